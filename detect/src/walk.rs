//! Chains with their runs of points, each fitted by one curve, and the boundaries between runs.

use super::detection::{EdgeChain, EdgePixel};
use super::fit::{Fit, ellipse, line};
use std::ops::Range;

/// A run of points of a chain that one curve fits.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    pub range: Range<usize>,
    /// Whether the curve is an ellipse.
    pub bent: bool,
}

/// A chain with its points and runs.
pub(super) struct Walk {
    pub chain: EdgeChain,
    /// The positions of its pixels.
    pub points: Vec<[f64; 2]>,
    /// The consecutive runs, from the first point to the last.
    pub stretches: Vec<Stretch>,
}

impl Walk {
    pub fn new(chain: EdgeChain, pixels: &[EdgePixel]) -> Self {
        let at = |&i: &u32| pixels[i as usize].at;
        Self {
            points: chain.pixels.iter().map(at).collect(),
            chain,
            stretches: Vec::new(),
        }
    }

    /// Moves the start of a closed chain to a later point; if there are runs, to the start of one.
    pub fn turn(&mut self, by: usize) {
        let n = self.points.len();
        self.chain.pixels.rotate_left(by);
        self.points.rotate_left(by);
        for s in &mut self.stretches {
            let start = (s.range.start + n - by) % n;
            s.range = start..start + s.range.len();
        }
        self.stretches.sort_unstable_by_key(|s| s.range.start);
    }

    /// The points of the chain before and after a range.
    pub fn beyond(&self, range: &Range<usize>) -> [Option<[f64; 2]>; 2] {
        let closed = self.chain.closed;
        let last = self.points.last().copied().filter(|_| closed);
        let first = self.points.first().copied().filter(|_| closed);
        let before = range.start.checked_sub(1).map(|i| self.points[i]);
        let after = self.points.get(range.end).copied();
        [before.or(last), after.or(first)]
    }

    /// Divides short runs between their longer neighbours, and moves the boundaries to where the
    /// curves fit best; this can make other runs short.
    pub fn tidy(&mut self, short: usize) {
        loop {
            self.refine();
            let count = self.stretches.len();
            if self.chain.closed && count > 1 {
                let longest = self.stretches.iter().rev().max_by_key(|s| s.range.len());
                self.turn(longest.map_or(0, |s| s.range.start));
                self.absorb_last(short);
            }
            self.absorb(short);
            if self.stretches.len() == count {
                break;
            }
        }
    }

    /// Divides short runs between their neighbours, except for the first and the last.
    fn absorb(&mut self, short: usize) {
        let mut i = 1;
        while i + 1 < self.stretches.len() {
            let [before, here, after] = [i - 1, i, i + 1].map(|k| self.stretches[k].range.clone());
            if is_between(&before, &here, &after, short) {
                let middle = here.start + here.len() / 2;
                self.stretches[i - 1].range.end = middle;
                self.stretches[i + 1].range.start = middle;
                self.stretches.remove(i);
            } else {
                i += 1;
            }
        }
    }

    /// Moves the boundaries between runs to where the curves fit best.
    fn refine(&mut self) {
        refine(&self.points, &mut self.stretches);
        if self.chain.closed && self.stretches.len() > 1 {
            // The one at the start becomes the last.
            self.turn(self.stretches[1].range.start);
            let last = self.stretches.len() - 2;
            refine(&self.points, &mut self.stretches[last..]);
        }
    }

    /// Divides the last run of a closed chain between its neighbours, if it is short.
    fn absorb_last(&mut self, short: usize) {
        let [first, .., before, last] = &self.stretches[..] else {
            return;
        };
        if !is_between(&before.range, &last.range, &first.range, short) {
            return;
        }
        let middle = last.range.start + last.range.len() / 2;
        let count = self.stretches.len();
        self.stretches[count - 2].range.end = middle;
        self.stretches[count - 1].range.start = middle;
        self.turn(middle);
        self.stretches.remove(0);
        self.stretches[0].range.start = 0;
    }
}

/// Whether a run is so short that it is only the rounding of a corner by the mask between its
/// longer neighbours.
fn is_between(
    before: &Range<usize>,
    here: &Range<usize>,
    after: &Range<usize>,
    short: usize,
) -> bool {
    here.len() <= short && before.len().min(after.len()) > 2 * here.len()
}

/// Moves the boundaries between runs to the least sum of squared distances, of the points before
/// from the one curve and of those after from the other.
fn refine(points: &[[f64; 2]], stretches: &mut [Stretch]) {
    let fits: Vec<Option<Fit>> = stretches.iter().map(|s| core(points, s)).collect();
    for i in 1..stretches.len() {
        let (Some(before), Some(after)) = (fits[i - 1], fits[i]) else {
            continue;
        };
        let [a, b] = [i - 1, i].map(|k| stretches[k].range.clone());
        let from = b.start - a.len() / 2;
        let to = b.start + b.len() / 2;
        // The sum up to a constant, as the boundary passes the points one by one.
        let (mut sum, mut least, mut best) = (0.0, 0.0, from);
        for (k, &p) in (from..to).zip(&points[from..to]) {
            sum += before.distance(p).powi(2) - after.distance(p).powi(2);
            if sum < least {
                (least, best) = (sum, k + 1);
            }
        }
        stretches[i - 1].range.end = best;
        stretches[i].range.start = best;
    }
}

/// The curve of a run without the points that may belong to its neighbours.
fn core(points: &[[f64; 2]], stretch: &Stretch) -> Option<Fit> {
    let all = &points[stretch.range.clone()];
    let outer = all.len() / 4;
    let curve = stretch
        .bent
        .then(|| ellipse(all).map(Fit::Ellipse))
        .flatten();
    curve.or_else(|| line(&all[outer..all.len() - outer]).map(Fit::Line))
}
