//! Tests of POV-Ray's language.

use super::*;
use insta::assert_snapshot;

fn pov(text: &str) -> String {
    message(text, Format::Pov)
}

fn points(text: &str, inside: impl Fn([f64; 3]) -> bool) {
    assert_same_points(&tree(text, Format::Pov), inside);
}

fn n<const N: usize>(values: [i32; N]) -> [Rational; N] {
    values.map(Rational::from)
}

/// The only primitive of a scene.
fn only(text: &str) -> PlacedPrimitive {
    let tree = tree(text, Format::Pov);
    let (_, placed) = tree.leaves().next().unwrap();
    placed.clone()
}

#[test]
fn primitives() {
    points("box { <3, -1, 0>, <1, 2, 5> }", |[x, y, z]| {
        x > 1. && x < 3. && y > -1. && y < 2. && z > 0. && z < 5.
    });
    points("sphere { <1, 2, 3>, 2.5 }", |[x, y, z]| {
        (x - 1.).powi(2) + (y - 2.).powi(2) + (z - 3.).powi(2) < 6.25
    });
    points("cylinder { <0, -2, 1>, <0, 3, 1>, 2 }", |[x, y, z]| {
        x.hypot(z - 1.) < 2. && y > -2. && y < 3.
    });
    points("cone { -4*x, 1, 5*x, 3 }", |[x, y, z]| {
        x > -4. && x < 5. && y.hypot(z) < 1. + 2. * (x + 4.) / 9.
    });
    points("torus { 4, 1.5 }", |[x, y, z]| {
        (x.hypot(z) - 4.).hypot(y) < 1.5
    });
}

#[test]
fn scenes() {
    let text = r#"
// A scene /* not a comment
/* A comment /* in a comment */ */
#version 3.7;
#include "colors.inc"
global_settings { assumed_gamma 1.0 }
camera { location <0, 2, -8> look_at 0 right x*image_width/image_height }
light_source { 0*x color rgb <1, 1, 1> translate <-5, 10, -9> }
#declare R = 2 + .5;
#declare Away = <R, 0, 1e0>*2 - x;
#declare Red = color rgb <1, 0, 0>;
#declare Skin = texture { pigment { color Red } finish { phong 1 } }
#declare Ball = sphere { 0, R texture { Skin } }
difference {
  #declare Half = R/2;
  object { Ball }
  light_source { 0, rgb 1 }
  cylinder { -5*z, 5*z, Half hollow on }
  translate Away
  texture { Skin scale 2 }
  no_shadow
}
"#;
    points(text, |[x, y, z]| {
        let (x, z) = (x - 4., z - 2.);
        x * x + y * y + z * z < 6.25 && x.hypot(y) > 1.25
    });
    let notes = read_text(text, Format::Pov).unwrap().notes;
    assert_eq!(notes[0].text, "\"colors.inc\" is not read");
    assert!(notes[1].text.contains("left-handed"));
}

#[test]
fn placements() {
    // Rotated about x, then about z.
    let turned = only("cylinder { 0, 4*y, 1 rotate <90, 0, 90> translate 1 }");
    assert_eq!(turned.motion.apply_point(&n([0, 0, 4])), n([1, 1, 5]));
    let larger = only("sphere { <1, 2, 3>, 2 scale 3 }");
    assert_eq!(larger.primitive, Primitive::sphere(6.into()).unwrap());
    assert_eq!(larger.motion.offset(), &n([3, 6, 9]));
    let mirrored = only("cylinder { <1, 2, 3>, <1, 2, 7>, 2 scale <-2, 2, -2> }");
    assert_eq!(mirrored.motion.apply_point(&n([0, 0, 8])), n([-2, 4, -14]));
    let mirrored = only("cylinder { <1, 2, 3>, <1, 2, 7>, 2 scale <-1, 1, 1> }");
    assert_eq!(mirrored.motion.apply_point(&n([0, 0, 4])), n([-1, 2, 7]));
    // A box may be scaled differently along the axes while it is axis-aligned.
    let scaled = only("box { 0, 1 translate -1/2 scale <2, -4, 6> rotate 90*y }");
    assert_eq!(scaled.primitive, Primitive::block(n([2, 4, 6])).unwrap());
}

