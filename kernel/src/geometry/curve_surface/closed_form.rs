//! Roots in closed form: of a line with a plane, a cylinder or a sphere, and of a circle or an
//! ellipse with a plane, a sphere, or a parallel cylinder.
//!
//! The level of the surface along the curve is a polynomial of degree two at most, or a constant plus a
//! wave. The roots are returned only if they are unambiguous: the level at both ends of the range, and
//! at each extremum, is farther from zero than any close call. Root isolation handles other cases.

use super::CurveSurfaceRoots;
use crate::geometry::curve::{Curve, Line};
use crate::geometry::frame::Frame;
use crate::geometry::surface::Surface;
use crate::geometry::vector::Length;
use crate::number::elementary_roots::{linear_roots, quadratic_roots, wave_roots};
use crate::number::float::Float;
use crate::number::predicates::CLOSE;
use crate::number::roots::{Root, RootKind};
use nalgebra::Vector3;

/// The level of a surface along a curve.
enum Level<N> {
    /// height + slope t.
    Linear { height: N, slope: N },
    /// c + 2 b t + a t², a > 0.
    Quadratic { a: N, b: N, c: N },
    /// c + p cos t + q sin t.
    Wave { c: N, p: N, q: N },
}

/// The level, and the size of the numbers that cancel in it.
struct LevelOnCurve<N> {
    level: Level<N>,
    size: N,
}

/// The roots in a range; `None` if one of them, or a near miss, may be a close call, or if the curve
/// crosses the surface at a grazing angle.
pub(super) fn clear_roots<N: Float>(
    curve: &Curve<N>,
    range: [N; 2],
    surface: &Surface<N>,
    resolution: N,
) -> Option<CurveSurfaceRoots<N>> {
    let reach = N::from_f64(CLOSE) * resolution;
    let LevelOnCurve { level, size } = level_on(curve, surface)?;
    let noise = N::from_f64(ROUNDINGS) * N::ROUNDING * size;
    if reach <= noise || noise.is_nan() {
        return None;
    }
    let [at_lo, at_hi] = range.map(|t| level.at(t));
    if !(at_lo.abs() > reach && at_hi.abs() > reach) {
        return None;
    }
    let roots = level.roots(range, reach)?;
    // The number of roots has to agree with the signs at the ends.
    let changes = (at_lo > N::ZERO) != (at_hi > N::ZERO);
    if changes == roots.len().is_multiple_of(2) {
        return None;
    }
    let roots = roots
        .into_iter()
        .map(|t| polished(t, curve, surface))
        .collect::<Option<Vec<_>>>()?;
    Some(CurveSurfaceRoots {
        roots,
        misses: Vec::new(),
    })
}

/// A root after a step of Newton's method, because the coefficients of a level have rounding errors of
/// the distance of the curve's origin. `None` if the crossing is so grazing that the curve is within the
/// resolution of the surface for more than [`CLOSE`] times the resolution.
fn polished<N: Float>(t: N, curve: &Curve<N>, surface: &Surface<N>) -> Option<Root<N>> {
    let point = curve.jet(t);
    let speed = Vector3::from(point.map(|x| x.d)).length();
    let level = surface.level(point);
    let is_clear = speed <= N::from_f64(CLOSE) * level.d.abs();
    let t = t - level.v / level.d;
    is_clear.then_some(Root {
        t,
        lo: t,
        hi: t,
        contact: RootKind::Simple,
        margin: None,
    })
}

/// The number of roundings in a level.
const ROUNDINGS: f64 = 64.0;

impl<N: Float> Level<N> {
    fn at(&self, t: N) -> N {
        match *self {
            Self::Linear { height, slope } => height + slope * t,
            Self::Quadratic { a, b, c } => (a * t + N::TWO * b) * t + c,
            Self::Wave { c, p, q } => {
                let (sin, cos) = t.sin_cos();
                c + p * cos + q * sin
            }
        }
    }

