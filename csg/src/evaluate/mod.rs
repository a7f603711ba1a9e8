//! The boundary of a tree: generate and classify (Requicha and Voelcker 1985).
//!
//! The stages, in order:
//!
//! | module | what it gives |
//! | --- | --- |
//! | `near_cylinders` | refuses frustums that are nearly cylinders |
//! | `vanished` | drops primitives thinner than the resolution |
//! | `walls` | the surfaces that the edges of a figure sweep |
//! | `section` | which walls of a prism or revolution pass through a point, and where they end |
//! | `facets` | the same of a polyhedron |
//! | `region` | one of these two |
//! | `halfspaces` | every primitive as half-spaces, or as walls between half-spaces |
//! | `distinct_surfaces` | the distinct surfaces of these, the carriers |
//! | `arrangement` | the curves in which carriers intersect, and the points that split them |
//! | `carrier_intersections` | intersects the carriers, and builds the arrangement by the next three |
//! | `tangent_contacts` | moves a curve of contact onto a curve that runs next to it |
//! | `split_curves` | the common points of curves and carriers |
//! | `vertices` | equal points merged |
//! | `edge_candidates` | the pieces of curves between vertices |
//! | `membership` | whether a choice of sides is material, by the tree |
//! | `radial_order` | the order of carriers around a piece |
//! | `edge_classification` | which pieces are edges, and where their faces lie |
//! | `edge_joining` | consecutive pieces of a curve as one edge |
//! | `exact_coefficients` | in exact evaluation, surfaces with rational coefficients |
//! | `incidence_proof` | in exact evaluation, proofs of what passes through what |
//! | `close_calls` | the close calls of which it is not yet known whether they matter |
//! | `relevance` | the close calls on which the boundary depends |
//! | `face_verification` | every face checked against the tree |
//! | `evaluation` | the result |
//!
//! The kernel assembles edges to loops, faces, shells and solids.

mod arrangement;
mod carrier_intersections;
mod close_calls;
mod distinct_surfaces;
mod edge_candidates;
mod edge_classification;
mod edge_joining;
mod error;
mod evaluation;
mod exact_coefficients;
mod face_verification;
mod facets;
mod halfspaces;
mod incidence_proof;
mod incident_walls;
mod membership;
mod near_cylinders;
mod radial_order;
mod region;
mod relevance;
mod result_box;
mod section;
mod split_curves;
mod tangent_contacts;
mod vanished;
mod vertices;
mod walls;

pub use error::EvaluationError;
pub use evaluation::Evaluation;

use self::arrangement::Arrangement;
use self::carrier_intersections::Arranged;
use self::edge_candidates::EdgeCandidate;
use self::evaluation::Evaluated;
use self::halfspaces::HalfSpaceModel;
use self::membership::Membership;
use self::relevance::CloseCallFilter;
use self::result_box::size_below_vast;
use crate::tree::Tree;
use premio_kernel::brep::Brep;
use premio_kernel::brep::assemble::assemble;
use premio_kernel::brep::check::{check, worst_gap};
use premio_kernel::brep::face_integrals::{FaceIntegrals, Mass};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::region_of_interest::RegionOfInterest;
use premio_kernel::geometry::vector::rounded;
use premio_kernel::number::double_double::F106;
use premio_kernel::number::extended::F237;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{
    CloseCall, CoincidencePolicy, Compare, Predicates, RELATIVE_RESOLUTION,
};

/// How a tree is evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct EvaluationOptions {
    /// The resolution, a distance in the part's unit. The default is 1e-11 of the part's size, or
    /// more for a description with fewer digits.
    pub resolution: Option<f64>,
    /// The relative noise of the description's coordinates, if known.
    pub noise: Option<f64>,
    /// The coincidence policy.
    pub zeros: CoincidencePolicy,
    /// The arithmetic of the decisions.
    pub digits: Arithmetic,
    /// The maximum number of curves and points of curves, of some two thousand bytes each. The
    /// default is [`MAX_ENTITIES`].
    pub entity_limit: Option<usize>,
}

impl EvaluationOptions {
    /// Whether relations that the rounding of coordinates destroyed are recovered before the
    /// evaluation: unless a resolution is given, or only proven coincidences count.
    pub fn recovers(&self) -> bool {
        self.resolution.is_none() && self.zeros == CoincidencePolicy::ByResolution
    }
}

