//! Images of solids under affine maps.

use std::sync::Arc;

use premio_kernel::motion::Motion;
use premio_kernel::number::rational::{Rational, exact_sqrt};

use super::ConstructionError;
use super::affine_map::AffineMap;
use super::oblique_prism::{ObliquePrism, oblique_frustum};
use super::plane_faces::{own_corners, polyhedron};
use crate::builder::{Builder, SolidId};
use crate::figure::PlaneMap;
use crate::polyhedron::{SpacePoint, dot};
use crate::primitive::Primitive;
use crate::transform::Transform;
use crate::tree::{NodeId, PlacedPrimitive, TreeNode};

/// The image of a solid under an affine map.
///
/// Plane faces stay plane, cylinders and cones become elliptic ones, and spheres ellipsoids. Tori and
/// other revolutions may be scaled equally in all directions, and revolutions of polygons differently
/// along their axis.
///
/// # Errors
/// The map makes another surface of a revolution, or makes a solid flat.
pub fn mapped(
    builder: &mut Builder,
    solid: SolidId,
    map: &AffineMap,
) -> Result<SolidId, ConstructionError> {
    let tree = builder.finish(solid)?;
    let mut images: Vec<SolidId> = vec![SolidId::EMPTY; tree.nodes().len()];
    // Children follow their parents.
    for (index, node) in tree.nodes().iter().enumerate().rev() {
        images[index] = match node {
            TreeNode::Leaf(placed) => {
                let around = builder.current_colour();
                builder.set_colour(around.or(tree.colour(NodeId(index))));
                let image = of_leaf(builder, placed, map);
                builder.set_colour(around);
                image?
            }
            TreeNode::Operation { op, children } => {
                let children: Vec<SolidId> = children.iter().map(|c| images[c.index()]).collect();
                builder.operation(*op, &children)
            }
        };
    }
    let root = tree.root().map(|root| images[root.index()]);
    Ok(root.unwrap_or(SolidId::EMPTY))
}

fn of_leaf(
    builder: &mut Builder,
    placed: &PlacedPrimitive,
    map: &AffineMap,
) -> Result<SolidId, ConstructionError> {
    let whole = map.after(&placed.motion);
    if let Some(stretch) = Stretch::new(&whole)
        && let Some(primitive) = stretch.apply(&placed.primitive)
    {
        let part = builder.primitive(primitive);
        let part = match stretch.is_mirrored {
            true => builder.mirrored_y(part),
            false => part,
        };
        return Ok(builder.moved(part, Transform::from_motion(&stretch.motion)));
    }
    if own_corners(&placed.primitive).is_none() {
        return of_round_leaf(builder, &placed.primitive, &whole);
    }
    let image = polyhedron(&placed.primitive)?.mapped(&whole.matrix, &whole.offset)?;
    let polyhedron = Arc::new(image);
    Ok(builder.primitive(Primitive::Polyhedron { polyhedron }))
}

/// An ellipsoid, or a sphere if its radii are perpendicular and equal.
fn ellipsoid(
    builder: &mut Builder,
    radii: [SpacePoint; 3],
    centre: SpacePoint,
) -> Result<SolidId, ConstructionError> {
    let [x, y, z] = &radii;
    let square = dot(x, x);
    let is_round = [(x, y), (y, z), (z, x)]
        .into_iter()
        .all(|(u, v)| dot(u, v).is_zero() && dot(v, v) == square);
    let radius = is_round.then(|| exact_sqrt(&square)).flatten();
    let primitive = match radius {
        Some(radius) => Primitive::sphere(radius)?,
        None => Primitive::ellipsoid(radii)?,
    };
    let part = builder.primitive(primitive);
    Ok(builder.moved(part, Transform::shift(centre)))
}

