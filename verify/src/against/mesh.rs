//! The measures of the mesh that another program wrote.

use super::answer::{StatedAccuracy, StatedMeasures};
use nalgebra::{Point3, Vector3};
use premio_csg::mesh_file::{
    MeshFile, MeshFileError, MeshFormat, MeshReadOptions, ObjectPlacement,
};
use std::collections::HashMap;

/// The largest number of triangles: their sides have to fit into memory.
const MAX_TRIANGLES: usize = 1 << 23;

/// Why a mesh has no measures.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum MeshReadError {
    /// The file is not of this format.
    #[error(transparent)]
    File(#[from] MeshFileError),
    /// There are too many triangles.
    #[error("found {count} triangles, expected at most {MAX_TRIANGLES}")]
    TooMany {
        /// Their number.
        count: usize,
    },
    /// A side has not as many triangles in one sense as in the other.
    #[error("the mesh is not closed, or not oriented, at ({:.6}, {:.6}, {:.6})", .place[0], .place[1], .place[2])]
    Open {
        /// An end of such a side.
        place: [f64; 3],
    },
}

/// The measures of a closed mesh, by the divergence theorem. The bounds are those of its corners;
/// the solids are the outer shells, where no side has more than two triangles.
///
/// # Errors
/// The file is not of this format, or the mesh is not closed.
pub fn measures(bytes: &[u8], format: MeshFormat) -> Result<StatedMeasures, MeshReadError> {
    let options = MeshReadOptions {
        max_corners: 3 * MAX_TRIANGLES,
        placement: ObjectPlacement::Build,
    };
    TriangleMesh::new(MeshFile::read(bytes, format, &options)?).measures()
}

/// A side of triangles, with the numbers of those in each sense.
#[derive(Clone, Copy, Debug, Default)]
struct SideUse {
    forward: usize,
    backward: usize,
    /// A triangle there.
    triangle: usize,
}

/// The triangles of a file.
struct TriangleMesh {
    points: Vec<[f64; 3]>,
    triangles: Vec<[usize; 3]>,
    /// Whether the coordinates were rounded to single precision.
    is_single_precision: bool,
}

impl TriangleMesh {
    /// The triangles of each face, all from its first corner. One with two corners at one point has
    /// no area, and is left out.
    fn new(file: MeshFile<f64>) -> Self {
        let mut triangles = Vec::new();
        for face in file.objects.iter().flat_map(|faces| faces.iter()) {
            let [a, rest @ ..] = face else {
                continue;
            };
            let fan = rest.windows(2).map(|pair| [*a, pair[0], pair[1]]);
            triangles.extend(fan.filter(|[a, b, c]| a != b && b != c && c != a));
        }
        Self {
            points: file.points,
            triangles,
            is_single_precision: file.is_single_precision,
        }
    }

    fn measures(&self) -> Result<StatedMeasures, MeshReadError> {
        let count = self.triangles.len();
        if count > MAX_TRIANGLES {
            return Err(MeshReadError::TooMany { count });
        }
        // Relative to the first corner, so that the part's position costs no digits.
        let first = self.triangles.first().map(|corners| corners[0]);
        let Some(origin) = first.map(|corner| Point3::from(self.points[corner])) else {
            return Ok(StatedMeasures {
                volume: Some(0.0),
                area: Some(0.0),
                solids: Some(0),
                ..StatedMeasures::default()
            });
        };
        let sides = self.closed_sides()?;
        let mut volumes = Vec::with_capacity(self.triangles.len());
        let (mut area, mut outlines) = (0.0, 0.0);
        let (mut low, mut high): ([f64; 3], [f64; 3]) = (origin.into(), origin.into());
        for triangle in &self.triangles {
            let [a, b, c] = triangle.map(|corner| Point3::from(self.points[corner]));
            let across: Vector3<f64> = (b - a).cross(&(c - a));
            volumes.push((a - origin).dot(&across) / 6.0);
            area += across.norm() / 2.0;
            outlines += ((b - a).norm() + (c - b).norm() + (a - c).norm()) / 2.0;
            for p in [a, b, c] {
                low = std::array::from_fn(|i| low[i].min(p[i]));
                high = std::array::from_fn(|i| high[i].max(p[i]));
            }
        }
        let reach = low
            .iter()
            .chain(&high)
            .fold(0.0, |r: f64, x| r.max(x.abs()));
        let rounding = match self.is_single_precision {
            true => reach * f64::from(f32::EPSILON),
            false => 0.0,
        };
        Ok(StatedMeasures {
            volume: Some(volumes.iter().sum()),
            area: Some(area),
            bounds: Some([low, high]),
            solids: self.outer_shells(&sides, &volumes),
            accuracy: StatedAccuracy {
                relative: 0.0,
                volume: area * rounding,
                area: outlines * rounding,
            },
            seconds: None,
        })
    }

    /// The sides, each with as many triangles in one sense as in the other.
    fn closed_sides(&self) -> Result<HashMap<[usize; 2], SideUse>, MeshReadError> {
        let mut sides: HashMap<[usize; 2], SideUse> = HashMap::new();
        for (k, [a, b, c]) in self.triangles.iter().enumerate() {
            for [from, to] in [[*a, *b], [*b, *c], [*c, *a]] {
                let side = sides.entry([from.min(to), from.max(to)]).or_default();
                match from < to {
                    true => side.forward += 1,
                    false => side.backward += 1,
                }
                side.triangle = k;
            }
        }
        let open = sides
            .iter()
            .filter(|(_, side)| side.forward != side.backward);
        match open.map(|(ends, _)| ends[0]).min() {
            Some(end) => Err(MeshReadError::Open {
                place: self.points[end],
            }),
            None => Ok(sides),
        }
    }

