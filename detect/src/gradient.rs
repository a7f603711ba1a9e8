//! Gradients by masks (Haralick & Shapiro ch. 7).

use super::grey::Grey;
use super::parameters::Mask;
use super::pixel_mask::PixelMask;
use std::ops::Range;

/// The relative tolerance of equal magnitudes: rounding of equal ones must not open an edge.
pub(super) const ROUNDING: f32 = 32.0 * f32::EPSILON;

/// The gradient of an image on a domain; outside of it the values are undefined.
#[derive(Clone, Debug, Default)]
pub(super) struct Gradient {
    pub width: usize,
    /// In levels per pixel, along the rows.
    pub x: Vec<f32>,
    /// In levels per pixel, down the columns.
    pub y: Vec<f32>,
    /// The magnitude; zero where the gradient is NaN.
    pub size: Vec<f32>,
    /// The image smoothed along rows, for separable masks.
    smooth: Vec<f32>,
    /// The derivative along rows, for separable masks.
    slope: Vec<f32>,
}

impl Gradient {
    pub fn resize(&mut self, width: usize, height: usize) {
        self.width = width;
        for values in [&mut self.x, &mut self.y, &mut self.size] {
            values.resize(width * height, 0.0);
        }
    }

    /// Finds the gradient on `inner`, which is `domain` eroded by the radius of the mask.
    pub fn find(&mut self, mask: Mask, grey: &Grey, domain: &PixelMask, inner: &PixelMask) {
        match mask {
            Mask::Roberts => self.by_diagonals(grey, inner),
            Mask::Prewitt => self.by_differences(grey, inner, 1.0),
            Mask::Sobel => self.by_differences(grey, inner, 2.0),
            Mask::Gaussian { .. } => self.by_gaussian(&Taps::new(mask), grey, domain, inner),
        }
        for run in runs(inner, self.width) {
            let (x, y) = (&mut self.x[run.clone()], &mut self.y[run.clone()]);
            for ((x, y), size) in x.iter_mut().zip(y).zip(&mut self.size[run]) {
                let length = (*x * *x + *y * *y).sqrt();
                let known = length.is_finite();
                *x = if known { *x } else { 0.0 };
                *y = if known { *y } else { 0.0 };
                *size = if known { length } else { 0.0 };
            }
        }
    }

    /// Differences of three neighbours, the middle one with its own weight: Prewitt and Sobel.
    fn by_differences(&mut self, grey: &Grey, inner: &PixelMask, weight: f32) {
        let scale = 1.0 / (2.0 * (2.0 + weight));
        for run in runs(inner, self.width) {
            let n = run.len();
            let row = |start: usize| &grey.levels[start - 1..][..n + 2];
            let a = row(run.start - self.width);
            let b = row(run.start);
            let c = row(run.start + self.width);
            let (gx, gy) = (&mut self.x[run.clone()], &mut self.y[run]);
            for i in 0..n {
                let across = (a[i + 2] - a[i]) + (c[i + 2] - c[i]);
                gx[i] = scale * (across + weight * (b[i + 2] - b[i]));
                let down = (c[i] - a[i]) + (c[i + 2] - a[i + 2]);
                gy[i] = scale * (down + weight * (c[i + 1] - a[i + 1]));
            }
        }
    }

    /// Differences along the diagonals of two by two pixels, rotated to the image axes: Roberts.
    fn by_diagonals(&mut self, grey: &Grey, inner: &PixelMask) {
        for run in runs(inner, self.width) {
            let n = run.len();
            let a = &grey.levels[run.start..][..n + 1];
            let b = &grey.levels[run.start + self.width..][..n + 1];
            let (gx, gy) = (&mut self.x[run.clone()], &mut self.y[run]);
            for i in 0..n {
                let (falling, rising) = (b[i + 1] - a[i], a[i + 1] - b[i]);
                gx[i] = 0.5 * (falling + rising);
                gy[i] = 0.5 * (falling - rising);
            }
        }
    }

    /// Derivatives of a Gaussian, along the rows first and then down the columns.
    fn by_gaussian(&mut self, taps: &Taps, grey: &Grey, domain: &PixelMask, inner: &PixelMask) {
        self.smooth.resize(grey.levels.len(), 0.0);
        self.slope.resize(grey.levels.len(), 0.0);
        let (width, radius) = (self.width, taps.radius());
        for run in runs(domain, width).filter(|run| run.len() > 2 * radius) {
            let run = run.start + radius..run.end - radius;
            taps.smooth(&grey.levels, &mut self.smooth, &run, 1);
            taps.derive(&grey.levels, &mut self.slope, &run, 1);
        }
        for run in runs(inner, width) {
            taps.smooth(&self.slope, &mut self.x, &run, width);
            taps.derive(&self.smooth, &mut self.y, &run, width);
        }
    }
}

/// The known runs of rows as index ranges of the image.
pub(super) fn runs(domain: &PixelMask, width: usize) -> impl Iterator<Item = Range<usize>> {
    (0..domain.height()).flat_map(move |y| {
        let spans = domain.spans(y).iter();
        spans.map(move |r| y * width + r.start as usize..y * width + r.end as usize)
    })
}

