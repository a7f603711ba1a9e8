//! Views of parts built by hand.

#![allow(clippy::unwrap_used, reason = "tests")]

mod parts;

use nalgebra::{Point3, Vector3};
use parts::{BAND, Builder, block, tilted};
use premio_kernel::brep::Brep;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Surface, Torus};
use premio_visibility::camera::projection::Projection;
use premio_visibility::contours::{ContourKind, Contours, JunctionKind};
use premio_visibility::contours::{ViewError, contours, contours_with};
use premio_visibility::invisibility::Method;
use premio_visibility::ray_casting::OriginIncidence;
use premio_visibility::scene::Scene;
use premio_visibility::{ViewCamera, camera::CameraError};
use proptest::prelude::*;

fn eye(e: [f64; 3], t: [f64; 3]) -> ViewCamera {
    ViewCamera::perspective(e.into(), t.into(), Vector3::z(), 1.0).unwrap()
}

fn ortho(e: [f64; 3], t: [f64; 3]) -> ViewCamera {
    ViewCamera::orthographic(e.into(), t.into(), Vector3::z()).unwrap()
}

fn see(brep: &Brep, camera: &ViewCamera) -> Contours {
    contours(brep, camera, BAND).unwrap()
}

fn wholly_visible(c: &Contours) -> usize {
    let whole = |c: &&premio_visibility::contours::Contour| {
        !c.pieces.is_empty() && c.pieces.iter().all(|p| p.visible)
    };
    c.contours.iter().filter(whole).count()
}

#[test]
fn a_block_shows_nine_of_its_twelve_edges() {
    let part = block([3.0, 2.0, 1.0]);
    for camera in [
        eye([9.0, 7.0, 5.0], [1.5, 1.0, 0.5]),
        ortho([9.0, 7.0, 5.0], [1.5, 1.0, 0.5]),
        eye([-9.0, 7.0, -5.0], [1.5, 1.0, 0.5]),
    ] {
        let c = see(&part, &camera);
        assert_eq!(c.contours.len(), 12);
        assert_eq!(wholly_visible(&c), 9);
        let hidden: Vec<_> = c
            .contours
            .iter()
            .filter(|c| c.pieces.iter().all(|p| !p.visible))
            .flat_map(|c| &c.pieces)
            .collect();
        assert!(hidden.len() >= 3);
        assert!(
            hidden
                .iter()
                .all(|p| p.quantitative_invisibility == 1 && p.occluder.is_some())
        );
    }
}

#[test]
fn a_block_seen_along_an_axis_shows_its_front_face() {
    let part = block([3.0, 2.0, 1.0]);
    let c = see(&part, &ortho([10.0, 1.0, 0.5], [0.0, 1.0, 0.5]));
    assert_eq!(wholly_visible(&c), 4);
    for contour in &c.contours {
        let x = contour.space_curve.point(0.3).x;
        for piece in &contour.pieces {
            assert_eq!(piece.visible, (x - 3.0).abs() < 1e-9, "{contour:?}");
        }
    }
}

#[test]
fn a_sphere_has_one_visible_limb() {
    let mut b = Builder::default();
    b.sphere(&tilted(), 2.0);
    for camera in [
        eye([9.0, 7.0, 5.0], [1.0, -2.0, 0.5]),
        ortho([9.0, 7.0, 5.0], [0.0; 3]),
    ] {
        let c = see(&b.brep, &camera);
        assert_eq!(c.contours.len(), 1);
        assert_eq!(c.contours[0].kind, ContourKind::Limb);
        assert_eq!(c.contours[0].pieces.len(), 1);
        assert!(c.contours[0].pieces[0].visible);
    }
    let inside = contours(&b.brep, &eye([1.1, -2.0, 0.5], [9.0, 9.0, 9.0]), BAND);
    assert!(matches!(inside, Err(ViewError::EyeInside(_))));
}

#[test]
fn of_two_spheres_in_line_the_farther_limb_is_hidden() {
    let mut b = Builder::default();
    b.sphere(&Frame::world(), 1.0);
    b.sphere(&Frame::world().at(Point3::new(5.0, 0.0, 0.0)), 1.0);
    let c = see(&b.brep, &ortho([10.0, 0.0, 0.0], [0.0; 3]));
    let visible: Vec<bool> = c
        .contours
        .iter()
        .map(|c| c.pieces.iter().all(|p| p.visible))
        .collect();
    assert_eq!(visible, [false, true]);
}

