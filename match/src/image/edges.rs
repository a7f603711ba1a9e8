//! Edge pixels indexed by position and orientation.

use nalgebra::{Point2, Vector2};
use premio_detect::{Detection, SegmentShape};
use std::f64::consts::PI;

/// The number of orientation classes.
pub const BINS: usize = 16;
/// The tolerance for the distance of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reach {
    /// Two pixels, for a refined pose.
    Fine,
    /// Five pixels, for an approximate pose.
    Coarse,
}

impl Reach {
    const ALL: [Self; 2] = [Self::Fine, Self::Coarse];

    fn pixels(self) -> i32 {
        match self {
            Self::Fine => 2,
            Self::Coarse => 5,
        }
    }
}

/// The width of the border of an image, in pixels, in which no edges are found.
const BORDER: f64 = 6.0;

/// The orientation class of a normal, modulo 180 degrees.
pub fn bin(normal: &Vector2<f64>) -> usize {
    let turn = normal.y.atan2(normal.x) / PI;
    ((turn + 1.0) * BINS as f64) as usize % BINS
}

/// The length of the pieces into which chains are cut, in pixels.
pub const PIECE: usize = 12;

/// By edge pixel: the index of its piece.
fn pieces(detection: &Detection) -> Vec<u32> {
    let mut all = vec![0; detection.pixels.len()];
    let mut next = 0;
    for chain in &detection.chains {
        for run in chain.pixels.chunks(PIECE) {
            next += 1;
            for &pixel in run {
                all[pixel as usize] = next;
            }
        }
    }
    all
}

/// The segment of an edge pixel.
#[derive(Clone, Copy)]
struct PixelSegment {
    /// The unit normal. On a curved segment it is the pixel's gradient.
    normal: Vector2<f64>,
    /// The length of the segment, in pixels.
    length: f64,
    /// The index of the segment.
    segment: u32,
}

/// By edge pixel: its segment.
fn pixel_segments(detection: &Detection) -> Vec<Option<PixelSegment>> {
    let mut all = vec![None; detection.pixels.len()];
    for (number, segment) in (0..).zip(&detection.segments) {
        let [from, to] = segment.range.map(|n| n as usize);
        let pixels = &detection.chains[segment.chain as usize].pixels[from..to];
        for &pixel in pixels {
            let gradient = Vector2::from(detection.pixels[pixel as usize].gradient);
            let normal = match segment.shape {
                SegmentShape::Line { ends: [a, b] } => Vector2::new(a[1] - b[1], b[0] - a[0]),
                _ => gradient,
            };
            all[pixel as usize] = normal.try_normalize(0.0).map(|normal| PixelSegment {
                normal,
                length: pixels.len() as f64,
                segment: number,
            });
        }
    }
    all
}

/// An edge pixel near a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeHit {
    /// Its signed distance along the normal, in pixels.
    pub offset: f64,
    /// Its index in the detection.
    pub pixel: u32,
    /// The number of its segment.
    pub segment: u32,
    /// The index of its piece of a chain.
    pub piece: u32,
}

/// The segment length, in pixels, above which longer segments are not preferred.
const LONG: f64 = 60.0;
/// How much less a pixel at the greatest distance is preferred than one at the point.
const NEARER: f64 = 0.8;

/// An edge pixel.
#[derive(Clone, Copy, Debug)]
struct Pixel {
    at: Point2<f64>,
    /// The unit normal of its segment.
    normal: Vector2<f64>,
    /// The length of its segment in pixels.
    length: f64,
    /// The number of its segment.
    segment: u32,
    /// The number of its piece.
    piece: u32,
}

/// The edge pixels of an image.
#[derive(Clone, Debug)]
pub struct Edges {
    width: usize,
    height: usize,
    /// By pixel: the index of its edge pixel plus one, or zero.
    numbers: Vec<u32>,
    /// By tolerance and pixel: the orientations of edge pixels within the tolerance, as bits.
    near: [Vec<u16>; 2],
    pixels: Vec<Pixel>,
}

