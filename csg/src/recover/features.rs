//! The numbers of a primitive along a direction: its planes, axis or centre, and these plus and
//! minus radii.

use crate::primitive::Primitive;
use crate::recover::PrimitiveRelation;
use premio_kernel::number::rational::Rational;

/// A kind of number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum FeatureKind {
    /// A plane across the direction, or an edge of one.
    Plane,
    /// An axis across the direction, or a centre.
    Centre,
    /// A tangent plane of a curved surface across the direction.
    Tangent,
}

impl FeatureKind {
    /// The relation of two equal numbers.
    pub fn relation(self, other: Self) -> PrimitiveRelation {
        match (self, other) {
            (Self::Plane, Self::Plane) => PrimitiveRelation::Coplanar,
            (Self::Tangent, _) | (_, Self::Tangent) => PrimitiveRelation::Tangent,
            _ => PrimitiveRelation::Aligned,
        }
    }
}

/// A number of a primitive along a direction, relative to its origin.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Feature {
    /// What it is.
    pub kind: FeatureKind,
    /// The number.
    pub offset: Rational,
}

/// An axis of a primitive's own frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum LocalAxis {
    /// x, y or z, by index.
    Along(usize),
    /// Any direction across the axis of a primitive of revolution.
    Across,
}

/// The numbers of a primitive along an axis of its own frame.
pub(super) fn features(primitive: &Primitive, axis: LocalAxis) -> Vec<Feature> {
    let plane = |offset: &Rational| Feature {
        kind: FeatureKind::Plane,
        offset: offset.clone(),
    };
    let zero = Rational::ZERO;
    match primitive {
        Primitive::Block { size } | Primitive::Wedge { size } => match axis {
            LocalAxis::Along(k) => vec![plane(&zero), plane(&size[k])],
            LocalAxis::Across => Vec::new(),
        },
        Primitive::Sphere { radius } => about_centre(&[radius]),
        Primitive::Cylinder { radius, height } => match is_across(axis) {
            true => about_centre(&[radius]),
            false => vec![plane(&zero), plane(height)],
        },
        Primitive::Frustum { base, top, height } => match is_across(axis) {
            true => about_centre(&[base, top]),
            false => vec![plane(&zero), plane(height)],
        },
        Primitive::Torus { major, minor } => match is_across(axis) {
            true => {
                // The inner rim is none of a torus that reaches its axis.
                let inner = (major - minor).max(Rational::ZERO);
                about_centre(&[major, &(major + minor), &inner])
            }
            false => about_centre(&[minor]),
        },
        Primitive::Prism { height, .. } => match is_across(axis) {
            true => Vec::new(),
            false => vec![plane(&zero), plane(height)],
        },
        Primitive::Polyhedron { .. }
        | Primitive::ObliqueFrustum { .. }
        | Primitive::Ellipsoid { .. } => Vec::new(),
        Primitive::Revolution { .. } => match is_across(axis) {
            true => about_centre(&[]),
            false => Vec::new(),
        },
    }
}

/// Whether an axis of the own frame lies across the axis of revolution.
fn is_across(axis: LocalAxis) -> bool {
    axis != LocalAxis::Along(2)
}

/// The centre, and its tangent planes at distances; zero is none.
fn about_centre(radii: &[&Rational]) -> Vec<Feature> {
    let centre = Feature {
        kind: FeatureKind::Centre,
        offset: Rational::ZERO,
    };
    let radii = radii.iter().filter(|radius| !radius.is_zero());
    let tangents = radii.flat_map(|&radius| {
        [radius.clone(), -radius.clone()].map(|offset| Feature {
            kind: FeatureKind::Tangent,
            offset,
        })
    });
    std::iter::once(centre).chain(tangents).collect()
}
