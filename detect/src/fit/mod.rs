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

/// The ellipse fitted to points, or their line where there is none; none for fewer than two points.
pub fn conic_or_line(points: &[[f64; 2]]) -> Option<Fit> {
    let conic = ellipse(points).map(Fit::Ellipse);
    conic.or_else(|| line(points).map(Fit::Line))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_what_has_no_ellipse() {
        let points = [[0.0, 0.0], [3.0, 1.0], [6.0, 2.0]];
        let fit = conic_or_line(&points).unwrap();
        assert!(matches!(fit, Fit::Line(_)) && fit.rms() < 1e-12);
        assert!(conic_or_line(&points[..1]).is_none());
        let circle: Vec<[f64; 2]> = (0..12)
            .map(|i| f64::from(i) / 2.0)
            .map(|t| [50.0 + 9.0 * t.cos(), 20.0 + 9.0 * t.sin()])
            .collect();
        let fit = conic_or_line(&circle).unwrap();
        assert!(matches!(fit, Fit::Ellipse(_)) && fit.rms() < 1e-9);
        assert!((fit.distance([60.0, 20.0]) - 1.0).abs() < 0.1);
        assert!((fit.foot([60.0, 20.0])[0] - 59.0).abs() < 1e-6);
    }
}
