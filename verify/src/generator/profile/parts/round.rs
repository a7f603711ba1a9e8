//! Rounded boxes, domes and knobs.

use super::draft::{PartDraft, PartLength, PlanePoint, UNIT};
use super::flat::rounded_plate;
use crate::generator::model::{ModelAxis, ModelNodeId};

/// A box with all edges rounded, or those along z and around the top, with a bore or a cavity.
pub fn rounded_box(d: &mut PartDraft<'_>) -> ModelNodeId {
    let size = [d.length(20, 80), d.length(20, 60), d.length(12, 50)];
    let [x, y, z] = size;
    let r = d.part_of(x.min(y).min(z), 12, 35);
    let body = match d.random.below(3) {
        0 => rounded_plate(d, size, r, [0; 3]),
        1 => rounded_top(d, size, r),
        _ => rounded(d, size, r),
    };
    let mut tools = Vec::new();
    match d.random.below(5) {
        0 => {
            let bore = d.part_of(x.min(y), 12, 25);
            tools.push(d.cylinder(ModelAxis::Z, bore, z + 2 * UNIT, [x / 2, y / 2, -UNIT]));
        }
        1 => {
            let bore = d.part_of(y.min(z), 12, 25);
            tools.push(d.cylinder(ModelAxis::X, bore, x + 2 * UNIT, [-UNIT, y / 2, z / 2]));
        }
        2 => {
            let t = r / 2;
            tools.push(d.block([x - 2 * r, y - 2 * r, z], [r, r, t]));
        }
        3 => {
            let ball = d.part_of(x.min(y), 15, 30);
            tools.push(d.sphere(ball, [x / 2, y / 2, z]));
        }
        _ => {}
    }
    d.difference(body, tools)
}

/// Three blocks, a cylinder along each of twelve edges, a sphere in each of eight corners.
fn rounded(d: &mut PartDraft<'_>, [x, y, z]: PlanePoint, r: PartLength) -> ModelNodeId {
    let mut all = vec![
        d.block([x, y - 2 * r, z - 2 * r], [0, r, r]),
        d.block([x - 2 * r, y, z - 2 * r], [r, 0, r]),
        d.block([x - 2 * r, y - 2 * r, z], [r, r, 0]),
    ];
    for u in [r, y - r] {
        for v in [r, z - r] {
            all.push(d.cylinder(ModelAxis::X, r, x - 2 * r, [r, u, v]));
        }
    }
    for u in [r, x - r] {
        for v in [r, z - r] {
            all.push(d.cylinder(ModelAxis::Y, r, y - 2 * r, [u, r, v]));
        }
        for v in [r, y - r] {
            all.push(d.cylinder(ModelAxis::Z, r, z - 2 * r, [u, v, r]));
            all.extend([r, z - r].map(|w| d.sphere(r, [u, v, w])));
        }
    }
    d.union(all)
}

/// A rounded plate with the edges around its top rounded, too.
fn rounded_top(d: &mut PartDraft<'_>, [x, y, z]: PlanePoint, r: PartLength) -> ModelNodeId {
    let mut all = vec![
        rounded_plate(d, [x, y, z - r], r, [0; 3]),
        d.block([x - 2 * r, y - 2 * r, z], [r, r, 0]),
    ];
    for u in [r, x - r] {
        all.push(d.cylinder(ModelAxis::Y, r, y - 2 * r, [u, r, z - r]));
        for v in [r, y - r] {
            all.push(d.sphere(r, [u, v, z - r]));
        }
    }
    for v in [r, y - r] {
        all.push(d.cylinder(ModelAxis::X, r, x - 2 * r, [r, v, z - r]));
    }
    d.union(all)
}

