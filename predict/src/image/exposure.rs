//! The grey levels of pixels from the regions in each. The scanlines through a pixel determine the
//! area of each region in it, and each region is shaded at the centre of its area.

use super::field::Field;
use super::shading::Shading;
use crate::image_arcs::scanline::{LINES, line_y};
use crate::image_arcs::{Region, Regions};
use premio_detect::{Grey, PixelMask};
use std::ops::Range;

/// The spacing, in pixels, at which the light of one region is computed, where it is linear in
/// between.
const KNOTS: u32 = 8;
/// The greatest deviation from linearity, in grey levels.
const STRAIGHT: f64 = 1.0 / 16.0;

/// The share of a pixel that one scanline represents.
const SHARE: f64 = 1.0 / LINES as f64;

/// The area of one region in a pixel.
#[derive(Clone, Copy, Debug)]
struct Share {
    region: u32,
    area: f64,
    /// The area's first moments: divided by the area they give its centre.
    moment: [f64; 2],
}

/// The levels of the pixels of a domain, before the point spread, noise and steps.
pub fn expose(shading: &Shading<'_>, regions: &Regions, domain: &PixelMask, image: &mut Grey) {
    let mut light = Light::new(shading, regions);
    let mut shares: Vec<Share> = Vec::new();
    let mut row = Row::default();
    for y in 0..image.height.min(domain.height()) {
        let spans = domain.spans(y);
        if spans.is_empty() {
            continue;
        }
        row.fill(regions, y);
        let levels = &mut image.levels[y * image.width..(y + 1) * image.width];
        for span in spans {
            row.seek(span.start);
            let mut x = span.start;
            while x < span.end {
                // Up to here each scanline stays in one region.
                match row.unambiguous(x) {
                    RegionRun {
                        end: until,
                        region: Some(region),
                    } if until > x => {
                        let run = x..until.min(span.end);
                        x = run.end;
                        light.shade(region, run, y, levels);
                    }
                    _ => {
                        let is_known = |r: u32| regions.all[r as usize].seen.is_some();
                        row.shares(x, y, is_known, &mut shares);
                        let part = |share: &Share| {
                            let at = share.moment.map(|m| m / share.area);
                            share.area * light.level(share.region, at)
                        };
                        levels[x as usize] = shares.iter().map(part).sum::<f64>() as f32;
                        x += 1;
                    }
                }
            }
        }
    }
}

/// The light of the regions of an image, with the state of the evaluation of each.
struct Light<'s, 'p> {
    shading: &'s Shading<'p>,
    regions: &'s Regions,
    /// By region: the distance of the last evaluated point.
    hints: Vec<f64>,
    /// By region: its field, if it is flat.
    fields: Vec<Option<Field>>,
}

impl<'s, 'p> Light<'s, 'p> {
    fn new(shading: &'s Shading<'p>, regions: &'s Regions) -> Self {
        let hint = |region: &Region| {
            let seen = region.seen.as_ref();
            seen.map_or(0.0, |s| shading.distance(&s.point))
        };
        let field = |region: &Region| Field::new(shading, region);
        Self {
            shading,
            regions,
            hints: regions.all.iter().map(hint).collect(),
            fields: regions.all.iter().map(field).collect(),
        }
    }

    /// The level of a region at a point of it.
    fn level(&mut self, region: u32, at: [f64; 2]) -> f64 {
        let region = region as usize;
        if let Some(field) = &mut self.fields[region] {
            return field.level(self.shading, at);
        }
        match &self.regions.all[region].seen {
            Some(seen) => self.shading.level(at, seen, &mut self.hints[region]),
            None => {
                let seen = self.shading.cast(at);
                self.shading
                    .level(at, &seen, &mut self.shading.distance(&seen.point))
            }
        }
    }

    /// The levels of a run of pixels of one region.
    fn shade(&mut self, region: u32, run: Range<u32>, y: usize, levels: &mut [f32]) {
        if let Some(field) = &mut self.fields[region as usize] {
            return field.shade(self.shading, run, y as f64, levels);
        }
        let mut level = |x: u32| self.level(region, [f64::from(x), y as f64]);
        shade(run, levels, &mut level);
    }
}

/// The levels of a run of pixels of one region: interpolated in pieces between the ends and the
/// middle where it is linear, and halved where not.
fn shade(run: Range<u32>, row: &mut [f32], level: &mut impl FnMut(u32) -> f64) {
    let mut from = PixelLevel::new(run.start, level);
    row[from.x as usize] = from.level as f32;
    while from.x + 1 < run.end {
        let x = (from.x + KNOTS).min(run.end - 1);
        let to = PixelLevel::new(x, level);
        between([from, to], row, level);
        row[to.x as usize] = to.level as f32;
        from = to;
    }
}

