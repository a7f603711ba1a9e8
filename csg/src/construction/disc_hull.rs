//! Hulls of discs and points in parallel planes: cones between discs, and planes between them.
//!
//! Notation: a disc k at the height z_k has the support s_k(n) = c_k·n + r_k in the direction n. At
//! one n the hull has the upper hull of the points (z_k, s_k) as its profile, a chain of discs. Where
//! two discs follow each other in the chain for a range of n, the hull has a face of the cone around
//! both; their own hull, an oblique frustum, is part of it. The chain changes where three points of it
//! are in line, or where two discs in one plane have the same support. There a plane touches the discs
//! of the chain. The polyhedron of all these points of contact is the rest of the hull.

use std::collections::BTreeSet;
use std::f64::consts::TAU;
use std::sync::Arc;

use premio_kernel::number::predicates::Compare;
use premio_kernel::number::rational::{Rational, to_f64};

use super::ConstructionError;
use crate::builder::{Builder, SolidId};
use crate::figure::{Disc, Figure, HullElement, root, shortened};
use crate::polyhedron::{Polyhedron, PolyhedronError, SpacePoint};
use crate::primitive::Primitive;
use crate::transform::Transform;
use crate::tree::Operation;

/// The largest number of events that are looked at.
const MAX_EVENTS: usize = 1 << 18;

/// The angle below which two changes of the chain are one, in radians.
const TOGETHER: f64 = 1.0 / (1u64 << 32) as f64;

/// The number of directions in which an arc is compared with the figure around it.
const DIRECTIONS: u32 = 720;

/// The relative rounding of a support.
const ROUNDING: f64 = 1.0 / (1u64 << 40) as f64;

/// A disc at a height.
struct RaisedDisc {
    disc: Disc,
    height: Rational,
    /// The index of its plane.
    level: usize,
    centre: [f64; 2],
    radius: f64,
}

impl RaisedDisc {
    fn support(&self, [x, y]: [f64; 2]) -> f64 {
        self.centre[0] * x + self.centre[1] * y + self.radius
    }
}

/// A direction in which a plane may touch several discs: n with v·n = d.
struct Event {
    angle: f64,
    /// v, d, and the side of v on which n lies.
    vector: [Rational; 2],
    distance: Rational,
    is_left: bool,
}

impl Event {
    /// Both directions n with v·n = d, where they exist.
    fn both(vector: [Rational; 2], distance: &Rational) -> Vec<Self> {
        let [x, y] = vector.each_ref().map(to_f64);
        let size = x.hypot(y);
        let part = to_f64(distance) / size;
        // Next to the end of its range the angle needs the exact difference of the squares.
        let square = &vector[0] * &vector[0] + &vector[1] * &vector[1] - distance * distance;
        if square < Rational::ZERO || !part.is_finite() {
            return Vec::new();
        }
        let half = (to_f64(&square).sqrt() / size).atan2(part);
        let at = |is_left: bool| Self {
            angle: (y.atan2(x) + if is_left { half } else { -half }).rem_euclid(TAU),
            vector: vector.clone(),
            distance: distance.clone(),
            is_left,
        };
        match square.is_zero() {
            true => vec![at(true)],
            false => vec![at(true), at(false)],
        }
    }

    /// The unit vector n, rounded once.
    fn normal(&self) -> [Rational; 2] {
        let [x, y] = &self.vector;
        let square = x * x + y * y;
        let across = root(&(&square - &self.distance * &self.distance));
        let across = if self.is_left { across } else { -across };
        let d = &self.distance;
        [
            shortened(&((d * x - &across * y) / &square)),
            shortened(&((d * y + &across * x) / &square)),
        ]
    }
}

/// The hull of elements at heights along z. Empty if it is flat.
///
/// # Errors
/// An arc is a part of the hull, but its whole disc is not, or there are too many discs.
pub(super) fn disc_hull(
    builder: &mut Builder,
    elements: &[(Rational, HullElement)],
) -> Result<SolidId, ConstructionError> {
    let discs = raised_discs(elements)?;
    let events = events(&discs)?;
    let mut pairs: BTreeSet<[usize; 2]> = BTreeSet::new();
    let mut points: Vec<SpacePoint> = Vec::new();
    if events.is_empty() {
        pairs.extend(steps(&chain(&discs, 0.0)));
    }
    for group in groups(&events) {
        let (first, last) = (group.first, group.last);
        let chains = [group.before, group.after].map(|angle| chain(&discs, angle));
        pairs.extend(chains.iter().flat_map(|chain| steps(chain)));
        if chains[0] == chains[1] {
            continue;
        }
        let touched: BTreeSet<usize> = chains.concat().into_iter().collect();
        let mut normals: Vec<[Rational; 2]> = Vec::new();
        for event in (first..=last).map(|k| &events[k % events.len()]) {
            let normal = event.normal();
            let is_known = normals.iter().any(|known| {
                let apart = (0..2).map(|i| to_f64(&(&known[i] - &normal[i])).abs());
                apart
                    .fold(0.0, f64::max)
                    .is_at_most(f64::EPSILON * f64::EPSILON)
            });
            if !is_known {
                normals.push(normal);
            }
        }
        for normal in &normals {
            points.extend(touched.iter().map(|&k| point_of_contact(&discs[k], normal)));
        }
    }
    let mut parts = Vec::new();
    for [low, high] in pairs {
        parts.extend(frustum(builder, &discs[low], &discs[high])?);
    }
    match Polyhedron::convex_hull(&points) {
        Ok(hull) => {
            let polyhedron = Arc::new(hull);
            parts.push(builder.primitive(Primitive::Polyhedron { polyhedron }));
        }
        // The points of few discs may lie in a plane.
        Err(PolyhedronError::Empty) => {}
        Err(error) => return Err(error.into()),
    }
    Ok(builder.operation(Operation::Union, &parts))
}

