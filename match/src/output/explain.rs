//! The explanation of a result in words.

use crate::output::report::{FeatureReport, FeatureState, MatchReport};
use crate::verification::part_match::PartMatch;
use premio_predict::image_arcs::ArcSource;
use std::fmt::Write;

/// The evidence for and against the likeliest match, feature by feature, and the Occam factor of
/// its pose; and why a part is not found.
pub fn explained(best: Option<&PartMatch>, report: &MatchReport) -> String {
    let mut text = match &report.reason {
        Some(reason) => format!("not found: {reason}\n"),
        None => String::new(),
    };
    if let Some(best) = best {
        text += &terms(best, report);
    }
    text += &search_work(report);
    let mut order: Vec<_> = report.features.iter().collect();
    order.sort_by(|a, b| b.score.total_cmp(&a.score));
    for feature in order {
        text += &feature_line(feature);
    }
    text
}

/// The score of a match and its terms.
fn terms(best: &PartMatch, report: &MatchReport) -> String {
    let mut text = String::new();
    let verdict = if report.found { "found" } else { "likeliest" };
    let _ = writeln!(
        text,
        "{verdict}, probability {:.3}: log-likelihood ratio {:.1} (score {:.1} against clutter, {:.1} \
         fitted by the pose, {:.1} from relations)",
        report.probability,
        best.ratio,
        best.score,
        best.fitted,
        best.relations.iter().sum::<f64>()
    );
    let _ = writeln!(
        text,
        "log-odds {:.1}: residual {:.2} px (systematic {:.2}, roughness {:.2}; of lines {:.2}), {:.0} % of \
         the contours in the picture; shape evidence {:.1} for and {:.1} against, {:.0} % off one plane, \
         {:.0} % framed; {:.0} % of the carriers found, the others missing with {:.1}; {} edges overrun a \
         vertex",
        best.odds,
        best.rms,
        best.systematic_offset.offset,
        best.systematic_offset.roughness,
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
        let _ = writeln!(text, "{count} other poses are about as likely (`rivals`)");
    }
    text
}

/// The work of the search.
fn search_work(report: &MatchReport) -> String {
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

/// The score of a feature.
fn feature_line(feature: &FeatureReport) -> String {
    let state = match feature.state {
        FeatureState::Whole => "whole",
        FeatureState::Broken => "broken",
        FeatureState::Missed => "missed",
    };
    let residual = feature.offset.zip(feature.systematic_offset);
    let residual = residual.map_or(String::new(), |(offset, off)| {
        let rms = off.offset.hypot(off.roughness);
        format!(", offset {offset:+.2} px when assigned, residual {rms:.2} px at the pose")
    });
    format!(
        "  {:+6.1}  {} {} {state}: {:.0} % of {:.0} px{residual} ({:.1} against the part)\n",
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
