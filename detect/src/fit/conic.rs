//! Least-squares fit of an ellipse.

use nalgebra::{Cholesky, Matrix2, Matrix3, SymmetricEigen, Vector2};

/// A fitted ellipse.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EllipseFit {
    /// a, b, c, d, e, f of a x² + b x y + c y² + d x + e y + f = 0, the largest being 1.
    pub conic: [f64; 6],
    /// The centre.
    pub centre: [f64; 2],
    /// The half axes as vectors from the centre, in pixels, the longer one first.
    pub axes: [[f64; 2]; 2],
    /// The root mean square distance of the points, to first order, in pixels.
    pub rms: f64,
}

/// The fewest points: an ellipse has five parameters.
const FEWEST: usize = 5;

/// The relative ridge added to the scatter of the points, so that points exactly on an ellipse have
/// a solution.
const RIDGE: f64 = 64.0 * f64::EPSILON;

/// Fits an ellipse to points: the direct fit under the constraint 4 a c - b² = 1 (Fitzgibbon, Pilu
/// & Fisher 1999), split into quadratic and linear parts (Halíř & Flusser 1998), in coordinates
/// centred and scaled to the points (Hartley 1997). A second fit weights each point by the slope of
/// the first fit there, so that it minimises distances and not values (Sampson 1982; Haralick &
/// Shapiro ch. 11). None for too few points and for collinear ones.
pub fn ellipse(points: &[[f64; 2]]) -> Option<EllipseFit> {
    if points.len() < FEWEST {
        return None;
    }
    let frame = Frame::new(points)?;
    let first = direct(points.iter().map(|&p| WeightedPoint {
        point: frame.inward(p),
        weight: 1.0,
    }))?;
    let weighed = points.iter().map(|&p| {
        let q = frame.inward(p);
        let [gx, gy] = slope(&first, q);
        let square = gx * gx + gy * gy;
        WeightedPoint {
            point: q,
            weight: if square > 0.0 { 1.0 / square } else { 0.0 },
        }
    });
    let conic = frame.outward(&direct(weighed).unwrap_or(first));
    let EllipseShape { centre, axes } = shape(&conic)?;
    let square = |&p: &[f64; 2]| distance_to_conic(&conic, p).powi(2);
    let rms = (points.iter().map(square).sum::<f64>() / points.len() as f64).sqrt();
    rms.is_finite().then_some(EllipseFit {
        conic,
        centre,
        axes,
        rms,
    })
}

/// The distance of a point from a conic, to first order (Sampson 1982).
pub fn distance_to_conic(conic: &[f64; 6], p: [f64; 2]) -> f64 {
    let [gx, gy] = slope(conic, p);
    let steep = (gx * gx + gy * gy).sqrt();
    if steep > 0.0 {
        value(conic, p).abs() / steep
    } else {
        f64::INFINITY
    }
}

/// The foot of a nearby point on a conic, by a few gradient steps.
pub fn foot_on_conic(conic: &[f64; 6], p: [f64; 2]) -> [f64; 2] {
    let mut foot = p;
    for _ in 0..3 {
        let g = slope(conic, foot);
        let square = g[0] * g[0] + g[1] * g[1];
        if square > 0.0 {
            let step = value(conic, foot) / square;
            foot = [0, 1].map(|i| foot[i] - step * g[i]);
        }
    }
    if foot.iter().all(|x| x.is_finite()) {
        foot
    } else {
        p
    }
}

fn value([a, b, c, d, e, f]: &[f64; 6], [x, y]: [f64; 2]) -> f64 {
    (a * x + b * y + d) * x + (c * y + e) * y + f
}

/// The gradient of the polynomial.
pub(super) fn slope([a, b, c, d, e, _]: &[f64; 6], [x, y]: [f64; 2]) -> [f64; 2] {
    [2.0 * a * x + b * y + d, b * x + 2.0 * c * y + e]
}

