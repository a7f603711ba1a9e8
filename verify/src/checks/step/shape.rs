//! The solids of a STEP file: shells, faces, loops and edges with their curves and surfaces.

use super::curve::{Placement, StepCurve, StepSpline};
use super::part21::{Instances, StepEntity, StepInstance, StepReadError, StepValue};
use super::spline_net::SplineNet;
use super::surface::{StepSurface, SurfaceForm};
use nalgebra::{Point3, Vector3};
use std::collections::{HashMap, HashSet};
use std::f64::consts::TAU;

/// An edge.
#[derive(Clone, Debug)]
pub struct StepEdge {
    /// The numbers of the vertices at its start and its end.
    pub ends: [u32; 2],
    pub points: [Point3<f64>; 2],
    pub curve: StepCurve,
    /// The curves in the parameters of surfaces.
    pub on: Vec<ParametricCurve>,
    /// The parameters of its ends, as a reader computes them.
    pub range: [f64; 2],
}

/// A curve in the parameters of a surface.
#[derive(Clone, Debug)]
pub struct ParametricCurve {
    /// The number of the surface.
    pub surface: u32,
    pub spline: StepSpline<2>,
}

/// The use of an edge by a loop.
#[derive(Clone, Copy, Debug)]
pub struct StepEdgeUse {
    pub edge: u32,
    pub along: bool,
}

/// A face.
#[derive(Clone, Debug)]
pub struct StepFace {
    /// The number of its surface.
    pub surface: u32,
    /// Whether the outward normal is the surface's.
    pub along: bool,
    pub loops: Vec<Vec<StepEdgeUse>>,
}

/// The contents of a file.
#[derive(Clone, Debug, Default)]
pub struct StepShape {
    pub edges: HashMap<u32, StepEdge>,
    pub surfaces: HashMap<u32, StepSurface>,
    /// The faces of each shell of each solid, the outer shell first.
    pub solids: Vec<Vec<Vec<StepFace>>>,
}

/// What a reader takes for granted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepOrigin {
    /// This program wrote the file: bounds and edges are not turned, and curves in parameters are
    /// splines.
    Ours,
    /// Another program wrote it: bounds and edges may be turned, and curves in parameters are left
    /// out.
    Others,
}

impl StepShape {
    /// The solids of a file.
    pub fn new(instances: &Instances, origin: StepOrigin) -> Result<Self, StepReadError> {
        let mut reader = Reader {
            instances,
            origin,
            turned: HashSet::new(),
            shape: Self::default(),
        };
        let mut solids: Vec<u32> = Vec::new();
        for (id, instance) in instances {
            let is_solid = |name| instance.parts.iter().any(|part| part.name == name);
            if is_solid("MANIFOLD_SOLID_BREP") || is_solid("BREP_WITH_VOIDS") {
                solids.push(*id);
            }
        }
        solids.sort_unstable();
        for id in solids {
            let shells = reader.solid(id)?;
            reader.shape.solids.push(shells);
        }
        Ok(reader.shape)
    }
}

/// The distance of a spline's end from a vertex that is taken for it, relative to the edge's ends.
const CLOSE: f64 = 1.0 / (1 << 20) as f64;

/// The deviation, relative to the size, within which points are the same and directions are at right
/// angles.
const SAME_POINT: f64 = 1.0 / (1u64 << 32) as f64;

struct Reader<'i> {
    instances: &'i Instances,
    origin: StepOrigin,
    /// The edges that run against their curves; they are read along them.
    turned: HashSet<u32>,
    shape: StepShape,
}

/// An instance with its number, for error messages.
#[derive(Clone, Copy)]
struct Entity<'i> {
    id: u32,
    name: &'i str,
    values: &'i [StepValue],
}

/// A list of rows of values, each converted.
fn rows<T>(
    entity: &Entity<'_>,
    k: usize,
    of: impl Fn(&StepValue) -> Result<T, StepReadError>,
) -> Result<Vec<Vec<T>>, StepReadError> {
    let row = |row: &StepValue| match row {
        StepValue::List(values) => values.iter().map(&of).collect(),
        _ => Err(entity.wrong("rows")),
    };
    entity.list(k)?.iter().map(row).collect()
}