/// The arithmetic in which a tree is evaluated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Arithmetic {
    /// f64, and 106 or 237 bits where fewer are inconclusive.
    #[default]
    Filtered,
    /// 237 bits; no decision is made in f64.
    Extended,
}

/// The default limit on curves and points of curves between the surfaces of a part.
pub const MAX_ENTITIES: usize = 1 << 23;

/// The maximum numbers of primitives of a tree that is evaluated in 106 bits, and in 237 bits, if
/// fewer bits are inconclusive. That takes some ten times, and some hundred times, as long as f64.
const FEW_IN_106_BITS: usize = 1024;
const FEW_IN_237_BITS: usize = 64;

/// The maximum number of surfaces for each primitive of such a tree, on average.
const SIDES: usize = 6;

/// The maximum number of surfaces of a tree of which the measures are computed in 106 bits.
const FEW_TO_MEASURE: usize = 1024;

/// Whether a tree has at most so many primitives, and not many more surfaces.
fn is_small(tree: &Tree, few: usize) -> bool {
    tree.leaves().count() <= few && tree.side_count() <= SIDES * few
}

/// The boundary of the solid that a tree describes; empty for an empty solid.
///
/// It is evaluated in f64, and if f64 is inconclusive, with the same resolution in 106 bits, and at
/// last in 237 bits. Exact evaluation starts with 106 bits.
///
/// # Errors
/// The numbers, the distance from the origin, the resolution or the number of entities is beyond a
/// limit, or the part is not determined: surfaces nearly coincide or intersect in a way that is not
/// supported, or the computed boundary contradicts itself or the tree.
pub fn evaluate(tree: &Tree, options: &EvaluationOptions) -> Result<Evaluation, EvaluationError> {
    match (options.zeros, options.digits) {
        (CoincidencePolicy::Exact, Arithmetic::Filtered) => exact_evaluation(tree, options),
        (CoincidencePolicy::Exact, Arithmetic::Extended) => {
            let known = evaluated_at_finest::<F237>(tree, options)?;
            Ok(with_view_resolution(tree, options, known.into()))
        }
        (CoincidencePolicy::ByResolution, Arithmetic::Extended) => {
            let known = evaluated_in_more_bits::<F237>(tree, options)?;
            Ok(with_view_resolution(tree, options, known.into()))
        }
        (CoincidencePolicy::ByResolution, Arithmetic::Filtered) => by_resolution(tree, options),
    }
}

/// Evaluates in f64, and where that is inconclusive, in more and more bits.
fn by_resolution(tree: &Tree, options: &EvaluationOptions) -> Result<Evaluation, EvaluationError> {
    if let (None, Some(size)) = (options.resolution, size_below_vast(tree)) {
        return beside_vast_tools(tree, options, size);
    }
    let error = match evaluated::<f64>(tree, options) {
        Ok(mut known) => {
            known
                .decisions
                .close_calls
                .extend(vanished(tree, &known, options.noise));
            let fine = finer_measures(tree, options, &known);
            let known = Evaluation::from(known);
            return Ok(match fine {
                Some(fine) => known.measured_by(fine),
                None => known,
            });
        }
        Err(error) => error,
    };
    let error = match is_worth_more_bits(&error, tree, FEW_IN_106_BITS) {
        true => match evaluated_in_more_bits::<F106>(tree, options) {
            Ok(known) => return Ok(known.into()),
            Err(error) => error,
        },
        false => error,
    };
    match is_worth_more_bits(&error, tree, FEW_IN_237_BITS) {
        true => evaluated_in_more_bits::<F237>(tree, options).map(Evaluation::from),
        false => Err(error),
    }
}

/// Evaluates a part whose tools are far larger: with the resolution of the part, which f64 does not
/// have for them.
fn beside_vast_tools(
    tree: &Tree,
    options: &EvaluationOptions,
    size: f64,
) -> Result<Evaluation, EvaluationError> {
    if !is_small(tree, FEW_IN_106_BITS) {
        let far = HalfSpaceModel::<f64>::new(tree).bounds.diagonal();
        return Err(EvaluationError::TooFarFromOrigin { far, size });
    }
    let relative = RELATIVE_RESOLUTION.max(options.noise.unwrap_or(0.0));
    let fine = EvaluationOptions {
        resolution: Some(relative * size),
        ..*options
    };
    evaluated_in_more_bits::<F106>(tree, &fine).map(Evaluation::from)
}

