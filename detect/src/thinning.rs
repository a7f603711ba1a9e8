//! Selection of edge pixels: thresholds, non-maximum suppression and hysteresis (Canny 1986).

use super::detection::EdgePixel;
use super::gradient::{Gradient, ROUNDING, runs};
use super::parameters::{Detector, Thinning};
use super::pixel_mask::PixelMask;
use super::workspace::{Workspace, neighbours};

/// Marks the pixels that are strong enough, and of those, unless the edges shrink, the ones where
/// the gradient is largest across the edge.
pub(super) fn pick(detector: &Detector, work: &mut Workspace, inner: &PixelMask) {
    let least = detector.low.unwrap_or(detector.threshold) as f32;
    let gradient = &work.gradient;
    let all = detector.thinning == Thinning::Shrink;
    for run in runs(inner, gradient.width) {
        for (i, &size) in run.clone().zip(&gradient.size[run]) {
            if size >= least && size > 0.0 && (all || gradient.is_largest(i)) {
                work.found.push(i as u32);
            }
        }
    }
    for &place in &work.found {
        work.marks[place as usize] = 1;
    }
}

/// Drops the weak pixels that are not connected to a strong one.
pub(super) fn connect(detector: &Detector, work: &mut Workspace) {
    if detector.low.is_none() {
        return;
    }
    let strong = detector.threshold as f32;
    let (gradient, marks, queue) = (&work.gradient, &mut work.marks, &mut work.queue);
    for &place in &work.found {
        if gradient.size[place as usize] >= strong {
            marks[place as usize] = 2;
            queue.push(place);
        }
    }
    while let Some(place) = queue.pop() {
        for next in neighbours(place, gradient.width) {
            if marks[next as usize] == 1 {
                marks[next as usize] = 2;
                queue.push(next);
            }
        }
    }
    work.found.retain(|&place| {
        let mark = &mut marks[place as usize];
        *mark -= 1;
        *mark > 0
    });
}

/// The found pixels with their sub-pixel positions.
pub(super) fn edge_pixels(detector: &Detector, work: &Workspace) -> Vec<EdgePixel> {
    let (gradient, width) = (&work.gradient, work.gradient.width);
    let centre = detector.mask.centre();
    let pixel = |&place: &u32| {
        let place = place as usize;
        let (x, y) = (place % width, place / width);
        let offset = gradient.top(place);
        EdgePixel {
            x: x as u32,
            y: y as u32,
            at: [x as f64 + centre + offset[0], y as f64 + centre + offset[1]],
            gradient: [f64::from(gradient.x[place]), f64::from(gradient.y[place])],
        }
    };
    work.found.iter().map(pixel).collect()
}

impl Gradient {
    /// Whether the magnitude is the largest across the edge, compared with the values on both sides
    /// where the gradient leaves the ring of neighbours.
    fn is_largest(&self, i: usize) -> bool {
        let (gx, gy) = (self.x[i], self.y[i]);
        let steep = gy.abs() > gx.abs();
        let (main, other) = if steep { (gy, gx) } else { (gx, gy) };
        let (ahead, aside) = if steep {
            (self.width, 1)
        } else {
            (1, self.width)
        };
        let slant = other / main;
        let share = slant.abs();
        let between = |near: usize, far: usize| {
            let [near, far] = [self.size[near], self.size[far]];
            near + share * (far - near)
        };
        let [before, after] = if slant < 0.0 {
            [
                between(i - ahead, i - ahead + aside),
                between(i + ahead, i + ahead - aside),
            ]
        } else {
            [
                between(i - ahead, i - ahead - aside),
                between(i + ahead, i + ahead + aside),
            ]
        };
        let top = self.size[i] * (1.0 + ROUNDING);
        let bottom = self.size[i] * (1.0 - ROUNDING);
        top >= before && top >= after && bottom > before.min(after)
    }

    /// The position of the largest magnitude across the edge, relative to the pixel: the maximum of
    /// a parabola along the image axis nearer to the gradient. There no value has to be
    /// interpolated, and a straight edge has the same profile in each row or column.
    fn top(&self, i: usize) -> [f64; 2] {
        let steep = self.y[i].abs() > self.x[i].abs();
        let step = if steep { self.width } else { 1 };
        let [before, here, after] = [i - step, i, i + step].map(|at| f64::from(self.size[at]));
        let bend = before - 2.0 * here + after;
        let flat = bend >= -f64::from(ROUNDING) * here;
        // There is no maximum between the neighbours: the edge is at most near one of them.
        let offset = if flat {
            0.0
        } else {
            (0.5 * (before - after) / bend).clamp(-1.0, 1.0)
        };
        if steep { [0.0, offset] } else { [offset, 0.0] }
    }
}
