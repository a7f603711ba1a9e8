//! Charts: maps of faces to the plane, where they can be triangulated.
//!
//! A plane is its own chart. A cylinder and a cone are projected along their axis, the cylinder as
//! if it widened. A sphere is projected stereographically from a point outside the face. If the
//! face has no outside, the centre is a point of the face, and a cap about it is left out. An
//! ellipsoid is the image of a sphere. A torus that reaches its axis is mapped to a sphere, latitude by
//! latitude. Any other torus is cut along a
//! parallel and a circle of the tube, the seams, and unrolled. The seams exist in the chart only, and
//! are placed away from vertices and from points where edges turn back.

use super::Accuracy;
use super::edges::{Polylines, STEEPEST, off_chord};
use crate::brep::Brep;
use crate::brep::locate::{FaceLocator, PointLocation};
use crate::brep::topology::{FaceId, Sense};
use crate::geometry::ellipsoid::Ellipsoid;
use crate::geometry::frame::Frame;
use crate::geometry::surface::{Sphere, Surface, Torus, turn};
use nalgebra::{Point2, Point3, Vector2, Vector3};
use std::f64::consts::TAU;

/// A map from a face to the plane.
#[derive(Clone, Debug)]
pub(super) enum Chart {
    /// The plane's own coordinates.
    Plane(Frame),
    /// Polar coordinates: the angle, and a radius that grows from 1 to 2 along the axis. The radii of
    /// the cross section, and the range of heights.
    Cylinder(Frame, [f64; 2], [f64; 2]),
    /// Polar coordinates: the angle, and the distance from the axis, with an elliptic cross section
    /// stretched along y to a circle. The ratio of its radii, and the height over the distance.
    Cone(Frame, f64, f64),
    /// Stereographic projection; z points to its centre. If the centre is a point of the face, a
    /// cap about it, whose angular radius is given last, is not in the chart.
    Sphere(Frame, f64, Option<f64>),
    /// Stereographic projection of the unit sphere of which an ellipsoid is the image, with axes in the
    /// ellipsoid's frame.
    Ellipsoid(Ellipsoid, Frame, Option<f64>),
    /// Angles about the axis and about the tube from the seams, in steps of the accuracy. A triangle
    /// of a good shape in the chart is as long in each direction as the curvature there permits.
    Torus(Torus, Seams),
    /// Stereographic projection of the unit sphere to which a torus that reaches its axis is mapped.
    Sheet(Torus, Frame, Option<f64>),
}

/// The angles about the axis and about the tube at which a torus is cut.
#[derive(Clone, Copy, Debug)]
pub(super) struct Seams {
    /// The two angles.
    pub at: [f64; 2],
    /// The number of steps into which each angle is divided along the other's seam.
    pub steps: [u32; 2],
    /// The length of a whole turn of each angle in the chart: the number of steps on the circle in the
    /// middle of the tube, and on the tube.
    pub round: [f64; 2],
}

impl Seams {
    /// The unit of angle `i` in the chart.
    pub fn steps_per_radian(&self, i: usize) -> f64 {
        self.round[i] / TAU
    }
}

