//! The checker of boundaries finds integrals that are not those of the boundary.

use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_kernel::brep::check::{Violation, check_integrals};
use premio_kernel::brep::face_integrals::FaceIntegrals;

/// A plate with a hole.
fn plate(radius: f64) -> Evaluation {
    let text = format!(
        "PLATE = BLO(X=40, Y=30, Z=5) DIF CYL(R={radius}, H=9) AT (MOVX=20, MOVY=15, MOVZ=-2)"
    );
    let options = ReadOptions::default();
    let part = read("plate", text.as_bytes(), Format::Padl, &options).unwrap();
    evaluate(&part.tree, &EvaluationOptions::default()).unwrap()
}

#[test]
fn integrals_of_another_boundary_are_found() {
    let (ours, other) = (plate(4.0), plate(4.00001));
    let violations = |integrals: &FaceIntegrals| check_integrals(&ours.brep, integrals);
    assert_eq!(violations(&FaceIntegrals::new(&ours.brep)), []);
    let found = violations(&FaceIntegrals::new(&other.brep));
    // Top, bottom and the wall of the hole.
    assert_eq!(found.len(), 3, "{found:?}");
    let is_integral = |violation: &Violation| matches!(violation, Violation::Integral { .. });
    assert!(found.iter().all(is_integral), "{found:?}");
}
