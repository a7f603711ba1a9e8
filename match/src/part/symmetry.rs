//! The turns that bring a part onto itself.

use super::Chain;
use super::marks::Stroke;
use nalgebra::{Isometry3, Matrix3, Point3, Rotation3, Translation3, UnitQuaternion};
use premio_kernel::brep::Brep;

/// Places and directions are the same within this part of the part's size.
pub const SAME: f64 = 1.0 / (1 << 20) as f64;

/// The turns that bring the straight chains, and with them all edges, onto one another; the first
/// does nothing. A part without such chains has no other that is known.
pub fn symmetries(
    brep: &Brep,
    strokes: &[Stroke],
    chains: &[Chain],
    radius: f64,
    centre: Point3<f64>,
) -> Vec<Isometry3<f64>> {
    let mut all = vec![Isometry3::identity()];
    // A chain that is no plane one fixes a turn; the rarest length makes the fewest candidates.
    let Some((first, frame)) = chains.iter().find_map(|c| Some((c, frame(c)?))) else {
        return all;
    };
    let points = probes(brep, strokes);
    for other in chains {
        let Some(to) = self::frame(other) else {
            continue;
        };
        let alike = |a: f64, b: f64| (a - b).abs() < SAME * radius;
        let [l, m] = [first, other].map(|c| (c.lines.points[1] - c.lines.points[0]).norm());
        if !alike(l, m) {
            continue;
        }
        let rotation = to * frame.transpose();
        let rotation = Rotation3::from_matrix_unchecked(rotation);
        let rotation = UnitQuaternion::from_rotation_matrix(&rotation);
        let shift = other.lines.points[0] - rotation * first.lines.points[0];
        let turn = Isometry3::from_parts(Translation3::from(shift), rotation);
        let still = (turn * centre - centre).norm() < SAME * radius;
        let new = |s: &Isometry3<f64>| {
            s.rotation.angle_to(&turn.rotation) > SAME
                || (s * centre - turn * centre).norm() > SAME * radius
        };
        if still && all.iter().all(new) && holds(&turn, &points, radius) {
            all.push(turn);
        }
    }
    all
}

/// The frame of a chain: its middle line, and its first outer line across it.
fn frame(chain: &Chain) -> Option<Matrix3<f64>> {
    let [a, b] = chain.lines.points;
    let z = (b - a).try_normalize(0.0)?;
    let d = chain.lines.away[0];
    let x = (d - z * z.dot(&d)).try_normalize(SAME)?;
    Some(Matrix3::from_columns(&[x, z.cross(&x), z]))
}

/// Three points of every stroke: where they are tells it.
fn probes(brep: &Brep, strokes: &[Stroke]) -> Vec<[Point3<f64>; 3]> {
    let of = |s: &Stroke| {
        let [a, b] = brep.range(s.edge);
        [a, 0.5 * (a + b), b].map(|t| brep.curve(s.edge).point(t))
    };
    strokes.iter().map(of).collect()
}

/// Whether a turn brings every stroke onto one.
fn holds(turn: &Isometry3<f64>, strokes: &[[Point3<f64>; 3]], radius: f64) -> bool {
    let near = |a: &Point3<f64>, b: &Point3<f64>| (a - b).norm() < 64.0 * SAME * radius;
    strokes.iter().all(|own| {
        let [a, m, b] = own.map(|p| turn * p);
        strokes.iter().any(|[x, y, z]| {
            near(&m, y) && (near(&a, x) && near(&b, z) || near(&a, z) && near(&b, x))
        })
    })
}