    /// The number of connected pieces of the mesh with a positive volume; none where a side has more
    /// than two triangles.
    fn outer_shells(&self, sides: &HashMap<[usize; 2], SideUse>, volumes: &[f64]) -> Option<u64> {
        if sides.values().any(|side| side.forward > 1) {
            return None;
        }
        let mut shells: Vec<usize> = (0..self.triangles.len()).collect();
        let root = |shells: &mut Vec<usize>, mut k: usize| {
            while shells[k] != k {
                shells[k] = shells[shells[k]];
                k = shells[k];
            }
            k
        };
        for (k, [a, b, c]) in self.triangles.iter().enumerate() {
            for [from, to] in [[*a, *b], [*b, *c], [*c, *a]] {
                let other = sides[&[from.min(to), from.max(to)]].triangle;
                let (own, other) = (root(&mut shells, k), root(&mut shells, other));
                shells[own] = other;
            }
        }
        let mut enclosed: HashMap<usize, f64> = HashMap::new();
        for (k, volume) in volumes.iter().enumerate() {
            *enclosed.entry(root(&mut shells, k)).or_default() += volume;
        }
        Some(enclosed.values().filter(|volume| **volume > 0.0).count() as u64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A tetrahedron of volume 1/6 at a place.
    const OFF: &str = "OFF 4 4 0\n# corners\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n\
        3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

    fn close(a: Option<f64>, b: f64) -> bool {
        a.is_some_and(|a| (a - b).abs() < 1e-12)
    }

    #[test]
    fn formats_have_the_same_measures() {
        let obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n\
            f 1 3 2\nf 1/1 2/1 4/1\nf -4 -1 -2\nf 2//1 3//1 4//1\n";
        let points = [
            [0.0f32, 0.0, 0.0],
            [1.0, 0.0, 0.0],
            [0.0, 1.0, 0.0],
            [0.0, 0.0, 1.0],
        ];
        let triangles = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
        let mut stl = vec![b's'; HEADER];
        stl.extend(4u32.to_le_bytes());
        let mut text = "solid x\n".to_owned();
        for corners in triangles {
            stl.extend([0; 12]);
            text += "facet normal 0 0 0\nouter loop\n";
            for [x, y, z] in corners.map(|k| points[k]) {
                stl.extend([x, y, z].into_iter().flat_map(f32::to_le_bytes));
                text += &format!("vertex {x} {y} {z}\n");
            }
            stl.extend([0; 2]);
            text += "endloop\nendfacet\n";
        }
        text += "endsolid x\n";
        for (bytes, format) in [
            (OFF.as_bytes(), MeshFormat::Off),
            (obj.as_bytes(), MeshFormat::Obj),
            (&stl, MeshFormat::Stl),
            (text.as_bytes(), MeshFormat::Stl),
        ] {
            let found = measures(bytes, format).unwrap();
            assert!(close(found.volume, 1.0 / 6.0), "{format}: {found:?}");
            assert!(close(found.area, 1.5 + 3f64.sqrt() / 2.0), "{format}");
            assert_eq!(found.bounds, Some([[0.0; 3], [1.0; 3]]), "{format}");
            assert_eq!(found.solids, Some(1), "{format}");
        }
    }

    const HEADER: usize = 80;

    #[test]
    fn what_is_no_closed_mesh_is_an_error() {
        let open = OFF.replace("OFF 4 4", "OFF 4 3");
        let error = |text: &str, format| measures(text.as_bytes(), format).unwrap_err().to_string();
        assert!(error(&open, MeshFormat::Off).contains("not closed"));
        let turned = OFF.replace("3 0 2 1", "3 0 1 2");
        assert!(error(&turned, MeshFormat::Off).contains("not closed"));
        for (text, format) in [
            ("", MeshFormat::Off),
            ("OFF 1e18 1 0\n0 0 0\n", MeshFormat::Off),
            ("OFF 1 1 0\n0 0 nan\n", MeshFormat::Off),
            ("OFF 1 1 0\n0 0 0\n3 0 1 2\n", MeshFormat::Off),
            ("v 0 0 0\nf 1 2 3\n", MeshFormat::Obj),
            ("v 0 0 0\nf 0 1 1\n", MeshFormat::Obj),
            ("v 0 0 0\nf -9223372036854775808 1 1\n", MeshFormat::Obj),
            ("", MeshFormat::Stl),
            ("solid\nvertex 0 0 0\nendloop\n", MeshFormat::Stl),
            ("solid\n", MeshFormat::Stl),
        ] {
            assert!(error(text, format).contains("expected"), "{text}");
        }
    }

    #[test]
    fn a_void_is_no_solid() {
        let mut lines = OFF.replace("OFF 4 4", "OFF 8 8");
        // A smaller tetrahedron inside, turned inside out.
        let inner = "0.1 0.1 0.1\n0.2 0.1 0.1\n0.1 0.2 0.1\n0.1 0.1 0.2\n3 0 2 1\n";
        lines = lines.replace("3 0 2 1\n", inner);
        lines += "3 4 5 6\n3 4 7 5\n3 4 6 7\n3 5 7 6\n";
        let found = measures(lines.as_bytes(), MeshFormat::Off).unwrap();
        assert!(close(found.volume, 0.999 / 6.0), "{found:?}");
        assert_eq!(found.solids, Some(1));
    }
}
