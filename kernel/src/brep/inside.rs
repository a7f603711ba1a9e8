//! Whether shells hold a point: the parity of a ray's crossings.

use super::Brep;
use super::locate::{FaceLocator, Place};
use super::mass::bounds;
use super::topology::FaceId;
use crate::geometry::curve::{Curve, Line};
use crate::geometry::cut::cut;
use crate::geometry::vector::Length;
use crate::number::precision::Number;
use crate::number::roots::{Contact, Zeros};
use nalgebra::{Point3, Vector3};

/// How many rays are tried before it is left open.
const RAYS: u32 = 16;

/// Whether the solids hold a point that is not on the boundary; none where no ray from it crosses
/// faces plainly, farther than `band` from their edges.
pub fn holds<N: Number>(brep: &Brep<N>, p: &Point3<N>, band: N) -> Option<bool> {
    let faces: Vec<FaceId> = brep.topology.face_ids().collect();
    faces_hold(brep, &faces, p, band)
}

/// Whether the faces of closed shells hold a point. Rays are tried until one crosses plainly.
pub(super) fn faces_hold<N: Number>(
    brep: &Brep<N>,
    faces: &[FaceId],
    p: &Point3<N>,
    band: N,
) -> Option<bool> {
    // Beyond the box there is nothing to cross.
    let around = bounds(brep);
    let away = (around.centre().map(N::of) - p).length();
    let length = N::TWO * (away + N::of(around.diagonal()));
    let crossings = (0..RAYS).find_map(|k| {
        let line = Line {
            origin: *p,
            direction: towards(k),
        };
        crossings(brep, faces, (&line, length), band)
    });
    crossings.map(|count| count % 2 == 1)
}

/// The direction of the k-th ray: none along an axis or a common diagonal.
fn towards<N: Number>(k: u32) -> Vector3<N> {
    let a = N::of(0.61) + N::of(2.4) * N::whole(k);
    let rise = N::of(0.37) - N::of(0.21) * N::whole(k % 5);
    Vector3::new(a.cos(), a.sin(), rise).unit()
}

/// How often a ray of this length crosses the faces; none where that is unclear.
fn crossings<N: Number>(
    brep: &Brep<N>,
    faces: &[FaceId],
    (line, length): (&Line<N>, N),
    band: N,
) -> Option<u32> {
    let mut count = 0;
    let curve = Curve::Line(*line);
    for &face in faces {
        let Zeros::At { roots, .. } = cut(&curve, [N::ZERO, length], brep.surface(face), band)
        else {
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