    /// The roots, in increasing order; `None` if an extremum next to one is within `reach`.
    fn roots(&self, range: [N; 2], reach: N) -> Option<Vec<N>> {
        let (mut roots, mut is_clear) = (Vec::new(), true);
        let mut found = |t: N, is_simple: bool| {
            is_clear &= is_simple;
            roots.push(t);
        };
        match *self {
            Self::Linear { height, slope } => {
                linear_roots(height, slope, range, reach, &mut found);
            }
            Self::Quadratic { a, b, c } => quadratic_roots([a, b, c], range, reach, &mut found),
            Self::Wave { c, p, q } => wave_roots(c, [p, q], range, reach, &mut found),
        }
        roots.sort_by(N::total_cmp);
        is_clear.then_some(roots)
    }
}

/// The level of a surface along a curve; `None` for other curves and surfaces.
fn level_on<N: Float>(curve: &Curve<N>, surface: &Surface<N>) -> Option<LevelOnCurve<N>> {
    match curve {
        Curve::Line(line) => on_line(line, surface),
        Curve::Circle(c) => {
            let axes = [c.frame.x * c.radius, c.frame.y * c.radius];
            on_ellipse(&c.frame, axes, Some(c.radius), surface)
        }
        Curve::Ellipse(e) => {
            let axes = [e.frame.x * e.a, e.frame.y * e.b];
            on_ellipse(&e.frame, axes, None, surface)
        }
        Curve::Hyperbola(_) | Curve::Conic(_) | Curve::Quartic(_) | Curve::Toric(_) => None,
    }
}

fn on_line<N: Float>(line: &Line<N>, surface: &Surface<N>) -> Option<LevelOnCurve<N>> {
    let frame = surface.frame();
    let (o, d) = (
        frame.coordinates(&line.origin),
        frame.components(&line.direction),
    );
    let (o, d, radius) = match surface {
        Surface::Plane(_) => {
            let level = Level::Linear {
                height: o.z,
                slope: d.z,
            };
            let size = o.length();
            return Some(LevelOnCurve { level, size });
        }
        Surface::Cylinder(s) => {
            let flat = |v: Vector3<N>| Vector3::new(v.x, v.y, N::ZERO);
            (flat(o), flat(d), s.radius)
        }
        Surface::Sphere(s) => (o, d, s.radius),
        Surface::Cone(_)
        | Surface::Torus(_)
        | Surface::EllipticCylinder(_)
        | Surface::EllipticCone(_)
        | Surface::Ellipsoid(_) => return None,
    };
    let a = d.dot(&d);
    // A line nearly parallel to the axis is nearest to it far away, where digits cancel.
    if a < N::from_f64(STEEP) {
        return None;
    }
    let (b, away) = (o.dot(&d), o.dot(&o));
    let scale = N::HALF / radius;
    Some(LevelOnCurve {
        level: Level::Quadratic {
            a: a * scale,
            b: b * scale,
            c: (away - radius * radius) * scale,
        },
        size: (away + radius * radius) * scale,
    })
}

/// The least square of the sine of the angle between a line and an axis.
const STEEP: f64 = 1.0 / 256.0;

/// The level along the ellipse centre + x cos t + y sin t. A circle has a radius.
fn on_ellipse<N: Float>(
    frame: &Frame<N>,
    [x, y]: [Vector3<N>; 2],
    radius: Option<N>,
    surface: &Surface<N>,
) -> Option<LevelOnCurve<N>> {
    let about = surface.frame();
    let o = frame.origin - about.origin;
    if let Surface::Plane(_) = surface {
        return Some(LevelOnCurve {
            level: Level::Wave {
                c: o.dot(&about.z),
                p: x.dot(&about.z),
                q: y.dot(&about.z),
            },
            size: o.length() + x.length(),
        });
    }
    let own = radius?;
    let (o, other) = match surface {
        Surface::Sphere(s) => (o, s.radius),
        Surface::Cylinder(s) if is_parallel(&frame.z, &about.z) => {
            (o - about.z * o.dot(&about.z), s.radius)
        }
        _ => return None,
    };
    let scale = N::HALF / other;
    let away = o.dot(&o);
    Some(LevelOnCurve {
        level: Level::Wave {
            c: (away + (own - other) * (own + other)) * scale,
            p: o.dot(&x) * N::TWO * scale,
            q: o.dot(&y) * N::TWO * scale,
        },
        size: (away + own * own + other * other) * scale,
    })
}