/// The discs in the corners of the elements of each plane, in the order of their heights.
fn raised_discs(
    elements: &[(Rational, HullElement)],
) -> Result<Vec<RaisedDisc>, ConstructionError> {
    let mut heights: Vec<&Rational> = elements.iter().map(|(height, _)| height).collect();
    heights.sort_unstable();
    heights.dedup();
    let mut discs = Vec::new();
    for (level, height) in heights.into_iter().enumerate() {
        let own = elements.iter().filter(|(z, _)| z == height);
        let own: Vec<HullElement> = own.map(|(_, element)| element.clone()).collect();
        for disc in corner_discs(&own)? {
            discs.push(RaisedDisc {
                centre: disc.centre.each_ref().map(to_f64),
                radius: to_f64(&disc.radius),
                disc,
                height: height.clone(),
                level,
            });
        }
    }
    Ok(discs)
}

/// The discs in the corners of the hull of elements in a plane.
fn corner_discs(own: &[HullElement]) -> Result<Vec<Disc>, ConstructionError> {
    let Ok(figure) = Figure::hull_of_elements(own) else {
        // Points in a line have no figure.
        let mut discs: Vec<Disc> = Vec::new();
        for element in own {
            if !discs.contains(element.disc()) {
                discs.push(element.disc().clone());
            }
        }
        return Ok(discs);
    };
    let edges = figure.edges();
    let mut discs: Vec<Disc> = Vec::new();
    for (k, edge) in edges.iter().enumerate() {
        let before = &edges[(k + edges.len() - 1) % edges.len()];
        let disc = match &edge.arc {
            Some(arc) => Disc {
                centre: arc.centre.clone(),
                radius: arc.radius.clone(),
            },
            None if before.arc.is_none() => Disc::point(edge.start.clone()),
            None => continue,
        };
        if !discs.contains(&disc) {
            discs.push(disc);
        }
    }
    match own.iter().any(|e| matches!(e, HullElement::Arc { .. })) && !are_whole(own, &discs) {
        true => Err(ConstructionError::NoHull),
        false => Ok(discs),
    }
}

/// Whether discs are parts of the hull of elements, by their supports.
fn are_whole(own: &[HullElement], discs: &[Disc]) -> bool {
    let support = |disc: &Disc, [x, y]: [f64; 2]| {
        let [a, b] = disc.centre.each_ref().map(to_f64);
        a * x + b * y + to_f64(&disc.radius)
    };
    let size = own.iter().map(HullElement::reach).fold(0.0, f64::max);
    (0..DIRECTIONS).all(|k| {
        let (y, x) = (TAU * f64::from(k) / f64::from(DIRECTIONS)).sin_cos();
        let reach = own.iter().map(|element| match element {
            HullElement::Disc(disc) => support(disc, [x, y]),
            HullElement::Arc { disc, ends } => {
                let [from, to] = ends.each_ref().map(|end| {
                    let [a, b] = [0, 1].map(|i| to_f64(&(&end[i] - &disc.centre[i])));
                    b.atan2(a)
                });
                let turned = (y.atan2(x) - from).rem_euclid(TAU);
                match turned.is_at_most((to - from).rem_euclid(TAU)) {
                    true => support(disc, [x, y]),
                    false => {
                        let of = |end: &[Rational; 2]| to_f64(&end[0]) * x + to_f64(&end[1]) * y;
                        of(&ends[0]).max(of(&ends[1]))
                    }
                }
            }
        });
        let reach = reach.fold(f64::NEG_INFINITY, f64::max);
        let mut all = discs.iter().map(|disc| support(disc, [x, y]));
        all.all(|own| own.is_at_most(reach + ROUNDING * size))
    })
}

