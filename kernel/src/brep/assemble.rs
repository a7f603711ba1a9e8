//! Assembles loops, faces, shells and solids from edges and the faces around them.
//!
//! Loops: at a vertex a coedge is followed by the next one clockwise, seen from outside, so that
//! the face stays on the left. Faces: loops of one surface that bound one region (`region`). Shells
//! and solids: `shells`. Points where several of these touch: `non_manifold_points`.

use super::assembly_error::AssemblyError;
use super::boundary_input::{BoundaryInput, FaceUse, Names, SurfaceSide};
use super::non_manifold_points::touches;
use super::region::regions;
use super::shells::{bind_shells, fans};
use super::surface_path::DirectedArc;
use super::topology::{
    Coedge, CoedgeId, Edge, EdgeId, Face, FaceId, Loop, LoopId, Sense, ShellId, Topology, VertexId,
};
use super::{Brep, BrepGeometry, EdgeGeometry, FaceGeometry};
use crate::geometry::frame::Frame;
use crate::geometry::surface::Surface;
use crate::geometry::vector::{Length, rounded};
use crate::hash::HashMap;
use crate::number::bisection::bisect;
use crate::number::float::Float;
use crate::number::predicates::{Compare, Predicates};
use nalgebra::Point3;
use std::collections::BTreeMap;

/// A small sphere around a vertex on which the edges there are ordered.
struct Around {
    /// The fraction of each edge's range that the sphere may reach.
    along: f64,
    /// The radius relative to the shortest such distance.
    part: f64,
    /// The smallest gap that separates two edges, in multiples of the resolution.
    clear: f64,
}

/// Spheres close to the vertex need gaps well above the vertex's own uncertainty. Halfway along the
/// edges a gap of the resolution suffices, as closer edges would be one. The last sphere lies
/// farther along, where edges may end at different vertices.
const SPHERES: [Around; 7] = {
    const fn sphere(along: f64, part: f64, clear: f64) -> Around {
        Around { along, part, clear }
    }
    [
        sphere(0.5, 1.0 / 64.0, 16.0),
        sphere(0.5, 1.0 / 16.0, 16.0),
        sphere(0.5, 1.0 / 4.0, 16.0),
        sphere(0.5, 1.0 / 256.0, 16.0),
        sphere(0.5, 0.5, 16.0),
        sphere(0.5, 1.0, 1.0),
        sphere(0.9, 1.0, 1.0),
    ]
};

/// A coedge that is not yet in a loop.
#[derive(Clone, Copy, Debug)]
struct Half {
    edge: usize,
    face_use: FaceUse,
}

/// An end of an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
struct End {
    edge: usize,
    /// Whether it is the edge's first end.
    first: bool,
}

/// An end of an edge, and the angle at which it leaves a vertex.
struct EndAngle<N: Float = f64> {
    angle: N,
    end: End,
}

/// The corner of a side of a surface at a vertex.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct FaceCorner {
    vertex: usize,
    side: SurfaceSide,
    /// The upper (`Along`) or lower pole of a torus. Both poles of a horn torus are one point.
    pole: Option<Sense>,
}

/// The fraction of an edge from its end at which it shows which of two poles in one point it
/// approaches.
const NEAR_POLE: f64 = 1.0 / 8.0;

/// The boundary without its shells, solids and touches.
struct Unbound<N: Float = f64> {
    brep: Brep<N>,
    names: Names,
}

struct Assembler<'a, N: Float = f64> {
    raw: &'a BoundaryInput<N>,
    predicates: &'a Predicates,
    halves: Vec<Half>,
    /// The index of the first half of each edge.
    first: Vec<usize>,
    next: Vec<usize>,
}

