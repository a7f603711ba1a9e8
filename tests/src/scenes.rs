//! Scenes whose cost is measured: each grows with one number.

use premio_kernel::random::Random;
use serde_json::{Value, json};
use std::fmt::Write as _;

fn union(children: Vec<Value>) -> Value {
    json!({"op": "union", "children": children})
}

/// `n` cylinders on one axis, each on top of the last; three radii take turns.
pub fn stack(n: usize) -> Value {
    let cylinder = |i: usize| {
        let radius = 2.0 + (i % 3) as f64;
        json!({"prim": "cylinder", "r": radius, "h": 1.0,
               "transform": [{"translate": [0.0, 0.0, i as f64]}]})
    };
    union((0..n).map(cylinder).collect())
}

/// A bar with `n` slots.
pub fn comb(n: usize) -> Value {
    let bar = json!({"prim": "block", "size": [2.0 * n as f64 + 1.0, 5.0, 10.0]});
    let slot = |i: usize| {
        json!({"prim": "block", "size": [1.0, 7.0, 8.0],
               "transform": [{"translate": [2.0 * i as f64 + 1.0, -1.0, 3.0]}]})
    };
    let all = std::iter::once(bar)
        .chain((0..n).map(slot))
        .collect::<Vec<_>>();
    json!({"op": "difference", "children": all})
}

/// What a heap consists of.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum HeapShape {
    /// Blocks.
    Boxes,
    /// Spheres.
    Balls,
    /// Cylinders.
    Rods,
}

/// The union of `n` solids of one shape, turned and placed at random so that nearly all overlap.
pub fn heap(shape: HeapShape, n: usize) -> Value {
    let mut random = Random::new(n as u64);
    let mut within = |from: f64, to: f64| from + (to - from) * random.uniform();
    let mut solid = |_| {
        let axis = [within(-1.0, 1.0), within(-1.0, 1.0), within(0.1, 1.0)];
        let angle = within(0.0, 360.0);
        let at = [within(-6.0, 6.0), within(-6.0, 6.0), within(-6.0, 6.0)];
        let steps = json!([{"rotate": [axis, angle]}, {"translate": at}]);
        let [a, b, c] = [within(4.0, 10.0), within(4.0, 10.0), within(4.0, 10.0)];
        match shape {
            HeapShape::Boxes => json!({"prim": "block", "size": [a, b, c], "transform": steps}),
            HeapShape::Balls => json!({"prim": "sphere", "r": 0.7 * a, "transform": steps}),
            HeapShape::Rods => {
                json!({"prim": "cylinder", "r": 0.25 * a, "h": 2.0 * b, "transform": steps})
            }
        }
    };
    union((0..n).map(&mut solid).collect())
}

/// The `.csg` text of `n` separate unit cubes in a square.
pub fn separate_cubes(n: usize) -> String {
    let side = (n as f64).sqrt().ceil() as usize;
    let mut text = String::from("group() {\n");
    for i in 0..n {
        let (x, y) = (2 * (i % side), 2 * (i / side));
        let _ = writeln!(
            text,
            "multmatrix([[1, 0, 0, {x}], [0, 1, 0, {y}], [0, 0, 1, 0], [0, 0, 0, 1]]) {{ cube(size = [1, 1, 1], center = false); }}"
        );
    }
    text + "}\n"
}

/// A ball bearing at six decimals: two rings with grooves and `balls` balls, turned about an odd axis.
pub fn bearing(balls: usize) -> Value {
    let rounded = |x: f64| (x * 1e6).round() / 1e6;
    let steps = |at: [f64; 3]| {
        // The rotation about (1, 2, 3) by 40°, applied to the place.
        let axis = nalgebra::Unit::new_normalize(nalgebra::Vector3::new(1.0, 2.0, 3.0));
        let turn = nalgebra::Rotation3::from_axis_angle(&axis, 40_f64.to_radians());
        let place = turn * nalgebra::Vector3::from(at);
        let axis = [axis.x, axis.y, axis.z].map(rounded);
        json!([{"rotate": [axis, 40.0]}, {"translate": [rounded(place.x), rounded(place.y), rounded(place.z)]}])
    };
    let cylinder = |r: f64, from: f64, h: f64| json!({"prim": "cylinder", "r": r, "h": h, "transform": steps([0.0, 0.0, from])});
    let groove = json!({"prim": "torus", "R": 20.0, "r": 4.2, "transform": steps([0.0; 3])});
    let ring = |outer: f64, inner: f64| {
        json!({"op": "difference", "children": [
            cylinder(outer, -5.0, 10.0), cylinder(inner, -6.0, 12.0), groove.clone()]})
    };
    let mut all = vec![ring(27.0, 22.0), ring(18.0, 12.0)];
    all.extend((0..balls).map(|i| {
        let angle = std::f64::consts::TAU * i as f64 / balls as f64;
        let at = [20.0 * angle.cos(), 20.0 * angle.sin(), 0.0];
        json!({"prim": "sphere", "r": 4.0, "transform": steps(at)})
    }));
    union(all)
}

/// A gear in PADL: a prism of four corners a tooth, with a bore.
pub fn gear(teeth: usize) -> String {
    let count = 4 * teeth;
    let corner = |i: usize| {
        let radius = if i % 4 < 2 { 50.0 } else { 46.0 };
        let angle = std::f64::consts::TAU * i as f64 / count as f64;
        format!("({:.6}, {:.6})", radius * angle.cos(), radius * angle.sin())
    };
    let corners: Vec<String> = (0..count).map(corner).collect();
    format!(
        "GEAR = PRI(PGN({}), 10) DIF CYL(R=8, H=12) AT (MOVZ=-1)\n",
        corners.join(", ")
    )
}

/// A ball with `n` bores through its centre, of one radius, with axes in one plane.
pub fn cross_bores(n: usize) -> Value {
    let mut all = vec![json!({"prim": "sphere", "r": 10.0})];
    all.extend((0..n).map(|i| {
        let angle = 180.0 * i as f64 / n as f64;
        json!({"prim": "cylinder", "r": 1.5, "h": 24.0, "transform": [
            {"translate": [0.0, 0.0, -12.0]}, {"rotate": [[0.0, 1.0, 0.0], 90.0]},
            {"rotate": [[0.0, 0.0, 1.0], angle]}]})
    }));
    json!({"op": "difference", "children": all})
}