/// The image of a primitive with spheres, cylinders and cones.
fn of_round_leaf(
    builder: &mut Builder,
    primitive: &Primitive,
    map: &AffineMap,
) -> Result<SolidId, ConstructionError> {
    let zero = || Rational::ZERO;
    let frustum = |builder: &mut Builder, base: &Rational, top: &Rational, ends: [&Rational; 2]| {
        let [from, to] = ends;
        let axes = [
            map.vector(&[base.clone(), zero(), zero()]),
            map.vector(&[zero(), base.clone(), zero()]),
            map.vector(&[zero(), zero(), to - from]),
        ];
        let origin = map.point(&[zero(), zero(), from.clone()]);
        oblique_frustum(builder, axes, top / base, origin)
    };
    match primitive {
        Primitive::Cylinder { radius, height } => {
            frustum(builder, radius, radius, [&Rational::ZERO, height])
        }
        // The base is not an apex.
        Primitive::Frustum { base, top, height } if base.is_zero() => {
            frustum(builder, top, base, [height, &Rational::ZERO])
        }
        Primitive::Frustum { base, top, height } => {
            frustum(builder, base, top, [&Rational::ZERO, height])
        }
        Primitive::Sphere { radius } => {
            let radii = [0, 1, 2].map(|i| {
                let mut axis = [zero(), zero(), zero()];
                axis[i] = radius.clone();
                map.vector(&axis)
            });
            ellipsoid(builder, radii, map.offset.clone())
        }
        Primitive::Ellipsoid { radii } => {
            let radii = radii.vectors().each_ref().map(|radius| map.vector(radius));
            ellipsoid(builder, radii, map.offset.clone())
        }
        Primitive::ObliqueFrustum { frustum } => {
            let axes = frustum.axes().each_ref().map(|axis| map.vector(axis));
            oblique_frustum(builder, axes, frustum.top().clone(), map.offset.clone())
        }
        Primitive::Prism {
            figure,
            height,
            top,
        } => ObliquePrism {
            plane: &PlaneMap::identity(),
            height,
            top,
            space: map,
        }
        .solid(builder, figure),
        _ => Err(ConstructionError::Elliptic),
    }
}

/// A map that scales the axes by factors before a motion.
struct Stretch {
    factors: [Rational; 3],
    is_mirrored: bool,
    motion: Motion,
}

impl Stretch {
    fn new(map: &AffineMap) -> Option<Self> {
        let column = |j: usize| [0, 1, 2].map(|i| map.matrix[i][j].clone());
        let [x, y, z] = [0, 1, 2].map(column);
        let [xx, yy, zz] = [&x, &y, &z].map(|u| dot(u, u));
        let is_right = [(&x, &y), (&y, &z), (&z, &x)]
            .into_iter()
            .all(|(u, v)| dot(u, v).is_zero());
        if !is_right || [&xx, &yy, &zz].iter().any(|square| square.is_zero()) {
            return None;
        }
        let factors = [exact_sqrt(&xx)?, exact_sqrt(&yy)?, exact_sqrt(&zz)?];
        let [u, v, w] = &factors;
        let turn = [0, 1, 2].map(|i| [&x[i] / u, &y[i] / v, &z[i] / w]);
        let proper = Motion::from_matrix(turn.clone(), map.offset.clone());
        let is_mirrored = proper.is_none();
        let mirrored = turn.map(|[x, y, z]| [x, -y, z]);
        let motion = proper.or_else(|| Motion::from_matrix(mirrored, map.offset.clone()))?;
        Some(Self {
            factors,
            is_mirrored,
            motion,
        })
    }

    fn apply(&self, primitive: &Primitive) -> Option<Primitive> {
        let [s, u, t] = &self.factors;
        if let Primitive::Block { size: [x, y, z] } = primitive {
            let size = [x * s, y * u, z * t];
            return Some(Primitive::Block { size });
        }
        if s != u {
            return None;
        }
        if s == t {
            return Some(primitive.scaled(s));
        }
        Some(match primitive {
            Primitive::Cylinder { radius, height } => Primitive::Cylinder {
                radius: radius * s,
                height: height * t,
            },
            Primitive::Frustum { base, top, height } => Primitive::Frustum {
                base: base * s,
                top: top * s,
                height: height * t,
            },
            Primitive::Prism {
                figure,
                height,
                top,
            } => Primitive::Prism {
                figure: Arc::new(figure.scaled(s)),
                height: height * t,
                top: top.clone(),
            },
            Primitive::Revolution { figure, angle } => {
                let zero = || Rational::ZERO;
                let map = PlaneMap {
                    matrix: [[s.clone(), zero()], [zero(), t.clone()]],
                    offset: [zero(), zero()],
                };
                Primitive::Revolution {
                    figure: Arc::new(figure.mapped(&map).ok()?),
                    angle: angle.clone(),
                }
            }
            _ => return None,
        })
    }
}
