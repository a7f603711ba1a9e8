//! Housings and pipe elbows.

use super::draft::{PartDraft, PartLength, UNIT};
use super::flat::rounded_plate;
use crate::generator::model::{ModelAxis, ModelNodeId};

/// A hollow box, open above or closed, with bosses in its corners, blind holes and a window.
pub fn housing(d: &mut PartDraft<'_>) -> ModelNodeId {
    let (x, y, z) = (d.length(40, 100), d.length(30, 80), d.length(20, 60));
    let t = d.part_of(y.min(z), 6, 14);
    let r = match d.once_in(2) {
        true => None,
        false => Some(t + d.part_of(t, 50, 150)),
    };
    let outer = match r {
        Some(r) => rounded_plate(d, [x, y, z], r, [0; 3]),
        None => d.block([x, y, z], [0; 3]),
    };
    let closed = d.once_in(6);
    let high = if closed { z - 2 * t } else { z };
    let inside = [x - 2 * t, y - 2 * t, high];
    let hollow = match r {
        Some(r) => rounded_plate(d, inside, r - t, [t, t, t]),
        None => d.block(inside, [t, t, t]),
    };
    let mut body = d.difference(outer, vec![hollow]);
    let mut tools = Vec::new();
    let boss = d.part_of(x.min(y), 8, 12).max(r.map_or(0, |r| r - t));
    let up = if closed {
        high
    } else {
        d.part_of(high, 40, 100).min(z - t)
    };
    match d.random.below(3) {
        0 => {
            // In the corners, along both walls.
            let mut all = vec![body];
            for u in [t + boss, x - t - boss] {
                for v in [t + boss, y - t - boss] {
                    all.push(d.cylinder(ModelAxis::Z, boss, up, [u, v, t]));
                    let (hole, deep) = (boss / 2, up * 2 / 3);
                    if !closed {
                        tools.push(d.cylinder(ModelAxis::Z, hole, z, [u, v, t + up - deep]));
                    }
                }
            }
            body = d.union(all);
        }
        1 => {
            // One in the middle of the floor, through it.
            let boss = d.cylinder(ModelAxis::Z, boss, up.min(z / 2), [x / 2, y / 2, t]);
            body = d.union(vec![body, boss]);
            let hole = d.part_of(x.min(y), 3, 6);
            tools.push(d.cylinder(ModelAxis::Z, hole, z + UNIT, [x / 2, y / 2, -UNIT]));
        }
        _ => {}
    }
    match d.random.below(4) {
        0 => {
            let r = d.part_of(y.min(z) - 2 * t, 15, 35);
            tools.push(d.cylinder(ModelAxis::X, r, t + 2 * UNIT, [-UNIT, y / 2, z / 2]));
        }
        1 => {
            let r = d.part_of(y.min(z) - 2 * t, 10, 30);
            tools.push(d.cylinder(ModelAxis::X, r, x + 2 * UNIT, [-UNIT, y / 2, z / 2]));
        }
        2 => {
            let size = [x / 3, t + 2 * UNIT, z / 3];
            tools.push(d.block(size, [x / 3, -UNIT, z / 3]));
        }
        _ => {}
    }
    d.difference(body, tools)
}

/// A pipe bend, a quarter of a torus, with straight ends, flanges and a bore through everything.
pub fn elbow(d: &mut PartDraft<'_>) -> ModelNodeId {
    let r = d.length(6, 20);
    let bend = r + d.part_of(r, 30, 150);
    let ends = [d.length(5, 40), d.length(5, 40)];
    let mut body = pipe(d, bend, r, ends);
    let t = d.part_of(r, 20, 40);
    if d.once_in(2) {
        let wide = d.part_of(r, 140, 180).min(bend + ends[1] - t);
        let flange = d.cylinder(ModelAxis::Y, wide, t, [bend, -ends[0], 0]);
        body = d.union(vec![body, flange]);
    }
    if d.once_in(4) {
        return body;
    }
    let bore = d.part_of(r, 50, 85);
    let tool = pipe(d, bend, bore, ends.map(|end| end + UNIT));
    d.difference(body, vec![tool])
}

/// A pipe along y at x = `bend` that continues along x at y = `bend`.
fn pipe(
    d: &mut PartDraft<'_>,
    bend: PartLength,
    r: PartLength,
    [down, left]: [PartLength; 2],
) -> ModelNodeId {
    let ring = d.torus(ModelAxis::Z, bend, r, [0; 3]);
    let size = bend + 2 * r;
    let quarter = d.block([size, size, 4 * r], [0, 0, -2 * r]);
    let quarter = d.intersection(ring, quarter);
    let first = d.cylinder(ModelAxis::Y, r, down, [bend, -down, 0]);
    let second = d.cylinder(ModelAxis::X, r, left, [-left, bend, 0]);
    d.union(vec![quarter, first, second])
}
