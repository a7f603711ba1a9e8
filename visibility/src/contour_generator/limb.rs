//! Limbs: where the line of sight touches a surface.
//!
//! Notation, in the surface's own frame: P a point, N its outward normal, E the eye, r = P - E the
//! line of sight (for parallel lines its constant direction). A limb is N·r = 0 on the surface
//! (equation 6 of the paper). For a quadric that is the section with the polar plane of the eye:
//! a circle of a sphere, rulings of a cylinder or a cone. Affine maps keep that, so an elliptic surface
//! has the limbs of a round one whose points and eye are divided by the radii. For a torus it is, in its angles,
//! R cos φ + r - (e_x cos θ + e_y sin θ) cos φ - e_z sin φ = 0. At a cusp the line of sight runs
//! along the limb: the normal curvature of the surface vanishes along it.

mod elliptic;

use crate::camera::projection::ViewRay;
use elliptic::{ellipsoid_limb, elliptic_cone_limbs, elliptic_cylinder_limbs};
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::bivariate_trig_poly::BivariateTrigPoly;
use premio_kernel::geometry::curve::{Circle, Curve, Line};
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Cone, Cylinder, Plane, Sphere, Surface, Torus};
use premio_kernel::geometry::trace::trace;
use premio_kernel::geometry::unresolved::Unresolved;
use premio_kernel::number::bisection::bisect;
use premio_kernel::number::float::Analytic;
use premio_kernel::number::interval::Interval;
use premio_kernel::number::jet::Jet;
use premio_kernel::number::predicates::{Compare, ROUNDING};
use premio_kernel::number::roots::{Roots, isolate};
use std::f64::consts::TAU;

/// A limb of a whole surface, not yet cut by a face's boundary.
#[derive(Clone, Debug)]
pub struct Limb {
    /// The curve.
    pub curve: Curve,
    /// Where it ends in an apex: at the start of a cone's limb, and at the poles of a torus. Beyond a
    /// pole it lies on the torus's other sheet.
    pub apexes: Vec<f64>,
    /// Where it crosses itself, on a torus.
    pub nodes: Vec<f64>,
}

impl Limb {
    fn new(curve: Curve) -> Self {
        Self {
            curve,
            apexes: Vec::new(),
            nodes: Vec::new(),
        }
    }
}

/// The eye or the direction of sight in a surface's frame.
#[derive(Clone, Copy, Debug)]
enum LocalSight {
    Eye(Vector3<f64>),
    Direction(Vector3<f64>),
}

fn local(frame: &Frame, sight: &ViewRay) -> LocalSight {
    match sight {
        ViewRay::Eye(e) => LocalSight::Eye(frame.coordinates(e)),
        ViewRay::Direction(d) => LocalSight::Direction(frame.components(d)),
    }
}

/// The limbs of a surface. `resolution` is the resolution of the part. `tilt` is the sine of the
/// angle to parallel sight below which the whole part deviates by less than the resolution.
pub fn limbs(
    surface: &Surface,
    sight: &ViewRay,
    resolution: f64,
    tilt: f64,
) -> Result<Vec<Limb>, Unresolved> {
    Ok(match surface {
        Surface::Plane(_) => Vec::new(),
        Surface::Cylinder(s) => cylinder_limbs(s, sight, resolution, tilt),
        Surface::Cone(s) => cone_limbs(s, sight, resolution, tilt),
        Surface::Sphere(s) => sphere_limb(s, sight, resolution).into_iter().collect(),
        Surface::Torus(s) => torus_limbs(s, sight, resolution)?,
        Surface::EllipticCylinder(s) => elliptic_cylinder_limbs(s, sight, resolution, tilt),
        Surface::EllipticCone(s) => elliptic_cone_limbs(s, sight, resolution, tilt),
        Surface::Ellipsoid(s) => ellipsoid_limb(s, sight, resolution).into_iter().collect(),
    })
}

/// Half the angle between two directions a cos(u - u0) = c, or none where they do not exist.
fn half_angle(a: f64, c: f64) -> Option<f64> {
    let exists = c.abs().is_short_of(a);
    exists.then(|| ((a - c) * (a + c)).sqrt().atan2(c))
}

