//! Measures of elliptic surfaces, from their conjugate axes.
//!
//! Notation: x, y and z are the conjugate axes, so that a cylinder is o + x cos u + y sin u + v z,
//! a cone o + v (x cos u + y sin u + z), and an ellipsoid the image of the unit sphere; q are the
//! coordinates of a point in these axes, relative to o.

use super::{cross, dot, norm};
use crate::geometry::surface::Surface;
use crate::number::enclosable::Enclosable;
use crate::number::float::Float;

/// The conjugate axes of an elliptic surface.
pub type ConjugateAxes<R> = [[R; 3]; 3];

/// Half the width of a cylinder along a normal, of which the component across the axis counts.
pub(super) fn half_width<R: Enclosable>([x, y, z]: &ConjugateAxes<R>, n: &[R; 3]) -> R {
    let along = dot(n, z).over(dot(z, z));
    let across = std::array::from_fn(|i| n[i].clone() - along.clone() * z[i].clone());
    let [u, v] = [x, y].map(|axis| dot(&across, axis));
    (u.clone() * u + v.clone() * v).sqrt().over(norm(n))
}

/// Half the width of an ellipsoid along a normal.
pub(super) fn half_width_of_ellipsoid<R: Enclosable>(axes: &ConjugateAxes<R>, n: &[R; 3]) -> R {
    let rates = axes.each_ref().map(|axis| dot(n, axis));
    norm(&rates).over(norm(n))
}

/// The dual form of a cone, x xᵀ + y yᵀ - z zᵀ: the normals of its tangent planes are its zeros.
fn dual_form<R: Enclosable>([x, y, z]: &ConjugateAxes<R>) -> [[R; 3]; 3] {
    let product = |v: &[R; 3], i: usize, j: usize| v[i].clone() * v[j].clone();
    std::array::from_fn(|i| {
        std::array::from_fn(|j| product(x, i, j) + product(y, i, j) - product(z, i, j))
    })
}

/// The square root of the sum of the squares of a matrix's entries.
fn size<R: Enclosable>(m: &[[R; 3]; 3]) -> R {
    let [x, y, z] = m.each_ref().map(|row| dot(row, row));
    (x + y + z).sqrt()
}

/// The sine of the angle by which a plane through the apex of a cone misses tangency, to first order;
/// negative where it intersects the cone.
pub(super) fn off_tangency<R: Enclosable>(axes: &ConjugateAxes<R>, n: &[R; 3]) -> R {
    let image = dual_form(axes).map(|row| dot(&row, n));
    let slope = R::constant(2.0) * norm(n) * norm(&image);
    -dot(n, &image).over(slope)
}

/// The gradients of the coordinates q.
fn gradients<R: Enclosable>([x, y, z]: &ConjugateAxes<R>) -> ConjugateAxes<R> {
    let across = cross(y, z);
    let volume = dot(x, &across);
    let over = |v: [R; 3]| v.map(|c| c.over(volume.clone()));
    [over(across), over(cross(z, x)), over(cross(x, y))]
}

/// The distance of a point, by its offset from o, from a surface of the kind of `kind`, to first order:
/// from a cylinder, from both nappes of a cone, or from an ellipsoid. Those from a cylinder and from an
/// ellipsoid are smooth on the axis and at the centre.
pub(super) fn distance<N: Float, R: Enclosable>(
    axes: &ConjugateAxes<R>,
    away: &[R; 3],
    kind: &Surface<N>,
) -> R {
    let gradients = gradients(axes);
    let q = gradients.each_ref().map(|g| dot(g, away));
    // The form is x² + y² + weight z², which on the surface is `level`.
    let (weight, level) = match kind {
        Surface::EllipticCone(_) => (-1.0, 0.0),
        Surface::Ellipsoid(_) => (1.0, 1.0),
        _ => (0.0, 1.0),
    };
    let weights = [1.0, 1.0, weight].map(R::constant);
    let weighted: [R; 3] = std::array::from_fn(|k| weights[k].clone() * q[k].clone());
    let beyond = dot(&weighted, &q) - R::constant(level);
    let steep: [R; 3] = std::array::from_fn(|i| {
        let across = gradients.each_ref().map(|g| g[i].clone());
        dot(&across, &weighted)
    });
    let squares = gradients.each_ref().map(|g| dot(g, g));
    let least = dot(&squares, &weights) * R::constant(level);
    let slope = R::constant(4.0) * dot(&steep, &steep) + beyond.clone() * beyond.clone() * least;
    beyond.over(slope.sqrt())
}

/// The difference of two ellipsoids with a common centre, as a length: with the second's dual form I + E
/// in the axes of the first, the surface moves by E_ij √(|a_i| |a_j|)/2.
pub(super) fn ellipsoids_apart<R: Enclosable>(
    first: &ConjugateAxes<R>,
    second: &ConjugateAxes<R>,
) -> R {
    let gradients = gradients(first);
    let sizes = first.each_ref().map(norm);
    let second = second
        .each_ref()
        .map(|b| gradients.each_ref().map(|g| dot(g, b)));
    let mut square = R::constant(0.0);
    for i in 0..3 {
        for j in 0..3 {
            let [row, column] = [i, j].map(|i| second.each_ref().map(|b| b[i].clone()));
            let unit = R::constant(if i == j { 1.0 } else { 0.0 });
            let excess = dot(&row, &column) - unit;
            square = square + excess.clone() * excess * sizes[i].clone() * sizes[j].clone();
        }
    }
    square.sqrt() * R::constant(0.5)
}

/// The difference of the cross sections of two cylinders, as a length.
pub(super) fn sections_apart<R: Enclosable>(
    first: &ConjugateAxes<R>,
    second: &ConjugateAxes<R>,
) -> R {
    let section = |[x, y, z]: &ConjugateAxes<R>| {
        let square = dot(z, z);
        let across = |axis: &[R; 3]| {
            let along = dot(axis, z).over(square.clone());
            std::array::from_fn::<R, 3, _>(|i| axis[i].clone() - along.clone() * z[i].clone())
        };
        let zero = std::array::from_fn(|_| R::constant(0.0));
        dual_form(&[across(x), across(y), zero])
    };
    let (a, b) = (section(first), section(second));
    size(&less(&a, &b)).over(size(&a).sqrt())
}

/// The difference of two cones with a common apex, as an angle. For slender cones it is relative to
/// their mean half angle.
pub(super) fn cones_apart<R: Enclosable>(first: &ConjugateAxes<R>, second: &ConjugateAxes<R>) -> R {
    let form = |axes: &ConjugateAxes<R>| {
        let form = dual_form(axes);
        let size = size(&form);
        form.map(|row| row.map(|c| c.over(size.clone())))
    };
    let (a, b) = (form(first), form(second));
    let volume = dot(&a[0], &cross(&a[1], &a[2])).abs();
    size(&less(&a, &b)).over(volume.sqrt().sqrt())
}

fn less<R: Enclosable>(a: &[[R; 3]; 3], b: &[[R; 3]; 3]) -> [[R; 3]; 3] {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j].clone() - b[i][j].clone()))
}
