//! The carriers: the distinct surfaces of all half spaces.

use super::exact_coefficients::coefficients;
use super::halfspaces::{HalfSpace, HalfSpaceModel, Solid};
use crate::tree::{PlacedPrimitive, Tree};
use nalgebra::Point3;
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

/// Merges equal surfaces, and assigns a carrier to each half space. Equal surfaces have nearly the same
/// point closest to the extent's centre: the surfaces are sorted by that point, and only neighbours are
/// compared.
pub(super) fn merge<'t, N: Float>(
    tree: &'t Tree,
    solids: &HalfSpaceModel<N>,
    extent: &RegionOfInterest<N>,
    predicates: &Predicates,
) -> Merged<'t, N> {
    let placed: Vec<&PlacedPrimitive> = tree.leaves().map(|leaf| leaf.1).collect();
    let window = N::from_f64(4.0) * predicates.reach::<N>() + N::ROUNDING * extent.radius;
    let own = |s: &Solid<N>| vec![CarrierSide::own(usize::MAX); s.sides.len()];
    let mut merged = Merged {
        carriers: Vec::new(),
        sources: Vec::new(),
        sides: solids.all.iter().map(own).collect(),
    };
    // The carriers that may still equal a later surface, by the coordinate of that point.
    let mut recent: Vec<(N, usize)> = Vec::new();
    for placed_side in sorted_sides(solids, &extent.centre) {
        let PlacedSide { x, solid, side, .. } = placed_side;
        recent.retain(|(y, _)| (x - *y).is_at_most(window));
        let surface = placed_side.half_space.surface;
        let source = Source {
            placed: placed[solid],
            side,
        };
        let candidates = recent.iter().map(|&(_, carrier)| carrier);
        let known = merged.equal_carrier(candidates, &surface, &source, extent, predicates);
        merged.sides[solid][side] = known.unwrap_or_else(|| {
            merged.carriers.push(surface);
            merged.sources.push(source);
            recent.push((x, merged.carriers.len() - 1));
            CarrierSide::own(merged.carriers.len() - 1)
        });
    }
    merged
}

impl<N: Float> Merged<'_, N> {
    /// The carrier, among some, that a surface equals.
    fn equal_carrier(
        &self,
        mut candidates: impl Iterator<Item = usize>,
        surface: &Surface<N>,
        source: &Source<'_>,
        extent: &RegionOfInterest<N>,
        predicates: &Predicates,
    ) -> Option<CarrierSide> {
        let exact = || source.exact();
        candidates.find_map(|carrier| {
            let exact_known = || self.sources[carrier].exact();
            let a = Carrier::rounded(&self.carriers[carrier], &exact_known);
            let b = Carrier::rounded(surface, &exact);
            let sense = coincidence(a, b, extent, predicates)?;
            Some(CarrierSide { carrier, sense })
        })
    }
}

/// All half spaces, by the first coordinate of the point of each surface that is closest to a centre.
fn sorted_sides<'s, N: Float>(
    solids: &'s HalfSpaceModel<N>,
    centre: &Point3<N>,
) -> Vec<PlacedSide<'s, N>> {
    let mut list: Vec<PlacedSide<'_, N>> = Vec::new();
    for (solid, s) in solids.all.iter().enumerate() {
        list.extend(
            s.sides
                .iter()
                .enumerate()
                .map(|(side, half_space)| PlacedSide {
                    x: foot(&half_space.surface, centre).x,
                    solid,
                    side,
                    half_space,
                }),
        );
    }
    list.sort_by(|a, b| {
        let indices = [a.solid, a.side].cmp(&[b.solid, b.side]);
        a.x.total_cmp(&b.x).then(indices)
    });
    list
}

/// The point of a plane or of an axis closest to a centre; of other surfaces the origin of the frame.
fn foot<N: Float>(surface: &Surface<N>, centre: &Point3<N>) -> Point3<N> {
    let f = surface.frame();
    let away = centre - f.origin;
    match surface {
        Surface::Plane(_) => centre - f.z * f.z.dot(&away),
        Surface::Cylinder(_) | Surface::EllipticCylinder(_) => f.origin + f.z * f.z.dot(&away),
        Surface::Cone(_)
        | Surface::Sphere(_)
        | Surface::Torus(_)
        | Surface::EllipticCone(_)
        | Surface::Ellipsoid(_) => f.origin,
    }
}
