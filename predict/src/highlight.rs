//! Outlines of highlights: where the specular reflection of a light in a face has half its greatest
//! brightness.

use crate::image::shading::Shading;
use crate::image_arcs::arc::{ArcSource, PredictedArc};
use crate::image_arcs::flatten::Polyline;
use crate::image_arcs::regions::{RegionSample, Regions};
use crate::setup::Conditions;
use premio_kernel::brep::topology::FaceId;
use std::f64::consts::TAU;

/// The spacing, in pixels, of the start points of the search for the brightest one.
const EVERY: usize = 8;
/// The number of directions in which the outline is searched.
const DIRECTIONS: usize = 96;
/// The least brightness of a highlight, in grey levels, that a threshold can detect.
const FAINT: f64 = 4.0;

/// The greatest distance of an outline from its brightest point, in pixels: outside the image
/// regions are unbounded.
const FURTHEST: f64 = 1_048_576.0;

/// The point of a region with the strongest specular reflection of a light.
#[derive(Clone, Copy, Debug)]
struct Peak {
    at: [f64; 2],
    /// N·H.
    mirrored: f64,
}

/// Adds the outlines of the highlights of a view to its arcs.
pub fn add_highlights(
    shading: &Shading<'_>,
    regions: &Regions,
    conditions: &Conditions,
    arcs: &mut Vec<PredictedArc>,
) {
    let lights = shading.lights();
    let peaks = peaks(shading, regions, conditions.sensor.resolution, lights);
    for (k, peak) in peaks.iter().enumerate() {
        let (region, light) = ((k / lights.max(1)) as u32, k % lights.max(1));
        let (Some(peak), Some(seen)) = (peak, regions.all[region as usize].seen) else {
            continue;
        };
        let Some(face) = seen.face else {
            continue;
        };
        let only = RegionSample {
            lit: 1 << light,
            ..seen
        };
        let glow = Glow {
            shading,
            regions,
            region,
            seen: only,
            face,
            light,
            resolution: conditions.sensor.resolution,
        };
        let source = ArcSource::Highlight {
            light: light as u32,
            face: face.0,
        };
        for line in glow.outlines(*peak) {
            arcs.push(PredictedArc {
                source,
                contour: None,
                smooth: false,
                coefficients: Vec::new(),
                line,
                stops: Vec::new(),
                shade: None,
                within: Some(region),
            });
        }
    }
}

/// By region and light: the point of a lattice with the strongest specular reflection.
fn peaks(
    shading: &Shading<'_>,
    regions: &Regions,
    [width, height]: [usize; 2],
    lights: usize,
) -> Vec<Option<Peak>> {
    let mut peaks: Vec<Option<Peak>> = vec![None; regions.all.len() * lights];
    let first = |r: &crate::image_arcs::Region| r.seen.map_or(0.0, |s| shading.distance(&s.point));
    let mut hints: Vec<f64> = regions.all.iter().map(first).collect();
    for y in (0..height).step_by(EVERY) {
        for x in (0..width).step_by(EVERY) {
            let at = [x as f64, y as f64];
            let region = regions.at(at);
            let Some(seen) = regions.all[region as usize].seen else {
                continue;
            };
            let Some(face) = seen
                .face
                .filter(|face| seen.lit != 0 && shading.mirrors(*face))
            else {
                continue;
            };
            for light in (0..lights).filter(|l| seen.lit >> l & 1 == 1) {
                let hint = &mut hints[region as usize];
                let Some(mirrored) = shading.mirrored(at, face, light, hint) else {
                    continue;
                };
                let known = &mut peaks[region as usize * lights + light];
                if known.is_none_or(|peak| mirrored > peak.mirrored) {
                    *known = Some(Peak { at, mirrored });
                }
            }
        }
    }
    peaks
}

/// The reflection of a light in a region.
struct Glow<'s, 'p> {
    shading: &'s Shading<'p>,
    regions: &'s Regions,
    region: u32,
    seen: RegionSample,
    face: FaceId,
    light: usize,
    /// That of the image.
    resolution: [usize; 2],
}

impl Glow<'_, '_> {
    /// Whether a point is in the image or within its width and height of it: outside the image
    /// regions are unbounded.
    fn is_near(&self, at: [f64; 2]) -> bool {
        at.iter().zip(self.resolution).all(|(x, n)| {
            let n = n as f64;
            (-n..=2.0 * n).contains(x)
        })
    }

    fn inside(&self, at: [f64; 2]) -> bool {
        self.regions.at(at) == self.region
    }

    /// The specular reflection of the light, in grey levels.
    fn level(&self, at: [f64; 2]) -> f64 {
        let mut hint = self.shading.distance(&self.seen.point);
        self.shading.levels(at, &self.seen, &mut hint).specular
    }

    /// The brightest point, from one near it.
    fn brightest(&self, peak: Peak) -> Peak {
        let mut best = peak;
        let mut step = 0.5 * EVERY as f64;
        while step > 1.0 / 16.0 {
            let [x, y] = best.at;
            let around = [[x + step, y], [x - step, y], [x, y + step], [x, y - step]];
            let mut moved = false;
            for at in around
                .into_iter()
                .filter(|at| self.is_near(*at) && self.inside(*at))
            {
                let mut hint = self.shading.distance(&self.seen.point);
                let mirrored = self.shading.mirrored(at, self.face, self.light, &mut hint);
                if let Some(mirrored) = mirrored.filter(|m| *m > best.mirrored) {
                    best = Peak { at, mirrored };
                    moved = true;
                }
            }
            if !moved {
                step *= 0.5;
            }
        }
        best
    }

    /// The outlines: a closed one, or the parts of it that lie in the region.
    fn outlines(&self, peak: Peak) -> Vec<Polyline> {
        let peak = self.brightest(peak);
        let brightness = self.level(peak.at);
        if brightness < FAINT {
            return Vec::new();
        }
        let points: Vec<Option<[f64; 2]>> = (0..DIRECTIONS)
            .map(|k| {
                self.edge(
                    peak.at,
                    TAU * k as f64 / DIRECTIONS as f64,
                    0.5 * brightness,
                )
            })
            .collect();
        let depth = self.shading.distance(&self.seen.point);
        let mut lines = Vec::new();
        let mut run = Polyline::default();
        let whole = points.iter().all(Option::is_some);
        // Starts at a gap, so that no run is cut at the start.
        let start = points.iter().position(Option::is_none).unwrap_or(0);
        for k in 0..DIRECTIONS + usize::from(whole) {
            let i = (start + k) % DIRECTIONS;
            match points[i] {
                Some(p) => run.add(TAU * (start + k) as f64 / DIRECTIONS as f64, p, depth),
                None => lines.push(std::mem::take(&mut run)),
            }
        }
        lines.push(run);
        lines.retain(|line| line.points.len() > 2);
        lines
    }

    /// The point where the level falls below `least` in a direction, if it is in the region.
    fn edge(&self, from: [f64; 2], angle: f64, least: f64) -> Option<[f64; 2]> {
        let (sin, cos) = angle.sin_cos();
        let at = |far: f64| [from[0] + far * cos, from[1] + far * sin];
        let bright = |far: f64| self.level(at(far)) >= least;
        let (mut near, mut far) = (0.0, 1.0);
        while bright(far) {
            if !self.inside(at(far)) || far > FURTHEST {
                return None;
            }
            near = far;
            far *= 1.5;
        }
        while far - near > 1.0 / 16.0 {
            let middle = 0.5 * (near + far);
            match bright(middle) {
                true => near = middle,
                false => far = middle,
            }
        }
        self.inside(at(far)).then(|| at(far))
    }
}
