//! The surfaces that the edges of a figure sweep: planes, cylinders, cones, spheres and tori.

use crate::figure::{ArcTurn, Figure, FigureEdge};
use crate::primitive::Primitive;
use premio_kernel::geometry::surface_pair::Coefficients;
use premio_kernel::number::rational::Rational;

/// The kind of a wall's surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum WallKind {
    /// A plane.
    Plane,
    /// A cylinder.
    Cylinder,
    /// A nappe of a cone.
    Cone,
    /// A sphere.
    Sphere,
    /// A ring torus.
    Torus,
}

/// The surface that an edge of a figure sweeps.
#[derive(Clone, Debug)]
pub(super) struct Wall {
    /// The index of the edge.
    pub edge: usize,
    /// The kind of the surface.
    pub kind: WallKind,
    /// Whether the material is on the surface's positive side.
    pub is_concave: bool,
    /// The exact coefficients in the primitive's frame.
    pub coefficients: Coefficients<Rational>,
}

/// A wall without the index of its edge.
struct Surface {
    kind: WallKind,
    is_concave: bool,
    coefficients: Coefficients<Rational>,
}

/// The number of walls of a primitive.
pub(super) fn count(primitive: &Primitive) -> usize {
    match primitive {
        Primitive::Prism { figure, .. } => figure.edges().len(),
        Primitive::Revolution { figure, .. } => {
            let walls = figure.edges().iter().filter(|edge| !is_on_axis(edge));
            walls.count()
        }
        _ => 0,
    }
}

/// The walls of a primitive, in the order of its figure's edges. An edge on the axis of a
/// revolution has none.
pub(super) fn walls(primitive: &Primitive) -> Vec<Wall> {
    let all = |figure: &Figure, surface: &dyn Fn(&FigureEdge) -> Option<Surface>| {
        let edges = figure.edges().iter().enumerate();
        let walls = edges.filter_map(|(edge, of)| Some(of_edge(edge, surface(of)?)));
        walls.collect()
    };
    match primitive {
        Primitive::Prism {
            figure,
            height,
            top,
        } => all(figure, &|edge| Some(extruded(edge, height, top))),
        Primitive::Revolution { figure, .. } => all(figure, &revolved),
        _ => Vec::new(),
    }
}

/// One wall of a primitive, by its index among the walls.
pub(super) fn wall(primitive: &Primitive, index: usize) -> Option<Wall> {
    match primitive {
        Primitive::Prism {
            figure,
            height,
            top,
        } => {
            let edge = figure.edges().get(index)?;
            Some(of_edge(index, extruded(edge, height, top)))
        }
        Primitive::Revolution { figure, .. } => {
            let edges = figure.edges().iter().enumerate();
            let mut walls = edges.filter(|(_, edge)| !is_on_axis(edge));
            let (at, edge) = walls.nth(index)?;
            Some(of_edge(at, revolved(edge)?))
        }
        _ => None,
    }
}

fn of_edge(edge: usize, surface: Surface) -> Wall {
    let Surface {
        kind,
        is_concave,
        coefficients,
    } = surface;
    Wall {
        edge,
        kind,
        is_concave,
        coefficients,
    }
}

fn is_on_axis(edge: &FigureEdge) -> bool {
    edge.arc.is_none() && edge.start[0].is_zero() && edge.end[0].is_zero()
}

fn about_z(z: Rational) -> Coefficients<Rational> {
    Coefficients {
        point: [Rational::ZERO, Rational::ZERO, z],
        direction: [Rational::ZERO, Rational::ZERO, Rational::ONE],
        size: Rational::ZERO,
        tube: Rational::ZERO,
        axes: None,
    }
}

/// The nappe of a cone about the z axis, by its apex and the slope of its radius along z.
fn cone(apex: Rational, slope: Rational) -> Coefficients<Rational> {
    let (into, size) = match slope > Rational::ZERO {
        true => (Rational::ONE, slope),
        false => (-Rational::ONE, -slope),
    };
    Coefficients {
        direction: [Rational::ZERO, Rational::ZERO, into],
        size,
        ..about_z(apex)
    }
}

/// The wall of an edge that is extruded, and scaled by `top` on the way.
fn extruded(edge: &FigureEdge, height: &Rational, top: &Rational) -> Surface {
    let [s, e] = [&edge.start, &edge.end];
    let growth = (top - Rational::ONE) / height;
    let Some(arc) = &edge.arc else {
        let [dx, dy] = [0, 1].map(|i| &e[i] - &s[i]);
        let lean = growth * (&dx * &s[1] - &dy * &s[0]);
        return Surface {
            kind: WallKind::Plane,
            is_concave: false,
            coefficients: Coefficients {
                point: [s[0].clone(), s[1].clone(), Rational::ZERO],
                direction: [dy, -dx, lean],
                ..about_z(Rational::ZERO)
            },
        };
    };
    let is_concave = arc.turn == ArcTurn::Clockwise;
    if top.is_one() {
        let [x, y] = arc.centre.clone();
        return Surface {
            kind: WallKind::Cylinder,
            is_concave,
            coefficients: Coefficients {
                point: [x, y, Rational::ZERO],
                size: arc.radius.clone(),
                ..about_z(Rational::ZERO)
            },
        };
    }
    let apex = -Rational::ONE / &growth;
    Surface {
        kind: WallKind::Cone,
        is_concave,
        coefficients: cone(apex, growth * &arc.radius),
    }
}

/// The wall of an edge that is revolved about the second axis of its plane.
fn revolved(edge: &FigureEdge) -> Option<Surface> {
    let ([r, z], [r2, z2]) = (&edge.start, &edge.end);
    if let Some(arc) = &edge.arc {
        let [major, height] = &arc.centre;
        let (kind, size, tube) = match major.is_zero() {
            true => (WallKind::Sphere, arc.radius.clone(), Rational::ZERO),
            false => (WallKind::Torus, major.clone(), arc.radius.clone()),
        };
        return Some(Surface {
            kind,
            is_concave: arc.turn == ArcTurn::Clockwise,
            coefficients: Coefficients {
                size,
                tube,
                ..about_z(height.clone())
            },
        });
    }
    if is_on_axis(edge) {
        return None;
    }
    let is_concave = z2 - z < Rational::ZERO;
    Some(if r == r2 {
        Surface {
            kind: WallKind::Cylinder,
            is_concave,
            coefficients: Coefficients {
                size: r.clone(),
                ..about_z(Rational::ZERO)
            },
        }
    } else if z == z2 {
        let up = if r2 - r < Rational::ZERO {
            Rational::ONE
        } else {
            -Rational::ONE
        };
        Surface {
            kind: WallKind::Plane,
            is_concave: false,
            coefficients: Coefficients {
                direction: [Rational::ZERO, Rational::ZERO, up],
                ..about_z(z.clone())
            },
        }
    } else {
        let slope = (r2 - r) / (z2 - z);
        Surface {
            kind: WallKind::Cone,
            is_concave,
            coefficients: cone(z - r / &slope, slope),
        }
    })
}

/// The outward normals of the half planes at which a revolution by an angle starts and ends.
pub(super) fn end_normals(primitive: &Primitive) -> Vec<[Rational; 3]> {
    let Primitive::Revolution {
        angle: Some(angle), ..
    } = primitive
    else {
        return Vec::new();
    };
    let [cos, sin] = angle.direction();
    let start = [Rational::ZERO, -Rational::ONE, Rational::ZERO];
    match angle.is_half_turn() {
        true => vec![start],
        false => vec![start, [-sin, cos, Rational::ZERO]],
    }
}
