//! Lines and conics along chains: the pieces between splits, merged where one curve fits several
//! (Haralick & Shapiro ch. 11).

use super::detection::{DetectedSegment, EdgeChain, EdgePixel, SegmentShape};
use super::fit::{Fit, LineFit, distance_to_conic, ellipse, line};
use super::parameters::Detector;
use super::splitting::{outermost, split, split_closed};
use super::walk::{Stretch, Walk};
use std::ops::Range;

/// A root mean square distance below this, in pixels, is as good as zero.
const FINE: f64 = 3.0 / 16.0;

/// The factor by which the residual of one line may exceed that of its pieces.
const LOOSER: f64 = 1.25;

/// Pieces of at least this many pixels determine the residual of edges themselves. Where all of
/// them are straight, a merged curve must fit about as well, however small its residual is.
const TELLING: usize = 24;

/// The fewest points that distinguish an ellipse from a line with noise.
const FEWEST: usize = 8;

/// The approximate number of points of a long run on which a fit is tried first.
const SAMPLE: usize = 40;

/// Fits segments to chains.
pub(super) struct Fitter<'a> {
    detector: &'a Detector,
    pixels: &'a [EdgePixel],
    /// The segments so far, chain by chain.
    pub found: Vec<DetectedSegment>,
}

/// The pieces of a chain, with the residuals of their curves.
struct Pieces<'a> {
    points: &'a [[f64; 2]],
    /// The index at which each begins; at last the end of the chain.
    breaks: Vec<usize>,
    /// The sum of squared distances of each from its curve.
    squares: Vec<f64>,
    /// Whether the curve of each is an ellipse.
    bent: Vec<bool>,
    tolerance: f64,
    /// The number of pixels next to a corner that the mask may displace.
    blurred: usize,
}

impl<'a> Fitter<'a> {
    pub fn new(detector: &'a Detector, pixels: &'a [EdgePixel]) -> Self {
        Self {
            detector,
            pixels,
            found: Vec::new(),
        }
    }

    /// Finds the segments of chains, and returns the chains: the closed ones start where a segment
    /// does.
    pub fn segments(&mut self, chains: Vec<EdgeChain>) -> Vec<EdgeChain> {
        let numbered = (0_u32..).zip(chains);
        let chains = numbered.map(|(number, chain)| self.chain(number, chain));
        chains.collect()
    }

    fn chain(&mut self, number: u32, chain: EdgeChain) -> EdgeChain {
        let mut walk = Walk::new(chain, self.pixels);
        let tolerance = self.detector.corner;
        let breaks = if walk.chain.closed {
            walk.turn(outermost(&walk.points));
            let breaks = split_closed(&walk.points, tolerance);
            let sharpest = sharpest(&walk.points, &breaks);
            walk.turn(sharpest);
            turned(breaks, sharpest)
        } else {
            split(&walk.points, tolerance)
        };
        walk.stretches = self.pieces(&walk.points, breaks).merged();
        self.close(&mut walk);
        walk.tidy(2 * self.detector.radius());
        let whole = walk.chain.closed && walk.stretches.len() == 1;
        for stretch in &walk.stretches {
            let segment = self.segment(number, &walk, stretch, whole);
            self.found.push(segment);
        }
        walk.chain
    }

    /// Merges the last and the first run of a closed chain, if one curve fits both.
    fn close(&self, walk: &mut Walk) {
        let last = match &walk.stretches[..] {
            [_, .., last] if walk.chain.closed => last.range.start,
            _ => return,
        };
        walk.turn(last);
        let [back, front] = [0, 1].map(|i| walk.stretches[i].range.end);
        let both = self
            .pieces(&walk.points, vec![0, back, front])
            .fitted_by_one(0..2);
        if let Some(CommonFit { bent, .. }) = both {
            let range = 0..front;
            walk.stretches.splice(0..2, [Stretch { range, bent }]);
        }
    }

    fn pieces<'p>(&self, points: &'p [[f64; 2]], breaks: Vec<usize>) -> Pieces<'p> {
        let square = |b: &[usize]| {
            let fit = line(&points[b[0]..b[1]]);
            fit.map_or(0.0, |f| f.rms * f.rms * (b[1] - b[0]) as f64)
        };
        Pieces {
            squares: breaks.windows(2).map(square).collect(),
            bent: vec![false; breaks.len() - 1],
            points,
            breaks,
            tolerance: self.detector.corner,
            blurred: self.detector.radius(),
        }
    }

    fn segment(&self, chain: u32, walk: &Walk, stretch: &Stretch, whole: bool) -> DetectedSegment {
        let all = &walk.points[stretch.range.clone()];
        // Beyond a corner the mask covers another edge, which displaces the pixels next to it.
        let outer = self.detector.radius().min(all.len() / 4);
        let inner = &all[outer..all.len() - outer];
        let fitted = if whole { all } else { inner };
        let straight = line(fitted).or_else(|| line(all));
        // With other boundaries it may fit a line after all.
        let curved = whole || straight.is_none_or(|fit| fit.rms > FINE);
        let curve = (stretch.bent && curved).then(|| ellipse(fitted)).flatten();
        let fit = curve.map(Fit::Ellipse).or(straight.map(Fit::Line));
        DetectedSegment {
            chain,
            range: [stretch.range.start as u32, stretch.range.end as u32],
            shape: shape(fit, walk, &stretch.range, whole),
            rms: fit.map_or(0.0, |f| f.rms()),
        }
    }
}

