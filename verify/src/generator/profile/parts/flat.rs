//! Plates, brackets, clevises, links and wedges.

use super::draft::{PartDraft, PartLength, PlanePoint, UNIT};
use crate::generator::model::{ModelAxis, ModelNodeId};

/// A plate with sharp or rounded corners, holes at the corners, a bore and a slot.
pub fn plate(d: &mut PartDraft<'_>) -> ModelNodeId {
    let (x, y, z) = (d.length(40, 120), d.length(30, 80), d.length(3, 15));
    let corner = d.part_of(x.min(y), 8, 18);
    let body = match d.once_in(4) {
        true => d.block([x, y, z], [0; 3]),
        false => rounded_plate(d, [x, y, z], corner, [0; 3]),
    };
    let mut tools = Vec::new();
    if !d.once_in(4) {
        let (r, wide) = (d.part_of(corner, 25, 50), d.part_of(corner, 60, 80));
        let hole = d.hole(r, wide, z);
        for [u, v] in corners([x, y, z], corner) {
            tools.extend(d.drill(&hole, [u, v, z]));
        }
    }
    match d.random.below(3) {
        0 => {
            let r = d.part_of(x.min(y), 12, 22);
            let wide = d.part_of(x.min(y), 24, 28);
            let bore = d.hole(r, wide, z);
            tools.extend(d.drill(&bore, [x / 2, y / 2, z]));
        }
        1 => {
            let (long, r) = (d.part_of(x, 20, 50), d.part_of(y, 6, 15));
            let at = [x / 2, y / 2, -UNIT];
            tools.extend(slot(d, [long, 2 * r, z + 2 * UNIT], at));
        }
        _ => {}
    }
    if d.once_in(4) {
        // A pocket whose corners are rounded by the mill.
        let size = [x / 3, y / 5, z];
        let deep = d.part_of(z, 30, 60);
        let r = d.part_of(y / 5, 20, 40);
        tools.push(rounded_plate(d, size, r, [x / 3, corner, z - deep]));
    }
    d.difference(body, tools)
}

/// The centres of circles in the corners of a plate.
fn corners([x, y, _]: PlanePoint, r: PartLength) -> [[PartLength; 2]; 4] {
    [[r, r], [x - r, r], [r, y - r], [x - r, y - r]]
}

/// A plate with rounded corners: two blocks and four cylinders.
pub fn rounded_plate(
    d: &mut PartDraft<'_>,
    size: PlanePoint,
    r: PartLength,
    at: PlanePoint,
) -> ModelNodeId {
    let [x, y, z] = size;
    let mut all = vec![
        d.block([x, y - 2 * r, z], [at[0], at[1] + r, at[2]]),
        d.block([x - 2 * r, y, z], [at[0] + r, at[1], at[2]]),
    ];
    for [u, v] in corners(size, r) {
        all.push(d.cylinder(ModelAxis::Z, r, z, [at[0] + u, at[1] + v, at[2]]));
    }
    d.union(all)
}

/// A slot along x with round ends, about a position; its length is measured between the axes.
fn slot(d: &mut PartDraft<'_>, [long, wide, deep]: PlanePoint, at: PlanePoint) -> Vec<ModelNodeId> {
    let end = |x: PartLength| [at[0] + x, at[1], at[2]];
    vec![
        d.centred([long, wide, deep], at),
        d.cylinder(ModelAxis::Z, wide / 2, deep, end(-long / 2)),
        d.cylinder(ModelAxis::Z, wide / 2, deep, end(long / 2)),
    ]
}

/// A bracket of a base and a wall, with ribs, holes, a fillet between them or a round top.
pub fn bracket(d: &mut PartDraft<'_>) -> ModelNodeId {
    let (x, y, z) = (d.length(30, 80), d.length(20, 60), d.length(25, 70));
    let t = d.part_of(x.min(y).min(z), 12, 20);
    let mut body = vec![d.block([x, y, t], [0; 3])];
    let round = d.once_in(3) && z > t + y / 2;
    let high = if round { z - y / 2 } else { z };
    body.push(d.block([t, y, high], [0; 3]));
    if round {
        body.push(d.cylinder(ModelAxis::X, y / 2, t, [0, y / 2, high]));
    }
    match d.random.below(4) {
        0 => {
            let rib = d.part_of(y, 8, 15);
            let size = [x - t, rib, z / 2 - t];
            body.push(d.wedge(size, 0, [t, (y - rib) / 2, t]));
        }
        1 => {
            let rib = d.part_of(y, 6, 12);
            let size = [x - t, rib, z / 2 - t];
            body.push(d.wedge(size, 0, [t, 0, t]));
            body.push(d.wedge(size, 0, [t, y - rib, t]));
        }
        2 => {
            let r = d.part_of(x.min(z) - t, 10, 25);
            let corner = d.block([r, y, r], [t, 0, t]);
            let round = d.cylinder(ModelAxis::Y, r, y + 2 * UNIT, [t + r, -UNIT, t + r]);
            body.push(d.difference(corner, vec![round]));
        }
        _ => {}
    }
    let body = d.union(body);
    let mut tools = Vec::new();
    let free = x - t;
    let (r, wide) = (
        d.part_of(free.min(y), 8, 12),
        d.part_of(free.min(y), 14, 18),
    );
    let hole = d.hole(r, wide, t);
    for v in [y / 4, y - y / 4] {
        tools.extend(d.drill(&hole, [t + free * 3 / 4, v, t]));
    }
    if round || d.once_in(2) {
        let r = d.part_of(y, 15, 35);
        let up = if round { high } else { z - y / 4 - r / 2 };
        tools.push(d.cylinder(ModelAxis::X, r.min(y / 3), t + 2 * UNIT, [-UNIT, y / 2, up]));
    }
    d.difference(body, tools)
}

