//! The carriers: the distinct surfaces of all half spaces.

use super::exact_coefficients::coefficients;
use super::halfspaces::{HalfSpace, HalfSpaceModel};
use crate::tree::{PlacedPrimitive, Tree};
use premio_kernel::brep::topology::Sense;
use premio_kernel::geometry::intersect::coincidence;
use premio_kernel::geometry::region_of_interest::RegionOfInterest;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::surface_pair::{Carrier, Coefficients};
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};
use premio_kernel::number::rational::Rational;

/// The half space for which a carrier was first created; its exact coefficients are the carrier's.
#[derive(Clone, Copy, Debug)]
pub(super) struct Source<'t> {
    placed: &'t PlacedPrimitive,
    side: usize,
}

impl Source<'_> {
    /// The carrier's exact coefficients.
    pub fn exact(&self) -> Coefficients<Rational> {
        coefficients(self.placed, self.side)
    }
}

/// All half spaces' surfaces, equal ones merged.
pub(super) struct Merged<'t, N: Float = f64> {
    /// The distinct surfaces.
    pub carriers: Vec<Surface<N>>,
    /// The source of each carrier.
    pub sources: Vec<Source<'t>>,
    /// For each half space of each solid: its carrier, and the sense relative to it.
    pub sides: Vec<Vec<(usize, Sense)>>,
}

/// Merges equal surfaces, and assigns a carrier to each half space.
pub(super) fn merge<'t, N: Float>(
    tree: &'t Tree,
    solids: &HalfSpaceModel<N>,
    extent: &RegionOfInterest<N>,
    predicates: &Predicates,
) -> Merged<'t, N> {
    let placed: Vec<&PlacedPrimitive> = tree.leaves().map(|leaf| leaf.1).collect();
    // Equal surfaces have nearly the same point closest to the extent's centre. The surfaces are
    // sorted by that point, and only neighbours are compared.
    let foot = |s: &Surface<N>| {
        let f = s.frame();
        let away = extent.centre - f.origin;
        match s {
            Surface::Plane(_) => extent.centre - f.z * f.z.dot(&away),
            Surface::Cylinder(_) => f.origin + f.z * f.z.dot(&away),
            Surface::Cone(_) | Surface::Sphere(_) | Surface::Torus(_) => f.origin,
        }
    };
    let mut list: Vec<(N, usize, usize, &HalfSpace<N>)> = Vec::new();
    for (i, s) in solids.all.iter().enumerate() {
        for (k, side) in s.sides.iter().enumerate() {
            list.push((foot(&side.surface).x, i, k, side));
        }
    }
    list.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let window = N::from_f64(4.0) * predicates.reach::<N>() + N::ROUNDING * extent.radius;
    let mut sides: Vec<Vec<(usize, Sense)>> = solids
        .all
        .iter()
        .map(|s| vec![(usize::MAX, Sense::Along); s.sides.len()])
        .collect();
    let mut carriers: Vec<Surface<N>> = Vec::new();
    let mut sources: Vec<Source<'t>> = Vec::new();
    // The carriers that may still equal a later surface, by the coordinate of that point.
    let mut recent: Vec<(N, usize)> = Vec::new();
    for (x, i, k, side) in list {
        recent.retain(|(y, _)| (x - *y).is_at_most(window));
        let source = Source {
            placed: placed[i],
            side: k,
        };
        let exact = || source.exact();
        let known = recent.iter().find_map(|&(_, c)| {
            let exact_known = || sources[c].exact();
            let a = Carrier::rounded(&carriers[c], &exact_known);
            let b = Carrier::rounded(&side.surface, &exact);
            coincidence(a, b, extent, predicates).map(|sense| (c, sense))
        });
        sides[i][k] = known.unwrap_or_else(|| {
            carriers.push(side.surface);
            sources.push(source);
            recent.push((x, carriers.len() - 1));
            (carriers.len() - 1, Sense::Along)
        });
    }
    Merged {
        carriers,
        sources,
        sides,
    }
}