/// The shape of a fit to a range of points.
fn shape(fit: Option<Fit>, walk: &Walk, range: &Range<usize>, whole: bool) -> SegmentShape {
    let points = &walk.points[range.clone()];
    let onto = |p: [f64; 2]| fit.map_or(p, |f| f.foot(p));
    let ends = [points[0], points[points.len() - 1]].map(onto);
    match fit {
        Some(Fit::Ellipse(fit)) if whole => SegmentShape::Ellipse {
            conic: fit.conic,
            centre: fit.centre,
            axes: fit.axes,
        },
        Some(Fit::Ellipse(fit)) => SegmentShape::Arc {
            conic: fit.conic,
            ends,
            middle: onto(points[points.len() / 2]),
        },
        Some(Fit::Line(fit)) if !whole => SegmentShape::Line {
            ends: reaching(&fit, ends, walk.beyond(range)),
        },
        _ => SegmentShape::Line { ends },
    }
}

/// The ends of a line that is split from its neighbours: the pixel beyond a split is as near to the
/// corner as the last one before it, and is used where it is farther out.
fn reaching(fit: &LineFit, ends: [[f64; 2]; 2], beyond: [Option<[f64; 2]>; 2]) -> [[f64; 2]; 2] {
    [0, 1].map(|i| {
        let outwards = [ends[1 - i], ends[i]];
        let out = |p: [f64; 2]| {
            let [a, b] = outwards;
            (p[0] - b[0]) * (b[0] - a[0]) + (p[1] - b[1]) * (b[1] - a[1])
        };
        let next = beyond[i].map(|p| fit.foot(p));
        next.filter(|&p| out(p) > 0.0).unwrap_or(ends[i])
    })
}

/// The breaks of a closed chain after its start is moved by a number of points.
fn turned(mut breaks: Vec<usize>, by: usize) -> Vec<usize> {
    let n = breaks.pop().unwrap_or_default();
    let at = breaks.iter().position(|&b| b == by).unwrap_or_default();
    breaks.rotate_left(at);
    let mut breaks: Vec<usize> = breaks.iter().map(|b| (b + n - by) % n).collect();
    breaks.push(n);
    breaks
}

/// The index of the break with the greatest angle between the chords of a closed chain.
fn sharpest(points: &[[f64; 2]], breaks: &[usize]) -> usize {
    let n = points.len();
    let m = breaks.len() - 1;
    let chord = |i: usize| {
        let [a, b] = [points[breaks[i % m]], points[breaks[i % m + 1] % n]];
        [b[0] - a[0], b[1] - a[1]]
    };
    let turn = |i: usize| turn(chord(i + m - 1), chord(i)).abs();
    let mut best = 0;
    for i in 1..m {
        if turn(i) > turn(best) {
            best = i;
        }
    }
    breaks[best]
}

/// The angle from one vector to another.
fn turn(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] * b[1] - a[1] * b[0]).atan2(a[0] * b[0] + a[1] * b[1])
}

/// A curve that fits several pieces.
#[derive(Clone, Copy)]
struct CommonFit {
    /// Whether it is an ellipse, not a line.
    bent: bool,
    /// The root mean square distance.
    rms: f64,
}

