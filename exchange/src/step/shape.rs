//! Surfaces, curves, edges, faces and solids.

use super::StepError;
use super::part21::{Exchange, Id, List, Real, Reals, Truth};
use crate::parameters::ParameterWindow;
use crate::spline::{BezierSegments, DEGREE, Follow, Pace, Spline};
use crate::two_manifold::{SeamedEdge, SeamedFace, TwoManifold};
use nalgebra::{Point3, Vector3};
use premio_kernel::brep::topology::{FaceId, Sense};
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Cone, Surface, Torus};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

/// Writes the shape of a part.
pub(super) struct Shape<'s, 'e> {
    pub(super) exchange: &'e mut Exchange,
    pub(super) seamed: &'s TwoManifold<'s>,
    accuracy: f64,
    /// The context of the curves in the parameters of surfaces.
    parametric: Option<Id>,
    vertices: Vec<Option<Id>>,
    edges: Vec<Option<Id>>,
    surfaces: Vec<Placed>,
    /// The faces written so far, with those of the boundary.
    faces: Vec<WrittenFace>,
    /// The faces on both sides of each edge.
    sides: Vec<Vec<usize>>,
}

/// The placement of a face's surface in the file.
#[derive(Clone, Copy)]
struct Placed {
    id: Id,
    /// The value of the second parameter from which the file measures it: for a cone a height above
    /// the apex, for a torus that reaches its axis the lower pole.
    level: f64,
}

/// A face in the file.
#[derive(Clone, Copy)]
pub(super) struct WrittenFace {
    pub id: Id,
    /// The face of the boundary that contains it.
    pub source: FaceId,
}

impl<'s, 'e> Shape<'s, 'e> {
    pub fn new(exchange: &'e mut Exchange, seamed: &'s TwoManifold<'s>, accuracy: f64) -> Self {
        let mut sides = vec![Vec::new(); seamed.edges.len()];
        for (f, face) in seamed.faces.iter().enumerate() {
            for half in face.loops.iter().flatten() {
                sides[half.edge].push(f);
            }
        }
        Self {
            exchange,
            seamed,
            accuracy,
            parametric: None,
            vertices: vec![None; seamed.points.len()],
            edges: vec![None; seamed.edges.len()],
            surfaces: Vec::new(),
            faces: Vec::new(),
            sides,
        }
    }

    /// All solids.
    pub fn solids(&mut self) -> Result<Vec<Id>, StepError> {
        for face in &self.seamed.faces {
            let placed = self.surface(face);
            self.surfaces.push(placed);
        }
        let solids = &self.seamed.solids;
        solids.iter().map(|shells| self.solid(shells)).collect()
    }

    fn solid(&mut self, shells: &[Vec<usize>]) -> Result<Id, StepError> {
        let mut closed = Vec::with_capacity(shells.len());
        for faces in shells {
            let faces: Result<Vec<Id>, StepError> = faces.iter().map(|&f| self.face(f)).collect();
            closed.push(
                self.exchange
                    .add(format_args!("CLOSED_SHELL('',{})", List(&faces?))),
            );
        }
        let outer = closed[0];
        if closed.len() == 1 {
            return Ok(self
                .exchange
                .add(format_args!("MANIFOLD_SOLID_BREP('',{outer})")));
        }
        let oriented = closed[1..].iter().map(|shell| {
            self.exchange
                .add(format_args!("ORIENTED_CLOSED_SHELL('',*,{shell},.T.)"))
        });
        let voids: Vec<Id> = oriented.collect();
        Ok(self
            .exchange
            .add(format_args!("BREP_WITH_VOIDS('',{outer},{})", List(&voids))))
    }

    fn face(&mut self, index: usize) -> Result<Id, StepError> {
        let face = &self.seamed.faces[index];
        let mut bounds = Vec::with_capacity(face.loops.len());
        for (k, ring) in face.loops.iter().enumerate() {
            let mut oriented = Vec::with_capacity(ring.len());
            for half in ring {
                let id = self.edge(half.edge)?;
                let along = Truth(half.sense == Sense::Along);
                oriented.push(
                    self.exchange
                        .add(format_args!("ORIENTED_EDGE('',*,*,{id},{along})")),
                );
            }
            let ring = self
                .exchange
                .add(format_args!("EDGE_LOOP('',{})", List(&oriented)));
            let kind = if k == 0 {
                "FACE_OUTER_BOUND"
            } else {
                "FACE_BOUND"
            };
            bounds.push(self.exchange.add(format_args!("{kind}('',{ring},.T.)")));
        }
        let surface = self.surfaces[index].id;
        let along = Truth(face.sense == Sense::Along);
        let id = self.exchange.add(format_args!(
            "ADVANCED_FACE('',{},{surface},{along})",
            List(&bounds)
        ));
        let source = face.source;
        self.faces.push(WrittenFace { id, source });
        Ok(id)
    }

