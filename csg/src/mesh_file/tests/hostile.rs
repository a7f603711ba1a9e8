//! Files that cost more than they are long, and files that are damaged.

use super::*;
use proptest::prelude::*;

/// Each object is two of the object before it.
fn doubling(count: u32, first: &str) -> String {
    let mut resources = format!("<object id='1'>{first}</object>");
    for id in 2..=count {
        let component = format!("<component objectid='{}'/>", id - 1);
        resources +=
            &format!("<object id='{id}'><components>{component}{component}</components></object>");
    }
    model(
        "millimeter",
        &resources,
        &format!("<item objectid='{count}'/>"),
    )
}

#[test]
fn components_that_double_are_limited() {
    let mesh = TETRAHEDRON.three_mf_mesh();
    let found = read(&three_mf(&doubling(4, &mesh)), MeshFormat::ThreeMf).unwrap();
    assert_eq!(found.objects.len(), 8);
    for first in [mesh.as_str(), "<mesh/>"] {
        let bytes = three_mf(&doubling(60, first));
        let error = read(&bytes, MeshFormat::ThreeMf).unwrap_err();
        assert!(
            matches!(error, MeshFileError::TooManyInstances { .. }),
            "{error}"
        );
    }
    let few = MeshReadOptions {
        max_corners: 100,
        placement: ObjectPlacement::Build,
    };
    let bytes = three_mf(&doubling(60, &mesh));
    let error = MeshFile::<f64>::read(&bytes, MeshFormat::ThreeMf, &few).unwrap_err();
    assert_eq!(error, MeshFileError::TooManyCorners { limit: 100 });
}

/// An object that is a part of itself has no end.
#[test]
fn an_object_is_no_component_of_itself() {
    let own = "<object id='1'><components><component objectid='1'/></components></object>";
    let bytes = three_mf(&model("millimeter", own, "<item objectid='1'/>"));
    assert!(message(&bytes, MeshFormat::ThreeMf).contains("before it"));
}

/// Each level of components makes the numbers of a transform longer.
#[test]
fn transforms_of_transforms_are_limited() {
    let mut resources = format!("<object id='1'>{}</object>", TETRAHEDRON.three_mf_mesh());
    let digits = "0.1234567890123456789";
    for id in 2..60 {
        let component = format!(
            "<component objectid='{}' transform='{digits} 0 0 0 {digits} 0 0 0 {digits} 0 0 0'/>",
            id - 1
        );
        resources += &format!("<object id='{id}'><components>{component}</components></object>");
    }
    let bytes = three_mf(&model("millimeter", &resources, "<item objectid='59'/>"));
    let error = read(&bytes, MeshFormat::ThreeMf).unwrap_err();
    assert!(
        matches!(error, MeshFileError::LongTransform { .. }),
        "{error}"
    );
    assert!(
        MeshFile::<f64>::read(
            &bytes,
            MeshFormat::ThreeMf,
            &options(ObjectPlacement::Build)
        )
        .is_ok()
    );
}

/// 300 million spaces pack into 300 kilobytes.
#[test]
fn parts_are_unpacked_up_to_a_limit() {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    writer
        .start_file("a.amf", SimpleFileOptions::default())
        .unwrap();
    let spaces = vec![b' '; 1 << 20];
    for _ in 0..300 {
        writer.write_all(&spaces).unwrap();
    }
    let bytes = writer.finish().unwrap().into_inner();
    let error = read(&bytes, MeshFormat::Amf).unwrap_err();
    assert!(matches!(error, MeshFileError::LongPart { .. }), "{error}");
}

#[test]
fn entities_are_refused() {
    let bomb = "<!DOCTYPE amf [<!ENTITY a '0000000000'><!ENTITY b '&a;&a;&a;&a;&a;&a;&a;&a;'>]>\
        <amf><object><mesh><vertices><vertex><coordinates><x>&b;</x></coordinates></vertex>\
        </vertices></mesh></object></amf>";
    assert!(message(bomb.as_bytes(), MeshFormat::Amf).contains("document type"));
}

