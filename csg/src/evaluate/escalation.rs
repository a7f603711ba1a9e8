//! Evaluates a component in f64, and in more bits where fewer are inconclusive.

use super::evaluation::{Evaluated, Evaluation};
use super::halfspaces::HalfSpaceModel;
use super::settings::Settings;
use super::{Arithmetic, EvaluationError, evaluated, fine_facets, vanished};
use crate::tree::Tree;
use premio_kernel::brep::face_integrals::Mass;
use premio_kernel::number::double_double::F106;
use premio_kernel::number::extended::F237;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{
    CloseCall, CoincidencePolicy, Compare, RELATIVE_RESOLUTION,
};

/// The maximum numbers of primitives of a component that is evaluated in 106 bits, and in 237 bits,
/// if fewer bits are inconclusive. That takes some ten times, and some hundred times, as long as
/// f64.
const MAX_PRIMITIVES_IN_106_BITS: usize = 1024;
const MAX_PRIMITIVES_IN_237_BITS: usize = 64;

/// The maximum number of surfaces for each primitive of such a component, on average.
const MAX_SIDES_PER_PRIMITIVE: usize = 6;

/// The maximum number of surfaces of a component of which the measures are computed in 106 bits.
const MAX_SIDES_TO_MEASURE: usize = 1024;

/// Whether a tree has at most `max_primitives`, and not many more surfaces.
fn is_small(tree: &Tree, max_primitives: usize) -> bool {
    tree.leaves().count() <= max_primitives
        && tree.side_count() <= MAX_SIDES_PER_PRIMITIVE * max_primitives
}

/// The boundary of a component, in the arithmetic that it needs. `has_vast_tools` says
/// whether its primitives are far larger than its result.
pub(super) fn evaluate_component(
    tree: &Tree,
    has_vast_tools: bool,
    settings: &Settings,
) -> Result<Evaluation, EvaluationError> {
    match (settings.zeros, settings.digits) {
        (CoincidencePolicy::Exact, Arithmetic::Filtered) => exact_evaluation(tree, settings),
        (CoincidencePolicy::Exact, Arithmetic::Extended) => {
            let known = evaluated_at_finest::<F237>(tree, settings)?;
            Ok(with_view_resolution(tree, settings, known.into()))
        }
        (CoincidencePolicy::ByResolution, Arithmetic::Extended) => {
            let known = evaluated_in_more_bits::<F237>(tree, settings)?;
            Ok(with_view_resolution(tree, settings, known.into()))
        }
        (CoincidencePolicy::ByResolution, Arithmetic::Filtered) => {
            match has_vast_tools && settings.requested.is_none() {
                true => with_resolution_of_part(tree, settings),
                false => by_resolution(tree, settings),
            }
        }
    }
}

/// Evaluates in f64, and where that is inconclusive, in more and more bits.
fn by_resolution(tree: &Tree, settings: &Settings) -> Result<Evaluation, EvaluationError> {
    let noiseless = settings.without_noise();
    // Merging within the noise contradicts itself where surfaces meet at small angles.
    let [first, second] = match is_finer_than_noise(tree, settings) {
        true => [&noiseless, settings],
        false => [settings, &noiseless],
    };
    let error = match in_f64(tree, first) {
        Err(error) if error.is_of_rounding() => error,
        known => return known,
    };
    let is_noisy = settings.noise.is_above_zero();
    if let Some(Ok(known)) = is_noisy.then(|| in_f64(tree, second)) {
        return Ok(known);
    }
    let settings = &noiseless;
    let error = match may_succeed_in_more_bits(&error, tree, MAX_PRIMITIVES_IN_106_BITS) {
        true => match evaluated_in_more_bits::<F106>(tree, settings) {
            Ok(known) => return Ok(known.into()),
            Err(error) => error,
        },
        false => error,
    };
    match may_succeed_in_more_bits(&error, tree, MAX_PRIMITIVES_IN_237_BITS) {
        true => evaluated_in_more_bits::<F237>(tree, settings).map(Evaluation::from),
        false => Err(error),
    }
}

/// Whether the facets of a polyhedron are closer to each other than the noise of the coordinates.
fn is_finer_than_noise(tree: &Tree, settings: &Settings) -> bool {
    let noise = settings.noise * settings.size;
    noise.is_above_zero() && settings.requested.is_none() && fine_facets::are_within(tree, noise)
}

/// Evaluates in f64.
fn in_f64(tree: &Tree, settings: &Settings) -> Result<Evaluation, EvaluationError> {
    let mut known = evaluated::<f64>(tree, settings)?;
    let remainder = remainder(tree, &known, settings);
    known.decisions.close_calls.extend(remainder);
    let fine = finer_measures(tree, settings, &known);
    let known = Evaluation::from(known);
    Ok(match fine {
        Some(fine) => known.measured_by(fine),
        None => known,
    })
}

