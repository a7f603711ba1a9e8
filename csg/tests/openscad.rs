//! Volumes of what OpenSCAD describes.

use crate::common::{evaluated, tree};
use premio_csg::primitive::Primitive;
use premio_csg::reader::{
    FacetLimit, Format, IncludeError, IncludeLoader, IncludePath, Includes, ReadError, ReadOptions,
    StandaloneText, parse, read,
};
use premio_csg::tree::Tree;

/// The tree of a text in which every circle is a polygon.
fn faceted(text: &str) -> Tree {
    let options = ReadOptions {
        facets: FacetLimit::All,
        ..ReadOptions::default()
    };
    let read = read("part", text.as_bytes(), Format::Csg, &options);
    read.unwrap().tree
}

fn volume(text: &str) -> f64 {
    evaluated(&tree(text, Format::Csg)).mass().volume
}

/// A square with a corner on the axis has sides of which both diagonals are equally long, and a hole
/// with such a corner, too. The volumes are those of OpenSCAD 2021.01, from coordinates of six digits.
#[test]
fn equal_diagonals_bulge_the_inside_of_their_contour() {
    let square = "square(size = [20, 20]);";
    let holed = "difference() { square(size = [20, 20], center = true); \
        polygon(points = [[0, 0], [5, 0], [5, 5], [0, 5]]); }";
    for (figure, volume) in [(square, 4067.955), (holed, 3813.7196)] {
        for twist in [3, -3] {
            let text = format!("linear_extrude(height = 10, twist = {twist}) {{ {figure} }}");
            let found = evaluated(&faceted(&text)).mass().volume;
            assert!((found - volume).abs() < 2e-2, "{figure} {twist}: {found}");
        }
    }
}

/// The numbers of slices and the volumes are those of OpenSCAD 2021.01.
#[test]
fn extrusions_have_the_slices_of_openscad() {
    let cases = [
        ("twist = 90, scale = [1, 1]", 8, 4299.524),
        ("twist = -90, scale = [1, 1]", 8, 4299.524),
        ("twist = 90, scale = [1, 1], $fn = 20", 5, 4449.77),
        ("twist = 90, scale = [0.5, 0.5]", 8, 2507.668),
        ("scale = [0.3, 2]", 11, 3666.667),
    ];
    for (arguments, slices, volume) in cases {
        let square = "square(size = [20, 10], center = true);";
        let text = format!("linear_extrude(height = 20, {arguments}) {{ {square} }}");
        let tree = faceted(&text);
        let (_, leaf) = tree.leaves().next().unwrap();
        let Primitive::Polyhedron { polyhedron } = &leaf.primitive else {
            panic!("a polyhedron");
        };
        assert_eq!(polyhedron.points().len(), 4 * (slices + 1), "{arguments}");
        let found = evaluated(&tree).mass().volume;
        assert!((found - volume).abs() < 1e-2, "{arguments}: {found}");
    }
}

/// Files in memory.
#[derive(Debug)]
struct Shelf(Vec<(&'static str, &'static [u8])>);

impl IncludeLoader for Shelf {
    fn find(&self, including: Option<&str>, path: &str) -> Result<IncludePath, IncludeError> {
        assert_eq!(including, Some("part.csg"));
        let (name, identity) = (path.to_owned(), path.to_owned());
        match self.0.iter().any(|(known, _)| *known == path) {
            true => Ok(IncludePath { name, identity }),
            false => Err(IncludeError::new("no such file")),
        }
    }

    fn load(&self, file: &IncludePath) -> Result<Vec<u8>, IncludeError> {
        let found = self.0.iter().find(|(known, _)| *known == file.name);
        Ok(found.map(|(_, bytes)| bytes.to_vec()).unwrap_or_default())
    }
}

/// The volume of a part that imports these files.
fn imported(text: &str, files: &[(&'static str, &'static [u8])]) -> Result<f64, ReadError> {
    let options = ReadOptions {
        includes: Includes::new(Shelf(files.to_vec())),
        ..ReadOptions::default()
    };
    let program = parse("part.csg", text.as_bytes(), Format::Csg, &options)?;
    assert_eq!(program.standalone, StandaloneText::Unavailable);
    assert_eq!(program.included.len(), files.len());
    let tree = program.tree("part.csg", text.as_bytes())?;
    Ok(evaluated(&tree).mass().volume)
}

/// A half disc of radius 2, closed by a line.
const HALF_DISC: &[u8] =
    b"0\nSECTION\n2\nENTITIES\n0\nARC\n8\n0\n10\n0\n20\n0\n40\n2\n50\n0\n51\n180\n\
    0\nLINE\n8\n0\n10\n-2\n20\n0\n11\n2\n21\n0\n0\nENDSEC\n0\nEOF\n";

const TETRAHEDRON: &[u8] =
    b"OFF 4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

