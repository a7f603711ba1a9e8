//! Parts built by hand.
#![allow(dead_code)]

use nalgebra::{Point3, Vector3};
use premio_kernel::brep::topology::*;
use premio_kernel::brep::{Brep, EdgeGeometry, FaceGeometry};
use premio_kernel::geometry::curve::{Circle, Curve, Line};
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Cone, Cylinder, Plane, Sphere, Surface, Torus};
use std::collections::HashMap;
use std::f64::consts::TAU;

/// The resolution of all these parts.
pub const BAND: f64 = 1e-10;

#[derive(Default)]
pub struct Builder {
    pub brep: Brep,
    lines: HashMap<(u32, u32), EdgeId>,
}

impl Builder {
    pub fn vertex(&mut self, p: Point3<f64>) -> VertexId {
        self.brep.geometry.points.push(p);
        self.brep.topology.vertices += 1;
        VertexId(self.brep.topology.vertices - 1)
    }

    pub fn edge(&mut self, curve: Curve, range: [f64; 2], ends: Option<[VertexId; 2]>) -> EdgeId {
        self.brep.geometry.curves.push(curve);
        let curve = self.brep.geometry.curves.len() - 1;
        self.brep.geometry.arcs.push(EdgeGeometry { curve, range });
        self.brep.topology.edges.push(Edge {
            ends,
            coedges: Vec::new(),
            smooth: false,
        });
        EdgeId(self.brep.topology.edges.len() as u32 - 1)
    }

    pub fn circle(&mut self, frame: Frame, radius: f64) -> EdgeId {
        self.edge(Curve::Circle(Circle { frame, radius }), [0.0, TAU], None)
    }

    /// The edge between two vertices, with the sense in which it runs from `a` to `b`.
    pub fn between(&mut self, a: VertexId, b: VertexId) -> (EdgeId, Sense) {
        if let Some(&e) = self.lines.get(&(b.0, a.0)) {
            return (e, Sense::Against);
        }
        let (p, q) = (self.brep.point(a), self.brep.point(b));
        let d = q - p;
        let line = Curve::Line(Line {
            origin: p,
            direction: d.normalize(),
        });
        let e = self.edge(line, [0.0, d.norm()], Some([a, b]));
        self.lines.insert((a.0, b.0), e);
        (e, Sense::Along)
    }

    pub fn face(
        &mut self,
        surface: Surface,
        sense: Sense,
        loops: &[Vec<(EdgeId, Sense)>],
    ) -> FaceId {
        let t = &mut self.brep.topology;
        self.brep.geometry.surfaces.push(surface);
        self.brep.geometry.patches.push(FaceGeometry {
            surface: self.brep.geometry.surfaces.len() - 1,
            sense,
        });
        let face = FaceId(t.faces.len() as u32);
        let mut ids = Vec::new();
        for ring in loops {
            let owner = LoopId(t.loops.len() as u32);
            let mut coedges = Vec::new();
            for &(edge, sense) in ring {
                let id = CoedgeId(t.coedges.len() as u32);
                t.coedges.push(Coedge { edge, sense, owner });
                t.edges[edge.index()].coedges.push(id);
                coedges.push(id);
            }
            t.loops.push(Loop { coedges, face });
            ids.push(owner);
        }
        t.faces.push(Face {
            loops: ids,
            shell: ShellId(0),
            euler: 0,
        });
        face
    }

    pub fn polygon(&mut self, corners: &[VertexId], holes: &[Vec<(EdgeId, Sense)>]) -> FaceId {
        let p: Vec<_> = corners.iter().map(|&v| self.brep.point(v)).collect();
        let z = (p[1] - p[0]).cross(&(p[2] - p[1])).normalize();
        let frame = Frame::toward(p[0], z, p[1] - p[0]);
        let n = corners.len();
        let ring = (0..n)
            .map(|i| self.between(corners[i], corners[(i + 1) % n]))
            .collect();
        let mut loops = vec![ring];
        loops.extend_from_slice(holes);
        self.face(Surface::Plane(Plane { frame }), Sense::Along, &loops)
    }

