//! Tests of the lengths of primitives.

use super::*;

fn n(value: i32) -> Rational {
    Rational::from(value)
}

#[test]
fn sizes_must_be_positive() {
    let block = |x, y, z| Primitive::block([n(x), n(y), n(z)]);
    assert!(block(1, 2, 3).is_ok());
    assert_eq!(
        block(1, 0, 3),
        Err(PrimitiveError::NotPositive(Dimension::Y))
    );
    assert_eq!(
        Primitive::wedge([n(1), n(1), n(-1)]),
        Err(PrimitiveError::NotPositive(Dimension::Z))
    );
    assert_eq!(
        Primitive::cylinder(n(1), n(0)),
        Err(PrimitiveError::NotPositive(Dimension::Height))
    );
    assert_eq!(
        Primitive::sphere(n(-1)),
        Err(PrimitiveError::NotPositive(Dimension::Radius))
    );
    assert_eq!(
        Primitive::cone(n(0), n(1)),
        Err(PrimitiveError::NotPositive(Dimension::Base))
    );
}

#[test]
fn a_frustum_may_have_its_apex_at_either_end() {
    assert!(Primitive::frustum(n(0), n(2), n(1)).is_ok());
    assert!(Primitive::frustum(n(2), n(0), n(1)).is_ok());
    assert_eq!(
        Primitive::frustum(n(0), n(0), n(1)),
        Err(PrimitiveError::NoRadius)
    );
    assert_eq!(
        Primitive::frustum(n(1), n(-1), n(1)),
        Err(PrimitiveError::Negative(Dimension::Top))
    );
    assert_eq!(
        Primitive::frustum(n(2), n(2), n(1)),
        Primitive::cylinder(n(2), n(1))
    );
}

#[test]
fn a_torus_may_reach_its_axis() {
    for minor in [2, 3, 4] {
        assert!(Primitive::torus(n(3), n(minor)).is_ok());
    }
    assert_eq!(
        Primitive::torus(n(2), n(0)),
        Err(PrimitiveError::NotPositive(Dimension::Minor))
    );
    assert_eq!(
        Primitive::torus(n(0), n(2)),
        Err(PrimitiveError::NotPositive(Dimension::Major))
    );
}