    /// The faces written so far.
    pub fn take_faces(&mut self) -> Vec<WrittenFace> {
        std::mem::take(&mut self.faces)
    }

    fn edge(&mut self, index: usize) -> Result<Id, StepError> {
        if let Some(id) = self.edges[index] {
            return Ok(id);
        }
        let edge = &self.seamed.edges[index];
        let [from, to] = edge.ends.map(|v| self.vertex(v));
        let curve = self.curve(index, edge)?;
        let id = self
            .exchange
            .add(format_args!("EDGE_CURVE('',{from},{to},{curve},.T.)"));
        self.edges[index] = Some(id);
        Ok(id)
    }

    fn vertex(&mut self, index: usize) -> Id {
        if let Some(id) = self.vertices[index] {
            return id;
        }
        let point = self.point(&self.seamed.points[index]);
        let id = self.exchange.add(format_args!("VERTEX_POINT('',{point})"));
        self.vertices[index] = Some(id);
        id
    }

    pub(super) fn point(&mut self, p: &Point3<f64>) -> Id {
        let place = Reals(p.coords.as_slice());
        self.exchange
            .add(format_args!("CARTESIAN_POINT('',{place})"))
    }

    fn direction(&mut self, d: &Vector3<f64>) -> Id {
        let ratios = Reals(d.as_slice());
        self.exchange.add(format_args!("DIRECTION('',{ratios})"))
    }

    fn placement(&mut self, frame: &Frame) -> Id {
        let origin = self.point(&frame.origin);
        let [z, x] = [&frame.z, &frame.x].map(|d| self.direction(d));
        self.exchange
            .add(format_args!("AXIS2_PLACEMENT_3D('',{origin},{z},{x})"))
    }

    fn surface(&mut self, face: &SeamedFace) -> Placed {
        let mut level = 0.0;
        let surface = &face.window.surface;
        let mut frame = *surface.frame();
        if let Surface::Cone(_) = surface {
            level = self.top(face);
            frame = frame.at(frame.point(0.0, 0.0, level));
        }
        if let Surface::Torus(s) = surface
            && !s.is_ring()
        {
            return Placed {
                id: self.revolution(s),
                level: -s.pole_angle(),
            };
        }
        if surface.is_elliptic() {
            let id = match surface {
                Surface::Ellipsoid(s) => self.ellipsoid(s, face.window.starts[0]),
                _ => self.elliptic_surface(face),
            };
            return Placed { id, level };
        }
        let placement = self.placement(&frame);
        let entity = match surface {
            Surface::Cylinder(s) => {
                format!("CYLINDRICAL_SURFACE('',{placement},{})", Real(s.radius))
            }
            Surface::Cone(s) => {
                let (radius, angle) = (Real(level * s.sin / s.cos), Real(half_angle(s)));
                format!("CONICAL_SURFACE('',{placement},{radius},{angle})")
            }
            Surface::Sphere(s) => {
                format!("SPHERICAL_SURFACE('',{placement},{})", Real(s.radius))
            }
            Surface::Torus(s) => {
                let (major, minor) = (Real(s.major), Real(s.minor));
                format!("TOROIDAL_SURFACE('',{placement},{major},{minor})")
            }
            Surface::Plane(_)
            | Surface::EllipticCylinder(_)
            | Surface::EllipticCone(_)
            | Surface::Ellipsoid(_) => {
                format!("PLANE('',{placement})")
            }
        };
        let id = self.exchange.add(format_args!("{entity}"));
        Placed { id, level }
    }