#[test]
fn a_cylinder_in_general_and_along_and_across_its_axis() {
    let mut b = Builder::default();
    b.cylinder(&Frame::world(), 1.0, 2.0);
    let c = see(&b.brep, &eye([9.0, 7.0, 5.0], [0.0, 0.0, 1.0]));
    assert_eq!(c.contours.len(), 4);
    let visible = |c: &Contours, i: usize| {
        c.contours[i]
            .pieces
            .iter()
            .map(|p| p.visible)
            .collect::<Vec<_>>()
    };
    let mut low = visible(&c, 0);
    low.sort_unstable();
    assert_eq!(low, [false, true]);
    assert!(visible(&c, 1).iter().all(|v| *v));
    assert_eq!(visible(&c, 2), [true]);
    assert_eq!(visible(&c, 3), [true]);
    // Along the axis: two circles, one hidden.
    let c = see(&b.brep, &ortho([0.0, 0.0, 9.0], [0.0; 3]));
    assert_eq!(c.contours.len(), 2);
    assert_eq!(visible(&c, 0), [false]);
    assert_eq!(visible(&c, 1), [true]);
    // From the side: the circles are lines, their far halves hidden.
    let c = see(&b.brep, &ortho([9.0, 0.0, 1.0], [0.0, 0.0, 1.0]));
    assert_eq!(c.contours.len(), 4);
    for i in 0..2 {
        for p in &c.contours[i].pieces {
            let x = c.contours[i]
                .space_curve
                .point(0.5 * (p.range[0] + p.range[1]))
                .x;
            assert_eq!(p.visible, x > 0.0, "{p:?}");
        }
    }
    assert_eq!(visible(&c, 2), [true]);
    assert_eq!(visible(&c, 3), [true]);
}

/// How often a line of sight from the limb at `p` towards `v` enters a torus before the eye, which
/// lies at `length`, or none where that is too close to call.
///
/// Along it the quartic of the torus is s²(s² + bs + c), as it touches at s = 0. It enters where a
/// root lies before the eye: none or two do, one where it goes into the torus at `p` itself.
fn torus_oracle(torus: &Torus, p: Point3<f64>, v: Vector3<f64>, length: f64) -> Option<u32> {
    let (p, v) = (
        torus.frame.coordinates(&p),
        torus.frame.components(&v).normalize(),
    );
    let across = torus.major * torus.major;
    let level = p.norm_squared() + across - torus.minor * torus.minor;
    let along = p.dot(&v);
    let b = 4.0 * along;
    let c = 4.0 * along * along + 2.0 * level - 4.0 * across * (v.x * v.x + v.y * v.y);
    let discriminant = b * b - 4.0 * c;
    // At a cusp c is zero; where another part of the torus is grazed, the discriminant.
    if c.abs() < 1e-6 * across || discriminant.abs() < 1e-6 * across {
        return None;
    }
    if discriminant < 0.0 {
        return Some(0);
    }
    let roots = [-1.0, 1.0].map(|sign| 0.5 * (-b + sign * discriminant.sqrt()));
    Some(u32::from(roots.iter().any(|s| (0.0..length).contains(s))))
}

fn check_torus(
    f: Frame,
    major: f64,
    minor: f64,
    camera: &ViewCamera,
    at: Result<Point3<f64>, Vector3<f64>>,
) -> (usize, usize) {
    let mut b = Builder::default();
    b.torus(&f, major, minor);
    let torus = Torus {
        frame: f,
        major,
        minor,
    };
    let c = contours(&b.brep, camera, BAND).unwrap();
    let cusps = c
        .junctions
        .iter()
        .filter(|j| j.kind == JunctionKind::Cusp)
        .count();
    let (mut evaluated, mut decided) = (0, 0);
    for contour in &c.contours {
        for piece in &contour.pieces {
            for part in [0.15, 0.5, 0.83] {
                let t = piece.range[0] + (piece.range[1] - piece.range[0]) * part;
                let p = contour.space_curve.point(t);
                let (v, length) = match at {
                    Ok(e) => ((e - p).normalize(), (e - p).norm()),
                    Err(d) => (-d, 20.0),
                };
                evaluated += 1;
                if let Some(truth) = torus_oracle(&torus, p, v, length) {
                    decided += 1;
                    assert_eq!(
                        piece.quantitative_invisibility, truth,
                        "{camera:?} {part} {piece:?}"
                    );
                }
            }
        }
    }
    assert!(decided * 3 > evaluated * 2, "{decided} of {evaluated}");
    (cusps, c.contours.len())
}

