//! The volume by ray casting: the mean length of material on parallel lines.

use super::shape::clip;
use super::{Ray, RayOracle};
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::random::Random;
use std::f64::consts::{PI, SQRT_2};

/// A measured value with its standard error.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Estimate {
    /// The value.
    pub value: f64,
    /// Its standard error.
    pub standard_error: f64,
}

impl Estimate {
    /// The deviation of a value in standard errors; zero if it is within `rounding`.
    pub fn deviation(&self, value: f64, rounding: f64) -> f64 {
        let off = (value - self.value).abs();
        if off <= rounding {
            return 0.0;
        }
        off / self.standard_error
    }
}

/// The number of independent grids among which the rays are divided; their scatter gives the error.
const GRIDS: usize = 32;

/// Powers of the plastic number, the steps of Roberts's sequence in the unit square.
const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_2];

impl RayOracle {
    /// The volume by about `rays` rays in a direction of general position. The rays form
    /// low-discrepancy grids at random offsets, which `seed` determines.
    pub fn volume(&self, rays: usize, seed: u64) -> Estimate {
        let length = |_: &Ray, [lo, hi]: [f64; 2]| hi - lo;
        self.measured(&self.bounds, length, rays, seed)
    }

    /// The volume, with half of the rays for the part inside a box. Otherwise a small part of a
    /// large tree is missed.
    pub fn volume_about(&self, part: &Aabb, rays: usize, seed: u64) -> Estimate {
        let within = |ray: &Ray, span: [f64; 2]| {
            let mut inside = span;
            let hits = (0..3).all(|i| {
                let (from, along) = (ray.origin[i], ray.direction[i]);
                clip(&mut inside, part.min[i] - from, -along)
                    && clip(&mut inside, from - part.max[i], along)
            });
            if hits { inside[1] - inside[0] } else { 0.0 }
        };
        let beyond = |ray: &Ray, span: [f64; 2]| span[1] - span[0] - within(ray, span);
        let near = self.measured(part, within, rays, seed);
        let far = self.measured(&self.bounds, beyond, rays, seed);
        Estimate {
            value: near.value + far.value,
            standard_error: near.standard_error.hypot(far.standard_error),
        }
    }

    /// The integral, over rays through a box, of a function of each interval of material.
    fn measured(
        &self,
        bounds: &Aabb,
        length: impl Fn(&Ray, [f64; 2]) -> f64,
        rays: usize,
        seed: u64,
    ) -> Estimate {
        if bounds.min[0] > bounds.max[0] {
            return Estimate::default();
        }
        let window = Window::around(bounds);
        let mut scratch = self.scratch();
        let each = (rays / GRIDS).max(1);
        let mut random = Random::new(seed);
        let mut means = [0.0; GRIDS];
        for mean in &mut means {
            let shift = [random.uniform(), random.uniform()];
            let mut sum = 0.0;
            for k in 0..each {
                let at = |i: usize| (shift[i] + k as f64 * STEPS[i]).fract();
                let ray = window.ray(at(0), at(1));
                self.cross(&ray, &mut scratch, |span| sum += length(&ray, span));
            }
            *mean = sum / each as f64 * window.area();
        }
        let n = GRIDS as f64;
        let value = means.iter().sum::<f64>() / n;
        let scatter: f64 = means.iter().map(|m| (m - value).powi(2)).sum();
        Estimate {
            value,
            standard_error: (scatter / (n * (n - 1.0))).sqrt(),
        }
    }
}

impl RayOracle {
    /// The box around all points where about `rays` parallel rays enter or leave material. It is
    /// never larger than the part's own box. Intervals of length up to `least` are ignored: they
    /// are rounding where faces of primitives coincide.
    pub fn extent(&self, rays: usize, least: f64) -> Aabb {
        let mut extent = Aabb::EMPTY;
        if self.bounds.min[0] > self.bounds.max[0] {
            return extent;
        }
        let window = Window::around(&self.bounds);
        let mut scratch = self.scratch();
        for k in 0..rays {
            let [u, v] = STEPS.map(|step| ((k as f64 + 0.5) * step).fract());
            let ray = window.ray(u, v);
            self.cross(&ray, &mut scratch, |span| {
                for at in span.into_iter().filter(|_| span[1] - span[0] > least) {
                    extent = extent.hull(&Aabb::new(&(ray.origin + ray.direction * at)));
                }
            });
        }
        extent
    }
}

/// A rectangle perpendicular to the direction of the rays that covers a box.
struct Window {
    frame: Frame,
    min: [f64; 2],
    size: [f64; 2],
}

impl Window {
    fn around(bounds: &Aabb) -> Self {
        // No rotation by a whole number of degrees maps an axis to this direction.
        let direction = Vector3::new(1.0, SQRT_2, PI).normalize();
        let frame = Frame::about(bounds.centre(), direction);
        let half = Vector3::from_fn(|i, _| 0.5 * (bounds.max[i] - bounds.min[i]));
        let reach = [frame.x, frame.y].map(|axis| axis.abs().dot(&half));
        Self {
            frame,
            min: reach.map(|r| -r),
            size: reach.map(|r| 2.0 * r),
        }
    }

    fn area(&self) -> f64 {
        self.size[0] * self.size[1]
    }

    fn ray(&self, u: f64, v: f64) -> Ray {
        let origin: Point3<f64> = self.frame.point(
            self.min[0] + u * self.size[0],
            self.min[1] + v * self.size[1],
            0.0,
        );
        Ray {
            origin,
            direction: self.frame.z,
        }
    }
}