#[test]
fn operations() {
    let balls = "sphere { 0, 3 } sphere { 2*x, 3 } sphere { 2*y, 3 }";
    let held = |[x, y, z]: [f64; 3]| {
        let ball = |a: f64, b: f64| (x - a).powi(2) + (y - b).powi(2) + z * z < 9.;
        [ball(0., 0.), ball(2., 0.), ball(0., 2.)]
    };
    points(&format!("union {{ {balls} }}"), |p| held(p).contains(&true));
    points(&format!("merge {{ {balls} }}"), |p| held(p).contains(&true));
    points(balls, |p| held(p).contains(&true));
    points(&format!("intersection {{ {balls} }}"), |p| {
        !held(p).contains(&false)
    });
    points(&format!("difference {{ {balls} }}"), |p| {
        held(p) == [true, false, false]
    });
    let inside_out = "intersection { sphere { 0, 3 } sphere { 2*x, 3 inverse } }";
    points(inside_out, |p| held(p)[0] && !held(p)[1]);
    let inside_out = "difference { sphere { 0, 3 } sphere { 2*x, 3 inverse } }";
    points(inside_out, |p| held(p)[0] && held(p)[1]);
    let outside =
        "difference { sphere { 0, 3 } union { sphere { 2*x, 3 } sphere { 2*y, 3 } inverse } }";
    points(outside, |p| held(p)[0] && (held(p)[1] || held(p)[2]));
}

/// The inside of a plane is the side from which its normal points away.
#[test]
fn planes() {
    let text =
        "intersection { plane { -x, 0 } plane { -y, 0 } plane { -z, 0 } plane { <2, 2, 1>, 1 } }";
    points(text, |p| {
        let above = 2.0 * p[0] + 2.0 * p[1] + p[2];
        p.iter().all(|&x| x >= 0.0) && above <= 3.0
    });
    let scaled = "intersection { sphere { 0, 3 } plane { y, 1 scale <1, -1, 1> } plane { x+z, 1/2 scale 2 } }";
    points(scaled, |p| {
        let is_in_ball = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] < 9.0;
        is_in_ball && p[1] > -1.0 && (p[0] + p[2]) / 2.0_f64.sqrt() < 1.0
    });
    assert_snapshot!(pov("plane { y, 1 }"), @"part:1:1: found a part that is unbounded toward +x, expected solids that bound it on every side");
    assert_snapshot!(pov("plane { 0*x, 1 }"), @"part:1:9: found the normal (0, 0, 0), expected a normal of some length");
}

#[test]
fn parts_by_name() {
    let text = "#declare A = box { 0, 1 }
        #declare B = object { A clipped_by { A } }
        #declare Step = 3*x; #declare C = union { object { A } object { A translate Step.x*y } }
        lathe { 2 }";
    let part = |name: &str| {
        let options = ReadOptions {
            part: Some(name.to_owned()),
            ..ReadOptions::default()
        };
        read("part", text.as_bytes(), Format::Pov, &options)
    };
    assert_eq!(part("C").unwrap().tree.leaves().count(), 2);
    assert!(part("B").is_err() && part("Step").is_err() && part("D").is_err());
    assert_snapshot!(pov(text), @"part:4:9: found the object `lathe`, expected one that is exact here: `box`, `sphere`, `cylinder`, `cone`, `torus`, `plane`, `union`, `merge`, `intersection`, `difference`, `object`");
}

