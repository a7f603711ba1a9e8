//! Lines across an image, and where arcs cross them: between two crossings there is one region.

use super::arc::{ArcSide, PredictedArc};
use super::flatten::FINE;
use std::ops::Range;

/// How many lines are laid through a row of pixels.
pub const LINES: usize = 8;
/// The distance between two arcs, in pixels, from which on polylines lie as they do: those that are
/// nearer than they are fine may lie the other way about.
pub const APART: f64 = 4.0 * FINE;
/// So near to the end of an arc's section, in pixels, a crossing may be of the next one as well.
const LOOSE: f64 = 1.0 / (1 << 20) as f64;

/// Where an arc crosses a line.
#[derive(Clone, Copy, Debug)]
pub struct ScanlineCrossing {
    /// The column.
    pub x: f64,
    /// The section of an arc, by its number in [`Sections`].
    pub section: u32,
    /// The side of the section that is to the right on the page.
    pub right: ArcSide,
    /// Whether it is clearly this section that crosses, apart from all others.
    pub firm: bool,
    /// The sine of the angle at which it crosses: what a polyline is off its curve moves the crossing
    /// by as much over this.
    pub slant: f64,
}

/// The sections of arcs: what lies between two points at which others end on them, or their own ends.
#[derive(Clone, Debug, Default)]
pub struct Sections {
    /// By section: its arc, and the points of the arc's polyline at its ends.
    pub all: Vec<(u32, [usize; 2])>,
    /// By arc: its first section, and after the last arc the number of all.
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
                sections.all.push((i as u32, [from, to]));
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
    /// By line: where its crossings start, and after the last line their number.
    starts: Vec<u32>,
    crossings: Vec<ScanlineCrossing>,
}

/// The row of a line of the image, in pixels.
pub fn line_y(line: usize) -> f64 {
    // Off the middles by a part of no fraction, so that what is drawn at whole pixels meets none.
    let within = ((line % LINES) as f64 + 0.486_731) / LINES as f64;
    (line / LINES) as f64 - 0.5 + within
}

/// The line next to a row.
pub fn line_at(y: f64) -> usize {
    ((y + 0.5) * LINES as f64).max(0.0) as usize
}

/// The first line at or below a row.
fn first_line(y: f64, lines: usize) -> usize {
    let guess = ((y + 0.5) * LINES as f64 - 0.486_731).ceil().max(0.0);
    (guess as usize).min(lines)
}

impl Scanlines {
    /// The crossings of the arcs with the lines of an image with so many rows.
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

    /// The crossings of a line, from the left to the right.
    pub fn on(&self, line: usize) -> &[ScanlineCrossing] {
        &self.crossings[self.starts[line] as usize..self.starts[line + 1] as usize]
    }

    /// How many lines there are.
    pub fn lines(&self) -> usize {
        self.starts.len() - 1
    }
}

/// Notes which crossings of a line are too near to one another for their order to be known.
fn loosen(on: &mut [ScanlineCrossing]) {
    for i in 1..on.len() {
        let [a, b] = [on[i - 1], on[i]];
        if (b.x - a.x) * a.slant.min(b.slant) <= APART {
            on[i - 1].firm = false;
            on[i].firm = false;
        }
    }
}

/// Tells every crossing of a section with a line.
fn each(
    arcs: &[PredictedArc],
    sections: &Sections,
    lines: usize,
    mut report: impl FnMut(usize, ScanlineCrossing),
) {
    for (id, &(arc, [from, to])) in sections.all.iter().enumerate() {
        let points = &arcs[arc as usize].line.points;
        let ends = [points[from][1], points[to][1]];
        for pair in points[from..=to].windows(2) {
            let [a, b] = [pair[0], pair[1]];
            let (top, bottom) = (a[1].min(b[1]), a[1].max(b[1]));
            let slope = (b[0] - a[0]) / (b[1] - a[1]);
            let slant = (b[1] - a[1]).abs() / (b[0] - a[0]).hypot(b[1] - a[1]);
            // What runs down has its left on the page's right.
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
