//! Flanges, shafts, bearings and pulleys.

use super::draft::{PartDraft, PartLength, UNIT};
use crate::generator::model::{ModelAxis, ModelNodeId};

/// A disc with a bore, a hub, a raised face and a circle of bolts.
pub fn flange(d: &mut PartDraft<'_>) -> ModelNodeId {
    let (r, z) = (d.length(25, 60), d.length(5, 15));
    let mut body = vec![d.cylinder(ModelAxis::Z, r, z, [0; 3])];
    let hub = d.part_of(r, 35, 55);
    let mut high = z;
    match d.random.below(4) {
        0 => {
            high += d.length(5, 30);
            body.push(d.cylinder(ModelAxis::Z, hub, high, [0; 3]));
        }
        1 => {
            let (up, narrow) = (d.length(5, 30), d.part_of(hub, 75, 95));
            body.push(d.frustum(hub, narrow, up, [0, 0, z]));
            high += up;
        }
        2 => {
            high += d.part_of(z, 10, 30);
            body.push(d.cylinder(ModelAxis::Z, hub, high, [0; 3]));
        }
        _ => {}
    }
    let body = d.union(body);
    let bore = d.part_of(hub, 40, 70);
    let wide = d.part_of(hub, 72, 74);
    let hole = d.hole(bore, wide, high);
    let mut tools = d.drill(&hole, [0, 0, high]);
    let count = d.random.choose(&[3, 4, 4, 5, 6, 6, 8, 12]);
    let circle = (r + hub) / 2;
    let room = ((r - hub) / 2).min(circle * 2 / count as PartLength);
    let (bolt, head) = (d.part_of(room, 30, 55), d.part_of(room, 60, 80));
    let hole = d.hole(bolt, head, z);
    tools.extend(d.circle(count, |d| {
        let hole = d.drill(&hole, [circle, 0, z]);
        d.union(hole)
    }));
    if d.once_in(4) {
        // A keyway.
        let wide = d.part_of(bore, 30, 60);
        tools.push(d.block([bore * 5 / 4, wide, high + 2 * UNIT], [0, -wide / 2, -UNIT]));
    }
    d.difference(body, tools)
}

/// Steps about one axis, with chamfers, grooves, a cross hole, a keyway and centre holes.
pub fn shaft(d: &mut PartDraft<'_>) -> ModelNodeId {
    let mut body = Vec::new();
    let mut tools = Vec::new();
    let mut up = 0;
    let count = d.random.between(1, 5);
    let chamfered = d.once_in(2);
    let mut widest = 0;
    let mut last = 0;
    for k in 0..count {
        let (r, h) = (d.length(5, 25), d.length(8, 40));
        let chamfer = d.part_of(r.min(h), 8, 20);
        let [mut low, mut top] = [up, up + h];
        if chamfered && k == 0 {
            body.push(d.frustum(r - chamfer, r, chamfer, [0, 0, low]));
            low += chamfer;
        }
        if chamfered && k + 1 == count {
            top -= chamfer;
            body.push(d.frustum(r, r - chamfer, chamfer, [0, 0, top]));
        }
        body.push(d.cylinder(ModelAxis::Z, r, top - low, [0, 0, low]));
        match d.random.below(8) {
            0 => {
                // A groove of rectangular section.
                let (wide, deep) = (d.part_of(h, 15, 30), d.part_of(r, 10, 25));
                let at = [0, 0, up + (h - wide) / 2];
                let ring = d.cylinder(ModelAxis::Z, r + UNIT, wide, at);
                let core = d.cylinder(ModelAxis::Z, r - deep, wide, at);
                tools.push(d.difference(ring, vec![core]));
            }
            1 => {
                // A round groove.
                let minor = d.part_of(h.min(r), 10, 25);
                tools.push(d.torus(ModelAxis::Z, r, minor, [0, 0, up + h / 2]));
            }
            2 => {
                let hole = d.part_of(h.min(r), 15, 40);
                tools.push(d.cylinder(
                    ModelAxis::X,
                    hole,
                    2 * r + 2 * UNIT,
                    [-r - UNIT, 0, up + h / 2],
                ));
            }
            3 => {
                // A keyway with round ends.
                let wide = d.part_of(r, 30, 50);
                let deep = d.part_of(r, 15, 30);
                let long = h / 3;
                let at = [r - deep, -wide / 2, up + h / 3];
                tools.push(d.block([deep + UNIT, wide, long], at));
                for v in [up + h / 3, up + h / 3 + long] {
                    tools.push(d.cylinder(ModelAxis::X, wide / 2, deep + UNIT, [r - deep, 0, v]));
                }
            }
            4 => {
                // A flat.
                let deep = d.part_of(r, 15, 40);
                tools.push(d.block(
                    [deep + UNIT, 2 * r + 2 * UNIT, h],
                    [r - deep, -r - UNIT, up],
                ));
            }
            5 => {
                let minor = d.part_of(h.min(r), 10, 25);
                body.push(d.torus(ModelAxis::Z, r, minor, [0, 0, up + h / 2]));
            }
            _ => {}
        }
        up += h;
        widest = r.max(widest);
        last = r;
    }
    match d.random.below(5) {
        0 => {
            let r = d.part_of(last, 20, 50);
            let hole = d.hole(r, r, up);
            tools.extend(d.drill(&hole, [0, 0, up]));
        }
        1 => {
            // A centre hole.
            let r = d.part_of(last, 20, 40);
            tools.push(d.frustum(0, r, r, [0, 0, up - r]));
        }
        2 => {
            let r = last / 2;
            let hole = d.part_of(r, 20, 40);
            tools.push(d.cylinder(
                ModelAxis::Y,
                hole,
                2 * widest + 2 * UNIT,
                [0, -widest - UNIT, up / 2],
            ));
        }
        _ => {}
    }
    let body = d.union(body);
    d.difference(body, tools)
}