#[test]
fn an_oblique_torus_has_four_cusps() {
    let d = Vector3::new(1.0, 0.0, -0.35).normalize();
    let camera = ortho([-8.0, 0.0, 2.8], [0.0; 3]);
    let (cusps, limbs) = check_torus(Frame::world(), 2.0, 0.6, &camera, Err(d));
    assert_eq!((cusps, limbs), (4, 2));
    // Seen from high above, the inner limb is whole.
    let camera = ortho([1.0, 0.0, 8.0], [0.0; 3]);
    let d = Vector3::new(-1.0, 0.0, -8.0).normalize();
    let (cusps, limbs) = check_torus(Frame::world(), 2.0, 0.6, &camera, Err(d));
    assert_eq!((cusps, limbs), (0, 2));
}

#[test]
fn a_torus_along_its_axis_and_across() {
    let d = Vector3::new(0.0, 0.0, -1.0);
    check_torus(
        Frame::world(),
        2.0,
        0.6,
        &ortho([0.0, 0.0, 8.0], [0.0; 3]),
        Err(d),
    );
    let e = Point3::new(0.0, 0.0, 8.0);
    check_torus(
        Frame::world(),
        2.0,
        0.6,
        &eye([0.0, 0.0, 8.0], [0.0; 3]),
        Ok(e),
    );
    let c = {
        let mut b = Builder::default();
        b.torus(&Frame::world(), 2.0, 0.6);
        see(&b.brep, &ortho([8.0, 0.0, 0.0], [0.0; 3]))
    };
    assert!(!c.contours.is_empty());
}

fn direction() -> impl Strategy<Value = Vector3<f64>> {
    [-1.0..1.0f64, -1.0..1.0, -1.0..1.0]
        .prop_map(Vector3::from)
        .prop_filter("not short", |v| v.norm() > 0.1)
        .prop_map(|v| v.normalize())
}

/// The quantitative invisibility is one along each piece: no junction was missed.
fn constant(brep: &Brep, camera: &ViewCamera, c: &Contours) {
    let projection = Projection::new(camera, 10.0);
    let scene = Scene::new(brep, &projection, BAND);
    for contour in &c.contours {
        for piece in &contour.pieces {
            let [lo, hi] = piece.range;
            for part in [0.04, 0.27, 0.5, 0.71, 0.96] {
                let p = contour.space_curve.point(lo + (hi - lo) * part);
                let own = |f| match contour.faces.contains(&f) {
                    false => OriginIncidence::No,
                    true if contour.kind == ContourKind::Limb => OriginIncidence::Tangent,
                    true => OriginIncidence::Through,
                };
                let along = contour.space_curve.tangent(lo + (hi - lo) * part);
                let count = scene.count(&p, &along, &own);
                if count.unambiguous {
                    assert_eq!(
                        count.quantitative_invisibility, piece.quantitative_invisibility,
                        "{camera:?} contour {} {piece:?} at {part}",
                        contour.id
                    );
                }
            }
        }
    }
}

fn mark_ambiguous() -> Brep {
    let mut b = Builder::default();
    let world = |x, y, z| Frame::world().at(Point3::new(x, y, z));
    b.block(
        &Frame::world(),
        [4.0, 4.0, 1.5],
        &[(1.0, 1.0, 0.5), (2.6, 1.4, 0.8), (1.2, 2.8, 0.6)],
    );
    b.cylinder(&world(6.0, 1.0, -1.0), 0.7, 3.0);
    b.cylinder(&tilted().at(Point3::new(-2.0, 3.0, -1.0)), 0.5, 4.0);
    b.cone(&world(-3.0, -2.0, 0.0), 0.4, 2.5);
    b.cone(&tilted().at(Point3::new(6.0, 5.0, 0.0)), 0.6, 2.0);
    b.sphere(&world(2.0, 6.5, 1.0), 1.2);
    b.torus(&tilted().at(Point3::new(2.0, 2.0, 5.0)), 1.5, 0.4);
    b.torus(&world(2.0, 2.0, -3.0), 1.5, 0.6);
    b.brep
}

