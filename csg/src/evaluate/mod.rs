//! The boundary of a tree: generate and classify (Requicha and Voelcker 1985).
//!
//! The stages, in order:
//!
//! | module | what it gives |
//! | --- | --- |
//! | `settings` | what the options mean for the part |
//! | `result_boxes` | boxes around the results of the tree's nodes |
//! | `components` | the components that are apart; each passes the stages below separately |
//! | `escalation` | f64, and more bits where fewer are inconclusive |
//! | `fine_facets` | finds polyhedra whose facets are closer than the noise of the coordinates |
//! | `near_cylinders` | refuses frustums that are nearly cylinders |
//! | `vanished` | drops primitives thinner than the resolution |
//! | `walls` | the surfaces that the edges of a figure sweep |
//! | `section` | which walls of a prism or revolution pass through a point, and where they end |
//! | `facets` | the same of a polyhedron |
//! | `region` | one of these two |
//! | `halfspaces` | every primitive as half-spaces, or as walls between half-spaces |
//! | `face_hulls` | convex polyhedra around faces, where boxes are too wide |
//! | `distinct_surfaces` | the distinct surfaces of these, the carriers |
//! | `arrangement` | the curves in which carriers intersect, and the points that split them |
//! | `carrier_intersections` | intersects the carriers, and builds the arrangement by the next three |
//! | `facet_joints` | the corners and edges of polyhedra, which are known from the start |
//! | `wall_joints` | moves a curve of contact to the end of the walls that meet there |
//! | `tangent_contacts` | moves a curve of contact onto a curve that runs next to it |
//! | `culling` | leaves out the parts of curves near which membership is constant |
//! | `split_curves` | the common points of curves and carriers |
//! | `vertices` | equal points merged |
//! | `vertex_incidence` | adds every corner to all curves through it |
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
//! | `face_colours` | the colours of its faces, by the primitives on which they lie |
//!
//! The kernel assembles edges to loops, faces, shells and solids.

mod arrangement;
mod carrier_intersections;
mod close_calls;
mod components;
mod culling;
mod distinct_surfaces;
mod edge_candidates;
mod edge_classification;
mod edge_joining;
mod ellipsoid_side;
mod error;
mod escalation;
mod evaluation;
mod exact_coefficients;
mod face_colours;
mod face_hulls;
mod face_verification;
mod facet_joints;
mod facets;
mod fine_facets;
mod halfspaces;
mod incidence_proof;
mod incident_walls;
mod membership;
mod near_cylinders;
mod oblique_sides;
mod radial_order;
mod region;
mod relevance;
mod result_boxes;
mod section;
mod settings;
mod split_curves;
mod tangent_contacts;
mod vanished;
mod vertex_incidence;
mod vertices;
mod wall_joints;
mod walls;

pub use error::EvaluationError;
pub use evaluation::{Evaluation, ViewLimit};
pub use face_colours::face_colours;

use self::arrangement::Arrangement;
use self::carrier_intersections::Arranged;
use self::components::components;
use self::edge_candidates::EdgeCandidate;
use self::escalation::evaluate_component;
use self::evaluation::Evaluated;
use self::halfspaces::HalfSpaceModel;
use self::membership::Membership;
use self::relevance::CloseCallFilter;
use self::result_boxes::ResultBoxes;
use self::settings::Settings;
use crate::primitive::Primitive;
use crate::tree::Tree;
use premio_kernel::brep::Brep;
use premio_kernel::brep::assemble::assemble;
use premio_kernel::brep::check::{check, worst_gap};
use premio_kernel::brep::face_integrals::FaceIntegrals;
use premio_kernel::concurrency;
use premio_kernel::geometry::region_of_interest::RegionOfInterest;
use premio_kernel::geometry::vector::rounded;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{CoincidencePolicy, Compare, Predicates};
use premio_kernel::number::rational::to_f64;

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
    /// The maximum number of curves and points of curves of a component, of some two thousand bytes
    /// each. The default is [`MAX_ENTITIES`].
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

/// The default limit on curves and points of curves between the surfaces of a component.
pub const MAX_ENTITIES: usize = 1 << 23;

