//! The exact coefficients of half spaces: rational numbers in a rational frame.

use super::{ellipsoid_side, oblique_sides, walls};
use crate::primitive::Primitive;
use crate::tree::PlacedPrimitive;
use premio_kernel::geometry::surface_pair::Coefficients;
use premio_kernel::number::rational::Rational;

/// The exact coefficients of a primitive's half space, by its index among the primitive's half
/// spaces.
pub(super) fn coefficients(placed: &PlacedPrimitive, side: usize) -> Coefficients<Rational> {
    let own = in_own_frame(&placed.primitive, side);
    Coefficients {
        point: placed.motion.apply_point(&own.point),
        direction: placed.motion.apply_vector(&own.direction),
        axes: own
            .axes
            .map(|axes| Box::new(axes.each_ref().map(|axis| placed.motion.apply_vector(axis)))),
        ..own
    }
}

fn in_own_frame(primitive: &Primitive, side: usize) -> Coefficients<Rational> {
    match primitive {
        Primitive::Block { size } => block_side(size, side / 2, side % 2 == 1),
        Primitive::Wedge { size } => match side {
            0 => block_side(size, 0, false),
            1 => block_side(size, 1, false),
            2 => block_side(size, 1, true),
            3 => block_side(size, 2, false),
            _ => Coefficients {
                point: [size[0].clone(), Rational::ZERO, Rational::ZERO],
                direction: [size[2].clone(), Rational::ZERO, size[0].clone()],
                ..plane()
            },
        },
        Primitive::Cylinder { radius, height } => match side {
            0 => about_z(radius),
            1 => disc(&Rational::ZERO, false),
            _ => disc(height, true),
        },
        Primitive::Frustum { base, top, height } => match side {
            0 => cone(base, top, height),
            1 if *base > Rational::ZERO => disc(&Rational::ZERO, false),
            _ => disc(height, true),
        },
        Primitive::Sphere { radius } => about_z(radius),
        Primitive::Torus { major, minor } => Coefficients {
            tube: minor.clone(),
            ..about_z(major)
        },
        Primitive::Prism { height, .. } => match walls::wall(primitive, side) {
            Some(wall) => wall.coefficients,
            None if side == walls::count(primitive) => disc(&Rational::ZERO, false),
            None => disc(height, true),
        },
        Primitive::Polyhedron { polyhedron } => Coefficients {
            point: polyhedron.corners(side).next().cloned().unwrap_or_default(),
            direction: polyhedron.normal(side),
            ..plane()
        },
        Primitive::ObliqueFrustum { frustum } => oblique_sides::coefficients(frustum, side),
        Primitive::Ellipsoid { radii } => ellipsoid_side::coefficients(radii),
        Primitive::Revolution { .. } => match walls::wall(primitive, side) {
            Some(wall) => wall.coefficients,
            None => {
                let end = side - walls::count(primitive);
                let normal = walls::end_normals(primitive).into_iter().nth(end);
                Coefficients {
                    direction: normal.unwrap_or_default(),
                    ..plane()
                }
            }
        },
    }
}

/// The plane z = 0.
fn plane() -> Coefficients<Rational> {
    about_z(&Rational::ZERO)
}

/// The coefficients of a surface of revolution about the z axis at the origin.
fn about_z(size: &Rational) -> Coefficients<Rational> {
    Coefficients {
        point: [Rational::ZERO, Rational::ZERO, Rational::ZERO],
        direction: [Rational::ZERO, Rational::ZERO, Rational::ONE],
        size: size.clone(),
        tube: Rational::ZERO,
        axes: None,
    }
}

fn disc(height: &Rational, up: bool) -> Coefficients<Rational> {
    let normal = if up { Rational::ONE } else { -Rational::ONE };
    Coefficients {
        point: [Rational::ZERO, Rational::ZERO, height.clone()],
        direction: [Rational::ZERO, Rational::ZERO, normal],
        ..plane()
    }
}

