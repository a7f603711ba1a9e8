//! Limbs inside faces: the limbs of every surface, trimmed by the faces on it.

use super::contour_arc::ArcJunction;
use super::junctions::{JunctionKind, JunctionSupport, Junctions};
use super::limb::{Limb, cusps, cutters, limbs, torus_limb_on};
use crate::scene::Scene;
use crate::scene::tolerance::SPACE_TOLERANCE;
use nalgebra::Point3;
use premio_kernel::brep::locate::PointLocation;
use premio_kernel::brep::topology::{EdgeId, FaceId};
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::curve_plane::plane_roots;
use premio_kernel::geometry::curve_surface::cut;
use premio_kernel::geometry::surface::{Surface, Torus};
use premio_kernel::geometry::unresolved::Unresolved;
use premio_kernel::number::predicates::Compare;
use premio_kernel::number::roots::{Root, Roots};

/// A limb inside a face.
#[derive(Debug)]
pub struct LimbArc {
    /// The curve.
    pub curve: Curve,
    /// The range of its parameter.
    pub range: [f64; 2],
    /// Whether the range is a whole period.
    pub(crate) closed: bool,
    /// The face.
    pub face: FaceId,
    /// The junctions at both ends.
    pub(crate) ends: [Option<u32>; 2],
    /// Cusps and nodes.
    pub(crate) marks: Vec<ArcJunction>,
}

/// All limbs of a part, and where they end on its edges.
#[derive(Debug)]
pub struct LimbArcs {
    /// The limbs.
    pub arcs: Vec<LimbArc>,
    /// By edge: the ends of limbs on it.
    pub(crate) on_edges: Vec<Vec<ArcJunction>>,
}

/// Trims the limbs of every surface by the faces on it.
///
/// # Errors
/// A limb of a torus could not be resolved.
pub fn limb_arcs(scene: &Scene<'_>, junctions: &mut Junctions<'_>) -> Result<LimbArcs, Unresolved> {
    let brep = scene.brep;
    let mut known: Vec<Option<Vec<Limb>>> = vec![None; brep.geometry.surfaces.len()];
    let mut trim = LimbTrimmer {
        scene,
        junctions,
        found: LimbArcs {
            arcs: Vec::new(),
            on_edges: vec![Vec::new(); brep.topology.edges.len()],
        },
    };
    for face in brep.topology.face_ids() {
        let index = brep.geometry.patches[face.index()].surface;
        let surface = &brep.geometry.surfaces[index];
        if matches!(surface, Surface::Plane(_)) {
            continue;
        }
        if known[index].is_none() {
            known[index] = Some(limbs(
                surface,
                &scene.projection.sight,
                scene.resolution,
                scene.tilt,
            )?);
        }
        if let Some(limbs) = &known[index] {
            trim.face(face, limbs);
        }
    }
    Ok(trim.found)
}

/// The junction at an apex of a face's surface.
struct ApexJunction {
    place: Point3<f64>,
    junction: u32,
}

struct LimbTrimmer<'s, 'a, 'j, 'p> {
    scene: &'s Scene<'a>,
    junctions: &'j mut Junctions<'p>,
    found: LimbArcs,
}

impl LimbTrimmer<'_, '_, '_, '_> {
    fn face(&mut self, face: FaceId, limbs: &[Limb]) {
        if limbs.is_empty() {
            return;
        }
        let surface = self.scene.brep.surface(face);
        let cutters = cutters(surface, &self.scene.projection.sight, self.scene.resolution);
        let mut ends: Vec<Vec<ArcJunction>> = vec![Vec::new(); limbs.len()];
        for edge in face_edges(self.scene, face) {
            for t in self.intersects(surface, limbs, &cutters, edge) {
                let p = self.scene.brep.curve(edge).point(t);
                let met = limbs_through(limbs, &p, SPACE_TOLERANCE * self.scene.resolution);
                if met.is_empty() {
                    continue;
                }
                let junction = self.end_on(edge, t, &p);
                for which in met {
                    let t = limbs[which].curve.parameter(&p);
                    ends[which].push(ArcJunction { t, junction });
                }
            }
        }
        let mut apexes: Vec<ApexJunction> = Vec::new();
        for (limb, mut ends) in limbs.iter().zip(ends) {
            for &t in &limb.apexes {
                let p = limb.curve.point(t);
                let near = SPACE_TOLERANCE * self.scene.resolution;
                let away = |e: &ArcJunction| (limb.curve.point(e.t) - p).norm();
                let is_apex = |e: &ArcJunction| limb.apexes.iter().any(|t| t.is_exactly(e.t));
                if ends.iter().all(|e| is_apex(e) || away(e).is_beyond(near)) {
                    let junction = self.end_at_apex(face, &p, &mut apexes);
                    ends.push(ArcJunction { t, junction });
                }
            }
            self.limb(face, limb, ends);
        }
    }

