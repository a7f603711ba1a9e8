use super::*;
use crate::checks::Checker;
use crate::checks::views::{CheckedView, around};
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_csg::tree::Tree;
use premio_visibility::contours;
use premio_visibility::contours::{Contour, ContourKind, ContourPiece};

/// Limbs in front and behind, creases, a smooth edge, a blind hole, a torus with cusps.
const PARTS: [&str; 4] = [
    "P = SPH(R=2) UN CYL(R=1, H=4) AT (MOVX=0.5)",
    "P = BLO(X=4, Y=3, Z=2) DIF CYL(R=1, H=2) AT (MOVX=1.5, MOVY=1.4, MOVZ=0.5) \
         UN CON(R=0.8, H=3) AT (MOVX=3.1, MOVY=1.7, MOVZ=1)",
    "P = TOR(RMAJ=3, RMIN=1) DIF BLO(X=3, Y=2, Z=4) AT (MOVX=1, MOVY=1, MOVZ=-2)",
    "P = (CYL(R=1, H=2) UN SPH(R=1) AT (MOVZ=2) UN WED(X=2, Y=3, Z=1)) AT (ROTX=17, ROTZ=30)",
];

struct Part {
    tree: Tree,
    evaluation: Evaluation,
}

impl Part {
    fn new(padl: &str) -> Self {
        let read = read(
            "test",
            padl.as_bytes(),
            Format::Padl,
            &ReadOptions::default(),
        )
        .unwrap();
        Self {
            evaluation: evaluate(&read.tree, &EvaluationOptions::default()).unwrap(),
            tree: read.tree,
        }
    }

    fn view(&self, name: &str) -> CheckedView {
        let all = around(&self.evaluation.bounds);
        all.into_iter().find(|v| v.name == name).unwrap()
    }

    fn contours(&self, view: &CheckedView) -> Contours {
        let Evaluation {
            brep, resolution, ..
        } = &self.evaluation;
        contours(brep, &view.camera, *resolution).unwrap()
    }

    fn outlines(&self, seen: &Contours) -> Outlines {
        let checker = Checker::new(&self.tree, &self.evaluation);
        Outlines::new(&checker.material, seen, &checker.clearance())
    }

    /// The length of a piece in the image, in radii of the window.
    fn length(&self, seen: &Contours, contour: &Contour, piece: &ContourPiece) -> f64 {
        let size = self.evaluation.bounds.diagonal();
        let projection = Projection::new(&seen.camera, size);
        let window = Window::around(&projection, &self.evaluation.bounds);
        let [lo, hi] = piece.range;
        let at = |k: i32| {
            let p = contour
                .space_curve
                .point(lo + (hi - lo) * f64::from(k) / 64.0);
            window.image(&p).at
        };
        let step = |k: i32| {
            let (p, q) = (at(k), at(k + 1));
            (p[0] - q[0]).hypot(p[1] - q[1])
        };
        (0..64).map(step).sum::<f64>() / window.radius
    }
}

/// A line across the window crosses a curve as long as its radius with probability one third.
const LONG: f64 = 0.6;

const VIEWS: [&str; 3] = ["perspective 2", "perspective 5", "orthographic 1"];

#[test]
fn every_change_has_its_contour() {
    for padl in PARTS {
        let part = Part::new(padl);
        for view in around(&part.evaluation.bounds) {
            let found = part.outlines(&part.contours(&view));
            assert!(found.missing.is_empty(), "{padl} {}: {found}", view.name);
            assert!(found.explained > 30, "{padl} {}: {found}", view.name);
            assert!(found.ambiguous * 5 < found.explained, "{padl}: {found}");
        }
    }
}

#[test]
fn a_wall_narrower_than_the_last_interval_has_its_contours() {
    // It leans by 2e-7, and the bodies behind it begin and end in its image.
    let part = Part::new(
        "A = CYL(R=1, H=3)\n\
         B = BLO(X=4, Y=4, Z=8) AT (MOVY=-2, MOVZ=-4, ROTY=0.00001, MOVX=0.3)\n\
         C = CYL(R=0.4, H=4) AT (ROTX=90, MOVY=2, MOVX=0.3, MOVZ=1.5)\n\
         P = A DIF B DIF C",
    );
    let found = part.outlines(&part.contours(&part.view("along z")));
    assert!(found.missing.is_empty(), "{found}");
    assert!(found.explained > 30, "{found}");
}

