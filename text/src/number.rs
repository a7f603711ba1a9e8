//! Numbers for messages.

/// A number for a message, with an exponent where it is very large or very small.
pub fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").unwrap_or(&text).to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_short() {
        for (value, text) in [
            (16.0, "16"),
            (0.25, "0.25"),
            (-1e300, "-1e300"),
            (1e-320, "1e-320"),
            (1e9, "1000000000"),
            (f64::INFINITY, "inf"),
        ] {
            assert_eq!(number(value), text);
        }
    }
}
