//! Families of parts for tests and benches.

use serde_json::{Value, json};

fn cylinder(r: f64, h: f64, transform: &Value) -> Value {
    json!({"prim": "cylinder", "r": r, "h": h, "transform": transform})
}

/// A block with n by n through holes at a distance of one unit.
pub fn plate(n: usize, thickness: f64) -> Value {
    let side = n as f64;
    let mut all = vec![json!({"prim": "block", "size": [side, side, thickness]})];
    for i in 0..n * n {
        let (x, y) = ((i % n) as f64 + 0.5, (i / n) as f64 + 0.5);
        let at = json!([{"translate": [x, y, -1.0]}]);
        all.push(cylinder(0.3, thickness + 2.0, &at));
    }
    json!({"op": "difference", "children": all})
}

/// A cube with three cuts: a slot, a bore and a bevel.
pub fn cube_with_cuts() -> Value {
    json!({"op": "difference", "children": [
        {"prim": "block", "size": [3.0, 3.0, 3.0]},
        {"prim": "block", "size": [1.0, 4.0, 1.0], "transform": [{"translate": [1.0, -0.5, 2.5]}]},
        cylinder(0.5, 4.0, &json!([{"translate": [0.8, 0.8, -0.5]}])),
        {"prim": "wedge", "size": [1.0, 4.0, 1.0], "transform": [{"translate": [-0.1, -0.5, -0.1]}]},
    ]})
}

/// A pipe of radii 50 and 48 and length 200, with k radial branches of radii 6 and 5 from its axis
/// to x = 80, at z = 20 + 20 i; all bores are open.
pub fn tee(k: usize) -> Value {
    let main = |r: f64, from: f64, to: f64| {
        cylinder(r, to - from, &json!([{"translate": [0.0, 0.0, from]}]))
    };
    let branch = |i: usize, r: f64, to: f64| {
        let z = 20.0 + 20.0 * i as f64;
        let turned = json!([{"rotate": [[0.0, 1.0, 0.0], 90.0]}, {"translate": [0.0, 0.0, z]}]);
        cylinder(r, to, &turned)
    };
    let mut outer = vec![main(50.0, 0.0, 200.0)];
    outer.extend((0..k).map(|i| branch(i, 6.0, 80.0)));
    let mut all = vec![
        json!({"op": "union", "children": outer}),
        main(48.0, -1.0, 201.0),
    ];
    all.extend((0..k).map(|i| branch(i, 5.0, 81.0)));
    json!({"op": "difference", "children": all})
}