    /// A block with through holes along its z, in the given frame.
    pub fn block(&mut self, f: &Frame, size: [f64; 3], holes: &[(f64, f64, f64)]) {
        let v: Vec<VertexId> = (0..8)
            .map(|k| {
                let pick = |i: usize| if k >> i & 1 == 1 { size[i] } else { 0.0 };
                let p = f.point(pick(0), pick(1), pick(2));
                self.vertex(p)
            })
            .collect();
        let (mut low, mut high) = (Vec::new(), Vec::new());
        for &(x, y, radius) in holes {
            let at = |z: f64| f.at(f.point(x, y, z));
            let (a, b) = (
                self.circle(at(0.0), radius),
                self.circle(at(size[2]), radius),
            );
            low.push(vec![(a, Sense::Along)]);
            high.push(vec![(b, Sense::Against)]);
            let wall = Surface::Cylinder(Cylinder {
                frame: at(0.0),
                radius,
            });
            self.face(
                wall,
                Sense::Against,
                &[vec![(a, Sense::Against)], vec![(b, Sense::Along)]],
            );
        }
        self.polygon(&[v[0], v[2], v[3], v[1]], &low);
        self.polygon(&[v[4], v[5], v[7], v[6]], &high);
        self.polygon(&[v[0], v[1], v[5], v[4]], &[]);
        self.polygon(&[v[2], v[6], v[7], v[3]], &[]);
        self.polygon(&[v[0], v[4], v[6], v[2]], &[]);
        self.polygon(&[v[1], v[3], v[7], v[5]], &[]);
    }

    pub fn cylinder(&mut self, f: &Frame, radius: f64, height: f64) {
        let low = self.circle(*f, radius);
        let top = f.at(f.point(0.0, 0.0, height));
        let high = self.circle(top, radius);
        self.face(
            Surface::Cylinder(Cylinder { frame: *f, radius }),
            Sense::Along,
            &[vec![(low, Sense::Along)], vec![(high, Sense::Against)]],
        );
        self.face(
            Surface::Plane(Plane { frame: top }),
            Sense::Along,
            &[vec![(high, Sense::Along)]],
        );
        self.face(
            Surface::Plane(Plane { frame: *f }),
            Sense::Against,
            &[vec![(low, Sense::Against)]],
        );
    }

    pub fn cone(&mut self, f: &Frame, sin: f64, height: f64) {
        let cos = (1.0 - sin * sin).sqrt();
        let base = f.at(f.point(0.0, 0.0, height));
        let rim = self.circle(base, height * sin / cos);
        self.face(
            Surface::Cone(Cone {
                frame: *f,
                sin,
                cos,
            }),
            Sense::Along,
            &[vec![(rim, Sense::Against)]],
        );
        self.face(
            Surface::Plane(Plane { frame: base }),
            Sense::Along,
            &[vec![(rim, Sense::Along)]],
        );
    }

    pub fn sphere(&mut self, f: &Frame, radius: f64) {
        self.face(
            Surface::Sphere(Sphere { frame: *f, radius }),
            Sense::Along,
            &[],
        );
    }

    pub fn torus(&mut self, f: &Frame, major: f64, minor: f64) {
        let torus = Torus {
            frame: *f,
            major,
            minor,
        };
        self.face(Surface::Torus(torus), Sense::Along, &[]);
    }
}

pub fn block(size: [f64; 3]) -> Brep {
    let mut b = Builder::default();
    b.block(&Frame::world(), size, &[]);
    b.brep
}

pub fn tilted() -> Frame {
    let z = Vector3::new(0.3, -0.4, 0.7).normalize();
    Frame::toward(Point3::new(1.0, -2.0, 0.5), z, Vector3::new(1.0, 0.2, 0.0))
}

pub fn plate(n: u32, thickness: f64) -> Brep {
    let holes: Vec<(f64, f64, f64)> = (0..n * n)
        .map(|k| (f64::from(k % n) + 0.5, f64::from(k / n) + 0.5, 0.3))
        .collect();
    let mut b = Builder::default();
    b.block(
        &Frame::world(),
        [f64::from(n), f64::from(n), thickness],
        &holes,
    );
    b.brep
}
