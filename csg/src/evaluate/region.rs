//! The region that the walls of a prism, a revolution or a polyhedron bound.

use super::facets::Facets;
use super::incident_walls::RegionLook;
use super::section::Section;
use nalgebra::Point3;
use premio_kernel::number::float::Float;

/// The distance up to which the distance of a wall is determined, relative to the tolerance.
const MARGIN: f64 = 8.0;

/// A region that walls bound: surfaces that end where the next wall begins.
#[derive(Clone, Debug)]
pub(super) enum WalledRegion<N: Float> {
    /// The points that are mapped into a figure.
    Section(Section<N>),
    /// The inside of a polyhedron.
    Facets(Facets<N>),
}

impl<N: Float> WalledRegion<N> {
    /// The number of walls, which are the first sides of the primitive.
    pub fn walls(&self) -> usize {
        match self {
            Self::Section(section) => section.walls,
            Self::Facets(facets) => facets.count(),
        }
    }

    /// Whether a point is inside. On a wall rounding decides.
    pub fn contains(&self, p: &Point3<N>) -> bool {
        match self {
            Self::Section(section) => section.contains(p),
            Self::Facets(facets) => facets.contains(p),
        }
    }

    /// The walls through a point among those that `is_chosen` selects by their sides, within a
    /// tolerance, and the distance of the others.
    pub fn look(
        &self,
        p: &Point3<N>,
        is_chosen: impl Fn(usize) -> bool,
        tolerance: N,
    ) -> RegionLook<N> {
        let margin = N::from_f64(MARGIN) * tolerance;
        match self {
            Self::Section(section) => section.look(p, is_chosen, tolerance, margin),
            Self::Facets(facets) => facets.look(p, is_chosen, tolerance, margin),
        }
    }

    /// The signed distance of the closest wall, or a lower bound of it with the right sign: to a
    /// limit, and where walls are slanted.
    pub fn level(&self, p: &Point3<N>, limit: N) -> N {
        match self {
            Self::Section(section) => section.level(p, limit),
            Self::Facets(facets) => facets.level(p, limit),
        }
    }
}
