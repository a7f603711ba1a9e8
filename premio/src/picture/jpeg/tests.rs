use super::*;

/// Pictures of 40 by 32 pixels, written by libjpeg.
const ALL: [&[u8]; 4] = [
    include_bytes!("../../../tests/pictures/progressive.jpg"),
    include_bytes!("../../../tests/pictures/progressive-colours.jpg"),
    include_bytes!("../../../tests/pictures/restarts.jpg"),
    include_bytes!("../../../tests/pictures/subsampled.jpg"),
];

fn place(bytes: &[u8], kinds: &[u8]) -> usize {
    let is = |pair: &[u8]| pair[0] == 0xff && kinds.contains(&pair[1]);
    bytes.windows(2).position(is).unwrap()
}

#[test]
fn whole_pictures_have_all_data() {
    for bytes in ALL {
        assert_eq!(check(bytes), Ok(()));
        // Bytes after the end do not matter.
        assert_eq!(check(&[bytes, b"more"].concat()), Ok(()));
    }
}

#[test]
fn an_end_in_the_wrong_place_is_no_end() {
    for bytes in ALL {
        for end in place(bytes, &[marker::SCAN])..bytes.len() - 2 {
            let cut = [&bytes[..end], &[0xff, marker::END]].concat();
            assert!(check(&cut).is_err(), "{end} of {}", bytes.len());
            assert!(check(&bytes[..end]).is_err());
        }
    }
}

#[test]
fn a_larger_picture_needs_more_data() {
    for bytes in ALL {
        let frame = place(bytes, &[marker::BASELINE, marker::PROGRESSIVE]);
        for (offset, from) in [(5, 32), (7, 40)] {
            for size in [from + 9, 2 * from, 9000] {
                let mut larger = bytes.to_vec();
                larger[frame + offset..frame + offset + 2].copy_from_slice(&u16::to_be_bytes(size));
                assert!(check(&larger).is_err(), "{size}");
            }
        }
    }
}

#[test]
fn a_smaller_picture_needs_less_data() {
    let mut smaller = ALL[3].to_vec();
    let frame = place(&smaller, &[marker::BASELINE]);
    smaller[frame + 6] = 16;
    assert!(matches!(check(&smaller), Err(JpegError::Surplus { .. })));
}

#[test]
fn a_lost_restart_marker_is_missed() {
    let bytes = ALL[2];
    let first = place(bytes, &[0xd0]);
    let without = [&bytes[..first], &bytes[first + 2..]].concat();
    assert!(check(&without).is_err());
}

#[test]
fn no_bytes_end_in_a_panic() {
    for bytes in ALL {
        for at in 0..bytes.len() {
            for value in [0, 0xff, bytes[at] ^ 0x40] {
                let mut other = bytes.to_vec();
                other[at] = value;
                let _ = check(&other);
            }
        }
    }
}

#[test]
fn codes_that_do_not_fit_are_none() {
    let mut counts = [0; 16];
    counts[0] = 3;
    assert!(Huffman::new(&counts, &[1, 2, 3]).is_none());
    counts[0] = 1;
    counts[1] = 1;
    assert!(Huffman::new(&counts, &[1, 2]).is_some());
}
