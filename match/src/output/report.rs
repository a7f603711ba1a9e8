//! The report of a match (`premio.match/1`), and its line for evaluations by others (the CSV of the
//! BOP challenge, Hodan et al. 2018).

use crate::hypothesis::INSIDE;
use crate::image::ImageFeatures;
use crate::part::SoughtPart;
use crate::search::SearchStats;
use crate::verification::part_match::{PartMatch, SearchResult};
use crate::verification::residuals::SystematicOffset;
use crate::verification::score_weights::WEIGHTS;
use crate::verification::scoring::ScoreMeasures;
use crate::verification::shape_evidence::ShapeEvidence;
use nalgebra::{Isometry3, Matrix3};
use premio_kernel::geometry::frame::Frame;
use premio_predict::image_arcs::ArcSource;
use schemars::JsonSchema;
use serde::Serialize;

/// The name of the format.
pub const SCHEMA: &str = "premio.match/1";

/// The schema of [`MatchReport`], as JSON Schema has it.
pub fn schema() -> schemars::Schema {
    schemars::schema_for!(MatchReport)
}

/// A pose: x_camera = R x + t, with the camera's x to the right, y down and z forward (OpenCV).
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Pose {
    /// The rotation, row by row.
    #[serde(rename = "R")]
    pub r: [[f64; 3]; 3],
    /// The part's origin in the camera's frame, in the part's unit.
    pub t: [f64; 3],
}

impl From<&Isometry3<f64>> for Pose {
    fn from(pose: &Isometry3<f64>) -> Self {
        let m: Matrix3<f64> = pose.rotation.to_rotation_matrix().into_inner();
        Self {
            r: std::array::from_fn(|i| std::array::from_fn(|j| m[(i, j)])),
            t: pose.translation.vector.into(),
        }
    }
}

/// An axis of a part, in its frame.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct SymmetryAxis {
    /// A point of it.
    pub point: [f64; 3],
    /// Its unit direction.
    pub direction: [f64; 3],
}

impl From<&Frame> for SymmetryAxis {
    fn from(frame: &Frame) -> Self {
        Self {
            point: frame.origin.into(),
            direction: frame.z.into(),
        }
    }
}

/// The state of a feature of the part in the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, JsonSchema, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum FeatureState {
    /// Its edge is found.
    Whole,
    /// A part of its edge is found.
    Broken,
    /// It is not found.
    Missed,
}

/// A correspondence.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct FeatureReport {
    /// The feature of the part.
    #[serde(flatten)]
    pub source: ArcSource,
    /// Its visible length in the picture, in pixels.
    pub length: f64,
    /// Its state in the picture.
    pub state: FeatureState,
    /// The share of it that is covered.
    pub share: f64,
    /// At how many of its visible vertices its edge ends, and how many it overruns.
    pub ends: Option<[u32; 2]>,
    /// The mean signed distance of its edge from it, in pixels, when the edge was assigned.
    pub offset: Option<f64>,
    /// The residual of the edge at the pose, as root mean squares in pixels.
    pub systematic_offset: Option<SystematicOffset>,
    /// The ends of its segments.
    pub segments: Vec<[[f64; 2]; 2]>,
    /// Its contribution to the score, and the part of it that is evidence against the part.
    pub score: f64,
    /// See `score`.
    pub against: f64,
}

/// Another pose of a part, at which it looks about as likely.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct Rival {
    /// The pose.
    #[serde(flatten)]
    pub pose: Pose,
    /// As the report's.
    pub ratio: f64,
    /// See `ratio`.
    pub probability: f64,
}

/// A place in the picture at which the part is found.
#[derive(Clone, Copy, Debug, PartialEq, JsonSchema, Serialize)]
pub struct InstanceReport {
    /// The pose.
    #[serde(flatten)]
    pub pose: Pose,
    /// As the report's.
    pub probability: f64,
    /// Whether the part is there.
    pub found: bool,
}

/// The work of the search for a part.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize)]
pub struct SearchWork {
    /// Segments that the detector found.
    pub segments: usize,
    /// The numbers of chains with one line, and with two, between their corners.
    pub chains: [usize; 2],
    /// The number of poses that they proposed.
    pub proposed: usize,
    /// Whether chains, ellipses or paths were left out, so that a better match may have been
    /// missed.
    pub cut: bool,
    /// The search for the correspondences at the pose.
    #[serde(flatten)]
    pub search: SearchStats,
    /// Pruned over opened paths.
    pub pruning: f64,
}

/// Run times in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, JsonSchema, Serialize)]
pub struct MatchSeconds {
    /// To detect features.
    pub features: f64,
    /// To find the pose.
    pub matching: f64,
}

