//! The regions into which arcs divide an image, each with the one face and the lights that are
//! visible in it.
//!
//! Two sides of sections that face each other along a scanline, with no arc between them, belong to
//! one region. The face and the lights of a region are determined by lines of sight through a few
//! of its points. Where these do not agree, or the sides of shadows contradict them, every pixel is
//! evaluated by itself.

use super::arc::{ArcSide, PredictedArc};
use super::lit_scene::LitScene;
use super::scanline::{
    APART, ArcSection, LINES, ScanlineCrossing, Scanlines, Sections, line_at, line_y,
};
use nalgebra::Point3;
use premio_kernel::brep::topology::FaceId;
use premio_kernel::geometry::surface::Surface;
use premio_visibility::ray_casting::FirstHit;

/// The number of bands of a region from which sample points are taken.
const BANDS: usize = 3;
/// The positions of sample points in a gap; in a flat region only the first, its middle, is used.
const ACROSS: [f64; 3] = [0.5, 0.12, 0.88];
/// In a region smaller than this, in pixels, only the middles of gaps are sampled.
const SMALL: f64 = 64.0;
/// The distance of a check point from the middle of a section, in pixels.
const CHECK_DISTANCE: f64 = 0.5;
/// The least cosine of incidence at which a point determines whether a light reaches a region.
const GRAZING: f64 = 1.0 / 64.0;

/// The content of a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionSample {
    /// The face; none is the background.
    pub face: Option<FaceId>,
    /// A point of the face that is visible in it.
    pub point: Point3<f64>,
    /// By bit: whether the light reaches it, where it is turned towards the light.
    pub lit: u64,
}

/// A region of an image.
#[derive(Clone, Debug)]
pub struct Region {
    /// Its content; none where every pixel has to be evaluated by itself.
    pub seen: Option<RegionSample>,
    /// Its area within the image, in pixels.
    pub area: f64,
    /// The bounds of its pixels: columns and rows.
    pub bounds: [[f64; 2]; 2],
    /// Sample points.
    pub points: Vec<RegionPoint>,
}

/// A sample point of a region, between two arcs on a scanline.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionPoint {
    /// The point of the image.
    pub at: [f64; 2],
    /// The length of the gap between the arcs.
    pub gap: f64,
}

/// A gap of a scanline, between two crossings of arcs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ScanlineGap {
    /// Where it begins and ends, in columns.
    pub range: [f64; 2],
    /// Its region.
    pub region: u32,
}

/// The widest gap of a region on some scanlines.
#[derive(Clone, Copy)]
struct WidestGap {
    range: [f64; 2],
    /// The row of the scanline.
    y: f64,
}

impl WidestGap {
    const NONE: Self = Self {
        range: [0.0; 2],
        y: 0.0,
    };

    fn length(&self) -> f64 {
        self.range[1] - self.range[0]
    }
}

impl Region {
    /// A region without content.
    fn without_content() -> Self {
        Self {
            seen: None,
            area: 0.0,
            bounds: [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]],
            points: Vec::new(),
        }
    }
}

/// The regions of an image.
#[derive(Debug)]
pub struct Regions {
    /// The crossings of lines and arcs.
    pub(crate) scanlines: Scanlines,
    /// The sections of the arcs.
    pub(crate) sections: Sections,
    /// The regions. The first is the outside of all arcs. The last contains all gaps of scanlines
    /// whose region neither end determines.
    pub all: Vec<Region>,
    /// By side of a section: its region.
    sides: Vec<u32>,
    /// The width of the image in pixels.
    width: usize,
}

/// The index of a side of a section.
fn side(section: u32, side: ArcSide) -> usize {
    // Index 0 is the outside of all arcs.
    1 + 2 * section as usize + usize::from(side == ArcSide::Right)
}

/// Disjoint sets of indices (Tarjan 1975).
struct Sets(Vec<u32>);

