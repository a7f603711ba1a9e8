//! Rays cast on triangles of the boundary: what lies before a contour, by a way that knows neither
//! the tree nor a formula of a surface.
//!
//! A mesh is only near to the boundary. A sample counts where the rays around it agree on what lies
//! well before it; what lies just before it leaves room in the answer; and where another contour
//! passes it in the image, the exact rays on the tree (`premio_verify::checks`) answer, not this.

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

/// How far the triangles may be off, as a part of the part's size.
const DEVIATION: f64 = 1.0 / 2000.0;

/// The greatest angle between neighbouring normals, in radians.
const ANGLE: f64 = 0.3;

/// How far next to a sample the rays run, in deviations.
const ASIDE: f64 = 3.0;

/// What a box in single precision is grown by, as a part of the size: more than its rounding.
const GROWN: f32 = 1.0 / (1 << 18) as f32;

/// Where in a piece samples are taken, as parts of its range.
const SAMPLES: [f64; 2] = [0.37, 0.71];

/// How many points of a piece are asked whether they pass near to a sample.
const POINTS: u32 = 256;

/// A boundary's triangles, to be met by rays.
pub struct Cast {
    mesh: Mesh,
    boxes: Bvh2,
    /// Which faces are plane.
    flat: Vec<bool>,
    centre: Point3<f64>,
    size: f64,
}

/// A triangle that faces the eye, met by a ray.
#[derive(Clone, Copy, Debug)]
struct Hit {
    /// How far along the ray.
    at: f64,
    /// The face it follows.
    face: FaceId,
    /// Whether that is plane: such a face does not come back over its own edge.
    flat: bool,
}

/// What a triangle that a ray meets says of the sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Means {
    /// The sample's own face, next to it.
    Itself,
    /// A face that may or may not lie before the sample.
    Unsure,
    /// A face before the sample.
    Layer,
}

/// What the samples of a view said.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Counted {
    /// How many agree.
    pub agreed: usize,
    /// How many lie too near to something for a mesh.
    pub unclear: usize,
    /// What is wrong, in words.
    pub wrong: Vec<String>,
}

impl Cast {
    /// The triangles of a boundary; none of an empty one.
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

    /// What is wrong with the mesh: it is watertight, and encloses the volume but for its distance.
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

    /// Counts what lies before the pieces of a view.
    pub fn count(&self, seen: &Contours) -> Counted {
        let projection = Projection::new(&seen.camera, self.size);
        let mut counted = Counted::default();
        for contour in &seen.contours {
            for (index, piece) in contour.pieces.iter().enumerate() {
                for part in SAMPLES {
                    match self.before(&projection, contour, piece, part) {
                        Some([least, most]) if (least..=most).contains(&piece.qi) => {
                            counted.agreed += 1;
                        }
                        Some([least, most])
                            if !self.is_passed(&projection, seen, contour, piece, part) =>
                        {
                            counted.wrong.push(format!(
                                "contour {} piece {index} over {:?}: {} for {least} to {most}",
                                contour.id, piece.t, piece.qi
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
        ASIDE * DEVIATION * self.size
    }

    /// Within this distance before a sample lies what its own faces may still be: where a ray next to
    /// a limb meets a surface as curved as the part.
    fn just_before(&self) -> f64 {
        (4.0 * self.size * self.lateral()).sqrt()
    }

    /// How many faces lie before a sample, at least and at most; none where the rays around it do
    /// not agree.
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

    /// What it means for a contour's sample that a ray next to it meets a triangle.
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

    /// Whether a contour passes a sample nearer than the mesh can tell, or its piece ends there.
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
                    let [lo, hi] = near.t;
                    let t = lo + (hi - lo) * f64::from(k) / f64::from(POINTS);
                    let q = other.curve3.point(t);
                    let own = other.id == contour.id && (q - p).norm() < 8.0 * margin;
                    let d = frame.components(&(q - p));
                    !own && d.x.hypot(d.y) < margin
                })
            })
        })
    }

    /// The triangles facing the eye that a ray meets.
    fn hits(&self, start: &Point3<f64>, towards: &Vector3<f64>, reach: f64) -> Vec<Hit> {
        let mut hits = Vec::new();
        let ray = Ray::new_inf(single((start - self.centre) / self.size), single(*towards));
        self.boxes.ray_traverse_anyhit(ray, |_, place| {
            let index = self.boxes.primitive_indices[place] as usize;
            let triangle = &self.mesh.triangles[index];
            let corners = triangle.corners.map(|c| self.mesh.points[c as usize]);
            if let Some(at) = met(start, towards, &corners)
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
    let [lo, hi] = piece.t;
    let p = contour.curve3.point(lo + part * (hi - lo));
    let (towards, reach) = projection.towards_eye(&p);
    (p, Frame::about(p, towards), reach)
}

fn single(v: Vector3<f64>) -> Vec3A {
    vec3a(v.x as f32, v.y as f32, v.z as f32)
}

/// How far along a ray a triangle is met from the side that it is run counterclockwise on (Möller
/// and Trumbore 1997).
fn met(start: &Point3<f64>, towards: &Vector3<f64>, [a, b, c]: &[Point3<f64>; 3]) -> Option<f64> {
    let (u, v) = (b - a, c - a);
    let across = towards.cross(&v);
    let determinant = u.dot(&across);
    // Seen from the start of a ray towards the eye, a triangle that faces the eye is met from behind.
    if determinant >= 0.0 {
        return None;
    }
    let away = start - a;
    let x = away.dot(&across) / determinant;
    let along = away.cross(&u);
    let y = towards.dot(&along) / determinant;
    (x >= 0.0 && y >= 0.0 && x + y <= 1.0).then(|| v.dot(&along) / determinant)
}