impl Chart {
    /// The chart of a face.
    pub fn new(
        brep: &Brep,
        face: FaceId,
        lines: &Polylines,
        accuracy: &Accuracy,
        resolution: f64,
    ) -> Self {
        match *brep.surface(face) {
            Surface::Plane(s) => Self::Plane(s.frame),
            Surface::Cylinder(s) => Self::cylinder(brep, face, lines, [s.radius; 2]),
            Surface::EllipticCylinder(s) => Self::cylinder(brep, face, lines, s.radii),
            Surface::Cone(s) => Self::Cone(s.frame, 1.0, s.cos / s.sin),
            Surface::EllipticCone(s) => {
                let [a, b] = s.slopes;
                Self::Cone(s.frame, a / b, 1.0 / a)
            }
            Surface::Sphere(s) => {
                let around = Around::new(brep, face, SphericalMap::Sphere(s), lines);
                let SphereCentre { direction, cap } = around.centre(accuracy, resolution);
                Self::Sphere(Frame::about(s.frame.origin, direction), s.radius, cap)
            }
            Surface::Ellipsoid(s) => {
                let around = Around::new(brep, face, SphericalMap::Ellipsoid(s), lines);
                let SphereCentre { direction, cap } = around.centre(accuracy, resolution);
                Self::Ellipsoid(s, Frame::about(Point3::origin(), direction), cap)
            }
            Surface::Torus(s) if !s.is_ring() => {
                let around = Around::new(brep, face, SphericalMap::Sheet(s), lines);
                let SphereCentre { direction, cap } = around.centre(accuracy, resolution);
                Self::Sheet(s, Frame::about(Point3::origin(), direction), cap)
            }
            Surface::Torus(s) => {
                let at = Seams::angles(brep, face, lines);
                // The steps may be nearly half as long again close to an edge, and triangles need
                // room.
                let fine = accuracy.part(0.25);
                let steps = |radii: [f64; 2]| radii.map(|r| steps_round(r, &fine));
                let seams = Seams {
                    at,
                    steps: steps([s.major + s.minor, s.minor]),
                    round: steps([s.major, s.minor]).map(f64::from),
                };
                Self::Torus(s, seams)
            }
        }
    }

    fn cylinder(brep: &Brep, face: FaceId, lines: &Polylines, radii: [f64; 2]) -> Self {
        let frame = *brep.surface(face).frame();
        let heights = points_of(brep, face, lines).map(|p| frame.coordinates(&p).z);
        let range = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], z| {
            [lo.min(z), hi.max(z)]
        });
        Self::Cylinder(frame, radii, range)
    }

    /// The position of a point of the surface in the chart; on a torus measured from the seams.
    pub fn map(&self, p: &Point3<f64>) -> Point2<f64> {
        match self {
            Self::Plane(f) => f.coordinates(p).xy().into(),
            Self::Cone(f, ratio, _) => {
                let q = f.coordinates(p);
                Point2::new(q.x, q.y * ratio)
            }
            Self::Cylinder(f, [a, b], [lo, hi]) => {
                let q = f.coordinates(p);
                let radius = 1.0 + (q.z - lo) / (hi - lo);
                (Vector2::new(q.x, q.y * (a / b)).normalize() * radius).into()
            }
            Self::Sphere(f, radius, _) => {
                let q = f.coordinates(p) / *radius;
                (q.xy() / (1.0 - q.z)).into()
            }
            Self::Ellipsoid(s, f, _) => projected(f, &SphericalMap::Ellipsoid(*s).direction(p)),
            Self::Sheet(s, f, _) => projected(f, &SphericalMap::Sheet(*s).direction(p)),
            Self::Torus(s, seams) => {
                let [u, v] = Surface::Torus(*s).parameters(p);
                let from = |i: usize, x: f64| seams.steps_per_radian(i) * turn(x - seams.at[i]);
                Point2::new(from(0, u), from(1, v))
            }
        }
    }

    /// The point of the surface at a position in the chart.
    pub fn lift(&self, x: &Point2<f64>) -> Point3<f64> {
        match self {
            Self::Plane(f) => f.point(x.x, x.y, 0.0),
            Self::Cylinder(f, [a, b], [lo, hi]) => {
                let away = x.coords.norm();
                let on = x.coords * (a / away);
                f.point(on.x, on.y * (b / a), lo + (away - 1.0) * (hi - lo))
            }
            Self::Cone(f, ratio, slope) => f.point(x.x, x.y / ratio, x.coords.norm() * slope),
            Self::Sphere(f, radius, _) => {
                let square = x.coords.norm_squared();
                let part = 2.0 * radius / (1.0 + square);
                f.point(x.x * part, x.y * part, radius - part)
            }
            Self::Ellipsoid(s, f, _) => SphericalMap::Ellipsoid(*s).point(&unprojected(f, x)),
            Self::Sheet(s, f, _) => SphericalMap::Sheet(*s).point(&unprojected(f, x)),
            Self::Torus(s, seams) => {
                let angle = |i: usize| x[i] / seams.steps_per_radian(i) + seams.at[i];
                Surface::Torus(*s).point(angle(0), angle(1))
            }
        }
    }

    /// The positions of the upper and the lower pole of a torus that reaches its axis. Both may be
    /// one point of the surface.
    pub fn poles(&self) -> Option<[Point2<f64>; 2]> {
        match self {
            Self::Sheet(s, f, _) => Some([s.frame.z, -s.frame.z].map(|pole| projected(f, &pole))),
            _ => None,
        }
    }

    /// The point of the surface at the centre of a stereographic projection, with the angular radius of
    /// the cap about it, if there is one.
    pub fn cap(&self) -> Option<Cap> {
        let (centre, radius) = match self {
            Self::Sphere(f, radius, cap) => (f.point(0.0, 0.0, *radius), cap),
            Self::Ellipsoid(s, f, cap) => (SphericalMap::Ellipsoid(*s).point(&f.z), cap),
            Self::Sheet(s, f, cap) => (SphericalMap::Sheet(*s).point(&f.z), cap),
            Self::Plane(_) | Self::Cylinder(..) | Self::Cone(..) | Self::Torus(..) => return None,
        };
        let radius = (*radius)?;
        Some(Cap { centre, radius })
    }

    /// The point of a side, between its ends, that is closest to the middle of a chart that has
    /// one. Far from the middle a long side of the chart is a short one of the surface, close to it
    /// it is not.
    pub fn nearest_to_middle(&self, [a, b]: [Point2<f64>; 2]) -> Option<Point2<f64>> {
        let away = b - a;
        let part = -a.coords.dot(&away) / away.norm_squared();
        match self {
            Self::Plane(_) | Self::Torus(..) => None,
            _ => (part > 0.0 && part < 1.0).then(|| a + away * part),
        }
    }

    /// Whether counterclockwise in the chart is clockwise as seen from outside.
    pub fn is_mirrored(&self, outward: Sense) -> bool {
        let own = match self {
            Self::Plane(_) | Self::Torus(..) => false,
            Self::Cylinder(..)
            | Self::Cone(..)
            | Self::Sphere(..)
            | Self::Ellipsoid(..)
            | Self::Sheet(..) => true,
        };
        own != (outward == Sense::Against)
    }
}

