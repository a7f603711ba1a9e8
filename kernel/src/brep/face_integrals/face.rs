//! The moments of a face.

use super::density::{Density, add};
use super::ground::{Ground, Middle};
use super::outline::boundary_sum;
use super::pole_turns::{is_pole, pole_turns};
use super::{Amid, Moments};
use crate::brep::Brep;
use crate::brep::arcs::Arcs;
use crate::brep::locate::{FaceLocator, PointLocation};
use crate::brep::surface_path::{DirectedArc, SurfacePath};
use crate::brep::topology::{CoedgeId, FaceId, Sense};
use crate::geometry::curve_plane::plane_roots;
use crate::geometry::ellipsoid::Ellipsoid;
use crate::geometry::elliptic_surface::EllipticCylinder;
use crate::geometry::frame::Frame;
use crate::geometry::surface::{Cylinder, Plane, Sphere, Surface, Torus};
use crate::geometry::vector::{Length, rounded};
use crate::number::float::Float;
use crate::number::predicates::Compare;
use nalgebra::{Point3, Vector3};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_4, PI, TAU};

/// The moments of a face, and the defect of its boundary's closure.
pub(super) struct FaceSum<N: Float> {
    pub moments: Moments<N>,
    /// In radians, or relative to the part's size on a plane.
    pub defect: N,
}

/// The moments of a face.
pub(super) fn face_sum<N: Float>(brep: &Brep<N>, face: FaceId, amid: &Amid<N>) -> FaceSum<N> {
    let coedges: Vec<CoedgeId> = brep.topology.coedges_of(face).collect();
    let surface = convenient(brep, brep.surface(face), &coedges, &amid.reference);
    let (base, middle) = match &surface {
        Surface::Plane(_)
        | Surface::Cylinder(_)
        | Surface::Cone(_)
        | Surface::EllipticCylinder(_)
        | Surface::EllipticCone(_) => (N::ZERO, N::ZERO),
        Surface::Sphere(_) | Surface::Ellipsoid(_) => (-N::PI / N::TWO, N::ZERO),
        Surface::Torus(t) if t.is_ring() => (-N::PI, opposite_parallel(brep, t, &coedges)),
        Surface::Torus(t) => (-t.pole_angle(), N::ZERO),
    };
    let ground = Ground {
        surface,
        reference: amid.reference,
        base,
        middle: Middle::at(middle),
    };
    let d = Density {
        rounded_f64: amid.tells_in_doubles().then(|| ground.to_f64()),
        ground,
        amid,
        floor: amid.floor(brep, face),
        defect: Cell::new(N::ZERO),
    };
    let moments = match &surface {
        Surface::Plane(_)
        | Surface::Cylinder(_)
        | Surface::Cone(_)
        | Surface::EllipticCylinder(_)
        | Surface::EllipticCone(_) => boundary_sum(brep, face, &d, &|_| Vec::new()),
        Surface::Sphere(_) | Surface::Ellipsoid(_) => {
            let sum = boundary_sum(brep, face, &d, &|_| Vec::new());
            let whole = d.between(base, N::PI / N::TWO);
            let opposite = d.ground.surface.point(N::ZERO, N::PI / N::TWO);
            let holds = holds_far(brep, face, amid, sum[0] / whole[0], &opposite);
            with_far(sum, whole, holds)
        }
        Surface::Torus(t) if t.is_ring() => torus_moments(brep, face, &coedges, t, &d),
        Surface::Torus(t) => {
            let sum = boundary_sum(brep, face, &d, &|_| Vec::new());
            let whole = d.between(base, -base);
            let turns = pole_turns(brep, &surface, &coedges, brep.sense(face));
            let passes_upper = turns.iter().any(|turn| turn.v.is_above_zero());
            let part = sum[0] / whole[0];
            let holds = match passes_upper {
                true => Some(false),
                false => holds_far(brep, face, amid, part, &far_point(brep, &coedges, t)),
            };
            with_far(sum, whole, holds)
        }
    };
    FaceSum {
        moments,
        defect: d.defect.get(),
    }
}

