//! Casts rays on triangles of the boundary to count the faces in front of a contour. The method
//! uses neither the tree nor a formula of a surface.
//!
//! A mesh only approximates the boundary. A sample counts if the rays around it agree on the faces
//! well in front of it. Faces just in front of it make the answer a range. Where another contour
//! passes the sample in the image, the exact rays on the tree (`premio_verify::checks`) decide in
//! place of this method.

use glam::{Vec3A, vec3a};
use nalgebra::{Point3, Vector3};
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::ray::Ray;
use premio_csg::evaluate::Evaluation;
use premio_kernel::brep::topology::FaceId;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::SurfaceKind;
use premio_kernel::tessellation::{Accuracy, Mesh, TessellationError, Triangle, tessellate};
use premio_visibility::Contours;
use premio_visibility::camera::projection::Projection;
use premio_visibility::contours::{Contour, ContourPiece};
use std::f64::consts::TAU;
use std::time::Duration;

/// The deviation of the triangles, relative to the part's size.
const DEVIATION: f64 = 1.0 / 2000.0;

/// The greatest angle between neighbouring normals, in radians.
const ANGLE: f64 = 0.3;

/// The lateral distance of the rays from a sample, in deviations.
const LATERAL: f64 = 3.0;

/// The enlargement of a box in single precision, relative to the size: more than its rounding.
const GROWN: f32 = 1.0 / (1 << 18) as f32;

/// The fractions of a piece's range at which samples are taken.
const SAMPLES: [f64; 2] = [0.37, 0.71];

/// The number of points of a piece that are tested for passing close to a sample.
const POINTS: u32 = 256;

/// A boundary's triangles, prepared for ray casting.
pub struct Cast {
    mesh: Mesh,
    boxes: Bvh2,
    /// Whether each face is planar.
    flat: Vec<bool>,
    centre: Point3<f64>,
    size: f64,
}

/// The hit of a ray on a triangle that faces the eye.
#[derive(Clone, Copy, Debug)]
struct Hit {
    /// The distance along the ray.
    at: f64,
    /// The face that it approximates.
    face: FaceId,
    /// Whether that face is planar: a planar face does not curve back over its own edge.
    flat: bool,
}

/// The meaning of a hit for a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Means {
    /// The sample's own face, next to it.
    Itself,
    /// A face that may or may not be in front of the sample.
    Unsure,
    /// A face in front of the sample.
    Layer,
}

/// The result for the samples of a view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counted {
    /// The number of samples that agree.
    pub agreed: usize,
    /// The number of samples too close to something for a mesh.
    pub unclear: usize,
    /// Descriptions of what is wrong.
    pub wrong: Vec<String>,
}

impl Cast {
    /// The triangles of a boundary; none if it is empty.
    ///
    /// # Errors
    /// The boundary cannot be tessellated.
    pub fn new(evaluation: &Evaluation) -> Result<Self, TessellationError> {
        let size = evaluation.bounds.diagonal();
        let accuracy = Accuracy {
            deviation: DEVIATION * size,
            angle: ANGLE,
        };
        let mesh = tessellate(&evaluation.brep, &accuracy, evaluation.resolution)?;
        let centre = evaluation.bounds.centre();
        let single = |p: &Point3<f64>| single((p - centre) / size);
        let box_of = |t: &Triangle| {
            let corners = t.corners.map(|c| single(&mesh.points[c as usize]));
            let grown = Vec3A::splat(GROWN);
            Aabb::new(
                corners[0].min(corners[1]).min(corners[2]) - grown,
                corners[0].max(corners[1]).max(corners[2]) + grown,
            )
        };
        let boxes: Vec<Aabb> = mesh.triangles.iter().map(box_of).collect();
        let mut took = Duration::ZERO;
        let boxes = build_bvh2(&boxes, BvhBuildParams::fast_build(), &mut took);
        let brep = &evaluation.brep;
        let flat = brep.topology.face_ids();
        let flat = flat.map(|f| brep.surface(f).kind() == SurfaceKind::Plane);
        Ok(Self {
            flat: flat.collect(),
            boxes,
            centre,
            size,
            mesh,
        })
    }

    /// The faults of the mesh: it must be watertight, and its volume must be that of the boundary
    /// up to the deviation.
    pub fn faults(&self, evaluation: &Evaluation) -> Option<String> {
        let exact = evaluation.mass();
        let volume = self.mesh.volume();
        if !self.mesh.is_watertight() {
            return Some("mesh: not watertight".to_owned());
        }
        let off = (volume - exact.volume).abs();
        let room = exact.area * DEVIATION * self.size;
        (off.is_nan() || off > room).then(|| {
            format!(
                "mesh: volume {volume} for {} (within {room:e})",
                exact.volume
            )
        })
    }

    /// Counts the faces in front of the pieces of a view.
    pub fn count(&self, seen: &Contours) -> Counted {
        let projection = Projection::new(&seen.camera, self.size);
        let mut counted = Counted::default();
        for contour in &seen.contours {
            for (index, piece) in contour.pieces.iter().enumerate() {
                for part in SAMPLES {
                    match self.before(&projection, contour, piece, part) {
                        Some([least, most])
                            if (least..=most).contains(&piece.quantitative_invisibility) =>
                        {
                            counted.agreed += 1;
                        }
                        Some([least, most])
                            if !self.is_passed(&projection, seen, contour, piece, part) =>
                        {
                            counted.wrong.push(format!(
                                "contour {} piece {index} over {:?}: {} for {least} to {most}",
                                contour.id, piece.range, piece.quantitative_invisibility
                            ));
                        }
                        _ => counted.unclear += 1,
                    }
                }
            }
        }
        counted
    }

