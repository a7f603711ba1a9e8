use super::*;
use proptest::prelude::*;

fn ratio(numerator: i64, denominator: u64) -> Rational {
    Rational::from_parts(numerator.into(), denominator.into())
}

fn table(text: &str) -> HeightField {
    HeightField::from_dat(text.as_bytes()).unwrap()
}

/// Six times the volume of a field's solid.
fn sixfold_volume(field: &HeightField) -> Rational {
    field.polyhedron(false).unwrap().sixfold_volume()
}

/// The prism over a triangle has its area times the mean of its heights. The four triangles of a
/// cell have the centre's height once and two corners' each: together the mean of the corners.
#[test]
fn a_cell_has_the_mean_of_its_heights() {
    let field = table("1 2\n3 6\n");
    assert_eq!(field.base, Rational::ZERO);
    assert_eq!(sixfold_volume(&field), Rational::from(6 * 3));
    let found = field.polyhedron(false).unwrap();
    // Four triangles, four walls and the base.
    assert_eq!(found.faces().len(), 9);
    assert_eq!(found.points().len(), 9);
    assert_eq!(found.bounds(), [[0.0; 3], [1.0, 1.0, 6.0]]);
    let centred = field.polyhedron(true).unwrap();
    assert_eq!(centred.bounds(), [[-0.5, -0.5, 0.0], [0.5, 0.5, 6.0]]);
    // The first row is that at y = 0.
    let front = [Rational::ONE, Rational::ZERO, Rational::from(2)];
    assert!(found.points().contains(&front));
}

/// The middle is a corner of all four cells: (4 * 4 + 8 * 0) / 4 above 0, and the base at -1.
#[test]
fn a_peak_among_zeros() {
    let field = table("# a peak\n0 0 0\n0 4 0\n\n  # of four\n0\t0 0");
    assert_eq!(field.base, -Rational::ONE);
    assert_eq!(sixfold_volume(&field), Rational::from(6 * (4 + 4)));
    let found = field.polyhedron(true).unwrap();
    assert_eq!(found.bounds(), [[-1.0, -1.0, -1.0], [1.0, 1.0, 4.0]]);
}

/// A flat field is a block, with the base at 0 where all heights are at least 1.
#[test]
fn a_flat_field_is_a_block() {
    for (height, base) in [(5, 0), (1, 0), (0, -1), (-3, -4)] {
        let field = table(&format!("{height} {height} {height}\n").repeat(3));
        assert_eq!(field.base, Rational::from(base));
        let found = field.polyhedron(false).unwrap();
        assert_eq!(found.faces().len(), 6);
        assert_eq!(
            found.sixfold_volume(),
            Rational::from(6 * 4 * (height - base))
        );
    }
    assert_eq!(table("0.5 1\n1 1").base, ratio(-1, 2));
}

/// OpenSCAD reads zeros where a row is short, and its base is at 0 here: the last cell of the
/// second table has no volume.
#[test]
fn short_rows_are_zeros() {
    let field = table("1 1 1\n1 1\n1\n");
    assert_eq!(field.base, Rational::ZERO);
    // Cells of 4/4, 3/4, 3/4 and 1/4: the centre alone has a height in the last one.
    assert_eq!(sixfold_volume(&field), ratio(6 * 11, 4));
    let field = table("2 2 2 2\n2 2\n2 2\n");
    // Cells of 2, 3/2 and 1, and of 2, 1 and 0.
    assert_eq!(sixfold_volume(&field), ratio(6 * 15, 2));
}

#[test]
fn a_field_needs_a_cell() {
    for text in ["", "# nothing", "1 2 3", "1\n2\n3"] {
        let found = table(text).polyhedron(false);
        assert_eq!(found, Err(PolyhedronError::Empty), "{text}");
    }
}

#[test]
fn what_is_no_table_is_an_error() {
    let error = |text: &str| HeightField::from_dat(text.as_bytes()).unwrap_err();
    assert_eq!(error("1 2\n3 x"), HeightFieldError::Number { line: 2 });
    for text in ["nan 1", "inf 1", "1e999 1", "1,2", "1 2 # 3"] {
        assert_eq!(error(text), HeightFieldError::Number { line: 1 }, "{text}");
    }
    let found = HeightField::from_dat(b"1 2\n\xff");
    assert_eq!(found, Err(HeightFieldError::Text { byte: 4 }));
    // Two lines that make a table of 40 000 x 40 000.
    let wide = "0 ".repeat(40_000) + "\n" + &"0\n".repeat(20_000);
    assert!(matches!(
        error(&wide),
        HeightFieldError::TooManyHeights { .. }
    ));
    let long = "0 0\n".repeat(40_000);
    assert!(matches!(
        error(&long),
        HeightFieldError::TooManyHeights { .. }
    ));
}

fn picture(
    [width, height]: [u32; 2],
    color: png::ColorType,
    depth: png::BitDepth,
    levels: &[u8],
) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, height);
    encoder.set_color(color);
    encoder.set_depth(depth);
    if color == png::ColorType::Indexed {
        encoder.set_palette([255, 0, 0, 0, 0, 255, 0, 255, 0, 255, 255, 255].as_slice());
    }
    let mut writer = encoder.write_header().unwrap();
    writer.write_image_data(levels).unwrap();
    writer.finish().unwrap();
    bytes
}

/// The heights of red, green, blue and white by the weights of OpenSCAD.
fn primaries() -> [Rational; 4] {
    [2126, 7152, 722, 10_000].map(|weight| ratio(weight, 100))
}