impl Pieces<'_> {
    /// The runs of points, each of as many pieces as one curve fits. The neighbours that one curve
    /// fits best are merged first, so that a curve is complete before its ends are tried.
    fn merged(mut self) -> Vec<Stretch> {
        let count = self.squares.len();
        if let Some(fit) = self.fitted_by_one(0..count).filter(|_| count > 1) {
            let (range, bent) = (0..self.points.len(), fit.bent);
            return vec![Stretch { range, bent }];
        }
        let mut pairs: Vec<_> = (1..count)
            .map(|i| self.fitted_by_one(i - 1..i + 1))
            .collect();
        loop {
            let fitted = pairs.iter().enumerate();
            let fitted = fitted.filter_map(|(i, pair)| pair.map(|fit: CommonFit| (i, fit)));
            let Some((i, fit)) = fitted.min_by(|(_, a), (_, b)| a.rms.total_cmp(&b.rms)) else {
                break;
            };
            self.breaks.remove(i + 1);
            self.squares.remove(i + 1);
            self.bent.remove(i + 1);
            pairs.remove(i);
            let length = self.breaks[i + 1] - self.breaks[i];
            self.squares[i] = fit.rms * fit.rms * length as f64;
            self.bent[i] = fit.bent;
            for k in [i.checked_sub(1), Some(i)].into_iter().flatten() {
                if k < pairs.len() {
                    pairs[k] = self.fitted_by_one(k..k + 2);
                }
            }
        }
        let ranges = self.breaks.windows(2).map(|b| b[0]..b[1]);
        let stretches = ranges.zip(self.bent);
        stretches
            .map(|(range, bent)| Stretch { range, bent })
            .collect()
    }

    /// The curve that fits the points of pieces about as well as their own curves; none where
    /// neither a line nor an ellipse does.
    fn fitted_by_one(&self, pieces: Range<usize>) -> Option<CommonFit> {
        let range = self.breaks[pieces.start]..self.breaks[pieces.end];
        let squares: f64 = self.squares[pieces.clone()].iter().sum();
        let rms = (squares / range.len() as f64).sqrt();
        let points = &self.points[range];
        let near = |d: f64| d <= self.tolerance;
        if let Some(fit) = self.straight(points, (LOOSER * rms).max(FINE)) {
            let outer = self.outer(points);
            let inner = outer..points.len() - outer;
            let distances = points.iter().map(|&p| fit.distance(p)).enumerate();
            // Where a corner may displace the ends, they may be farther away.
            let mut distances =
                distances.map(|(i, d)| if inner.contains(&i) { d } else { 0.5 * d });
            return distances.all(near).then_some(CommonFit {
                bent: false,
                rms: fit.rms,
            });
        }
        let limit = if self.determine_residual(pieces.clone()) {
            LOOSER * rms
        } else {
            rms.max(FINE)
        };
        if points.len() < FEWEST || !self.turns_one_way(pieces) {
            return None;
        }
        let step = points.len() / SAMPLE;
        if step > 1 {
            let sample: Vec<[f64; 2]> = points.iter().copied().step_by(step).collect();
            ellipse(&sample).filter(|fit| fit.rms <= 2.0 * limit)?;
        }
        let fit = ellipse(points).filter(|fit| fit.rms <= limit)?;
        let all = points
            .iter()
            .all(|&p| near(distance_to_conic(&fit.conic, p)));
        (all && runs_along(points, fit.centre)).then_some(CommonFit {
            bent: true,
            rms: fit.rms,
        })
    }

    /// Whether all of some pieces are straight and long enough to determine the residual of edges
    /// from lines.
    fn determine_residual(&self, mut pieces: Range<usize>) -> bool {
        let length = |k: usize| self.breaks[k + 1] - self.breaks[k];
        pieces.all(|k| !self.bent[k] && length(k) >= TELLING)
    }

    /// The number of points at each end of a run that a corner may displace.
    fn outer(&self, points: &[[f64; 2]]) -> usize {
        self.blurred.min(points.len() / 4)
    }

    /// The line of points, if it fits all except those at the ends that a corner may displace.
    fn straight(&self, points: &[[f64; 2]], limit: f64) -> Option<LineFit> {
        let outer = self.outer(points);
        line(&points[outer..points.len() - outer]).filter(|fit| fit.rms <= limit)
    }

    /// Whether the chords of pieces all turn to the same side.
    fn turns_one_way(&self, pieces: Range<usize>) -> bool {
        let n = self.points.len();
        let chord = |i: usize| {
            let [a, b] = [i, i + 1].map(|k| self.points[self.breaks[k].min(n - 1)]);
            [b[0] - a[0], b[1] - a[1]]
        };
        let mut sides = (pieces.start + 1..pieces.end).map(|i| turn(chord(i - 1), chord(i)));
        let first = sides.next().unwrap_or_default();
        sides.all(|side| side * first > 0.0)
    }
}

/// Whether points go around a centre in one direction, tested at a few of them.
fn runs_along(points: &[[f64; 2]], centre: [f64; 2]) -> bool {
    let step = (points.len() / 8).max(1);
    let arms = points.iter().step_by(step);
    let arms: Vec<[f64; 2]> = arms.map(|p| [0, 1].map(|i| p[i] - centre[i])).collect();
    let mut sides = arms.windows(2).map(|a| turn(a[0], a[1]));
    let first = sides.next().unwrap_or_default();
    sides.all(|side| side * first > 0.0)
}
