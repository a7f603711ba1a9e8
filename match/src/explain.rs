//! Why a match won, in words.

use crate::finding::Match;
use crate::report::{Report, State};
use premio_predict::outline::Source;
use std::fmt::Write;

/// What tells for and against a match: feature by feature, and what its pose was fitted to.
pub fn explained(best: &Match, report: &Report) -> String {
    let mut text = String::new();
    let verdict = if report.found { "found" } else { "not found" };
    let _ = writeln!(
        text,
        "{verdict}, probability {:.3}: ratio {:.1} (score {:.1} against clutter, {:.1} fitted by the pose, \
         {:.1} of relations)",
        report.probability,
        best.ratio,
        best.score,
        best.fitted,
        best.relations.iter().sum::<f64>()
    );
    let _ = writeln!(
        text,
        "odds {:.1}: edges {:.2} px off contours (as wholes {:.2}, beside that {:.2}; off lines {:.2}), \
         {:.0} % of these in the picture; the shape told by {:.1}, denied by {:.1}, {:.0} % apart from one \
         plane, {:.0} % framed; {} edges go on past a vertex",
        best.odds,
        best.rms,
        best.astray.wholes,
        best.astray.edges,
        report.straightness,
        100.0 * best.inside(),
        best.shape.told,
        best.shape.denied,
        100.0 * best.shape.relief,
        100.0 * best.framed,
        best.past()
    );
    if !report.rivals.is_empty() {
        let count = report.rivals.len();
        let _ = writeln!(text, "{count} more poses are about as likely (`rivals`)");
    }
    let work = &report.work;
    let _ = writeln!(
        text,
        "{} segments, {} + {} chains proposed {} poses; correspondences: {} choices eliminated, {} \
         paths opened, {} pruned ({:.2} %), {} nodes, {} rounds{}",
        work.segments,
        work.chains[0],
        work.chains[1],
        work.proposed,
        work.search.eliminated,
        work.search.opened,
        work.search.pruned,
        100.0 * work.pruning,
        work.search.nodes,
        work.search.rounds,
        if work.cut { "; some were left out" } else { "" }
    );
    let mut order: Vec<_> = report.features.iter().collect();
    order.sort_by(|a, b| b.score.total_cmp(&a.score));
    for feature in order {
        let state = match feature.state {
            State::Whole => "whole",
            State::Broken => "broken",
            State::Missed => "missed",
        };
        let beside = feature
            .offset
            .map_or(String::new(), |o| format!(", {o:+.2} px beside it"));
        let _ = writeln!(
            text,
            "  {:+6.1}  {} {} {state}: {:.0} % of {:.0} px{beside} (against it {:.1})",
            feature.score,
            feature.source.word(),
            number(&feature.source),
            100.0 * feature.share,
            feature.length,
            feature.against
        );
    }
    text
}

/// The number of a feature.
fn number(source: &Source) -> String {
    match source {
        Source::Edge { edge } => edge.to_string(),
        Source::Limb { face, ordinal } => format!("{face}.{ordinal}"),
        _ => String::new(),
    }
}
