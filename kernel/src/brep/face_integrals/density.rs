//! The integrand over a face, and the parameters from which its integrals start.

use super::closed_form::over_ranges;
use super::ground::{Between, Ground};
use super::{Amid, Moments};
use crate::brep::Brep;
use crate::brep::topology::CoedgeId;
use crate::geometry::bounds;
use crate::geometry::surface::Surface;
use crate::number::float::Float;
use crate::number::quadrature::adaptive;
use nalgebra::Point3;
use std::cell::Cell;

/// The data for integration over a face.
pub(super) struct Density<'a, N: Float = f64> {
    pub ground: Ground<N>,
    /// The surface rounded to f64, where f64 may be accurate enough.
    pub rounded_f64: Option<Ground>,
    pub amid: &'a Amid<N>,
    /// The errors that may be ignored.
    pub floor: Moments<N>,
    /// The largest defect of a loop's closure so far: ∮ du less a whole number of turns, relative to
    /// the part's size on a plane.
    pub defect: Cell<N>,
}

impl<N: Float> Density<'_, N> {
    /// Notes ∮ du over a loop with this winding number.
    pub fn note_closure(&self, way: N, turns: N) {
        let defect = match &self.ground.surface {
            Surface::Plane(_) => way / self.amid.size,
            _ => way - N::TAU * turns,
        };
        self.defect.set(self.defect.get().max(defect.abs()));
    }

    /// Whether a loop may pass through a cone's apex. There u jumps, so ∮ du is no whole number of turns
    /// and there may be nothing amid the edges; G is zero if it starts at the apex.
    pub fn may_jump(&self, brep: &Brep<N>, coedges: &[CoedgeId]) -> bool {
        match &self.ground.surface {
            cone @ (Surface::Cone(_) | Surface::EllipticCone(_)) => {
                reaches(brep, coedges, &cone.frame().origin)
            }
            _ => false,
        }
    }

    /// The integral over the whole surface between two v.
    pub fn between(&self, from: N, to: N) -> Moments<N> {
        self.over([N::ZERO, N::TAU], [from, to])
    }

    /// The integral over a range of u and of v.
    pub fn over(&self, [a, b]: [N; 2], range: [N; 2]) -> Moments<N> {
        if let Some(moments) = over_ranges(&self.ground, [a, b], range) {
            return moments;
        }
        let between = Between {
            ground: &self.ground,
            range,
            rounded_f64: self.rounded_f64.as_ref(),
        };
        adaptive(a, b, &self.floor, &between)
    }
}

/// Whether edges may pass through a point.
fn reaches<N: Float>(brep: &Brep<N>, coedges: &[CoedgeId], p: &Point3<N>) -> bool {
    coedges.iter().any(|&c| {
        let e = brep.topology.coedge(c).edge;
        let around = bounds::bounds(brep.curve(e), brep.range(e));
        around.grown(around.diagonal()).contains(p)
    })
}

/// A v amid the edges of a face, so that what they have in common need not cancel.
pub(super) fn amid_edges<N: Float>(brep: &Brep<N>, ground: &Ground<N>, coedges: &[CoedgeId]) -> N {
    let middle = |&c: &CoedgeId| {
        let e = brep.topology.coedge(c).edge;
        let [lo, hi] = brep.range(e);
        let [_, v] = ground.parameters(&brep.curve(e).point(N::HALF * (lo + hi)));
        v
    };
    match coedges.len() {
        0 => ground.base,
        n => coedges.iter().map(middle).sum::<N>() / N::from_f64(n as f64),
    }
}

/// The sum of two moments.
pub(super) fn add<N: Float>(a: Moments<N>, b: Moments<N>) -> Moments<N> {
    std::array::from_fn(|i| a[i] + b[i])
}
