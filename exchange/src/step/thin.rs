//! Edges, faces and walls that are too thin for other kernels, whose vertices and edges have a width.

use super::StepError;
use nalgebra::Point3;
use premio_kernel::brep::Brep;
use premio_kernel::brep::mass::Measures;
use premio_kernel::brep::topology::ShellId;
use premio_kernel::geometry::curve::Curve;
use premio_kernel::unit::Unit;
use std::fmt;

/// What is no farther apart other kernels take for one, in millimetres (Open CASCADE's
/// `Precision::Confusion`).
const APART: f64 = 1.0 / 10_000_000.0;
/// An edge is as long as a polyline of so many sides, for the purpose.
const SIDES: u32 = 16;

/// A part of a boundary that is thin.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Thin {
    /// An edge is short.
    Edge,
    /// A face is narrow.
    Face,
    /// The two sides of a shell are next to each other.
    Shell,
}

impl fmt::Display for Thin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Edge => "an edge as short",
            Self::Face => "a face as narrow",
            Self::Shell => "a wall or gap as thin",
        })
    }
}

/// That nothing in a boundary is as thin as other kernels take points to be wide.
pub(super) fn check(brep: &Brep, unit: Unit) -> Result<(), StepError> {
    let least = APART / unit.millimetres();
    let thin = |what: Thin, place: Point3<f64>, size: f64| StepError::Thin {
        what,
        place: place.into(),
        size,
        least,
    };
    let topology = &brep.topology;
    let start = |edge| brep.curve(edge).point(brep.range(edge)[0]);
    let lengths: Vec<f64> = topology
        .edge_ids()
        .map(|e| length(brep.curve(e), brep.range(e)))
        .collect();
    for (edge, &length) in topology.edge_ids().zip(&lengths) {
        if length <= least {
            return Err(thin(Thin::Edge, start(edge), length));
        }
    }
    let measures = Measures::of(brep);
    let areas = measures.areas(brep);
    for (face, covered) in topology.face_ids().zip(&areas) {
        let Some(first) = topology.edges_of(face).next() else {
            continue;
        };
        let perimeter: f64 = topology.edges_of(face).map(|e| lengths[e.index()]).sum();
        // A strip has two long sides.
        let width = 2.0 * covered.area / perimeter;
        if width <= least {
            return Err(thin(Thin::Face, start(first), width));
        }
    }
    for (shell, id) in topology.shells.iter().zip(0..) {
        let area: f64 = shell.faces.iter().map(|f| areas[f.index()].area).sum();
        // A plate has two large sides.
        let thickness = 2.0 * measures.enclosed(brep, ShellId(id)).volume.abs() / area;
        let first = shell
            .faces
            .iter()
            .flat_map(|&f| topology.edges_of(f))
            .next();
        if let (Some(edge), true) = (first, thickness <= least) {
            return Err(thin(Thin::Shell, start(edge), thickness));
        }
    }
    Ok(())
}

/// How long an edge is.
fn length(curve: &Curve, [lo, hi]: [f64; 2]) -> f64 {
    let at = |k: u32| curve.point(lo + (hi - lo) * (f64::from(k) / f64::from(SIDES)));
    (0..SIDES).map(|k| (at(k + 1) - at(k)).norm()).sum()
}
