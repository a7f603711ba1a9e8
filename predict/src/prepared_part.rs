//! A part, with what is needed of it in every setup.

use nalgebra::{Point3, Vector3};
use premio_kernel::brep::Brep;
use premio_kernel::brep::bounding_box;
use premio_kernel::brep::point_in_solid::contains;
use premio_kernel::brep::topology::FaceId;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::tessellation::{Accuracy, Mesh, tessellate};
use premio_visibility::camera::ViewCamera;
use premio_visibility::camera::projection::Projection;
use premio_visibility::ray_casting::{OriginIncidence, SightLine};
use premio_visibility::scene::Scene;
use std::f64::consts::PI;

/// The number of tested directions of the hemisphere, and the most points of a face.
const DIRECTIONS: usize = 64;
const POINTS: usize = 8;

/// Why a part cannot be seen at all.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SubjectError {
    /// It has no faces.
    #[error("the part is empty: there is nothing to be seen")]
    Empty,
}

/// A part, with what is needed of it in every setup.
#[derive(Clone, Debug)]
pub struct PreparedPart<'a> {
    /// Its boundary.
    pub brep: &'a Brep,
    /// Its resolution.
    pub resolution: f64,
    /// The centre of its box.
    pub centre: Point3<f64>,
    /// Half the diagonal of its box.
    pub radius: f64,
    /// By face: f, the share of the hemisphere over it that the part itself does not block,
    /// weighted by the cosine (Cook and Torrance 1982), averaged over the face.
    pub unblocked_fraction: Vec<f64>,
}

impl<'a> PreparedPart<'a> {
    /// The part with this boundary and resolution.
    ///
    /// # Errors
    /// The part has no faces.
    pub fn new(brep: &'a Brep, resolution: f64) -> Result<Self, SubjectError> {
        if brep.topology.faces.is_empty() {
            return Err(SubjectError::Empty);
        }
        let hull = bounding_box::bounds(brep);
        let mut subject = Self {
            brep,
            resolution,
            centre: hull.centre(),
            radius: 0.5 * hull.diagonal(),
            unblocked_fraction: vec![1.0; brep.topology.faces.len()],
        };
        subject.unblocked_fraction = unblocked_fraction(&subject);
        Ok(subject)
    }

    /// Whether a point is in the part's material, or on its boundary within the resolution.
    pub fn contains(&self, p: &Point3<f64>) -> bool {
        let near = (p - self.centre).norm() <= self.radius + self.resolution;
        near && contains(self.brep, p, self.resolution).unwrap_or(true)
    }
}

/// By face: the share of the hemisphere that is not blocked.
fn unblocked_fraction(subject: &PreparedPart<'_>) -> Vec<f64> {
    let count = subject.brep.topology.faces.len();
    let away = Vector3::z() * (4.0 * subject.radius);
    let eye = ViewCamera::orthographic(subject.centre + away, subject.centre, Vector3::y());
    let accuracy = Accuracy {
        deviation: subject.radius / 64.0,
        angle: PI / 8.0,
    };
    let mesh = tessellate(subject.brep, &accuracy, subject.resolution);
    // A part without a mesh, or without a finite position, counts as unblocked: the ambient term is
    // small.
    let (Ok(eye), Ok(mesh)) = (eye, mesh) else {
        return vec![1.0; count];
    };
    let projection = Projection::new(&eye, 2.0 * subject.radius);
    let scene = Scene::new(subject.brep, &projection, subject.resolution);
    let faces = subject.brep.topology.face_ids();
    faces
        .map(|face| open_part(subject, &scene, &mesh, face))
        .collect()
}

fn open_part(subject: &PreparedPart<'_>, scene: &Scene<'_>, mesh: &Mesh, face: FaceId) -> f64 {
    let points = points(mesh, face);
    let (mut open, mut all) = (0usize, 0usize);
    for p in points.iter().map(|p| subject.brep.surface(face).nearest(p)) {
        let up = Frame::about(p, subject.brep.outward(face, &p));
        for k in 0..DIRECTIONS {
            // Evenly over the disc below the hemisphere, which weighs by the cosine.
            let rho = ((k as f64 + 0.5) / DIRECTIONS as f64).sqrt();
            let (sin, cos) = (k as f64 * PI * (3.0 - 5f64.sqrt())).sin_cos();
            let direction = Vector3::new(rho * cos, rho * sin, (1.0 - rho * rho).sqrt());
            let ray = SightLine {
                origin: p,
                towards: up.vector(&direction),
                length: f64::INFINITY,
            };
            let own = |f| {
                if f == face {
                    OriginIncidence::Through
                } else {
                    OriginIncidence::No
                }
            };
            open += usize::from(!scene.is_blocked(&ray, &own));
            all += 1;
        }
    }
    if all == 0 {
        1.0
    } else {
        open as f64 / all as f64
    }
}

/// Points of a face, spread over its area: the centroids of triangles.
fn points(mesh: &Mesh, face: FaceId) -> Vec<Point3<f64>> {
    let own: Vec<(f64, Point3<f64>)> = mesh
        .triangles
        .iter()
        .filter(|t| t.face == face)
        .map(|t| {
            let [a, b, c] = t.corners.map(|k| mesh.points[k as usize]);
            let middle = Point3::from((a.coords + b.coords + c.coords) / 3.0);
            ((b - a).cross(&(c - a)).norm(), middle)
        })
        .collect();
    let total: f64 = own.iter().map(|t| t.0).sum();
    let mut chosen = Vec::new();
    let mut passed = 0.0;
    for &(area, middle) in &own {
        passed += area;
        let due = (passed / total * POINTS as f64 + 0.5).floor() as usize;
        if due > chosen.len() {
            chosen.resize(due.min(POINTS), middle);
        }
    }
    chosen.dedup();
    chosen
}