impl Sets {
    fn find(&mut self, mut i: u32) -> u32 {
        while self.0[i as usize] != i {
            let above = self.0[self.0[i as usize] as usize];
            self.0[i as usize] = above;
            i = above;
        }
        i
    }

    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a as u32), self.find(b as u32));
        // The lesser index represents both, so that the order of joins does not matter.
        let (least, most) = (a.min(b), a.max(b));
        self.0[most as usize] = least;
    }
}

impl Regions {
    /// The regions between the arcs of a stage's image.
    pub(crate) fn new(
        stage: &LitScene<'_>,
        arcs: &[PredictedArc],
        [width, height]: [usize; 2],
    ) -> Self {
        let sections = Sections::new(arcs);
        let scanlines = Scanlines::new(arcs, &sections, height);
        let mut sets = Sets((0..=2 * sections.all.len() as u32).collect());
        for line in 0..scanlines.lines() {
            join(scanlines.on(line), &mut sets);
        }
        let mut numbers = vec![u32::MAX; sets.0.len()];
        let mut all = Vec::new();
        let mut sides = Vec::with_capacity(sets.0.len());
        for i in 0..sets.0.len() {
            let root = sets.find(i as u32) as usize;
            if numbers[root] == u32::MAX {
                numbers[root] = all.len() as u32;
                all.push(Region::without_content());
            }
            sides.push(numbers[root]);
        }
        all.push(Region::without_content());
        let mut regions = Self {
            scanlines,
            sections,
            all,
            sides,
            width,
        };
        regions.choose_points();
        regions.sample(stage, arcs);
        regions
    }

    /// The number of arcs that divide the image; outlines of highlights, which come after them, do
    /// not.
    pub(crate) fn arcs(&self) -> usize {
        self.sections.arcs()
    }

    /// The region on a side of a section.
    pub(crate) fn adjacent(&self, section: u32, on: ArcSide) -> u32 {
        self.sides[side(section, on)]
    }

    /// The region at a point of the image.
    pub fn at(&self, [x, y]: [f64; 2]) -> u32 {
        let line = line_at(y).min(self.scanlines.lines().saturating_sub(1));
        let on = self.scanlines.on(line);
        let k = on.partition_point(|c| c.x <= x);
        self.between(k.checked_sub(1).map(|k| &on[k]), on.get(k))
    }