    /// A torus that reaches its axis, as the surface of revolution of the part of its tube from pole
    /// to pole, which starts at the lower pole.
    fn revolution(&mut self, s: &Torus) -> Id {
        let end = s.pole_angle();
        let (sin, cos) = end.sin_cos();
        let (f, axis) = (&s.frame, -s.frame.y);
        let x = f.x * cos - f.z * sin;
        let frame = Frame {
            origin: f.origin + f.x * s.major,
            x,
            y: axis.cross(&x),
            z: axis,
        };
        let circle = self.conic("CIRCLE", &frame, &[s.minor]);
        let meridian = self.exchange.add(format_args!(
            "TRIMMED_CURVE('',{circle},(PARAMETER_VALUE(0.)),(PARAMETER_VALUE({})),.T.,.PARAMETER.)",
            Real(2.0 * end)
        ));
        let [origin, z] = [self.point(&f.origin), self.direction(&f.z)];
        let about = self
            .exchange
            .add(format_args!("AXIS1_PLACEMENT('',{origin},{z})"));
        self.exchange
            .add(format_args!("SURFACE_OF_REVOLUTION('',{meridian},{about})"))
    }

    /// The height of the highest vertex of a face above its cone's apex.
    fn top(&self, face: &SeamedFace) -> f64 {
        let edges = face.loops.iter().flatten();
        let vertices = edges.flat_map(|half| self.seamed.edges[half.edge].ends);
        let frame = face.window.surface.frame();
        let heights = vertices.map(|v| frame.coordinates(&self.seamed.points[v]).z);
        heights.fold(0.0, f64::max)
    }

    fn curve(&mut self, index: usize, edge: &SeamedEdge<'_>) -> Result<Id, StepError> {
        let edge = &started_far_from_zero(edge);
        let bent = |&f: &usize| needs_parameter_curve(edge, &self.seamed.faces[f].window);
        let is_bent = self.sides[index].iter().any(bent);
        let id = match &*edge.curve {
            Curve::Line(c) => {
                let origin = self.point(&c.origin);
                let direction = self.direction(&c.direction);
                let vector = self.exchange.add(format_args!("VECTOR('',{direction},1.)"));
                return Ok(self
                    .exchange
                    .add(format_args!("LINE('',{origin},{vector})")));
            }
            Curve::Circle(c) => self.conic("CIRCLE", &c.frame, &[c.radius]),
            Curve::Ellipse(c) => self.conic("ELLIPSE", &c.frame, &[c.a, c.b]),
            Curve::Hyperbola(c) if !(is_bent && is_sharp(edge, c.a.min(c.b))) => {
                self.conic("HYPERBOLA", &c.frame, &[c.a, c.b])
            }
            // Readers disagree on the parameter of a parabola, which matters if another curve
            // shares it.
            Curve::Conic(c) if c.is_parabola() && !is_bent => {
                self.conic("PARABOLA", &c.frame, &[0.5 / c.curvature])
            }
            Curve::Hyperbola(_) | Curve::Conic(_) | Curve::Quartic(_) | Curve::Toric(_) => {
                let sides = self.sides[index].clone();
                let BezierSegments { space, on } = self.course(edge, &sides, Pace::Length)?;
                let space = self.spline(&space);
                return Ok(self.surface_curve(space, &sides, on));
            }
        };
        let mut sides = self.sides[index].clone();
        sides.retain(|&f| needs_parameter_curve(edge, &self.seamed.faces[f].window));
        if sides.is_empty() {
            return Ok(id);
        }
        let BezierSegments { on, .. } = self.course(edge, &sides, Pace::Parameter)?;
        Ok(self.surface_curve(id, &sides, on))
    }

    fn conic(&mut self, name: &str, frame: &Frame, sizes: &[f64]) -> Id {
        let placement = self.placement(frame);
        let mut all = String::new();
        for size in sizes {
            all.push_str(&format!(",{}", Real(*size)));
        }
        self.exchange
            .add(format_args!("{name}('',{placement}{all})"))
    }

    /// The splines that approximate an edge, in space and on some of the adjacent faces.
    fn course(
        &self,
        edge: &SeamedEdge<'_>,
        sides: &[usize],
        pace: Pace,
    ) -> Result<BezierSegments, StepError> {
        let windows: Vec<ParameterWindow> =
            sides.iter().map(|&f| self.seamed.faces[f].window).collect();
        let follow = Follow {
            pace,
            curve: &edge.curve,
            range: edge.range,
            windows: &windows,
            accuracy: self.accuracy,
        };
        Ok(follow.course()?)
    }

    /// A curve with the curves that represent it in the parameters of faces.
    fn surface_curve(&mut self, curve: Id, sides: &[usize], on: Vec<Spline<2>>) -> Id {
        let mut all = Vec::with_capacity(on.len());
        for (face, mut on) in sides.iter().zip(on) {
            let Placed { id, level } = self.surfaces[*face];
            for p in &mut on.points {
                p[1] -= level;
            }
            let on = self.spline(&on);
            let context = self.parametric();
            let representation = self.exchange.add(format_args!(
                "DEFINITIONAL_REPRESENTATION('',({on}),{context})"
            ));
            all.push(
                self.exchange
                    .add(format_args!("PCURVE('',{id},{representation})")),
            );
        }
        self.exchange.add(format_args!(
            "SURFACE_CURVE('',{curve},{},.CURVE_3D.)",
            List(&all)
        ))
    }