/// The same boundary in 106 bits, where f64 gives its measures to less than the default resolution.
fn finer_measures(
    tree: &Tree,
    options: &EvaluationOptions,
    known: &Evaluated<f64>,
) -> Option<Evaluated<F106>> {
    let is_asked = known.measures.precision().is_beyond(RELATIVE_RESOLUTION)
        && tree.side_count() <= FEW_TO_MEASURE;
    let fine = is_asked.then(|| evaluated::<F106>(tree, options).ok())??;
    let census = known.brep.topology.census();
    (fine.brep.topology.census() == census).then_some(fine)
}

/// Evaluates with the finest resolution, and proves every coincidence. More bits are needed where a
/// proof fails, or where a point is not known well enough for one.
fn exact_evaluation(
    tree: &Tree,
    options: &EvaluationOptions,
) -> Result<Evaluation, EvaluationError> {
    let known = match evaluated_at_finest::<F106>(tree, options) {
        Ok(known) if known.decisions.coincident == 0 => known.into(),
        Ok(_) => evaluated_at_finest::<F237>(tree, options)?.into(),
        Err(error) if error.is_of_rounding() => evaluated_at_finest::<F237>(tree, options)?.into(),
        Err(error) => return Err(error),
    };
    Ok(with_view_resolution(tree, options, known))
}

/// Whether more bits may succeed on a tree, and do so in reasonable time.
fn is_worth_more_bits(error: &EvaluationError, tree: &Tree, few: usize) -> bool {
    error.is_of_rounding() && is_small(tree, few)
}

/// The close call because of which a part is empty in f64 but a solid in more bits.
fn vanished(tree: &Tree, known: &Evaluated<f64>, noise: Option<f64>) -> Option<CloseCall> {
    let is_asked = known.brep.topology.faces.is_empty()
        && known.decisions.coincident > 0
        && is_small(tree, FEW_IN_106_BITS);
    let mass = is_asked.then(|| fine_mass(tree).ok())??;
    let written = noise.unwrap_or(0.0) * known.bounds.diagonal();
    let noise = vanished::rounding(tree, &known.bounds).max(written);
    vanished::remainder(&mass, noise)
}

/// The mass properties with a resolution far below the precision of an f64.
fn fine_mass(tree: &Tree) -> Result<Mass, EvaluationError> {
    let size = HalfSpaceModel::<F106>::new(tree).bounds.diagonal();
    let options = EvaluationOptions {
        resolution: Some(BELOW_DOUBLES * f64::EPSILON * size),
        ..EvaluationOptions::default()
    };
    let fine = evaluated::<F106>(tree, &options)?;
    Ok(fine.measures.mass(&fine.brep))
}

/// The resolution at which the thickness of a part is measured, relative to the precision of an
/// f64.
const BELOW_DOUBLES: f64 = 1.0 / 16.0;

/// Evaluates with the resolution, and if that contradicts itself, with the finest one, unless a
/// resolution is requested.
fn evaluated_in_more_bits<N: Float>(
    tree: &Tree,
    options: &EvaluationOptions,
) -> Result<Evaluated<N>, EvaluationError> {
    match (evaluated::<N>(tree, options), options.resolution) {
        (Err(error), None) => evaluated_at_finest(tree, options).map_err(|_| error),
        (known, _) => known,
    }
}

/// The result of an evaluation in many bits. If f64 gives a boundary of the same kind, views can be
/// computed in f64.
fn with_view_resolution(
    tree: &Tree,
    options: &EvaluationOptions,
    mut known: Evaluation,
) -> Evaluation {
    let by_resolution = EvaluationOptions {
        zeros: CoincidencePolicy::ByResolution,
        ..*options
    };
    let in_f64 = evaluated::<f64>(tree, &by_resolution).ok();
    let alike =
        in_f64.filter(|in_f64| in_f64.brep.topology.census() == known.brep.topology.census());
    known.view_resolution = alike.map(|in_f64| in_f64.resolution);
    known
}

/// Evaluates with the finest resolution.
fn evaluated_at_finest<N: Float>(
    tree: &Tree,
    options: &EvaluationOptions,
) -> Result<Evaluated<N>, EvaluationError> {
    let size = HalfSpaceModel::<N>::new(tree).bounds.diagonal();
    let finest = EvaluationOptions {
        resolution: Some(N::FINEST_RESOLUTION * size),
        ..*options
    };
    evaluated::<N>(tree, &finest)
}