/// The directions in which the chain may change, by their angles.
fn events(discs: &[RaisedDisc]) -> Result<Vec<Event>, ConstructionError> {
    let mut events = Vec::new();
    let count = discs.len();
    for i in 0..count {
        for j in i + 1..count {
            let [a, b] = [&discs[i], &discs[j]];
            if a.level == b.level {
                let vector = [0, 1].map(|k| &a.disc.centre[k] - &b.disc.centre[k]);
                events.extend(Event::both(vector, &(&b.disc.radius - &a.disc.radius)));
                continue;
            }
            for c in discs[j + 1..].iter().filter(|c| c.level != b.level) {
                // (z_c - z_b) s_a + (z_a - z_c) s_b + (z_b - z_a) s_c = 0
                let weights = [
                    &c.height - &b.height,
                    &a.height - &c.height,
                    &b.height - &a.height,
                ];
                let sum = |of: &dyn Fn(&Disc) -> Rational| {
                    let all = weights.iter().zip([a, b, c]);
                    all.fold(Rational::ZERO, |sum, (weight, d)| {
                        sum + weight * of(&d.disc)
                    })
                };
                let vector = [0, 1].map(|k| sum(&|d| d.centre[k].clone()));
                let distance = -sum(&|d| d.radius.clone());
                if !vector.iter().all(Rational::is_zero) {
                    events.extend(Event::both(vector, &distance));
                }
            }
            if events.len() > MAX_EVENTS {
                return Err(ConstructionError::NoHull);
            }
        }
    }
    events.sort_by(|a, b| a.angle.total_cmp(&b.angle));
    Ok(events)
}

/// Consecutive events that are one, by their indices, and directions before and after them.
struct Group {
    first: usize,
    last: usize,
    before: f64,
    after: f64,
}

/// The groups of events. An index beyond the last event is one of the next turn.
fn groups(events: &[Event]) -> Vec<Group> {
    let count = events.len();
    let angle = |k: usize| {
        let turns = TAU * f64::from(u32::try_from(k / count).unwrap_or_default());
        events[k % count].angle + turns
    };
    let gap = |k: usize| angle(k + 1) - angle(k);
    // A group starts after a gap.
    let starts: Vec<usize> = (1..=count)
        .filter(|&k| gap(k - 1).is_beyond(TOGETHER))
        .collect();
    let groups = starts.iter().enumerate().map(|(i, &first)| {
        let next = starts.get(i + 1).copied().unwrap_or(starts[0] + count);
        let last = next - 1;
        Group {
            first,
            last,
            before: 0.5 * (angle(first - 1) + angle(first)),
            after: 0.5 * (angle(last) + angle(last + 1)),
        }
    });
    groups.collect()
}

/// The discs of the upper hull of the supports in a direction, from the lowest plane to the highest.
fn chain(discs: &[RaisedDisc], angle: f64) -> Vec<usize> {
    let (y, x) = angle.sin_cos();
    let support = |k: usize| discs[k].support([x, y]);
    let mut highest: Vec<usize> = Vec::new();
    for (k, disc) in discs.iter().enumerate() {
        match highest.last().copied() {
            Some(known) if discs[known].level == disc.level => {
                if support(k).is_beyond(support(known)) {
                    highest.pop();
                    highest.push(k);
                }
            }
            _ => highest.push(k),
        }
    }
    let mut chain: Vec<usize> = Vec::new();
    for k in highest {
        while let [.., a, b] = chain[..] {
            let up = |k: usize| to_f64(&(&discs[k].height - &discs[a].height));
            let grown = |k: usize| support(k) - support(a);
            if (grown(b) * up(k)).is_beyond(grown(k) * up(b)) {
                break;
            }
            chain.pop();
        }
        chain.push(k);
    }
    chain
}

/// The pairs of consecutive discs of a chain.
fn steps(chain: &[usize]) -> Vec<[usize; 2]> {
    chain.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}

/// The point in which a plane with a horizontal normal n touches the rim of a disc.
fn point_of_contact(disc: &RaisedDisc, normal: &[Rational; 2]) -> SpacePoint {
    let [x, y] = [0, 1].map(|i| &disc.disc.centre[i] + &disc.disc.radius * &normal[i]);
    [x, y, disc.height.clone()]
}

/// The hull of two discs, unless both are points.
fn frustum(
    builder: &mut Builder,
    low: &RaisedDisc,
    high: &RaisedDisc,
) -> Result<Option<SolidId>, ConstructionError> {
    let is_reversed = low.disc.radius < high.disc.radius;
    let [base, top] = if is_reversed {
        [high, low]
    } else {
        [low, high]
    };
    let radius = &base.disc.radius;
    if radius.is_zero() {
        return Ok(None);
    }
    let [x, y] = [0, 1].map(|i| &top.disc.centre[i] - &base.disc.centre[i]);
    let [a, b] = base.disc.centre.clone();
    let is_right = x.is_zero() && y.is_zero();
    let (primitive, place) = if is_right {
        let height = &high.height - &low.height;
        let radii = [low, high].map(|end| end.disc.radius.clone());
        let [base, top] = radii;
        (
            Primitive::frustum(base, top, height)?,
            [a, b, low.height.clone()],
        )
    } else {
        let zero = || Rational::ZERO;
        let axes = [
            [radius.clone(), zero(), zero()],
            [zero(), radius.clone(), zero()],
            [x, y, &top.height - &base.height],
        ];
        (
            Primitive::oblique_frustum(axes, &top.disc.radius / radius)?,
            [a, b, base.height.clone()],
        )
    };
    let part = builder.primitive(primitive);
    Ok(Some(builder.moved(part, Transform::shift(place))))
}
