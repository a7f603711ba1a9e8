//! The point spread of the optics: a Gaussian, on the pixels that are known.

use premio_detect::{Grey, PixelMask};
use std::ops::Range;

/// The truncation of the point spread, in standard deviations.
const WIDE: f64 = 3.0;

/// How many pixels on each side the point spread reaches.
pub fn reach(sigma: f64) -> usize {
    (WIDE * sigma).ceil() as usize
}

/// The weights of a Gaussian from the middle outwards; all of them, on both sides, add up to one.
fn weights(sigma: f64) -> Vec<f32> {
    let half = reach(sigma);
    let value = |k: usize| (-0.5 * (k as f64 / sigma).powi(2)).exp();
    let sum = (1..=half).map(value).sum::<f64>() * 2.0 + 1.0;
    (0..=half).map(|k| (value(k) / sum) as f32).collect()
}

/// Blurs the known pixels of an image. The result is valid in the domain eroded by [`reach`].
/// Pixels beyond the image equal the nearest pixel of it.
pub fn blur(image: &mut Grey, domain: &PixelMask, sigma: f64) {
    blur_by(image, domain, sigma, &mut Vec::new());
}

/// Blurs with reused memory.
pub fn blur_by(image: &mut Grey, domain: &PixelMask, sigma: f64, across: &mut Vec<f32>) {
    if reach(sigma) == 0 {
        return;
    }
    let weights = weights(sigma);
    let (width, height) = (image.width, image.height);
    // The rows are blurred into `across`, and the columns from there.
    across.resize(image.levels.len(), 0.0);
    let wide = grown_rows(domain, reach(sigma));
    for (y, runs) in wide.iter().enumerate() {
        let row = &image.levels[y * width..(y + 1) * width];
        let out = &mut across[y * width..(y + 1) * width];
        for run in runs {
            blur_run(row, run, &weights, out);
        }
    }
    for y in 0..height {
        let row = |v: usize, run: &Range<u32>| {
            &across[v * width + run.start as usize..v * width + run.end as usize]
        };
        for run in domain.spans(y) {
            let out = &mut image.levels[y * width..(y + 1) * width];
            let out = &mut out[run.start as usize..run.end as usize];
            scale(out, row(y, run), weights[0]);
            for (k, w) in weights.iter().enumerate().skip(1) {
                let [above, below] = [y.saturating_sub(k), (y + k).min(height - 1)];
                add(out, row(above, run), row(below, run), *w);
            }
        }
    }
}

/// Blurs a run of pixels of a row along it.
fn blur_run(row: &[f32], run: &Range<u32>, weights: &[f32], out: &mut [f32]) {
    let reach = weights.len() - 1;
    let (start, end) = (run.start as usize, run.end as usize);
    // Near the ends of the row the nearest pixel replaces those beyond.
    let inner = start.max(reach)..end.min(row.len().saturating_sub(reach));
    let beside = (start..end).filter(|x| !inner.contains(x));
    for x in beside {
        let pair = |k: usize| row[x.saturating_sub(k)] + row[(x + k).min(row.len() - 1)];
        let sides = weights.iter().enumerate().skip(1);
        out[x] = sides.fold(weights[0] * row[x], |all, (k, w)| all + w * pair(k));
    }
    if inner.is_empty() {
        return;
    }
    let out = &mut out[inner.clone()];
    scale(out, &row[inner.clone()], weights[0]);
    for (k, w) in weights.iter().enumerate().skip(1) {
        let moved = |by: usize| &row[by..by + out.len()];
        let [left, right] = [moved(inner.start - k), moved(inner.start + k)];
        add(out, left, right, *w);
    }
}

fn scale(out: &mut [f32], from: &[f32], weight: f32) {
    for (o, f) in out.iter_mut().zip(from) {
        *o = weight * f;
    }
}

fn add(out: &mut [f32], a: &[f32], b: &[f32], weight: f32) {
    for (o, (a, b)) in out.iter_mut().zip(a.iter().zip(b)) {
        *o += weight * (a + b);
    }
}

/// By row: the columns of the domain within a number of rows.
fn grown_rows(domain: &PixelMask, by: usize) -> Vec<Vec<Range<u32>>> {
    let height = domain.height();
    let near = |y: usize| y.saturating_sub(by)..(y + by + 1).min(height);
    let row = |y: usize| {
        let runs = near(y).flat_map(|v| domain.spans(v).iter().cloned());
        let one = PixelMask::of_rows(domain.width(), std::iter::once(runs.collect()));
        one.spans(0).to_vec()
    };
    (0..height).map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_flat_image_stays_and_a_point_spreads() {
        let size = 21;
        let domain = PixelMask::full(size, size);
        let mut flat = Grey {
            width: size,
            height: size,
            levels: vec![7.0; size * size],
        };
        blur(&mut flat, &domain, 1.2);
        assert!(flat.levels.iter().all(|v| (v - 7.0).abs() < 1e-4));
        let mut point = flat.clone();
        point.levels.fill(0.0);
        point.levels[10 * size + 10] = 1.0;
        blur(&mut point, &domain, 1.2);
        let total: f32 = point.levels.iter().sum();
        assert!((total - 1.0).abs() < 1e-5);
        let moment: f64 = (0..size)
            .flat_map(|y| (0..size).map(move |x| (x, y)))
            .map(|(x, y)| f64::from(point.levels[y * size + x]) * (x as f64 - 10.0).powi(2))
            .sum();
        assert!((moment - 1.44).abs() < 0.06, "{moment}");
    }
}
