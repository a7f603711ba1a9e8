//! The five levels of a prediction (`premio.prediction/1`).

use super::predicted_image::{DetectionOutcome, PredictedImage};
use crate::feature::contrast::{Contrast, sides};
use crate::feature::detected_arc::DetectionState;
use crate::feature::group::{ArcChain, BoundaryGroup, boundaries, chains, triplets};
use crate::feature::junction::{Nodes, PredictedJunction, junctions};
use crate::feature::reason::Reason;
use crate::image_arcs::{ArcSource, PredictedArc, RegionPoint};
use crate::setup::Setup;
use premio_detect::SegmentShape;
use schemars::JsonSchema;
use serde::Serialize;

/// The name of the format.
pub const SCHEMA: &str = "premio.prediction/1";

/// The prediction of an image.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct Prediction {
    /// [`SCHEMA`].
    pub schema: &'static str,
    /// The image, and its conditions.
    pub image: ImageLevel,
    /// The part in it.
    pub object: ObjectLevel,
    /// The regions, by id.
    pub regions: Vec<RegionLevel>,
    /// The boundaries of regions, by id.
    pub boundaries: Vec<BoundaryLevel>,
    /// The arcs that boundaries consist of, by id.
    pub arcs: Vec<ArcLevel>,
    /// The segments that the detector finds, by id.
    pub segments: Vec<ImageSegment>,
}

/// The image level: the conditions of the image.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct ImageLevel {
    /// The setup.
    pub setup: Setup,
    /// OpenCV's camera matrix, in pixels.
    #[serde(rename = "K")]
    pub k: [[f64; 3]; 3],
    /// The rotation into the camera's frame.
    #[serde(rename = "R")]
    pub r: [[f64; 3]; 3],
    /// The part's origin in the camera's frame.
    pub t: [f64; 3],
    /// The difference of grey levels that the detector's threshold needs.
    pub contrast_needed: f64,
    /// The number of noise draws from which chances are estimated.
    pub draws: u32,
}

/// The object level: the visible part.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct ObjectLevel {
    /// The least and the greatest column and row of its arcs in the image.
    pub bounds: [[f64; 2]; 2],
    /// The regions that show it.
    pub regions: Vec<u32>,
    /// The arcs that may be found: all but smooth ones.
    pub features: Vec<u32>,
    /// The junctions of arcs.
    pub junctions: Vec<PredictedJunction>,
    /// Chains of arcs through junctions of two.
    pub chains: Vec<ArcChain>,
    /// Three arcs, the middle one of which has a junction with the others at its ends.
    pub triplets: Vec<[u32; 3]>,
    /// The closed boundaries.
    pub loops: Vec<u32>,
    /// The boundaries of holes in regions.
    pub holes: Vec<u32>,
}

/// The region level.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct RegionLevel {
    /// Its place in the list.
    pub id: u32,
    /// The face that is visible in it; none for the background.
    pub face: Option<u32>,
    /// The lights that reach it.
    pub lit: Vec<u32>,
    /// The mean grey level, before noise and steps.
    pub mean: f64,
    /// Its area in pixels.
    pub area: f64,
    /// Its boundaries.
    pub boundaries: Vec<u32>,
}

/// The boundary level.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct BoundaryLevel {
    /// Its place in the list.
    pub id: u32,
    /// The region it bounds.
    pub region: u32,
    /// Its arcs.
    #[serde(flatten)]
    pub boundary: BoundaryGroup,
    /// The share of its length that is found.
    pub found: f64,
}

/// The form of an arc in the image, in pixels.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub enum ArcGeometry {
    /// A straight line.
    Line {
        /// Its ends.
        ends: [[f64; 2]; 2],
    },
    /// A conic a x² + b x y + c y² + d x + e y + f = 0.
    Conic {
        /// a to f.
        coefficients: Vec<f64>,
        /// Points of it, from its start to its end.
        points: Vec<[f64; 2]>,
    },
    /// Neither.
    Sampled {
        /// Points of it, from its start to its end.
        points: Vec<[f64; 2]>,
    },
}

/// The probabilities that an arc is whole, broken or missed.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Chances {
    /// In one piece.
    pub whole: f64,
    /// In pieces, or in part.
    pub broken: f64,
    /// Not found.
    pub missed: f64,
}