/// Assembles the boundary representation with the given edges.
///
/// # Errors
/// The edges do not form a boundary: a loop is open, an order of edges or the grouping of loops is
/// ambiguous, a shell has no volume, or a void is in no solid.
pub fn assemble<N: Float>(
    raw: BoundaryInput<N>,
    predicates: &Predicates,
) -> Result<Brep<N>, AssemblyError> {
    let mut assembler = Assembler::new(&raw, predicates);
    assembler.link()?;
    let rings = assembler.rings();
    let faces = assembler.faces(&rings)?;
    let Unbound { mut brep, names } = assembler.brep(&rings, &faces);
    let fans = fans(&brep.topology, &names.partner);
    bind_shells(&mut brep, &fans, predicates)?;
    for found in touches(&brep, &raw, &names, &fans, predicates) {
        brep.geometry.touches.push(found.place);
        brep.topology.touches.push(found.touch);
    }
    Ok(brep)
}

/// A face: its side of the surface and its loops.
struct Region {
    side: SurfaceSide,
    rings: Vec<usize>,
    euler: i32,
}

impl<'a, N: Float> Assembler<'a, N> {
    fn new(raw: &'a BoundaryInput<N>, predicates: &'a Predicates) -> Self {
        let mut halves = Vec::new();
        let mut first = Vec::new();
        for (edge, e) in raw.edges.iter().enumerate() {
            first.push(halves.len());
            halves.extend(e.face_uses.iter().map(|&face_use| Half { edge, face_use }));
        }
        let next = vec![usize::MAX; halves.len()];
        Self {
            raw,
            predicates,
            halves,
            first,
            next,
        }
    }

    /// The vertex at which a half starts (`false`) or ends (`true`).
    fn end(&self, half: usize, at_end: bool) -> Option<usize> {
        let h = &self.halves[half];
        let ends = self.raw.edges[h.edge].ends?;
        Some(ends[usize::from(at_end == (h.face_use.sense == Sense::Along))])
    }

    /// Finds the successor of every half.
    fn link(&mut self) -> Result<(), AssemblyError> {
        // Per vertex and side: the incoming and the outgoing halves.
        let mut meeting: BTreeMap<FaceCorner, [Vec<usize>; 2]> = BTreeMap::new();
        for i in 0..self.halves.len() {
            let side = self.halves[i].face_use.side();
            let corner = |vertex: usize, at_end: bool| FaceCorner {
                vertex,
                side,
                pole: self.pole(side, vertex, self.edge_end(i, at_end)),
            };
            match (self.end(i, false), self.end(i, true)) {
                (Some(start), Some(end)) => {
                    meeting.entry(corner(end, true)).or_default()[0].push(i);
                    meeting.entry(corner(start, false)).or_default()[1].push(i);
                }
                _ => self.next[i] = i,
            }
        }
        for (corner, [into, out]) in meeting {
            if into.len() != out.len() {
                return Err(AssemblyError::OpenLoop {
                    place: rounded(&self.raw.points[corner.vertex].place),
                });
            }
            match (&into[..], &out[..]) {
                ([i], [o]) => self.next[*i] = *o,
                _ => self.link_by_angle(corner, &into, &out)?,
            }
        }
        Ok(())
    }

    fn link_by_angle(
        &mut self,
        corner: FaceCorner,
        into: &[usize],
        out: &[usize],
    ) -> Result<(), AssemblyError> {
        let back = |&i: &usize| self.edge_end(i, true);
        let away = |&o: &usize| self.edge_end(o, false);
        let mut ends: Vec<End> = into.iter().map(back).chain(out.iter().map(away)).collect();
        ends.sort_unstable();
        ends.dedup();
        let order = self.order(corner, ends)?;
        let n = order.len();
        let rank: HashMap<End, usize> = order.into_iter().zip(0..).collect();
        let follower = |i: &usize| {
            // The distance is at least one: an end may be followed by itself, after a full turn.
            let clockwise = |o: &&usize| (rank[&back(i)] + n - rank[&away(o)] + n - 1) % n;
            out.iter().min_by_key(clockwise).copied()
        };
        let mut followers: Vec<usize> = into.iter().filter_map(follower).collect();
        for (&i, &o) in into.iter().zip(&followers) {
            self.next[i] = o;
        }
        followers.sort_unstable();
        followers.dedup();
        if followers.len() != into.len() {
            return Err(AssemblyError::AmbiguousVertex {
                place: rounded(&self.raw.points[corner.vertex].place),
            });
        }
        Ok(())
    }

