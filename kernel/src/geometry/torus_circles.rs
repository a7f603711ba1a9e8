//! Intersections of a curve on a torus with the torus's own circles.
//!
//! On such a circle one angle is fixed, and F is a trigonometric polynomial of the other. Its zeros
//! are the points of all branches on the circle, and each is found on one segment. The general
//! method along the curve needs points that are themselves solved for; where the curve runs nearly
//! along the circle it needs very many.

use crate::geometry::curve::Circle;
use crate::geometry::implicit_on_curve::ImplicitOnCurve;
use crate::geometry::surface::Surface;
use crate::geometry::torus_curve::{SegmentEquation, TorusCurve, TorusCurveSegment, wrap};
use crate::geometry::torus_parameter::{TorusParameter, arrange};
use crate::geometry::trigonometric::{SimpleZero, simple_zeros};
use crate::geometry::vector::Length;
use crate::number::float::Float;

/// The ratio of a point's distance to its error above which it is certainly not on the curve.
const CLEARLY_APART: f64 = (1 << 20) as f64;

/// The fractions of a curve's length at which its other surface is tested.
const PARTS: [f64; 3] = [0.13, 0.47, 0.86];

/// The error of a curve relative to its own surface, in roundings.
const ROUNDINGS: f64 = 16.0;

/// The position of a point relative to a segment.
enum Place<N: Float> {
    /// On the segment, at this fraction of its length.
    On(N),
    NotOn,
    Unclear,
}

impl<N: Float> TorusCurve<N> {
    /// The parameters, near the curve's own, at which it crosses the circle of points with one
    /// angle fixed. `None` if the result is ambiguous: if some branch is tangent to the circle or
    /// runs along it, or next to singular points.
    pub(crate) fn across(&self, fixed: TorusParameter, angle: N, resolution: N) -> Option<Vec<N>> {
        let section = self.form.section(fixed == TorusParameter::Around, angle);
        let zeros = simple_zeros(&section.0, self.form.bound() * N::ROUNDING)?;
        let mut crossed = Vec::new();
        for SimpleZero {
            angle: other,
            error,
        } in zeros
        {
            let slack = error + resolution / self.torus.minor;
            crossed.extend(self.passes(arrange(fixed, angle, other), slack)?);
        }
        Some(crossed)
    }

    /// The crossings with a circle of another surface, where that surface intersects the torus.
    /// `None` unless the surface is, to rounding, the one whose intersection with the torus is the
    /// curve: a surface that contains the curve within the resolution only may intersect the torus
    /// elsewhere.
    pub(crate) fn across_circle(
        &self,
        circle: &Circle<N>,
        surface: &Surface<N>,
        resolution: N,
    ) -> Option<Vec<N>> {
        let holds = |part: f64| {
            let p = self.point(self.length() * N::from_f64(part));
            let size = p.coords.length() + (surface.frame().origin - p).length();
            surface.distance(&p).abs() <= N::from_f64(ROUNDINGS) * N::ROUNDING * size
        };
        if !PARTS.into_iter().all(holds) {
            return None;
        }
        let torus = Surface::Torus(self.torus);
        let ImplicitOnCurve::Circle { coefficients, slop } =
            ImplicitOnCurve::circle(circle, &torus)
        else {
            return None;
        };
        let mut crossed = Vec::new();
        for SimpleZero { angle, error } in simple_zeros(&coefficients, slop)? {
            let (sin, cos) = angle.sin_cos();
            let frame = &circle.frame;
            let p = frame.point(circle.radius * cos, circle.radius * sin, N::ZERO);
            if self.torus.sheet_level([p.x, p.y, p.z]) < N::ZERO {
                continue;
            }
            let slack = (error * circle.radius + resolution) / self.torus.minor;
            crossed.extend(self.passes(torus.parameters(&p), slack)?);
        }
        Some(crossed)
    }

    /// The parameter at which the curve passes through a point of F = 0, whose angles have the
    /// error `slack`. It does so at most once. `None` close to singular points.
    fn passes(&self, angles: [N; 2], slack: N) -> Option<Option<N>> {
        let count = self.segments.len();
        let mut passed: Option<(usize, N)> = None;
        for (i, s) in self.segments.iter().enumerate() {
            let tau = match self.place(s, angles, slack) {
                Place::On(tau) => tau,
                Place::NotOn => continue,
                Place::Unclear => return None,
            };
            match passed {
                None => passed = Some((i, tau)),
                // The end of a segment is the start of the next.
                Some((before, _)) if before + 1 == i => {}
                Some((0, _)) if self.closed && i + 1 == count => {}
                Some(_) => return None,
            }
        }
        Some(passed.map(|(i, tau)| N::whole(i as u32) + tau))
    }

