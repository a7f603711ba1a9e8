//! Arcs of projected curves: the points along them, and the nearest one to another point.

use nalgebra::{Point2, distance};
use rstar::{AABB, PointDistance, RTree, RTreeObject};
use std::rc::Rc;

/// A point of a projected curve, with the curve's parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// The parameter.
    pub t: f64,
    /// The image point.
    pub point: Point2<f64>,
}

/// The point of an arc that is nearest to another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// Its parameter.
    pub t: f64,
    /// Its distance.
    pub distance: f64,
}

/// The image of a parameter.
type ImageOf<'c> = Rc<dyn Fn(f64) -> Point2<f64> + 'c>;

/// The projection of an arc in space, by its parameter.
#[derive(Clone)]
pub struct ProjectedArc<'c> {
    curve: ImageOf<'c>,
    polyline: Rc<Polyline>,
}

/// Points along an arc, with an index of the sides between them.
struct Polyline {
    samples: Vec<Sample>,
    sides: RTree<Side>,
    deviation: f64,
}

/// A side of a polyline.
struct Side {
    ends: [Point2<f64>; 2],
    index: usize,
}

impl RTreeObject for Side {
    type Envelope = AABB<[f64; 2]>;

    fn envelope(&self) -> Self::Envelope {
        let [a, b] = self.ends.map(Into::into);
        AABB::from_corners(a, b)
    }
}

impl PointDistance for Side {
    fn distance_2(&self, point: &[f64; 2]) -> f64 {
        let p = Point2::from(*point);
        let [a, b] = self.ends;
        let d = b - a;
        let square = d.norm_squared();
        let t = match square > 0.0 {
            true => (p - a).dot(&d) / square,
            false => 0.0,
        };
        (a + d * t.clamp(0.0, 1.0) - p).norm_squared()
    }
}

impl<'c> ProjectedArc<'c> {
    /// The arc of a curve through two or more samples, whose polyline is within the drawing's
    /// distance.
    pub fn new(curve: ImageOf<'c>, samples: Vec<Sample>) -> Self {
        let side = |(index, pair): (usize, &[Sample])| Side {
            ends: [pair[0].point, pair[1].point],
            index,
        };
        let sides = samples.windows(2).enumerate().map(side).collect();
        let polyline = Rc::new(Polyline {
            sides: RTree::bulk_load(sides),
            deviation: deviation(&samples),
            samples,
        });
        Self { curve, polyline }
    }

    /// The points along it.
    pub fn samples(&self) -> &[Sample] {
        &self.polyline.samples
    }

    /// The range of the parameter.
    pub fn range(&self) -> [f64; 2] {
        let samples = self.samples();
        [samples[0].t, samples[samples.len() - 1].t]
    }

    /// The point with a parameter.
    pub fn point(&self, t: f64) -> Point2<f64> {
        (self.curve)(t)
    }

    /// The length of the polyline.
    pub fn length(&self) -> f64 {
        let steps = self.samples().windows(2);
        steps.map(|s| distance(&s[1].point, &s[0].point)).sum()
    }

    /// A bound of the distance between the curve and its polyline, from the angles between samples.
    pub fn deviation(&self) -> f64 {
        self.polyline.deviation
    }

    /// The distance of a point from the polyline.
    pub fn approximate_distance(&self, p: &Point2<f64>) -> f64 {
        let side = self.polyline.sides.nearest_neighbor((*p).into());
        side.map_or(f64::INFINITY, |side| side.distance_2(&(*p).into()).sqrt())
    }

    /// The point nearest to another: on the nearest side of the polyline or on one next to it.
    pub fn nearest(&self, p: &Point2<f64>) -> Nearest {
        let samples = self.samples();
        let sides = samples.len() - 1;
        let near = self.polyline.sides.nearest_neighbor((*p).into());
        let near = near.map_or(0, |side| side.index);
        let around = near.saturating_sub(1)..(near + 2).min(sides);
        let found = around.map(|i| self.nearest_between(samples[i].t, samples[i + 1].t, p));
        let nearest = found.min_by(|a, b| a.distance.total_cmp(&b.distance));
        nearest.unwrap_or_else(|| self.at(samples[0].t, p))
    }

    fn at(&self, t: f64, p: &Point2<f64>) -> Nearest {
        let distance = distance(&self.point(t), p);
        Nearest { t, distance }
    }

    /// The nearest point between two parameters, by golden sections.
    fn nearest_between(&self, mut lo: f64, mut hi: f64, p: &Point2<f64>) -> Nearest {
        let golden = 0.5 * (5.0f64.sqrt() - 1.0);
        let inner = |lo: f64, hi: f64| [hi - golden * (hi - lo), lo + golden * (hi - lo)];
        let ends = [lo, hi].map(|t| self.at(t, p));
        let mut tried = inner(lo, hi).map(|t| self.at(t, p));
        for _ in 0..GOLDEN_STEPS {
            match tried[0].distance < tried[1].distance {
                true => {
                    hi = tried[1].t;
                    tried = [self.at(inner(lo, hi)[0], p), tried[0]];
                }
                false => {
                    lo = tried[0].t;
                    tried = [tried[1], self.at(inner(lo, hi)[1], p)];
                }
            }
        }
        let all = [ends[0], tried[0], tried[1], ends[1]];
        let nearest = all
            .into_iter()
            .min_by(|a, b| a.distance.total_cmp(&b.distance));
        nearest.unwrap_or(ends[0])
    }

