//! The result of an evaluation, and the numbers from which it was computed.

use premio_kernel::brep::Brep;
use premio_kernel::brep::bounding_box::bounds;
use premio_kernel::brep::check::{Violation, check, check_integrals, worst_gap};
use premio_kernel::brep::face_integrals::{FaceIntegrals, Mass};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::number::double_double::F106;
use premio_kernel::number::extended::F237;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{
    Compare, DecisionStats, GREATEST_ROUNDING_GAP, Predicates, RELATIVE_RESOLUTION, ROUNDING,
};
use std::sync::OnceLock;

/// The boundary of a tree, with the statistics of its decisions.
#[derive(Debug)]
pub struct Evaluation {
    /// The boundary.
    pub brep: Brep,
    /// How the decisions were made.
    pub decisions: DecisionStats,
    /// The resolution used, in the part's unit.
    pub resolution: f64,
    /// A box that contains the part.
    pub bounds: Aabb,
    /// The integrals from which the mass properties are computed.
    integrals: Integrals,
    /// The resolution at which f64 gives the same boundary, if it does.
    pub(super) view_resolution: Option<f64>,
    /// The greatest distance of an edge from a face or a vertex, if the rounding to f64 makes it larger
    /// than merging does.
    rounding_gap: f64,
    /// Computed on the first request: in extended precision it takes longer than the boundary.
    mass: OnceLock<Mass>,
}

/// The numbers from which a boundary was computed.
#[derive(Debug)]
enum Integrals {
    /// f64 values.
    Doubles(FaceIntegrals),
    /// 106 bits: the boundary before it was rounded.
    DoubleDoubles(Box<WideBoundary<F106>>),
    /// 237 bits: the same.
    Extended(Box<WideBoundary<F237>>),
    /// Components that were evaluated by themselves.
    Components(Vec<Evaluation>),
}

/// A boundary in more bits than those of f64, and its integrals.
#[derive(Debug)]
struct WideBoundary<N: Float> {
    brep: Brep<N>,
    measures: FaceIntegrals<N>,
}

impl<N: Float> WideBoundary<N> {
    fn violations(&self, resolution: f64) -> Vec<Violation> {
        all_violations(&self.brep, &self.measures, resolution)
    }
}

/// Why a boundary that is known in more bits than f64 has no view.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum ViewLimit {
    /// Views cannot separate the two sides of the part.
    #[error(
        "the part is {thickness:.3e} thick on average, and views resolve {resolution:.3e}: the boundary \
         is known, but it has no view"
    )]
    Thin {
        /// Twice the volume over the area.
        thickness: f64,
        /// The resolution of views.
        resolution: f64,
    },
    /// Rounding to f64 moves an edge too far off its faces.
    #[error(
        "an edge is {gap:.3e} off its faces when it is rounded to f64: the boundary is known, but it has \
         no view"
    )]
    Rounded {
        /// The distance of the edge from its faces.
        gap: f64,
    },
}

impl Evaluation {
    /// The resolution for views of the boundary, which are computed in f64. `None` if f64 does not
    /// give this boundary: surfaces rounded to f64 may coincide although the exact ones do not.
    pub fn view_resolution(&self) -> Option<f64> {
        self.view_resolution
    }

    /// The resolution for views where f64 does not give this boundary: the default one. Such a view
    /// has to be confirmed.
    pub fn rounded_view_resolution(&self) -> f64 {
        self.resolution
            .max(self.rounding_gap)
            .max(RELATIVE_RESOLUTION * self.bounds.diagonal())
    }

    /// The mean thickness of the part, of its thinnest body where bodies are apart: twice the volume over
    /// the area.
    pub fn mean_thickness(&self) -> f64 {
        match &self.integrals {
            Integrals::Components(bodies) => {
                let each = bodies.iter().map(Self::mean_thickness);
                each.fold(f64::INFINITY, f64::min)
            }
            _ => {
                let Mass { volume, area, .. } = self.mass();
                2.0 * volume / area
            }
        }
    }

    /// Why the boundary rounded to f64 has no view, if it has none.
    pub fn view_limit(&self) -> Option<ViewLimit> {
        if self.view_resolution.is_some() {
            return None;
        }
        let gap = self.rounding_gap;
        if !gap.is_within(GREATEST_ROUNDING_GAP * self.bounds.diagonal()) {
            return Some(ViewLimit::Rounded { gap });
        }
        let (thickness, resolution) = (self.mean_thickness(), self.rounded_view_resolution());
        thickness
            .is_short_of(resolution)
            .then_some(ViewLimit::Thin {
                thickness,
                resolution,
            })
    }

    /// The resolution that f64 supports for the boundary, however finely it was evaluated.
    pub fn f64_resolution(&self) -> f64 {
        let known = self.view_resolution.unwrap_or(self.resolution);
        known
            .max(self.rounding_gap)
            .max(ROUNDING * self.bounds.diagonal())
    }

    /// The greatest distance between entities that coincide by the resolution; zero if none of them
    /// was a close call.
    pub fn greatest_coincidence(&self) -> f64 {
        let distances = self.decisions.close_calls.iter().map(|c| c.distance.abs());
        let coincident = distances.filter(|d| d.is_within(self.resolution));
        coincident.fold(0.0, f64::max)
    }