/// Normalised coordinates: centred at the mean of points and scaled to a mean distance of about
/// one.
struct Frame {
    centre: [f64; 2],
    size: f64,
}

impl Frame {
    fn new(points: &[[f64; 2]]) -> Option<Self> {
        let n = points.len() as f64;
        let centre = [0, 1].map(|i| points.iter().map(|p| p[i]).sum::<f64>() / n);
        let square = |p: &[f64; 2]| (p[0] - centre[0]).powi(2) + (p[1] - centre[1]).powi(2);
        let size = (points.iter().map(square).sum::<f64>() / n).sqrt();
        (size.is_finite() && size > 0.0).then_some(Self { centre, size })
    }

    fn inward(&self, p: [f64; 2]) -> [f64; 2] {
        [0, 1].map(|i| (p[i] - self.centre[i]) / self.size)
    }

    /// The conic in the coordinates of the image.
    fn outward(&self, &[a, b, c, d, e, f]: &[f64; 6]) -> [f64; 6] {
        let ([x, y], s) = (self.centre, self.size);
        let (d, e) = (d * s, e * s);
        let conic = [
            a,
            b,
            c,
            d - 2.0 * a * x - b * y,
            e - 2.0 * c * y - b * x,
            (a * x + b * y - d) * x + (c * y - e) * y + f * s * s,
        ];
        let largest = conic
            .iter()
            .fold(0.0_f64, |l, k| if k.abs() > l.abs() { *k } else { l });
        conic.map(|k| k / largest)
    }
}

/// A point with its weight in a fit.
struct WeightedPoint {
    point: [f64; 2],
    weight: f64,
}

/// The weighted sums of x^i y^j: the fourth order, the third and so on, each by falling i.
fn moments(points: impl Iterator<Item = WeightedPoint>) -> [f64; 15] {
    let mut sums = [0.0; 15];
    for WeightedPoint {
        point: [x, y],
        weight,
    } in points
    {
        let [xx, xy, yy] = [x * x, x * y, y * y];
        let powers = [
            [xx * xx, xx * xy, xx * yy, xy * yy, yy * yy],
            [xx * x, xx * y, x * yy, yy * y, xx],
            [xy, yy, x, y, 1.0],
        ];
        for (sum, power) in sums.iter_mut().zip(powers.as_flattened()) {
            *sum += weight * power;
        }
    }
    sums
}

/// The direct fit to weighted points.
fn direct(points: impl Iterator<Item = WeightedPoint>) -> Option<[f64; 6]> {
    let [
        x4,
        x3y,
        x2y2,
        xy3,
        y4,
        x3,
        x2y,
        xy2,
        y3,
        xx,
        xy,
        yy,
        x,
        y,
        n,
    ] = moments(points);
    let quadratic = Matrix3::new(x4, x3y, x2y2, x3y, x2y2, xy3, x2y2, xy3, y4);
    let mixed = Matrix3::new(x3, x2y, xx, x2y, xy2, xy, xy2, y3, yy);
    let linear = Matrix3::new(xx, xy, x, xy, yy, y, x, y, n);
    let rest = -linear.try_inverse()? * mixed.transpose();
    let reduced = quadratic + mixed * rest;
    let reduced = 0.5 * (reduced + reduced.transpose());
    let ridge = RIDGE * quadratic.trace();
    let root = Cholesky::new(reduced + ridge * Matrix3::identity())?.l();
    let back = root.try_inverse()?;
    // 4 a c - b² as a form; its one positive value in the coordinates of the root is the ellipse.
    let form = Matrix3::new(0.0, 0.0, 2.0, 0.0, -1.0, 0.0, 2.0, 0.0, 0.0);
    let turned = back * form * back.transpose();
    let eigen = SymmetricEigen::new(0.5 * (turned + turned.transpose()));
    let (best, value) = eigen.eigenvalues.argmax();
    if !(value.is_finite() && value > 0.0) {
        return None;
    }
    let a = back.transpose() * eigen.eigenvectors.column(best);
    let b = rest * a;
    let conic = [a[0], a[1], a[2], b[0], b[1], b[2]];
    conic.iter().all(|k| k.is_finite()).then_some(conic)
}