#[test]
fn what_is_not_ours() {
    assert_snapshot!(pov("sphere { 0, 1 }\nblob { threshold 0.6 component 1, 1, <0, 0, 0> }"), @"part:2:1: found the object `blob`, expected one that is exact here: `box`, `sphere`, `cylinder`, `cone`, `torus`, `plane`, `union`, `merge`, `intersection`, `difference`, `object`");
    assert_snapshot!(pov("torus { 3, 1 scale <1, 2, 1> }"), @"part:1:20: found a map that changes the shape of revolutions, expected spheres, cylinders, cones, prisms or plane faces, or a scale equal in all directions");
    assert_snapshot!(pov("union { sphere { 0, 1 } box { -1, 1 clipped_by { sphere { 0, 1 } } } }"), @"part:1:37: found the modifier `clipped_by`, expected `translate`, `rotate`, or `scale` the same in all directions");
    assert_snapshot!(pov("cylinder { 0, y, 1 open }"), @"part:1:20: found the modifier `open`, expected `translate`, `rotate`, or `scale` the same in all directions");
    assert_snapshot!(pov("sphere { 0, 1 inverse }"), @"part:1:1: found a part that is unbounded on every side, expected solids that bound it on every side");
    assert_snapshot!(pov("torus { 1, 0 }"), @"part:1:12: found the value 0, expected a minor radius greater than zero");
    assert_snapshot!(pov("box { 0, <1, 0, 1> }"), @"part:1:10: found a box without volume, expected two corners that differ along x, y and z");
    assert_snapshot!(pov("cylinder { y, y, 1 }"), @"part:1:18: found an axis without length, expected two points that differ");
    assert_snapshot!(pov("#declare R = sqrt(2);\nsphere { 0, R }"), @"part:1:14: found the unknown name `sqrt`, expected an exact number, or a name that is declared above");
    assert_snapshot!(pov("#declare A = sphere { 0, 1 matrix <1,0,0, 0,1,0, 0,0,1, 0,0,0> }\nobject { A }"), @"part:1:28: found the modifier `matrix`, expected `translate`, `rotate`, or `scale` the same in all directions");
    assert_snapshot!(pov("#include \"shapes.inc\"\nobject { UnitBox }"), @r#"part:2:10: found the unknown name `UnitBox`, expected an exact number, or a name that is declared above (what is declared in "shapes.inc" is not read)"#);
    assert_snapshot!(pov("#macro M(A) sphere { 0, A } #end"), @"part:1:2: found `macro`, expected `#declare`, `#local`, `#include` or `#version` (loops, conditions and macros are not read)");
    assert_snapshot!(pov("#while (1) #end"), @"part:1:2: found `while`, expected `#declare`, `#local`, `#include` or `#version` (loops, conditions and macros are not read)");
}

#[test]
fn messages() {
    assert_snapshot!(pov(""), @"part:1:1: found no object in the scene, expected one at least");
    assert_snapshot!(pov("#declare Ball = sphere { 0, 1 }"), @"part:1:32: found no object in the scene, expected one at least (`--part` reads one of Ball)");
    assert_snapshot!(pov("sphere { 0, 1"), @"part:1:14: found the end of the file, expected a closing bracket (the bracket opened on line 1 is not closed)");
    assert_snapshot!(pov("sphere { 0 1 } }"), @"part:1:16: found `}`, expected an object, one of `box`, `sphere`, `cylinder`, `cone`, `torus`, `plane`, `union`, `merge`, `intersection`, `difference`, `object`, or `#declare`");
    assert_snapshot!(pov("sphere { 0, <1, 2> }"), @"part:1:13: found a vector, expected a number");
    assert_snapshot!(pov("sphere { <1, 2, 3, 4>, 1 }"), @"part:1:10: found a vector of 4, expected a vector of three");
    assert_snapshot!(pov("sphere { 0, 1 translat x }"), @"part:1:15: found `translat`, expected an object, a modifier or `}` (did you mean `translate`?)");
    assert_snapshot!(pov("spere { 0, 1 }"), @"part:1:1: found `spere`, expected an object, one of `box`, `sphere`, `cylinder`, `cone`, `torus`, `plane`, `union`, `merge`, `intersection`, `difference`, `object`, or `#declare` (did you mean `sphere`?)");
    assert_snapshot!(pov("sphere { 0, 1/0 }"), @"part:1:13: found a division by zero, expected a number other than zero");
    assert_snapshot!(pov("sphere { 0, (1 }"), @"part:1:16: found `}`, expected `)` or an operator");
    assert_snapshot!(pov("/* /* */ sphere { 0, 1 }"), @"part:1:1: found a comment without an end, expected a closing `*/`");
    assert_snapshot!(pov("#declare T = texture { pigment { rgb 1 } }\nobject { T }"), @"part:2:10: found `T`, which is neither a number nor an object, expected an object");
    assert_snapshot!(pov("object { Wheel(2) }"), @"part:1:10: found `Wheel`, expected an object (macros are not read)");
    assert_snapshot!(pov("Wheel(2)"), @"part:1:1: found `Wheel`, expected an object, one of `box`, `sphere`, `cylinder`, `cone`, `torus`, `plane`, `union`, `merge`, `intersection`, `difference`, `object`, or `#declare` (macros are not read)");
    assert_snapshot!(pov("sphere { 0, 1 scale 0 }"), @"part:1:21: found a scale of zero, expected factors other than zero");
    assert_snapshot!(pov("#declare box = 3;"), @"part:1:10: found `box`, expected a name that is not a keyword");
}