/// The surface in a frame suitable for integration. Its origin is close to the reference where it
/// is arbitrary, so that a thin strip is no difference of large coordinates. Its poles are away
/// from the edges.
fn convenient<N: Float>(
    brep: &Brep<N>,
    surface: &Surface<N>,
    coedges: &[CoedgeId],
    reference: &Point3<N>,
) -> Surface<N> {
    let next_to_reference = |f: &Frame<N>, axes: &[Vector3<N>]| {
        let along = |axis: &Vector3<N>| axis * axis.dot(&(reference - f.origin));
        f.at(axes.iter().fold(f.origin, |o, axis| o + along(axis)))
    };
    match *surface {
        Surface::Plane(s) => {
            let frame = next_to_reference(&s.frame, &[s.frame.x, s.frame.y]);
            Surface::Plane(Plane { frame })
        }
        Surface::Cylinder(s) => {
            let frame = next_to_reference(&s.frame, &[s.frame.z]);
            Surface::Cylinder(Cylinder { frame, ..s })
        }
        Surface::EllipticCylinder(s) => {
            let frame = next_to_reference(&s.frame, &[s.frame.z]);
            Surface::EllipticCylinder(EllipticCylinder { frame, ..s })
        }
        Surface::Sphere(s) => {
            let frame = clear_axis(brep, &s, coedges);
            Surface::Sphere(Sphere { frame, ..s })
        }
        Surface::Ellipsoid(s) => Surface::Ellipsoid(clear_ellipsoid(brep, &s, coedges)),
        other @ (Surface::Cone(_) | Surface::Torus(_) | Surface::EllipticCone(_)) => other,
    }
}

/// Whether a face of a closed surface contains the point farthest from the base, which no edge
/// comes close to. The boundary sum is the face's area, or that less the whole surface, so its sign
/// decides. If it is close to zero, paths on the surface decide.
fn holds_far<N: Float>(
    brep: &Brep<N>,
    face: FaceId,
    amid: &Amid<N>,
    part: N,
    far: &Point3<N>,
) -> Option<bool> {
    if brep.topology.face(face).loops.is_empty() {
        return Some(true);
    }
    if part.abs().is_beyond(N::from_f64(FEW) * amid.part()) {
        return Some(part.is_below_zero());
    }
    match FaceLocator::by_gaps(brep, face, amid.size).place(far) {
        PointLocation::Inside => Some(true),
        PointLocation::Outside => Some(false),
        PointLocation::On => None,
    }
}

/// The upper pole of a torus that reaches its axis. Of a horn torus, whose poles are one point, it is a
/// point between all edges and the upper pole.
fn far_point<N: Float>(brep: &Brep<N>, coedges: &[CoedgeId], torus: &Torus<N>) -> Point3<N> {
    let surface = Surface::Torus(*torus);
    let pole = torus.pole_angle();
    if !torus.is_horn() {
        return surface.point(N::ZERO, pole);
    }
    let rounded = torus.to_f64();
    let points = samples(brep, coedges).into_iter();
    // At the pole the angle about the tube is not defined.
    let away = points.filter(|p| !is_pole(&rounded, p));
    let angles = away.map(|p| Surface::Torus(rounded).parameters(&p)[1]);
    let uppermost = angles.reduce(f64::max).unwrap_or(0.0);
    surface.point(N::ZERO, N::HALF * (N::from_f64(uppermost) + pole))
}

/// The multiple of rounding, relative to the whole surface, below which the sign of an area may be
/// rounding.
const FEW: f64 = 256.0;

/// Points on the edges of a face, in f64.
fn samples<N: Float>(brep: &Brep<N>, coedges: &[CoedgeId]) -> Vec<Point3<f64>> {
    let of_edge = |&c: &CoedgeId| {
        let edge = brep.topology.coedge(c).edge;
        let curve = brep.curve(edge).to_f64();
        let [lo, hi] = brep.range(edge).map(N::rounded);
        (0..=SAMPLES).map(move |i| curve.point(lo + (hi - lo) * f64::from(i) / f64::from(SAMPLES)))
    };
    coedges.iter().flat_map(of_edge).collect()
}

/// The number of pieces into which an edge is divided for its sample points.
const SAMPLES: u32 = 16;

/// The number of candidates for cutting a face's surface open.
const WAYS: u32 = 12;

/// The first candidate with the greatest distance from the points of a face's edges.
fn clearest<T>(ways: impl Iterator<Item = T>, clearance: impl Fn(&T) -> f64) -> Option<T> {
    let ways = ways.map(|way| (clearance(&way), way));
    let best = ways.reduce(|best, other| match other.0.is_beyond(best.0) {
        true => other,
        false => best,
    });
    best.map(|(_, way)| way)
}

