use super::*;
use crate::geometry::curve::{Circle, Curve, Line};
use crate::geometry::frame::Frame;
use crate::geometry::surface::{Cone, Cylinder, Plane, Sphere, Torus};
use nalgebra::Vector3;
use proptest::prelude::*;
use std::f64::consts::TAU;

const BAND: f64 = 1e-10;

fn tilted() -> Frame {
    let z = Vector3::new(0.3, -0.4, 0.7).normalize();
    Frame::toward(Point3::new(1.0, -2.0, 0.5), z, Vector3::new(1.0, 0.2, 0.0))
}

fn circle_at(f: &Frame, z: f64, radius: f64) -> Curve {
    let frame = f.at(f.point(0.0, 0.0, z));
    Curve::Circle(Circle { frame, radius })
}

/// The circle about the tube of a torus at the angle theta, parameterised by the tube's angle.
fn tube(s: &Torus, theta: f64) -> Curve {
    let radial = s.frame.x * theta.cos() + s.frame.y * theta.sin();
    let frame = Frame {
        origin: s.frame.origin + radial * s.major,
        x: radial,
        y: s.frame.z,
        z: radial.cross(&s.frame.z),
    };
    Curve::Circle(Circle {
        frame,
        radius: s.minor,
    })
}

fn arc(curve: &Curve, range: [f64; 2], sense: Sense) -> DirectedArc<'_> {
    DirectedArc {
        curve,
        range,
        sense,
    }
}

fn expect(inside: bool) -> PointLocation {
    if inside {
        PointLocation::Inside
    } else {
        PointLocation::Outside
    }
}

