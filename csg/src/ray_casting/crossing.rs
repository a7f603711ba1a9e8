//! The surfaces on which a line enters and leaves material.
//!
//! The surfaces are those of the primitives. Coincident surfaces of several primitives are merged,
//! so that neighbouring lines that cross the same face of the part cross the same surface.

use super::ellipsoid::EllipsoidShape;
use super::oblique::ObliqueShape;
use super::section::{Edge, SectionShape, Sweep};
use super::shape::Shape;
use super::{Event, Leaf, Ray, RayOracle};
use nalgebra::{Matrix3, Vector3};
use premio_kernel::geometry::ellipsoid::Ellipsoid;
use premio_kernel::geometry::elliptic_surface::{EllipticCone, EllipticCylinder};
use premio_kernel::geometry::surface::Surface;
use premio_kernel::number::predicates::ROUNDING;

/// A point at which a line enters or leaves material. Entries and exits alternate, starting with an
/// entry.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceCrossing {
    /// The line's parameter.
    pub at: f64,
    /// The index of the surface in the tree's list.
    pub surface: usize,
    /// Whether the line comes from the inside of a curved surface; false for a plane.
    pub outwards: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Plane,
    Cylinder,
    Cone,
    Sphere,
    Torus,
    Elliptic,
}

/// A surface: a point on it, its centre or its apex; its normal or axis, up to the sign; its radii,
/// or the slope of a cone. An elliptic surface itself.
#[derive(Clone, Copy, Debug)]
struct Carrier {
    kind: Kind,
    point: Vector3<f64>,
    axis: Vector3<f64>,
    sizes: [f64; 2],
    elliptic: Option<EllipticCarrier>,
}

/// A surface o + x cos u + y sin u + v z, or o + v (x cos u + y sin u + z), or the image of the unit
/// sphere about o, by o and its axes.
#[derive(Clone, Copy, Debug)]
struct EllipticCarrier {
    axes: Matrix3<f64>,
    surface: Surface,
}

/// The kinds of elliptic surfaces.
#[derive(Clone, Copy, Debug)]
enum EllipticKind {
    Cylinder,
    Cone,
    Ellipsoid,
}

impl EllipticCarrier {
    fn new(kind: EllipticKind, point: Vector3<f64>, axes: Matrix3<f64>) -> Self {
        let columns = [0, 1, 2].map(|i| axes.column(i).into());
        let o = point.into();
        let surface = match kind {
            EllipticKind::Cylinder => {
                Surface::EllipticCylinder(EllipticCylinder::with_axes(o, columns))
            }
            EllipticKind::Cone => Surface::EllipticCone(EllipticCone::with_axes(o, columns)),
            EllipticKind::Ellipsoid => Surface::Ellipsoid(Ellipsoid::with_axes(o, columns)),
        };
        Self { axes, surface }
    }

    /// The surface about another point, with turned axes.
    fn placed(&self, point: Vector3<f64>, turn: &Matrix3<f64>) -> Self {
        let kind = match self.surface {
            Surface::EllipticCone(_) => EllipticKind::Cone,
            Surface::Ellipsoid(_) => EllipticKind::Ellipsoid,
            _ => EllipticKind::Cylinder,
        };
        Self::new(kind, point, turn * self.axes)
    }

    /// Whether points around the other one lie on this one.
    fn coincides(&self, other: &Self, near: f64, size: f64) -> bool {
        let places = [0.1, 1.3, 2.4, 3.6, 4.9, 5.8].into_iter();
        let mut places = places.flat_map(|u| [(u, 0.5 * size), (u, size)]);
        self.surface.kind() == other.surface.kind()
            && places.all(|(u, v)| {
                let p = other.surface.point(u, v);
                self.surface.distance(&p).abs() <= near
            })
    }
}

/// The surfaces of a tree's primitives, without duplicates.
#[derive(Debug)]
pub struct Surfaces<'a> {
    material: &'a RayOracle,
    /// All surfaces, in the part's frame.
    all: Vec<Carrier>,
    /// The surfaces of each leaf.
    of_leaves: Vec<Vec<LeafSurface>>,
}

