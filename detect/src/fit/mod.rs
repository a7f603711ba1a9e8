//! Fits of lines and ellipses to points, each with its distances (Haralick & Shapiro ch. 11).

mod conic;
mod line;

pub use conic::{EllipseFit, distance_to_conic, ellipse, foot_on_conic};
pub use line::{LineFit, line};

/// A fitted curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fit {
    /// A straight line.
    Line(LineFit),
    /// An ellipse.
    Ellipse(EllipseFit),
}

impl Fit {
    /// The root mean square distance of the fitted points, in pixels.
    pub fn rms(&self) -> f64 {
        match self {
            Self::Line(fit) => fit.rms,
            Self::Ellipse(fit) => fit.rms,
        }
    }

    /// The distance of a point from the curve, in pixels.
    pub fn distance(&self, p: [f64; 2]) -> f64 {
        match self {
            Self::Line(fit) => fit.distance(p),
            Self::Ellipse(fit) => distance_to_conic(&fit.conic, p),
        }
    }

    /// The foot of a point on the curve.
    pub fn foot(&self, p: [f64; 2]) -> [f64; 2] {
        match self {
            Self::Line(fit) => fit.foot(p),
            Self::Ellipse(fit) => foot_on_conic(&fit.conic, p),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_fit_has_the_distances_of_its_curve() {
        let points = [[0.0, 0.0], [3.0, 1.0], [6.0, 2.0]];
        assert!(ellipse(&points).is_none() && line(&points[..1]).is_none());
        let fit = Fit::Line(line(&points).unwrap());
        assert!(fit.rms() < 1e-12 && fit.distance([6.0, 2.0]) < 1e-12);
        let circle: Vec<[f64; 2]> = (0..12)
            .map(|i| f64::from(i) / 2.0)
            .map(|t| [50.0 + 9.0 * t.cos(), 20.0 + 9.0 * t.sin()])
            .collect();
        let fit = Fit::Ellipse(ellipse(&circle).unwrap());
        assert!(fit.rms() < 1e-9);
        assert!((fit.distance([60.0, 20.0]) - 1.0).abs() < 0.1);
        assert!((fit.foot([60.0, 20.0])[0] - 59.0).abs() < 1e-6);
    }
}