proptest! {
    #[test]
    fn plane_with_holes(x in -6.0..6.0, y in -6.0..6.0) {
        let f = tilted();
        let surface = Surface::Plane(Plane { frame: f });
        let outer = circle_at(&f, 0.0, 5.0);
        let holes: Vec<Curve> = (0..16).map(|k| {
            let at = f.point(-3.0 + 2.0 * f64::from(k % 4), -3.0 + 2.0 * f64::from(k / 4), 0.0);
            Curve::Circle(Circle { frame: f.at(at), radius: 0.5 })
        }).collect();
        let mut arcs = vec![arc(&outer, [0.0, TAU], Sense::Along)];
        arcs.extend(holes.iter().map(|h| arc(h, [0.0, TAU], Sense::Against)));
        let locator = FaceLocator::new(&surface, Sense::Along, arcs, BAND);
        let in_hole = (0..16).any(|k| {
            let (a, b) = (-3.0 + 2.0 * f64::from(k % 4), -3.0 + 2.0 * f64::from(k / 4));
            f64::hypot(x - a, y - b) < 0.5
        });
        let truth = f64::hypot(x, y) < 5.0 && !in_hole;
        prop_assert_eq!(locator.place(&f.point(x, y, 0.0)), expect(truth));
    }

    #[test]
    fn cylinder_patch_and_band(u in 0.0..TAU, v in -1.0..3.0) {
        let f = tilted();
        let surface = Surface::Cylinder(Cylinder { frame: f, radius: 1.5 });
        let (low, high) = (circle_at(&f, 0.0, 1.5), circle_at(&f, 2.0, 1.5));
        let ruling = |u: f64| Curve::Line(Line {
            origin: f.point(1.5 * u.cos(), 1.5 * u.sin(), 0.0), direction: f.z });
        let whole = vec![
            arc(&low, [0.0, TAU], Sense::Along),
            arc(&high, [0.0, TAU], Sense::Against),
        ];
        let p = surface.point(u, v);
        let locator = FaceLocator::new(&surface, Sense::Along, whole.clone(), BAND);
        prop_assert_eq!(locator.place(&p), expect(v > 0.0 && v < 2.0));
        // The inside of a bore: the normal and all senses are reversed.
        let bore = whole.iter().map(|a| DirectedArc { sense: a.sense.reversed(), ..*a });
        let locator = FaceLocator::new(&surface, Sense::Against, bore.collect(), BAND);
        prop_assert_eq!(locator.place(&p), expect(v > 0.0 && v < 2.0));
        let (a, b) = (ruling(5.0), ruling(7.5));
        let patch = vec![
            arc(&low, [5.0, 7.5], Sense::Along),
            arc(&b, [0.0, 2.0], Sense::Along),
            arc(&high, [5.0, 7.5], Sense::Against),
            arc(&a, [0.0, 2.0], Sense::Against),
        ];
        let locator = FaceLocator::new(&surface, Sense::Along, patch, BAND);
        let within = !(7.5 - TAU..=5.0).contains(&u);
        prop_assert_eq!(locator.place(&p), expect(within && v > 0.0 && v < 2.0));
    }

    #[test]
    fn cone_with_apex(u in 0.0..TAU, v in 0.0..3.0) {
        let f = tilted();
        let surface = Surface::Cone(Cone { frame: f, sin: 0.6, cos: 0.8 });
        let base = circle_at(&f, 2.0, 1.5);
        let arcs = vec![arc(&base, [0.0, TAU], Sense::Against)];
        let locator = FaceLocator::new(&surface, Sense::Along, arcs, BAND);
        prop_assert_eq!(locator.place(&surface.point(u, v)), expect(v < 2.0));
        prop_assert_eq!(locator.place(&f.origin), PointLocation::Inside);
    }

    #[test]
    fn sphere_cap(u in 0.0..TAU, v in -1.5..1.5) {
        let f = tilted();
        let surface = Surface::Sphere(Sphere { frame: f, radius: 2.0 });
        let rim = circle_at(&f, 1.0, 3f64.sqrt());
        let arcs = vec![arc(&rim, [0.0, TAU], Sense::Along)];
        let locator = FaceLocator::new(&surface, Sense::Along, arcs, BAND);
        let p = surface.point(u, v);
        prop_assert_eq!(locator.place(&p), expect(2.0 * v.sin() > 1.0));
        let whole = FaceLocator::new(&surface, Sense::Along, vec![], BAND);
        prop_assert_eq!(whole.place(&p), PointLocation::Inside);
    }

    #[test]
    fn torus_patch_and_bands(u in 0.0..TAU, v in 0.0..TAU) {
        let f = tilted();
        let torus = Torus { frame: f, major: 2.0, minor: 0.75 };
        let surface = Surface::Torus(torus);
        let parallel = |phi: f64| {
            circle_at(&f, 0.75 * phi.sin(), 2.0 + 0.75 * phi.cos())
        };
        let p = surface.point(u, v);
        let (low, high) = (parallel(0.5), parallel(2.5));
        let (a, b) = (tube(&torus, 1.0), tube(&torus, 4.0));
        let resolution = vec![arc(&low, [0.0, TAU], Sense::Along), arc(&high, [0.0, TAU], Sense::Against)];
        let locator = FaceLocator::new(&surface, Sense::Along, resolution, BAND);
        prop_assert_eq!(locator.place(&p), expect(v > 0.5 && v < 2.5));
        // The tube's circle runs with phi; theta increases to its right.
        let bend = vec![arc(&a, [0.0, TAU], Sense::Against), arc(&b, [0.0, TAU], Sense::Along)];
        let locator = FaceLocator::new(&surface, Sense::Along, bend, BAND);
        prop_assert_eq!(locator.place(&p), expect(u > 1.0 && u < 4.0));
        let patch = vec![
            arc(&low, [1.0, 4.0], Sense::Along),
            arc(&b, [0.5, 2.5], Sense::Along),
            arc(&high, [1.0, 4.0], Sense::Against),
            arc(&a, [0.5, 2.5], Sense::Against),
        ];
        let locator = FaceLocator::new(&surface, Sense::Along, patch, BAND);
        prop_assert_eq!(locator.place(&p), expect(u > 1.0 && u < 4.0 && v > 0.5 && v < 2.5));
    }
}

#[test]
fn on_a_torus_no_order_of_the_arcs_hides_a_way() {
    // A piece between two equators and two circles of the tube, and a point of one equator close to
    // the piece: every path along the equator runs into an arc.
    let f = tilted();
    let torus = Torus {
        frame: f,
        major: 2.0,
        minor: 0.75,
    };
    let surface = Surface::Torus(torus);
    let (outer, inner) = (circle_at(&f, 0.0, 2.75), circle_at(&f, 0.0, 1.25));
    let (a, b) = (tube(&torus, 1.0), tube(&torus, 4.0));
    let half = 0.5 * TAU;
    let upper = [
        arc(&outer, [1.0, 4.0], Sense::Along),
        arc(&b, [0.0, half], Sense::Along),
        arc(&inner, [1.0, 4.0], Sense::Against),
        arc(&a, [0.0, half], Sense::Against),
    ];
    for turn in 0..4 {
        let arcs: Vec<_> = (0..4).map(|k| upper[(turn + k) % 4]).collect();
        let locator = FaceLocator::new(&surface, Sense::Along, arcs, BAND);
        let place = |u: f64, v: f64| locator.place(&surface.point(u, v));
        assert_eq!(place(5.0, half), PointLocation::Outside);
        assert_eq!(place(5.0, 0.0), PointLocation::Outside);
        assert_eq!(place(2.0, 1.0), PointLocation::Inside);
    }
}