impl<'i> Entity<'i> {
    fn wrong(&self, expected: &'static str) -> StepReadError {
        let id = self.id;
        StepReadError::Instance { id, expected }
    }

    fn value(&self, k: usize) -> Result<&'i StepValue, StepReadError> {
        self.values
            .get(k)
            .ok_or_else(|| self.wrong("more parameters"))
    }

    fn instance(&self, k: usize) -> Result<u32, StepReadError> {
        match self.value(k)? {
            StepValue::Instance(id) => Ok(*id),
            _ => Err(self.wrong("an instance")),
        }
    }

    fn number(&self, k: usize) -> Result<f64, StepReadError> {
        match self.value(k)? {
            StepValue::Number(x) => Ok(*x),
            _ => Err(self.wrong("a number")),
        }
    }

    fn truth(&self, k: usize) -> Result<bool, StepReadError> {
        match self.value(k)? {
            StepValue::Enumeration(name) if name == "T" => Ok(true),
            StepValue::Enumeration(name) if name == "F" => Ok(false),
            _ => Err(self.wrong("a truth value")),
        }
    }

    fn list(&self, k: usize) -> Result<&'i [StepValue], StepReadError> {
        match self.value(k)? {
            StepValue::List(values) => Ok(values),
            _ => Err(self.wrong("a list")),
        }
    }

    fn instances(&self, k: usize) -> Result<Vec<u32>, StepReadError> {
        let of = |value: &StepValue| match value {
            StepValue::Instance(id) => Ok(*id),
            _ => Err(self.wrong("a list of instances")),
        };
        self.list(k)?.iter().map(of).collect()
    }

    fn numbers(&self, k: usize) -> Result<Vec<f64>, StepReadError> {
        let of = |value: &StepValue| match value {
            StepValue::Number(x) => Ok(*x),
            _ => Err(self.wrong("a list of numbers")),
        };
        self.list(k)?.iter().map(of).collect()
    }
}