#[test]
fn files_are_imported() {
    let plate = "linear_extrude(height = 3) { import(file = \"a.dxf\", layer = \"\"); }";
    let volume = imported(plate, &[("a.dxf", HALF_DISC)]).unwrap();
    assert!((volume - 6.0 * std::f64::consts::PI).abs() < 1e-9);
    let solid = "import(file = \"t.off\", convexity = 2);";
    let volume = imported(solid, &[("t.off", TETRAHEDRON)]).unwrap();
    assert!((volume - 1.0 / 6.0).abs() < 1e-12);
    // Heights of 1, over a base at zero: a block.
    let field = "surface(file = \"h.dat\", center = true);";
    let volume = imported(field, &[("h.dat", b"1 1 1\n1 1 1\n")]).unwrap();
    assert!((volume - 2.0).abs() < 1e-12);
    for (text, files) in [
        ("import(file = \"none.stl\");", &[][..]),
        ("import(file = \"a.txt\");", &[("a.txt", &b""[..])]),
        ("import(file = \"t.off\");", &[("t.off", &b"OFF 1 1 1"[..])]),
        ("surface(file = \"h.dat\");", &[("h.dat", &b"1 x"[..])]),
    ] {
        let error = imported(text, files).unwrap_err().to_string();
        assert!(error.starts_with("part.csg:1:"), "{error}");
    }
    let error = parse(
        "part.csg",
        solid.as_bytes(),
        Format::Csg,
        &ReadOptions::default(),
    );
    assert!(
        error
            .unwrap_err()
            .to_string()
            .contains("files cannot be read")
    );
}

/// A profile of an intersection is combined before its hull is made.
#[test]
fn operands_of_hulls_are_combined_in_the_plane() {
    let half = "intersection() { circle(r = 2, $fn = 0); multmatrix([[1,0,0,-2],[0,1,0,0],\
        [0,0,1,0],[0,0,0,1]]) { square(size = [4, 2]); } }";
    let plate = format!("hull() {{ linear_extrude(height = 3) {{ {half} }} }}");
    assert!((volume(&plate) - 6.0 * std::f64::consts::PI).abs() < 1e-9);
}

/// The corners of the upper plate are at 54.00017, by the rounding of its numbers.
#[test]
fn rounded_corners_of_hulls_are_about_common_axes() {
    let plate = |size: &str, radius: &str, height: &str, z: &str| {
        let figure = format!(
            "offset(r = {radius}) {{ offset(r = -{radius}) {{ square(size = {size}, center = true); }} }}"
        );
        let plate = format!("linear_extrude(height = {height}) {{ {figure} }}");
        format!("multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,{z}],[0,0,0,1]]) {{ {plate} }}")
    };
    let low = plate("[116, 66]", "4", "1", "0");
    let high = plate("[121.602, 71.6017]", "6.80083", "1", "3");
    let text = format!("hull() {{ {low} {high} }}");
    let options = ReadOptions::default();
    let read = read("part", text.as_bytes(), Format::Csg, &options).unwrap();
    let [note] = &read.notes[..] else {
        panic!("{:?}", read.notes);
    };
    let end = "coordinates change by up to 1.7e-4";
    assert!(note.text.ends_with(end), "{}", note.text);
    // Sections have the area 108 * 58 + 332 r + pi r^2; r grows from 4 to 6.8 over a height of 3.
    let [r, s] = [4.0f64, 6.80083];
    let mean =
        108.0 * 58.0 + 332.0 * (r + s) / 2.0 + std::f64::consts::PI * (r * r + r * s + s * s) / 3.0;
    let top = 108.0 * 58.0 + 332.0 * s + std::f64::consts::PI * s * s;
    assert!((volume(&text) - (3.0 * mean + top)).abs() < 1e-6);
}

/// A cube of 1e10 stands for a half-space. The step of 0.01 is below 1e-11 of its size.
#[test]
fn vast_tools_do_not_coarsen_the_resolution() {
    let vast = "multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube(size = [1e+10, 1e+10, 1e+10]); }";
    let step = "cube(size = [2, 2, 1]); multmatrix([[1,0,0,0],[0,1,0,0],[0,0,1,1],[0,0,0,1]]) { \
        cube(size = [1, 1, 0.01]); }";
    let ball = "rotate_extrude(angle = 360, $fn = 60) { multmatrix([[0,1,0,0],[-1,0,0,0],[0,0,1,0],\
        [0,0,0,1]]) { intersection() { circle(r = 50, $fn = 60); multmatrix([[1,0,0,-51],[0,1,0,0],\
        [0,0,1,0],[0,0,0,1]]) { square(size = [102, 51]); } } } }";
    let clipped = |part: &str| volume(&format!("intersection() {{ union() {{ {part} }} {vast} }}"));
    assert!((clipped(step) - 4.01).abs() < 1e-9);
    let eighth = 50f64.powi(3) * std::f64::consts::PI / 6.0;
    assert!((clipped(ball) - eighth).abs() < 1e-6);
}
