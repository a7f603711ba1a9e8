//! The regions that arcs divide an image into, each with the one face, and the lights, that are seen
//! in it.
//!
//! Sides of sections that face one another across a line of the image, with nothing between them,
//! belong to one region. What is seen in it is asked of a line of sight through each of a few points
//! of it; where these do not agree, or the sides of shadows contradict it, every pixel is asked.

use super::arc::{ArcSide, PredictedArc};
use super::lit_scene::LitScene;
use super::scanline::{APART, LINES, ScanlineCrossing, Scanlines, Sections, line_at, line_y};
use nalgebra::Point3;
use premio_kernel::brep::topology::FaceId;
use premio_kernel::geometry::surface::Surface;

/// How many bands of a region have points that are asked.
const BANDS: usize = 3;
/// The places in a gap that are asked: of a flat region only the first, its middle.
const ACROSS: [f64; 3] = [0.5, 0.12, 0.88];
/// Of a smaller region, in pixels, only the middles of gaps are asked.
const SMALL: f64 = 64.0;
/// How far next to the middle of a section it is asked, in pixels.
const BESIDE: f64 = 0.5;
/// A point determines whether a light reaches a region only where it does not graze the face.
const GRAZING: f64 = 1.0 / 64.0;

/// What is seen in a region.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RegionSample {
    /// The face; none is the background.
    pub face: Option<FaceId>,
    /// A point of the face that is seen in it.
    pub point: Point3<f64>,
    /// By bit: whether the light reaches it, where it is turned towards the light.
    pub lit: u64,
}

/// A region of an image.
#[derive(Clone, Debug)]
pub struct Region {
    /// What is seen in it; none where every point has to be requested itself.
    pub seen: Option<RegionSample>,
    /// Its area within the image, in pixels.
    pub area: f64,
    /// The least and the greatest pixel that shows it: columns and rows.
    pub bounds: [[f64; 2]; 2],
    /// A few points of it, with the length of the gap between arcs each is in the middle of.
    pub points: Vec<([f64; 2], f64)>,
}

impl Region {
    /// A region of which nothing is told so far.
    fn untold() -> Self {
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
    pub scanlines: Scanlines,
    /// The sections of the arcs.
    pub sections: Sections,
    /// The regions; the first is what lies beyond all arcs, the last all gaps of lines of which
    /// neither end tells what they are.
    pub all: Vec<Region>,
    /// By side of a section: its region.
    sides: Vec<u32>,
    /// The width of the image in pixels.
    width: usize,
}

/// The number of a side of a section.
fn side(section: u32, side: ArcSide) -> usize {
    // The first number is of what lies beyond all arcs.
    1 + 2 * section as usize + usize::from(side == ArcSide::Right)
}

/// Sets of numbers that are joined (Tarjan 1975).
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
        // The lesser number stands for both, so that the order of joins does not matter.
        let (least, most) = (a.min(b), a.max(b));
        self.0[most as usize] = least;
    }
}

