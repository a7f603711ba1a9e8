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
    /// For each half space of each solid: its carrier.
    pub sides: Vec<Vec<CarrierSide>>,
}

/// The carrier of a half space.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct CarrierSide {
    /// The index of the carrier.
    pub carrier: usize,
    /// The sense of the half space's surface relative to it.
    pub sense: Sense,
}

impl CarrierSide {
    /// The side of a carrier that has the half space's own surface.
    fn own(carrier: usize) -> Self {
        let sense = Sense::Along;
        Self { carrier, sense }
    }
}

/// A half space, with the place by which it is compared.
struct PlacedSide<'s, N: Float = f64> {
    /// The coordinate of the surface's point closest to the extent's centre.
    x: N,
    /// The index of the solid.
    solid: usize,
    /// The index of the half space in the solid.
    side: usize,
    half_space: &'s HalfSpace<N>,
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
            Surface::Cylinder(_) | Surface::EllipticCylinder(_) => f.origin + f.z * f.z.dot(&away),
            Surface::Cone(_)
            | Surface::Sphere(_)
            | Surface::Torus(_)
            | Surface::EllipticCone(_)
            | Surface::Ellipsoid(_) => f.origin,
        }
    };
    let mut list: Vec<PlacedSide<'_, N>> = Vec::new();
    for (solid, s) in solids.all.iter().enumerate() {
        for (side, half_space) in s.sides.iter().enumerate() {
            list.push(PlacedSide {
                x: foot(&half_space.surface).x,
                solid,
                side,
                half_space,
            });
        }
    }
    list.sort_by(|a, b| {
        let indices = [a.solid, a.side].cmp(&[b.solid, b.side]);
        a.x.total_cmp(&b.x).then(indices)
    });
    let window = N::from_f64(4.0) * predicates.reach::<N>() + N::ROUNDING * extent.radius;
    let mut sides: Vec<Vec<CarrierSide>> = solids
        .all
        .iter()
        .map(|s| vec![CarrierSide::own(usize::MAX); s.sides.len()])
        .collect();
    let mut carriers: Vec<Surface<N>> = Vec::new();
    let mut sources: Vec<Source<'t>> = Vec::new();
    // The carriers that may still equal a later surface, by the coordinate of that point.
    let mut recent: Vec<(N, usize)> = Vec::new();
    for placed_side in list {
        let PlacedSide {
            x,
            solid,
            side,
            half_space,
        } = placed_side;
        recent.retain(|(y, _)| (x - *y).is_at_most(window));
        let source = Source {
            placed: placed[solid],
            side,
        };
        let exact = || source.exact();
        let known = recent.iter().find_map(|&(_, carrier)| {
            let exact_known = || sources[carrier].exact();
            let a = Carrier::rounded(&carriers[carrier], &exact_known);
            let b = Carrier::rounded(&half_space.surface, &exact);
            let sense = coincidence(a, b, extent, predicates)?;
            Some(CarrierSide { carrier, sense })
        });
        sides[solid][side] = known.unwrap_or_else(|| {
            carriers.push(half_space.surface);
            sources.push(source);
            recent.push((x, carriers.len() - 1));
            CarrierSide::own(carriers.len() - 1)
        });
    }
    Merged {
        carriers,
        sources,
        sides,
    }
}
