//! Finds edges, faces and walls that are too thin for the tolerances of other kernels.

use super::overlap::{Tolerances, overlapping_edges};
use super::{StepError, clearance};
use crate::two_manifold::{SeamedEdge, TwoManifold, short};
use nalgebra::Point3;
use premio_kernel::brep::Brep;
use premio_kernel::brep::face_integrals::FaceIntegrals;
use premio_kernel::brep::topology::ShellId;
use premio_kernel::unit::Unit;
use std::fmt;

/// The distance, in millimetres, up to which other kernels merge points (Open CASCADE's
/// `Precision::Confusion`).
const APART: f64 = 1.0 / 10_000_000.0;

/// The fraction of that distance up to which two edges of a face cross for other kernels (Open
/// CASCADE's `Precision::Intersection`).
const CROSSING: f64 = 1.0 / 100.0;

/// The fraction of that distance up to which touching edges of a face may overlap (Open CASCADE
/// classifies wires with about a tenth of `Precision::Intersection`).
const OVERLAPPING: f64 = 1.0 / 1_000.0;

/// A kind of thin entity.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Thin {
    /// An edge is short.
    Edge,
    /// A face is narrow.
    Face,
    /// Two edges of a face are close to each other.
    Gap,
    /// Two edges of a face touch and overlap.
    Overlap,
    /// The two sides of a shell are close to each other.
    Shell,
}

impl fmt::Display for Thin {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Edge => "an edge of length",
            Self::Face => "a face of width",
            Self::Gap => "two edges of a face at the distance",
            Self::Overlap => "two edges of a face that touch and overlap by",
            Self::Shell => "a wall or gap of thickness",
        })
    }
}

/// The distance up to which other kernels merge points, in the part's unit.
pub(super) fn apart(unit: Unit) -> f64 {
    APART / unit.millimetres()
}

/// Checks that every edge is longer and every face wider than that, and that edges of a face touch
/// without an overlap or are farther from each other.
pub(super) fn check(
    brep: &Brep,
    seamed: &TwoManifold<'_>,
    resolution: f64,
    least: f64,
) -> Result<(), StepError> {
    let crossing = least * CROSSING;
    if let Some(near) = clearance::near_edges(seamed, resolution, crossing) {
        return Err(thin(Thin::Gap, near.place, near.distance, crossing));
    }
    let tolerances = Tolerances {
        resolution,
        vertex: least,
        crossing: least * OVERLAPPING,
    };
    if let Some(overlap) = overlapping_edges(brep, seamed, &tolerances) {
        let most = tolerances.crossing;
        return Err(thin(Thin::Overlap, overlap.place, overlap.distance, most));
    }
    let areas = FaceIntegrals::new(brep).areas(brep);
    let length = |edge: &SeamedEdge<'_>| short::length(&edge.curve, edge.range);
    let lengths: Vec<f64> = seamed.edges.iter().map(length).collect();
    let start = |edge: usize| seamed.points[seamed.edges[edge].ends[0]];
    for face in &seamed.faces {
        let edges = || face.loops.iter().flatten().map(|half| half.edge);
        if let Some(edge) = edges().find(|&edge| lengths[edge] <= least) {
            return Err(thin(Thin::Edge, start(edge), lengths[edge], least));
        }
        let Some(first) = edges().next() else {
            continue;
        };
        let perimeter: f64 = edges().map(|edge| lengths[edge]).sum();
        // A strip has two long sides.
        let width = 2.0 * areas[face.source.index()].area / perimeter;
        if width <= least {
            return Err(thin(Thin::Face, start(first), width, least));
        }
    }
    Ok(())
}

fn thin(what: Thin, place: Point3<f64>, size: f64, least: f64) -> StepError {
    StepError::Thin {
        what,
        place: place.into(),
        size,
        least,
    }
}

/// Checks that the two sides of each shell are farther from each other.
pub(super) fn check_shells(brep: &Brep, least: f64) -> Result<(), StepError> {
    let topology = &brep.topology;
    let measures = FaceIntegrals::new(brep);
    let areas = measures.areas(brep);
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
            let place = brep.curve(edge).point(brep.range(edge)[0]);
            return Err(thin(Thin::Shell, place, thickness, least));
        }
    }
    Ok(())
}