fn cylinder_limbs(s: &Cylinder, sight: &ViewRay, resolution: f64, tilt: f64) -> Vec<Limb> {
    let (across, level, least) = match local(&s.frame, sight) {
        LocalSight::Eye(e) => (e, s.radius, resolution),
        // Seen along its axis a cylinder is edge-on.
        LocalSight::Direction(d) => (d, 0.0, tilt),
    };
    let reach = across.x.hypot(across.y);
    if (reach - level).is_at_most(least) {
        return Vec::new();
    }
    let Some(half) = half_angle(reach, level) else {
        return Vec::new();
    };
    let middle = across.y.atan2(across.x);
    [middle - half, middle + half]
        .map(|u| {
            let origin = s.frame.point(s.radius * u.cos(), s.radius * u.sin(), 0.0);
            Limb::new(Curve::Line(Line {
                origin,
                direction: s.frame.z,
            }))
        })
        .to_vec()
}

fn cone_limbs(s: &Cone, sight: &ViewRay, resolution: f64, tilt: f64) -> Vec<Limb> {
    // N·r = -N·E on every ruling: cos (e_x cos u + e_y sin u) = sin e_z.
    let (e, least) = match local(&s.frame, sight) {
        LocalSight::Eye(e) => (e, resolution),
        LocalSight::Direction(d) => (d, tilt),
    };
    let reach = s.cos * e.x.hypot(e.y);
    let level = s.sin * e.z;
    if (reach - level.abs()).is_at_most(least) {
        return Vec::new();
    }
    let Some(half) = half_angle(reach, level) else {
        return Vec::new();
    };
    let middle = e.y.atan2(e.x);
    [middle - half, middle + half]
        .map(|u| {
            let radial = s.frame.x * u.cos() + s.frame.y * u.sin();
            Limb {
                apexes: vec![0.0],
                ..Limb::new(Curve::Line(Line {
                    origin: s.frame.origin,
                    direction: s.frame.z * s.cos + radial * s.sin,
                }))
            }
        })
        .to_vec()
}

fn sphere_limb(s: &Sphere, sight: &ViewRay, resolution: f64) -> Option<Limb> {
    let circle = |centre: Point3<f64>, z: Vector3<f64>, radius: f64| {
        Limb::new(Curve::Circle(Circle {
            frame: Frame::about(centre, z),
            radius,
        }))
    };
    match sight {
        ViewRay::Direction(d) => Some(circle(s.frame.origin, -d, s.radius)),
        ViewRay::Eye(e) => {
            let arm = e - s.frame.origin;
            let away = arm.norm();
            if (away - s.radius).is_at_most(resolution) {
                return None;
            }
            let sin = s.radius / away;
            let z = arm / away;
            let radius = s.radius * ((1.0 - sin) * (1.0 + sin)).sqrt();
            Some(circle(s.frame.origin + z * (s.radius * sin), z, radius))
        }
    }
}

fn torus_limbs(s: &Torus, sight: &ViewRay, resolution: f64) -> Result<Vec<Limb>, Unresolved> {
    let local = local(&s.frame, sight);
    if let Some(circles) =
        axial_limbs(s, &local, resolution).or_else(|| side_limbs(s, &local, resolution))
    {
        return Ok(circles);
    }
    let form = torus_form(s, &local);
    let traced = trace(s, &form, resolution, &|_| true)?;
    let mut limbs: Vec<Limb> = traced
        .branches
        .into_iter()
        .map(|c| Limb::new(Curve::Toric(Box::new(c))))
        .collect();
    if !s.is_ring() {
        for limb in &mut limbs {
            limb.apexes = pole_passes(s, &limb.curve, resolution);
        }
    }
    for on in traced.singular.iter().flat_map(|s| &s.on) {
        if let Some(limb) = limbs.get_mut(on.branch) {
            limb.nodes.push(on.t);
        }
    }
    Ok(limbs)
}

