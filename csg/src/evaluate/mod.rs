//! The boundary of a tree: generate and classify (Requicha and Voelcker 1985).
//!
//! The stages, in order:
//!
//! | module | what it gives |
//! | --- | --- |
//! | `near_cylinders` | refuses frustums that are nearly cylinders |
//! | `vanished` | drops primitives thinner than the resolution |
//! | `halfspaces` | every primitive as half-spaces |
//! | `distinct_surfaces` | the distinct surfaces of these, the carriers |
//! | `arrangement` | the curves in which carriers intersect |
//! | `tangent_contacts` | moves a curve of contact onto a curve that runs next to it |
//! | `split_curves` | the common points of curves and carriers |
//! | `vertices` | equal points merged |
//! | `edge_candidates` | the pieces of curves between vertices |
//! | `membership` | whether a choice of sides is material, by the tree |
//! | `radial_order` | the order of carriers around a piece |
//! | `edge_classification` | which pieces are edges, and where their faces lie |
//! | `exact_coefficients` | in exact evaluation, surfaces with rational coefficients |
//! | `incidence_proof` | in exact evaluation, proofs of what passes through what |
//! | `relevance` | the close calls on which the boundary depends |
//! | `face_verification` | every face checked against the tree |
//!
//! The kernel assembles edges to loops, faces, shells and solids.

mod arrangement;
mod distinct_surfaces;
mod edge_candidates;
mod edge_classification;
mod exact_coefficients;
mod face_verification;
mod halfspaces;
mod incidence_proof;
mod membership;
mod near_cylinders;
mod radial_order;
mod relevance;
mod split_curves;
mod tangent_contacts;
mod vanished;
mod vertices;

use crate::tree::Tree;
use premio_kernel::brep::Brep;
use premio_kernel::brep::assemble::{AssemblyError, assemble};
use premio_kernel::brep::bounding_box::bounds;
use premio_kernel::brep::check::{Violation, check, worst_gap};
use premio_kernel::brep::face_integrals::{FaceIntegrals, Mass};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::intersect::{IntersectionError, RegionOfInterest};
use premio_kernel::geometry::vector::rounded;
use premio_kernel::number::extended::F237;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{
    CloseCall, CoincidencePolicy, Compare, DecisionStats, FINEST_RESOLUTION, Predicates,
    RELATIVE_RESOLUTION, ROUNDING,
};
use std::sync::OnceLock;

/// How a tree is evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EvaluationOptions {
    /// The resolution, a distance in the part's unit; by default 1e-11 of the part's size, wider
    /// for a description with fewer digits.
    pub resolution: Option<f64>,
    /// The relative noise of the description's coordinates, where it has any.
    pub noise: Option<f64>,
    /// What coincides.
    pub zeros: CoincidencePolicy,
    /// In what numbers that is decided.
    pub digits: Arithmetic,
    /// The most curves and points of curves that are kept, some two thousand bytes each; by default
    /// [`MAX_ENTITIES`].
    pub entity_limit: Option<usize>,
}

/// In what numbers a tree is evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Arithmetic {
    /// In f64, and in 237 bits where these do not tell.
    #[default]
    Filtered,
    /// In 237 bits: no decision is made in f64.
    Extended,
}

/// The default limit on curves and points of curves between the surfaces of a part.
pub const MAX_ENTITIES: usize = 1 << 23;

/// The boundary of a tree, and how it was decided.
#[derive(Debug)]
pub struct Evaluation {
    /// The boundary.
    pub brep: Brep,
    /// How the decisions were made.
    pub decisions: DecisionStats,
    /// The resolution used, in the part's unit.
    pub resolution: f64,
    /// A box that holds the part.
    pub bounds: Aabb,
    /// What it was told by.
    told: Told,
    /// The resolution by which f64 values tell the same boundary, where they do.
    plain: Option<f64>,
    /// Once it was requested: with more digits it takes longer than the boundary.
    mass: OnceLock<Mass>,
}