/// Evaluates a component whose tools are far larger: with the resolution of the part, which f64
/// does not have for them.
fn with_resolution_of_part(
    tree: &Tree,
    settings: &Settings,
) -> Result<Evaluation, EvaluationError> {
    if !is_small(tree, MAX_PRIMITIVES_IN_106_BITS) {
        let far = HalfSpaceModel::<f64>::new(tree).bounds.diagonal();
        let size = settings.size;
        return Err(EvaluationError::TooFarFromOrigin { far, size });
    }
    let fine = settings.with_resolution(settings.default_resolution());
    evaluated_in_more_bits::<F106>(tree, &fine).map(Evaluation::from)
}

/// The same boundary in 106 bits, where f64 gives its measures to less than the default resolution.
fn finer_measures(
    tree: &Tree,
    settings: &Settings,
    known: &Evaluated<f64>,
) -> Option<Evaluated<F106>> {
    let is_needed = known.measures.precision().is_beyond(RELATIVE_RESOLUTION)
        && tree.side_count() <= MAX_SIDES_TO_MEASURE;
    let fine = is_needed.then(|| evaluated::<F106>(tree, settings).ok())??;
    let census = known.brep.topology.census();
    (fine.brep.topology.census() == census).then_some(fine)
}

/// Evaluates with the finest resolution, and proves every coincidence. More bits are needed where a
/// proof fails, or where a point is not known well enough for one.
fn exact_evaluation(tree: &Tree, settings: &Settings) -> Result<Evaluation, EvaluationError> {
    let known = match evaluated_at_finest::<F106>(tree, settings) {
        Ok(known) if known.decisions.coincident == 0 => known.into(),
        Ok(_) => evaluated_at_finest::<F237>(tree, settings)?.into(),
        Err(error) if error.is_of_rounding() => evaluated_at_finest::<F237>(tree, settings)?.into(),
        Err(error) => return Err(error),
    };
    Ok(with_view_resolution(tree, settings, known))
}

/// Whether more bits may succeed on a tree, and do so in reasonable time.
fn may_succeed_in_more_bits(error: &EvaluationError, tree: &Tree, max_primitives: usize) -> bool {
    error.is_of_rounding() && is_small(tree, max_primitives)
}

/// The close call because of which a component is empty in f64 but a solid in more bits.
fn remainder(tree: &Tree, known: &Evaluated<f64>, settings: &Settings) -> Option<CloseCall> {
    let is_needed = known.brep.topology.faces.is_empty()
        && known.decisions.coincident > 0
        && is_small(tree, MAX_PRIMITIVES_IN_106_BITS);
    let mass = is_needed.then(|| fine_mass(tree, settings).ok())??;
    let written = settings.noise * settings.size;
    let noise = vanished::rounding(tree, &known.bounds).max(written);
    vanished::remainder(&mass, noise)
}

/// The mass properties with a resolution far below the precision of an f64.
fn fine_mass(tree: &Tree, settings: &Settings) -> Result<Mass, EvaluationError> {
    let size = HalfSpaceModel::<F106>::new(tree).bounds.diagonal();
    let fine = settings.with_resolution(BELOW_DOUBLES * f64::EPSILON * size);
    let fine = evaluated::<F106>(tree, &fine)?;
    Ok(fine.measures.mass(&fine.brep))
}

/// The resolution at which the thickness of a part is measured, relative to the precision of an
/// f64.
const BELOW_DOUBLES: f64 = 1.0 / 16.0;

/// Evaluates with the resolution, and if that contradicts itself, with the finest one, unless a
/// resolution is requested.
fn evaluated_in_more_bits<N: Float>(
    tree: &Tree,
    settings: &Settings,
) -> Result<Evaluated<N>, EvaluationError> {
    match (evaluated::<N>(tree, settings), settings.requested) {
        (Err(error), None) => evaluated_at_finest(tree, settings).map_err(|_| error),
        (known, _) => known,
    }
}

/// The result of an evaluation in many bits. If f64 gives a boundary of the same kind, views can be
/// computed in f64.
fn with_view_resolution(tree: &Tree, settings: &Settings, mut known: Evaluation) -> Evaluation {
    let by_resolution = Settings {
        zeros: CoincidencePolicy::ByResolution,
        ..*settings
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
    settings: &Settings,
) -> Result<Evaluated<N>, EvaluationError> {
    let size = HalfSpaceModel::<N>::new(tree).bounds.diagonal();
    evaluated::<N>(tree, &settings.with_resolution(N::FINEST_RESOLUTION * size))
}
