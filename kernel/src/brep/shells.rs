//! Groups faces into shells and shells into solids. Faces that enclose material together along an
//! edge are one shell; an outer shell and the voids in it are one solid.

use super::Brep;
use super::assembly_error::AssemblyError;
use super::face_integrals::{shell_volume, size};
use super::point_in_solid::Closed;
use super::topology::{CoedgeId, FaceId, Lump, LumpId, Shell, ShellId, Topology};
use crate::geometry::vector::rounded;
use crate::hash::HashMap;
use crate::number::float::Float;
use crate::number::predicates::{Compare, Predicates};
use nalgebra::{Point3, Vector3};

/// A union-find structure.
struct Union(Vec<usize>);

impl Union {
    fn new(n: usize) -> Self {
        Self((0..n).collect())
    }
    fn find(&mut self, mut i: usize) -> usize {
        while self.0[i] != i {
            self.0[i] = self.0[self.0[i]];
            i = self.0[i];
        }
        i
    }
    fn join(&mut self, a: usize, b: usize) {
        let (a, b) = (self.find(a), self.find(b));
        let (lo, hi) = (a.min(b), a.max(b));
        self.0[hi] = lo;
    }
}

/// The connected components: the shell number of each face, and the Euler characteristic of each
/// shell.
pub(super) struct Fans {
    shell_of: Vec<usize>,
    euler: Vec<i32>,
    /// The number of fans of faces at each vertex.
    pub at_vertex: Vec<usize>,
}

pub(super) fn fans(topology: &Topology, partner: &[CoedgeId]) -> Fans {
    let mut faces = Union::new(topology.faces.len());
    for (i, p) in partner.iter().enumerate() {
        let (a, b) = (topology.face_of(CoedgeId(i as u32)), topology.face_of(*p));
        faces.join(a.index(), b.index());
    }
    let mut number: HashMap<usize, usize> = HashMap::default();
    let mut shell_of = Vec::new();
    for f in 0..topology.faces.len() {
        let n = number.len();
        shell_of.push(*number.entry(faces.find(f)).or_insert(n));
    }
    let mut euler = vec![0; number.len()];
    for (f, face) in topology.faces.iter().enumerate() {
        euler[shell_of[f]] += face.euler;
    }
    // A corner is where a coedge ends and the next begins. Corners that share an edge end belong to
    // one fan around the vertex. A corner is identified by the coedge that ends there.
    let mut corners = Union::new(topology.coedges.len());
    let mut ends_before = vec![usize::MAX; topology.coedges.len()];
    for ring in &topology.loops {
        for (k, c) in ring.coedges.iter().enumerate() {
            let previous = ring.coedges[(k + ring.coedges.len() - 1) % ring.coedges.len()];
            ends_before[c.index()] = previous.index();
        }
    }
    for (i, p) in partner.iter().enumerate() {
        let open = topology
            .edge(topology.coedge(CoedgeId(i as u32)).edge)
            .ends
            .is_some();
        if open {
            // Partners run in opposite directions: the end of one is the start of the other.
            corners.join(i, ends_before[p.index()]);
            if i < p.index() {
                let shell = shell_of[topology.face_of(CoedgeId(i as u32)).index()];
                euler[shell] -= 1;
            }
        }
    }
    let mut at_vertex = vec![0; topology.vertices as usize];
    for i in 0..topology.coedges.len() {
        let id = CoedgeId(i as u32);
        if let Some([_, end]) = topology.run(id)
            && corners.find(i) == i
        {
            euler[shell_of[topology.face_of(id).index()]] += 1;
            at_vertex[end.index()] += 1;
        }
    }
    Fans {
        shell_of,
        euler,
        at_vertex,
    }
}