/// A surface of a leaf.
#[derive(Debug)]
struct LeafSurface {
    /// The surface in the leaf's own frame.
    carrier: Carrier,
    /// Its index among all surfaces.
    surface: usize,
}

impl Carrier {
    fn new(kind: Kind, point: Vector3<f64>, axis: Vector3<f64>, sizes: [f64; 2]) -> Self {
        Self {
            kind,
            point,
            axis,
            sizes,
            elliptic: None,
        }
    }

    /// The wall of an oblique frustum.
    fn elliptic(frustum: &ObliqueShape) -> Self {
        let zero = Vector3::zeros();
        let mut axes = frustum.axes;
        let (kind, point) = match frustum.growth != 0.0 {
            true => (EllipticKind::Cone, axes.column(2) / -frustum.growth),
            false => (EllipticKind::Cylinder, zero),
        };
        if let EllipticKind::Cone = kind {
            axes.set_column(2, &-point);
        }
        Self {
            elliptic: Some(EllipticCarrier::new(kind, point, axes)),
            ..Self::new(Kind::Elliptic, point, zero, [0.0; 2])
        }
    }

    fn ellipsoid(shape: &EllipsoidShape) -> Self {
        let zero = Vector3::zeros();
        let own = EllipticCarrier::new(EllipticKind::Ellipsoid, zero, shape.radii);
        Self {
            elliptic: Some(own),
            ..Self::new(Kind::Elliptic, zero, zero, [0.0; 2])
        }
    }

    fn plane(point: Vector3<f64>, normal: Vector3<f64>) -> Self {
        Self::new(Kind::Plane, point, normal.normalize(), [0.0; 2])
    }

    /// The surface in the part's frame. The point of a plane or a cylinder is the one closest to
    /// `middle`.
    fn placed(&self, leaf: &Leaf, middle: &Vector3<f64>) -> Self {
        let (point, axis) = (leaf.turn * self.point + leaf.offset, leaf.turn * self.axis);
        let along = axis * axis.dot(&(middle - point));
        let point = match self.kind {
            Kind::Plane => middle - along,
            Kind::Cylinder => point + along,
            Kind::Cone | Kind::Sphere | Kind::Torus | Kind::Elliptic => point,
        };
        let elliptic = self.elliptic.map(|own| own.placed(point, &leaf.turn));
        Self {
            point,
            axis,
            elliptic,
            ..*self
        }
    }

    /// The normal at a point on it, up to length and sign.
    fn normal(&self, p: &Vector3<f64>) -> Vector3<f64> {
        if let Some(own) = &self.elliptic {
            return own.surface.normal(&(*p).into());
        }
        let away = p - self.point;
        let along = away.dot(&self.axis);
        let radial = away - self.axis * along;
        match self.kind {
            Kind::Plane => self.axis,
            Kind::Cylinder => radial,
            Kind::Cone => radial.normalize() - self.axis * (self.sizes[0] * along.signum()),
            Kind::Sphere | Kind::Elliptic => away,
            Kind::Torus => away - radial.normalize() * self.sizes[0],
        }
    }

    /// The distance of a point from it.
    fn distance(&self, p: &Vector3<f64>) -> f64 {
        if let Some(own) = &self.elliptic {
            return own.surface.distance(&(*p).into()).abs();
        }
        let away = p - self.point;
        let along = away.dot(&self.axis);
        let radius = (away - self.axis * along).norm();
        let [a, b] = self.sizes;
        match self.kind {
            Kind::Plane => along.abs(),
            Kind::Cylinder => (radius - a).abs(),
            Kind::Cone => (radius - a * along.abs()).abs() / a.hypot(1.0),
            Kind::Sphere | Kind::Elliptic => (away.norm() - a).abs(),
            Kind::Torus => ((radius - a).hypot(along) - b).abs(),
        }
    }

    /// Whether two carriers differ by at most `near`, a distance in a part of the given size.
    fn coincides(&self, other: &Self, near: f64, size: f64) -> bool {
        let sizes = self.sizes.iter().zip(other.sizes);
        if let (Some(own), Some(other)) = (&self.elliptic, &other.elliptic) {
            return own.coincides(other, near, size);
        }
        self.kind == other.kind
            && (self.point - other.point).norm() <= near
            && self.axis.cross(&other.axis).norm() * size <= near
            && sizes.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) <= near
    }
}

