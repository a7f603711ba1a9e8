use super::*;

/// Every kind of PNG samples is read as it was written.
#[test]
fn samples_are_read_as_they_were_written() {
    for channels in [
        Channels::Grey,
        Channels::GreyAlpha,
        Channels::Rgb,
        Channels::RgbAlpha,
    ] {
        let count = 31 * 17 * channels.count() as u32;
        for samples in [
            Samples::Bytes((0..count).map(|i| ((7 * i) ^ (i / 31)) as u8).collect()),
            Samples::Words((0..count).map(|i| ((977 * i) ^ (i / 31)) as u16).collect()),
        ] {
            let raster = Raster {
                size: [31, 17],
                channels,
                samples,
            };
            for bytes in [png::encode(&raster).unwrap(), netpbm::encode(&raster)] {
                assert_eq!(decode(&bytes, 1000).unwrap(), raster);
                let large = decode(&bytes, 31 * 17 - 1);
                assert!(matches!(large, Err(PictureError::Large { .. })));
            }
        }
    }
}

#[test]
fn what_is_no_picture_is_refused() {
    for bytes in [&b""[..], b"GIF89a", b"none", b"\x89PNG", b"P8\n1 1\n"] {
        assert!(matches!(decode(bytes, 1000), Err(PictureError::Format)));
    }
    let empty = decode(b"P5\n0 3\n255\n", 1000);
    assert!(matches!(empty, Err(PictureError::Empty { .. })));
}
