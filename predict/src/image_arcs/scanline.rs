//! Scanlines of an image and their crossings with arcs. Between two crossings there is one region.

use super::arc::{ArcSide, PredictedArc};
use super::flatten::FINE;
use std::ops::Range;

/// The number of scanlines in a row of pixels.
pub const LINES: usize = 8;
/// The distance between two arcs, in pixels, above which their polylines have the arcs' order.
/// Below, within the accuracy of polylines, the order may be reversed.
pub const APART: f64 = 4.0 * FINE;
/// The distance from the end of an arc's section, in pixels, within which a crossing may also be
/// one of the next section.
const LOOSE: f64 = 1.0 / (1 << 20) as f64;

/// A crossing of an arc and a scanline.
#[derive(Clone, Copy, Debug)]
pub struct ScanlineCrossing {
    /// The column.
    pub x: f64,
    /// The index of the arc's section in [`Sections`].
    pub section: u32,
    /// The side of the section that is to the right on the page.
    pub right: ArcSide,
    /// Whether it is unambiguous that this section crosses, separately from all others.
    pub firm: bool,
    /// The sine of the crossing angle. An error of the polyline moves the crossing by the error
    /// over this.
    pub slant: f64,
}

/// A piece of an arc between two points at which others end on it, or its own ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ArcSection {
    /// The arc.
    pub arc: u32,
    /// The points of the arc's polyline at both ends.
    pub ends: [usize; 2],
}

/// The sections of arcs: the pieces between two points at which others end on them, or their own
/// ends.
#[derive(Clone, Debug, Default)]
pub struct Sections {
    /// The sections.
    pub all: Vec<ArcSection>,
    /// By arc: the index of its first section; after the last arc the number of all sections.
    first: Vec<u32>,
}

impl Sections {
    /// The sections of arcs.
    pub fn new(arcs: &[PredictedArc]) -> Self {
        let mut sections = Self::default();
        for (i, arc) in arcs.iter().enumerate() {
            sections.first.push(sections.all.len() as u32);
            let mut from = 0;
            for &to in arc.stops.iter().chain([&(arc.line.points.len() - 1)]) {
                sections.all.push(ArcSection {
                    arc: i as u32,
                    ends: [from, to],
                });
                from = to;
            }
        }
        sections.first.push(sections.all.len() as u32);
        sections
    }

    /// How many arcs there are.
    pub fn arcs(&self) -> usize {
        self.first.len() - 1
    }

    /// The sections of an arc, in order.
    pub fn of_arc(&self, arc: usize) -> Range<u32> {
        self.first[arc]..self.first[arc + 1]
    }
}

/// The crossings of all lines of an image.
#[derive(Clone, Debug)]
pub struct Scanlines {
    /// By scanline: the index of its first crossing; after the last scanline the number of
    /// crossings.
    starts: Vec<u32>,
    crossings: Vec<ScanlineCrossing>,
}

/// The row of a scanline, in pixels.
pub fn line_y(line: usize) -> f64 {
    // The offset is no simple fraction of a pixel, so that curves at whole pixels do not coincide
    // with scanlines.
    let within = ((line % LINES) as f64 + 0.486_731) / LINES as f64;
    (line / LINES) as f64 - 0.5 + within
}

/// The scanline nearest to a row.
pub fn line_at(y: f64) -> usize {
    ((y + 0.5) * LINES as f64).max(0.0) as usize
}

/// The first scanline at or below a row.
fn first_line(y: f64, lines: usize) -> usize {
    let guess = ((y + 0.5) * LINES as f64 - 0.486_731).ceil().max(0.0);
    (guess as usize).min(lines)
}

impl Scanlines {
    /// The crossings of the arcs with the scanlines of an image of a height in pixels.
    pub fn new(arcs: &[PredictedArc], sections: &Sections, height: usize) -> Self {
        let lines = height * LINES;
        let mut counts = vec![0u32; lines + 1];
        each(arcs, sections, lines, |line, _| counts[line + 1] += 1);
        for line in 0..lines {
            counts[line + 1] += counts[line];
        }
        let blank = ScanlineCrossing {
            x: 0.0,
            section: 0,
            right: ArcSide::Left,
            firm: false,
            slant: 0.0,
        };
        let mut crossings = vec![blank; counts[lines] as usize];
        let mut next = counts.clone();
        each(arcs, sections, lines, |line, crossing| {
            crossings[next[line] as usize] = crossing;
            next[line] += 1;
        });
        for line in 0..lines {
            let range = counts[line] as usize..counts[line + 1] as usize;
            let on = &mut crossings[range];
            on.sort_unstable_by(|a, b| a.x.total_cmp(&b.x));
            loosen(on);
        }
        Self {
            starts: counts,
            crossings,
        }
    }

    /// The crossings of a scanline, from left to right.
    pub fn on(&self, line: usize) -> &[ScanlineCrossing] {
        &self.crossings[self.starts[line] as usize..self.starts[line + 1] as usize]
    }

    /// The number of scanlines.
    pub fn lines(&self) -> usize {
        self.starts.len() - 1
    }
}

/// Marks the crossings of a scanline that are too near to one another for their order to be known.
fn loosen(on: &mut [ScanlineCrossing]) {
    for i in 1..on.len() {
        let [a, b] = [on[i - 1], on[i]];
        if (b.x - a.x) * a.slant.min(b.slant) <= APART {
            on[i - 1].firm = false;
            on[i].firm = false;
        }
    }
}

/// Reports every crossing of a section with a scanline.
fn each(
    arcs: &[PredictedArc],
    sections: &Sections,
    lines: usize,
    mut report: impl FnMut(usize, ScanlineCrossing),
) {
    for (id, section) in sections.all.iter().enumerate() {
        let ArcSection {
            arc,
            ends: [from, to],
        } = *section;
        let points = &arcs[arc as usize].line.points;
        let ends = [points[from][1], points[to][1]];
        for pair in points[from..=to].windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let (top, bottom) = (a[1].min(b[1]), a[1].max(b[1]));
            let slope = (b[0] - a[0]) / (b[1] - a[1]);
            let slant = (b[1] - a[1]).abs() / (b[0] - a[0]).hypot(b[1] - a[1]);
            // A segment that runs down has its left side on the page's right.
            let right = if b[1] > a[1] {
                ArcSide::Left
            } else {
                ArcSide::Right
            };
            for line in first_line(top, lines)..first_line(bottom, lines) {
                let y = line_y(line);
                let firm = ends.iter().all(|end| (end - y).abs() > LOOSE);
                let x = a[0] + (y - a[1]) * slope;
                let section = id as u32;
                report(
                    line,
                    ScanlineCrossing {
                        x,
                        section,
                        right,
                        firm,
                        slant,
                    },
                );
            }
        }
    }
}