/// All points of the divided edges of a face.
fn points_of<'a>(
    brep: &'a Brep,
    face: FaceId,
    lines: &'a Polylines,
) -> impl Iterator<Item = Point3<f64>> + 'a {
    brep.topology.edges_of(face).flat_map(|edge| {
        let nodes = lines.nodes(edge).iter();
        nodes.map(|n| lines.points[n.point as usize])
    })
}

/// The stereographic projection of a direction from the direction z.
fn projected(f: &Frame, direction: &Vector3<f64>) -> Point2<f64> {
    let q = f.components(direction);
    (q.xy() / (1.0 - q.z)).into()
}

/// The direction with a stereographic projection.
fn unprojected(f: &Frame, x: &Point2<f64>) -> Vector3<f64> {
    let part = 2.0 / (1.0 + x.coords.norm_squared());
    f.point(x.x * part, x.y * part, 1.0 - part).coords
}

/// A cap of a sphere, or of the surface of which it is the map.
pub(super) struct Cap {
    /// The point of the surface at its middle.
    pub centre: Point3<f64>,
    /// The angular radius on the sphere.
    pub radius: f64,
}

/// A surface that is projected by way of the unit sphere.
#[derive(Clone, Copy)]
enum SphericalMap {
    Sphere(Sphere),
    /// An ellipsoid, with directions in its frame.
    Ellipsoid(Ellipsoid),
    /// A torus that reaches its axis, with the poles mapped to the poles.
    Sheet(Torus),
}

impl SphericalMap {
    /// The point of the surface in a direction.
    fn point(&self, d: &Vector3<f64>) -> Point3<f64> {
        match self {
            Self::Sphere(s) => s.frame.origin + d * s.radius,
            Self::Ellipsoid(s) => s.frame.origin + s.frame.vector(&s.image(d)),
            Self::Sheet(s) => {
                let q = s.frame.components(d);
                let latitude = q.z.atan2(q.x.hypot(q.y));
                let v = latitude * (4.0 / TAU) * s.pole_angle();
                Surface::Torus(*s).point(q.y.atan2(q.x), v)
            }
        }
    }