#[test]
fn a_slit_along_the_top_of_a_torus_hides_nothing() {
    // At every point of the boundary a plane perpendicular to the axis is tangent to the torus.
    let f = tilted();
    let surface = Surface::Torus(Torus {
        frame: f,
        major: 2.0,
        minor: 0.75,
    });
    let top = circle_at(&f, 0.75, 2.0);
    let slit = [Sense::Along, Sense::Against].map(|sense| arc(&top, [1.0, 2.0], sense));
    let locator = FaceLocator::new(&surface, Sense::Along, slit.to_vec(), BAND);
    let quarter = 0.25 * TAU;
    for phi in [quarter, -quarter, 0.0, 2.0 * quarter, quarter + 1e-6, 1.0] {
        for theta in [0.0, 3.0, 5.0] {
            assert_eq!(
                locator.place(&surface.point(theta, phi)),
                PointLocation::Inside
            );
        }
    }
    for phi in [-quarter, 0.0, 1.0] {
        assert_eq!(
            locator.place(&surface.point(1.5, phi)),
            PointLocation::Inside
        );
    }
    assert_eq!(
        locator.place(&surface.point(1.5, quarter)),
        PointLocation::On
    );
}

/// A hemisphere, and points close to its rim: great circles to points of the rim run along it.
#[test]
fn next_to_a_great_circle_a_side_is_told() {
    let f = tilted();
    let surface = Surface::Sphere(Sphere {
        frame: f,
        radius: 2.0,
    });
    let rim = circle_at(&f, 0.0, 2.0);
    let upper = [arc(&rim, [0.0, TAU], Sense::Along)];
    let locator = FaceLocator::new(&surface, Sense::Along, upper.to_vec(), BAND);
    for k in 0..64 {
        let u = TAU * f64::from(k) / 64.0;
        for away in [8.0, 64.0, 4096.0, 1e6] {
            for side in [1.0, -1.0] {
                let p = surface.point(u, side * away * BAND);
                assert_eq!(locator.place(&p), expect(side > 0.0), "{u} {away} {side}");
            }
        }
    }
}

/// A ball that touches both walls of a groove has two slits on one great circle.
#[test]
fn slits_on_a_great_circle_hide_nothing() {
    let f = tilted();
    let surface = Surface::Sphere(Sphere {
        frame: f,
        radius: 2.0,
    });
    let circle = circle_at(&f, 0.0, 2.0);
    let [one, other] = [[0.0, 2.0], [3.0, 5.0]];
    let sides = [Sense::Along, Sense::Against];
    let arcs = [one, other].map(|range| sides.map(|sense| arc(&circle, range, sense)));
    let locator = FaceLocator::new(&surface, Sense::Along, arcs.concat(), BAND);
    for (u, place) in [
        (1.0, PointLocation::On),
        (2.5, PointLocation::Inside),
        (4.0, PointLocation::On),
        (5.5, PointLocation::Inside),
        (6.0, PointLocation::Inside),
    ] {
        assert_eq!(locator.place(&surface.point(u, 0.0)), place, "{u}");
        assert_eq!(
            locator.place(&surface.point(u, 0.5)),
            PointLocation::Inside,
            "{u}"
        );
    }
}

#[test]
fn points_on_the_boundary_are_on() {
    let f = tilted();
    let surface = Surface::Plane(Plane { frame: f });
    let outer = circle_at(&f, 0.0, 5.0);
    let arcs = vec![arc(&outer, [0.0, TAU], Sense::Along)];
    let locator = FaceLocator::new(&surface, Sense::Along, arcs, BAND);
    assert_eq!(locator.place(&f.point(3.0, 4.0, 0.0)), PointLocation::On);
    assert_eq!(
        locator.place(&f.point(3.0, 4.0 - 1e-8, 0.0)),
        PointLocation::Inside
    );
}
