//! Where a curve on a torus crosses the torus's own circles.
//!
//! On a circle one angle is fixed, and F is a trigonometric polynomial of the other: its zeros are
//! the points of all branches, and each is one root of the segment that passes it. Along the curve
//! the same is asked of points that are themselves solved for, and where it runs nearly along the
//! circle, of very many.

use super::{TorusCurve, TorusCurveSegment, TorusParameter, arrange, wrap};
use crate::geometry::curve::Circle;
use crate::geometry::implicit_on_curve::ImplicitOnCurve;
use crate::geometry::surface::Surface;
use crate::geometry::trigonometric::simple_zeros;
use crate::geometry::vector::Length;
use crate::number::float::Float;

/// What lies so many times farther from a curve than it may be off is clearly next to it.
const CLEARLY_APART: f64 = (1 << 20) as f64;

/// Where on a curve, in parts of its length, its other surface is requested.
const PARTS: [f64; 3] = [0.13, 0.47, 0.86];

/// How far a curve may be off its own surface, in roundings.
const ROUNDINGS: f64 = 16.0;

/// Where a point lies with respect to a segment.
enum Place<N: Float> {
    /// On it, at this part of its length.
    On(N),
    Beside,
    Unclear,
}

impl<N: Float> TorusCurve<N> {
    /// The parameters, next to the curve's own, at which it crosses the circle of the points with
    /// one angle. None where that is not plain: where some branch touches the circle or runs along
    /// it, and next to singular points. `resolution` is the resolution.
    pub fn across(&self, fixed: TorusParameter, angle: N, resolution: N) -> Option<Vec<N>> {
        let section = self.form.section(fixed == TorusParameter::Around, angle);
        let zeros = simple_zeros(&section.0, self.form.bound() * N::ROUNDING)?;
        let mut crossed = Vec::new();
        for (other, off) in zeros {
            let slack = off + resolution / self.torus.minor;
            crossed.extend(self.passes(arrange(fixed, angle, other), slack)?);
        }
        Some(crossed)
    }

    /// The same of a circle of another surface: where it meets the torus. None where that surface is
    /// not the one in which the curve meets the torus, to rounding: one that holds the curve within
    /// the resolution may meet the torus elsewhere.
    pub fn across_circle(
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
        for (u, off) in simple_zeros(&coefficients, slop)? {
            let (sin, cos) = u.sin_cos();
            let frame = &circle.frame;
            let p = frame.point(circle.radius * cos, circle.radius * sin, N::ZERO);
            let slack = (off * circle.radius + resolution) / self.torus.minor;
            crossed.extend(self.passes(torus.parameters(&p), slack)?);
        }
        Some(crossed)
    }

    /// Where the curve passes a point of F = 0, which is off by `slack` of an angle: at most once, next
    /// to no singular point.
    fn passes(&self, angles: [N; 2], slack: N) -> Option<Option<N>> {
        let count = self.segments.len();
        let mut passed: Option<(usize, N)> = None;
        for (i, s) in self.segments.iter().enumerate() {
            let tau = match self.place(s, angles, slack) {
                Place::On(tau) => tau,
                Place::Beside => continue,
                Place::Unclear => return None,
            };
            match passed {
                None => passed = Some((i, tau)),
                // The end of one segment is the next one's beginning.
                Some((before, _)) if before + 1 == i => {}
                Some((0, _)) if self.closed && i + 1 == count => {}
                Some(_) => return None,
            }
        }
        Some(passed.map(|(i, tau)| N::whole(i as u32) + tau))
    }

    /// Where a point of F = 0 lies with respect to a segment.
    fn place(&self, s: &TorusCurveSegment<N>, [theta, phi]: [N; 2], slack: N) -> Place<N> {
        let slack = slack * (N::ONE + s.steep);
        let x = self.folded(s, theta, phi);
        let length = s.to - s.from;
        if s.chart.is_some() {
            let [a, b] = [s.from.min(s.to), s.from.max(s.to)];
            let reach = b - a;
            return match x >= a - reach && x <= b + reach {
                true => Place::Unclear,
                false => Place::Beside,
            };
        }
        let before = (s.from.min(s.to) - x).max(x - s.from.max(s.to));
        if before > slack {
            return Place::Beside;
        }
        let [_, y] = arrange(s.axis, theta, phi);
        let rough = wrap(s.hermite(x) - y).abs();
        if rough > N::TWO * s.steep.max(N::ONE) * length.abs() + N::from_f64(CLEARLY_APART) * slack
        {
            return Place::Beside;
        }
        let tau = ((x - s.from) / length).clamp(N::ZERO, N::ONE);
        let [a, b] = self.angles_on(s, tau);
        let away = wrap(theta - a).hypot(wrap(phi - b));
        if away <= slack {
            Place::On(tau)
        } else if away > N::from_f64(CLEARLY_APART) * slack {
            Place::Beside
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

    /// The branches in which a torus meets a cylinder next to its axis and tilted.
    fn branches(minor: f64, beside: f64, radius: f64) -> Vec<TorusCurve> {
        let torus = Torus {
            frame: Frame::world(),
            major: 2.0,
            minor,
        };
        let axis = Vector3::new(0.1, 0.2, 1.0).normalize();
        let frame = Frame::about(Point3::new(beside, 0.1, 0.0), axis);
        let other = Surface::Cylinder(Cylinder { frame, radius });
        let form = BivariateTrigPoly::interpolate(|theta, phi| {
            let p = Surface::Torus(torus).point(theta, phi);
            other.level([p.x, p.y, p.z])
        });
        trace(&torus, &form, 1e-11).unwrap().branches
    }

    /// How often one angle along a curve changes from one side of a value to the other.
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
        for (minor, beside, radius) in [(0.5, 0.3, 2.1), (1.2, 1.5, 0.8), (0.7, 1.9, 1.1)] {
            for curve in branches(minor, beside, radius) {
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
        let beside = Surface::Cylinder(Cylinder {
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
                assert!(curve.across_circle(&circle, &beside, 1e-11).is_none());
            }
        }
        assert!(crossed > 20, "{crossed}");
    }

    #[test]
    fn a_circle_that_is_touched_is_not_plainly_crossed() {
        // Where the angle about the axis is greatest along a small oval.
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
