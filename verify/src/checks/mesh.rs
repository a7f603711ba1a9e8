//! Checks the meshes of a part as written to files, in the precision of each format. They must be
//! closed and oriented, have no triangle of zero area, and have the volume of the boundary up to
//! the deviation.

use super::{Check, CheckSubject, Checker, Finding};
use nalgebra::{Point3, Vector3};
use premio_exchange::mesh::{self, Facets, MeshError, obj, stl};
use premio_kernel::tessellation::Accuracy;
use std::collections::HashMap;

/// A mesh that was read back.
#[derive(Clone, Debug, Default)]
struct Read {
    points: Vec<Point3<f64>>,
    triangles: Vec<[usize; 3]>,
    /// Whether points with equal coordinates are one point, whatever solid or piece they belong to.
    is_by_place: bool,
}

/// What is known of the mesh from the boundary.
#[derive(Clone, Copy, Debug)]
struct Known {
    volume: f64,
    /// The volume error allowed.
    allowed: f64,
    /// Whether the boundary touches itself, so that several points may coincide.
    is_crowded: bool,
}

impl Checker<'_> {
    /// Writes meshes, reads them back and checks them.
    pub(crate) fn mesh(&self) -> Check {
        let check = |finding, detail| Check {
            subject: CheckSubject::Mesh,
            finding,
            detail,
        };
        let evaluation = self.evaluation;
        let topology = &evaluation.brep.topology;
        if topology.solids.is_empty() {
            return check(Finding::Passes, "nothing to write".to_owned());
        }
        let accuracy = Accuracy {
            deviation: mesh::DEVIATION * self.bounds.diagonal(),
            angle: mesh::ANGLE.to_radians(),
        };
        let resolution = evaluation.f64_resolution();
        let facets = match Facets::new(&evaluation.brep, &accuracy, resolution) {
            Ok(facets) => facets,
            Err(error) => return check(Finding::Passes, format!("refused: {error}")),
        };
        let mass = evaluation.mass();
        let known = Known {
            volume: mass.volume,
            allowed: mass.area * accuracy.deviation,
            is_crowded: topology.edges_of_many_faces() > 0 || !topology.touches.is_empty(),
        };
        let formats = [
            ("obj", Ok(from_obj(&obj::write(&facets, "part")))),
            ("stl", stl::write(&facets).map(|bytes| from_stl(&bytes))),
        ];
        let mut wrong = Vec::new();
        let mut right = vec![format!("{} triangles", facets.facets.len())];
        for (name, read) in formats {
            match read {
                Ok(Some(read)) => match flaw(&read, &known) {
                    Some(flaw) => wrong.push(format!("{name}: {flaw}")),
                    None => right.push(format!("{name} is closed")),
                },
                Ok(None) => wrong.push(format!("{name}: not read")),
                Err(error) => right.push(refused(name, &error)),
            }
        }
        match wrong.is_empty() {
            true => check(Finding::Passes, right.join(", ")),
            false => check(Finding::Fails, wrong.join("; ")),
        }
    }
}

fn refused(name: &str, error: &MeshError) -> String {
    format!("{name} is refused: {error}")
}

/// The triangles of an OBJ file.
fn from_obj(text: &str) -> Option<Read> {
    let mut read = Read::default();
    for line in text.lines() {
        let mut words = line.split_whitespace();
        match words.next() {
            Some("v") => {
                let numbers: Result<Vec<f64>, _> = words.map(str::parse).collect();
                let place: [f64; 3] = numbers.ok()?.try_into().ok()?;
                read.points.push(place.into());
            }
            Some("f") => {
                let number = |word: &str| word.split('/').next()?.parse::<usize>().ok();
                let corners: Option<Vec<usize>> = words.map(number).collect();
                let corners: [usize; 3] = corners?.try_into().ok()?;
                read.triangles.push(corners.map(|c| c.wrapping_sub(1)));
            }
            _ => {}
        }
    }
    let is_there = |c: &usize| *c < read.points.len();
    read.triangles
        .iter()
        .flatten()
        .all(is_there)
        .then_some(read)
}

/// The lengths in bytes of a binary STL's header, triangle and number.
const HEADER: usize = 80;
const TRIANGLE: usize = 50;
const NUMBER: usize = 4;

/// The triangles of a binary STL file; points with equal coordinates are merged.
fn from_stl(bytes: &[u8]) -> Option<Read> {
    let number =
        |at: usize| -> Option<[u8; NUMBER]> { bytes.get(at..at + NUMBER)?.try_into().ok() };
    let count = u32::from_le_bytes(number(HEADER)?) as usize;
    let start = HEADER + NUMBER;
    if bytes.len() != start + count * TRIANGLE {
        return None;
    }
    let mut read = Read {
        is_by_place: true,
        ..Read::default()
    };
    let mut known: HashMap<[u32; 3], usize> = HashMap::new();
    for triangle in 0..count {
        let mut corners = [0; 3];
        for (k, corner) in corners.iter_mut().enumerate() {
            // The normal comes first.
            let at = start + triangle * TRIANGLE + 3 * NUMBER * (k + 1);
            let mut place = [0.0f32; 3];
            for (i, x) in place.iter_mut().enumerate() {
                // A negative zero is the same coordinate.
                *x = f32::from_le_bytes(number(at + i * NUMBER)?) + 0.0;
            }
            *corner = *known.entry(place.map(f32::to_bits)).or_insert_with(|| {
                read.points.push(place.map(f64::from).into());
                read.points.len() - 1
            });
        }
        read.triangles.push(corners);
    }
    Some(read)
}

/// What is wrong with a mesh.
fn flaw(read: &Read, known: &Known) -> Option<String> {
    let mut sides: HashMap<[usize; 2], usize> = HashMap::new();
    for [a, b, c] in &read.triangles {
        for side in [[*a, *b], [*b, *c], [*c, *a]] {
            *sides.entry(side).or_default() += 1;
        }
    }
    let place = |corner: usize| {
        let p = read.points[corner];
        format!("at ({:.6}, {:.6}, {:.6})", p.x, p.y, p.z)
    };
    let is_open = |(side, count): &(&[usize; 2], &usize)| {
        let [a, b] = **side;
        sides.get(&[b, a]) != Some(*count)
    };
    if let Some((side, _)) = sides.iter().find(is_open) {
        return Some(format!("not closed, or not oriented {}", place(side[0])));
    }
    let most = match read.is_by_place && known.is_crowded {
        true => usize::MAX,
        false => 1,
    };
    if let Some((side, _)) = sides.iter().find(|(_, count)| **count > most) {
        return Some(format!("a side of many triangles {}", place(side[0])));
    }
    // Relative to a corner, so that the part's position costs no digits.
    let origin = read.points.first()?;
    let mut volume = 0.0;
    for triangle in &read.triangles {
        let [a, b, c] = triangle.map(|k| read.points[k]);
        let across = (b - a).cross(&(c - a));
        if across == Vector3::zeros() {
            return Some(format!("a triangle without an area {}", place(triangle[0])));
        }
        volume += (a - origin).dot(&across) / 6.0;
    }
    let off = (volume - known.volume).abs();
    let is_off = off.is_nan() || off > known.allowed;
    is_off.then(|| format!("the volume is {volume}, not {}", known.volume))
}