/// The numbers that told a boundary.
#[derive(Debug)]
enum Told {
    /// f64 values.
    Doubles(FaceIntegrals),
    /// More digits: the boundary before it was rounded.
    Wide(Box<(Brep<F237>, FaceIntegrals<F237>)>),
}

impl Evaluation {
    /// The resolution for views of the boundary, which are computed in f64; none where f64 values do
    /// not tell the boundary: rounded to them, surfaces may lie on one another that do not.
    pub fn view_resolution(&self) -> Option<f64> {
        self.plain
    }

    /// What f64 values tell of the boundary, however finely it was evaluated.
    pub fn f64_resolution(&self) -> f64 {
        let known = self.plain.unwrap_or(self.resolution);
        known.max(ROUNDING * self.bounds.diagonal())
    }

    /// How far apart what coincides by the resolution was seen to be at most; nought where nothing
    /// of it was a close call.
    pub fn greatest_coincidence(&self) -> f64 {
        let distances = self.decisions.close_calls.iter().map(|c| c.distance.abs());
        let coincident = distances.filter(|d| d.is_within(self.resolution));
        coincident.fold(0.0, f64::max)
    }

    /// The volume, the area and the centroid.
    pub fn mass(&self) -> Mass {
        *self.mass.get_or_init(|| match &self.told {
            Told::Doubles(measures) => measures.mass(&self.brep),
            Told::Wide(wide) => wide.1.mass(&wide.0),
        })
    }

    /// The box of the boundary, to rounding.
    pub fn tight_bounds(&self) -> Aabb {
        match &self.told {
            Told::Doubles(_) => bounds(&self.brep),
            Told::Wide(wide) => bounds(&wide.0),
        }
    }

    /// The rules that the boundary breaks.
    pub fn violations(&self) -> Vec<Violation> {
        match &self.told {
            Told::Doubles(measures) => check(&self.brep, measures, self.resolution),
            Told::Wide(wide) => check(&wide.0, &wide.1, F237::from_f64(self.resolution)),
        }
    }
}

/// The same, in numbers of one precision.
struct Evaluated<N: Float> {
    brep: Brep<N>,
    measures: FaceIntegrals<N>,
    decisions: DecisionStats,
    resolution: f64,
    bounds: Aabb,
}

impl From<Evaluated<f64>> for Evaluation {
    fn from(known: Evaluated<f64>) -> Self {
        Self {
            brep: known.brep,
            decisions: known.decisions,
            resolution: known.resolution,
            bounds: known.bounds,
            told: Told::Doubles(known.measures),
            plain: Some(known.resolution),
            mass: OnceLock::new(),
        }
    }
}

impl From<Evaluated<F237>> for Evaluation {
    fn from(known: Evaluated<F237>) -> Self {
        let mut decisions = known.decisions;
        // All of them took more bits than f64 values have.
        decisions.refined += std::mem::take(&mut decisions.filtered);
        Self {
            brep: known.brep.to_f64(),
            decisions,
            resolution: known.resolution,
            bounds: known.bounds,
            told: Told::Wide(Box::new((known.brep, known.measures))),
            plain: None,
            mass: OnceLock::new(),
        }
    }
}

