//! The colours of faces.

use crate::common::{evaluated, tree};
use premio_csg::evaluate::face_colours;
use premio_csg::reader::Format;
use std::collections::BTreeMap;

/// The number of faces of each colour.
fn count(text: &str) -> BTreeMap<String, usize> {
    let tree = tree(text, Format::Csg);
    let evaluation = evaluated(&tree);
    let mut count = BTreeMap::new();
    for colour in face_colours(&tree, &evaluation) {
        let name = colour.map_or("none".to_owned(), |colour| colour.to_string());
        *count.entry(name).or_default() += 1;
    }
    count
}

fn is(text: &str, expected: &[(&str, usize)]) {
    let expected = expected.iter().map(|(name, n)| ((*name).to_owned(), *n));
    assert_eq!(count(text), expected.collect(), "{text}");
}

const RED: &str = "color([1, 0, 0, 1])";
const BLUE: &str = "color([0, 0, 1, 1])";

#[test]
fn faces_have_the_colours_of_their_primitives() {
    is("cube(size = 2);", &[]);
    is(&format!("{RED} {{ cube(size = 2); }}"), &[("#FF0000FF", 6)]);
    // A bore has the colour of what was taken away.
    let bore = format!(
        "difference() {{ {RED} {{ cube(size = [4, 4, 4], center = true); }}
         {BLUE} {{ cylinder(h = 6, r1 = 1, r2 = 1, center = true); }} }}"
    );
    is(&bore, &[("#0000FFFF", 1), ("#FF0000FF", 6)]);
    // Three flush faces are one each, of the first primitive.
    let flush = format!(
        "{RED} {{ cube(size = [2, 2, 2]); }}
         {BLUE} {{ multmatrix([[1,0,0,1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) {{ cube(size = [2, 2, 3]); }} }}"
    );
    is(&flush, &[("#0000FFFF", 3), ("#FF0000FF", 5)]);
    // A ball has no edge. What is hulled has the colour around the hull.
    let ball = format!("{BLUE} {{ sphere(r = 2); }} cube(size = 1);");
    is(&ball, &[("#0000FFFF", 1)]);
    let hull = format!("{BLUE} {{ hull() {{ {RED} {{ cube(size = 1); }} sphere(r = 0); }} }}");
    is(&hull, &[("#0000FFFF", 6)]);
}

/// The outermost colour counts, also under a map that makes other primitives.
#[test]
fn colours_outside_win() {
    let map = "multmatrix([[2,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]])";
    is(
        &format!("{map} {{ {RED} {{ {BLUE} {{ sphere(r = 2); }} }} }}"),
        &[("#FF0000FF", 1)],
    );
    is(
        &format!("{BLUE} {{ {map} {{ {RED} {{ sphere(r = 2); }} }} }}"),
        &[("#0000FFFF", 1)],
    );
    // Colours that OpenSCAD does not know.
    is("color([-1, -1, -1, 1]) { cube(size = 2); }", &[]);
}
