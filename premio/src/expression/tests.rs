use super::*;

#[test]
fn deep_expressions_need_no_stack() {
    let mut part = block(1, 1, 1);
    for k in 0..100_000 {
        part = match k % 2 {
            0 => part + block(1, 1, 1),
            _ => (part & block(9, 9, 9)).translate([1, 0, 0]),
        };
    }
    assert_eq!(part.tree().unwrap().leaves().count(), 100_001);
    assert!(format!("{part:?}").contains("100001"));
}

#[test]
fn shared_nodes_are_built_once() {
    let mut part = block(1, 1, 1);
    for _ in 0..200 {
        part = part.clone() + part;
    }
    assert!(matches!(part.tree(), Err(Error::Tree(_))));
}

#[test]
fn the_first_error_of_an_expression_is_kept() {
    let wrong = block(1, 1, 1) - sphere("x") + cylinder(-1, 1);
    let error = wrong.evaluate().unwrap_err();
    let number = ExpressionError::Number(NumberError::Decimal(
        premio_kernel::number::rational::DecimalError::Malformed,
    ));
    assert!(matches!(error, Error::Expression(found) if found == number));
    for wrong in [
        block(1, 1, 1).scale(0),
        block(1, 1, 1).translate([f64::NAN; 3]),
    ] {
        assert!(matches!(wrong.tree(), Err(Error::Expression(_))));
    }
}
