//! Wavefront OBJ: points and normals in f64, an object for each solid, a group for each face.
//!
//! It is written here, because the crates that write it use single precision.

use super::{Facet, Facets};
use nalgebra::Vector3;
use premio_text::escape;
use std::collections::HashMap;
use std::fmt::Write as _;

/// The text of a file.
pub fn write(facets: &Facets, name: &str) -> String {
    // A name ends at the end of its line.
    let name = escape::line(name);
    let mut text = String::new();
    for p in &facets.points {
        line(&mut text, format_args!("v {} {} {}", p.x, p.y, p.z));
    }
    let mut normals: HashMap<[u64; 3], usize> = HashMap::new();
    let mut number = |text: &mut String, n: &Vector3<f64>| {
        let next = normals.len() + 1;
        let bits: [u64; 3] = n.map(f64::to_bits).into();
        *normals.entry(bits).or_insert_with(|| {
            line(text, format_args!("vn {} {} {}", n.x, n.y, n.z));
            next
        })
    };
    let count = facets.solids().count();
    for (solid, of_solid) in facets.solids().enumerate() {
        match count {
            1 => line(&mut text, format_args!("o {name}")),
            _ => line(&mut text, format_args!("o {name} {}", solid + 1)),
        }
        for of_face in of_solid.chunk_by(|a, b| a.face == b.face) {
            line(&mut text, format_args!("g face{}", of_face[0].face.0));
            for Facet {
                corners, normals, ..
            } in of_face
            {
                let [i, j, k] = normals.map(|n| number(&mut text, &n));
                let [a, b, c] = corners.map(|c| c + 1);
                line(&mut text, format_args!("f {a}//{i} {b}//{j} {c}//{k}"));
            }
        }
    }
    text
}

fn line(text: &mut String, content: std::fmt::Arguments<'_>) {
    // Writing to a string does not fail.
    let _ = writeln!(text, "{content}");
}