    /// The direction to which a point close to the surface is mapped.
    fn direction(&self, p: &Point3<f64>) -> Vector3<f64> {
        match self {
            Self::Sphere(s) => (p - s.frame.origin).normalize(),
            Self::Ellipsoid(s) => s.on_unit_sphere(&s.frame.coordinates(p)).normalize(),
            Self::Sheet(s) => {
                let [u, v] = Surface::Torus(*s).parameters(p);
                let latitude = (v / s.pole_angle()).clamp(-1.0, 1.0) * (TAU / 4.0);
                let across = latitude.cos();
                let local = Vector3::new(across * u.cos(), across * u.sin(), latitude.sin());
                s.frame.vector(&local)
            }
        }
    }

    /// A radius of curvature that the surface has nowhere less than in proportion to its directions.
    fn radius(&self) -> f64 {
        match self {
            Self::Sphere(s) => s.radius,
            Self::Ellipsoid(s) => s.circumradius(),
            Self::Sheet(s) => s.reach().max(s.minor),
        }
    }

    /// Whether a cap about a direction may be flat: it must not contain a pole of a sheet.
    fn has_flat_cap(&self, d: &Vector3<f64>) -> bool {
        match self {
            Self::Sphere(_) | Self::Ellipsoid(_) => true,
            Self::Sheet(s) => s.frame.z.dot(d).abs() < 0.5,
        }
    }
}

/// The points that the centre of a face's stereographic projection must avoid.
struct Around<'a> {
    brep: &'a Brep,
    face: FaceId,
    map: SphericalMap,
    /// The chords of the face's edges.
    chords: Vec<[Point3<f64>; 2]>,
}

/// The centre of the projection of a sphere.
struct SphereCentre {
    direction: Vector3<f64>,
    /// The angular radius of a cap about a direction in the face; it contains no edge and is flat
    /// within the accuracy.
    cap: Option<f64>,
}

impl<'a> Around<'a> {
    fn new(brep: &'a Brep, face: FaceId, map: SphericalMap, lines: &Polylines) -> Self {
        let chords = brep.topology.edges_of(face).flat_map(|edge| {
            let nodes = lines.nodes(edge).windows(2);
            nodes.map(|pair| [0, 1].map(|i: usize| lines.points[pair[i].point as usize]))
        });
        Self {
            brep,
            face,
            map,
            chords: chords.collect(),
        }
    }

    /// The centre of the projection: a direction outside the face if there is one, otherwise a
    /// direction in the face with a cap.
    fn centre(&self, accuracy: &Accuracy, resolution: f64) -> SphereCentre {
        if let Some(direction) = self.outside(resolution) {
            let cap = None;
            return SphereCentre { direction, cap };
        }
        let mut flat = spread().filter(|d| self.map.has_flat_cap(d));
        let z = self.farthest(&mut flat).unwrap_or_else(Vector3::z);
        let radius = self.map.radius();
        let clear = (self.away(&z) - accuracy.deviation) / (2.0 * radius);
        let mut flat = TAU / f64::from(steps_round(radius, &accuracy.part(0.5)));
        if let SphericalMap::Sheet(_) = self.map {
            // A latitude is up to two angles about the tube.
            flat *= 0.5;
        }
        SphereCentre {
            direction: z,
            cap: Some(flat.min(clear)),
        }
    }

    /// The direction of a point of the sphere outside the face, far from the face if possible.
    fn outside(&self, resolution: f64) -> Option<Vector3<f64>> {
        if self.chords.is_empty() {
            return None;
        }
        let locator = FaceLocator::from_face(self.brep, self.face, resolution);
        let outside =
            |d: &Vector3<f64>| locator.place(&self.map.point(d)) == PointLocation::Outside;
        // Points close to the boundary, to its right, for faces that cover almost the whole sphere.
        let nearby = locator.arcs().iter().flat_map(|a| {
            let t = 0.5 * (a.range[0] + a.range[1]);
            let p = a.curve.point(t);
            let out = self.brep.outward(self.face, &p);
            let right = a.curve.tangent(t).cross(&out) * a.sense.sign::<f64>();
            let size = (a.curve.point(a.range[0]) - p).norm();
            (1..NEAREST).map(move |k| {
                let nearby = p + right * (size / f64::from(1 << k));
                self.map.direction(&nearby)
            })
        });
        self.farthest(&mut spread().filter(outside))
            .or_else(|| self.farthest(&mut nearby.filter(outside)))
    }