/// The parameters at which a closed curve passes through the poles of a torus.
fn pole_passes(s: &Torus, curve: &Curve, resolution: f64) -> Vec<f64> {
    let f = |t: Interval| s.sheet_level(curve.jet_over(t));
    let period = curve.period().unwrap_or(0.0);
    match isolate(&f, &curve.breaks(0.0, period), resolution) {
        Roots::Everywhere => Vec::new(),
        Roots::At { roots, .. } => roots.iter().map(|r| r.t).collect(),
    }
}

/// Seen from its axis, a torus has two parallel circles as limbs, of which its sheet may have one
/// or none.
fn axial_limbs(s: &Torus, sight: &LocalSight, resolution: f64) -> Option<Vec<Limb>> {
    let angles = match sight {
        LocalSight::Direction(d) => {
            let is_axial = d.x.hypot(d.y).is_within(ROUNDING);
            is_axial.then_some([0.0, TAU / 2.0])?
        }
        LocalSight::Eye(e) => {
            e.x.hypot(e.y).is_within(resolution).then_some(())?;
            // R cos φ - e_z sin φ = -r
            let half = half_angle(s.major.hypot(e.z), -s.minor)?;
            let middle = (-e.z).atan2(s.major);
            [middle - half, middle + half]
        }
    };
    let circle = |phi: f64| {
        let centre = s.frame.point(0.0, 0.0, s.minor * phi.sin());
        Limb::new(Curve::Circle(Circle {
            frame: s.frame.at(centre),
            radius: s.major + s.minor * phi.cos(),
        }))
    };
    let is_on_sheet = |phi: &f64| (s.major + s.minor * phi.cos()).is_beyond(resolution);
    let angles = angles.into_iter().filter(is_on_sheet);
    Some(angles.map(circle).collect())
}

/// For parallel sight perpendicular to its axis within the resolution, cos φ cos(θ - α) = 0: the
/// circles at the top and at the bottom, which the inner sheet does not have, and two circles of the
/// tube, which cross them.
fn side_limbs(s: &Torus, sight: &LocalSight, resolution: f64) -> Option<Vec<Limb>> {
    let LocalSight::Direction(d) = sight else {
        return None;
    };
    is_across(s, d, resolution).then_some(())?;
    let alpha = d.y.atan2(d.x);
    let side = s.frame.x * -alpha.sin() + s.frame.y * alpha.cos();
    let quarter = TAU / 4.0;
    let level = |z: f64| Limb {
        nodes: vec![alpha + quarter, alpha - quarter],
        ..Limb::new(Curve::Circle(Circle {
            frame: s.frame.at(s.frame.point(0.0, 0.0, z)),
            radius: s.major,
        }))
    };
    let poles = match s.is_ring() {
        true => Vec::new(),
        false => vec![s.pole_angle(), TAU - s.pole_angle()],
    };
    let has_levels = s.major.is_above_zero();
    let tube = |radial: Vector3<f64>| Limb {
        nodes: match has_levels {
            true => vec![quarter, -quarter],
            false => Vec::new(),
        },
        apexes: poles.clone(),
        ..Limb::new(Curve::Circle(Circle {
            frame: Frame {
                origin: s.frame.origin + radial * s.major,
                x: radial,
                y: s.frame.z,
                z: radial.cross(&s.frame.z),
            },
            radius: s.minor,
        }))
    };
    let heights = [s.minor, -s.minor].into_iter().filter(|_| has_levels);
    let levels = heights.map(level);
    Some(levels.chain([tube(side), tube(-side)]).collect())
}

/// N·(P - E), or N·d, over the angles, scaled to a distance to first order.
fn torus_form(s: &Torus, sight: &LocalSight) -> BivariateTrigPoly {
    const ONE: usize = 0;
    const COS: usize = 1;
    const SIN: usize = 2;
    let mut k = BivariateTrigPoly::zero();
    let e = match sight {
        LocalSight::Eye(e) => {
            k.0[ONE][COS] = s.major;
            k.0[ONE][ONE] = s.minor;
            e
        }
        LocalSight::Direction(d) => d,
    };
    k.0[COS][COS] = -e.x;
    k.0[SIN][COS] = -e.y;
    k.0[ONE][SIN] = -e.z;
    let scale = s.minor / slope(s, sight);
    for c in k.0.iter_mut().flatten() {
        *c *= scale;
    }
    k
}