    fn parametric(&mut self) -> Id {
        let exchange = &mut self.exchange;
        *self.parametric.get_or_insert_with(|| {
            exchange.add(format_args!(
                "(GEOMETRIC_REPRESENTATION_CONTEXT(2)PARAMETRIC_REPRESENTATION_CONTEXT()\
                 REPRESENTATION_CONTEXT('2D SPACE',''))"
            ))
        })
    }

    fn spline<const D: usize>(&mut self, spline: &Spline<D>) -> Id {
        let points = spline.points.iter().map(|p| {
            self.exchange
                .add(format_args!("CARTESIAN_POINT('',{})", Reals(p)))
        });
        let points: Vec<Id> = points.collect();
        let counts: Vec<usize> = spline.multiplicities().collect();
        self.exchange.add(format_args!(
            "B_SPLINE_CURVE_WITH_KNOTS('',{DEGREE},{},.UNSPECIFIED.,.F.,.F.,{},{},.UNSPECIFIED.)",
            List(&points),
            List(&counts),
            Reals(&spline.knots)
        ))
    }
}

/// The same edge. On a circle or an ellipse the parameter of its start is moved to the half period
/// about the middle of the period. Readers compute the parameters of an edge's ends from its
/// vertices, and rounding turns zero into a whole period.
fn started_far_from_zero<'a>(edge: &SeamedEdge<'a>) -> SeamedEdge<'a> {
    let mut edge = edge.clone();
    let frame = match edge.curve.to_mut() {
        Curve::Circle(c) => &mut c.frame,
        Curve::Ellipse(c) => &mut c.frame,
        _ => return edge,
    };
    let [lo, hi] = edge.range;
    let mut start = lo.rem_euclid(TAU);
    if (start - PI).abs() > FRAC_PI_2 {
        frame.x = -frame.x;
        frame.y = -frame.y;
        start = (start + PI).rem_euclid(TAU);
    }
    edge.range = [start, start + (hi - lo)];
    edge
}

fn half_angle(cone: &Cone) -> f64 {
    cone.sin.atan2(cone.cos)
}

/// Whether a file gives the curve of an edge in the parameters of a surface. Readers find a straight
/// line or a conic in the parameters of an elementary surface by themselves, and a seam always.
fn needs_parameter_curve(edge: &SeamedEdge<'_>, window: &ParameterWindow) -> bool {
    if edge.source.is_none() || matches!(window.surface, Surface::Plane(_)) {
        return false;
    }
    let is_swept = matches!(window.surface, Surface::Torus(torus) if !torus.is_ring());
    if is_swept || window.surface.is_elliptic() {
        return true;
    }
    bends(edge, window)
}

/// Whether an edge is neither a straight line nor a conic in the parameters of a surface: both of
/// them change, and one is an angle.
fn bends(edge: &SeamedEdge<'_>, window: &ParameterWindow) -> bool {
    let [lo, hi] = edge.range;
    let on = |k: u32| window.parameters_at(&edge.curve.point(lo + (hi - lo) * f64::from(k) / 8.0));
    let middle = on(4);
    let size = |i: usize| {
        if window.surface.periods()[i].is_some() {
            1.0
        } else {
            middle[i].abs()
        }
    };
    let changes = |i: usize| {
        let away = |k: u32| (window.nearest_equivalent(i, on(k)[i], middle[i]) - middle[i]).abs();
        (0..=8).any(|k| away(k) > LEVEL * size(i))
    };
    changes(0) && changes(1)
}

/// Whether an edge turns within much less than its length, about a semi-axis. Its parameter then
/// determines the position poorly.
fn is_sharp(edge: &SeamedEdge<'_>, semi_axis: f64) -> bool {
    let [from, to] = edge.range.map(|t| edge.curve.point(t));
    semi_axis < SHARP * (to - from).norm()
}

/// The ratio of the semi-axis to the edge's length below which a hyperbola is sharp.
const SHARP: f64 = 1.0 / 1024.0;

/// The relative change below which a parameter is constant.
const LEVEL: f64 = 1.0 / (1u64 << 36) as f64;