/// Two rings with grooves, and balls between them.
pub fn bearing(d: &mut PartDraft<'_>) -> ModelNodeId {
    let ball = d.length(3, 8);
    let (bore, wide) = (d.length(8, 25), d.part_of(ball, 240, 320));
    let pitch = bore + d.part_of(ball, 150, 180);
    let groove = match d.once_in(2) {
        true => ball,
        false => ball + d.part_of(ball, 3, 8),
    };
    let gap = d.part_of(ball, 30, 60);
    let low = -wide / 2;
    let outside = pitch + (pitch - bore);
    let mut parts = Vec::new();
    let solid = d.cylinder(ModelAxis::Z, outside, wide, [0, 0, low]);
    let hole = d.cylinder(
        ModelAxis::Z,
        pitch + gap,
        wide + 2 * UNIT,
        [0, 0, low - UNIT],
    );
    let tube = d.torus(ModelAxis::Z, pitch, groove, [0; 3]);
    parts.push(d.difference(solid, vec![hole, tube]));
    let solid = d.cylinder(ModelAxis::Z, pitch - gap, wide, [0, 0, low]);
    let hole = d.cylinder(ModelAxis::Z, bore, wide + 2 * UNIT, [0, 0, low - UNIT]);
    let tube = d.torus(ModelAxis::Z, pitch, groove, [0; 3]);
    parts.push(d.difference(solid, vec![hole, tube]));
    if groove > ball {
        // As many as fit, up to twelve.
        let most = (6 * pitch / (2 * ball + UNIT)).clamp(3, 12) as usize;
        let count = d.random.between(3, most);
        parts.extend(d.circle(count, |d| d.sphere(ball, [pitch, 0, 0])));
    }
    match d.random.below(6) {
        0 => {
            // A single ring.
            let both = d.union(parts);
            let inside = d.cylinder(ModelAxis::Z, pitch - gap, wide, [0, 0, low]);
            d.intersection(both, inside)
        }
        _ => d.union(parts),
    }
}

/// A wheel with a groove for a belt or a rope, holes in its web, a hub and a bore.
pub fn pulley(d: &mut PartDraft<'_>) -> ModelNodeId {
    let (r, z) = (d.length(25, 60), d.length(8, 24));
    let disc = d.cylinder(ModelAxis::Z, r, z, [0; 3]);
    let hub = d.part_of(r, 25, 40);
    let high = z + d.part_of(z, 20, 60);
    let hub_body = d.cylinder(ModelAxis::Z, hub, high, [0; 3]);
    let body = d.union(vec![disc, hub_body]);
    let deep = d.part_of(z, 20, 40);
    let mut tools = Vec::new();
    match d.random.below(3) {
        0 => tools.push(d.torus(ModelAxis::Z, r, deep, [0, 0, z / 2])),
        1 => {
            // A groove in the shape of a V.
            let at = [0, 0, z / 2 - deep];
            let ring = d.cylinder(ModelAxis::Z, r + UNIT, 2 * deep, at);
            let low = d.frustum(r, r - deep, deep, at);
            let top = d.frustum(r - deep, r, deep, [0, 0, z / 2]);
            tools.push(d.difference(ring, vec![low, top]));
        }
        _ => {
            let at = [0, 0, z / 2 - deep];
            let ring = d.cylinder(ModelAxis::Z, r + UNIT, 2 * deep, at);
            let core = d.cylinder(ModelAxis::Z, r - deep, 2 * deep, at);
            tools.push(d.difference(ring, vec![core]));
        }
    }
    let bore = d.part_of(hub, 40, 70);
    let hole = d.hole(bore, bore, high);
    tools.extend(d.drill(&hole, [0, 0, high]));
    let free = r - deep - hub;
    if free > 4 * UNIT {
        let count = d.random.choose(&[3, 4, 5, 6]);
        let hole = d.part_of(free, 20, 35);
        let at = [hub + free / 2, 0, -UNIT];
        tools.extend(d.circle(count, |d| d.cylinder(ModelAxis::Z, hole, z + 2 * UNIT, at)));
    }
    d.difference(body, tools)
}