/// Why a tree has no boundary here.
#[derive(Debug, thiserror::Error)]
pub enum EvaluationError {
    /// Two surfaces meet in a way that is beyond the kernel.
    #[error(transparent)]
    Intersection(#[from] IntersectionError),
    /// The sheets around an edge could not be put in order.
    #[error("the faces around an edge near ({:.6}, {:.6}, {:.6}) cannot be told apart", place[0], place[1], place[2])]
    AmbiguousEdgeOrder {
        /// Near where.
        place: [f64; 3],
    },
    /// Nothing determines whether a closed surface without an edge is a face.
    #[error(
        "whether the sphere or torus near ({:.6}, {:.6}, {:.6}) is a face cannot be told: all over it other surfaces are within the resolution",
        place[0], place[1], place[2]
    )]
    UndecidedClosedFace {
        /// A point of it.
        place: [f64; 3],
    },
    /// The pieces do not form a boundary.
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    /// Surfaces lie so nearly along one another that f64 values do not determine where they meet.
    #[error(
        "what meets near ({:.6}, {:.6}, {:.6}) is known to {distance:.1e} only, and the resolution is {resolution:.1e}: surfaces lie nearly along one another there",
        place[0], place[1], place[2]
    )]
    IllConditioned {
        /// Near where.
        place: [f64; 3],
        /// How far apart is what should be one, in the part's unit.
        distance: f64,
        /// The resolution.
        resolution: f64,
    },
    /// The walls of a frustum are nearly those of a cylinder.
    #[error(
        "the apex of the frustum near ({:.6}, {:.6}, {:.6}) is {away:.1e} away: rounding moves its walls by more than the resolution",
        place[0], place[1], place[2]
    )]
    NearCylinder {
        /// Near where.
        place: [f64; 3],
        /// How far away the apex is, in the part's unit.
        away: f64,
    },
    /// Under exact evaluation: 237 bits take something for zero that is proven not to be.
    #[error(
        "{question} near ({:.6}, {:.6}, {:.6}): they are apart, by less than 237 bits tell",
        place[0], place[1], place[2]
    )]
    UnprovenCoincidence {
        /// What was asked.
        question: &'static str,
        /// Near where.
        place: [f64; 3],
    },
    /// The description's numbers are too large or too small for f64 values.
    #[error("the part's size is beyond the range of lengths from 1e-100 to 1e100")]
    Size,
    /// The part lies too far from the origin for f64 values.
    #[error(
        "the part, of size {size:.3e}, lies up to {far:.3e} from the origin: its coordinates are rounded by more than a millionth of its size"
    )]
    TooFarFromOrigin {
        /// The greatest coordinate.
        far: f64,
        /// The diagonal of its box.
        size: f64,
    },
    /// The resolution is finer than f64 values are, or wider than the part.
    #[error(
        "a resolution of {asked:e} is beyond the range from {least:.1e} to {most:.1e} for a part of this size"
    )]
    Resolution {
        /// What was requested.
        asked: f64,
        /// The least that f64 values keep apart.
        least: f64,
        /// The greatest: a hundredth of the part's size.
        most: f64,
    },
    /// There are more pairs of faces that may meet, or curves and points in which they do, than are kept.
    #[error("the faces of the part meet in more than {most} places: the limit")]
    EntityLimit {
        /// The limit.
        most: usize,
    },
    /// The boundary breaks one of its own rules: something was told wrongly, and it would be wrong.
    #[error("the boundary that was found is unsound: {0}")]
    InvalidBoundary(Violation),
    /// The tree itself contradicts a face: something was told wrongly, and it would be wrong.
    #[error(
        "the boundary that was found has a face near ({:.6}, {:.6}, {:.6}) where the description has none",
        place[0], place[1], place[2]
    )]
    Contradiction {
        /// A point of the face.
        place: [f64; 3],
    },
}

impl EvaluationError {
    /// Whether numbers with more digits may tell what f64 values do not.
    fn is_of_doubles(&self) -> bool {
        match self {
            Self::Intersection(_)
            | Self::AmbiguousEdgeOrder { .. }
            | Self::UndecidedClosedFace { .. }
            | Self::Assembly(_)
            | Self::IllConditioned { .. }
            | Self::InvalidBoundary(_)
            | Self::Contradiction { .. }
            | Self::NearCylinder { .. }
            | Self::Resolution { .. } => true,
            Self::Size
            | Self::TooFarFromOrigin { .. }
            | Self::UnprovenCoincidence { .. }
            | Self::EntityLimit { .. } => false,
        }
    }
}