/// A deep element and one of many attributes take no more than their length.
#[test]
fn deep_and_wide_elements_are_read() {
    let deep = format!(
        "<amf>{}{}</amf>",
        "<a>".repeat(200_000),
        "</a>".repeat(200_000)
    );
    assert!(
        read(deep.as_bytes(), MeshFormat::Amf)
            .unwrap()
            .objects
            .is_empty()
    );
    let attributes: String = (0..100_000)
        .map(|k| format!(" a{k}='' xmlns:a{k}=''"))
        .collect();
    let wide = model("inch", "", &format!("<item{attributes} objectid='1'/>"));
    assert!(message(&three_mf(&wide), MeshFormat::ThreeMf).contains("before it"));
}

#[test]
fn stated_counts_reserve_nothing() {
    for (text, format) in [
        ("OFF 1000000000000 1 0\n0 0 0\n", MeshFormat::Off),
        ("OFF 1 1000000000000 0\n0 0 0\n3 0 0 0\n", MeshFormat::Off),
        (
            "OFF 1 1 0\n0 0 0\n18446744073709551615 0 0 0\n",
            MeshFormat::Off,
        ),
        ("OFF 1e18 1 0\n0 0 0\n", MeshFormat::Off),
        ("v 0 0 0\nf -9223372036854775808 1 1\n", MeshFormat::Obj),
        ("v 0 0 0\nf 9223372036854775807 1 1\n", MeshFormat::Obj),
        ("v 1e400000000 0 0\n", MeshFormat::Obj),
        ("v 1e-400000000 0 0\n", MeshFormat::Obj),
        ("v 0 0 nan\n", MeshFormat::Obj),
    ] {
        assert!(
            message(text.as_bytes(), format).contains("expected"),
            "{text}"
        );
    }
    let mut binary = TETRAHEDRON.binary_stl();
    binary[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    assert!(message(&binary, MeshFormat::Stl).contains("expected"));
    let mut binary = TETRAHEDRON.binary_stl();
    binary[84 + 50 + 12..][..4].copy_from_slice(&f32::INFINITY.to_le_bytes());
    assert!(message(&binary, MeshFormat::Stl).contains("triangle 2"));
    let few = MeshReadOptions {
        max_corners: 11,
        placement: ObjectPlacement::Build,
    };
    for format in MeshFormat::ALL {
        // A tetrahedron has twelve corners of faces.
        let bytes = TETRAHEDRON.bytes(format);
        let error = MeshFile::<f64>::read(&bytes, format, &few).unwrap_err();
        assert_eq!(
            error,
            MeshFileError::TooManyCorners { limit: 11 },
            "{format}"
        );
    }
}

proptest! {
    /// No damage of a file makes a reader panic.
    #[test]
    fn damaged_files_give_an_answer(
        format in prop::sample::select(&MeshFormat::ALL[..]),
        is_binary in any::<bool>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..4),
        cut in prop::option::of(any::<prop::sample::Index>()),
    ) {
        let mut bytes = match (format, is_binary) {
            (MeshFormat::Stl, true) => TETRAHEDRON.binary_stl(),
            (MeshFormat::Amf, true) => archive(&[("a.amf", &amf(&TETRAHEDRON.amf_object()))]),
            // What is in the archive is damaged, and not its checksum.
            (MeshFormat::ThreeMf, true) => TETRAHEDRON.three_mf_model().into_bytes(),
            _ => TETRAHEDRON.bytes(format),
        };
        for (at, byte) in &changes {
            let at = at.index(bytes.len());
            bytes[at] = *byte;
        }
        if let Some(cut) = cut {
            bytes.truncate(cut.index(bytes.len()));
        }
        if format == MeshFormat::ThreeMf && is_binary {
            bytes = three_mf(&String::from_utf8_lossy(&bytes));
        }
        if let Ok(mesh) = read(&bytes, format) {
            let _ = mesh.polyhedra();
        }
        let _ = MeshFile::<f64>::read(&bytes, format, &options(ObjectPlacement::AsWritten));
    }
}