/// A base with two walls and a bore through both: a fork or a bearing block.
pub fn clevis(d: &mut PartDraft<'_>) -> ModelNodeId {
    let (x, y, z) = (d.length(30, 80), d.length(20, 50), d.length(30, 60));
    let t = d.part_of(x.min(y), 12, 22);
    let r = d.part_of(y, 18, 35);
    let round = d.once_in(2);
    let mut body = vec![d.block([x, y, t], [0; 3])];
    for u in [0, x - t] {
        body.push(d.block([t, y, z - t], [u, 0, t]));
        if round {
            body.push(d.cylinder(ModelAxis::X, y / 2, t, [u, y / 2, z]));
        }
    }
    if d.once_in(3) {
        let size = [(x - 2 * t) / 3, t / 2, z / 3];
        body.push(d.wedge(size, 0, [t, (y - t / 2) / 2, t]));
        body.push(d.wedge(size, 2, [x - t, (y + t / 2) / 2, t]));
    }
    let body = d.union(body);
    let up = if round { z } else { z - r - t / 2 };
    let mut tools = vec![d.cylinder(ModelAxis::X, r, x + 2 * UNIT, [-UNIT, y / 2, up])];
    if d.once_in(2) {
        let r = d.part_of(t.min(y), 15, 30);
        tools.push(d.cylinder(ModelAxis::Z, r, t + 2 * UNIT, [x / 2, y / 2, -UNIT]));
    }
    d.difference(body, tools)
}

/// A bar with round ends and a bore in each, one end perhaps higher or wider.
pub fn link(d: &mut PartDraft<'_>) -> ModelNodeId {
    let (long, r, z) = (d.length(30, 100), d.length(6, 18), d.length(4, 14));
    let wide = match d.random.below(3) {
        0 => 2 * r,
        1 => d.part_of(r, 80, 150),
        _ => r,
    };
    let boss = match d.once_in(2) {
        true => z,
        false => z + d.part_of(z, 20, 80),
    };
    let far = match d.once_in(2) {
        true => r,
        false => d.part_of(r, 60, 90).max(wide / 2),
    };
    let body = vec![
        d.block([long, wide, z], [0, -wide / 2, 0]),
        d.cylinder(ModelAxis::Z, r, boss, [0; 3]),
        d.cylinder(ModelAxis::Z, far, z, [long, 0, 0]),
    ];
    let body = d.union(body);
    let (near_bore, far_bore) = (d.part_of(r, 40, 70), d.part_of(far, 40, 70));
    let near = d.hole(near_bore, near_bore + (r - near_bore) / 2, boss);
    let far = d.hole(far_bore, far_bore, z);
    let mut tools = d.drill(&near, [0, 0, boss]);
    tools.extend(d.drill(&far, [long, 0, z]));
    if d.once_in(3) {
        let deep = d.part_of(z, 20, 40);
        let half = [long / 4, wide / 2, deep + UNIT];
        tools.extend(slot(d, half, [long / 2, 0, z - deep]));
    }
    d.difference(body, tools)
}

/// A ramp: a wedge on a base, or a block with a groove of two wedges, with holes.
pub fn wedge(d: &mut PartDraft<'_>) -> ModelNodeId {
    let (x, y, z) = (d.length(30, 80), d.length(20, 60), d.length(15, 50));
    let t = d.part_of(z, 15, 40);
    if d.once_in(3) {
        // A block with a groove in the shape of a V along y.
        let body = d.block([x, y, z], [0; 3]);
        let groove = [x / 3, y, t];
        let at = [x / 2, 0, z - t];
        let slopes = d.block([2 * groove[0], y, t], [at[0] - groove[0], 0, at[2]]);
        let left = d.wedge(groove, 0, [at[0] - groove[0], 0, at[2]]);
        let right = d.wedge(groove, 2, [at[0] + groove[0], y, at[2]]);
        let groove = d.difference(slopes, vec![left, right]);
        return d.difference(body, vec![groove]);
    }
    let base = d.block([x, y, t], [0; 3]);
    let ramp = d.wedge([x, y, z], 0, [0, 0, t]);
    let body = d.union(vec![base, ramp]);
    let r = d.part_of(x.min(y), 8, 18);
    let tool = match d.random.below(3) {
        0 => d.cylinder(ModelAxis::Z, r, t + z + 2 * UNIT, [x / 2, y / 2, -UNIT]),
        1 => d.cylinder(
            ModelAxis::Y,
            r.min(t / 3),
            y + 2 * UNIT,
            [x / 4, -UNIT, t / 2],
        ),
        _ => d.sphere(r, [x / 2, y / 2, t + z / 2]),
    };
    d.difference(body, vec![tool])
}