/// Trees of no more primitives are evaluated with more digits where f64 values do not tell: that takes
/// some hundred times as long.
const FEW: usize = 64;

/// The boundary of the solid that a tree describes; empty for an empty solid.
///
/// In f64, and where these do not tell what meets, in numbers of 237 bits by the same
/// resolution.
pub fn evaluate(tree: &Tree, options: &EvaluationOptions) -> Result<Evaluation, EvaluationError> {
    match (options.zeros, options.digits) {
        (CoincidencePolicy::Exact, _) => return Ok(seen(tree, options, finely(tree, options)?)),
        (_, Arithmetic::Extended) => return Ok(seen(tree, options, widely(tree, options)?)),
        (_, Arithmetic::Filtered) => {}
    }
    match evaluated::<f64>(tree, options) {
        Ok(mut known) => {
            known
                .decisions
                .close_calls
                .extend(vanished(tree, &known, options.noise));
            Ok(known.into())
        }
        Err(error) if error.is_of_doubles() && tree.leaves().count() <= FEW => {
            widely(tree, options).map(Evaluation::from)
        }
        Err(error) => Err(error),
    }
}

/// The close call by which nothing is left of a part that has a solid in 237 bits.
fn vanished(tree: &Tree, known: &Evaluated<f64>, noise: Option<f64>) -> Option<CloseCall> {
    let is_asked = known.brep.topology.faces.is_empty()
        && known.decisions.coincident > 0
        && tree.leaves().count() <= FEW;
    let fine = is_asked.then(|| finely(tree, &EvaluationOptions::default()).ok())??;
    let written = noise.unwrap_or(0.0) * known.bounds.diagonal();
    let noise = vanished::rounding(tree, &known.bounds).max(written);
    vanished::remainder(&fine.measures.mass(&fine.brep), noise)
}

/// In 237 bits: by the resolution, and where what coincides by it contradicts itself, by the finest,
/// unless one is requested.
fn widely(tree: &Tree, options: &EvaluationOptions) -> Result<Evaluated<F237>, EvaluationError> {
    match (evaluated::<F237>(tree, options), options.resolution) {
        (Err(error), None) => finely(tree, options).map_err(|_| error),
        (known, _) => known,
    }
}

/// What is known in 237 bits. Where f64 values tell a boundary of the same kind, it can be seen in them.
fn seen(tree: &Tree, options: &EvaluationOptions, known: Evaluated<F237>) -> Evaluation {
    let by_resolution = EvaluationOptions {
        zeros: CoincidencePolicy::ByResolution,
        ..*options
    };
    let plain = evaluated::<f64>(tree, &by_resolution).ok();
    let alike = plain.filter(|plain| plain.brep.topology.census() == known.brep.topology.census());
    let resolution = alike.map(|plain| plain.resolution);
    Evaluation {
        plain: resolution,
        ..Evaluation::from(known)
    }
}

/// In 237 bits, by the finest resolution.
fn finely(tree: &Tree, options: &EvaluationOptions) -> Result<Evaluated<F237>, EvaluationError> {
    let size = halfspaces::HalfSpaceModel::<F237>::new(tree)
        .bounds
        .diagonal();
    let finest = EvaluationOptions {
        resolution: Some(FINEST_RESOLUTION * size),
        ..*options
    };
    evaluated::<F237>(tree, &finest)
}