impl Regions {
    /// The regions between the arcs of a stage's image.
    pub fn new(stage: &LitScene<'_>, arcs: &[PredictedArc], [width, height]: [usize; 2]) -> Self {
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
                all.push(Region::untold());
            }
            sides.push(numbers[root]);
        }
        all.push(Region::untold());
        let mut regions = Self {
            scanlines,
            sections,
            all,
            sides,
            width,
        };
        regions.choose_points();
        regions.ask(stage, arcs);
        regions
    }

    /// How many arcs divide the image; outlines of highlights, which come after them, do not.
    pub fn arcs(&self) -> usize {
        self.sections.arcs()
    }

    /// The region on a side of a section.
    pub fn adjacent(&self, section: u32, on: ArcSide) -> u32 {
        self.sides[side(section, on)]
    }

    /// The region at a point of the image.
    pub fn at(&self, [x, y]: [f64; 2]) -> u32 {
        let line = line_at(y).min(self.scanlines.lines().saturating_sub(1));
        let on = self.scanlines.on(line);
        let k = on.partition_point(|c| c.x <= x);
        self.between(k.checked_sub(1).map(|k| &on[k]), on.get(k))
    }

    /// The gaps of a line: the region between each two crossings, from beyond the left on.
    pub fn gaps(&self, line: usize) -> impl Iterator<Item = ([f64; 2], u32)> + '_ {
        let on = self.scanlines.on(line);
        (0..=on.len()).map(move |k| {
            let (from, to) = (k.checked_sub(1).map(|k| &on[k]), on.get(k));
            let start = from.map_or(f64::NEG_INFINITY, |c| c.x);
            let end = to.map_or(f64::INFINITY, |c| c.x);
            ([start, end], self.between(from, to))
        })
    }

    /// The region between two crossings that follow one another on a line, or beyond the last.
    fn between(&self, from: Option<&ScanlineCrossing>, to: Option<&ScanlineCrossing>) -> u32 {
        let (Some(from), Some(to)) = (from, to) else {
            return self.sides[0];
        };
        // Next to the end of a section, or to another arc, the other crossing tells.
        match (from.firm, to.firm) {
            (true, _) => self.sides[right_of(from)],
            (false, true) => self.sides[left_of(to)],
            (false, false) => self.all.len() as u32 - 1,
        }
    }

    /// Measures the regions, and chooses points of them: of lines spread over a region those with the
    /// widest gaps, and of a gap its middle and places towards its ends.
    fn choose_points(&mut self) {
        let (left, right) = (-0.5, self.width as f64 - 0.5);
        let inside = |[from, to]: [f64; 2]| (from.max(left), to.min(right));
        for line in 0..self.scanlines.lines() {
            let y = line_y(line);
            let gaps: Vec<_> = self.gaps(line).collect();
            for (gap, region) in gaps {
                let (from, to) = inside(gap);
                if to > from {
                    let region = &mut self.all[region as usize];
                    region.area += (to - from) / LINES as f64;
                    let [least, most] = &mut region.bounds;
                    *least = [least[0].min(from), least[1].min(y)];
                    *most = [most[0].max(to), most[1].max(y)];
                }
            }
        }
        let mut best = vec![[(0.0, 0.0, 0.0); BANDS]; self.all.len()];
        for line in 0..self.scanlines.lines() {
            let y = line_y(line);
            for (gap, region) in self.gaps(line) {
                let (from, to) = inside(gap);
                let [least, most] = self.all[region as usize].bounds;
                let part = (y - least[1]) / (most[1] - least[1]).max(f64::MIN_POSITIVE);
                let resolution = ((part * BANDS as f64) as usize).min(BANDS - 1);
                let known = &mut best[region as usize][resolution];
                if to - from > known.1 - known.0 {
                    *known = (from, to, y);
                }
            }
        }
        for (region, best) in self.all.iter_mut().zip(best) {
            for (from, to, y) in best.into_iter().filter(|(from, to, _)| to - from > APART) {
                let at = |part: f64| ([from + (to - from) * part, y], to - from);
                region.points.extend(ACROSS.map(at));
            }
        }
    }

    /// Asks what is seen in every region.
    fn ask(&mut self, stage: &LitScene<'_>, arcs: &[PredictedArc]) {
        let lights = stage.lights.len().max(1);
        let votes = self.votes(arcs, stage.lights.len());
        let told = self.all.len() - 1;
        for (region, votes) in self.all[..told].iter_mut().zip(votes.chunks(lights)) {
            region.seen = seen(stage, region, votes);
        }
        self.doubt(stage, arcs);
    }

    /// Asks next to the middle of every section: a region that shows something else there than it is
    /// told to, because arcs leave a gap that no line passes, is told nothing of.
    fn doubt(&mut self, stage: &LitScene<'_>, arcs: &[PredictedArc]) {
        for section in 0..self.sections.all.len() {
            let (arc, [from, to]) = self.sections.all[section];
            let line = &arcs[arc as usize].line;
            let middle = (from + to) / 2;
            let [a, b] = [line.points[middle], line.points[middle + 1]];
            let length = (b[0] - a[0]).hypot(b[1] - a[1]);
            let across = [
                (a[1] - b[1]) / length * BESIDE,
                (b[0] - a[0]) / length * BESIDE,
            ];
            for sign in [1.0, -1.0] {
                let at = [0, 1].map(|i| 0.5 * (a[i] + b[i]) + sign * across[i]);
                let side = ArcSide::new(at, [a, b]);
                let region = self.at(at);
                // Another arc may run in between.
                if region != self.adjacent(section as u32, side) || !self.contains(at) {
                    continue;
                }
                let seen = &mut self.all[region as usize].seen;
                *seen = seen.filter(|told| agrees(stage, told, at));
            }
        }
    }

    /// Whether a point lies in the image.
    fn contains(&self, [x, y]: [f64; 2]) -> bool {
        let inside = |v: f64, size: usize| v >= -0.5 && v < size as f64 - 0.5;
        inside(x, self.width) && inside(y, self.scanlines.lines() / LINES)
    }

    /// By region and light: how many sides of shadows say that it is lit, and that it is not.
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

