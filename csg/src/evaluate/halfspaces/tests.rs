#![allow(clippy::unwrap_used, reason = "a test fails by it")]

use super::HalfSpaceModel;
use crate::builder::Builder;
use crate::figure::Figure;
use crate::polyhedron::{Polyhedron, PolyhedronFace};
use crate::primitive::{Primitive, RevolutionAngle};
use crate::transform::{Transform, TransformStep};
use nalgebra::{Point3, Vector3};
use premio_kernel::number::rational::Rational;
use proptest::prelude::*;
use std::sync::Arc;

fn n(x: i32) -> Rational {
    Rational::from(x)
}

fn tenths(x: i32) -> Rational {
    n(x) / n(10)
}

fn polygon(corners: &[[i32; 2]]) -> Figure {
    let corners = corners.iter().map(|corner| corner.map(n)).collect();
    Figure::polygon(&[corners]).unwrap()
}

fn revolved(degrees: i32) -> Primitive {
    let section = polygon(&[[1, 0], [3, 0], [3, 1], [1, 1]]);
    let angle = RevolutionAngle::new(n(degrees)).unwrap();
    Primitive::revolution(section, Some(angle)).unwrap()
}

fn tetrahedron() -> Primitive {
    let points = [[0, 0, 0], [4, 0, 0], [0, 4, 0], [0, 0, 1]].map(|p| p.map(n));
    let faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];
    let faces = faces.map(|corners| PolyhedronFace::simple(corners.to_vec()));
    let polyhedron = Arc::new(Polyhedron::from_faces(&points, &faces).unwrap().polyhedron);
    Primitive::Polyhedron { polyhedron }
}

/// Primitives of every kind: walls that are slanted, surfaces with an apex, sections of less and of
/// more than half a turn.
fn primitives() -> Vec<Primitive> {
    let plate = || polygon(&[[-4, -3], [4, -3], [4, 3], [-4, 3]]);
    let axes = |a: i32, b: Rational, c: Rational| {
        let o = || n(0);
        [[n(a), o(), o()], [o(), b, o()], [o(), o(), c]]
    };
    let all = [
        Primitive::block([2, 3, 4].map(n)),
        Primitive::wedge([2, 3, 1].map(n)),
        Primitive::cylinder(n(1), n(3)),
        Primitive::frustum(n(2), tenths(5), n(1)),
        Primitive::frustum(tenths(2), n(0), n(3)),
        Primitive::sphere(n(2)),
        Primitive::torus(n(2), tenths(5)),
        Primitive::torus(n(1), n(2)),
        Primitive::ellipsoid(axes(4, n(2), n(1))),
        Primitive::oblique_frustum(axes(3, n(1), n(2)), tenths(2)),
        Primitive::scaled_prism(plate(), n(1), tenths(1)),
        Primitive::scaled_prism(plate(), n(1), n(0)),
        Primitive::scaled_prism(Figure::disc(&n(1)).unwrap(), n(1), n(6)),
        Ok(revolved(100)),
        Ok(revolved(260)),
        Ok(tetrahedron()),
    ];
    all.into_iter().map(Result::unwrap).collect()
}

/// Each primitive in its own position, and rotated.
fn models() -> Vec<(String, HalfSpaceModel<f64>)> {
    let turned = |primitive: &Primitive, degrees: i32| {
        let mut moves = Transform::new();
        let axis = [1, 2, 2].map(n);
        let degrees = n(degrees);
        moves.push(TransformStep::Turn { axis, degrees }).unwrap();
        let mut builder = Builder::new();
        let part = builder.primitive(primitive.clone());
        let part = builder.moved(part, moves);
        HalfSpaceModel::new(&builder.finish(part).unwrap())
    };
    let named = |primitive: &Primitive| {
        [0, 40].map(|degrees| {
            (
                format!("{primitive:?} by {degrees}"),
                turned(primitive, degrees),
            )
        })
    };
    primitives().iter().flat_map(named).collect()
}

fn coordinate() -> impl Strategy<Value = f64> {
    -5.0..5.0
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// No surface passes through the ball around a point whose radius is the level there: every point
    /// of the ball is on the same side.
    #[test]
    fn levels_are_no_more_than_distances(
        p in [coordinate(), coordinate(), coordinate()],
        towards in prop::collection::vec([coordinate(), coordinate(), coordinate()], 40),
        part in 0.5..1.0,
    ) {
        let p = Point3::from(p);
        for (text, model) in models() {
            for solid in &model.all {
                for limit in [0.5, 100.0] {
                    let level = solid.level(&p, limit);
                    for &direction in &towards {
                        let direction = Vector3::from(direction);
                        let step = direction.normalize() * (0.999 * part * level.abs().min(limit));
                        let q = p + step;
                        let there = solid.level(&q, 100.0);
                        prop_assert!(there * level >= 0.0, "{text}: {level} at {p}, {there} at {q}");
                    }
                }
            }
        }
    }
}