fn evaluated<N: Float>(
    tree: &Tree,
    options: &EvaluationOptions,
) -> Result<Evaluated<N>, EvaluationError> {
    let solids = halfspaces::HalfSpaceModel::new(tree);
    let size = solids.bounds.diagonal();
    if tree.is_empty() {
        let decisions = Predicates::new(0.0).decisions();
        let (brep, bounds) = (Brep::default(), Aabb::EMPTY);
        return Ok(Evaluated {
            measures: FaceIntegrals::new(&brep),
            brep,
            decisions,
            resolution: 0.0,
            bounds,
        });
    }
    if !size.lies_between([1.0 / LARGEST, LARGEST]) {
        return Err(EvaluationError::Size);
    }
    let resolution = resolution_of::<N>(&solids.bounds, options)?;
    let predicates = match options.zeros {
        CoincidencePolicy::Exact => Predicates::exact(resolution),
        CoincidencePolicy::ByResolution => Predicates::new(resolution),
    };
    let straight = near_cylinders::without(tree, &predicates);
    let (tree, solids) = match &straight {
        Some(tree) => (tree, halfspaces::HalfSpaceModel::new(tree)),
        None => (tree, solids),
    };
    let extent = RegionOfInterest {
        centre: solids.bounds.centre().map(N::from_f64),
        radius: N::from_f64(0.75 * size),
    };
    near_cylinders::check(&solids, &extent, &predicates)?;
    let most = options.entity_limit.unwrap_or(MAX_ENTITIES);
    let (arrangement, sources) = arrangement::arrange(tree, &solids, &extent, &predicates, most)?;
    let pieces = edge_candidates::pieces(&arrangement, &predicates);
    if predicates.is_exact() {
        incidence_proof::prove(&arrangement, &pieces, &sources, &predicates)?;
        if let Some(doubt) = predicates.first_unproven() {
            let (question, place) = (doubt.question, doubt.place);
            return Err(EvaluationError::UnprovenCoincidence { question, place });
        }
    }
    let concern = relevance::CloseCallFilter {
        solids: &solids,
        arrangement: &arrangement,
        membership: &membership::Membership::new(tree),
        predicates: &predicates,
    };
    concern.list();
    vanished::list(tree, &predicates);
    let raw = edge_classification::boundary(&concern, pieces)?;
    let brep = assemble(raw, &predicates)?;
    let exact_resolution = N::from_f64(resolution);
    let measures = FaceIntegrals::new(&brep);
    if let Some(broken) = check(&brep, &measures, exact_resolution).into_iter().next() {
        return Err(match worst_gap(&brep, exact_resolution) {
            Some((place, distance)) => EvaluationError::IllConditioned {
                place: rounded(&place),
                distance: distance.rounded(),
                resolution,
            },
            None => EvaluationError::InvalidBoundary(broken),
        });
    }
    if let Some(place) = concern.contradiction(&brep) {
        return Err(EvaluationError::Contradiction { place });
    }
    let decisions = predicates.decisions();
    Ok(Evaluated {
        brep,
        measures,
        decisions,
        resolution,
        bounds: solids.bounds,
    })
}

/// The resolution that is requested, or the default: wider where the part lies so far from the
/// origin that its coordinates are rounded by more.
fn resolution_of<N: Float>(
    bounds: &Aabb,
    options: &EvaluationOptions,
) -> Result<f64, EvaluationError> {
    let size = bounds.diagonal();
    let far = bounds.min.iter().chain(&bounds.max);
    let far = far.fold(size, |far, x| far.max(x.abs()));
    let (least, most) = (N::ROUNDING.rounded() * far, COARSEST * size);
    if least.is_beyond(size * FARTHEST) {
        return Err(EvaluationError::TooFarFromOrigin { far, size });
    }
    let relative = RELATIVE_RESOLUTION.max(options.noise.unwrap_or(0.0));
    let resolution = options.resolution.unwrap_or((relative * size).max(least));
    if !resolution.lies_in([least, most]) {
        return Err(EvaluationError::Resolution {
            asked: resolution,
            least,
            most,
        });
    }
    Ok(resolution)
}

/// The greatest resolution, in terms of the part's size.
const COARSEST: f64 = 0.01;

/// The greatest rounding of coordinates, in terms of the part's size.
const FARTHEST: f64 = 1.0 / (1 << 20) as f64;

/// Beyond these lengths squares of f64 values lose their range.
const LARGEST: f64 = 1e100;