    /// The junction where a limb ends in an apex, shared by all limbs that do.
    fn end_at_apex(&mut self, face: FaceId, p: &Point3<f64>, known: &mut Vec<ApexJunction>) -> u32 {
        let brep = self.scene.brep;
        let unresolved = match brep.surface(face) {
            Surface::Torus(torus) => torus.pole_neighbourhood(self.scene.resolution),
            _ => self.scene.resolution,
        };
        let near = SPACE_TOLERANCE * unresolved;
        if let Some(apex) = known.iter().find(|a| (a.place - p).norm().is_within(near)) {
            return apex.junction;
        }
        let ends = face_edges(self.scene, face);
        let ends = ends.iter().filter_map(|&e| brep.topology.edge(e).ends);
        let vertex = ends
            .flatten()
            .find(|&v| (brep.point(v) - p).norm().is_within(near));
        let junction = match vertex {
            Some(v) => self.junctions.vertex(v, &brep.point(v)),
            None => self
                .junctions
                .add(JunctionKind::Vertex, JunctionSupport::Alone, p),
        };
        known.push(ApexJunction {
            place: *p,
            junction,
        });
        junction
    }

    /// The parameters at which the limbs of a surface, and the surfaces that cut these out,
    /// intersect an edge on it.
    fn intersects(
        &self,
        surface: &Surface,
        limbs: &[Limb],
        cutters: &[Surface],
        edge: EdgeId,
    ) -> Vec<f64> {
        let mut found = Vec::new();
        match surface {
            Surface::Torus(s) if cutters.is_empty() => {
                self.torus_meets(s, edge, limbs, &mut found);
            }
            _ => cutters
                .iter()
                .for_each(|cutter| self.cuts(cutter, edge, &mut found)),
        }
        found
    }

    /// The parameters at which a surface that cuts limbs out cuts an edge.
    fn cuts(&self, cutter: &Surface, edge: EdgeId, found: &mut Vec<f64>) {
        let (brep, resolution) = (self.scene.brep, self.scene.resolution);
        let (curve, range) = (brep.curve(edge), brep.range(edge));
        if runs_in(curve, range, cutter, resolution) {
            return found.extend(range);
        }
        match cutter {
            Surface::Plane(s) => {
                plane_roots(curve, range, s, resolution, &mut |t, _| found.push(t))
            }
            _ => {
                if let Roots::At { roots, .. } = cut(curve, range, cutter, resolution) {
                    found.extend(roots.iter().map(|r| r.t));
                }
            }
        }
        // A root at a vertex may be just beyond the ends of all its edges.
        let met = |t: &f64| cutter.distance(&curve.point(*t)).is_within(resolution);
        let open = brep.topology.edge(edge).ends.is_some();
        found.extend(range.into_iter().filter(|t| open && met(t)));
    }

    /// The parameters on a torus. Where an edge passes through a node of the limbs, that is used,
    /// because it is known more accurately than the intersections with the limbs.
    fn torus_meets(&self, s: &Torus, edge: EdgeId, limbs: &[Limb], found: &mut Vec<f64>) {
        let (brep, resolution) = (self.scene.brep, self.scene.resolution);
        let (curve, range) = (brep.curve(edge), brep.range(edge));
        let nodes = limbs
            .iter()
            .flat_map(|limb| limb.nodes.iter().map(|&t| limb.curve.point(t)));
        let nodes = nodes.filter_map(|p| on_arc(curve, range, &p, SPACE_TOLERANCE * resolution));
        match torus_limb_on(s, &self.scene.projection.sight, curve, range, resolution) {
            // Where the edge runs along one limb, others cross both there.
            Roots::Everywhere => {
                found.extend(range);
                found.extend(nodes);
            }
            Roots::At { roots, .. } => {
                let nodes: Vec<f64> = nodes.collect();
                let place = |r: &Root| {
                    let node = nodes.iter().find(|t| t.lies_in([r.lo, r.hi]));
                    node.copied().unwrap_or(r.t)
                };
                found.extend(roots.iter().map(place));
            }
        }
    }

    /// The junction where a limb ends on an edge, shared by the faces on both sides.
    fn end_on(&mut self, edge: EdgeId, t: f64, p: &Point3<f64>) -> u32 {
        let brep = self.scene.brep;
        let near = SPACE_TOLERANCE * self.scene.resolution;
        if let Some(ends) = brep.topology.edge(edge).ends {
            for v in ends {
                let q = brep.point(v);
                if (q - p).norm().is_within(near) {
                    return self.junctions.vertex(v, &q);
                }
            }
        }
        let curve = brep.curve(edge);
        let known = self.found.on_edges[edge.index()]
            .iter()
            .find(|m| (curve.point(m.t) - p).norm().is_within(near));
        if let Some(known) = known {
            return known.junction;
        }
        let junction = self
            .junctions
            .add(JunctionKind::Limb, JunctionSupport::Edge(edge), p);
        self.found.on_edges[edge.index()].push(ArcJunction { t, junction });
        junction
    }