    /// The end of its edge at which a half ends (`at_end`) or starts.
    fn edge_end(&self, half: usize, at_end: bool) -> End {
        let Half { edge, face_use } = self.halves[half];
        let first = at_end != (face_use.sense == Sense::Along);
        End { edge, first }
    }

    /// Sorts edge ends around a vertex, counterclockwise seen from outside, by their intersections
    /// with a small sphere around it. Ends that are tangent and cannot be separated on one sphere
    /// are sorted on a wider one, which only they need to reach.
    fn order(&self, corner: FaceCorner, ends: Vec<End>) -> Result<Vec<End>, AssemblyError> {
        let v = self.raw.points[corner.vertex].place;
        let frame = self.tangent_frame(corner, &v);
        let mut bundles = vec![ends];
        while let Some(at) = bundles.iter().position(|b| b.len() > 1) {
            let parts = self.separated(&v, &frame, &bundles[at]);
            if parts.len() < 2 {
                return Err(AssemblyError::AmbiguousVertex { place: rounded(&v) });
            }
            bundles.splice(at..=at, parts);
        }
        Ok(bundles.concat())
    }

    /// Edge ends in counterclockwise order, in as many separate bundles as any one sphere that all
    /// of them reach can distinguish.
    fn separated(&self, v: &Point3<N>, frame: &Frame<N>, ends: &[End]) -> Vec<Vec<End>> {
        let mut best = Vec::new();
        for sphere in &SPHERES {
            let [along, part, clear] = [sphere.along, sphere.part, sphere.clear].map(N::from_f64);
            let reaches = ends
                .iter()
                .map(|e| (self.point_along(*e, along) - v).length());
            let radius = reaches.fold(N::INFINITY, N::min) * part;
            let angle = |&end: &End| {
                let p = self.point_at(end, along, v, radius);
                let d = frame.components(&(p - v));
                EndAngle {
                    angle: d.y.atan2(d.x),
                    end,
                }
            };
            let least = self.predicates.resolution::<N>() / radius * clear + N::ROUNDING;
            let bundles = bundled(ends.iter().map(angle).collect(), least);
            if bundles.len() > best.len() {
                best = bundles;
            }
            if best.len() == ends.len() {
                break;
            }
        }
        best
    }

    fn tangent_frame(&self, corner: FaceCorner, v: &Point3<N>) -> Frame<N> {
        let s = &self.raw.surfaces[corner.side.surface];
        let normal = match (s, corner.pole) {
            // At an apex the directions are sorted around the axis.
            (Surface::Cone(_) | Surface::EllipticCone(_), _)
                if self.predicates.within((v - s.frame().origin).length()) =>
            {
                -s.frame().z
            }
            (_, Some(pole)) => s.frame().z * pole.sign::<N>(),
            _ => s.normal(v),
        };
        Frame::about(*v, normal * corner.side.outward.sign::<N>())
    }

    /// The pole of a torus that a vertex is, as an edge that ends there approaches it.
    fn pole(&self, side: SurfaceSide, vertex: usize, end: End) -> Option<Sense> {
        let Surface::Torus(torus) = &self.raw.surfaces[side.surface] else {
            return None;
        };
        let v = self.raw.points[vertex].place;
        let is_here = |pole: Point3<N>| self.predicates.within((v - pole).length());
        if !torus.poles().any(is_here) {
            return None;
        }
        let (origin, axis) = (torus.frame.origin, torus.frame.z);
        let up = (v - origin).dot(&axis);
        let up = match self.predicates.within(up) {
            true => (self.point_along(end, N::from_f64(NEAR_POLE)) - v).dot(&axis),
            false => up,
        };
        Some(match up.is_above_zero() {
            true => Sense::Along,
            false => Sense::Against,
        })
    }

