//! Crossings in the image of two curves without a closed form, by certified subdivision.
//!
//! The pair of parameter intervals is halved until the images are apart, or Krawczyk's test shows
//! that there is no crossing in it, or exactly one.

use crate::crossing::Overlap;
use crate::image::flat_point;
use crate::projection::Projection;
use crate::strand::Strand;
use premio_kernel::number::interval::Interval;
use premio_kernel::number::jet::Jet;
use premio_kernel::number::scalar::Scalar;

/// Halvings of the pair after which it is given up as overlapping or touching.
const DEPTH: u32 = 26;
/// How near to a cusp, in lengths of a segment, a curve is sure not to cross itself.
const NEAR_CUSP: f64 = 0.25;
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
        if (given_up > MANY && !same) || work > WORK {
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
        let verdict = krawczyk(a, b, projection, &pair, &x, &y);
        if verdict == Verdict::Nothing {
            continue;
        }
        let last = pair.depth >= DEPTH;
        if verdict == Verdict::One || last {
            if let Some((t, s)) = newton(a, b, projection, &pair, band) {
                let apart = |c: &Strand<'_>, u: f64, v: f64| {
                    (c.curve.point(u) - c.curve.point(v)).norm() > 16.0 * band
                };
                if roots.iter().all(|r| apart(a, r.0, t) || apart(b, r.1, s)) {
                    roots.push((t, s));
                    found(t, s);
                }
                continue;
            }
            // Newton's steps may leave a pair that is still wide.
            if last {
                given_up += 1;
                continue;
            }
        }
        // Next to one cusp, and only one, a curve does not cross itself.
        if same && around_one(a, &pair) {
            continue;
        }
        halve(pair, same, [&x, &y], &mut stack);
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

/// Whether exactly one cusp lies between the outer ends of the pair, and the next one far off:
/// there the image is a semicubical parabola, which does not cross itself.
fn around_one(a: &Strand<'_>, pair: &Pair) -> bool {
    let (lo, hi) = (pair.t[0].min(pair.s[0]), pair.t[1].max(pair.s[1]));
    let width = hi - lo;
    let within = |t: f64, by: f64| t >= lo - by && t <= hi + by;
    let marks = |by: f64| a.splits.iter().filter(|m| within(m.t, by)).count();
    width <= NEAR_CUSP && marks(0.0) == 1 && marks(4.0 * width) == 1
}

fn halve(pair: Pair, same: bool, [x, y]: [&[Jet<Interval>; 2]; 2], stack: &mut Vec<Pair>) {
    let size = |j: &[Jet<Interval>; 2]| j[0].v.width().max(j[1].v.width());
    let depth = pair.depth + 1;
    if same && pair.t == pair.s {
        // The diagonal of a curve with itself stays a diagonal.
        let m = 0.5 * (pair.t[0] + pair.t[1]);
        let (lo, hi) = ([pair.t[0], m], [m, pair.t[1]]);
        for (t, s) in [(lo, lo), (lo, hi), (hi, hi)] {
            stack.push(Pair { t, s, depth });
        }
    } else if size(x) >= size(y) {
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

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Verdict {
    /// No crossing.
    Nothing,
    /// Exactly one.
    One,
    /// Not known.
    Unsure,
}

/// Krawczyk's test of the difference of the images over the pair.
fn krawczyk(
    a: &Strand<'_>,
    b: &Strand<'_>,
    projection: &Projection,
    pair: &Pair,
    x: &[Jet<Interval>; 2],
    y: &[Jet<Interval>; 2],
) -> Verdict {
    let middle = |r: [f64; 2]| 0.5 * (r[0] + r[1]);
    let m = [middle(pair.t), middle(pair.s)];
    let at = |c: &Strand<'_>, t: f64| flat_point(projection, c.curve.jet_over(Interval::point(t)));
    let (p, q) = (at(a, m[0]), at(b, m[1]));
    let j = [[x[0].d, -y[0].d], [x[1].d, -y[1].d]];
    let k = j.map(|row| row.map(Interval::mid));
    let det = k[0][0] * k[1][1] - k[0][1] * k[1][0];
    let inverse = [
        [k[1][1] / det, -k[0][1] / det],
        [-k[1][0] / det, k[0][0] / det],
    ];
    if !inverse.iter().flatten().all(|c| c.is_finite()) {
        return Verdict::Unsure;
    }
    let f = [p[0].v - q[0].v, p[1].v - q[1].v];
    let whole = [pair.t, pair.s].map(|r| Interval::new(r[0], r[1]));
    let run = [
        whole[0] - Interval::point(m[0]),
        whole[1] - Interval::point(m[1]),
    ];
    let mut inside = true;
    for i in 0..2 {
        let step = f[0].scale(inverse[i][0]) + f[1].scale(inverse[i][1]);
        let mut image = Interval::point(m[i]) - step;
        for n in 0..2 {
            let product = j[0][n].scale(inverse[i][0]) + j[1][n].scale(inverse[i][1]);
            let unit = Interval::point(if i == n { 1.0 } else { 0.0 });
            image = image + (unit - product) * run[n];
        }
        if !image.meets(whole[i]) {
            return Verdict::Nothing;
        }
        inside &= whole[i].lo <= image.lo && image.hi <= whole[i].hi;
    }
    if inside {
        Verdict::One
    } else {
        Verdict::Unsure
    }
}

/// The crossing that the pair holds, where Newton's steps settle in it.
fn newton(
    a: &Strand<'_>,
    b: &Strand<'_>,
    projection: &Projection,
    pair: &Pair,
    near: f64,
) -> Option<(f64, f64)> {
    let (mut t, mut s) = (0.5 * (pair.t[0] + pair.t[1]), 0.5 * (pair.s[0] + pair.s[1]));
    // Steps that no longer shrink are rounding.
    let (mut settled, mut last) = (false, f64::INFINITY);
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
        let moved = |c: &Strand<'_>, from: f64, to: f64| {
            (to - from).abs() * c.curve.derivative(from).norm()
        };
        let step = moved(a, t, nt).max(moved(b, s, ns));
        let done = step <= near && step >= last;
        settled = step <= near;
        last = step;
        (t, s) = (nt, ns);
        if done {
            break;
        }
    }
    let inside = |c: &Strand<'_>, u: f64, r: [f64; 2]| {
        let slack = near / c.curve.derivative(u).norm();
        u >= r[0] - slack && u <= r[1] + slack
    };
    (settled && inside(a, t, pair.t) && inside(b, s, pair.s)).then_some((t, s))
}