/// Whether a region shows at a point of it what it is told to.
fn agrees(stage: &LitScene<'_>, told: &RegionSample, at: [f64; 2]) -> bool {
    let met = stage.seen(at);
    if met.map(|(face, _)| face) != told.face {
        return false;
    }
    let Some((face, p)) = met else {
        return true;
    };
    let normal = stage.subject.brep.outward(face, &p);
    (0..stage.lights.len()).all(|light| {
        let (towards, _) = stage.lights[light].0.from(&p);
        let told = told.lit >> light & 1 == 1;
        normal.dot(&towards) <= GRAZING || stage.is_lit(light, &p, face) == told
    })
}

/// What is seen at all points of a region, given what the sides of shadows say; none where they differ.
fn seen(stage: &LitScene<'_>, region: &Region, votes: &[[u32; 2]]) -> Option<RegionSample> {
    let points = &region.points;
    let first = stage.seen(points.first()?.0);
    // Flat regions are alike all over, and of small ones few pixels are wrong.
    let flat =
        |(face, _): &(FaceId, _)| matches!(stage.subject.brep.surface(*face), Surface::Plane(_));
    let step = if first.as_ref().is_none_or(flat) || region.area < SMALL {
        ACROSS.len()
    } else {
        1
    };
    let mut hits = points
        .iter()
        .step_by(step)
        .skip(1)
        .map(|&(at, _)| stage.seen(at));
    let Some((face, point)) = first else {
        let same = hits.all(|hit| hit.is_none());
        return same.then_some(RegionSample {
            face: None,
            point: stage.subject.centre,
            lit: 0,
        });
    };
    let mut all = vec![point];
    for hit in hits {
        all.push(hit.filter(|h| h.0 == face)?.1);
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

/// Whether a light reaches points of a face; none where it reaches some of them.
fn is_lit(
    stage: &LitScene<'_>,
    light: usize,
    face: FaceId,
    points: &[Point3<f64>],
    votes: [u32; 2],
) -> Option<bool> {
    let source = &stage.lights[light].0;
    let turned = |p: &&Point3<f64>| {
        let (towards, _) = source.from(p);
        stage.subject.brep.outward(face, p).dot(&towards) > GRAZING
    };
    let mut cast = points
        .iter()
        .filter(turned)
        .map(|p| stage.is_lit(light, p, face));
    match votes {
        [0, 0] => {
            // Where nothing is turned to the light it does not matter.
            let first = cast.next().unwrap_or(true);
            cast.all(|lit| lit == first).then_some(first)
        }
        [_, 0] => cast.all(|lit| lit).then_some(true),
        [0, _] => cast.all(|lit| !lit).then_some(false),
        _ => None,
    }
}
