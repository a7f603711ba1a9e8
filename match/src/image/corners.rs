//! Chains of lines: three lines, the middle one of which forms a corner with another at each end.

use super::lines::ImageLine;
use nalgebra::{Point2, Vector2};
use std::cmp::Ordering;

/// The greatest gap between the end of a line and a corner: in pixels, plus a share of the line's
/// length.
const SHORT: f64 = 8.0;
const PART: f64 = 0.25;
/// The least sine of the angle of a corner.
const SHARP: f64 = 0.17;
/// The shortest lines of chains, in pixels: the middle one, and those at its ends.
const MIDDLE: f64 = 16.0;
const LIMB: f64 = 10.0;

/// A corner of a line with another at one of its ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineCorner {
    /// The point.
    pub at: Point2<f64>,
    /// The other line.
    pub line: u32,
    /// The unit vector in which the other leaves the corner.
    pub away: Vector2<f64>,
    /// How far the lines end before the corner or overrun it, in pixels.
    pub gap: f64,
    /// The length of the other line from the corner.
    pub length: f64,
}

/// Two corners, at the ends of a line, or of two lines end to end.
#[derive(Clone, Debug, PartialEq)]
pub struct LinePath {
    /// The lines between the corners: one or two.
    pub middle: Vec<u32>,
    /// The corners, with the lines that leave them.
    pub corners: [LineCorner; 2],
    /// Its score: the length of its lines less a penalty for gaps, in pixels.
    pub worth: f64,
}

impl LinePath {
    fn new(lines: &[ImageLine], middle: Vec<u32>, corners: [LineCorner; 2], gap: f64) -> Self {
        let covered: f64 = middle.iter().map(|&i| lines[i as usize].covered).sum();
        let length: f64 = middle.iter().map(|&i| lines[i as usize].length).sum();
        let outer: f64 = corners.iter().map(|c| c.length.min(2.0 * length)).sum();
        let gaps = corners[0].gap + corners[1].gap + gap;
        Self {
            middle,
            corners,
            worth: covered + 0.5 * outer - MISSING * gaps,
        }
    }

    /// The order of chains with equal scores: by the indices of their lines.
    fn order(&self, other: &Self) -> Ordering {
        let ends = |path: &Self| path.corners.map(|c| c.line);
        let middle = self.middle.cmp(&other.middle);
        middle.then_with(|| ends(self).cmp(&ends(other)))
    }
}

/// The length of a line that balances a unit of gap.
const MISSING: f64 = 4.0;

/// The chains of lines, the best first: at most `most` with one line between the corners, and as
/// many with two.
pub fn chains(lines: &[ImageLine], most: usize) -> [Vec<LinePath>; 2] {
    let long = lines.iter().take_while(|l| l.length >= MIDDLE);
    let all: Vec<[Vec<LineCorner>; 2]> = long
        .enumerate()
        .map(|(i, line)| [0, 1].map(|end| corners(i as u32, line, end, lines)))
        .collect();
    let mut found = [Vec::new(), Vec::new()];
    for (i, ends) in (0..).zip(&all) {
        for a in &ends[0] {
            for b in ends[1].iter().filter(|b| b.line != a.line) {
                found[0].push(LinePath::new(lines, vec![i], [*a, *b], 0.0));
            }
        }
    }
    for pair in nearby_ends(&lines[..all.len()]) {
        let [i, j] = pair.lines;
        for a in &all[i][pair.far_ends[0]] {
            for b in &all[j][pair.far_ends[1]] {
                let four = a.line != b.line && a.line as usize != j && b.line as usize != i;
                if four {
                    found[1].push(LinePath::new(
                        lines,
                        vec![i as u32, j as u32],
                        [*a, *b],
                        pair.gap,
                    ));
                }
            }
        }
    }
    for all in &mut found {
        all.sort_by(|a, b| b.worth.total_cmp(&a.worth).then_with(|| a.order(b)));
        all.truncate(most);
    }
    found
}

