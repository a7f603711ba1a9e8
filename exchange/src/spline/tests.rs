use super::*;
use nalgebra::Vector3;
use premio_csg::evaluate::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::EdgeId;
use premio_kernel::geometry::curve::{Circle, Ellipse};
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Cone, Sphere};

/// The point of a spline at a parameter, by de Boor's algorithm on the whole knot vector.
fn point<const D: usize>(spline: &Spline<D>, s: f64) -> [f64; D] {
    let counted = spline.knots.iter().zip(spline.multiplicities());
    let knots: Vec<f64> = counted
        .flat_map(|(k, n)| std::iter::repeat_n(*k, n))
        .collect();
    assert_eq!(knots.len(), spline.points.len() + DEGREE + 1);
    let last = spline.points.len() - 1;
    let span = (DEGREE..=last).rfind(|&k| knots[k] <= s).unwrap();
    let mut d: Vec<[f64; D]> = (0..=DEGREE)
        .map(|j| spline.points[j + span - DEGREE])
        .collect();
    for r in 1..=DEGREE {
        for j in (r..=DEGREE).rev() {
            let (a, b) = (knots[j + span - DEGREE], knots[j + 1 + span - r]);
            let part = (s - a) / (b - a);
            d[j] = std::array::from_fn(|i| (1.0 - part) * d[j - 1][i] + part * d[j][i]);
        }
    }
    d[DEGREE]
}

fn window(surface: Surface) -> ParameterWindow {
    ParameterWindow {
        surface,
        starts: [0.0; 2],
        reach: 10.0,
    }
}

/// Asserts that both splines are within the accuracy of the surfaces, and of each other; and of the
/// curve at the same parameter, if it is written exactly.
fn holds(curve: &Curve, range: [f64; 2], surfaces: &[Surface], pace: Pace, accuracy: f64) -> usize {
    let windows: Vec<ParameterWindow> = surfaces.iter().map(|s| window(*s)).collect();
    let follow = Follow {
        pace,
        curve,
        range,
        windows: &windows,
        accuracy,
    };
    let BezierSegments { space, on } = follow.course().unwrap();
    let (first, last) = (space.knots[0], space.knots[space.knots.len() - 1]);
    for k in 0..=1000 {
        let s = first + (last - first) * f64::from(k) / 1000.0;
        let p = Point3::from(point(&space, s));
        for (window, on) in windows.iter().zip(&on) {
            assert!(window.surface.distance(&p).abs() <= accuracy, "{s}");
            let off = (window.point(point(on, s)) - p).norm();
            assert!(off <= accuracy, "{off:e} at {s}");
        }
        if pace == Pace::Parameter {
            assert!((curve.point(s) - p).norm() <= accuracy, "{s}");
        }
    }
    space.knots.len()
}

#[test]
fn a_tilted_circle_is_followed_on_its_sphere() {
    let sphere = Sphere {
        frame: Frame::world(),
        radius: 10.0,
    };
    let z = Vector3::new(0.3, 0.9, 0.2).normalize();
    let frame = Frame::about(Point3::from(z * 6.0), z);
    let circle = Curve::Circle(Circle { frame, radius: 8.0 });
    for pace in [Pace::Length, Pace::Parameter] {
        let surfaces = [Surface::Sphere(sphere)];
        let pieces = holds(&circle, [1.0, 7.0], &surfaces, pace, 1e-7);
        assert!(pieces < 100, "{pieces}");
    }
}

fn evaluated(text: &str) -> Brep {
    let options = ReadOptions::default();
    let part = read("part", text.as_bytes(), Format::Padl, &options).unwrap();
    let known = evaluate(&part.tree, &EvaluationOptions::default());
    known.unwrap().brep
}

fn surfaces_of(brep: &Brep, edge: EdgeId) -> Vec<Surface> {
    let faces = brep.topology.faces_of(edge);
    faces.map(|face| *brep.surface(face)).collect()
}

/// An ellipse 1e-5 wide along a ruling of a cone, from its apex: it is within 1e-9 of the cone. A spline
/// in space that is off along the ellipse is not off the ellipse.
#[test]
fn a_thin_ellipse_is_followed_on_its_cone() {
    let (sin, cos) = (0.8f64.sqrt(), 0.2f64.sqrt());
    let cone = Cone {
        frame: Frame::world(),
        sin,
        cos,
    };
    let ruling = Vector3::new(sin, 0.0, cos);
    let frame = Frame {
        origin: Point3::from(0.56 * ruling),
        x: ruling,
        y: Vector3::y(),
        z: ruling.cross(&Vector3::y()),
    };
    let (a, b) = (0.56, 1e-5);
    let ellipse = Curve::Ellipse(Ellipse { frame, a, b });
    let surfaces = [Surface::Cone(cone)];
    holds(&ellipse, [1.63, 4.66], &surfaces, Pace::Parameter, 1e-6);
}

/// Edges of parts that are not conics.
#[test]
fn edges_are_followed_on_the_faces_beside_them() {
    let parts = [
        "A = CYL(R=1, H=4) UN CYL(R=0.6, H=4) AT (MOVZ=-2, ROTX=80, MOVX=0.1, MOVZ=2)",
        "A = TOR(RMAJ=3, RMIN=1) DIF CYL(R=0.7, H=9) AT (MOVX=2.5, MOVZ=-4, ROTY=20)",
        "A = CON(R=2, H=3) INT SPH(R=1.5) AT (MOVX=0.6, MOVZ=1)",
        "A = TOR(RMAJ=3, RMIN=1) UN TOR(RMAJ=3, RMIN=0.8) AT (ROTX=70, MOVX=1)",
    ];
    for text in parts {
        let brep = evaluated(text);
        for edge in brep.topology.edge_ids() {
            let surfaces = surfaces_of(&brep, edge);
            let mut pieces = Vec::new();
            for accuracy in [1e-3, 1e-6, 1e-9] {
                let (curve, range) = (brep.curve(edge), brep.range(edge));
                if matches!(curve, Curve::Quartic(_) | Curve::Toric(_)) {
                    pieces.push(holds(curve, range, &surfaces, Pace::Length, accuracy));
                }
            }
            // A thousandth of the accuracy takes about four times as many pieces, for a method of
            // sixth order.
            assert!(pieces.windows(2).all(|p| p[1] < 8 * p[0]), "{pieces:?}");
        }
    }
}