    /// The position of a point of F = 0 relative to a segment.
    fn place(&self, s: &TorusCurveSegment<N>, [theta, phi]: [N; 2], slack: N) -> Place<N> {
        let slack = slack * (N::ONE + s.steep);
        let x = self.folded(s, theta, phi);
        let length = s.to - s.from;
        if matches!(s.equation, SegmentEquation::Chart(_)) {
            let [a, b] = [s.from.min(s.to), s.from.max(s.to)];
            let reach = b - a;
            return match x >= a - reach && x <= b + reach {
                true => Place::Unclear,
                false => Place::NotOn,
            };
        }
        let before = (s.from.min(s.to) - x).max(x - s.from.max(s.to));
        if before > slack {
            return Place::NotOn;
        }
        let [_, y] = arrange(s.axis, theta, phi);
        let rough = wrap(s.hermite(x) - y).abs();
        if rough > N::TWO * s.steep.max(N::ONE) * length.abs() + N::from_f64(CLEARLY_APART) * slack
        {
            return Place::NotOn;
        }
        let tau = ((x - s.from) / length).clamp(N::ZERO, N::ONE);
        let [a, b] = self.angles_on(s, tau);
        let away = wrap(theta - a).hypot(wrap(phi - b));
        if away <= slack {
            Place::On(tau)
        } else if away > N::from_f64(CLEARLY_APART) * slack {
            Place::NotOn
        } else {
            Place::Unclear
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::bivariate_trig_poly::BivariateTrigPoly;
    use crate::geometry::frame::Frame;
    use crate::geometry::surface::{Cylinder, Torus};
    use crate::geometry::trace::trace;
    use nalgebra::{Point3, Vector3};

    /// The branches in which a torus intersects a tilted cylinder offset its axis.
    fn branches(minor: f64, offset: f64, radius: f64) -> Vec<TorusCurve> {
        let torus = Torus {
            frame: Frame::world(),
            major: 2.0,
            minor,
        };
        let axis = Vector3::new(0.1, 0.2, 1.0).normalize();
        let frame = Frame::about(Point3::new(offset, 0.1, 0.0), axis);
        let other = Surface::Cylinder(Cylinder { frame, radius });
        let form = BivariateTrigPoly::interpolate(|theta, phi| {
            let p = Surface::Torus(torus).point(theta, phi);
            other.level([p.x, p.y, p.z])
        });
        trace(&torus, &form, 1e-11, &|_| true).unwrap().branches
    }

    /// The number of times that one angle crosses a value along a curve.
    fn changes(curve: &TorusCurve, which: usize, value: f64) -> usize {
        let count = 200 * curve.segments.len();
        let sides = (0..=count).map(|k| {
            let t = curve.length() * (k as f64 / count as f64);
            wrap(curve.angles(t)[which].v - value)
        });
        let sides: Vec<f64> = sides.collect();
        let crosses = |pair: &[f64]| pair[0] * pair[1] < 0.0 && (pair[0] - pair[1]).abs() < 1.0;
        sides.windows(2).filter(|pair| crosses(pair)).count()
    }

    #[test]
    fn circles_are_crossed_where_the_angle_changes_side() {
        let mut crossed = 0;
        for (minor, offset, radius) in [(0.5, 0.3, 2.1), (1.2, 1.5, 0.8), (0.7, 1.9, 1.1)] {
            for curve in branches(minor, offset, radius) {
                for k in 0..24 {
                    let angle = 0.05 + 0.26 * f64::from(k);
                    for (which, fixed) in [(0, TorusParameter::Around), (1, TorusParameter::Tube)] {
                        let found = curve.across(fixed, angle, 1e-11).unwrap();
                        assert_eq!(
                            found.len(),
                            changes(&curve, which, angle),
                            "{fixed:?} {angle}"
                        );
                        for t in &found {
                            let away = wrap(curve.angles(*t)[which].v - angle);
                            assert!(away.abs() < 1e-10, "{fixed:?} {angle} at {t}: {away:e}");
                        }
                        crossed += found.len();
                    }
                }
            }
        }
        assert!(crossed > 100, "{crossed}");
    }

    #[test]
    fn circles_of_the_other_surface_are_crossed_where_their_planes_are() {
        let axis = Vector3::new(0.1, 0.2, 1.0).normalize();
        let frame = Frame::about(Point3::new(0.3, 0.1, 0.0), axis);
        let radius = 2.1;
        let other = Surface::Cylinder(Cylinder { frame, radius });
        let adjacent = Surface::Cylinder(Cylinder {
            frame,
            radius: radius + 1e-9,
        });
        let mut crossed = 0;
        for curve in branches(0.5, 0.3, radius) {
            for k in 0..20 {
                let up = -0.55 + 0.055 * f64::from(k);
                let frame = frame.at(frame.origin + frame.z * up);
                let circle = Circle { frame, radius };
                let found = curve.across_circle(&circle, &other, 1e-11).unwrap();
                let count = 200 * curve.segments.len();
                let above = |k: usize| {
                    let p = curve.point(curve.length() * (k as f64 / count as f64));
                    frame.coordinates(&p).z > 0.0
                };
                let changes = (0..count).filter(|&k| above(k) != above(k + 1)).count();
                assert_eq!(found.len(), changes, "{up}");
                for t in &found {
                    let away = frame.coordinates(&curve.point(*t)).z;
                    assert!(away.abs() < 1e-10, "{up} at {t}: {away:e}");
                }
                crossed += found.len();
                assert!(curve.across_circle(&circle, &adjacent, 1e-11).is_none());
            }
        }
        assert!(crossed > 20, "{crossed}");
    }

    #[test]
    fn a_circle_that_is_touched_is_not_plainly_crossed() {
        // The maximum of the angle about the axis along a small oval.
        let curve = branches(0.5, 2.0, 0.3).remove(0);
        let count = 4000 * curve.segments.len();
        let at = |k: usize| wrap(curve.angles(curve.length() * (k as f64 / count as f64))[0].v);
        let most = (0..count).map(at).fold(f64::NEG_INFINITY, f64::max);
        let none = curve
            .across(TorusParameter::Around, most + 1e-3, 1e-11)
            .unwrap();
        assert!(none.is_empty());
        let two = curve
            .across(TorusParameter::Around, most - 1e-3, 1e-11)
            .unwrap();
        assert_eq!(two.len(), 2);
    }
}