/// A frame of a sphere whose poles are away from the edges.
fn clear_axis<N: Float>(brep: &Brep<N>, s: &Sphere<N>, coedges: &[CoedgeId]) -> Frame<N> {
    let o: Point3<f64> = rounded(&s.frame.origin).into();
    let directions = samples(brep, coedges).into_iter().map(|p| (p - o).unit());
    match clear_direction(&directions.collect::<Vec<_>>()) {
        Some(axis) => Frame::about(s.frame.origin, axis.map(N::from_f64).unit()),
        None => s.frame,
    }
}

/// An ellipsoid whose parameters have their poles away from the edges.
fn clear_ellipsoid<N: Float>(
    brep: &Brep<N>,
    s: &Ellipsoid<N>,
    coedges: &[CoedgeId],
) -> Ellipsoid<N> {
    let Surface::Ellipsoid(rounded) = Surface::Ellipsoid(*s).to_f64() else {
        return *s;
    };
    let direction = |p: Point3<f64>| {
        let local = rounded.frame.coordinates(&p);
        rounded.on_unit_sphere(&local).unit()
    };
    let directions = samples(brep, coedges).into_iter().map(direction);
    match clear_direction(&directions.collect::<Vec<_>>()) {
        Some(axis) => s.about(axis.map(N::from_f64).unit()),
        None => *s,
    }
}

/// A direction far from the given ones and from their opposites.
fn clear_direction(directions: &[Vector3<f64>]) -> Option<Vector3<f64>> {
    let axes = (0..WAYS).map(|k| {
        let (z, a) = (
            1.0 - f64::from(2 * k + 1) / f64::from(2 * WAYS),
            2.4 * f64::from(k) + 0.3,
        );
        let across = (1.0 - z * z).sqrt();
        Vector3::new(across * a.cos(), across * a.sin(), z)
    });
    let clearance = |axis: &Vector3<f64>| {
        let sines = directions.iter().map(|d| d.cross(axis).length());
        sines.fold(1.0, f64::min)
    };
    clearest(axes, clearance)
}

/// The v opposite to a parallel of a torus that is away from the edges, if there is one. It avoids
/// the top and the bottom, where the parallel's plane is tangent to the torus, unless all edges are
/// on the other side.
fn opposite_parallel<N: Float>(brep: &Brep<N>, t: &Torus<N>, coedges: &[CoedgeId]) -> N {
    let torus = Surface::Torus(*t).to_f64();
    let points = samples(brep, coedges).into_iter();
    let angles: Vec<f64> = points.map(|p| torus.parameters(&p)[1]).collect();
    let near = |v: f64| {
        let off = angles.iter().map(|a| (a - v + PI).rem_euclid(TAU) - PI);
        off.map(f64::abs).fold(0.0, f64::max)
    };
    if let Some(&amid) = angles.get(angles.len() / 2)
        && near(amid).is_short_of(FRAC_PI_4)
    {
        return N::from_f64(amid);
    }
    let step = TAU / f64::from(WAYS);
    let opposites = (0..WAYS).map(|k| step * (f64::from(k) + 0.2));
    let clearance = |v: &f64| {
        let off = angles.iter().map(|a| (a - v).rem_euclid(TAU) - PI);
        off.map(f64::abs).fold(PI, f64::min)
    };
    N::from_f64(clearest(opposites, clearance).unwrap_or(step))
}

