//! Arcs rasterised as pixels (Bresenham 1965), each with the point of its arc that it shows.

use crate::image::bitmap::Bitmap;
use crate::image_arcs::PredictedArc;
use crate::image_arcs::flatten::nearest_on;

/// A pixel of an arc.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InkPixel {
    /// The column.
    pub x: i32,
    /// The row.
    pub y: i32,
    /// The arc.
    pub arc: u32,
    /// The length along the arc, in pixels.
    pub along: f64,
    /// The point of the arc next to the pixel's centre.
    pub at: [f64; 2],
    /// The arc's unit direction there.
    pub direction: [f64; 2],
    /// The index of the next arc pixel at the same image pixel; its own index at the end.
    next: u32,
}

/// The pixels of all arcs of an image.
#[derive(Clone, Debug)]
pub struct ArcRaster {
    width: usize,
    height: usize,
    /// The pixels, arc by arc, in the order in which the arcs run.
    pub(crate) pixels: Vec<InkPixel>,
    /// By image pixel: the index of the last of `pixels` in it.
    last: Vec<u32>,
    /// By arc: the range of its pixels.
    pub(crate) ranges: Vec<std::ops::Range<usize>>,
    /// By arc: its length within the image, and the length at which it enters the image.
    pub(crate) spans: Vec<[f64; 2]>,
}

const NONE: u32 = u32::MAX;

impl ArcRaster {
    /// The pixels of arcs, in reused memory, which [`Self::into_memory`] returns.
    pub(crate) fn within(
        arcs: &[PredictedArc],
        [width, height]: [usize; 2],
        mut last: Vec<u32>,
    ) -> Self {
        last.clear();
        last.resize(width * height, NONE);
        let mut ink = Self {
            width,
            height,
            pixels: Vec::new(),
            last,
            ranges: Vec::with_capacity(arcs.len()),
            spans: Vec::with_capacity(arcs.len()),
        };
        for (i, arc) in arcs.iter().enumerate() {
            let start = ink.pixels.len();
            ink.draw(i as u32, arc);
            ink.ranges.push(start..ink.pixels.len());
            let own = &ink.pixels[start..];
            let least = own.iter().map(|p| p.along).fold(f64::INFINITY, f64::min);
            let most = own
                .iter()
                .map(|p| p.along)
                .fold(f64::NEG_INFINITY, f64::max);
            ink.spans.push([least, most]);
        }
        ink
    }

    /// Returns its memory.
    pub(crate) fn into_memory(self) -> Vec<u32> {
        self.last
    }

    fn draw(&mut self, arc: u32, shown: &PredictedArc) {
        let mut before = 0.0;
        for (_, [a, b]) in shown.line.segments() {
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            if let Some([from, to]) = self.clip(a, b) {
                let place = |p: [i32; 2]| {
                    let s = nearest_on(&a, &b, &p.map(f64::from)).fraction;
                    (
                        before + s * length,
                        [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])],
                    )
                };
                let direction = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
                bresenham(from, to, |p| {
                    let (along, at) = place(p);
                    self.add(arc, p, along, at, direction);
                });
            }
            before += length;
        }
    }

    fn add(&mut self, arc: u32, [x, y]: [i32; 2], along: f64, at: [f64; 2], direction: [f64; 2]) {
        let inside = x >= 0 && y >= 0 && (x as usize) < self.width && (y as usize) < self.height;
        let repeated = self
            .pixels
            .last()
            .is_some_and(|p| p.arc == arc && [p.x, p.y] == [x, y]);
        if !inside || repeated || !direction[0].is_finite() {
            return;
        }
        let cell = &mut self.last[y as usize * self.width + x as usize];
        let next = *cell;
        *cell = self.pixels.len() as u32;
        self.pixels.push(InkPixel {
            x,
            y,
            arc,
            along,
            at,
            direction,
            next,
        });
    }

    /// The part of a segment within the image and a margin of one pixel, by its end pixels.
    fn clip(&self, a: [f64; 2], b: [f64; 2]) -> Option<[[i32; 2]; 2]> {
        let most = [self.width as f64, self.height as f64];
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for i in 0..2 {
            let d = b[i] - a[i];
            let (x, y) = ((-1.0 - a[i]) / d, (most[i] - a[i]) / d);
            if d == 0.0 {
                if a[i] < -1.0 || a[i] > most[i] {
                    return None;
                }
                continue;
            }
            from = from.max(x.min(y));
            to = to.min(x.max(y));
        }
        let at = |s: f64| [0, 1].map(|i| (a[i] + s * (b[i] - a[i])).round() as i32);
        (from <= to).then(|| [at(from), at(to)])
    }

    /// The pixels of arcs in a pixel of the image.
    pub(crate) fn at(&self, x: i64, y: i64) -> impl Iterator<Item = &InkPixel> {
        let inside = x >= 0 && y >= 0 && (x as usize) < self.width && (y as usize) < self.height;
        let first = if inside {
            self.last[y as usize * self.width + x as usize]
        } else {
            NONE
        };
        let get = |i: u32| self.pixels.get(i as usize);
        std::iter::successors(get(first), move |p| get(p.next))
    }

    /// The width and the height of the image.
    pub(crate) fn size(&self) -> [usize; 2] {
        [self.width, self.height]
    }

    /// The set of all pixels.
    pub fn bitmap(&self) -> Bitmap {
        let mut map = Bitmap::new([self.width, self.height]);
        for p in &self.pixels {
            map.add(i64::from(p.x), i64::from(p.y));
        }
        map
    }
}

/// The pixels of the line from one pixel to another (Bresenham 1965).
pub fn bresenham(
    [mut x, mut y]: [i32; 2],
    [to_x, to_y]: [i32; 2],
    mut report: impl FnMut([i32; 2]),
) {
    let (dx, dy) = ((to_x - x).abs(), -(to_y - y).abs());
    let (step_x, step_y) = ((to_x - x).signum(), (to_y - y).signum());
    let mut error = dx + dy;
    loop {
        report([x, y]);
        if [x, y] == [to_x, to_y] {
            return;
        }
        let twice = 2 * error;
        if twice >= dy {
            error += dy;
            x += step_x;
        }
        if twice <= dx {
            error += dx;
            y += step_y;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_as_many_pixels_as_its_longer_side() {
        for to in [[7, 3], [-7, 3], [3, -7], [0, 5], [5, 0], [6, 6], [0, 0]] {
            let mut pixels: Vec<[i32; 2]> = Vec::new();
            bresenham([0, 0], to, |p| pixels.push(p));
            let longer = to[0].abs().max(to[1].abs()) as usize;
            assert_eq!(pixels.len(), longer + 1);
            assert_eq!(pixels.last(), Some(&to));
            for [x, y] in &pixels {
                let off = f64::from(x * to[1] - y * to[0]).abs();
                let length = f64::from(to[0]).hypot(f64::from(to[1])).max(1.0);
                assert!(off / length <= 0.5 + 1e-12);
            }
        }
    }
}