    /// The direction that is farthest from the edges.
    fn farthest(&self, all: &mut dyn Iterator<Item = Vector3<f64>>) -> Option<Vector3<f64>> {
        all.map(|d| (self.away(&d), d))
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, d)| d)
    }

    /// The distance of the surface's point in a direction from the edges.
    fn away(&self, d: &Vector3<f64>) -> f64 {
        let p = self.map.point(d);
        let apart = self.chords.iter().map(|[a, b]| off_chord(&p, a, b));
        apart.fold(f64::INFINITY, f64::min)
    }
}

/// Directions spread over the sphere.
fn spread() -> impl Iterator<Item = Vector3<f64>> {
    (0..SPREAD).map(|k| {
        let z = 1.0 - (2.0 * f64::from(k) + 1.0) / f64::from(SPREAD);
        let (sin, cos) = (GOLDEN * f64::from(k)).sin_cos();
        let r = (1.0 - z * z).sqrt();
        Vector3::new(r * cos, r * sin, z)
    })
}

/// The number of directions tried as the centre of a projection.
const SPREAD: u32 = 64;

/// The number of halvings of the distance, starting at an arc's length, at which points close to
/// the arc are tried.
const NEAREST: u32 = 16;

/// The golden angle, whose multiples are spread over the circle.
const GOLDEN: f64 = 2.399_963_229_728_653;

impl Seams {
    /// Angles close to the middle of the widest gaps between the vertices of a face and the nodes
    /// at which its edges turn back.
    fn angles(brep: &Brep, face: FaceId, lines: &Polylines) -> [f64; 2] {
        let surface = brep.surface(face);
        let mut turns: [Vec<f64>; 2] = [Vec::new(), Vec::new()];
        for edge in brep.topology.edges_of(face) {
            let nodes = lines.nodes(edge);
            let at: Vec<[f64; 2]> = nodes
                .iter()
                .map(|n| surface.parameters(&lines.points[n.point as usize]))
                .collect();
            for (i, turns) in turns.iter_mut().enumerate() {
                turns.extend([at[0][i], at[at.len() - 1][i]]);
                let steps: Vec<f64> = at
                    .windows(2)
                    .map(|w| signed_turn(w[1][i] - w[0][i]))
                    .collect();
                let turning = steps.windows(2).enumerate();
                turns.extend(
                    turning
                        .filter(|(_, s)| s[0] * s[1] <= 0.0)
                        .map(|(k, _)| at[k + 1][i]),
                );
            }
        }
        turns.map(|turns| widest_gap(&turns))
    }
}

/// The number of chords into which a circle of this radius is divided.
pub(super) fn steps_round(radius: f64, accuracy: &Accuracy) -> u32 {
    let sagitta = (1.0 - accuracy.deviation / radius).clamp(-1.0, 1.0);
    let step = (2.0 * sagitta.acos()).min(accuracy.angle).min(STEEPEST);
    (TAU / step).ceil() as u32
}

/// The angle modulo 2 pi, between -pi and pi.
pub(super) fn signed_turn(angle: f64) -> f64 {
    let a = turn(angle);
    if a > 0.5 * TAU { a - TAU } else { a }
}

/// The fraction of a gap at which a seam is placed: close to the middle, but not there, where
/// symmetric parts have points.
const SEAM_POSITION: f64 = 0.47;

/// The angle close to the middle of the widest gap between angles.
fn widest_gap(angles: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = angles.iter().map(|&a| turn(a)).collect();
    sorted.sort_by(f64::total_cmp);
    let Some(&first) = sorted.first() else {
        return 0.0;
    };
    sorted.push(first + TAU);
    let widest = sorted
        .windows(2)
        .max_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
    widest.map_or(0.0, |w| turn(w[0] + SEAM_POSITION * (w[1] - w[0])))
}
