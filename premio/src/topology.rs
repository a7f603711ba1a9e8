//! Faces, edges and vertices of a solid, with their relations and exact geometry.

use nalgebra::Point3;
use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::{EdgeId, FaceId, Sense, VertexId};
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::surface::Surface;
use std::collections::BTreeSet;
use std::fmt;

macro_rules! entity {
    ($(#[$doc:meta])* $name:ident, $id:ident) => {
        $(#[$doc])*
        #[derive(Clone, Copy)]
        pub struct $name<'s> {
            brep: &'s Brep,
            id: $id,
        }

        impl<'s> $name<'s> {
            pub(crate) fn new(brep: &'s Brep, id: $id) -> Self {
                Self { brep, id }
            }
        }

        impl fmt::Debug for $name<'_> {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.debug_tuple(stringify!($name)).field(&self.id.0).finish()
            }
        }

        /// The same entity of the same solid.
        impl PartialEq for $name<'_> {
            fn eq(&self, other: &Self) -> bool {
                std::ptr::eq(self.brep, other.brep) && self.id == other.id
            }
        }

        impl Eq for $name<'_> {}
    };
}

entity!(
    /// A face of a solid: a maximal connected piece of one surface.
    ///
    /// # Examples
    ///
    /// ```
    /// let ball = premio::sphere(2).evaluate()?;
    /// let face = ball.faces().next().unwrap();
    /// assert_eq!(face.outward_normal([0.0, 0.0, 2.0]), [0.0, 0.0, 1.0]);
    /// # Ok::<(), premio::Error>(())
    /// ```
    FaceRef,
    FaceId
);
entity!(
    /// An edge of a solid: a piece of a curve between faces.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::cylinder(2, 3).evaluate()?;
    /// for edge in solid.edges() {
    ///     let [x, y, _] = edge.point(1.0);
    ///     assert!((x.hypot(y) - 2.0).abs() < 1e-12);
    /// }
    /// # Ok::<(), premio::Error>(())
    /// ```
    EdgeRef,
    EdgeId
);
entity!(
    /// A vertex of a solid: a point where edges end.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::wedge(1, 1, 1).evaluate()?;
    /// assert!(solid.vertices().all(|vertex| vertex.edges().count() == 3));
    /// # Ok::<(), premio::Error>(())
    /// ```
    VertexRef,
    VertexId
);

impl<'s> FaceRef<'s> {
    /// The number by which contours, models and files name the face.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(1, 2, 3).evaluate()?;
    /// assert!(solid.faces().map(|face| face.index()).eq(0..6));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn index(self) -> u32 {
        self.id.0
    }

    /// The surface.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = sphere(2).evaluate()?;
    /// let face = solid.faces().next().unwrap();
    /// assert!(matches!(face.surface(), Surface::Sphere(sphere) if sphere.radius == 2.0));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn surface(self) -> &'s Surface {
        self.brep.surface(self.id)
    }

    /// Whether the outward normal of the solid is the surface's own: within a bore it is not.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let bore = (block(4, 4, 4) - sphere(1).translate([2, 2, 2])).evaluate()?;
    /// let round = bore.faces().find(|f| matches!(f.surface(), Surface::Sphere(_))).unwrap();
    /// assert!(!round.is_along_surface());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn is_along_surface(self) -> bool {
        self.brep.sense(self.id) == Sense::Along
    }

    /// The unit normal at a point of the face, out of the material.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(1, 2, 3).evaluate()?;
    /// let up = |face: &premio::FaceRef<'_>| face.outward_normal([0.5, 1.0, 3.0]) == [0.0, 0.0, 1.0];
    /// assert_eq!(solid.faces().filter(up).count(), 1);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn outward_normal(self, point: [f64; 3]) -> [f64; 3] {
        // Zeros of either sign are one.
        let normal = self.brep.outward(self.id, &Point3::from(point));
        normal.map(|x| x + 0.0).into()
    }

    /// The loops of edges around the face; none where the face is a whole closed surface. The face
    /// is to the left of each loop as seen from outside the material.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let plate = (block(6, 4, 2) - cylinder(1, 4).translate([3, 2, -1])).evaluate()?;
    /// let loops: Vec<usize> = plate.faces().map(|face| face.loops().count()).collect();
    /// assert_eq!(loops.iter().filter(|n| **n == 2).count(), 3);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn loops(self) -> impl Iterator<Item = Vec<EdgeRef<'s>>> {
        let topology = &self.brep.topology;
        let loops = topology.face(self.id).loops.iter();
        loops.map(move |&ring| {
            let coedges = topology.ring(ring).coedges.iter();
            let edges = coedges.map(|&c| EdgeRef::new(self.brep, topology.coedge(c).edge));
            edges.collect()
        })
    }

    /// The edges around the face, each once.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(1, 2, 3).evaluate()?;
    /// assert!(solid.faces().all(|face| face.edges().count() == 4));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn edges(self) -> impl Iterator<Item = EdgeRef<'s>> {
        let edges: BTreeSet<EdgeId> = self.brep.topology.edges_of(self.id).collect();
        let brep = self.brep;
        edges.into_iter().map(move |id| EdgeRef::new(brep, id))
    }

    /// The vertices around the face, each once.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(1, 2, 3).evaluate()?;
    /// assert!(solid.faces().all(|face| face.vertices().count() == 4));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn vertices(self) -> impl Iterator<Item = VertexRef<'s>> {
        let topology = &self.brep.topology;
        let ends = topology
            .edges_of(self.id)
            .filter_map(|e| topology.edge(e).ends);
        let vertices: BTreeSet<VertexId> = ends.flatten().collect();
        let brep = self.brep;
        vertices.into_iter().map(move |id| VertexRef::new(brep, id))
    }

    /// The other faces that share an edge with the face, each once.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::cylinder(1, 2).evaluate()?;
    /// let counts: Vec<usize> = solid.faces().map(|face| face.neighbours().count()).collect();
    /// assert_eq!(counts.iter().sum::<usize>(), 4);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn neighbours(self) -> impl Iterator<Item = FaceRef<'s>> {
        let topology = &self.brep.topology;
        let around = topology
            .edges_of(self.id)
            .flat_map(|e| topology.faces_of(e));
        let mut faces: BTreeSet<FaceId> = around.collect();
        faces.remove(&self.id);
        let brep = self.brep;
        faces.into_iter().map(move |id| FaceRef::new(brep, id))
    }
}