/// The result for a picture.
#[derive(Clone, Debug, PartialEq, JsonSchema, Serialize)]
pub struct MatchReport {
    /// [`SCHEMA`].
    pub schema: String,
    /// The picture's file.
    pub image: String,
    /// The part's file.
    pub part: String,
    /// Whether the part is there.
    pub found: bool,
    /// Why it is not found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
    /// The probability that it is there.
    pub probability: f64,
    /// The log-likelihood ratio of the picture with the part at the pose against clutter or another
    /// thing.
    pub ratio: Option<f64>,
    /// The prior log-odds that a thing that agrees this well is the part. They are lower the
    /// greater the residuals are, the more of the part is missed or cut off by the border, and the
    /// less its shape is determined. `probability` has the log-odds (`ratio` + `odds`) / 3.5,
    /// because the evidence of edges is correlated. Where nothing is found of some carriers
    /// (`shape`), the odds against a piece of the part limit it.
    pub odds: Option<f64>,
    /// The evidence of the part's shape.
    pub shape: Option<ShapeEvidence>,
    /// The systematic offset of features and the roughness of their edges. Another thing that is
    /// like the part has a greater systematic offset.
    pub systematic_offset: Option<SystematicOffset>,
    /// From 0 to 1: how much of what is found runs along the picture's rows and columns, as in a
    /// drawing or a frame. It is 1 if all of it does, some along either.
    pub framed: Option<f64>,
    /// The log-likelihood ratio against clutter alone, which the search maximises.
    pub score: Option<f64>,
    /// The Occam factor of the pose, by which the score counts less.
    pub fitted: Option<f64>,
    /// The contribution of relations to the score.
    pub related: Option<f64>,
    /// The share of the visible contours that lies in the picture, and the covered share of that.
    pub inside: Option<f64>,
    /// See `inside`.
    pub covered: Option<f64>,
    /// The pose; the likeliest one if the part is not found.
    #[serde(flatten)]
    pub pose: Option<Pose>,
    /// The covariance of the pose's error: rotation about the camera's axes through the part's
    /// origin, in radians, and translation, in the part's unit; row by row.
    pub covariance: Option<[[f64; 6]; 6]>,
    /// What the weights of the score apply to, if an explanation is wanted.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub measures: Option<ScoreMeasures>,
    /// The root mean square distance of edges from contours, in pixels.
    pub rms: Option<f64>,
    /// The residual of long straight segments from their lines in the picture, in pixels: `rms` may
    /// be as large.
    pub straightness: f64,
    /// The other poses that are equivalent by the part's symmetries.
    pub alternatives: Vec<Pose>,
    /// The axis of a part of revolution, in the part's frame: the pose may be rotated about it by
    /// any angle.
    pub axis: Option<SymmetryAxis>,
    /// Other accepted poses whose odds are less by a factor of at most e³, up to symmetries.
    pub rivals: Vec<Rival>,
    /// The instances of the part, each with edges of its own, the likeliest first. The report is of
    /// the first one. The picture may show more of them, because only the best poses are searched.
    pub instances: Vec<InstanceReport>,
    /// The correspondences.
    pub features: Vec<FeatureReport>,
    /// In a sequence: whether the whole picture was searched, rather than from the last pose.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub anew: Option<bool>,
    /// The work of the search.
    pub work: SearchWork,
    /// The side in pixels of the file of one pixel of the report: more than one for large pictures.
    /// Lengths and distances are in pixels of the report, the ends of segments in pixels of the
    /// file.
    pub scale: u32,
    /// The run times.
    pub seconds: MatchSeconds,
}

/// The names in a report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReportNames<'a> {
    /// The name of the picture.
    pub image: &'a str,
    /// The name of the part.
    pub part: &'a str,
}

/// The numbers of a line of the BOP challenge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BopIds {
    /// The scene.
    pub scene: u32,
    /// The picture of the scene.
    pub image: u32,
    /// The object.
    pub object: u32,
}

impl MatchReport {
    /// The report of a search.
    pub fn new(
        part: &SoughtPart<'_>,
        names: ReportNames<'_>,
        picture: &ImageFeatures,
        finding: &SearchResult,
        scale: u32,
        seconds: MatchSeconds,
    ) -> Self {
        let best = finding.best();
        let found = best.is_some_and(PartMatch::is_accepted);
        Self {
            schema: SCHEMA.to_owned(),
            image: names.image.to_owned(),
            part: names.part.to_owned(),
            found,
            reason: (!found).then(|| reason(part, picture, finding)),
            probability: best.map_or(0.0, PartMatch::probability),
            ratio: best.map(|m| m.ratio),
            odds: best.map(|m| m.odds),
            shape: best.map(|m| m.shape),
            systematic_offset: best.map(|m| m.systematic_offset),
            framed: best.map(|m| m.framed),
            score: best.map(|m| m.score),
            fitted: best.map(|m| m.fitted),
            inside: best.map(PartMatch::inside),
            covered: best.map(PartMatch::share),
            related: best.map(|m| m.relations.iter().sum()),
            pose: best.map(|m| Pose::from(&m.pose)),
            covariance: best
                .map(|m| std::array::from_fn(|i| std::array::from_fn(|j| m.covariance[(i, j)]))),
            measures: None,
            rms: best.map(|m| m.rms),
            straightness: picture.straightness,
            alternatives: best.map_or(Vec::new(), |m| {
                let others = part.turns().skip(1);
                others.map(|s| Pose::from(&(m.pose * s))).collect()
            }),
            axis: part.axis.as_ref().map(SymmetryAxis::from),
            rivals: rivals(finding),
            instances: instances(finding),
            features: best.map_or(Vec::new(), |m| features(m, picture, scale)),
            anew: None,
            work: work(picture, finding),
            scale,
            seconds,
        }
    }