    fn lateral(&self) -> f64 {
        LATERAL * DEVIATION * self.size
    }

    /// The distance in front of a sample within which a hit may be on the sample's own faces: where
    /// a ray close to a limb hits a surface as curved as the part.
    fn just_before(&self) -> f64 {
        (4.0 * self.size * self.lateral()).sqrt()
    }

    /// The least and the greatest number of faces in front of a sample; `None` if the rays around
    /// it disagree.
    fn before(
        &self,
        projection: &Projection,
        contour: &Contour,
        piece: &ContourPiece,
        part: f64,
    ) -> Option<[u32; 2]> {
        let (p, frame, reach) = sample(projection, contour, piece, part);
        let rays = (0..4).map(|k| {
            let (sin, cos) = (0.3 + 0.25 * TAU * f64::from(k)).sin_cos();
            let start = p + (frame.x * cos + frame.y * sin) * self.lateral();
            let hits = self.hits(&start, &frame.z, reach);
            let found = |means: Means| {
                let of = hits.iter().filter(|hit| self.means(contour, hit) == means);
                of.count() as u32
            };
            [found(Means::Layer), found(Means::Unsure)]
        });
        let rays: Vec<[u32; 2]> = rays.collect();
        let layers = rays[0][0];
        let unsure = rays.iter().map(|r| r[1]).max()?;
        let agreed = rays.iter().all(|r| r[0] == layers);
        agreed.then_some([layers, layers + unsure])
    }

    /// The meaning of a hit close to a contour's sample.
    fn means(&self, contour: &Contour, hit: &Hit) -> Means {
        let own = contour.faces.contains(&hit.face);
        if own && (hit.flat || hit.at <= 4.0 * self.lateral()) {
            Means::Itself
        } else if hit.at <= self.just_before() {
            Means::Unsure
        } else {
            Means::Layer
        }
    }

    /// Whether a contour passes a sample closer than the mesh resolves, or the sample's piece ends
    /// there.
    fn is_passed(
        &self,
        projection: &Projection,
        seen: &Contours,
        contour: &Contour,
        piece: &ContourPiece,
        part: f64,
    ) -> bool {
        let (p, frame, _) = sample(projection, contour, piece, part);
        let margin = 3.0 * self.lateral();
        seen.contours.iter().any(|other| {
            other.pieces.iter().any(|near| {
                (0..=POINTS).any(|k| {
                    let [lo, hi] = near.range;
                    let t = lo + (hi - lo) * f64::from(k) / f64::from(POINTS);
                    let q = other.space_curve.point(t);
                    let own = other.id == contour.id && (q - p).norm() < 8.0 * margin;
                    let d = frame.components(&(q - p));
                    !own && d.x.hypot(d.y) < margin
                })
            })
        })
    }

    /// The triangles facing the eye that a ray hits.
    fn hits(&self, start: &Point3<f64>, towards: &Vector3<f64>, reach: f64) -> Vec<Hit> {
        let mut hits = Vec::new();
        let ray = Ray::new_inf(single((start - self.centre) / self.size), single(*towards));
        self.boxes.ray_traverse_anyhit(ray, |_, place| {
            let index = self.boxes.primitive_indices[place] as usize;
            let triangle = &self.mesh.triangles[index];
            let corners = triangle.corners.map(|c| self.mesh.points[c as usize]);
            if let Some(at) = hit_distance(start, towards, &corners)
                && at > 0.0
                && at < reach
            {
                let face = triangle.face;
                let flat = self.flat[face.index()];
                hits.push(Hit { at, face, flat });
            }
        });
        hits
    }
}

/// A point of a piece, a frame whose z axis points to the eye, and the distance to it.
fn sample(
    projection: &Projection,
    contour: &Contour,
    piece: &ContourPiece,
    part: f64,
) -> (Point3<f64>, Frame, f64) {
    let [lo, hi] = piece.range;
    let p = contour.space_curve.point(lo + part * (hi - lo));
    let eye = projection.towards_eye(&p);
    (p, Frame::about(p, eye.direction), eye.distance)
}

fn single(v: Vector3<f64>) -> Vec3A {
    vec3a(v.x as f32, v.y as f32, v.z as f32)
}

/// The distance along a ray at which it hits a triangle from the side on which the triangle is
/// counterclockwise (Möller and Trumbore 1997).
fn hit_distance(
    start: &Point3<f64>,
    towards: &Vector3<f64>,
    [a, b, c]: &[Point3<f64>; 3],
) -> Option<f64> {
    let (u, v) = (b - a, c - a);
    let across = towards.cross(&v);
    let determinant = u.dot(&across);
    // As seen from the start of a ray towards the eye, a triangle that faces the eye is hit from
    // behind.
    if determinant >= 0.0 {
        return None;
    }
    let away = start - a;
    let x = away.dot(&across) / determinant;
    let along = away.cross(&u);
    let y = towards.dot(&along) / determinant;
    (x >= 0.0 && y >= 0.0 && x + y <= 1.0).then(|| v.dot(&along) / determinant)
}