/// The weights of a Gaussian and of its derivative, from the middle outwards.
struct Taps {
    weights: Vec<f32>,
    slopes: Vec<f32>,
}

impl Taps {
    fn new(mask: Mask) -> Self {
        let Mask::Gaussian { sigma } = mask else {
            return Self {
                weights: vec![1.0],
                slopes: vec![0.0],
            };
        };
        let sigma = Mask::usable(sigma);
        let bell = |k: usize| (-0.5 * (k as f64 / sigma).powi(2)).exp();
        let bells: Vec<f64> = (0..=mask.radius()).map(bell).collect();
        let total = 2.0 * bells.iter().sum::<f64>() - bells[0];
        // A ramp of one level per pixel has the slope one.
        let ramp = |(k, b): (usize, &f64)| 2.0 * (k * k) as f64 * b;
        let moment: f64 = bells.iter().enumerate().map(ramp).sum();
        let slope = |(k, b): (usize, &f64)| (k as f64 * b / moment) as f32;
        Self {
            weights: bells.iter().map(|b| (b / total) as f32).collect(),
            slopes: bells.iter().enumerate().map(slope).collect(),
        }
    }

    fn radius(&self) -> usize {
        self.weights.len() - 1
    }

    /// Smooths along a run, over pixels at a distance of `step` in the image array.
    fn smooth(&self, from: &[f32], to: &mut [f32], run: &Range<usize>, step: usize) {
        let to = &mut to[run.clone()];
        for (to, from) in to.iter_mut().zip(&from[run.clone()]) {
            *to = self.weights[0] * from;
        }
        for (k, weight) in self.weights.iter().enumerate().skip(1) {
            let before = &from[run.start - k * step..];
            let after = &from[run.start + k * step..];
            for ((to, before), after) in to.iter_mut().zip(before).zip(after) {
                *to += weight * (after + before);
            }
        }
    }

    /// Differentiates along a run, over pixels at a distance of `step` in the image array.
    fn derive(&self, from: &[f32], to: &mut [f32], run: &Range<usize>, step: usize) {
        let to = &mut to[run.clone()];
        to.fill(0.0);
        for (k, slope) in self.slopes.iter().enumerate().skip(1) {
            let before = &from[run.start - k * step..];
            let after = &from[run.start + k * step..];
            for ((to, before), after) in to.iter_mut().zip(before).zip(after) {
                *to += slope * (after - before);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MASKS: [Mask; 5] = [
        Mask::Roberts,
        Mask::Prewitt,
        Mask::Sobel,
        Mask::Gaussian { sigma: 1.0 },
        Mask::Gaussian { sigma: 2.3 },
    ];

    fn gradient(mask: Mask, grey: &Grey) -> (Gradient, PixelMask) {
        let mut gradient = Gradient::default();
        gradient.resize(grey.width, grey.height);
        let domain = PixelMask::full(grey.width, grey.height);
        let inner = domain.eroded(mask.radius());
        gradient.find(mask, grey, &domain, &inner);
        (gradient, inner)
    }

    #[test]
    fn a_ramp_has_its_slope() {
        let ramp = Grey::new(30, 25, |x, y| 3.0 * x as f32 - 2.0 * y as f32);
        for mask in MASKS {
            let (gradient, inner) = gradient(mask, &ramp);
            assert!(inner.len() > 30);
            for i in runs(&inner, 30).flatten() {
                assert!((gradient.x[i] - 3.0).abs() < 1e-4, "{mask:?}");
                assert!((gradient.y[i] + 2.0).abs() < 1e-4, "{mask:?}");
                assert!((gradient.size[i] - 13_f32.sqrt()).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn a_step_is_steepest_beside_it() {
        let step = Grey::new(30, 25, |x, _| if x < 15 { 0.0 } else { 8.0 });
        for mask in MASKS {
            let (gradient, _) = gradient(mask, &step);
            let row = &gradient.x[12 * 30..13 * 30];
            let top = row[8..22].iter().copied().fold(0.0, f32::max);
            assert_eq!(row[14], top, "{mask:?}");
            // Two neighbours share the step, except for the mask between pixels.
            let shared = mask == Mask::Roberts || row[15] == top;
            assert!(shared, "{mask:?}");
            assert!(gradient.y[12 * 30 + 14].abs() < 1e-5);
        }
    }

    #[test]
    fn what_is_no_number_has_no_gradient() {
        for bad in [f32::NAN, f32::INFINITY, f32::MAX] {
            let spoilt = Grey::new(9, 9, |x, y| if (x, y) == (4, 4) { bad } else { 1.0 });
            for mask in MASKS {
                let (gradient, inner) = gradient(mask, &spoilt);
                for i in runs(&inner, 9).flatten() {
                    assert!(gradient.size[i].is_finite() && gradient.x[i].is_finite());
                }
            }
        }
    }
}
