//! Pictures that are damaged or cut: refused with their name, and no file is written.

use crate::common::{self, CAMERA, assert_says, folder, premio, said};
use std::fs;
use tempfile::TempDir;

/// A folder with a part and a camera.
fn prepared() -> TempDir {
    folder(&[("camera.json", CAMERA)])
}

/// The message about a picture.
#[track_caller]
fn message(folder: &TempDir, name: &str, bytes: &[u8], status: i32) -> String {
    let path = folder.path();
    fs::write(path.join(name), bytes).unwrap();
    let words = format!("match part.padl {name} --camera camera.json -o out.json");
    let output = premio(path, &words);
    let text = said(&output);
    assert_eq!(output.status.code(), Some(status), "{text}");
    let is_written = path.join("out.json").exists();
    assert_eq!(is_written, status == 0, "{text}");
    let _ = fs::remove_file(path.join("out.json"));
    text
}

/// A PNG of 160 by 120 grey pixels, its chunks apart.
fn chunks() -> Vec<Vec<u8>> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 160, 120);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().unwrap();
    let grey: Vec<u8> = (0..160 * 120)
        .map(|i| ((i % 160) ^ (i / 160)) as u8)
        .collect();
    writer.write_image_data(&grey).unwrap();
    writer.finish().unwrap();
    let mut chunks = vec![bytes[..8].to_vec()];
    let mut at = 8;
    while at < bytes.len() {
        let length = u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        chunks.push(bytes[at..at + length + 12].to_vec());
        at += length + 12;
    }
    chunks
}

fn chunk(kind: &[u8], data: &[u8]) -> Vec<u8> {
    let covered = [kind, data].concat();
    let length = (data.len() as u32).to_be_bytes();
    let checksum = crc32fast::hash(&covered).to_be_bytes();
    [&length[..], &covered, &checksum].concat()
}

#[test]
fn every_checksum_of_a_png_is_compared() {
    let folder = prepared();
    let mut chunks = chunks();
    chunks.insert(2, chunk(b"tEXt", b"Title\0part"));
    message(&folder, "good.png", &chunks.concat(), 0);
    for k in 1..chunks.len() {
        let mut bad = chunks.clone();
        *bad[k].last_mut().unwrap() ^= 1;
        let kind = String::from_utf8(bad[k][4..8].to_vec()).unwrap();
        let text = message(&folder, "bad.png", &bad.concat(), 2);
        assert_says(&text, &["bad.png", "checksum", &kind]);
    }
}

#[test]
fn the_checksum_of_compressed_data_is_compared() {
    let folder = prepared();
    let mut chunks = chunks();
    assert_eq!(chunks.len(), 4);
    let mut data = chunks[2][8..chunks[2].len() - 4].to_vec();
    *data.last_mut().unwrap() ^= 1;
    chunks[2] = chunk(b"IDAT", &data);
    let text = message(&folder, "bad.png", &chunks.concat(), 2);
    assert_says(&text, &["bad.png"]);
}

#[test]
fn a_png_that_is_too_large_says_how_large() {
    let folder = prepared();
    let mut chunks = chunks();
    let mut header = chunks[1][8..21].to_vec();
    header[..8].fill(0xff);
    (header[0], header[4]) = (0x7f, 0x7f);
    chunks[1] = chunk(b"IHDR", &header);
    let text = message(&folder, "bad.png", &chunks.concat(), 2);
    assert_says(&text, &["2147483647 x 2147483647", "--max-pixels"]);
}

#[test]
fn a_jpeg_with_missing_data_is_refused() {
    let folder = prepared();
    let bytes = common::JPEG;
    message(&folder, "good.jpg", bytes, 0);
    let scan = bytes.windows(2).position(|w| w == [0xff, 0xda]).unwrap();
    for tenths in 2..10 {
        let end = scan + (bytes.len() - scan) * tenths / 10;
        let cut = [&bytes[..end], &[0xff, 0xd9]].concat();
        let text = message(&folder, "bad.jpg", &cut, 2);
        assert_says(&text, &["bad.jpg", "a part of a picture", "at byte"]);
    }
    let frame = bytes.windows(2).position(|w| w == [0xff, 0xc0]).unwrap();
    for (offset, size) in [(5, 240u16), (7, 320), (5, 129)] {
        let mut larger = bytes.to_vec();
        larger[frame + offset..frame + offset + 2].copy_from_slice(&size.to_be_bytes());
        let text = message(&folder, "bad.jpg", &larger, 2);
        assert_says(&text, &["bad.jpg", "a part of a picture"]);
    }
}

#[test]
fn a_sample_above_white_is_refused() {
    let folder = prepared();
    let with = |header: &str, data: &[u8]| [header.as_bytes(), data].concat();
    let dark = [9; 160 * 120];
    let mut bright = dark;
    bright[163] = 255;
    let header = "P5\n# a comment\n160 120\n10\n";
    message(&folder, "good.pgm", &with(header, &dark), 0);
    let text = message(&folder, "bad.pgm", &with(header, &bright), 2);
    assert_says(&text, &["bad.pgm", "255 at pixel (3, 1)", "at most 10"]);
    let wide = dark.map(|v| [v, 0]).concat();
    let header = "P5\n160 120\n2000\n";
    assert_says(
        &message(&folder, "bad.pgm", &with(header, &wide), 2),
        &["2304 at pixel (0, 0)"],
    );
    let text = message(&folder, "bad.pgm", b"P2\n3 1\n255\n1 2 256\n", 2);
    assert_says(&text, &["256 at pixel (2, 0)", "at most 255"]);
    let text = message(&folder, "bad.ppm", b"P3\n2 1\n7\n1 2 3 4 5 8\n", 2);
    assert_says(&text, &["8 at pixel (1, 0)", "at most 7"]);
}

#[test]
fn a_colour_beyond_the_palette_is_refused() {
    let folder = prepared();
    let picture = |colours: usize, depth: png::BitDepth| {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, 160, 120);
        encoder.set_color(png::ColorType::Indexed);
        encoder.set_depth(depth);
        encoder.set_palette(vec![128; 3 * colours]);
        let mut writer = encoder.write_header().unwrap();
        let row = 160 * depth as usize / 8;
        let mut data = vec![0; row * 120];
        data[row + 1] = 3;
        writer.write_image_data(&data).unwrap();
        writer.finish().unwrap();
        bytes
    };
    for (depth, x) in [(png::BitDepth::Eight, 1), (png::BitDepth::Two, 7)] {
        message(&folder, "good.png", &picture(4, depth), 0);
        let text = message(&folder, "bad.png", &picture(3, depth), 2);
        let place = format!("colour 3 at pixel ({x}, 1)");
        assert_says(&text, &["bad.png", &place, "below 3"]);
    }
}