/// A dome on a cylinder or cut from a sphere, hollow or whole, with a hole on its top.
pub fn dome(d: &mut PartDraft<'_>) -> ModelNodeId {
    let r = d.length(15, 50);
    let t = d.part_of(r, 8, 25);
    let base = d.part_of(r, 20, 80);
    let around = [4 * r, 4 * r, 2 * r];
    let body = match d.random.below(3) {
        0 => {
            let ball = d.sphere(r, [0; 3]);
            let above = d.block(around, [-2 * r, -2 * r, 0]);
            d.intersection(ball, above)
        }
        1 => {
            // A cap of less than half of the sphere.
            let ball = d.sphere(r, [0; 3]);
            let above = d.block(around, [-2 * r, -2 * r, base]);
            d.intersection(ball, above)
        }
        _ => {
            let ball = d.sphere(r, [0; 3]);
            let foot = d.cylinder(ModelAxis::Z, r, base, [0, 0, -base]);
            d.union(vec![ball, foot])
        }
    };
    let mut tools = Vec::new();
    if !d.once_in(3) {
        tools.push(d.sphere(r - t, [0; 3]));
        tools.push(d.cylinder(ModelAxis::Z, r - t, base + r, [0, 0, -base - r]));
    }
    match d.random.below(4) {
        0 => {
            let hole = d.part_of(r, 10, 40);
            tools.push(d.cylinder(ModelAxis::Z, hole, 2 * r, [0; 3]));
        }
        1 => {
            let hole = d.part_of(r, 10, 20);
            let up = r / 2;
            tools.push(d.cylinder(ModelAxis::X, hole, 4 * r, [-2 * r, 0, up]));
        }
        _ => {}
    }
    d.difference(body, tools)
}

/// A knob: a cylinder with a dome or a rounded rim, flats or grooves around, and a blind bore.
pub fn knob(d: &mut PartDraft<'_>) -> ModelNodeId {
    let (r, z) = (d.length(10, 30), d.length(8, 25));
    let mut body = vec![d.cylinder(ModelAxis::Z, r, z, [0; 3])];
    match d.random.below(4) {
        0 => body.push(d.sphere(r, [0, 0, z])),
        1 => {
            let minor = d.part_of(r, 20, 40);
            body.push(d.torus(ModelAxis::Z, r - minor, minor, [0, 0, z]));
            body.push(d.cylinder(ModelAxis::Z, r - minor, z + minor, [0; 3]));
        }
        2 => {
            let (narrow, up) = (d.part_of(r, 50, 80), d.part_of(r, 20, 50));
            body.push(d.frustum(r, narrow, up, [0, 0, z]));
        }
        _ => {}
    }
    if d.once_in(2) {
        let (foot, down) = (d.part_of(r, 40, 70), d.length(4, 15));
        body.push(d.cylinder(ModelAxis::Z, foot, down, [0, 0, -down]));
    }
    let body = d.union(body);
    let mut tools = Vec::new();
    match d.random.below(4) {
        0 => {
            // A flat, as on the shaft of a switch.
            let deep = d.part_of(r, 15, 35);
            tools.push(d.block(
                [deep + UNIT, 2 * r + 2 * UNIT, 3 * z],
                [r - deep, -r - UNIT, z / 2],
            ));
        }
        1 => {
            let count = d.random.choose(&[4, 6, 8, 10, 12]);
            let groove = r * 3 / count as PartLength;
            let groove = d.part_of(groove, 30, 60);
            let at = [r, 0, -UNIT];
            tools.extend(d.circle(count, |d| d.cylinder(ModelAxis::Z, groove, z + 2 * r, at)));
        }
        2 => {
            let wide = d.part_of(r, 60, 120);
            let low = z / 2;
            for x in [wide, -wide - 2 * r] {
                tools.push(d.block([2 * r, 2 * r + 2 * UNIT, 3 * z], [x, -r - UNIT, low]));
            }
        }
        _ => {}
    }
    if !d.once_in(3) {
        let (bore, deep) = (d.part_of(r, 15, 35), d.part_of(z, 40, 80));
        tools.push(d.cylinder(ModelAxis::Z, bore, deep + 20 * UNIT, [0, 0, -20 * UNIT]));
    }
    d.difference(body, tools)
}