/// Names the shells, distinguishes voids from outer shells, and assigns every void to its solid.
pub(super) fn bind_shells<N: Float>(
    brep: &mut Brep<N>,
    fans: &Fans,
    predicates: &Predicates,
) -> Result<(), AssemblyError> {
    for (f, &s) in fans.shell_of.iter().enumerate() {
        brep.topology.faces[f].shell = ShellId(s as u32);
    }
    let mut members: Vec<Vec<FaceId>> = vec![Vec::new(); fans.euler.len()];
    for (f, &s) in fans.shell_of.iter().enumerate() {
        members[s].push(FaceId(f as u32));
    }
    let volumes = name_shells(brep, fans, &members)?;
    let of_kind = |void: bool| -> Vec<usize> {
        let shells = brep.topology.shells.iter().enumerate();
        shells
            .filter(|(_, s)| s.void == void)
            .map(|(s, _)| s)
            .collect()
    };
    let (mut outer, voids) = (of_kind(false), of_kind(true));
    for &s in &outer {
        let id = LumpId(brep.topology.solids.len() as u32);
        brep.topology.solids.push(Lump {
            shells: vec![ShellId(s as u32)],
        });
        brep.topology.shells[s].solid = id;
    }
    outer.sort_by(|&a, &b| volumes[a].total_cmp(&volumes[b]));
    for VoidHome { void, home } in homes(brep, &voids, &outer, predicates)? {
        let solid = brep.topology.shells[home].solid;
        brep.topology.shells[void].solid = solid;
        let shells = &mut brep.topology.solids[solid.index()].shells;
        shells.push(ShellId(void as u32));
    }
    Ok(())
}

/// Creates the shells according to the side on which their material lies, and returns the volumes
/// that they enclose.
fn name_shells<N: Float>(
    brep: &mut Brep<N>,
    fans: &Fans,
    members: &[Vec<FaceId>],
) -> Result<Vec<N>, AssemblyError> {
    let size = size(brep);
    let mut volumes = Vec::new();
    for (s, faces) in members.iter().enumerate() {
        // A single shell is an outer one.
        let void = members.len() > 1 && {
            let enclosed = shell_volume(brep, faces, size);
            if !enclosed.is_clear() {
                return Err(AssemblyError::ZeroVolumeShell {
                    place: rounded(&point_of(brep, faces[0])),
                });
            }
            volumes.push(enclosed.volume);
            enclosed.volume.is_below_zero()
        };
        brep.topology.shells.push(Shell {
            faces: faces.clone(),
            solid: LumpId(u32::MAX),
            void,
            genus: (2 - fans.euler[s]).div_euclid(2),
            odd: fans.euler[s].rem_euclid(2) == 1,
        });
    }
    Ok(volumes)
}

/// A void, and the outer shell around it.
struct VoidHome {
    void: usize,
    home: usize,
}

/// The outer shell of each void: the smallest one that contains it. `outer` is sorted by volume.
fn homes<N: Float>(
    brep: &Brep<N>,
    voids: &[usize],
    outer: &[usize],
    predicates: &Predicates,
) -> Result<Vec<VoidHome>, AssemblyError> {
    if let [only] = outer {
        let home = *only;
        let voids = voids.iter().map(|&void| VoidHome { void, home });
        return Ok(voids.collect());
    }
    if voids.is_empty() {
        return Ok(Vec::new());
    }
    let closed = |shell: usize| {
        let faces = &brep.topology.shells[shell].faces;
        Closed::new(brep, faces, predicates.resolution())
    };
    let around: Vec<Closed<'_, N>> = outer.iter().map(|&s| closed(s)).collect();
    let home_of = |void: usize| {
        let place = || rounded(&point_of(brep, brep.topology.shells[void].faces[0]));
        let hollow = closed(void);
        let fits = |k: &usize| {
            let b = around[*k].bounds.grown(predicates.resolution::<N>());
            b.encloses(&hollow.bounds)
        };
        let mut may: Vec<usize> = (0..outer.len()).filter(fits).collect();
        // If no other shell can contain the void, the last one does.
        let last = may.pop();
        for k in may {
            match around[k].enclosing(&hollow) {
                Some(true) => {
                    let home = outer[k];
                    return Ok(VoidHome { void, home });
                }
                Some(false) => {}
                None => return Err(AssemblyError::OrphanVoid { place: place() }),
            }
        }
        let last = last.ok_or_else(|| AssemblyError::OrphanVoid { place: place() });
        let home = outer[last?];
        Ok(VoidHome { void, home })
    };
    voids.iter().map(|&void| home_of(void)).collect()
}

/// A point on a face's boundary, or in the face if it has none.
pub(super) fn point_of<N: Float>(brep: &Brep<N>, face: FaceId) -> Point3<N> {
    let topology = &brep.topology;
    match topology.face(face).loops.first() {
        Some(&l) => {
            let edge = topology.coedge(topology.ring(l).coedges[0]).edge;
            let [lo, hi] = brep.range(edge);
            brep.curve(edge).point(lo + N::from_f64(0.37) * (hi - lo))
        }
        None => {
            let s = brep.surface(face);
            s.point(N::from_f64(0.3), N::from_f64(0.4)) + Vector3::zeros()
        }
    }
}
