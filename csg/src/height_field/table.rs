//! Height fields in tables.

use premio_kernel::number::rational::{Rational, from_decimal};

use super::{HeightField, HeightFieldError, base_below, check_size};

/// The longest number.
const MAX_DECIMAL_LENGTH: usize = 100;

pub(super) fn read(bytes: &[u8]) -> Result<HeightField, HeightFieldError> {
    let text = std::str::from_utf8(bytes).map_err(|error| HeightFieldError::Text {
        byte: error.valid_up_to(),
    })?;
    let lines = text.lines().map(str::trim).enumerate();
    let lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
    let (mut count, mut columns) = (0, 0);
    let mut rows: Vec<Vec<Rational>> = Vec::new();
    for (line, words) in lines {
        let mut row = Vec::new();
        for word in words.split([' ', '\t']).filter(|word| !word.is_empty()) {
            count += 1;
            check_size(count, 1)?;
            let number = Some(word).filter(|word| word.len() <= MAX_DECIMAL_LENGTH);
            let number = number.and_then(|word| from_decimal(word).ok());
            row.push(number.ok_or(HeightFieldError::Number { line: line + 1 })?);
        }
        columns = row.len().max(columns);
        rows.push(row);
    }
    check_size(columns, rows.len())?;
    let base = base_below(rows.iter().flatten());
    for row in &mut rows {
        row.resize(columns, Rational::ZERO);
    }
    Ok(HeightField {
        columns,
        rows: rows.len(),
        heights: rows.into_iter().flatten().collect(),
        base,
    })
}