/// The surfaces of a primitive in its own frame.
fn carriers(shape: &Shape) -> Vec<Carrier> {
    let (zero, z) = (Vector3::zeros(), Vector3::z());
    let unit = |i: usize| Vector3::ith_axis(i).into_inner();
    let low = |i: usize| Carrier::plane(zero, unit(i));
    let high = |i: usize, at: f64| Carrier::plane(unit(i) * at, unit(i));
    match shape {
        &Shape::Block(size) => (0..3).flat_map(|i| [low(i), high(i, size[i])]).collect(),
        &Shape::Wedge([x, y, z]) => {
            let slant = Carrier::plane(unit(0) * x, Vector3::new(1.0 / x, 0.0, 1.0 / z));
            vec![low(0), low(1), high(1, y), low(2), slant]
        }
        &Shape::Frustum {
            base,
            slope,
            height,
            ..
        } => {
            let side = if slope == 0.0 {
                Carrier::new(Kind::Cylinder, zero, z, [base, 0.0])
            } else {
                Carrier::new(Kind::Cone, z * (-base / slope), z, [slope.abs(), 0.0])
            };
            vec![low(2), high(2, height), side]
        }
        &Shape::Sphere(r) => vec![Carrier::new(Kind::Sphere, zero, zero, [r, 0.0])],
        &Shape::Torus { major, minor } => {
            vec![Carrier::new(Kind::Torus, zero, z, [major, minor])]
        }
        Shape::Section(section) => section_carriers(section),
        Shape::Ellipsoid(ellipsoid) => vec![Carrier::ellipsoid(ellipsoid)],
        Shape::Oblique(frustum) => {
            let [x, y, z] = [0, 1, 2].map(|i| Vector3::from(frustum.axes.column(i)));
            let normal = x.cross(&y);
            let ends = [zero, z].map(|at| Carrier::plane(at, normal));
            let wall = Carrier::elliptic(frustum);
            ends.into_iter().chain([wall]).collect()
        }
        Shape::Facets(facets) => {
            let planes = facets.planes();
            planes
                .map(|(at, normal)| Carrier::plane(at, normal))
                .collect()
        }
    }
}

/// The surfaces of a prism or a revolution in its own frame.
fn section_carriers(section: &SectionShape) -> Vec<Carrier> {
    let (zero, z) = (Vector3::zeros(), Vector3::z());
    match section.sweep {
        Sweep::Along { height, growth } => {
            let ends = [zero, z * height].map(|at| Carrier::plane(at, z));
            let walls = section.edges.iter().map(|edge| extruded(edge, growth));
            ends.into_iter().chain(walls).collect()
        }
        Sweep::About { angle } => {
            let end = |angle: f64| {
                let (sin, cos) = angle.sin_cos();
                Carrier::plane(zero, Vector3::new(-sin, cos, 0.0))
            };
            let ends = angle.into_iter().flat_map(|angle| [end(0.0), end(angle)]);
            ends.chain(section.edges.iter().map(revolved)).collect()
        }
    }
}

fn extruded(edge: &Edge, growth: f64) -> Carrier {
    let z = Vector3::z();
    let [sx, sy] = edge.start;
    match edge.circle {
        None => {
            let [dx, dy] = [edge.end[0] - sx, edge.end[1] - sy];
            let normal = Vector3::new(dy, -dx, growth * (dx * sy - dy * sx));
            Carrier::plane(Vector3::new(sx, sy, 0.0), normal)
        }
        Some(circle) if growth == 0.0 => {
            let [x, y] = circle.centre;
            let point = Vector3::new(x, y, 0.0);
            Carrier::new(Kind::Cylinder, point, z, [circle.radius, 0.0])
        }
        Some(circle) => {
            let slope = (circle.radius * growth).abs();
            Carrier::new(Kind::Cone, z * (-1.0 / growth), z, [slope, 0.0])
        }
    }
}