/// The approximate rate of change of N·r with the angle of the normal.
fn slope(s: &Torus, sight: &LocalSight) -> f64 {
    match sight {
        LocalSight::Eye(e) => e.norm() + s.major.abs(),
        LocalSight::Direction(_) => 1.0,
    }
}

/// The surfaces that intersect a surface transversally in its limbs. For a quadric that is the
/// polar plane of the eye. For parallel sight perpendicular to a torus's axis, it is the plane of
/// the two circles of the tube and the cylinder through those at the top and at the bottom. Each by
/// itself determines where a curve crosses a limb, however near to another limb; their product does
/// not. None where the whole surface is seen edge-on or from inside, and where no such surface is
/// known.
pub fn cutters(surface: &Surface, sight: &ViewRay, resolution: f64) -> Vec<Surface> {
    match surface {
        Surface::Torus(s) => side_cutters(s, sight, resolution),
        quadric => polar_plane(quadric, sight)
            .map(Surface::Plane)
            .into_iter()
            .collect(),
    }
}

fn side_cutters(s: &Torus, sight: &ViewRay, resolution: f64) -> Vec<Surface> {
    let LocalSight::Direction(d) = local(&s.frame, sight) else {
        return Vec::new();
    };
    if !is_across(s, &d, resolution) {
        return Vec::new();
    }
    let along = s.frame.x * d.x + s.frame.y * d.y;
    let plane = Plane {
        frame: Frame::about(s.frame.origin, along.normalize()),
    };
    let cylinder = Cylinder {
        frame: s.frame,
        radius: s.major,
    };
    let levels = s
        .major
        .is_above_zero()
        .then_some(Surface::Cylinder(cylinder));
    std::iter::once(Surface::Plane(plane))
        .chain(levels)
        .collect()
}

/// The value of the form, in multiples of the resolution, up to which four branches intersect in a
/// node. Tracing joins them up to one resolution.
const NODES: f64 = 2.0;

/// Whether a direction of sight d, in a torus's frame, is perpendicular to its axis within the
/// resolution. At the nodes of the circles, the form of the limbs has the value r d_z. In the image
/// that is the greatest distance of the limbs from the circles; along the line of sight the distance
/// grows with the square root of the tilt.
fn is_across(s: &Torus, direction: &Vector3<f64>, resolution: f64) -> bool {
    let level = s.minor * direction.z;
    level.is_within(NODES * resolution) || direction.z.is_within(ROUNDING)
}

/// The polar plane of the eye with respect to a quadric: it intersects the surface in the limb.
/// None for planes and tori, and where the whole surface is seen edge-on or from inside.
fn polar_plane(surface: &Surface, sight: &ViewRay) -> Option<Plane> {
    let f = surface.frame();
    let plane = |normal: Vector3<f64>, level: f64| {
        let size = normal.norm();
        size.is_above_zero().then(|| {
            let n = f.vector(&(normal / size));
            Plane {
                frame: Frame::about(f.origin + n * (level / size), n),
            }
        })
    };
    match (surface, local(f, sight)) {
        (Surface::Cylinder(s), LocalSight::Eye(e)) => {
            plane(Vector3::new(e.x, e.y, 0.0), s.radius * s.radius)
        }
        (Surface::Cylinder(_), LocalSight::Direction(d)) => plane(Vector3::new(d.x, d.y, 0.0), 0.0),
        (Surface::Cone(s), LocalSight::Eye(e) | LocalSight::Direction(e)) => {
            let (c, k) = (s.cos * s.cos, s.sin * s.sin);
            plane(Vector3::new(c * e.x, c * e.y, -k * e.z), 0.0)
        }
        (Surface::Sphere(s), LocalSight::Eye(e)) => plane(e, s.radius * s.radius),
        (Surface::Sphere(_), LocalSight::Direction(d)) => plane(d, 0.0),
        (Surface::EllipticCylinder(s), LocalSight::Eye(e)) => plane(s.gradient(&e), 1.0),
        (Surface::EllipticCylinder(s), LocalSight::Direction(d)) => plane(s.gradient(&d), 0.0),
        (Surface::EllipticCone(s), LocalSight::Eye(e) | LocalSight::Direction(e)) => {
            plane(s.gradient(&e), 0.0)
        }
        (Surface::Ellipsoid(s), LocalSight::Eye(e)) => plane(s.gradient(&e), 1.0),
        (Surface::Ellipsoid(s), LocalSight::Direction(d)) => plane(s.gradient(&d), 0.0),
        (Surface::Plane(_) | Surface::Torus(_), _) => None,
    }
}

