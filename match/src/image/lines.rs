//! Lines of an image: straight segments, and chains of collinear segments of a broken edge.

use nalgebra::{Point2, Vector2};
use premio_detect::{Detection, SegmentShape};

/// The greatest distance of pieces from their line, in pixels.
const OFF: f64 = 1.5;
/// The longest gap between pieces of one line, relative to the shorter piece.
const GAP: f64 = 1.0;

/// A straight piece of an edge.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageLine {
    /// Its ends, the bright side being on the right of the way from the first to the last as the
    /// image is seen.
    pub ends: [Point2<f64>; 2],
    /// The unit vector from the first to the last.
    pub direction: Vector2<f64>,
    /// Its length in pixels.
    pub length: f64,
    /// The length in pixels that segments cover.
    pub covered: f64,
    /// The segments of the detection that it is made of.
    pub segments: Vec<u32>,
}

impl ImageLine {
    fn new(ends: [Point2<f64>; 2], covered: f64, segments: Vec<u32>) -> Option<Self> {
        let along = ends[1] - ends[0];
        let length = along.norm();
        (length > 0.0).then(|| Self {
            ends,
            direction: along / length,
            length,
            covered,
            segments,
        })
    }

    /// The signed distance of a point from the line, positive on its left, and its position along
    /// it.
    pub fn place(&self, p: &Point2<f64>) -> [f64; 2] {
        let d = p - self.ends[0];
        [self.direction.perp(&d), self.direction.dot(&d)]
    }

    /// The middle.
    pub fn middle(&self) -> Point2<f64> {
        nalgebra::center(&self.ends[0], &self.ends[1])
    }
}

/// The lines of a detection, the longest first: its straight segments, and lines joined from two or
/// more of them end to end.
pub fn lines(detection: &Detection) -> Vec<ImageLine> {
    let mut all: Vec<ImageLine> = Vec::new();
    for (i, segment) in (0..).zip(&detection.segments) {
        if let SegmentShape::Line { ends } = segment.shape {
            let ends = ends.map(Point2::from);
            let length = (ends[1] - ends[0]).norm();
            all.extend(ImageLine::new(ends, length, vec![i]));
        }
    }
    longest_first(&mut all);
    let mut joined: Vec<ImageLine> = Vec::new();
    for i in 0..all.len() {
        let mut line = all[i].clone();
        // The nearest piece on either end, again and again.
        while let Some(next) = next(&line, &all) {
            line = next;
        }
        let known = |l: &ImageLine| l.segments == line.segments;
        if line.segments.len() > 1 && !joined.iter().any(known) {
            joined.push(line);
        }
    }
    all.extend(joined);
    longest_first(&mut all);
    all
}

fn longest_first(lines: &mut [ImageLine]) {
    lines.sort_by(|a, b| {
        let order = b.length.total_cmp(&a.length);
        order.then_with(|| a.segments.cmp(&b.segments))
    });
}

/// A line joined with the piece that continues it with the smallest gap; none if there is none.
fn next(line: &ImageLine, all: &[ImageLine]) -> Option<ImageLine> {
    let fits = all.iter().filter_map(|piece| {
        if line.segments.contains(&piece.segments[0]) {
            return None;
        }
        let places = piece.ends.map(|p| line.place(&p));
        let middle = piece.place(&line.middle());
        if places.iter().any(|p| p[0].abs() > OFF)
            || piece.length < line.length && middle[0].abs() > 8.0 * OFF
        {
            return None;
        }
        let [from, to] = [
            places[0][1].min(places[1][1]),
            places[0][1].max(places[1][1]),
        ];
        let gap = (from - line.length).max(-to);
        let shorter = piece.length.min(line.length);
        (gap > -OFF && gap < GAP * shorter).then_some((gap, piece))
    });
    let (_, piece) = fits.min_by(|a, b| a.0.total_cmp(&b.0))?;
    let mut along: Vec<(f64, Point2<f64>)> = [line, piece]
        .iter()
        .flat_map(|l| l.ends)
        .map(|p| (line.place(&p)[1], p))
        .collect();
    along.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut segments = [&line.segments[..], &piece.segments[..]].concat();
    segments.sort_unstable();
    let covered = line.covered + piece.covered;
    ImageLine::new([along[0].1, along[3].1], covered, segments)
}
