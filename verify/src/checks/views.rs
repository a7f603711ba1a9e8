//! Cameras around a part.

use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::bounds::Aabb;
use premio_visibility::ViewCamera;
use std::f64::consts::{PI, SQRT_2};

/// A camera with a name for messages.
#[derive(Clone, Debug)]
pub struct CheckedView {
    /// The name in messages.
    pub name: String,
    /// The camera.
    pub camera: ViewCamera,
}

/// The number of perspective views in general position.
const PERSPECTIVE: usize = 8;

/// The number of orthographic views.
const ORTHOGRAPHIC: usize = 2;

/// Eight perspective and two orthographic views in general position, and one along each axis. Empty
/// for an empty box.
pub fn around(bounds: &Aabb) -> Vec<CheckedView> {
    let size = bounds.diagonal();
    if !size.is_finite() || size <= 0.0 {
        return Vec::new();
    }
    let centre = bounds.centre();
    let perspective = (0..PERSPECTIVE).filter_map(|k| {
        let distance = size * (0.8 + 0.3 * k as f64);
        let eye = centre + general(k, PERSPECTIVE) * distance;
        let camera = ViewCamera::perspective(eye, aim(&centre, size, k), Vector3::z(), 1.0).ok()?;
        Some(view(format!("perspective {}", k + 1), camera))
    });
    let orthographic = (0..ORTHOGRAPHIC).filter_map(|k| {
        let eye = centre + general(2 * k + 1, 2 * ORTHOGRAPHIC + 1) * size;
        let camera = ViewCamera::orthographic(eye, centre, Vector3::z()).ok()?;
        Some(view(format!("orthographic {}", k + 1), camera))
    });
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let along = axes.iter().zip(["x", "y", "z"]).filter_map(|(axis, name)| {
        let camera = ViewCamera::orthographic(centre + axis * size, centre, Vector3::z()).ok()?;
        Some(view(format!("along {name}"), camera))
    });
    perspective.chain(orthographic).chain(along).collect()
}

fn view(name: String, camera: ViewCamera) -> CheckedView {
    CheckedView { name, camera }
}

/// The k-th of n unit directions spread over the sphere. None is parallel to an axis or to a plane
/// of a common rotation.
fn general(k: usize, n: usize) -> Vector3<f64> {
    let z = 1.0 - (2.0 * k as f64 + SQRT_2 / 2.0) / (n as f64 + 0.5);
    let (sin, cos) = (1.0 + PI * SQRT_2 * k as f64).sin_cos();
    let r = (1.0 - z * z).max(0.0).sqrt();
    Vector3::new(r * cos, r * sin, z).normalize()
}

/// A target close to the centre, but not at it.
fn aim(centre: &Point3<f64>, size: f64, k: usize) -> Point3<f64> {
    centre + general(k + 3, PERSPECTIVE + 3) * (0.03 * size)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_are_views_of_every_box_with_a_size() {
        let unit = Aabb {
            min: [0.0; 3],
            max: [1.0, 2.0, 3.0],
        };
        assert_eq!(around(&unit).len(), 13);
        assert!(around(&Aabb::EMPTY).is_empty());
    }
}
