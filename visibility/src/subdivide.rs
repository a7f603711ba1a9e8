//! Crossings in the image of two curves without a closed form, by certified subdivision.
//!
//! The pair of parameter intervals is halved until the images are apart, or the Jacobian of the
//! difference keeps its sign over the pair: then Newton's steps decide whether there is a crossing
//! in it, and there is at most one.

use crate::crossing::Overlap;
use crate::image::flat_point;
use crate::projection::Projection;
use crate::strand::Strand;
use premio_kernel::number::interval::Interval;
use premio_kernel::number::jet::Jet;

/// Halvings of the pair after which it is given up as overlapping or touching.
const DEPTH: u32 = 26;
/// Halvings after which a pair of pieces of one curve counts as next to a cusp.
const CUSP_DEPTH: u32 = 8;
/// So many pairs given up mean that the curves fall on one another.
const MANY: usize = 64;
/// So many pairs are looked at.
const WORK: usize = 20_000;

struct Pair {
    t: [f64; 2],
    s: [f64; 2],
    depth: u32,
}

fn over(strand: &Strand<'_>, projection: &Projection, t: [f64; 2]) -> [Jet<Interval>; 2] {
    let wide = flat_point(projection, strand.curve.jet_over(Interval::new(t[0], t[1])));
    let middle = 0.5 * (t[0] + t[1]);
    let centre = flat_point(projection, strand.curve.jet_over(Interval::point(middle)));
    let run = Interval::new(t[0], t[1]) - Interval::point(middle);
    std::array::from_fn(|i| {
        let mut jet = wide[i];
        if jet.d.width().is_finite() {
            jet.v = jet.v.meet(centre[i].v + jet.d * run);
        }
        jet
    })
}

/// Reports the crossings of two general curves in the image.
pub fn general_pair(
    a: &Strand<'_>,
    b: &Strand<'_>,
    projection: &Projection,
    band: f64,
    found: &mut impl FnMut(f64, f64),
) -> Overlap {
    let ta = a.curve.breaks(a.range[0], a.range[1]);
    let tb = b.curve.breaks(b.range[0], b.range[1]);
    let same = std::ptr::eq(a, b);
    let mut stack = Vec::new();
    for (i, t) in ta.windows(2).enumerate() {
        for (j, s) in tb.windows(2).enumerate() {
            if !same || i <= j {
                stack.push(Pair {
                    t: [t[0], t[1]],
                    s: [s[0], s[1]],
                    depth: 0,
                });
            }
        }
    }
    let (mut given_up, mut work) = (0, 0);
    let mut roots: Vec<(f64, f64)> = Vec::new();
    while let Some(pair) = stack.pop() {
        work += 1;
        if given_up > MANY || work > WORK {
            return Overlap::Yes;
        }
        if same && (pair.t == pair.s || pair.t[1] == pair.s[0]) && monotone(a, projection, &pair) {
            continue;
        }
        let (x, y) = (over(a, projection, pair.t), over(b, projection, pair.s));
        let apart = (0..2).any(|i| !x[i].v.meets(y[i].v));
        if apart {
            continue;
        }
        let det = x[0].d * y[1].d - x[1].d * y[0].d;
        if !det.has_zero() {
            if let Some((t, s)) = newton(a, b, projection, &pair) {
                let near = |r: &(f64, f64)| {
                    let d = |c: &Strand<'_>, u: f64, v: f64| {
                        (c.curve.point(u) - c.curve.point(v)).norm()
                    };
                    d(a, r.0, t) <= 16.0 * band && d(b, r.1, s) <= 16.0 * band
                };
                if !roots.iter().any(near) {
                    roots.push((t, s));
                    found(t, s);
                }
            }
            continue;
        }
        if pair.depth >= DEPTH {
            given_up += 1;
            continue;
        }
        // Next to one cusp, and only one, a curve does not cross itself.
        if same && pair.depth >= CUSP_DEPTH && around_one(a, &pair) {
            continue;
        }
        halve(pair, x, y, &mut stack);
    }
    Overlap::No
}

