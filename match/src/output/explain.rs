//! Why a match won, in words.

use crate::output::report::{FeatureReport, FeatureState, MatchReport};
use crate::verification::part_match::PartMatch;
use premio_predict::image_arcs::ArcSource;
use std::fmt::Write;

/// What tells for and against the likeliest match, if there is any: feature by feature, and what its pose
/// was fitted to; and why a part is not found.
pub fn explained(best: Option<&PartMatch>, report: &MatchReport) -> String {
    let mut text = match &report.reason {
        Some(reason) => format!("not found: {reason}\n"),
        None => String::new(),
    };
    if let Some(best) = best {
        text += &weighed(best, report);
    }
    text += &worked(report);
    let mut order: Vec<_> = report.features.iter().collect();
    order.sort_by(|a, b| b.score.total_cmp(&a.score));
    for feature in order {
        text += &told(feature);
    }
    text
}

/// What a match weighs, and of what.
fn weighed(best: &PartMatch, report: &MatchReport) -> String {
    let mut text = String::new();
    let verdict = if report.found { "found" } else { "likeliest" };
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
         plane, {:.0} % framed; {:.0} % of the carriers found, the rest untold by {:.1}; {} edges go on \
         past a vertex",
        best.odds,
        best.rms,
        best.systematic_offset.wholes,
        best.systematic_offset.edges,
        report.straightness,
        100.0 * best.inside(),
        best.shape.determined,
        best.shape.denied,
        100.0 * best.shape.relief,
        100.0 * best.framed,
        100.0 * best.shape.carriers,
        best.shape.undetermined,
        best.past()
    );
    if !report.rivals.is_empty() {
        let count = report.rivals.len();
        let _ = writeln!(text, "{count} more poses are about as likely (`rivals`)");
    }
    text
}

/// What the search did.
fn worked(report: &MatchReport) -> String {
    let work = &report.work;
    let mut text = String::new();
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
    text
}

/// What a feature adds.
fn told(feature: &FeatureReport) -> String {
    let state = match feature.state {
        FeatureState::Whole => "whole",
        FeatureState::Broken => "broken",
        FeatureState::Missed => "missed",
    };
    let beside = feature.offset.zip(feature.systematic_offset);
    let beside = beside.map_or(String::new(), |(offset, off)| {
        let rms = off.wholes.hypot(off.edges);
        format!(", {offset:+.2} px beside it at first, {rms:.2} at last")
    });
    format!(
        "  {:+6.1}  {} {} {state}: {:.0} % of {:.0} px{beside} (against it {:.1})\n",
        feature.score,
        feature.source.word(),
        number(&feature.source),
        100.0 * feature.share,
        feature.length,
        feature.against
    )
}

/// The number of a feature.
fn number(source: &ArcSource) -> String {
    match source {
        ArcSource::Edge { edge } => edge.to_string(),
        ArcSource::Limb { face, ordinal } => format!("{face}.{ordinal}"),
        _ => String::new(),
    }
}