/// A piece of an arc that is found.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct ArcPiece {
    /// The range of the curve's parameter.
    pub t: [f64; 2],
    /// The range along the arc, in pixels.
    pub along: [f64; 2],
    /// The segments of the detector that form it.
    pub segments: Vec<u32>,
}

/// The arc level.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct ArcLevel {
    /// Its place in the list.
    pub id: u32,
    /// Its source.
    pub source: ArcSource,
    /// The contour of the view from which it is cut.
    pub contour: Option<u32>,
    /// The range of the parameter of the curve in space; for a shadow's boundary that of the curve
    /// that casts it.
    pub t: [f64; 2],
    /// The regions to its left and to its right, from stop to stop.
    pub sides: Vec<[u32; 2]>,
    /// Whether the normal is continuous across it.
    pub smooth: bool,
    /// Its form.
    pub geometry: ArcGeometry,
    /// Its length within the image, in pixels.
    pub length: f64,
    /// The grey levels on both sides along it, before noise and steps.
    pub contrast: Vec<Contrast>,
    /// The pieces of it that are found.
    pub fragments: Vec<ArcPiece>,
    /// The found share of it without its ends.
    pub share: f64,
    /// Its most frequent state.
    pub state: DetectionState,
    /// The probabilities of the states.
    pub chances: Chances,
    /// Why it is not whole.
    pub reason: Option<Reason>,
}

/// A segment of the detector, with the arcs of its edge pixels.
#[derive(Clone, Debug, JsonSchema, Serialize)]
pub struct ImageSegment {
    /// Its place in the list.
    pub id: u32,
    /// Its form, in pixels.
    pub shape: SegmentShape,
    /// The root mean square distance of the edge pixels from it.
    pub rms: f64,
    /// The arcs.
    pub arcs: Vec<u32>,
}

/// The prediction of an image.
pub fn prediction(draft: &PredictedImage<'_>, setup: &Setup) -> Prediction {
    let outcome = draft.outcome();
    let measure = draft.measure();
    let arcs: Vec<ArcLevel> = (0..draft.arcs.len())
        .map(|i| arc_level(draft, &outcome, i, &measure))
        .collect();
    let nodes = Nodes::new(&draft.arcs);
    let margin = draft.conditions.detector.radius() as f64;
    let meetings = junctions(&draft.arcs, &nodes, &outcome.evidence, &draft.ink, margin);
    let mut regions = region_levels(draft);
    let mut bounds = Vec::new();
    let by_region = boundaries(&draft.arcs[..draft.regions.arcs()], &nodes, &draft.regions);
    for (region, all) in by_region.into_iter().enumerate() {
        for boundary in all {
            let id = bounds.len() as u32;
            regions[region].boundaries.push(id);
            bounds.push(boundary_level(id, region as u32, boundary, &arcs));
        }
    }
    let segments = segments(&outcome, arcs.len());
    let matrices = draft.stage.matrices;
    let rows =
        |m: &nalgebra::Matrix3<f64>| std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)]));
    Prediction {
        schema: SCHEMA,
        image: ImageLevel {
            setup: setup.clone(),
            k: rows(&matrices.k),
            r: rows(&matrices.r),
            t: matrices.t.into(),
            contrast_needed: measure.needed,
            draws: outcome.counts.first().map_or(0, |c| c.iter().sum()),
        },
        object: object_level(draft, meetings, &regions, &bounds, &arcs),
        regions,
        boundaries: bounds,
        arcs,
        segments,
    }
}

fn object_level(
    draft: &PredictedImage<'_>,
    junctions: Vec<PredictedJunction>,
    regions: &[RegionLevel],
    boundaries: &[BoundaryLevel],
    arcs: &[ArcLevel],
) -> ObjectLevel {
    let mut bounds = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
    for p in draft.ink.pixels.iter().map(|p| p.at) {
        for i in 0..2 {
            bounds[0][i] = bounds[0][i].min(p[i]);
            bounds[1][i] = bounds[1][i].max(p[i]);
        }
    }
    let those = |hole: bool| {
        let all = boundaries
            .iter()
            .filter(|b| b.boundary.closed && (!hole || b.boundary.hole));
        all.map(|b| b.id).collect()
    };
    ObjectLevel {
        bounds,
        regions: regions
            .iter()
            .filter(|r| r.face.is_some())
            .map(|r| r.id)
            .collect(),
        features: arcs.iter().filter(|a| !a.smooth).map(|a| a.id).collect(),
        chains: chains(arcs.len(), &junctions),
        triplets: triplets(arcs.len(), &junctions),
        junctions,
        loops: those(false),
        holes: those(true),
    }
}