/// A line of 5e-3 of the image's size crosses the smooth edge of a wall and a rounded corner: its last
/// interval is 4e-9 wide, and up to 1e-7 from the edge rounding decides which of the two is hit.
#[test]
fn a_smooth_edge_on_a_short_line_has_its_contour() {
    let part = Part::new(
        "P = PRI(PGN((0.5, -0.5), (2.5, -0.5, 2.5, 1, 1.5), (4, 1), (4, 3.5, 2.5, 3.5, 1.5), \
             (2.5, 5), (0.5, 5, 0.5, 3.5, 1.5), (-1, 3.5), (-1, 1, 0.5, 1, 1.5)), H=3.5) \
             AT (MOVZ=0.5, ROTZ=90) \
         DIF SPH(R=0.5)",
    );
    let found = part.outlines(&part.contours(&part.view("along y")));
    assert!(found.missing.is_empty(), "{found}");
}

#[test]
fn a_missing_contour_is_missed() {
    let mut limbs = 0;
    for padl in PARTS {
        let part = Part::new(padl);
        for name in VIEWS {
            let seen = part.contours(&part.view(name));
            for (k, contour) in seen.contours.iter().enumerate() {
                let pieces = contour.pieces.iter();
                let length: f64 = pieces.map(|p| part.length(&seen, contour, p)).sum();
                if length < LONG {
                    continue;
                }
                let mut fewer = seen.clone();
                fewer.contours.remove(k);
                let found = part.outlines(&fewer);
                assert!(
                    found.missing.iter().any(|m| m.lack != Lack::Visible),
                    "{padl} {name}: without {:?} {k}, {length}: {found}",
                    contour.kind
                );
                limbs += usize::from(contour.kind == ContourKind::Limb);
            }
        }
    }
    assert!(limbs > 10, "{limbs}");
}

#[test]
fn a_visible_piece_that_is_said_to_be_hidden_is_missed() {
    let mut marked = 0;
    for padl in PARTS {
        let part = Part::new(padl);
        for name in VIEWS {
            let seen = part.contours(&part.view(name));
            for (k, contour) in seen.contours.iter().enumerate() {
                for (i, piece) in contour.pieces.iter().enumerate() {
                    if !piece.visible || part.length(&seen, contour, piece) < LONG {
                        continue;
                    }
                    let mut wrong = seen.clone();
                    let piece = &mut wrong.contours[k].pieces[i];
                    (piece.visible, piece.quantitative_invisibility) = (false, 1);
                    let found = part.outlines(&wrong);
                    let lacks = found.missing.iter().map(|m| m.lack);
                    assert!(
                        !found.missing.is_empty() && lacks.into_iter().all(|l| l == Lack::Visible),
                        "{padl} {name}: {k} {i} hidden: {found}"
                    );
                    marked += 1;
                }
            }
        }
    }
    assert!(marked > 20, "{marked}");
}

/// Two cones are tangent along a ruling in the plane of a third one's base. Which of them is hit
/// close to it is ambiguous.
#[test]
fn surfaces_that_touch_are_not_told_apart() {
    let part =
        Part::new("P = CON(R=2, H=2) UN CON(R=2, H=2) AT (ROTY=90) UN CON(R=2, H=2) AT (ROTX=90)");
    let found = part.outlines(&part.contours(&part.view("along z")));
    assert!(found.missing.is_empty(), "{found}");
    assert!(found.explained > 30, "{found}");
}

#[test]
fn contours_on_one_another_are_told_apart_by_depth() {
    let part = Part::new("P = CYL(R=1, H=2)");
    let mut seen = part.contours(&part.view("along z"));
    assert!(part.outlines(&seen).missing.is_empty());
    seen.contours.retain(|c| c.space_curve.point(0.0).z < 1.0);
    let missing = part.outlines(&seen).missing;
    assert!(!missing.is_empty() && missing.iter().all(|m| m.lack == Lack::Depth));
}

#[test]
fn a_camera_inside_a_hole_sees_contours_too() {
    let part = Part::new("P = BLO(X=4, Y=4, Z=4) DIF CYL(R=1, H=9) AT (MOVX=2, MOVY=2, MOVZ=-2)");
    let eye = nalgebra::Point3::new(2.1, 2.2, 1.7);
    let target = nalgebra::Point3::new(2.0, 1.9, 4.0);
    let up = nalgebra::Vector3::y();
    let camera = premio_visibility::ViewCamera::perspective(eye, target, up, 1.0).unwrap();
    let name = "inside".to_owned();
    let mut seen = part.contours(&CheckedView { name, camera });
    let found = part.outlines(&seen);
    assert!(found.missing.is_empty() && found.explained > 10, "{found}");
    seen.contours.clear();
    assert!(part.outlines(&seen).missing.len() >= found.explained);
}