    /// The line of the BOP challenge: scene, image and object, score, R and t, and the time.
    pub fn bop(&self, ids: BopIds) -> Option<String> {
        let BopIds {
            scene,
            image,
            object,
        } = ids;
        let pose = self.pose.filter(|_| self.found)?;
        let words = |all: &[f64]| {
            let words: Vec<String> = all.iter().map(f64::to_string).collect();
            words.join(" ")
        };
        let (r, t) = (words(&pose.r.concat()), words(&pose.t));
        let time = self.seconds.features + self.seconds.matching;
        Some(format!(
            "{scene},{image},{object},{},{r},{t},{time}",
            self.probability
        ))
    }
}

/// The first line of the BOP challenge's CSV.
pub const BOP: &str = "scene_id,im_id,obj_id,score,R,t,time";

fn work(picture: &ImageFeatures, finding: &SearchResult) -> SearchWork {
    let best = finding.best();
    let search = best.map(|m| m.effort).unwrap_or_default();
    SearchWork {
        segments: picture.detection.segments.len(),
        chains: finding.chains,
        proposed: finding.proposed,
        cut: finding.cut || best.is_some_and(|m| !m.complete),
        search,
        pruning: search.ratio(),
    }
}

fn rivals(finding: &SearchResult) -> Vec<Rival> {
    let rivals = finding.rivals().iter().map(|m| Rival {
        pose: Pose::from(&m.pose),
        ratio: m.ratio,
        probability: m.probability(),
    });
    rivals.collect()
}

fn instances(finding: &SearchResult) -> Vec<InstanceReport> {
    let instances = finding.instances().into_iter().map(|m| InstanceReport {
        pose: Pose::from(&m.pose),
        probability: m.probability(),
        found: m.is_accepted(),
    });
    instances.collect()
}

fn features(found: &PartMatch, picture: &ImageFeatures, scale: u32) -> Vec<FeatureReport> {
    // The centre of a pixel that is the mean of others lies between theirs.
    let side = f64::from(scale);
    let given = |v: f64| side * (v + 0.5) - 0.5;
    let features = found.pairs.iter().map(|pair| {
        let is = pair.found.as_ref();
        let share = is.map_or(0.0, |f| f.share.min(1.0));
        FeatureReport {
            source: pair.source,
            length: pair.length,
            state: match is {
                None => FeatureState::Missed,
                Some(_) if share >= crate::correspondence::WHOLE => FeatureState::Whole,
                Some(_) => FeatureState::Broken,
            },
            share,
            offset: is.map(|f| f.offset),
            systematic_offset: is.map(|f| f.systematic_offset),
            ends: is.map(|f| f.ends),
            segments: is.map_or(Vec::new(), |f| {
                let ends = f.segments.iter();
                let ends = ends.map(|&s| picture.ends(s).map(|p| p.map(given)));
                ends.collect()
            }),
            score: pair.score,
            against: pair.against,
        }
    });
    features.collect()
}

/// Why a part is not found.
fn reason(part: &SoughtPart<'_>, picture: &ImageFeatures, finding: &SearchResult) -> String {
    if !part.proposes() {
        return "the part has neither straight edges that share a vertex nor circular edges to propose poses"
            .to_owned();
    }
    let segments = picture.detection.segments.len();
    let Some(best) = finding.best() else {
        return match (segments, finding.proposed, &finding.little) {
            (0, ..) => "the detector finds no segment in the picture".to_owned(),
            (_, 0, _) => {
                format!("no corner of the {segments} segments matches one of the part")
            }
            (_, _, Some(few)) => format!(
                "the likeliest match has {} features, {:.0} pixels of contour and {:.0} % of the contour in \
                 the picture: a pose needs {}, {} and {:.0} %",
                few.found(),
                few.length(),
                100.0 * few.inside(),
                WEIGHTS.fewest_features(part.axis.is_some()),
                WEIGHTS.min_length,
                100.0 * INSIDE
            ),
            (_, n, None) => format!("none of the {n} proposed poses fits the picture"),
        };
    };
    let (found, all) = (best.found(), best.pairs.len());
    let measures = ScoreMeasures::new(best, picture.straightness);
    let others = match (measures.is_figure(&WEIGHTS), best.weight() >= 0.0) {
        (true, _) => "all of them could be a figure on a flat thing, or a frame",
        (_, true) => "another thing that has these features and lacks the others is likelier",
        _ => "other things agree as well with the picture",
    };
    format!(
        "the likeliest match has {found} of {all} features, {:.0} % of their length: {others}",
        100.0 * best.share()
    )
}