    /// The parameters at one of an edge's ends, and at a fraction `along` of its range from there.
    fn stretch(&self, End { edge, first }: End, along: N) -> [N; 2] {
        let [lo, hi] = self.raw.edges[edge].range;
        match first {
            true => [lo, lo + (hi - lo) * along],
            false => [hi, hi - (hi - lo) * along],
        }
    }

    /// The point of an edge at a fraction of its range from one of its ends.
    fn point_along(&self, end: End, along: N) -> Point3<N> {
        let [_, t] = self.stretch(end, along);
        self.raw.curves[self.raw.edges[end.edge].curve].point(t)
    }

    /// The point of an edge at a distance from the vertex at one of its ends, within a fraction of
    /// its range.
    fn point_at(&self, end: End, along: N, v: &Point3<N>, radius: N) -> Point3<N> {
        let curve = &self.raw.curves[self.raw.edges[end.edge].curve];
        let [start, far] = self.stretch(end, along);
        let gap = |t: N| (curve.point(t) - v).length() - radius;
        let t = match start.is_short_of(far) {
            true => bisect(start, far, -radius, gap),
            false => bisect(far, start, radius, gap),
        };
        curve.point(t)
    }

    /// The closed cycles of halves.
    fn rings(&self) -> Vec<Vec<usize>> {
        let mut seen = vec![false; self.halves.len()];
        let mut rings = Vec::new();
        for start in 0..self.halves.len() {
            let mut ring = Vec::new();
            let mut i = start;
            while !seen[i] {
                seen[i] = true;
                ring.push(i);
                i = self.next[i];
            }
            if !ring.is_empty() {
                rings.push(ring);
            }
        }
        rings
    }