/// A pair of lines with nearby ends.
struct LinePair {
    lines: [usize; 2],
    /// The index of each line's other end.
    far_ends: [usize; 2],
    /// The gap in pixels.
    gap: f64,
}

/// The pairs of lines with nearby ends.
fn nearby_ends(lines: &[ImageLine]) -> Vec<LinePair> {
    let mut all = Vec::new();
    for (i, a) in lines.iter().enumerate() {
        for (j, b) in lines.iter().enumerate().skip(i + 1) {
            let slack = SHORT + PART * a.length.min(b.length);
            for (p, q) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let gap = (a.ends[p] - b.ends[q]).norm();
                // Not where one doubles back on the other.
                let way =
                    |l: &ImageLine, end: usize| if end == 0 { l.direction } else { -l.direction };
                let turns = way(a, p).dot(&way(b, q)) < 1.0 - SHARP;
                if gap < slack && turns {
                    all.push(LinePair {
                        lines: [i, j],
                        far_ends: [1 - p, 1 - q],
                        gap,
                    });
                }
            }
        }
    }
    all
}

/// The corners at one end of a line.
fn corners(own: u32, line: &ImageLine, end: usize, lines: &[ImageLine]) -> Vec<LineCorner> {
    let mut all: Vec<LineCorner> = Vec::new();
    let mut flat = Vec::new();
    let tip = line.ends[end];
    for (i, other) in (0..).zip(lines) {
        if other.length < LIMB {
            break;
        }
        if i == own {
            continue;
        }
        let slack = SHORT + PART * other.length.min(line.length);
        let [off, along] = other.place(&tip);
        // Too far away to be a corner.
        let reach = slack + SHORT + PART * line.length;
        if along < -reach || along > other.length + reach || off.abs() > reach {
            continue;
        }
        let sine = line.direction.perp(&other.direction);
        if sine.abs() < SHARP {
            flat.push(i);
            continue;
        }
        // line(t) = ends[0] + t direction intersects the other.
        let t = other.direction.perp(&(line.ends[0] - other.ends[0])) / sine;
        let at = line.ends[0] + line.direction * t;
        let beyond = if end == 0 { -t } else { t - line.length };
        let s = other.place(&at)[1];
        if beyond.abs() > slack {
            continue;
        }
        // The other ends there, and leaves it one way.
        for (gap, sign, length) in [(-s, 1.0, other.length - s), (s - other.length, -1.0, s)] {
            let near = gap.abs() <= slack;
            // Or it passes the corner: a silhouette at which the line ends.
            let passes = gap < 0.0 && length > LIMB;
            if (near || passes) && length > LIMB {
                all.push(LineCorner {
                    at,
                    line: i,
                    away: other.direction * sign,
                    gap: beyond.abs() + if near { gap.abs() } else { SHORT },
                    length,
                });
            }
        }
    }
    let known = all.clone();
    for i in flat {
        all.extend(third(i, &lines[i as usize], line, end, &known));
    }
    all
}

/// The corner of a line with a nearly parallel one, at a known corner with a third line.
fn third(
    number: u32,
    other: &ImageLine,
    line: &ImageLine,
    end: usize,
    known: &[LineCorner],
) -> Option<LineCorner> {
    let outwards = if end == 0 {
        -line.direction
    } else {
        line.direction
    };
    let slack = SHORT + PART * other.length.min(line.length);
    let near = known.iter().filter_map(|corner| {
        let [off, along] = other.place(&corner.at);
        // It continues from the corner, away from the line.
        let (gap, sign) = match other.direction.dot(&outwards) > 0.0 {
            true => (-along, 1.0),
            false => (along - other.length, -1.0),
        };
        let fits = off.abs() < THIRD && gap.abs() < slack && other.length > gap.abs() + LIMB;
        fits.then_some(LineCorner {
            line: number,
            away: other.direction * sign,
            gap: corner.gap + gap.abs(),
            length: other.length - gap.abs(),
            ..*corner
        })
    });
    near.min_by(|a, b| a.gap.total_cmp(&b.gap))
}

/// The greatest distance, in pixels, of a line from the corner of two others.
const THIRD: f64 = 3.0;