fn block_side(size: &[Rational; 3], axis: usize, high: bool) -> Coefficients<Rational> {
    let mut c = plane();
    c.direction = [Rational::ZERO, Rational::ZERO, Rational::ZERO];
    if high {
        c.point[axis] = size[axis].clone();
        c.direction[axis] = Rational::ONE;
    } else {
        c.direction[axis] = -Rational::ONE;
    }
    c
}

/// The nappe of a frustum's wall. Its apex, where the radius becomes zero, lies above or below.
fn cone(base: &Rational, top: &Rational, height: &Rational) -> Coefficients<Rational> {
    let slope = base - top;
    let apex = height * base / &slope;
    let narrows = slope > Rational::ZERO;
    let tangent = slope / height;
    let (into, tangent) = if narrows {
        (-Rational::ONE, tangent)
    } else {
        (Rational::ONE, -tangent)
    };
    Coefficients {
        point: [Rational::ZERO, Rational::ZERO, apex],
        direction: [Rational::ZERO, Rational::ZERO, into],
        size: tangent,
        tube: Rational::ZERO,
        axes: None,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by it")]
mod tests {
    use super::super::halfspaces::HalfSpaceModel;
    use super::*;
    use crate::builder::Builder;
    use crate::primitive::Primitive;
    use crate::transform::{Transform, TransformStep};
    use crate::tree::TreeNode;
    use nalgebra::Vector3;
    use premio_kernel::geometry::surface::Surface;
    use premio_kernel::number::rational::{Rational, to_f64};

    #[test]
    fn exact_and_rounded_half_spaces_are_the_same() {
        let n = |x: i32| Rational::from(x);
        let parts = [
            Primitive::block([4, 3, 2].map(n)),
            Primitive::wedge([4, 3, 2].map(n)),
            Primitive::cylinder(n(2), n(3)),
            Primitive::frustum(n(2), n(0), n(3)),
            Primitive::frustum(n(1), n(2), n(3)),
            Primitive::frustum(n(2), n(1), n(3)),
            Primitive::sphere(n(2)),
            Primitive::torus(n(3), n(1)),
        ];
        for part in parts.map(Result::unwrap) {
            let name = format!("{part:?}");
            let mut moves = Transform::new();
            for step in [
                TransformStep::about(0, n(17)),
                TransformStep::about(2, n(31)),
                TransformStep::Shift([n(1) / n(10), n(7), n(0)]),
            ] {
                moves.push(step).unwrap();
            }
            let mut builder = Builder::new();
            let part = builder.primitive(part);
            let part = builder.moved(part, moves);
            let tree = builder.finish(part).unwrap();
            let solids = HalfSpaceModel::new(&tree);
            for (k, side) in solids.all[0].sides.iter().enumerate() {
                let TreeNode::Leaf(placed) = &tree[solids.all[0].leaf] else {
                    continue;
                };
                let exact = coefficients(placed, k).map(to_f64);
                let frame = side.surface.frame();
                let sizes = match &side.surface {
                    Surface::Plane(_) => [0.0, 0.0],
                    Surface::Cylinder(c) => [c.radius, 0.0],
                    Surface::Cone(c) => [c.sin / c.cos, 0.0],
                    Surface::Sphere(s) => [s.radius, 0.0],
                    Surface::Torus(t) => [t.major, t.minor],
                    Surface::EllipticCylinder(_)
                    | Surface::EllipticCone(_)
                    | Surface::Ellipsoid(_) => [1.0, 0.0],
                };
                let slack = 4.0 * f64::EPSILON;
                let direction = Vector3::from(exact.direction).normalize();
                assert!((direction - frame.z).norm() <= slack, "{name} side {k}");
                assert_eq!(
                    exact.point,
                    <[f64; 3]>::from(frame.origin),
                    "{name} side {k}"
                );
                for (a, b) in [exact.size, exact.tube].iter().zip(sizes) {
                    assert!((a - b).abs() <= slack * b, "{name} side {k}");
                }
            }
        }
    }
}