    /// The gaps of a scanline between each two crossings, starting with the outside on the left.
    pub(crate) fn gaps(&self, line: usize) -> impl Iterator<Item = ScanlineGap> + '_ {
        let on = self.scanlines.on(line);
        (0..=on.len()).map(move |k| {
            let (from, to) = (k.checked_sub(1).map(|k| &on[k]), on.get(k));
            let start = from.map_or(f64::NEG_INFINITY, |c| c.x);
            let end = to.map_or(f64::INFINITY, |c| c.x);
            ScanlineGap {
                range: [start, end],
                region: self.between(from, to),
            }
        })
    }

    /// The region between two consecutive crossings of a scanline, or beyond the last.
    fn between(&self, from: Option<&ScanlineCrossing>, to: Option<&ScanlineCrossing>) -> u32 {
        let (Some(from), Some(to)) = (from, to) else {
            return self.sides[0];
        };
        // Near the end of a section, or near another arc, the other crossing decides.
        match (from.firm, to.firm) {
            (true, _) => self.sides[right_of(from)],
            (false, true) => self.sides[left_of(to)],
            (false, false) => self.all.len() as u32 - 1,
        }
    }

    /// Measures the regions and chooses their sample points: on scanlines spread over a region
    /// those with the widest gaps, and in a gap its middle and points towards its ends.
    fn choose_points(&mut self) {
        let (left, right) = (-0.5, self.width as f64 - 0.5);
        let inside = |[from, to]: [f64; 2]| (from.max(left), to.min(right));
        for line in 0..self.scanlines.lines() {
            let y = line_y(line);
            let gaps: Vec<_> = self.gaps(line).collect();
            for gap in gaps {
                let (from, to) = inside(gap.range);
                if to > from {
                    let region = &mut self.all[gap.region as usize];
                    region.area += (to - from) / LINES as f64;
                    let [least, most] = &mut region.bounds;
                    *least = [least[0].min(from), least[1].min(y)];
                    *most = [most[0].max(to), most[1].max(y)];
                }
            }
        }
        let mut best = vec![[WidestGap::NONE; BANDS]; self.all.len()];
        for line in 0..self.scanlines.lines() {
            let y = line_y(line);
            for gap in self.gaps(line) {
                let (from, to) = inside(gap.range);
                let [least, most] = self.all[gap.region as usize].bounds;
                let part = (y - least[1]) / (most[1] - least[1]).max(f64::MIN_POSITIVE);
                let strip = ((part * BANDS as f64) as usize).min(BANDS - 1);
                let known = &mut best[gap.region as usize][strip];
                if to - from > known.length() {
                    let range = [from, to];
                    *known = WidestGap { range, y };
                }
            }
        }
        for (region, best) in self.all.iter_mut().zip(best) {
            for gap in best.into_iter().filter(|gap| gap.length() > APART) {
                let [from, to] = gap.range;
                let at = |part: f64| RegionPoint {
                    at: [from + (to - from) * part, gap.y],
                    gap: to - from,
                };
                region.points.extend(ACROSS.map(at));
            }
        }
    }

    /// Determines the content of every region.
    fn sample(&mut self, stage: &LitScene<'_>, arcs: &[PredictedArc]) {
        let lights = stage.lights.len().max(1);
        let votes = self.votes(arcs, stage.lights.len());
        let defined = self.all.len() - 1;
        for (region, votes) in self.all[..defined].iter_mut().zip(votes.chunks(lights)) {
            region.seen = seen(stage, region, votes);
        }
        self.check_sections(stage, arcs);
    }

    /// Checks every region next to the middle of each of its sections. A region with other content
    /// there loses its content: arcs leave a gap that no scanline passes.
    fn check_sections(&mut self, stage: &LitScene<'_>, arcs: &[PredictedArc]) {
        for section in 0..self.sections.all.len() {
            let ArcSection {
                arc,
                ends: [from, to],
            } = self.sections.all[section];
            let line = &arcs[arc as usize].line;
            let middle = (from + to) / 2;
            let [a, b] = [line.points[middle], line.points[middle + 1]];
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let across = [
                (a[1] - b[1]) / length * CHECK_DISTANCE,
                (b[0] - a[0]) / length * CHECK_DISTANCE,
            ];
            for sign in [1.0, -1.0] {
                let at = [0, 1].map(|i| 0.5 * (a[i] + b[i]) + sign * across[i]);
                let side = ArcSide::new(at, [a, b]);
                let region = self.at(at);
                // Another arc may lie between.
                if region != self.adjacent(section as u32, side) || !self.contains(at) {
                    continue;
                }
                let seen = &mut self.all[region as usize].seen;
                *seen = seen.filter(|content| agrees(stage, content, at));
            }
        }
    }

    /// Whether a point lies in the image.
    fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let inside = |v: f64, size: usize| v >= -0.5 && v < size as f64 - 0.5;
        inside(x, self.width) && inside(y, self.scanlines.lines() / LINES)
    }

    /// By region and light: how many sides of shadows mark it as lit, and as not lit.
    fn votes(&self, arcs: &[PredictedArc], lights: usize) -> Vec<[u32; 2]> {
        let mut votes = vec![[0; 2]; self.all.len() * lights.max(1)];
        for (i, arc) in arcs.iter().enumerate() {
            let Some(shade) = arc.shade else {
                continue;
            };
            for section in self.sections.of_arc(i) {
                for (on, which) in [(shade.lit, 0), (shade.lit.other(), 1)] {
                    let region = self.adjacent(section, on) as usize;
                    votes[region * lights + shade.light][which] += 1;
                }
            }
        }
        votes
    }
}