impl<'s> EdgeRef<'s> {
    /// The number by which contours, models and files name the edge.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(1, 2, 3).evaluate()?;
    /// assert!(solid.edges().map(|edge| edge.index()).eq(0..12));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn index(self) -> u32 {
        self.id.0
    }

    /// The curve.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = cylinder(2, 3).evaluate()?;
    /// let round = |edge: EdgeRef<'_>| matches!(edge.curve(), Curve::Circle(c) if c.radius == 2.0);
    /// assert!(solid.edges().all(round));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn curve(self) -> &'s Curve {
        self.brep.curve(self.id)
    }

    /// The range of the curve's parameter, increasing from the first to the last vertex. A closed
    /// edge runs over one period.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::cylinder(2, 3).evaluate()?;
    /// let [from, to] = solid.edges().next().unwrap().range();
    /// assert!((to - from - std::f64::consts::TAU).abs() < 1e-12);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn range(self) -> [f64; 2] {
        self.brep.range(self.id)
    }

    /// The point at a parameter of the curve.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(1, 2, 3).evaluate()?;
    /// let edge = solid.edges().next().unwrap();
    /// assert_eq!(edge.point(edge.range()[0]), edge.vertices().unwrap()[0].point());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn point(self, parameter: f64) -> [f64; 3] {
        self.curve().point(parameter).into()
    }

    /// Whether the edge is closed without a vertex.
    ///
    /// # Examples
    ///
    /// ```
    /// assert!(premio::cylinder(2, 3).evaluate()?.edges().all(|edge| edge.is_closed()));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn is_closed(self) -> bool {
        self.brep.topology.edge(self.id).ends.is_none()
    }

    /// Whether the edge is smooth: it has two faces, whose normals agree along it.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let pin = (cylinder(1, 3) + sphere(1)).evaluate()?;
    /// assert_eq!(pin.edges().filter(|edge| edge.is_smooth()).count(), 1);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn is_smooth(self) -> bool {
        self.brep.topology.edge(self.id).smooth
    }

    /// The first and the last vertex; none of a closed edge.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(1, 2, 3).evaluate()?;
    /// assert!(solid.edges().all(|edge| edge.vertices().is_some_and(|[a, b]| a != b)));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn vertices(self) -> Option<[VertexRef<'s>; 2]> {
        let ends = self.brep.topology.edge(self.id).ends?;
        Some(ends.map(|id| VertexRef::new(self.brep, id)))
    }

    /// The faces around the edge, in order, counterclockwise as seen against its direction. There
    /// are more than two where the boundary is no manifold.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// // Two blocks that share one edge only.
    /// let pair = block(1, 1, 1) + block(1, 1, 1).translate([1, 1, 0]);
    /// let most = pair.evaluate()?.edges().map(|edge| edge.faces().count()).max();
    /// assert_eq!(most, Some(4));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn faces(self) -> impl Iterator<Item = FaceRef<'s>> {
        let brep = self.brep;
        let faces = brep.topology.faces_of(self.id);
        faces.map(move |id| FaceRef::new(brep, id))
    }
}

impl<'s> VertexRef<'s> {
    /// The number by which files name the vertex.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(1, 2, 3).evaluate()?;
    /// assert!(solid.vertices().map(|vertex| vertex.index()).eq(0..8));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn index(self) -> u32 {
        self.id.0
    }

    /// The point.
    ///
    /// # Examples
    ///
    /// ```
    /// let ramp = premio::wedge(1, 3, 2).evaluate()?;
    /// let top = ramp.vertices().filter(|vertex| vertex.point()[2] == 2.0);
    /// assert_eq!(top.count(), 2);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn point(self) -> [f64; 3] {
        self.brep.point(self.id).into()
    }

    /// The edges that end at the vertex, each once.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(1, 2, 3).evaluate()?;
    /// assert!(solid.vertices().all(|vertex| vertex.edges().count() == 3));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn edges(self) -> impl Iterator<Item = EdgeRef<'s>> {
        let brep = self.brep;
        let is_end = move |e: &EdgeId| {
            let ends = brep.topology.edge(*e).ends;
            ends.is_some_and(|ends| ends.contains(&self.id))
        };
        let edges = brep.topology.edge_ids().filter(is_end);
        edges.map(move |id| EdgeRef::new(brep, id))
    }

    /// The faces around the vertex, each once.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(1, 2, 3).evaluate()?;
    /// assert!(solid.vertices().all(|vertex| vertex.faces().count() == 3));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn faces(self) -> impl Iterator<Item = FaceRef<'s>> {
        let brep = self.brep;
        let faces = self.edges().flat_map(|e| brep.topology.faces_of(e.id));
        let faces: BTreeSet<FaceId> = faces.collect();
        faces.into_iter().map(move |id| FaceRef::new(brep, id))
    }
}
