use super::*;
use crate::polyhedron::{Polyhedron, PolyhedronError};
use premio_kernel::number::rational::Rational;
use std::io::{Cursor, Write};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

mod hostile;
mod packed;
mod planted;
mod text_formats;

const LIMIT: usize = 1_000_000;

fn options(placement: ObjectPlacement) -> MeshReadOptions {
    MeshReadOptions {
        max_corners: LIMIT,
        placement,
    }
}

fn read(bytes: &[u8], format: MeshFormat) -> Result<MeshFile<Rational>, MeshFileError> {
    MeshFile::read(bytes, format, &options(ObjectPlacement::Build))
}

fn message(bytes: &[u8], format: MeshFormat) -> String {
    read(bytes, format).unwrap_err().to_string()
}

fn polyhedra(bytes: &[u8], format: MeshFormat) -> Result<Vec<Polyhedron>, PolyhedronError> {
    read(bytes, format).unwrap().polyhedra()
}

/// Six times the volume of the polyhedra.
fn sixfold_volume(polyhedra: &[Polyhedron]) -> Rational {
    let volumes = polyhedra.iter().map(Polyhedron::sixfold_volume);
    volumes.fold(Rational::ZERO, |sum, volume| sum + volume)
}

fn ratio(numerator: i64, denominator: u64) -> Rational {
    Rational::from_parts(numerator.into(), denominator.into())
}

/// The tetrahedron at three unit vectors; its volume is 1/6.
const TETRAHEDRON: Written<'_> = Written {
    points: &["0 0 0", "1 0 0", "0 1 0", "0 0 1"],
    triangles: &[[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]],
};

/// A mesh as it is written.
struct Written<'a> {
    points: &'a [&'a str],
    triangles: &'a [[usize; 3]],
}

impl Written<'_> {
    fn bytes(&self, format: MeshFormat) -> Vec<u8> {
        match format {
            MeshFormat::Stl => self.text_stl().into_bytes(),
            MeshFormat::Off => self.off().into_bytes(),
            MeshFormat::Obj => self.obj().into_bytes(),
            MeshFormat::ThreeMf => three_mf(&self.three_mf_model()),
            MeshFormat::Amf => amf(&self.amf_object()).into_bytes(),
        }
    }

    fn text_stl(&self) -> String {
        let mut text = "solid x\n".to_owned();
        for corners in self.triangles {
            text += "facet normal 0 0 0\nouter loop\n";
            for corner in corners {
                text += &format!("vertex {}\n", self.points[*corner]);
            }
            text += "endloop\nendfacet\n";
        }
        text + "endsolid x\n"
    }

    fn binary_stl(&self) -> Vec<u8> {
        let mut bytes = b"solid".to_vec();
        bytes.resize(80, b' ');
        bytes.extend((self.triangles.len() as u32).to_le_bytes());
        for corners in self.triangles {
            bytes.extend([0; 12]);
            for corner in corners {
                let words = self.points[*corner].split(' ');
                bytes.extend(words.flat_map(|word| word.parse::<f32>().unwrap().to_le_bytes()));
            }
            bytes.extend([0; 2]);
        }
        bytes
    }

    fn off(&self) -> String {
        let (points, faces) = (self.points.len(), self.triangles.len());
        let mut text = format!("OFF\n# by hand\n{points} {faces} 0\n");
        text += &self.points.join("\n");
        text += "\n";
        for [a, b, c] in self.triangles {
            text += &format!("3 {a} {b} {c}\n");
        }
        text
    }

    fn obj(&self) -> String {
        let mut text = String::new();
        for point in self.points {
            text += &format!("v {point}\n");
        }
        for corners in self.triangles {
            let [a, b, c] = corners.map(|corner| corner + 1);
            text += &format!("f {a} {b} {c}\n");
        }
        text
    }

    fn three_mf_mesh(&self) -> String {
        let mut text = "<mesh><vertices>\n".to_owned();
        for point in self.points {
            let words: Vec<&str> = point.split(' ').collect();
            text += &format!(
                "<vertex x='{}' y='{}' z=\"{}\" />\n",
                words[0], words[1], words[2]
            );
        }
        text += "</vertices><triangles>\n";
        for [a, b, c] in self.triangles {
            text += &format!("<triangle v1='{a}' v2='{b}' v3='{c}'></triangle>\n");
        }
        text + "</triangles></mesh>"
    }

    fn three_mf_model(&self) -> String {
        let object = format!("<object id='3'>{}</object>", self.three_mf_mesh());
        model("millimeter", &object, "<item objectid='3'/>")
    }

    fn amf_object(&self) -> String {
        let mut text = "<object id='0'><mesh><vertices>\n".to_owned();
        for point in self.points {
            let words: Vec<&str> = point.split(' ').collect();
            text += "<vertex><coordinates>";
            text += &format!(
                "<x>{}</x><y> {} </y><z>{}</z>",
                words[0], words[1], words[2]
            );
            text += "</coordinates></vertex>\n";
        }
        text += "</vertices><volume>\n";
        for [a, b, c] in self.triangles {
            text += &format!("<triangle><v1>{a}</v1><v2>{b}</v2><v3>{c}</v3></triangle>\n");
        }
        text + "</volume></mesh></object>"
    }
}

fn model(unit: &str, resources: &str, build: &str) -> String {
    let space = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
    format!(
        "<?xml version='1.0' encoding='UTF-8'?>\n<!-- a model -->\n\
         <model unit='{unit}' xmlns='{space}'><metadata name='Title'>a &amp; b</metadata>\
         <resources>{resources}</resources><build>{build}</build></model>"
    )
}

const RELATIONSHIPS: &str = "<Relationships><Relationship Target='/3D/a.model' Id='r' \
    Type='http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel'/></Relationships>";

fn three_mf(model: &str) -> Vec<u8> {
    archive(&[("_rels/.rels", RELATIONSHIPS), ("3D/a.model", model)])
}

fn amf(objects: &str) -> String {
    format!("<?xml version='1.0'?>\n<amf unit='millimeter'>{objects}</amf>")
}

fn archive(parts: &[(&str, &str)]) -> Vec<u8> {
    let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
    for (name, text) in parts {
        let options = SimpleFileOptions::default();
        writer.start_file(*name, options).unwrap();
        writer.write_all(text.as_bytes()).unwrap();
    }
    writer.finish().unwrap().into_inner()
}