fn left_of(c: &ScanlineCrossing) -> usize {
    side(c.section, c.right.other())
}

fn right_of(c: &ScanlineCrossing) -> usize {
    side(c.section, c.right)
}

fn join(on: &[ScanlineCrossing], sets: &mut Sets) {
    if let Some(first) = on.first().filter(|c| c.firm) {
        sets.join(0, left_of(first));
    }
    if let Some(last) = on.last().filter(|c| c.firm) {
        sets.join(0, right_of(last));
    }
    for pair in on.windows(2) {
        let [a, b] = [&pair[0], &pair[1]];
        if a.firm && b.firm {
            sets.join(right_of(a), left_of(b));
        }
    }
}

/// Whether the view at a point of a region agrees with its content.
fn agrees(stage: &LitScene<'_>, content: &RegionSample, at: [f64; 2]) -> bool {
    let met = stage.seen(at);
    if met.map(|hit| hit.face) != content.face {
        return false;
    }
    let Some(FirstHit { face, point: p }) = met else {
        return true;
    };
    let normal = stage.subject.brep.outward(face, &p);
    (0..stage.lights.len()).all(|light| {
        let towards = stage.lights[light].source.from(&p).direction;
        let content = content.lit >> light & 1 == 1;
        normal.dot(&towards) <= GRAZING || stage.is_lit(light, &p, face) == content
    })
}

/// The content of a region at all its sample points, given the votes of the sides of shadows; none
/// where they differ.
fn seen(stage: &LitScene<'_>, region: &Region, votes: &[[u32; 2]]) -> Option<RegionSample> {
    let points = &region.points;
    let first = stage.seen(points.first()?.at);
    // A flat region is uniform, and in a small one few pixels can be wrong.
    let flat = |hit: &FirstHit| {
        let surface = stage.subject.brep.surface(hit.face);
        matches!(surface, Surface::Plane(_))
    };
    let step = if first.as_ref().is_none_or(flat) || region.area < SMALL {
        ACROSS.len()
    } else {
        1
    };
    let mut hits = points
        .iter()
        .step_by(step)
        .skip(1)
        .map(|point| stage.seen(point.at));
    let Some(FirstHit { face, point }) = first else {
        let same = hits.all(|hit| hit.is_none());
        return same.then_some(RegionSample {
            face: None,
            point: stage.subject.centre,
            lit: 0,
        });
    };
    let mut all = vec![point];
    for hit in hits {
        all.push(hit.filter(|h| h.face == face)?.point);
    }
    let mut lit = 0u64;
    for (light, votes) in (0..stage.lights.len()).zip(votes) {
        if is_lit(stage, light, face, &all, *votes)? {
            lit |= 1 << light;
        }
    }
    Some(RegionSample {
        face: Some(face),
        point,
        lit,
    })
}

/// Whether a light reaches points of a face; none where it reaches only some of them.
fn is_lit(
    stage: &LitScene<'_>,
    light: usize,
    face: FaceId,
    points: &[Point3<f64>],
    votes: [u32; 2],
) -> Option<bool> {
    let source = &stage.lights[light].source;
    let turned = |p: &&Point3<f64>| {
        let towards = source.from(p).direction;
        stage.subject.brep.outward(face, p).dot(&towards) > GRAZING
    };
    let mut cast = points
        .iter()
        .filter(turned)
        .map(|p| stage.is_lit(light, p, face));
    match votes {
        [0, 0] => {
            // If no point is turned towards the light, the value does not matter.
            let first = cast.next().unwrap_or(true);
            cast.all(|lit| lit == first).then_some(first)
        }
        [_, 0] => cast.all(|lit| lit).then_some(true),
        [0, _] => cast.all(|lit| !lit).then_some(false),
        _ => None,
    }
}