/// The part of a range of a curve on a torus that ends off the poles, where there is no normal.
fn off_poles(s: &Torus, curve: &Curve, [lo, hi]: [f64; 2], resolution: f64) -> [f64; 2] {
    let near = OFF_POLE * s.pole_neighbourhood(resolution);
    let from_pole = |t: f64| {
        let p = curve.point(t);
        let away = s.poles().map(|pole| (pole - p).norm());
        away.fold(f64::INFINITY, f64::min) - near
    };
    let middle = 0.5 * (lo + hi);
    let is_at_pole = |end: f64| from_pole(end).is_below_zero();
    [
        if is_at_pole(lo) {
            bisect(lo, middle, -1.0, from_pole)
        } else {
            lo
        },
        if is_at_pole(hi) {
            bisect(middle, hi, 1.0, from_pole)
        } else {
            hi
        },
    ]
}

/// The distance from a pole, relative to that within which the normal is not known, at which it is
/// clear.
const OFF_POLE: f64 = 8.0;

/// Where a curve on a torus crosses the torus's limb: the parameters over `range`, and whether
/// the curve runs along it.
pub fn torus_limb_on(
    s: &Torus,
    sight: &ViewRay,
    curve: &Curve,
    range: [f64; 2],
    resolution: f64,
) -> Roots {
    let local = local(&s.frame, sight);
    let range = off_poles(s, curve, range, resolution);
    let scale = 1.0 / slope(s, &local);
    let f = |t: Interval| {
        let q = s.frame.local(curve.jet_over(t));
        let rho = (q[0].square() + q[1].square()).root();
        // r N = (k x, k y, z) with k = 1 - R/ρ.
        let k = Jet::constant(1.0) - Jet::constant(s.major).over(rho);
        let n = [q[0] * k, q[1] * k, q[2]];
        let r = match local {
            LocalSight::Eye(e) => std::array::from_fn(|i| q[i] - Jet::constant(e[i])),
            LocalSight::Direction(d) => std::array::from_fn(|i| Jet::constant(d[i])),
        };
        let r: [Jet<Interval>; 3] = r;
        (n[0] * r[0] + n[1] * r[1] + n[2] * r[2]).scale(scale)
    };
    isolate(&f, &curve.breaks(range[0], range[1]), resolution)
}