/// The centre and the half axes of an ellipse.
struct EllipseShape {
    centre: [f64; 2],
    axes: [[f64; 2]; 2],
}

/// The shape of an ellipse; none for another conic.
fn shape(&[a, b, c, d, e, f]: &[f64; 6]) -> Option<EllipseShape> {
    let form = Matrix2::new(a, 0.5 * b, 0.5 * b, c);
    let centre = form.try_inverse()? * Vector2::new(-0.5 * d, -0.5 * e);
    let centre = [centre[0], centre[1]];
    let middle = value(&[a, b, c, d, e, f], centre);
    let eigen = SymmetricEigen::new(form);
    let mut axes = [0, 1].map(|i| {
        let square = -middle / eigen.eigenvalues[i];
        let along = eigen.eigenvectors.column(i);
        (square.sqrt(), [along[0], along[1]])
    });
    if axes[0].0 < axes[1].0 {
        axes.swap(0, 1);
    }
    let real = axes
        .iter()
        .all(|(length, _)| length.is_finite() && *length > 0.0);
    let axes = axes.map(|(length, along)| along.map(|x| length * x));
    real.then_some(EllipseShape { centre, axes })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// Points of an ellipse with half axes 30 and 12, from one angle to another.
    fn points(turn: f64, from: f64, to: f64) -> Vec<[f64; 2]> {
        let (sin, cos) = turn.sin_cos();
        let angle = |i: i32| from + (to - from) * f64::from(i) / 40.0;
        let place = |t: f64| [30.0 * t.cos(), 12.0 * t.sin()];
        (0..40)
            .map(|i| place(angle(i)))
            .map(|[x, y]| [320.0 + cos * x - sin * y, 210.0 + sin * x + cos * y])
            .collect()
    }

    #[test]
    fn an_ellipse_is_its_own() {
        for (turn, to) in [(0.0, 6.2), (0.7, 6.2), (2.0, 3.0), (1.2, 1.5)] {
            let fit = ellipse(&points(turn, 0.0, to)).unwrap();
            assert!(fit.rms < 1e-6, "{fit:?}");
            assert_relative_eq!(fit.centre[0], 320.0, epsilon = 1e-3);
            assert_relative_eq!(fit.centre[1], 210.0, epsilon = 1e-3);
            let lengths = fit.axes.map(|[x, y]| x.hypot(y));
            assert_relative_eq!(lengths[0], 30.0, epsilon = 1e-3);
            assert_relative_eq!(lengths[1], 12.0, epsilon = 1e-3);
            let largest = fit.conic.iter().fold(0.0, |l: f64, k| l.max(*k));
            assert_eq!(largest, 1.0);
            let off = foot_on_conic(
                &fit.conic,
                [320.0 + 31.0 * turn.cos(), 210.0 + 31.0 * turn.sin()],
            );
            assert_relative_eq!(off[0], 320.0 + 30.0 * turn.cos(), epsilon = 1e-3);
        }
    }

    #[test]
    fn some_points_have_no_ellipse() {
        assert!(ellipse(&[[0.0, 1.0]; 9]).is_none());
        assert!(ellipse(&points(0.0, 0.0, 6.0)[..4]).is_none());
        assert!(ellipse(&[[f64::NAN; 2]; 9]).is_none());
        // On a line: none, or one that is indistinguishable from it.
        let line: Vec<[f64; 2]> = (0..20)
            .map(|i| [f64::from(i), 2.0 * f64::from(i)])
            .collect();
        assert!(ellipse(&line).is_none_or(|fit| fit.rms < 1e-3));
    }
}