/// The upper row of the picture, red and green, is the second one of the field.
#[test]
fn a_picture_is_upright() {
    let levels = [255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255];
    let bytes = picture([2, 2], png::ColorType::Rgb, png::BitDepth::Eight, &levels);
    let field = HeightField::from_png(&bytes, false).unwrap();
    let [red, green, blue, white] = primaries();
    assert_eq!(
        field.heights,
        [&blue, &white, &red, &green].map(Rational::clone)
    );
    // All heights are above 1.
    assert_eq!(field.base, Rational::ZERO);
    let sum = red + green + blue + white;
    assert_eq!(sixfold_volume(&field), sum * ratio(6, 4));
}

#[test]
fn an_inverted_picture_is_below_zero() {
    let levels = [0, 255, 0, 255];
    let bytes = picture(
        [2, 2],
        png::ColorType::Grayscale,
        png::BitDepth::Eight,
        &levels,
    );
    let field = HeightField::from_png(&bytes, true).unwrap();
    let (black, white) = (ratio(100, 255), ratio(100, 255) - Rational::from(100));
    assert_eq!(
        field.heights,
        [&black, &white, &black, &white].map(Rational::clone)
    );
    assert_eq!(field.base, white - Rational::ONE);
    // The mean height above the base is half of 100, and 1.
    assert_eq!(sixfold_volume(&field), Rational::from(6 * 51));
}

/// Palettes, alpha and other depths: the levels are those of eight bits, and alpha does not count.
#[test]
fn every_kind_of_pixel_is_read() {
    use png::{BitDepth, ColorType};
    let [red, green, blue, white] = primaries();
    let zero = Rational::ZERO;
    let grey = ratio(128 * 100, 255);
    let cases: [(ColorType, BitDepth, &[u8], [&Rational; 2]); 7] = [
        (
            ColorType::Indexed,
            BitDepth::Two,
            &[0b0010_0000],
            [&red, &green],
        ),
        (
            ColorType::Indexed,
            BitDepth::Eight,
            &[1, 3],
            [&blue, &white],
        ),
        (
            ColorType::Grayscale,
            BitDepth::One,
            &[0b0100_0000],
            [&zero, &white],
        ),
        (
            ColorType::Grayscale,
            BitDepth::Sixteen,
            &[128, 255, 255, 0],
            [&grey, &white],
        ),
        (
            ColorType::GrayscaleAlpha,
            BitDepth::Eight,
            &[128, 0, 255, 9],
            [&grey, &white],
        ),
        (
            ColorType::Rgb,
            BitDepth::Sixteen,
            &[0, 9, 0, 9, 255, 9, 255, 0, 0, 0, 0, 0],
            [&blue, &red],
        ),
        (
            ColorType::Rgba,
            BitDepth::Eight,
            &[0, 255, 0, 0, 255, 255, 255, 7],
            [&green, &white],
        ),
    ];
    for (color, depth, levels, heights) in cases {
        let bytes = picture([2, 1], color, depth, levels);
        let field = HeightField::from_png(&bytes, false).unwrap();
        assert_eq!(
            field.heights,
            heights.map(Rational::clone),
            "{color:?} {depth:?}"
        );
    }
}

#[test]
fn what_is_no_picture_is_an_error() {
    let levels = [7; 4];
    let bytes = picture(
        [2, 2],
        png::ColorType::Grayscale,
        png::BitDepth::Eight,
        &levels,
    );
    for end in 0..bytes.len() - 12 {
        assert!(
            HeightField::from_png(&bytes[..end], false).is_err(),
            "{end}"
        );
    }
    // A header that states more pixels than any memory has.
    let mut huge = bytes;
    huge[16..24].copy_from_slice(&[0x7f; 8]);
    let header = crc32(&huge[12..29]);
    huge[29..33].copy_from_slice(&header.to_be_bytes());
    let found = HeightField::from_png(&huge, false);
    assert!(
        matches!(found, Err(HeightFieldError::TooManyHeights { .. })),
        "{found:?}"
    );
}

/// The checksum of a chunk, bit after bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| match crc & 1 {
            1 => crc >> 1 ^ 0xedb8_8320,
            _ => crc >> 1,
        })
    })
}

proptest! {
    /// The volume over the base is the sum of the means of the cells.
    #[test]
    fn the_volume_is_that_of_the_cells(
        heights in prop::collection::vec(prop::collection::vec(-20i64..20, 4), 2..5),
    ) {
        let rows = heights.iter().map(|row| {
            row.iter().map(|x| format!("{}.5 ", x)).collect::<String>() + "\n"
        });
        let field = table(&rows.collect::<String>());
        let value = |x: i64| if x < 0 { ratio(2 * x - 1, 2) } else { ratio(2 * x + 1, 2) };
        let mut sum = Rational::ZERO;
        for rows in heights.windows(2) {
            for k in 0..3 {
                let corners = [rows[0][k], rows[0][k + 1], rows[1][k], rows[1][k + 1]];
                let cell = corners.map(value).into_iter().fold(Rational::ZERO, |a, b| a + b);
                sum += cell / Rational::from(4) - &field.base;
            }
        }
        prop_assert_eq!(sixfold_volume(&field), sum * Rational::from(6));
    }

    #[test]
    fn damaged_pictures_give_an_answer(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
    ) {
        let mut bytes = picture([3, 3], png::ColorType::Grayscale, png::BitDepth::Eight, &[9; 9]);
        for (at, byte) in changes {
            let at = at.index(bytes.len());
            bytes[at] = byte;
        }
        let _ = HeightField::from_png(&bytes, true);
        let _ = HeightField::from_dat(&bytes);
    }
}