/// The cusps of a limb on a torus: where the line of sight is along it, |r|² = R (r·e_θ)²/ρ.
pub fn cusps(
    s: &Torus,
    sight: &ViewRay,
    curve: &Curve,
    range: [f64; 2],
    resolution: f64,
) -> Vec<f64> {
    let local = local(&s.frame, sight);
    let range = off_poles(s, curve, range, resolution);
    let scale = s.minor / slope(s, &local).powi(2);
    let f = |t: Interval| {
        let q = s.frame.local(curve.jet_over(t));
        let rho2 = q[0].square() + q[1].square();
        let rho3 = rho2 * rho2.root();
        let (r2, e) = match local {
            LocalSight::Eye(e) => {
                let r: [Jet<Interval>; 3] = std::array::from_fn(|i| q[i] - Jet::constant(e[i]));
                (r[0].square() + r[1].square() + r[2].square(), e)
            }
            LocalSight::Direction(d) => (Jet::constant(1.0), d),
        };
        let along = q[1].scale(e.x) - q[0].scale(e.y);
        (r2 - along.square().scale(s.major).over(rho3)).scale(scale)
    };
    match isolate(&f, &curve.breaks(range[0], range[1]), resolution) {
        Roots::Everywhere => Vec::new(),
        Roots::At { roots, .. } => roots.iter().map(|r| r.t).collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use premio_kernel::geometry::ellipsoid::Ellipsoid;
    use premio_kernel::geometry::elliptic_surface::{EllipticCone, EllipticCylinder};

    fn tilted() -> Frame {
        let z = Vector3::new(0.3, -0.4, 0.7).normalize();
        Frame::toward(Point3::new(1.0, -2.0, 0.5), z, Vector3::new(1.0, 0.2, 0.0))
    }

    fn surfaces() -> [Surface; 7] {
        let frame = tilted();
        [
            Surface::Cylinder(Cylinder { frame, radius: 1.3 }),
            Surface::Cone(Cone {
                frame,
                sin: 0.6,
                cos: 0.8,
            }),
            Surface::Sphere(Sphere { frame, radius: 1.3 }),
            Surface::Torus(Torus {
                frame,
                major: 2.0,
                minor: 0.6,
            }),
            Surface::EllipticCylinder(EllipticCylinder {
                frame,
                radii: [1.3, 0.4],
            }),
            Surface::EllipticCone(EllipticCone {
                frame,
                slopes: [0.75, 0.5],
            }),
            Surface::Ellipsoid(Ellipsoid::new(frame, [1.3, 0.4, 2.1])),
        ]
    }

    #[test]
    fn the_line_of_sight_touches_the_surface_along_its_limbs() {
        let sights = [
            ViewRay::Eye(Point3::new(7.0, 5.0, 3.0)),
            ViewRay::Direction(Vector3::new(0.5, -0.7, 0.2).normalize()),
        ];
        for surface in surfaces() {
            for sight in &sights {
                let limbs = limbs(&surface, sight, 1e-10, 1e-10).unwrap();
                assert!(!limbs.is_empty(), "{surface:?}");
                for limb in &limbs {
                    for k in 0..50 {
                        let t = 0.05 + 0.1 * f64::from(k);
                        let p = limb.curve.point(t);
                        let r = match sight {
                            ViewRay::Eye(e) => (p - e).normalize(),
                            ViewRay::Direction(d) => *d,
                        };
                        assert!(surface.distance(&p).abs() < 1e-12);
                        assert!(surface.normal(&p).dot(&r).abs() < 1e-12);
                        if let Some(plane) = polar_plane(&surface, sight) {
                            assert!(Surface::Plane(plane).distance(&p).abs() < 1e-12);
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn from_inside_there_is_no_limb() {
        let eye = ViewRay::Eye(tilted().point(0.1, 0.1, 1.0));
        let [cylinder, cone, sphere, _, oval, oblique, ellipsoid] = surfaces();
        for surface in &[cylinder, cone, sphere, oval, oblique, ellipsoid] {
            assert!(limbs(surface, &eye, 1e-10, 1e-10).unwrap().is_empty());
        }
        // The other nappe's solid angle gives none either.
        let eye = ViewRay::Eye(tilted().point(0.1, 0.1, -1.0));
        for surface in &[cone, oblique] {
            assert!(limbs(surface, &eye, 1e-10, 1e-10).unwrap().is_empty());
        }
    }

    #[test]
    fn an_oblique_torus_has_cusps_where_sight_runs_along_the_limb() {
        let surface = surfaces()[3];
        let Surface::Torus(torus) = surface else {
            unreachable!()
        };
        let f = torus.frame;
        let sight = ViewRay::Direction(f.vector(&Vector3::new(1.0, 0.0, -0.35)).normalize());
        let mut count = 0;
        for limb in limbs(&surface, &sight, 1e-10, 1e-10).unwrap() {
            let end = limb.curve.period().unwrap();
            for t in cusps(&torus, &sight, &limb.curve, [0.0, end], 1e-10) {
                let ViewRay::Direction(d) = sight else {
                    unreachable!()
                };
                assert!(limb.curve.tangent(t).cross(&d).norm() < 1e-6);
                count += 1;
            }
        }
        assert_eq!(count, 4);
    }
}
