//! Drawings of parts built by hand.
#![allow(clippy::unwrap_used, reason = "tests")]

#[path = "../../visibility/tests/parts/mod.rs"]
mod parts;

use nalgebra::{Point2, Point3, Vector2, Vector3};
use parts::{BAND, Builder, tilted};
use premio_drawing::{Drawing, DrawingOptions, StrokeShape, dxf, svg};
use premio_kernel::geometry::frame::Frame;
use premio_visibility::camera::projection::Projection;
use premio_visibility::contours::Contours;
use premio_visibility::{ViewCamera, contours};

fn seen() -> Contours {
    let mut b = Builder::default();
    b.block(
        &Frame::world(),
        [4.0, 4.0, 1.5],
        &[(1.0, 1.0, 0.5), (2.6, 1.4, 0.8)],
    );
    b.cylinder(&tilted().at(Point3::new(-2.0, 3.0, -1.0)), 0.5, 4.0);
    b.torus(&tilted().at(Point3::new(2.0, 2.0, 5.0)), 1.5, 0.4);
    let e = Point3::new(12.0, 9.0, 8.0);
    let camera = ViewCamera::perspective(e, Point3::new(1.0, 2.0, 1.0), Vector3::z(), 1.0).unwrap();
    contours(&b.brep, &camera, BAND).unwrap()
}

/// The distance of a point to the nearest stroke.
fn away(p: &Point2<f64>, drawing: &Drawing) -> f64 {
    let segment = |a: &Point2<f64>, b: &Point2<f64>| {
        let d = b - a;
        let s = ((p - a).dot(&d) / d.norm_squared()).clamp(0.0, 1.0);
        (a + d * s - p).norm()
    };
    let stroke = |shape: &StrokeShape| match shape {
        StrokeShape::Line([a, b]) => segment(a, b),
        StrokeShape::Path(points) => points
            .windows(2)
            .map(|w| segment(&w[0], &w[1]))
            .fold(f64::INFINITY, f64::min),
        StrokeShape::Ellipse {
            centre,
            major,
            ratio,
            from,
            sweep,
        } => {
            let minor = Vector2::new(-major.y, major.x) * *ratio;
            let d = p - centre;
            let s =
                (d.dot(&minor) / minor.norm_squared()).atan2(d.dot(major) / major.norm_squared());
            let s = from + (s - from).rem_euclid(std::f64::consts::TAU);
            if s > from + sweep + 1e-9 && s < from + std::f64::consts::TAU - 1e-9 {
                return f64::INFINITY;
            }
            (centre + major * s.cos() + minor * s.sin() - p).norm()
        }
    };
    drawing
        .strokes
        .iter()
        .map(|s| stroke(&s.shape))
        .fold(f64::INFINITY, f64::min)
}

#[test]
fn strokes_follow_the_contours_within_the_distance() {
    let c = seen();
    let projection = Projection::new(&c.camera, 1.0);
    let drawing = Drawing::new(&c, &DrawingOptions::default());
    for contour in &c.contours {
        for piece in &contour.pieces {
            for k in 0..=10 {
                let t = piece.range[0] + (piece.range[1] - piece.range[0]) * f64::from(k) / 10.0;
                let p = projection.project(&contour.space_curve.point(t));
                assert!(away(&p, &drawing) <= drawing.distance, "{contour:?} {t}");
            }
        }
    }
    let ellipses = drawing
        .strokes
        .iter()
        .filter(|s| matches!(s.shape, StrokeShape::Ellipse { .. }));
    assert!(ellipses.count() >= 6);
}

#[test]
fn documents_are_well_formed() {
    let c = seen();
    let drawing = Drawing::new(&c, &DrawingOptions::default());
    let text = svg::write(&drawing);
    assert!(text.contains("class=\"boundary hidden\"") && text.contains("class=\"limb visible\""));
    assert!(!text.contains("NaN") && !text.contains("inf"));
    assert_eq!(text.matches("<g ").count(), text.matches("</g>").count());
    let bare = Drawing::new(
        &c,
        &DrawingOptions {
            hidden: false,
            ..DrawingOptions::default()
        },
    );
    assert!(!svg::write(&bare).contains("hidden\" d"));
    let text = dxf::write(&drawing);
    assert!(!text.contains("NaN") && !text.contains("inf"));
    for word in [
        "AC1015",
        "ELLIPSE",
        "LWPOLYLINE",
        "BOUNDARY_HIDDEN",
        "DASHED",
    ] {
        assert!(text.contains(word), "{word}");
    }
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len() % 2, 0);
    assert!(lines.chunks(2).all(|g| g[0].trim().parse::<u32>().is_ok()));
    assert_eq!(&lines[lines.len() - 2..], ["  0", "EOF"]);
}

#[test]
fn circles_stay_circles_along_an_axis() {
    let mut b = Builder::default();
    b.cylinder(&Frame::world(), 1.0, 2.0);
    let up = Vector3::y();
    let camera =
        ViewCamera::orthographic(Point3::new(0.0, 0.0, 9.0), Point3::origin(), up).unwrap();
    let c = contours(&b.brep, &camera, BAND).unwrap();
    let text = dxf::write(&Drawing::new(
        &c,
        &DrawingOptions {
            hidden: false,
            ..DrawingOptions::default()
        },
    ));
    assert_eq!(text.matches("\nCIRCLE\n").count(), 1);
    assert_eq!(text.matches("\nELLIPSE\n").count(), 0);
}

#[test]
fn contours_serialise_by_the_interface() {
    let mut c = seen();
    c.sample(3);
    let v = serde_json::to_value(&c).unwrap();
    assert_eq!(v["schema"], "premio.contours/1");
    assert_eq!(v["contours"][0]["kind"], "boundary");
    assert_eq!(
        v["contours"][0]["pieces"][0]["samples"]
            .as_array()
            .unwrap()
            .len(),
        3
    );
    assert_eq!(v["camera"]["projection"], "perspective");
    let kinds: Vec<&str> = v["contours"]
        .as_array()
        .unwrap()
        .iter()
        .map(|c| c["curve3"]["type"].as_str().unwrap())
        .collect();
    for kind in ["line", "circle", "toric"] {
        assert!(kinds.contains(&kind));
    }
}