    /// Keeps the pieces of a limb between `ends` that lie in the face.
    fn limb(&mut self, face: FaceId, limb: &Limb, mut ends: Vec<ArcJunction>) {
        let curve = &limb.curve;
        ends.sort_by(|a, b| a.t.total_cmp(&b.t));
        let near = SPACE_TOLERANCE * self.scene.resolution;
        let apart = |t: f64, s: f64| (curve.point(t) - curve.point(s)).norm();
        // Between two passes through one pole of a torus the limb lies on its other sheet.
        let is_apex = |end: &ArcJunction| limb.apexes.iter().any(|t| t.is_exactly(end.t));
        ends.dedup_by(|b, a| {
            let is_one = a.junction == b.junction || apart(a.t, b.t).is_within(near);
            is_one && !(is_apex(a) && is_apex(b))
        });
        let Some(period) = curve.period() else {
            for pair in ends.windows(2) {
                self.stretch(
                    face,
                    limb,
                    [pair[0].t, pair[1].t],
                    [pair[0].junction, pair[1].junction].map(Some),
                );
            }
            return;
        };
        let Some(&first) = ends.first() else {
            return self.stretch(face, limb, [0.0, period], [None, None]);
        };
        ends.push(ArcJunction {
            t: first.t + period,
            ..first
        });
        for pair in ends.windows(2) {
            self.stretch(
                face,
                limb,
                [pair[0].t, pair[1].t],
                [pair[0].junction, pair[1].junction].map(Some),
            );
        }
    }

    fn stretch(&mut self, face: FaceId, limb: &Limb, range: [f64; 2], ends: [Option<u32>; 2]) {
        let [lo, hi] = range;
        let at = |part: f64| limb.curve.point(lo + (hi - lo) * part);
        if let Surface::Torus(torus) = self.scene.brep.surface(face)
            && torus.sheet_level(<[f64; 3]>::from(at(0.5))).is_at_most(0.0)
        {
            return;
        }
        let locator = self.scene.locator.face(face);
        // A limb on the boundary runs along an edge, which represents it.
        let inside = [0.5, 0.31, 0.73]
            .iter()
            .map(|&part| locator.place(&at(part)))
            .find(|&place| place != PointLocation::On);
        if inside != Some(PointLocation::Inside) {
            return;
        }
        let mut arc = LimbArc {
            curve: limb.curve.clone(),
            range,
            closed: ends == [None, None],
            face,
            ends,
            marks: Vec::new(),
        };
        if let Surface::Torus(s) = self.scene.brep.surface(face) {
            let sight = &self.scene.projection.sight;
            for t in cusps(s, sight, &arc.curve, range, self.scene.resolution) {
                let p = arc.curve.point(t);
                let junction = self
                    .junctions
                    .add(JunctionKind::Cusp, JunctionSupport::Alone, &p);
                arc.marks.push(ArcJunction { t, junction });
            }
            for &t in &limb.nodes {
                let t = arc
                    .curve
                    .period()
                    .map_or(t, |p| lo + (t - lo).rem_euclid(p));
                if t.lies_between(range) {
                    let p = arc.curve.point(t);
                    let junction =
                        self.junctions
                            .add(JunctionKind::SelfCrossing, JunctionSupport::Alone, &p);
                    arc.marks.push(ArcJunction { t, junction });
                }
            }
        }
        self.found.arcs.push(arc);
    }
}

/// Whether an edge lies in a surface throughout: no line or conic lies in a plane at three points
/// only.
fn runs_in(curve: &Curve, [lo, hi]: [f64; 2], surface: &Surface, resolution: f64) -> bool {
    [0.0, 0.23, 0.51, 0.77, 1.0].iter().all(|part| {
        let p = curve.point(lo + (hi - lo) * part);
        surface.distance(&p).is_within(resolution)
    })
}

/// The parameter of a point on an arc, within its range.
fn on_arc(curve: &Curve, [lo, hi]: [f64; 2], p: &Point3<f64>, near: f64) -> Option<f64> {
    let t = curve.in_cycle(curve.parameter(p), lo);
    (t.is_at_most(hi) && (curve.point(t) - p).norm().is_within(near)).then_some(t)
}

/// The limbs through a point of one of them; the nearest where rounding has moved the point.
fn limbs_through(limbs: &[Limb], p: &Point3<f64>, near: f64) -> Vec<usize> {
    if limbs.len() <= 1 {
        return (0..limbs.len()).collect();
    }
    let away = |limb: &Limb| (limb.curve.point(limb.curve.parameter(p)) - p).norm();
    let far: Vec<f64> = limbs.iter().map(away).collect();
    let least = far.iter().copied().fold(f64::INFINITY, f64::min);
    let close = |i: &usize| far[*i].is_within(near.max(least));
    (0..limbs.len()).filter(close).collect()
}

/// The edges of a face, each once.
fn face_edges(scene: &Scene<'_>, face: FaceId) -> Vec<EdgeId> {
    let mut edges: Vec<EdgeId> = scene.brep.topology.edges_of(face).collect();
    edges.sort_unstable();
    edges.dedup();
    edges
}
