//! The distances between the ends of edges and their vertices.

use super::Brep;
use super::topology::{EdgeId, VertexId};
use crate::geometry::vector::Length;
use crate::number::float::Float;
use nalgebra::Point3;

/// An end of an edge.
pub(super) struct EndGap<N: Float = f64> {
    pub vertex: VertexId,
    /// The point on the edge.
    pub place: Point3<N>,
    /// Its distance from the vertex.
    pub distance: N,
}

/// The ends of an edge.
pub(super) fn gaps_at_ends<N: Float>(
    brep: &Brep<N>,
    id: EdgeId,
) -> impl Iterator<Item = EndGap<N>> {
    let range = brep.range(id);
    let ends = brep.topology.edge(id).ends.into_iter().flatten();
    ends.zip(range).map(move |(vertex, t)| {
        let place = brep.curve(id).point(t);
        EndGap {
            vertex,
            place,
            distance: (brep.point(vertex) - place).length(),
        }
    })
}
