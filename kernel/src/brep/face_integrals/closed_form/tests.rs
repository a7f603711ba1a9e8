use super::*;
use crate::brep::face_integrals::density::Density;
use crate::brep::face_integrals::ground::{Ground, Middle};
use crate::brep::face_integrals::outline::by_quadrature;
use crate::brep::face_integrals::{Amid, Care, EdgeDivision};
use crate::geometry::curve::Ellipse;
use crate::geometry::frame::Frame;
use crate::geometry::surface::{Cone, Cylinder, Plane};
use approx::assert_relative_eq;
use proptest::prelude::*;
use std::cell::Cell;
use std::f64::consts::TAU;

fn frame(tilt: f64, origin: [f64; 3]) -> Frame {
    let z = Vector3::new(tilt.cos(), 0.7 * tilt.sin(), 0.4).normalize();
    Frame::toward(origin.into(), z, Vector3::new(0.1, 1.0, 0.3))
}

/// The circle at a height about the axis of a frame.
fn about(frame: &Frame, z: f64, radius: f64, phase: f64) -> Curve {
    let z_axis = if phase > 0.0 { frame.z } else { -frame.z };
    let x = frame.x * phase.cos() + frame.y * phase.sin();
    let frame = Frame::toward(frame.point(0.0, 0.0, z), z_axis, x);
    Curve::Circle(Circle { frame, radius })
}

/// The closed form and the quadrature of an edge on a surface.
fn both_ways(surface: Surface, curve: &Curve, range: [f64; 2]) -> [Option<[f64; 6]>; 2] {
    let reference = Point3::new(0.3, -0.2, 0.9);
    let amid = Amid {
        reference,
        size: 4.0,
        care: Care::Doubles,
        division: EdgeDivision::Plain,
    };
    let density = Density {
        ground: Ground {
            surface,
            reference,
            base: 0.0,
            middle: Middle::at(0.0),
        },
        rounded_f64: None,
        amid: &amid,
        floor: [0.0; 5],
        defect: Cell::new(0.0),
    };
    let start = 0.4;
    [
        along_edge(&density.ground, &amid, curve, range, start),
        Some(by_quadrature(&density, curve, range, start)),
    ]
}

proptest! {
    #[test]
    fn edges_have_the_integrals_that_quadrature_gives(
        tilt in 0.0..TAU,
        origin in prop::array::uniform3(-1.0..1.0),
        lo in -7.0..7.0,
        length in prop_oneof![0.01..TAU, Just(TAU)],
        [a, b] in prop::array::uniform2(0.3..2.0_f64),
        [x, y] in prop::array::uniform2(-1.0..1.0),
        phase in -1.0..1.0_f64,
    ) {
        let f = frame(tilt, origin);
        let plane = Surface::Plane(Plane { frame: f });
        let in_plane = f.at(f.point(x, y, 0.0));
        let turned = Frame::toward(in_plane.origin, f.z, f.x * phase.cos() + f.y * phase.sin());
        let [a, b] = [a.max(b), a.min(b)];
        let cone = Cone { frame: f, sin: phase.sin().abs().max(0.1), cos: 0.0 };
        let cone = Cone { cos: (1.0 - cone.sin * cone.sin).sqrt(), ..cone };
        let torus = Torus { frame: f, major: a + 0.2, minor: b };
        let tube = Frame {
            origin: f.point((a + 0.2) * phase.cos(), (a + 0.2) * phase.sin(), 0.0),
            x: f.x * phase.cos() + f.y * phase.sin(),
            y: f.z,
            z: f.x * phase.sin() - f.y * phase.cos(),
        };
        let v = 1.0 + phase;
        let cases = [
            (plane, Curve::Line(Line { origin: in_plane.origin, direction: turned.x })),
            (plane, Curve::Circle(Circle { frame: turned, radius: a })),
            (plane, Curve::Ellipse(Ellipse { frame: turned, a, b })),
            (Surface::Cylinder(Cylinder { frame: f, radius: a }), about(&f, x, a, phase)),
            (
                Surface::Cylinder(Cylinder { frame: f, radius: a }),
                Curve::Line(Line { origin: f.point(a * phase.cos(), a * phase.sin(), y), direction: f.z }),
            ),
            (Surface::Cone(cone), about(&f, v, v * cone.sin / cone.cos, phase)),
            (
                Surface::Torus(torus),
                about(&f, b * phase.sin(), a + 0.2 + b * phase.cos(), phase),
            ),
            (Surface::Torus(torus), Curve::Circle(Circle { frame: tube, radius: b })),
        ];
        for (i, (surface, curve)) in cases.into_iter().enumerate() {
            let [closed, summed] = both_ways(surface, &curve, [lo, lo + length]);
            let closed = closed.expect("there is a closed form");
            for (c, s) in closed.into_iter().zip(summed.into_iter().flatten()) {
                prop_assert!((c - s).abs() <= 1e-11, "case {i}: {c} for {s}");
            }
        }
    }
}

#[test]
fn a_unit_disc_has_the_area_of_one() {
    let plane = Surface::Plane(Plane {
        frame: Frame::world(),
    });
    let circle = Curve::Circle(Circle {
        frame: Frame::world(),
        radius: 1.0,
    });
    let [closed, _] = both_ways(plane, &circle, [0.0, TAU]);
    // −∮ v du is the area of a counterclockwise loop.
    assert_relative_eq!(
        -closed.map_or(f64::NAN, |sum| sum[0]),
        0.5 * TAU,
        epsilon = 1e-14
    );
}