/// The level of a pixel of a row.
#[derive(Clone, Copy)]
struct PixelLevel {
    x: u32,
    level: f64,
}

impl PixelLevel {
    fn new(x: u32, level: &mut impl FnMut(u32) -> f64) -> Self {
        Self { x, level: level(x) }
    }

    /// The level at a pixel, interpolated between this one and another.
    fn interpolated(&self, other: &Self, x: u32) -> f64 {
        let part = f64::from(x - self.x) / f64::from(other.x - self.x);
        self.level + (other.level - self.level) * part
    }
}

/// The levels between two pixels.
fn between([from, to]: [PixelLevel; 2], row: &mut [f32], level: &mut impl FnMut(u32) -> f64) {
    let x = (from.x + to.x) / 2;
    if x == from.x {
        return;
    }
    let middle = PixelLevel::new(x, level);
    row[x as usize] = middle.level as f32;
    // A parabola deviates from its half chords by a quarter of the deviation of its middle from its
    // chord.
    if (from.interpolated(&to, x) - middle.level).abs() > 4.0 * STRAIGHT {
        between([from, middle], row, level);
        between([middle, to], row, level);
        return;
    }
    for [a, b] in [[from, middle], [middle, to]] {
        for x in a.x + 1..b.x {
            row[x as usize] = a.interpolated(&b, x) as f32;
        }
    }
}

/// The end of a gap of a scanline, and its region.
#[derive(Clone, Copy)]
struct RowGap {
    end: f64,
    region: u32,
}

/// A run of pixels in which every scanline stays in its gap.
struct RegionRun {
    /// The last pixel.
    end: u32,
    /// The region of all gaps, if they have the same.
    region: Option<u32>,
}

/// The gaps of the scanlines through a row of pixels.
#[derive(Default)]
struct Row {
    /// By scanline: its gaps.
    gaps: [Vec<RowGap>; LINES],
    /// By scanline: the gap in which the last pixel began.
    at: [usize; LINES],
}

impl Row {
    fn fill(&mut self, regions: &Regions, y: usize) {
        for (k, gaps) in self.gaps.iter_mut().enumerate() {
            gaps.clear();
            gaps.extend(regions.gaps(y * LINES + k).map(|gap| RowGap {
                end: gap.range[1],
                region: gap.region,
            }));
        }
        self.at = [0; LINES];
    }

    /// Advances to the gaps in which a pixel begins.
    fn seek(&mut self, x: u32) {
        let left = f64::from(x) - 0.5;
        for (gaps, at) in self.gaps.iter().zip(&mut self.at) {
            while *at + 1 < gaps.len() && gaps[*at].end <= left {
                *at += 1;
            }
        }
    }

    /// The run of pixels, from a given one on, in which every scanline stays in its gap.
    fn unambiguous(&mut self, x: u32) -> RegionRun {
        self.seek(x);
        let RowGap { mut end, region } = self.gaps[0][self.at[0]];
        let mut same = Some(region);
        for (gaps, &at) in self.gaps.iter().zip(&self.at).skip(1) {
            end = end.min(gaps[at].end);
            same = same.filter(|region| *region == gaps[at].region);
        }
        RegionRun {
            // The last pixel that ends before the gap does.
            end: ((end + 0.5).floor().max(0.0) as u32).max(x),
            region: same,
        }
    }

    /// The shares of regions in a pixel; `is_known` states whether the content of a region is
    /// known.
    fn shares(&self, x: u32, y: usize, is_known: impl Fn(u32) -> bool, shares: &mut Vec<Share>) {
        shares.clear();
        let (left, right) = (f64::from(x) - 0.5, f64::from(x) + 0.5);
        for (k, (gaps, &at)) in self.gaps.iter().zip(&self.at).enumerate() {
            let row = line_y(y * LINES + k);
            let mut from = left;
            for &RowGap { end, region } in &gaps[at..] {
                let to = end.min(right);
                if to > from {
                    let area = (to - from) * SHARE;
                    let moment = [area * 0.5 * (from + to), area * row];
                    let share = Share {
                        region,
                        area,
                        moment,
                    };
                    match is_known(region) {
                        true => add(shares, share),
                        // The content may differ on every scanline.
                        false => shares.push(share),
                    }
                    from = to;
                }
                if end >= right {
                    break;
                }
            }
        }
    }
}

fn add(shares: &mut Vec<Share>, share: Share) {
    match shares.iter_mut().find(|known| known.region == share.region) {
        Some(known) => {
            known.area += share.area;
            for i in 0..2 {
                known.moment[i] += share.moment[i];
            }
        }
        None => shares.push(share),
    }
}