/// The moments of a face of a torus, which is cut open along the parallel of its base. The part of
/// that parallel inside the face is part of the boundary of the opened face.
fn torus_moments<N: Float>(
    brep: &Brep<N>,
    face: FaceId,
    coedges: &[CoedgeId],
    t: &Torus<N>,
    d: &Density<'_, N>,
) -> Moments<N> {
    let side = brep.sense(face).sign::<N>();
    let base = d.ground.base;
    let Some(roots) = opening_passes(brep, coedges, t, d) else {
        return [N::NAN; 5];
    };
    let cos = (d.ground.middle.angle + base).cos();
    let mut sum = boundary_sum(brep, face, d, &|c| {
        roots.get(&c).cloned().unwrap_or_default()
    });
    // The u at which edges cross the parallel, with 1 if the face lies ahead and −1 if it lies
    // behind.
    let mut passes: Vec<(N, N)> = Vec::new();
    for (&c, at) in &roots {
        let coedge = brep.topology.coedge(c);
        let curve = brep.curve(coedge.edge);
        for &s in at {
            let [u, _] = d.ground.parameters(&curve.point(s));
            let rise = curve.derivative(s).dot(&t.frame.z) * cos;
            let up = rise * side * coedge.sense.sign::<N>();
            passes.push((u, if up.is_above_zero() { -N::ONE } else { N::ONE }));
        }
    }
    let along = [base, base + N::TAU];
    // The parts ahead of each crossing are summed up to one of them, modulo whole turns. This needs
    // no order of the crossings, which is undefined for edges with the face on both sides.
    if let Some(&(first, _)) = passes.first() {
        for &(u, sign) in &passes {
            sum = add(sum, d.over([u, first], along).map(|m| m * sign));
        }
        let turns: N = passes.iter().map(|&(_, sign)| sign).sum();
        if !turns.is_exactly(N::ZERO) {
            // A crossing was missed; the result is unknown.
            return [N::NAN; 5];
        }
    }
    let whole = d.between(along[0], along[1]);
    let u = amid_gap(passes.iter().map(|&(u, _)| u).collect());
    let far = d.ground.surface.point(u, d.ground.middle.angle + base);
    let holds = holds_far(brep, face, d.amid, sum[0] / whole[0], &far);
    with_far(sum, whole, holds)
}

/// The boundary sum of a face of a closed surface, plus the whole surface if the face contains the
/// far point. NaN if that is unknown.
fn with_far<N: Float>(sum: Moments<N>, whole: Moments<N>, holds: Option<bool>) -> Moments<N> {
    match holds {
        Some(true) => add(sum, whole),
        Some(false) => sum,
        None => [N::NAN; 5],
    }
}

/// The crossings of a torus's face's edges with the parallel at which it is opened, as parameters
/// by coedge; `None` if one is not clearly transversal.
fn opening_passes<N: Float>(
    brep: &Brep<N>,
    coedges: &[CoedgeId],
    t: &Torus<N>,
    d: &Density<'_, N>,
) -> Option<BTreeMap<CoedgeId, Vec<N>>> {
    let angle = d.ground.middle.angle + d.ground.base;
    let Middle { sin, cos, .. } = Middle::at(angle);
    let frame = t.frame.at(t.frame.origin + t.frame.z * (t.minor * sin));
    let plane = Plane { frame };
    let start = d.ground.surface.point(N::ZERO, angle);
    let opening = SurfacePath::parallel(&d.ground.surface, &start, Sense::Along, N::ZERO)?;
    let directed = coedges.iter().map(|&c| DirectedArc::new(brep, c));
    let arcs = Arcs::new(directed.collect(), N::ZERO);
    // The plane intersects the torus in a second parallel, too, on which most edges may lie. Such
    // edges are distinguished from it by the finest resolution.
    let resolution = N::from_f64(N::FINEST_RESOLUTION) * d.amid.size;
    let mut passes: BTreeMap<CoedgeId, Vec<N>> = BTreeMap::new();
    let mut all_cross = true;
    for (i, &c) in coedges.iter().enumerate() {
        let curve = arcs.all[i].curve;
        for range in arcs.ranges(&opening, i, N::ZERO) {
            plane_roots(curve, range, &plane, resolution, &mut |s, crosses| {
                let q = t.frame.coordinates(&curve.point(s));
                let outward = (q.x.hypot(q.y) - t.major) * cos;
                if outward.is_above_zero() {
                    all_cross &= crosses;
                    passes.entry(c).or_default().push(s);
                }
            });
        }
    }
    all_cross.then_some(passes)
}

/// An angle in the middle of the widest gap between angles.
fn amid_gap<N: Float>(mut angles: Vec<N>) -> N {
    angles.sort_by(N::total_cmp);
    let Some(&first) = angles.first() else {
        return N::ZERO;
    };
    angles.push(first + N::TAU);
    let gaps = angles.windows(2).map(|w| (w[0], w[1] - w[0]));
    let widest = gaps.reduce(|best, gap| match gap.1.is_beyond(best.1) {
        true => gap,
        false => best,
    });
    widest.map_or(N::ZERO, |(from, gap)| from + N::HALF * gap)
}