impl<'i> Reader<'i> {
    fn entity(&self, id: u32) -> Result<Entity<'i>, StepReadError> {
        let expected = "an instance of one entity";
        match self.instances.get(&id) {
            Some(StepInstance { parts }) if parts.len() == 1 => Ok(Entity {
                id,
                name: &parts[0].name,
                values: &parts[0].values,
            }),
            _ => Err(StepReadError::Instance { id, expected }),
        }
    }

    fn named(&self, id: u32, name: &'static str) -> Result<Entity<'i>, StepReadError> {
        let entity = self.entity(id)?;
        match entity.name == name {
            true => Ok(entity),
            false => Err(entity.wrong(name)),
        }
    }

    fn solid(&mut self, id: u32) -> Result<Vec<Vec<StepFace>>, StepReadError> {
        let solid = self.entity(id)?;
        let mut shells = vec![self.shell(solid.instance(1)?)?];
        if solid.name == "BREP_WITH_VOIDS" {
            for void in solid.instances(2)? {
                let oriented = self.named(void, "ORIENTED_CLOSED_SHELL")?;
                if !oriented.truth(3)? {
                    return Err(oriented.wrong("a shell that is not turned"));
                }
                shells.push(self.shell(oriented.instance(2)?)?);
            }
        }
        Ok(shells)
    }

    fn shell(&mut self, id: u32) -> Result<Vec<StepFace>, StepReadError> {
        let faces = self.named(id, "CLOSED_SHELL")?.instances(1)?;
        faces.into_iter().map(|face| self.face(face)).collect()
    }

    fn face(&mut self, id: u32) -> Result<StepFace, StepReadError> {
        let face = self.named(id, "ADVANCED_FACE")?;
        let surface = face.instance(2)?;
        if !self.shape.surfaces.contains_key(&surface) {
            let made = self.surface(surface)?;
            self.shape.surfaces.insert(surface, made);
        }
        let mut loops = Vec::new();
        for bound in face.instances(1)? {
            let bound = self.entity(bound)?;
            let is_turned = !bound.truth(2)?;
            if is_turned && self.origin == StepOrigin::Ours {
                return Err(bound.wrong("a bound that is not turned"));
            }
            let ring = self.named(bound.instance(1)?, "EDGE_LOOP")?;
            let mut uses = Vec::new();
            for oriented in ring.instances(1)? {
                let oriented = self.named(oriented, "ORIENTED_EDGE")?;
                let edge = oriented.instance(3)?;
                self.add_edge(edge)?;
                let along = oriented.truth(4)? != self.turned.contains(&edge);
                uses.push(StepEdgeUse { edge, along });
            }
            if is_turned {
                uses.reverse();
                uses.iter_mut().for_each(|used| used.along = !used.along);
            }
            loops.push(uses);
        }
        Ok(StepFace {
            surface,
            along: face.truth(3)?,
            loops,
        })
    }

    fn add_edge(&mut self, id: u32) -> Result<(), StepReadError> {
        if self.shape.edges.contains_key(&id) {
            return Ok(());
        }
        let edge = self.named(id, "EDGE_CURVE")?;
        let mut ends = [edge.instance(1)?, edge.instance(2)?];
        match (edge.truth(4)?, self.origin) {
            (true, _) => {}
            (false, StepOrigin::Ours) => return Err(edge.wrong("an edge along its curve")),
            (false, StepOrigin::Others) => {
                ends.reverse();
                self.turned.insert(id);
            }
        }
        let mut points = [Point3::origin(); 2];
        for (point, vertex) in points.iter_mut().zip(ends) {
            *point = self.point(self.named(vertex, "VERTEX_POINT")?.instance(1)?)?;
        }
        let mut curve = self.entity(edge.instance(3)?)?;
        let mut on = Vec::new();
        let on_surfaces = ["SURFACE_CURVE", "SEAM_CURVE", "INTERSECTION_CURVE"];
        if self.origin == StepOrigin::Others && on_surfaces.contains(&curve.name) {
            curve = self.entity(curve.instance(1)?)?;
        } else if curve.name == "SURFACE_CURVE" {
            for pcurve in curve.instances(2)? {
                let pcurve = self.named(pcurve, "PCURVE")?;
                let represented = self.named(pcurve.instance(2)?, "DEFINITIONAL_REPRESENTATION")?;
                let [spline] = represented.instances(1)?[..] else {
                    return Err(represented.wrong("one curve"));
                };
                on.push(ParametricCurve {
                    surface: pcurve.instance(1)?,
                    spline: self.spline(spline)?,
                });
            }
            curve = self.entity(curve.instance(1)?)?;
        }
        let curve = self.curve(&curve)?;
        let [mut lo, mut hi] = [0, 1].map(|k| curve.parameter(&points[k], k == 0));
        if let (StepOrigin::Others, StepCurve::Spline(spline)) = (self.origin, &curve)
            && ends[0] != ends[1]
        {
            // The edge may be a piece of the spline.
            let range = [lo, hi];
            let is_end = |k: usize| {
                let end = Point3::from(spline.at(range[k])[0]);
                (end - points[k]).norm() <= CLOSE * (points[1] - points[0]).norm()
            };
            if !is_end(0) {
                lo = spline.nearest(&points[0]);
            }
            if !is_end(1) {
                hi = spline.nearest(&points[1]);
            }
            if lo >= hi {
                return Err(edge.wrong("an edge along its spline"));
            }
        }
        if curve.is_periodic() && (hi <= lo || ends[0] == ends[1]) {
            hi += if hi - lo > 0.5 * TAU { 0.0 } else { TAU };
        }
        let edge = StepEdge {
            ends,
            points,
            curve,
            on,
            range: [lo, hi],
        };
        self.shape.edges.insert(id, edge);
        Ok(())
    }

    fn curve(&self, curve: &Entity<'i>) -> Result<StepCurve, StepReadError> {
        match curve.name {
            "LINE" => {
                let vector = self.named(curve.instance(2)?, "VECTOR")?;
                Ok(StepCurve::Line {
                    origin: self.point(curve.instance(1)?)?,
                    direction: self.direction(vector.instance(1)?)? * vector.number(2)?,
                })
            }
            "CIRCLE" => Ok(StepCurve::Ellipse {
                place: self.placement(curve.instance(1)?)?,
                a: curve.number(2)?,
                b: curve.number(2)?,
            }),
            "ELLIPSE" => Ok(StepCurve::Ellipse {
                place: self.placement(curve.instance(1)?)?,
                a: curve.number(2)?,
                b: curve.number(3)?,
            }),
            "HYPERBOLA" => Ok(StepCurve::Hyperbola {
                place: self.placement(curve.instance(1)?)?,
                a: curve.number(2)?,
                b: curve.number(3)?,
            }),
            "PARABOLA" => Ok(StepCurve::Parabola {
                place: self.placement(curve.instance(1)?)?,
                focal: curve.number(2)?,
            }),
            "B_SPLINE_CURVE_WITH_KNOTS" => Ok(StepCurve::Spline(self.spline(curve.id)?)),
            _ => Err(curve.wrong("a curve")),
        }
    }

    fn spline<const D: usize>(&self, id: u32) -> Result<StepSpline<D>, StepReadError> {
        let spline = self.named(id, "B_SPLINE_CURVE_WITH_KNOTS")?;
        let mut points = Vec::new();
        for point in spline.instances(2)? {
            let point = self.named(point, "CARTESIAN_POINT")?;
            let point: Result<[f64; D], _> = point.numbers(1)?.try_into();
            points.push(point.map_err(|_| spline.wrong("points of as many coordinates"))?);
        }
        let counts = spline.numbers(6)?;
        // So many that no memory would be enough are no knots.
        let degree = spline.number(1)?;
        let is_sound = counts.iter().sum::<f64>() == points.len() as f64 + degree + 1.0;
        if !is_sound || counts.iter().any(|count| *count < 1.0) {
            return Err(spline.wrong("as many knots as points ask for, in order"));
        }
        let counted = counts.into_iter().zip(spline.numbers(7)?);
        let knots = counted.flat_map(|(count, knot)| std::iter::repeat_n(knot, count as usize));
        let made = StepSpline {
            degree: degree as usize,
            knots: knots.collect(),
            points,
        };
        match made.is_sound() {
            true => Ok(made),
            false => Err(spline.wrong("as many knots as points ask for, in order")),
        }
    }

    fn surface(&self, id: u32) -> Result<StepSurface, StepReadError> {
        if let Some(StepInstance { parts }) = self.instances.get(&id)
            && parts.len() > 1
        {
            return self.spline_surface(id, parts);
        }
        let surface = self.entity(id)?;
        let form = match surface.name {
            "PLANE" => SurfaceForm::Plane,
            "CYLINDRICAL_SURFACE" => SurfaceForm::Cylinder {
                radius: surface.number(2)?,
            },
            "CONICAL_SURFACE" => SurfaceForm::Cone {
                radius: surface.number(2)?,
                slope: surface.number(3)?.tan(),
            },
            "SPHERICAL_SURFACE" => SurfaceForm::Sphere {
                radius: surface.number(2)?,
            },
            "TOROIDAL_SURFACE" => SurfaceForm::Torus {
                major: surface.number(2)?,
                minor: surface.number(3)?,
            },
            "SURFACE_OF_REVOLUTION" => return self.sheet(&surface),
            _ => return Err(surface.wrong("a surface")),
        };
        let place = self.placement(surface.instance(1)?)?;
        Ok(StepSurface { place, form })
    }

    /// A rational B-spline surface between two ellipses, or an ellipsoid.
    fn spline_surface(
        &self,
        id: u32,
        parts: &'i [StepEntity],
    ) -> Result<StepSurface, StepReadError> {
        let expected = "a rational surface between two ellipses, or an ellipsoid";
        let wrong = StepReadError::Instance { id, expected };
        let part = |name: &str| {
            let part = parts.iter().find(|part| part.name == name);
            part.map(|StepEntity { name, values }| Entity { id, name, values })
        };
        let names = [
            "B_SPLINE_SURFACE",
            "B_SPLINE_SURFACE_WITH_KNOTS",
            "RATIONAL_B_SPLINE_SURFACE",
        ];
        let [Some(net), Some(with_knots), Some(rational)] = names.map(part) else {
            return Err(wrong);
        };
        let point = |value: &StepValue| match value {
            StepValue::Instance(id) => self.point(*id),
            _ => Err(net.wrong("points")),
        };
        let weight = |value: &StepValue| match value {
            StepValue::Number(x) => Ok(*x),
            _ => Err(rational.wrong("numbers")),
        };
        let made = SplineNet {
            points: rows(&net, 2, point)?,
            weights: rows(&rational, 0, weight)?,
            degrees: [net.number(0)?, net.number(1)?],
            multiplicities: [with_knots.numbers(0)?, with_knots.numbers(1)?],
            knots: [with_knots.numbers(2)?, with_knots.numbers(3)?],
        };
        let place = Placement {
            origin: Point3::origin(),
            x: Vector3::x(),
            y: Vector3::y(),
            z: Vector3::z(),
        };
        match made.form() {
            Some(form) => Ok(StepSurface { place, form }),
            None => Err(wrong),
        }
    }

    /// The surface of revolution of a circle that starts on the axis and returns to it.
    fn sheet(&self, surface: &Entity<'_>) -> Result<StepSurface, StepReadError> {
        let meridian = self.named(surface.instance(1)?, "TRIMMED_CURVE")?;
        let circle = self.named(meridian.instance(1)?, "CIRCLE")?;
        let (about, minor) = (self.placement(circle.instance(1)?)?, circle.number(2)?);
        let axis = self.named(surface.instance(2)?, "AXIS1_PLACEMENT")?;
        let origin = self.point(axis.instance(1)?)?;
        let z = self.direction(axis.instance(2)?)?;
        // The circle leads upwards on the outside.
        let x = z.cross(&about.z);
        let away = about.origin - origin;
        let major = away.dot(&x);
        let start = about.origin + about.x * minor;
        // By the start: the radii of a horn torus give the square root of their rounding.
        let height = (about.origin - start).dot(&z);
        let end = height.max(0.0).atan2(-major);
        let pole = origin + z * (start - origin).dot(&z);
        let near = SAME_POINT * (minor + major.abs());
        let is_lower = height >= -near && (start - pole).norm() <= near;
        match z.dot(&about.z).abs() <= SAME_POINT && is_lower {
            true => Ok(StepSurface {
                place: Placement {
                    origin: origin + z * away.dot(&z),
                    x,
                    y: z.cross(&x),
                    z,
                },
                form: SurfaceForm::Sheet { major, minor, end },
            }),
            false => Err(circle.wrong("a circle that starts at the lower pole")),
        }
    }

    fn placement(&self, id: u32) -> Result<Placement, StepReadError> {
        let placement = self.named(id, "AXIS2_PLACEMENT_3D")?;
        let z = self.direction(placement.instance(2)?)?;
        let toward = self.direction(placement.instance(3)?)?;
        let x = (toward - z * toward.dot(&z)).normalize();
        Ok(Placement {
            origin: self.point(placement.instance(1)?)?,
            x,
            y: z.cross(&x),
            z,
        })
    }

    fn point(&self, id: u32) -> Result<Point3<f64>, StepReadError> {
        self.triple(id, "CARTESIAN_POINT").map(Point3::from)
    }

    fn direction(&self, id: u32) -> Result<Vector3<f64>, StepReadError> {
        Ok(Vector3::from(self.triple(id, "DIRECTION")?).normalize())
    }

    fn triple(&self, id: u32, name: &'static str) -> Result<[f64; 3], StepReadError> {
        let entity = self.named(id, name)?;
        let numbers: Result<[f64; 3], _> = entity.numbers(1)?.try_into();
        numbers.map_err(|_| entity.wrong("three numbers"))
    }
}