/// Whether a curve cannot cross itself over the pair: its image keeps a direction there.
fn monotone(a: &Strand<'_>, projection: &Projection, pair: &Pair) -> bool {
    let whole = [pair.t[0].min(pair.s[0]), pair.t[1].max(pair.s[1])];
    if pair.t[1] < pair.s[0] {
        return false;
    }
    // Within one smooth piece only; across a break both sides have to agree on a direction.
    if pair.t == pair.s {
        let x = over(a, projection, whole);
        return (0..2).any(|i| !x[i].d.has_zero());
    }
    let (x, y) = (over(a, projection, pair.t), over(a, projection, pair.s));
    // The parameter of each piece has its own speed, but both run the same way.
    (0..2).any(|i| !x[i].d.hull(y[i].d).has_zero())
}

/// Whether exactly one cusp lies between the outer ends of the pair, and no more than one piece
/// on either side of it.
fn around_one(a: &Strand<'_>, pair: &Pair) -> bool {
    let (lo, hi) = (pair.t[0].min(pair.s[0]), pair.t[1].max(pair.s[1]));
    let width = (pair.t[1] - pair.t[0]).max(pair.s[1] - pair.s[0]);
    let within = |t: f64| t >= lo && t <= hi;
    let near = hi - lo <= 4.0 * width;
    near && a.splits.iter().filter(|m| within(m.t)).count() == 1
}

fn halve(pair: Pair, x: [Jet<Interval>; 2], y: [Jet<Interval>; 2], stack: &mut Vec<Pair>) {
    let size = |j: &[Jet<Interval>; 2]| j[0].v.width().max(j[1].v.width());
    let depth = pair.depth + 1;
    if pair.t == pair.s {
        // The diagonal of a curve with itself stays a diagonal.
        let m = 0.5 * (pair.t[0] + pair.t[1]);
        let (lo, hi) = ([pair.t[0], m], [m, pair.t[1]]);
        for (t, s) in [(lo, lo), (lo, hi), (hi, hi)] {
            stack.push(Pair { t, s, depth });
        }
    } else if size(&x) >= size(&y) {
        let m = 0.5 * (pair.t[0] + pair.t[1]);
        for t in [[pair.t[0], m], [m, pair.t[1]]] {
            stack.push(Pair { t, depth, ..pair });
        }
    } else {
        let m = 0.5 * (pair.s[0] + pair.s[1]);
        for s in [[pair.s[0], m], [m, pair.s[1]]] {
            stack.push(Pair { s, depth, ..pair });
        }
    }
}

/// The only crossing that the pair can hold.
fn newton(
    a: &Strand<'_>,
    b: &Strand<'_>,
    projection: &Projection,
    pair: &Pair,
) -> Option<(f64, f64)> {
    let (mut t, mut s) = (0.5 * (pair.t[0] + pair.t[1]), 0.5 * (pair.s[0] + pair.s[1]));
    for _ in 0..30 {
        let x = flat_point(projection, a.curve.jet(t));
        let y = flat_point(projection, b.curve.jet(s));
        let (fx, fy) = (x[0].v - y[0].v, x[1].v - y[1].v);
        let det = x[1].d * y[0].d - x[0].d * y[1].d;
        let dt = (fx * y[1].d - fy * y[0].d) / det;
        let ds = (fx * x[1].d - fy * x[0].d) / det;
        if !(dt.is_finite() && ds.is_finite()) {
            return None;
        }
        // One step may leave the pair; the next ones have to come back.
        let keep = |u: f64, [lo, hi]: [f64; 2]| u.clamp(lo - (hi - lo), hi + (hi - lo));
        let (nt, ns) = (keep(t + dt, pair.t), keep(s + ds, pair.s));
        let done = (nt - t).abs() <= 4.0 * f64::EPSILON * (1.0 + t.abs())
            && (ns - s).abs() <= 4.0 * f64::EPSILON * (1.0 + s.abs());
        (t, s) = (nt, ns);
        if done {
            break;
        }
    }
    let slack = |[lo, hi]: [f64; 2]| 64.0 * f64::EPSILON * (lo.abs() + hi.abs() + 1.0);
    let inside = |u: f64, r: [f64; 2]| u >= r[0] - slack(r) && u <= r[1] + slack(r);
    (inside(t, pair.t) && inside(s, pair.s)).then_some((t, s))
}
