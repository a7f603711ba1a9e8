//! Tests of the readers.

mod brlcad;
mod corpus;
mod csg;
mod json;
mod messages;
mod padl;
mod padl_figures;
mod padl_words;
mod pov;
mod robustness;

use crate::common::tree;
use nalgebra::Vector3;
use premio_csg::figure::Figure;
use premio_csg::polyhedron::Polyhedron;
use premio_csg::primitive::Primitive;
use premio_csg::reader::*;
use premio_csg::tree::{NodeId, Operation, PlacedPrimitive, Tree, TreeNode};
use premio_kernel::number::rational::{Rational, to_f64};

fn read_text(text: &str, format: Format) -> Result<Description, ReadError> {
    read("part", text.as_bytes(), format, &ReadOptions::default())
}

fn message(text: &str, format: Format) -> String {
    read_text(text, format).unwrap_err().to_string()
}

/// Whether a primitive, in its own frame, contains a point.
fn contains(primitive: &Primitive, [x, y, z]: [f64; 3]) -> bool {
    let f = to_f64;
    let within = |value: f64, size: &Rational| (0.0..=f(size)).contains(&value);
    let radial = x.hypot(y);
    match primitive {
        Primitive::Block { size: [a, b, c] } => within(x, a) && within(y, b) && within(z, c),
        Primitive::Wedge { size: [a, b, c] } => {
            within(x, a) && within(y, b) && within(z, c) && x / f(a) + z / f(c) <= 1.0
        }
        Primitive::Cylinder { radius, height } => radial <= f(radius) && within(z, height),
        Primitive::Frustum { base, top, height } => {
            within(z, height) && radial <= f(base) + (f(top) - f(base)) * z / f(height)
        }
        Primitive::Sphere { radius } => radial.hypot(z) <= f(radius),
        Primitive::Torus { major, minor } => (radial - f(major)).hypot(z) <= f(minor),
        Primitive::Prism {
            figure,
            height,
            top,
        } => {
            let scale = 1.0 + (f(top) - 1.0) * z / f(height);
            let at = [x / scale, y / scale];
            z >= 0.0 && z <= f(height) && scale > 0.0 && is_around(figure, at)
        }
        Primitive::Revolution { figure, angle } => {
            let turned = y.atan2(x).to_degrees().rem_euclid(360.0);
            let within = angle.as_ref().is_none_or(|a| turned <= f(a.degrees()));
            within && is_around(figure, [radial, z])
        }
        Primitive::Polyhedron { polyhedron } => is_enclosed(polyhedron, [x, y, z]),
        Primitive::ObliqueFrustum { frustum } => {
            let axes = frustum.axes().each_ref().map(|axis| axis.each_ref().map(f));
            let columns = axes.map(Vector3::from);
            let inverse = nalgebra::Matrix3::from_columns(&columns).try_inverse();
            let q = inverse.unwrap() * Vector3::new(x, y, z);
            let size = 1.0 + (f(frustum.top()) - 1.0) * q.z;
            (0.0..=1.0).contains(&q.z) && q.x.hypot(q.y) <= size
        }
        Primitive::Ellipsoid { radii } => {
            let columns = radii.vectors().each_ref();
            let columns = columns.map(|radius| Vector3::from(radius.each_ref().map(f)));
            let inverse = nalgebra::Matrix3::from_columns(&columns).try_inverse();
            (inverse.unwrap() * Vector3::new(x, y, z)).norm() <= 1.0
        }
    }
}

/// Whether the facets of a polyhedron cover more than half of the directions around a point.
fn is_enclosed(polyhedron: &Polyhedron, p: [f64; 3]) -> bool {
    let at =
        |i: usize| Vector3::from(polyhedron.points()[i].each_ref().map(to_f64)) - Vector3::from(p);
    let loops = polyhedron.faces().iter().flat_map(|face| &face.loops);
    let fan = |corners: &Vec<usize>| -> f64 {
        let triangles = (1..corners.len() - 1).map(|k| {
            let [a, b, c] = [corners[0], corners[k], corners[k + 1]].map(at);
            let volume = a.dot(&b.cross(&c));
            let [x, y, z] = [a.norm(), b.norm(), c.norm()];
            let across = x * y * z + a.dot(&b) * z + b.dot(&c) * x + c.dot(&a) * y;
            2.0 * volume.atan2(across)
        });
        triangles.sum()
    };
    loops.map(fan).sum::<f64>() > std::f64::consts::TAU
}

/// Whether a tree contains a point, by classifying it with every primitive.
fn inside(tree: &Tree, point: [f64; 3]) -> bool {
    tree.root().is_some_and(|root| holds(tree, root, point))
}

fn holds(tree: &Tree, node: NodeId, point: [f64; 3]) -> bool {
    match &tree[node] {
        TreeNode::Leaf(PlacedPrimitive { primitive, motion }) => {
            let back = motion.inverse();
            let exact = point.map(|x| premio_kernel::number::rational::from_f64(x).unwrap());
            contains(primitive, back.apply_point(&exact).map(|x| to_f64(&x)))
        }
        TreeNode::Operation { op, children } => {
            let mut below = children.iter().map(|child| holds(tree, *child, point));
            match op {
                Operation::Union => below.any(|h| h),
                Operation::Intersection => below.all(|h| h),
                Operation::Difference => below.next().unwrap() && !below.any(|h| h),
            }
        }
    }
}

/// Asserts that two trees contain the same points of a grid that avoids round numbers.
fn assert_same_points(a: &Tree, b: impl Fn([f64; 3]) -> bool) {
    let steps = || (-9..=9).map(|i| f64::from(i) * 0.61 + 0.0137);
    for x in steps() {
        for y in steps() {
            for z in steps() {
                assert_eq!(inside(a, [x, y, z]), b([x, y, z]), "at {x} {y} {z}");
            }
        }
    }
}

/// Whether the outline of a figure turns around a point, by the sum of its angles. Arcs are taken as
/// many chords.
fn is_around(figure: &Figure, [x, y]: [f64; 2]) -> bool {
    const CHORDS: u32 = 256;
    let angle = |s: [f64; 2], e: [f64; 2]| {
        let [s, e] = [s, e].map(|p| [p[0] - x, p[1] - y]);
        (s[0] * e[1] - s[1] * e[0]).atan2(s[0] * e[0] + s[1] * e[1])
    };
    let turned = figure.edges().iter().map(|edge| {
        let [s, e] = [&edge.start, &edge.end].map(|p| p.each_ref().map(to_f64));
        let Some(arc) = &edge.arc else {
            return angle(s, e);
        };
        let (c, r) = (arc.centre.each_ref().map(to_f64), to_f64(&arc.radius));
        let [from, to] = [s, e].map(|p| (p[1] - c[1]).atan2(p[0] - c[0]));
        let sign = to_f64(&arc.signed_radius()).signum();
        let by = sign * (sign * (to - from)).rem_euclid(std::f64::consts::TAU);
        let at = |k: u32| {
            let turned = from + by * f64::from(k) / f64::from(CHORDS);
            [c[0] + r * turned.cos(), c[1] + r * turned.sin()]
        };
        (0..CHORDS).map(|k| angle(at(k), at(k + 1))).sum()
    });
    turned.sum::<f64>() > 1.0
}