impl Edges {
    /// The edge pixels of a detection, without those of chains too short to be segments.
    pub fn new(detection: &Detection, [width, height]: [usize; 2]) -> Self {
        let mut edges = Self {
            width,
            height,
            numbers: vec![0; width * height],
            near: Reach::ALL.map(|_| vec![0; width * height]),
            pixels: Vec::with_capacity(detection.pixels.len()),
        };
        let across = pixel_segments(detection);
        let pieces = pieces(detection);
        for (number, pixel) in detection.pixels.iter().enumerate() {
            let gradient = Vector2::from(pixel.gradient);
            let own = gradient / gradient.norm().max(f64::MIN_POSITIVE);
            let PixelSegment {
                normal,
                length,
                segment,
            } = across[number].unwrap_or(PixelSegment {
                normal: own,
                length: 0.0,
                segment: u32::MAX,
            });
            let at = Point2::from(pixel.at);
            edges.pixels.push(Pixel {
                at,
                normal,
                length,
                segment,
                piece: pieces[number],
            });
            if across[number].is_some() {
                edges.numbers[pixel.y as usize * width + pixel.x as usize] = number as u32 + 1;
                let at = [pixel.x as i32, pixel.y as i32];
                for reach in Reach::ALL {
                    edges.stamp(at, bin(&normal), reach);
                }
            }
        }
        edges
    }

    fn stamp(&mut self, [x, y]: [i32; 2], bin: usize, reach: Reach) {
        let far = reach.pixels();
        let own = 1u16 << bin;
        let bits = own | own.rotate_left(1) | own.rotate_right(1);
        for dy in -far..=far {
            for dx in -far..=far {
                if dx * dx + dy * dy > far * far + 1 {
                    continue;
                }
                let (x, y) = (x + dx, y + dy);
                if x >= 0 && y >= 0 && x < self.width as i32 && y < self.height as i32 {
                    self.near[reach as usize][y as usize * self.width + x as usize] |= bits;
                }
            }
        }
    }

    /// Whether a point lies in the image and off its border, where edges are found.
    pub fn reaches(&self, at: &Point2<f64>) -> bool {
        let inside = |v: f64, size: usize| v >= BORDER && v < size as f64 - 1.0 - BORDER;
        inside(at.x, self.width) && inside(at.y, self.height)
    }

    /// Whether an edge of an orientation class lies within the tolerance of a point; none for a
    /// point outside the image or on its border.
    pub fn contains(&self, at: &Point2<f64>, bin: usize, reach: Reach) -> Option<bool> {
        let (x, y) = ((at.x + 0.5) as usize, (at.y + 0.5) as usize);
        self.reaches(at)
            .then(|| self.near[reach as usize][y * self.width + x] >> bin & 1 == 1)
    }

    /// The edge pixel along a normal to either side of a point, within a distance in pixels, whose
    /// gradient has at least the given cosine with the normal. It prefers near pixels and long
    /// segments.
    pub fn along(
        &self,
        at: &Point2<f64>,
        normal: &Vector2<f64>,
        reach: f64,
        cosine: f64,
    ) -> Option<EdgeHit> {
        let steps = reach.ceil() as i32;
        let mut best: Option<(f64, EdgeHit)> = None;
        for k in -steps..=steps {
            let p = at + normal * f64::from(k);
            let Some(hit) = self.hit(&p, at, normal, reach, cosine) else {
                continue;
            };
            let length = self.pixels[hit.pixel as usize].length.min(LONG);
            let worth = length * (1.0 - NEARER * hit.offset.abs() / reach);
            if best.is_none_or(|b| worth > b.0) {
                best = Some((worth, hit));
            }
        }
        best.map(|b| b.1)
    }

    /// The edge pixels along a normal within a distance of a point, from one side to the other, the
    /// first of each segment.
    pub fn all_along(
        &self,
        at: &Point2<f64>,
        normal: &Vector2<f64>,
        reach: f64,
        cosine: f64,
    ) -> Vec<EdgeHit> {
        let steps = reach.ceil() as i32;
        let mut all: Vec<EdgeHit> = Vec::new();
        for k in -steps..=steps {
            let p = at + normal * f64::from(k);
            let hit = self.hit(&p, at, normal, reach, cosine);
            all.extend(hit.filter(|h| all.iter().all(|a| a.segment != h.segment)));
        }
        all
    }

    fn hit(
        &self,
        p: &Point2<f64>,
        at: &Point2<f64>,
        normal: &Vector2<f64>,
        reach: f64,
        cosine: f64,
    ) -> Option<EdgeHit> {
        let (x, y) = (p.x + 0.5, p.y + 0.5);
        if !(x >= 0.0 && y >= 0.0 && x < self.width as f64 && y < self.height as f64) {
            return None;
        }
        let number = self.numbers[y as usize * self.width + x as usize].checked_sub(1)?;
        let pixel = &self.pixels[number as usize];
        let offset = normal.dot(&(pixel.at - at));
        let fits = pixel.normal.dot(normal).abs() >= cosine && offset.abs() <= reach;
        fits.then_some(EdgeHit {
            offset,
            pixel: number,
            segment: pixel.segment,
            piece: pixel.piece,
        })
    }
}