/// Whether two unit vectors are parallel up to their rounding.
fn is_parallel<N: Float>(a: &Vector3<N>, b: &Vector3<N>) -> bool {
    a.cross(b).length() <= N::from_f64(4.0) * N::ROUNDING
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::curve::{Circle, Ellipse};
    use crate::geometry::curve_surface::Height;
    use crate::geometry::surface::{Cylinder, Plane, Sphere};
    use crate::number::roots::{Roots, isolate_closely};
    use nalgebra::Point3;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    fn frame(tilt: f64, [x, y, z]: [f64; 3]) -> Frame {
        let axis = Vector3::new(tilt.cos(), 0.7 * tilt.sin(), 0.4).normalize();
        Frame::toward(Point3::new(x, y, z), axis, Vector3::new(0.1, 1.0, 0.3))
    }

    proptest! {
        #[test]
        fn clear_roots_are_those_of_root_isolation(
            tilt in 0.0..TAU,
            apart in prop_oneof![0.0..TAU, (0.0..8.0).prop_map(|digits: f64| 10.0_f64.powf(-digits))],
            first in prop::array::uniform3(-1.0..1.0),
            second in prop::array::uniform3(-1.0..1.0),
            lo in -4.0..0.0,
            length in prop_oneof![0.1..6.0, Just(TAU)],
            [a, b] in prop::array::uniform2(0.2..2.0_f64),
            radius in 0.2..2.0,
        ) {
            let [f, g] = [frame(tilt, first), frame(tilt + apart, second)];
            let [a, b] = [a.max(b), a.min(b)];
            let shifted = Frame { origin: g.origin, ..f };
            let line = Curve::Line(Line { origin: f.origin, direction: f.z });
            let circle = Curve::Circle(Circle { frame: f, radius: a });
            let ellipse = Curve::Ellipse(Ellipse { frame: f, a, b });
            let plane = Surface::Plane(Plane { frame: g });
            let sphere = Surface::Sphere(Sphere { frame: g, radius });
            let cylinder = Surface::Cylinder(Cylinder { frame: g, radius });
            let parallel = Surface::Cylinder(Cylinder { frame: shifted, radius });
            let cases = [
                (&line, plane), (&line, sphere), (&line, cylinder), (&circle, plane),
                (&circle, sphere), (&circle, parallel), (&ellipse, plane),
            ];
            for (i, (curve, surface)) in cases.into_iter().enumerate() {
                let range = [lo, lo + length];
                let Some(found) = clear_roots(curve, range, &surface, 1e-11) else {
                    continue;
                };
                let breaks = curve.breaks(range[0], range[1]);
                let known = isolate_closely(&Height::new(curve, &surface), &breaks, 1e-11);
                let Ok(Roots::At { roots, misses }) = known else {
                    return Err(TestCaseError::fail("no isolated roots"));
                };
                prop_assert!(misses.is_empty(), "case {i}");
                prop_assert_eq!(found.roots.len(), roots.len(), "case {}", i);
                for (x, y) in found.roots.iter().zip(&roots) {
                    prop_assert!((x.t - y.t).abs() <= 1e-9, "case {i}: {x:?} {y:?}");
                    prop_assert_eq!(x.contact, y.contact);
                    prop_assert!(y.hi - y.lo <= 1e-8, "case {i}: {y:?}");
                }
            }
        }
    }

    proptest! {
        /// The origin of the line, or the centre of the circle, is far from the sphere and the cylinder.
        /// Squares of that distance must not be in the error of a root.
        #[test]
        fn a_root_is_as_accurate_as_the_points_of_the_curve(
            tilts in prop::array::uniform2(0.0..TAU),
            aside in prop::array::uniform3(-1.0..1.0),
            [far, radius] in [10.0..1000.0, 0.5..2.0_f64],
        ) {
            let [f, g] = [frame(tilts[0], aside), frame(tilts[1], [0.0; 3])];
            let origin = f.point(0.0, 0.0, -far);
            let line = Curve::Line(Line { origin, direction: f.z });
            let around = Frame { origin: f.point(-far, 0.0, 0.0), ..f };
            let circle = Curve::Circle(Circle { frame: around, radius: far });
            let half = 4.0 / far;
            let sphere = Surface::Sphere(Sphere { frame: g, radius });
            let cylinder = Surface::Cylinder(Cylinder { frame: g, radius });
            let parallel = Surface::Cylinder(Cylinder { frame: Frame { origin: g.origin, ..f }, radius });
            let cases = [
                (&line, sphere, [far - 4.0, far + 4.0]), (&line, cylinder, [far - 4.0, far + 4.0]),
                (&circle, sphere, [-half, half]), (&circle, parallel, [-half, half]),
            ];
            for (i, (curve, surface, range)) in cases.into_iter().enumerate() {
                let found = clear_roots(curve, range, &surface, 1e-10).map(|found| found.roots);
                for root in found.into_iter().flatten() {
                    let residual = surface.distance(&curve.point(root.t)).abs();
                    prop_assert!(residual <= 2.0 * f64::EPSILON * far, "case {i}: {residual:e}");
                }
            }
        }
    }

    /// A wave whose roots are two known angles: cos t = 1/2.
    #[test]
    fn a_circle_crosses_a_plane_at_sixty_degrees() {
        let circle = Curve::Circle(Circle {
            frame: Frame::world(),
            radius: 2.0,
        });
        let x = Vector3::x();
        let plane = Surface::Plane(Plane {
            frame: Frame::about(Point3::new(1.0, 0.0, 0.0), x),
        });
        let found = clear_roots(&circle, [-1.5, 1.5], &plane, 1e-11).map(|found| found.roots);
        let at: Vec<f64> = found.into_iter().flatten().map(|root| root.t).collect();
        assert_eq!(at.len(), 2);
        assert!((at[0] + TAU / 6.0).abs() < 1e-15 && (at[1] - TAU / 6.0).abs() < 1e-15);
    }

    /// A circle in a plane that is tilted by 1/128 is within the resolution of the other plane for
    /// more than a hundred times the resolution.
    #[test]
    fn grazing_crossings_have_no_closed_form() {
        let circle = Curve::Circle(Circle {
            frame: Frame::world(),
            radius: 2.0,
        });
        let tilted = |angle: f64| {
            let normal = Vector3::new(0.0, angle.sin(), angle.cos());
            Surface::Plane(Plane {
                frame: Frame::about(Point3::origin(), normal),
            })
        };
        let found = |angle| clear_roots(&circle, [-1.0, 4.0], &tilted(angle), 1e-11);
        assert!(found(1.0 / 128.0).is_none());
        assert_eq!(found(1.0 / 64.0).map(|found| found.roots.len()), Some(2));
    }

    /// Tangent curves and ends on the surface are left to root isolation.
    #[test]
    fn contacts_have_no_closed_form() {
        let frame = Frame::world();
        let circle = Curve::Circle(Circle { frame, radius: 2.0 });
        let at = |x: f64| {
            Surface::Plane(Plane {
                frame: Frame::about(Point3::new(x, 0.0, 0.0), Vector3::x()),
            })
        };
        for x in [2.0, 2.0 + 1e-10, -2.0] {
            assert!(clear_roots(&circle, [-0.1, 4.0], &at(x), 1e-11).is_none());
        }
        assert!(clear_roots(&circle, [TAU / 4.0, 4.0], &at(0.0), 1e-11).is_none());
    }
}