    /// The arc over a part of its range.
    #[must_use]
    pub fn part(&self, range: [f64; 2]) -> Self {
        Self::new(Rc::clone(&self.curve), self.samples_over(range))
    }

    /// The samples over a part of its range, with its ends.
    fn samples_over(&self, [lo, hi]: [f64; 2]) -> Vec<Sample> {
        let end = |t: f64| Sample {
            t,
            point: self.point(t),
        };
        let inner = self.samples().iter().filter(|s| lo < s.t && s.t < hi);
        let mut part = vec![end(lo)];
        part.extend(inner);
        part.push(end(hi));
        part
    }

    /// The parameters at fractions of the length between two parameters, by the polyline.
    pub fn at_lengths<const N: usize>(&self, range: [f64; 2], parts: [f64; N]) -> [f64; N] {
        let samples = self.samples_over(range);
        let mut lengths = vec![0.0];
        for side in samples.windows(2) {
            let before = lengths[lengths.len() - 1];
            lengths.push(before + distance(&side[0].point, &side[1].point));
        }
        let whole = lengths[lengths.len() - 1];
        parts.map(|part| {
            let length = whole * part;
            let side = lengths.partition_point(|l| *l <= length);
            let side = side.clamp(1, samples.len() - 1);
            let step = lengths[side] - lengths[side - 1];
            let along = match step > 0.0 {
                true => (length - lengths[side - 1]) / step,
                false => 0.5,
            };
            let [from, to] = [samples[side - 1].t, samples[side].t];
            from + (to - from) * along
        })
    }
}

/// A bound of the distance between a curve and its polyline.
fn deviation(samples: &[Sample]) -> f64 {
    // The arc over a chord is no farther from it than its ends are from each other.
    let steps = samples.windows(3).map(|s| {
        let [a, b] = [s[1].point - s[0].point, s[2].point - s[1].point];
        let turn = a.perp(&b).abs() / (a.norm() * b.norm());
        let step = a.norm().max(b.norm());
        if turn.is_finite() { turn * step } else { step }
    });
    let few = match samples {
        [a, b] => distance(&a.point, &b.point),
        _ => 0.0,
    };
    steps.fold(few, f64::max)
}

/// The number of golden-section steps: each narrows the bracket by 0.618, and after this many it is
/// as narrow as f64 can resolve a minimum.
const GOLDEN_STEPS: u32 = 44;

#[cfg(test)]
mod tests {
    use super::*;

    /// Of y = 0, x = t⁸, a fraction f of the length lies before t = f^(1/8).
    #[test]
    fn parameters_are_at_fractions_of_the_length() {
        let curve = |t: f64| Point2::new(t.powi(8), 0.0);
        let samples = (0..=1000).map(|k| f64::from(k) / 1000.0);
        let samples = samples.map(|t| Sample { t, point: curve(t) }).collect();
        let arc = ProjectedArc::new(Rc::new(curve), samples);
        let at = arc.at_lengths([0.0, 1.0], [0.1, 0.5, 1.0]);
        for (t, part) in at.into_iter().zip([0.1f64, 0.5, 1.0]) {
            assert!((t - part.powf(0.125)).abs() < 1e-5, "{t}");
        }
    }

    /// A spiral of 2,000 sides: the index finds the side that a search through all of them finds.
    #[test]
    fn the_nearest_side_is_found() {
        let spiral = |t: f64| Point2::new(t.cos(), t.sin()) * (1.0 + t / 20.0);
        let samples: Vec<Sample> = (0..=2000)
            .map(|k| f64::from(k) / 50.0)
            .map(|t| Sample {
                t,
                point: spiral(t),
            })
            .collect();
        let arc = ProjectedArc::new(Rc::new(spiral), samples.clone());
        for k in 0..500 {
            let p = spiral(f64::from(k) * 0.11) * (0.8 + 0.001 * f64::from(k));
            let sides = samples.windows(2).enumerate().map(|(index, pair)| {
                let ends = [pair[0].point, pair[1].point];
                Side { ends, index }.distance_2(&p.into()).sqrt()
            });
            let least = sides.fold(f64::INFINITY, f64::min);
            assert_eq!(arc.approximate_distance(&p), least);
            let found = arc.nearest(&p);
            assert!(found.distance <= least + arc.deviation());
            assert!((distance(&spiral(found.t), &p) - found.distance).abs() < 1e-12);
        }
    }
}