/// Evaluates in one precision, with the resolution that the options give.
fn evaluated<N: Float>(
    tree: &Tree,
    options: &EvaluationOptions,
) -> Result<Evaluated<N>, EvaluationError> {
    if tree.is_empty() {
        return Ok(Evaluated::empty());
    }
    let solids = HalfSpaceModel::new(tree);
    let size = solids.bounds.diagonal();
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
        Some(tree) => (tree, HalfSpaceModel::new(tree)),
        None => (tree, solids),
    };
    let extent = RegionOfInterest {
        centre: solids.bounds.centre().map(N::from_f64),
        radius: N::from_f64(0.75 * size),
    };
    near_cylinders::check(&solids, &extent, &predicates)?;
    let most = options.entity_limit.unwrap_or(MAX_ENTITIES);
    let generated = generated(tree, &solids, &extent, &predicates, most)?;
    let classified = classified(tree, &solids, generated, &predicates)?;
    Ok(Evaluated {
        brep: classified.brep,
        measures: classified.measures,
        decisions: predicates.decisions(),
        resolution,
        bounds: solids.bounds,
    })
}

/// The arrangement of a tree's carriers, and the pieces of its curves.
struct Generated<N: Float> {
    arrangement: Arrangement<N>,
    pieces: Vec<EdgeCandidate<N>>,
}

/// Generates the edge candidates. In exact evaluation every coincidence among them is proven.
fn generated<N: Float>(
    tree: &Tree,
    solids: &HalfSpaceModel<N>,
    extent: &RegionOfInterest<N>,
    predicates: &Predicates,
    most: usize,
) -> Result<Generated<N>, EvaluationError> {
    let Arranged {
        arrangement,
        sources,
    } = carrier_intersections::arrange(tree, solids, extent, predicates, most)?;
    let pieces = edge_candidates::pieces(&arrangement, predicates);
    if predicates.is_exact() {
        incidence_proof::prove(&arrangement, &pieces, &sources, predicates)?;
        if let Some(doubt) = predicates.first_unproven() {
            let (question, place) = (doubt.question, doubt.place);
            return Err(EvaluationError::UnprovenCoincidence { question, place });
        }
    }
    Ok(Generated {
        arrangement,
        pieces,
    })
}

/// A boundary that keeps all rules and agrees with the tree, and its integrals.
struct Classified<N: Float> {
    brep: Brep<N>,
    measures: FaceIntegrals<N>,
}

/// Classifies the edge candidates, assembles the edges among them, and checks the boundary.
fn classified<N: Float>(
    tree: &Tree,
    solids: &HalfSpaceModel<N>,
    generated: Generated<N>,
    predicates: &Predicates,
) -> Result<Classified<N>, EvaluationError> {
    let concern = CloseCallFilter {
        solids,
        arrangement: &generated.arrangement,
        membership: &Membership::new(tree),
        predicates,
    };
    concern.list();
    vanished::list(tree, predicates);
    let raw = edge_classification::boundary(&concern, generated.pieces)?;
    let brep = assemble(raw, predicates)?;
    let measures = FaceIntegrals::new(&brep);
    check_rules(&brep, &measures, predicates)?;
    match concern.contradiction(&brep) {
        Some(place) => Err(EvaluationError::Contradiction { place }),
        None => Ok(Classified { brep, measures }),
    }
}

/// Refuses a boundary that breaks a rule.
fn check_rules<N: Float>(
    brep: &Brep<N>,
    measures: &FaceIntegrals<N>,
    predicates: &Predicates,
) -> Result<(), EvaluationError> {
    let resolution = predicates.resolution();
    let Some(broken) = check(brep, measures, resolution).into_iter().next() else {
        return Ok(());
    };
    Err(match worst_gap(brep, resolution) {
        Some(gap) => EvaluationError::IllConditioned {
            place: rounded(&gap.place),
            distance: gap.distance.rounded(),
            resolution: predicates.resolution(),
        },
        None => EvaluationError::InvalidBoundary(broken),
    })
}

/// The requested resolution, or the default. The default is coarser if the part is so far from the
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

/// The coarsest resolution, relative to the part's size.
const COARSEST: f64 = 0.01;

/// The greatest rounding of coordinates, relative to the part's size.
const FARTHEST: f64 = 1.0 / (1 << 20) as f64;

/// The product of six lengths is within the range of f64, and so is its reciprocal.
const LARGEST: f64 = 1e50;
