//! Total least-squares fit of a line.

/// A fitted line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineFit {
    /// The mean of the points, through which the line goes.
    pub centre: [f64; 2],
    /// Its direction, of length one, from the first towards the last point.
    pub direction: [f64; 2],
    /// The root mean square distance of the points, in pixels.
    pub rms: f64,
}

/// Fits the line with the least sum of squared perpendicular distances: the main axis of the
/// scatter of the points (Haralick & Shapiro ch. 11). None for fewer than two points, for points
/// that coincide and for those with NaN.
pub fn line(points: &[[f64; 2]]) -> Option<LineFit> {
    let (first, last) = (points.first()?, points.last()?);
    let n = points.len() as f64;
    let centre = [0, 1].map(|i| points.iter().map(|p| p[i]).sum::<f64>() / n);
    let [mut xx, mut xy, mut yy] = [0.0; 3];
    for p in points {
        let [x, y] = [p[0] - centre[0], p[1] - centre[1]];
        (xx, xy, yy) = (xx + x * x, xy + x * y, yy + y * y);
    }
    let spread = xx + yy;
    if !(spread.is_finite() && spread > 0.0) {
        return None;
    }
    let (sin, cos) = (0.5 * (2.0 * xy).atan2(xx - yy)).sin_cos();
    let forward = cos * (last[0] - first[0]) + sin * (last[1] - first[1]) >= 0.0;
    let fit = LineFit {
        centre,
        direction: if forward { [cos, sin] } else { [-cos, -sin] },
        rms: 0.0,
    };
    let squares: f64 = points.iter().map(|&p| fit.distance(p).powi(2)).sum();
    Some(LineFit {
        rms: (squares / n).sqrt(),
        ..fit
    })
}

impl LineFit {
    /// The distance of a point from the line, in pixels.
    pub fn distance(&self, p: [f64; 2]) -> f64 {
        let [x, y] = [p[0] - self.centre[0], p[1] - self.centre[1]];
        (self.direction[0] * y - self.direction[1] * x).abs()
    }

    /// The foot of a point on the line.
    pub fn foot(&self, p: [f64; 2]) -> [f64; 2] {
        let [x, y] = [p[0] - self.centre[0], p[1] - self.centre[1]];
        let along = self.direction[0] * x + self.direction[1] * y;
        [0, 1].map(|i| self.centre[i] + along * self.direction[i])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_line_is_its_own() {
        let points: Vec<[f64; 2]> = (0..9)
            .map(|i| [100.0 - 3.0 * f64::from(i), 7.0 + 4.0 * f64::from(i)])
            .collect();
        let fit = line(&points).unwrap();
        assert_relative_eq!(fit.direction[0], -0.6, epsilon = 1e-12);
        assert_relative_eq!(fit.direction[1], 0.8, epsilon = 1e-12);
        assert!(fit.rms < 1e-12);
        assert_relative_eq!(fit.distance([100.0, 12.0]), 3.0, epsilon = 1e-12);
    }

    #[test]
    fn distances_are_across() {
        let fit = line(&[[0.0, 0.0], [1.0, 1.0], [4.0, 0.0], [3.0, 1.0]]).unwrap();
        assert_relative_eq!(fit.rms, 0.5, epsilon = 1e-12);
        assert_relative_eq!(fit.foot([2.0, 5.0])[1], 0.5, epsilon = 1e-12);
    }

    #[test]
    fn some_points_have_no_line() {
        assert!(line(&[]).is_none());
        assert!(line(&[[1.0, 2.0]; 5]).is_none());
        assert!(line(&[[1.0, 2.0], [f64::NAN, 0.0]]).is_none());
    }
}