    fn arc(&self, half: usize) -> DirectedArc<'_, N> {
        let h = &self.halves[half];
        let e = &self.raw.edges[h.edge];
        DirectedArc {
            curve: &self.raw.curves[e.curve],
            range: e.range,
            sense: h.face_use.sense,
        }
    }

    /// Groups the loops of each surface into faces.
    fn faces(&self, rings: &[Vec<usize>]) -> Result<Vec<Region>, AssemblyError> {
        let mut sides: BTreeMap<SurfaceSide, Vec<usize>> = BTreeMap::new();
        for (i, ring) in rings.iter().enumerate() {
            let side = self.halves[ring[0]].face_use.side();
            sides.entry(side).or_default().push(i);
        }
        let mut faces = Vec::new();
        for (side, list) in sides {
            let arcs: Vec<Vec<DirectedArc<'_, N>>> = list
                .iter()
                .map(|&r| rings[r].iter().map(|&h| self.arc(h)).collect())
                .collect();
            let surface = &self.raw.surfaces[side.surface];
            let resolution = self.predicates.resolution();
            for region in regions(surface, side.outward, &arcs, resolution)? {
                let rings = region.loops.iter().map(|&k| list[k]).collect();
                faces.push(Region {
                    side,
                    rings,
                    euler: region.euler,
                });
            }
        }
        for &side in &self.raw.whole {
            let euler = match self.raw.surfaces[side.surface] {
                Surface::Torus(torus) if torus.is_ring() => 0,
                _ => 2,
            };
            faces.push(Region {
                side,
                rings: Vec::new(),
                euler,
            });
        }
        Ok(faces)
    }

    /// All entities except shells, solids and touches, and their ids.
    fn brep(&self, rings: &[Vec<usize>], faces: &[Region]) -> Unbound<N> {
        let mut brep = Brep {
            topology: Topology::default(),
            geometry: BrepGeometry::default(),
        };
        let vertex_of = self.add_edges(&mut brep);
        self.add_coedges(&mut brep.topology);
        let surface_of = self.add_faces(rings, faces, &mut brep);
        let partner = (0..self.halves.len()).map(|i| {
            let place = i - self.first[self.halves[i].edge];
            CoedgeId((self.first[self.halves[i].edge] + (place ^ 1)) as u32)
        });
        let names = Names {
            partner: partner.collect(),
            vertex_of,
            surface_of,
        };
        Unbound { brep, names }
    }

    /// Adds the edges with their curves and vertices. Returns the vertex id of each point.
    fn add_edges(&self, brep: &mut Brep<N>) -> HashMap<usize, VertexId> {
        let raw = self.raw;
        let Brep { topology, geometry } = brep;
        let mut vertex_of: HashMap<usize, VertexId> = HashMap::default();
        let mut curve_of: HashMap<usize, usize> = HashMap::default();
        for e in &raw.edges {
            let mut vertex = |v: usize| {
                *vertex_of.entry(v).or_insert_with(|| {
                    geometry.points.push(raw.points[v].place);
                    VertexId(geometry.points.len() as u32 - 1)
                })
            };
            let ends = e.ends.map(|[a, b]| [vertex(a), vertex(b)]);
            let curve = *curve_of.entry(e.curve).or_insert_with(|| {
                geometry.curves.push(raw.curves[e.curve].clone());
                geometry.curves.len() - 1
            });
            geometry.arcs.push(EdgeGeometry {
                curve,
                range: e.range,
            });
            topology.edges.push(Edge {
                ends,
                coedges: Vec::new(),
                smooth: e.smooth,
            });
        }
        topology.vertices = geometry.points.len() as u32;
        vertex_of
    }

    /// Adds the coedges, which have no loops yet.
    fn add_coedges(&self, topology: &mut Topology) {
        let unowned = LoopId(u32::MAX);
        for (i, h) in self.halves.iter().enumerate() {
            topology.edges[h.edge].coedges.push(CoedgeId(i as u32));
            let edge = EdgeId(h.edge as u32);
            topology.coedges.push(Coedge {
                edge,
                sense: h.face_use.sense,
                owner: unowned,
            });
        }
    }

    /// Adds the faces with their surfaces and loops. Returns the surface index of each input
    /// surface.
    fn add_faces(
        &self,
        rings: &[Vec<usize>],
        faces: &[Region],
        brep: &mut Brep<N>,
    ) -> HashMap<usize, usize> {
        let Brep { topology, geometry } = brep;
        let mut surface_of: HashMap<usize, usize> = HashMap::default();
        for region in faces {
            let SurfaceSide { surface, outward } = region.side;
            let surface = *surface_of.entry(surface).or_insert_with(|| {
                geometry.surfaces.push(self.raw.surfaces[surface]);
                geometry.surfaces.len() - 1
            });
            geometry.patches.push(FaceGeometry {
                surface,
                sense: outward,
            });
            let face = FaceId(topology.faces.len() as u32);
            let mut loops = Vec::new();
            for &r in &region.rings {
                let id = LoopId(topology.loops.len() as u32);
                loops.push(id);
                for &h in &rings[r] {
                    topology.coedges[h].owner = id;
                }
                let coedges = rings[r].iter().map(|&h| CoedgeId(h as u32)).collect();
                topology.loops.push(Loop { coedges, face });
            }
            topology.faces.push(Face {
                loops,
                shell: ShellId(u32::MAX),
                euler: region.euler,
            });
        }
        surface_of
    }
}

/// Sorts edge ends by angle, starting at the widest gap, into bundles separated by more than
/// `least`.
fn bundled<N: Float>(mut angles: Vec<EndAngle<N>>, least: N) -> Vec<Vec<End>> {
    angles.sort_by(|a, b| a.angle.total_cmp(&b.angle));
    let n = angles.len();
    let gap = |i: usize| match i {
        0 => angles[0].angle + N::TAU - angles[n - 1].angle,
        _ => angles[i].angle - angles[i - 1].angle,
    };
    let Some(start) = (0..n).max_by(|&a, &b| gap(a).total_cmp(&gap(b))) else {
        return Vec::new();
    };
    let mut bundles: Vec<Vec<End>> = Vec::new();
    for i in (start..n).chain(0..start) {
        match bundles.last_mut() {
            Some(bundle) if gap(i).is_at_most(least) => bundle.push(angles[i].end),
            _ => bundles.push(vec![angles[i].end]),
        }
    }
    bundles
}