fn revolved(edge: &Edge) -> Carrier {
    let (zero, z) = (Vector3::zeros(), Vector3::z());
    let ([sr, sz], [er, ez]) = (edge.start, edge.end);
    match edge.circle {
        Some(circle) => {
            let [major, at] = circle.centre;
            match major == 0.0 {
                true => Carrier::new(Kind::Sphere, z * at, zero, [circle.radius, 0.0]),
                false => Carrier::new(Kind::Torus, z * at, z, [major, circle.radius]),
            }
        }
        None if sz == ez => Carrier::plane(z * sz, z),
        None if sr == er => Carrier::new(Kind::Cylinder, zero, z, [sr, 0.0]),
        None => {
            let slope = (er - sr) / (ez - sz);
            Carrier::new(Kind::Cone, z * (sz - sr / slope), z, [slope.abs(), 0.0])
        }
    }
}

impl<'a> Surfaces<'a> {
    /// Collects the surfaces of a tree.
    pub fn new(material: &'a RayOracle) -> Self {
        let (size, middle) = (material.bounds.diagonal(), material.bounds.centre().coords);
        let near = size * ROUNDING.sqrt();
        let mut all: Vec<Carrier> = Vec::new();
        let of_leaves = material.leaves.iter().map(|leaf| {
            let own = carriers(&leaf.shape).into_iter().map(|local| {
                let placed = local.placed(leaf, &middle);
                let known = all.iter().position(|c| c.coincides(&placed, near, size));
                let surface = known.unwrap_or_else(|| {
                    all.push(placed);
                    all.len() - 1
                });
                LeafSurface {
                    carrier: local,
                    surface,
                }
            });
            own.collect()
        });
        let of_leaves = of_leaves.collect();
        Self {
            material,
            all,
            of_leaves,
        }
    }

    /// The change of the distance along a line to a surface, relative to a crossing, if the line is
    /// displaced by `step`. It is computed to first order, and infinite where the line is tangent
    /// to the surface.
    pub fn slope(&self, ray: &Ray, crossing: &SurfaceCrossing, step: &Vector3<f64>) -> f64 {
        let p = ray.origin + ray.direction * crossing.at;
        let normal = self.all[crossing.surface].normal(&p.coords);
        -step.dot(&normal) / ray.direction.dot(&normal)
    }

    /// The points at which a line enters and leaves material, in order. Gaps, then slivers, of
    /// length up to `least` are closed. `None` if another surface is hit within `least` of one of
    /// them: the two touch there, and rounding determines which is hit.
    pub fn crossings(&self, ray: &Ray, least: f64) -> Option<Vec<SurfaceCrossing>> {
        let mut joined: Vec<[Event; 2]> = Vec::new();
        let material = self.material;
        let mut scratch = material.scratch();
        material.cross_leaves(ray, &mut scratch, |span| match joined.last_mut() {
            Some(last) if span[0].at - last[1].at <= least => last[1] = span[1],
            _ => joined.push(span),
        });
        joined.retain(|[lo, hi]| hi.at - lo.at > least);
        let locate = |event: &Event| {
            let crossing = self.crossing(ray, event)?;
            let first = scratch.events.partition_point(|e| e.at < event.at - least);
            let near = scratch.events[first..].iter();
            let near = near.take_while(|e| e.at <= event.at + least);
            let mut others = near.filter(|e| e.leaf != event.leaf);
            let alone = others.all(|e| {
                let other = self.crossing(ray, e);
                other.is_some_and(|other| other.surface == crossing.surface)
            });
            alone.then_some(crossing)
        };
        joined.iter().flatten().map(locate).collect()
    }

    fn crossing(&self, ray: &Ray, event: &Event) -> Option<SurfaceCrossing> {
        let leaf = &self.material.leaves[event.leaf];
        let p = leaf.local_point(&(ray.origin + ray.direction * event.at));
        let off = |c: &Carrier| c.distance(&p);
        let own = self.of_leaves[event.leaf].iter();
        let LeafSurface { carrier, surface } =
            own.min_by(|a, b| off(&a.carrier).total_cmp(&off(&b.carrier)))?;
        Some(SurfaceCrossing {
            at: event.at,
            surface: *surface,
            outwards: carrier.kind != Kind::Plane && !event.enters,
        })
    }
}