    /// The boundary of components that are apart. The resolution is the coarsest of theirs.
    pub(super) fn joined(components: Vec<Self>) -> Self {
        let mut brep = Brep::default();
        let mut decisions = DecisionStats::default();
        for component in &components {
            brep.append(&component.brep);
            decisions.add(&component.decisions);
        }
        let coarsest = |of: fn(&Self) -> Option<f64>| -> Option<f64> {
            let all: Option<Vec<f64>> = components.iter().map(of).collect();
            Some(all?.into_iter().fold(0.0, f64::max))
        };
        let boxes = components.iter().map(|known| known.bounds);
        Self {
            brep,
            decisions,
            resolution: coarsest(|known| Some(known.resolution)).unwrap_or_default(),
            bounds: boxes.fold(Aabb::EMPTY, |all, own| all.hull(&own)),
            view_resolution: coarsest(|known| known.view_resolution),
            rounding_gap: coarsest(|known| Some(known.rounding_gap)).unwrap_or_default(),
            mass: OnceLock::new(),
            integrals: Integrals::Components(components),
        }
    }

    /// The same boundary with the measures of an evaluation in more bits.
    pub(super) fn measured_by(self, fine: Evaluated<F106>) -> Self {
        Self {
            integrals: Self::from(fine).integrals,
            ..self
        }
    }

    /// The volume, the area and the centroid.
    pub fn mass(&self) -> Mass {
        *self.mass.get_or_init(|| match &self.integrals {
            Integrals::Doubles(measures) => measures.mass(&self.brep),
            Integrals::DoubleDoubles(wide) => wide.measures.mass(&wide.brep),
            Integrals::Extended(wide) => wide.measures.mass(&wide.brep),
            Integrals::Components(all) => {
                Mass::sum(&all.iter().map(Self::mass).collect::<Vec<_>>())
            }
        })
    }

    /// The bounding box of the boundary, to rounding.
    pub fn tight_bounds(&self) -> Aabb {
        match &self.integrals {
            Integrals::Doubles(_) => bounds(&self.brep),
            Integrals::DoubleDoubles(wide) => bounds(&wide.brep),
            Integrals::Extended(wide) => bounds(&wide.brep),
            Integrals::Components(all) => {
                let boxes = all.iter().map(Self::tight_bounds);
                boxes.fold(Aabb::EMPTY, |all, own| all.hull(&own))
            }
        }
    }

    /// The rules that the boundary breaks, among them that the integrals over its faces do not depend on
    /// how they are computed.
    pub fn violations(&self) -> Vec<Violation> {
        match &self.integrals {
            Integrals::Doubles(measures) => all_violations(&self.brep, measures, self.resolution),
            Integrals::DoubleDoubles(wide) => wide.violations(self.resolution),
            Integrals::Extended(wide) => wide.violations(self.resolution),
            Integrals::Components(all) => {
                let mut found = Vec::new();
                let mut joined = Brep::default();
                for component in all {
                    let ids = joined.append(&component.brep);
                    let own = component.violations();
                    found.extend(own.into_iter().map(|violation| violation.renumbered(&ids)));
                }
                found
            }
        }
    }
}

/// The rules that a boundary and its integrals break.
fn all_violations<N: Float>(
    brep: &Brep<N>,
    measures: &FaceIntegrals<N>,
    resolution: f64,
) -> Vec<Violation> {
    let mut found = check(brep, measures, N::from_f64(resolution));
    found.extend(check_integrals(brep, measures));
    found
}

/// An evaluation in one precision.
pub(super) struct Evaluated<N: Float> {
    pub brep: Brep<N>,
    pub measures: FaceIntegrals<N>,
    pub decisions: DecisionStats,
    pub resolution: f64,
    pub bounds: Aabb,
}

impl<N: Float> Evaluated<N> {
    /// The evaluation of the empty tree.
    pub fn empty() -> Self {
        let brep = Brep::default();
        Self {
            measures: FaceIntegrals::new(&brep),
            brep,
            decisions: Predicates::new(0.0).decisions(),
            resolution: 0.0,
            bounds: Aabb::EMPTY,
        }
    }
}

impl From<Evaluated<f64>> for Evaluation {
    fn from(known: Evaluated<f64>) -> Self {
        Self {
            brep: known.brep,
            decisions: known.decisions,
            resolution: known.resolution,
            bounds: known.bounds,
            integrals: Integrals::Doubles(known.measures),
            view_resolution: Some(known.resolution),
            rounding_gap: 0.0,
            mass: OnceLock::new(),
        }
    }
}

impl From<Evaluated<F106>> for Evaluation {
    fn from(known: Evaluated<F106>) -> Self {
        known.into_evaluation(Integrals::DoubleDoubles)
    }
}

impl From<Evaluated<F237>> for Evaluation {
    fn from(known: Evaluated<F237>) -> Self {
        known.into_evaluation(Integrals::Extended)
    }
}

impl<N: Float> Evaluated<N> {
    /// The evaluation in more bits than those of f64.
    fn into_evaluation(self, keep: impl Fn(Box<WideBoundary<N>>) -> Integrals) -> Evaluation {
        let mut decisions = self.decisions;
        // All of them took more bits than f64 has.
        decisions.refined += std::mem::take(&mut decisions.filtered);
        let brep = self.brep.to_f64();
        let gap = worst_gap(&brep, self.resolution);
        Evaluation {
            brep,
            decisions,
            resolution: self.resolution,
            bounds: self.bounds,
            integrals: keep(Box::new(WideBoundary {
                brep: self.brep,
                measures: self.measures,
            })),
            view_resolution: None,
            rounding_gap: gap.map_or(0.0, |gap| gap.distance),
            mass: OnceLock::new(),
        }
    }
}