fn region_levels(draft: &PredictedImage<'_>) -> Vec<RegionLevel> {
    let levels = draft.regions.all.iter().enumerate().map(|(i, region)| {
        let (mut sum, mut weight) = (0.0, 0.0);
        for &RegionPoint { at, gap } in &region.points {
            let seen = region.seen.unwrap_or_else(|| draft.shading.cast(at));
            let mut hint = draft.shading.distance(&seen.point);
            sum += gap * draft.shading.level(at, &seen, &mut hint);
            weight += gap;
        }
        let seen = region.seen;
        RegionLevel {
            id: i as u32,
            face: seen.and_then(|s| s.face).map(|f| f.0),
            lit: (0..64)
                .filter(|k| seen.is_some_and(|s| s.lit >> k & 1 == 1))
                .collect(),
            mean: if weight > 0.0 { sum / weight } else { 0.0 },
            area: region.area,
            boundaries: Vec::new(),
        }
    });
    levels.collect()
}

fn boundary_level(
    id: u32,
    region: u32,
    boundary: BoundaryGroup,
    arcs: &[ArcLevel],
) -> BoundaryLevel {
    let own = boundary.arcs.iter().map(|&a| &arcs[a as usize]);
    let length: f64 = own.clone().map(|a| a.length).sum();
    let found: f64 = own.map(|a| a.length * a.share).sum();
    BoundaryLevel {
        id,
        region,
        boundary,
        found: if length > 0.0 { found / length } else { 0.0 },
    }
}

fn arc_level(
    draft: &PredictedImage<'_>,
    outcome: &DetectionOutcome,
    i: usize,
    measure: &crate::feature::reason::Measure,
) -> ArcLevel {
    let arc = &draft.arcs[i];
    let evidence = &outcome.evidence[i];
    let contrast = draft.contrast(i);
    let reason = draft.reason(i, &outcome.evidence, &contrast, measure);
    let [start, end] = draft.ink.spans[i];
    let total: u32 = outcome.counts[i].iter().sum();
    let chance =
        |state: DetectionState| f64::from(outcome.counts[i][state.index()]) / f64::from(total);
    let fragments = evidence.fragments.iter().map(|f| ArcPiece {
        t: f.along.map(|a| arc.line.parameter_at(a)),
        along: f.along,
        segments: f.segments.clone(),
    });
    ArcLevel {
        id: i as u32,
        source: arc.source,
        contour: arc.contour,
        t: [0, arc.line.parameters.len() - 1].map(|k| arc.line.parameters[k]),
        sides: sides(&draft.regions, i, arc),
        smooth: arc.smooth,
        geometry: geometry(arc),
        length: (end - start).max(0.0),
        contrast,
        fragments: fragments.collect(),
        share: evidence.share,
        state: evidence.state,
        chances: Chances {
            whole: chance(DetectionState::Whole),
            broken: chance(DetectionState::Broken),
            missed: chance(DetectionState::Missed),
        },
        reason: if arc.smooth { None } else { reason },
    }
}

fn geometry(arc: &PredictedArc) -> ArcGeometry {
    let points = &arc.line.points;
    let ends = [points[0], points[points.len() - 1]];
    match arc.coefficients.len() {
        3 => ArcGeometry::Line { ends },
        6 => ArcGeometry::Conic {
            coefficients: arc.coefficients.clone(),
            points: points.clone(),
        },
        _ if points.len() == 2 => ArcGeometry::Line { ends },
        _ => ArcGeometry::Sampled {
            points: points.clone(),
        },
    }
}

fn segments(outcome: &DetectionOutcome, arcs: usize) -> Vec<ImageSegment> {
    let found = outcome
        .detection
        .segments
        .iter()
        .enumerate()
        .map(|(i, segment)| ImageSegment {
            id: i as u32,
            shape: segment.shape,
            rms: segment.rms,
            arcs: (0..arcs as u32)
                .filter(|&a| {
                    let fragments = &outcome.evidence[a as usize].fragments;
                    fragments.iter().any(|f| f.segments.contains(&(i as u32)))
                })
                .collect(),
        });
    found.collect()
}