fn compare(brep: &Brep, camera: &ViewCamera) {
    let carried = contours_with(brep, camera, BAND, Method::Propagated).unwrap();
    let counted = contours_with(brep, camera, BAND, Method::Recounted).unwrap();
    for (a, b) in carried.contours.iter().zip(&counted.contours) {
        assert_eq!(a.pieces.len(), b.pieces.len());
        for (p, q) in a.pieces.iter().zip(&b.pieces) {
            assert_eq!(
                (p.quantitative_invisibility, p.visible, p.occluder),
                (q.quantitative_invisibility, q.visible, q.occluder),
                "{camera:?} contour {} {p:?} {q:?} {:?}",
                a.id,
                p.start.map(|j| &carried.junctions[j as usize])
            );
        }
    }
    constant(brep, camera, &carried);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn torus_counts_agree_with_rays(d in direction(), minor in 0.2..1.2f64, away in 3.0..9.0f64) {
        let f = tilted();
        let e = f.origin + d * away;
        prop_assume!(f.coordinates(&e).z.abs() > 0.05);
        prop_assume!(Surface::Torus(Torus { frame: f, major: 2.0, minor }).distance(&e) > 0.2);
        let up = Vector3::z();
        let camera = ViewCamera::perspective(e, f.origin, up, 1.0).unwrap();
        // From between the walls everything is near: only what lies in front of the eye is listed.
        prop_assume!(away > 2.5 + minor);
        check_torus(f, 2.0, minor, &camera, Ok(e));
        let camera = ViewCamera::orthographic(e, f.origin, up).unwrap();
        prop_assume!(d.cross(&f.z).norm() > 0.1 && d.dot(&f.z).abs() > 0.02);
        check_torus(f, 2.0, minor, &camera, Err(-d));
    }

    #[test]
    fn counts_carried_along_are_those_counted(d in direction(), away in 6.0..20.0f64) {
        let part = mark_ambiguous();
        let centre = Point3::new(2.0, 2.0, 1.0);
        let camera = ViewCamera::perspective(centre + d * away, centre, Vector3::z(), 1.0).unwrap();
        if contours(&part, &camera, BAND).is_ok() {
            compare(&part, &camera);
        }
        let camera = ViewCamera::orthographic(centre + d * away, centre, Vector3::z()).unwrap();
        compare(&part, &camera);
    }
}

/// A limb ends 7e-5 after it passes below a rim. At one position the piece is next to another
/// contour, and at another position it is not.
#[test]
fn a_short_piece_is_counted_where_it_is_unambiguous() {
    let d = Vector3::new(
        0.237_761_058_377_204_07,
        -0.932_521_277_749_971_8,
        0.271_797_251_021_624,
    );
    let centre = Point3::new(2.0, 2.0, 1.0);
    let camera = ViewCamera::orthographic(centre + d * 6.0, centre, Vector3::z()).unwrap();
    compare(&mark_ambiguous(), &camera);
}

#[test]
fn axis_views_of_a_plate_agree_by_both_methods() {
    let part = parts::plate(3, 0.7);
    for e in [
        [1.5, 1.5, 9.0],
        [9.0, 1.5, 0.35],
        [1.5, -9.0, 0.35],
        [9.0, 1.5, 9.0],
    ] {
        compare(&part, &ortho(e, [1.5, 1.5, 0.35]));
        compare(&part, &eye(e, [1.5, 1.5, 0.35]));
    }
}

#[test]
fn up_along_the_line_of_sight_is_replaced() {
    let camera = eye([0.0, 0.0, 9.0], [0.0; 3]);
    let c = see(&block([1.0; 3]), &camera);
    assert!(
        c.junctions
            .iter()
            .all(|j| j.image_point.iter().all(|x| x.is_finite()))
    );
    let bad = ViewCamera::perspective(Point3::origin(), Point3::origin(), Vector3::z(), 1.0);
    assert_eq!(bad, Err(CameraError::Value("target", "is the eye")));
}

#[test]
fn what_lies_behind_the_eye_is_cut_at_the_near_plane() {
    // Next to a long block, inside the box of it and another.
    let mut b = Builder::default();
    b.block(&Frame::world(), [20.0, 1.0, 1.0], &[]);
    b.cylinder(&Frame::world().at(Point3::new(10.0, 6.0, 0.0)), 1.0, 2.0);
    let c = see(&b.brep, &eye([10.0, 3.0, 0.5], [20.0, 2.0, 0.5]));
    let cuts = c
        .junctions
        .iter()
        .filter(|j| j.kind == JunctionKind::NearPlane)
        .count();
    assert!(cuts >= 4);
    for contour in &c.contours {
        for p in &contour.pieces {
            let m = contour.space_curve.point(0.5 * (p.range[0] + p.range[1]));
            assert!((m - Point3::new(10.0, 3.0, 0.5)).dot(&Vector3::new(10.0, -1.0, 0.0)) > 0.0);
        }
    }
}

#[test]
fn a_crowd_along_the_axes() {
    let part = mark_ambiguous();
    for e in [
        [2.0, 2.0, 30.0],
        [2.0, 2.0, -30.0],
        [30.0, 2.0, 1.0],
        [2.0, -30.0, 1.0],
        [30.0, 30.0, 30.0],
    ] {
        compare(&part, &ortho(e, [2.0, 2.0, 1.0]));
        compare(&part, &eye(e, [2.0, 2.0, 1.0]));
    }
}