/// The boundary of the solid that a tree describes; empty for an empty solid.
///
/// Components whose boxes are apart are evaluated separately, in parallel if the part is large. Each
/// is evaluated in f64, and if f64 is inconclusive, with the same resolution in 106 bits, and at
/// last in 237 bits. Exact evaluation starts with 106 bits.
///
/// # Errors
/// The numbers, the distance from the origin, the resolution or the number of entities is beyond a
/// limit, or the part is not determined: surfaces nearly coincide or intersect in a way that is not
/// supported, or the computed boundary contradicts itself or the tree.
pub fn evaluate(tree: &Tree, options: &EvaluationOptions) -> Result<Evaluation, EvaluationError> {
    let boxes = ResultBoxes::new(tree);
    let (whole, vast) = (boxes.primitives.diagonal(), boxes.size_below_vast());
    if !tree.is_empty() && !whole.lies_between([1.0 / MAX_SIZE, MAX_SIZE]) {
        return Err(EvaluationError::Size);
    }
    let settings = Settings::new(options, vast.unwrap_or(whole));
    let trees = settings.gap().and_then(|gap| components(tree, &boxes, gap));
    let known = match trees {
        Some(trees) => separately(&trees, &settings).map(Evaluation::joined),
        None => evaluate_component(tree, vast.is_some(), &settings),
    };
    known.map_err(|error| match error.is_of_rounding() {
        true => self_intersection(tree).unwrap_or(error),
        false => error,
    })
}

/// The error of a polyhedron whose faces cross each other, if there is one.
fn self_intersection(tree: &Tree) -> Option<EvaluationError> {
    tree.leaves().find_map(|(_, placed)| {
        let Primitive::Polyhedron { polyhedron } = &placed.primitive else {
            return None;
        };
        let place = placed.motion.apply_point(&polyhedron.crossing()?);
        let place = place.each_ref().map(to_f64);
        Some(EvaluationError::SelfIntersection { place })
    })
}

/// The number of surfaces from which the components of a part have threads of their own.
const MIN_SIDES_FOR_THREADS: usize = 256;

/// The share of the entities that a component may have while others are evaluated.
const ENTITY_SHARES: usize = 64;

/// The boundaries of components. Several at a time have a share of the entities each; those that
/// need more follow one by one.
fn separately(trees: &[Tree], settings: &Settings) -> Result<Vec<Evaluation>, EvaluationError> {
    let evaluate = |tree: &Tree, settings: &Settings| {
        let vast = ResultBoxes::new(tree).size_below_vast();
        evaluate_component(tree, vast.is_some(), settings)
    };
    let sides = || trees.iter().map(Tree::side_count);
    let largest = sides().max().unwrap_or(0);
    // The work on a component that is most of the part is divided itself.
    if sides().sum::<usize>() < MIN_SIDES_FOR_THREADS.max(2 * largest) {
        return trees.iter().map(|tree| evaluate(tree, settings)).collect();
    }
    let share = Settings {
        entity_limit: settings.entity_limit / ENTITY_SHARES,
        ..*settings
    };
    let first = concurrency::map(trees, 1, |tree| evaluate(tree, &share));
    let known = first
        .into_iter()
        .zip(trees)
        .map(|(known, tree)| match known {
            Err(EvaluationError::EntityLimit { .. }) => evaluate(tree, settings),
            known => known,
        });
    known.collect()
}

/// Evaluates in one precision, with the resolution that the options give.
fn evaluated<N: Float>(tree: &Tree, settings: &Settings) -> Result<Evaluated<N>, EvaluationError> {
    if tree.is_empty() {
        return Ok(Evaluated::empty());
    }
    let solids = HalfSpaceModel::new(tree);
    let size = solids.bounds.diagonal();
    let resolution = settings.resolution::<N>(&solids.bounds)?;
    let predicates = match settings.zeros {
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
    let generated = generated(tree, &solids, &extent, &predicates, settings.entity_limit)?;
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

/// The product of six lengths is within the range of f64, and so is its reciprocal.
const MAX_SIZE: f64 = 1e50;
