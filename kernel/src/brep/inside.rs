//! Whether a shell holds a point: the parity of a ray's crossings.

use super::Brep;
use super::locate::{FaceLocator, Place};
use super::topology::FaceId;
use crate::geometry::curve::{Curve, Line};
use crate::geometry::cut::cut;
use crate::number::roots::{Contact, Zeros};
use nalgebra::{Point3, Vector3};

/// Whether the faces of a closed shell hold a point that is not on them. Rays are tried until one
/// crosses plainly.
pub(super) fn shell_holds(brep: &Brep, faces: &[FaceId], p: &Point3<f64>, band: f64) -> bool {
    for k in 0..16 {
        let a = 0.61 + 2.4 * f64::from(k);
        let direction = Vector3::new(a.cos(), a.sin(), 0.37 - 0.21 * f64::from(k % 5)).normalize();
        if let Some(count) = crossings(
            brep,
            faces,
            &Line {
                origin: *p,
                direction,
            },
            band,
        ) {
            return count % 2 == 1;
        }
    }
    false
}

/// How often the ray from the line's origin crosses the faces; none where that is unclear.
fn crossings(brep: &Brep, faces: &[FaceId], line: &Line, band: f64) -> Option<u32> {
    let mut count = 0;
    let curve = Curve::Line(*line);
    let reach = brep
        .geometry
        .points
        .iter()
        .map(|q| (q - line.origin).norm());
    let arcs = brep
        .topology
        .edge_ids()
        .map(|e| (brep.curve(e).point(brep.range(e)[0]) - line.origin).norm());
    let sizes = brep
        .geometry
        .surfaces
        .iter()
        .map(|s| (s.frame().origin - line.origin).norm());
    let far = 4.0 * reach.chain(arcs).chain(sizes).fold(1.0, f64::max);
    for &face in faces {
        let Zeros::At { roots, .. } = cut(&curve, [0.0, far], brep.surface(face), band) else {
            return None;
        };
        if roots.is_empty() {
            continue;
        }
        let locator = FaceLocator::of(brep, face, band);
        for root in roots {
            match locator.place(&curve.point(root.t)) {
                Place::Outside => {}
                Place::Inside if root.contact == Contact::Simple => count += 1,
                _ => return None,
            }
        }
    }
    Some(count)
}
