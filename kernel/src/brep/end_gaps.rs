//! The distances between the ends of edges and their vertices.

use super::Brep;
use super::topology::{EdgeId, VertexId};
use crate::geometry::vector::Length;
use crate::number::float::Float;
use nalgebra::Point3;

/// The ends of an edge: the vertex, the point on the edge, and their distance.
pub(super) fn gaps_at_ends<N: Float>(
    brep: &Brep<N>,
    id: EdgeId,
) -> impl Iterator<Item = (VertexId, Point3<N>, N)> {
    let range = brep.range(id);
    let ends = brep.topology.edge(id).ends.into_iter().flatten();
    ends.zip(range).map(move |(vertex, t)| {
        let place = brep.curve(id).point(t);
        (vertex, place, (brep.point(vertex) - place).length())
    })
}
