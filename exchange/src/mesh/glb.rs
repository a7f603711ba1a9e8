//! Binary glTF 2.0: triangles with the surfaces' normals and the faces' colours, and the edges as
//! lines.
//!
//! Coordinates are in single precision, relative to the part's centre. The node above translates
//! them to their position and converts to metres and y up, as the format requires.

use super::f32_points::{F32Points, rounded};
use super::{Facet, Facets, MeshError};
use crate::FaceColours;
use gltf::binary::{Glb, Header};
use gltf::json::accessor::{ComponentType, GenericComponentType, Type};
use gltf::json::buffer::{Buffer, Target, View};
use gltf::json::material::{AlphaMode, PbrBaseColorFactor, PbrMetallicRoughness, StrengthFactor};
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::{Checked, USize64};
use gltf::json::{Accessor, Asset, Extras, Index, Material, Mesh, Node, Root, Scene, serialize};
use nalgebra::Point3;
use premio_kernel::colour::Colour;
use premio_kernel::unit::Unit;
use premio_text::escape;
use std::collections::{BTreeMap, HashMap};

/// The colours of faces and of edges.
const FACES: [f32; 4] = [0.65, 0.68, 0.72, 1.0];
const EDGES: [f32; 4] = [0.05, 0.05, 0.05, 1.0];

/// The roughness of a face.
const ROUGH: f32 = 0.6;

/// The bytes of a file.
///
/// # Errors
/// Points are too close for f32, or there are too many triangles.
pub fn write(
    facets: &Facets,
    colours: &FaceColours,
    name: &str,
    unit: Unit,
) -> Result<Vec<u8>, MeshError> {
    let centre = centre(&facets.points);
    let single = F32Points::new(facets, &centre)?;
    let mut file = File::default();
    let mut primitives = file.all_faces(&single, colours);
    if !facets.lines.is_empty() {
        primitives.push(file.edges(&facets.lines, &centre));
    }
    let mesh = file.root.push(Mesh {
        extensions: None,
        extras: Extras::default(),
        name: Some(name.to_owned()),
        primitives,
        weights: None,
    });
    let node = file.root.push(Node {
        matrix: Some(to_metres(&centre, unit)),
        mesh: Some(mesh),
        name: Some(name.to_owned()),
        ..Node::default()
    });
    let scene = file.root.push(Scene {
        extensions: None,
        extras: Extras::default(),
        name: None,
        nodes: vec![node],
    });
    file.root.scene = Some(scene);
    file.finish().ok_or(MeshError::TooMany {
        triangles: facets.facets.len(),
    })
}

/// The centre of the bounding box of points.
fn centre(points: &[Point3<f64>]) -> Point3<f64> {
    let over = |pick: fn(&Point3<f64>, &Point3<f64>) -> Point3<f64>| {
        points.iter().copied().reduce(|p, q| pick(&p, &q))
    };
    let low = over(|p, q| p.inf(q)).unwrap_or_default();
    let high = over(|p, q| p.sup(q)).unwrap_or_default();
    nalgebra::center(&low, &high)
}

/// The matrix, column by column, that moves a part from its centre to its position in metres, y up.
fn to_metres(centre: &Point3<f64>, unit: Unit) -> [f32; 16] {
    let size = unit.millimetres() / 1000.0;
    let [x, y, z] = [centre.x * size, centre.z * size, -centre.y * size];
    let columns = [
        [size, 0.0, 0.0, 0.0],
        [0.0, 0.0, -size, 0.0],
        [0.0, size, 0.0, 0.0],
        [x, y, z, 1.0],
    ];
    let mut matrix = [0.0; 16];
    for (to, from) in matrix.iter_mut().zip(columns.iter().flatten()) {
        *to = *from as f32;
    }
    matrix
}

/// A file under construction.
#[derive(Default)]
struct File {
    root: Root,
    bytes: Vec<u8>,
}

impl File {
    /// The triangles: those of faces without a colour, and then those of each colour.
    fn all_faces(&mut self, single: &F32Points, colours: &FaceColours) -> Vec<Primitive> {
        let mut by_colour: BTreeMap<Option<Colour>, Vec<&Facet>> = BTreeMap::new();
        for facet in &single.facets {
            let colour = colours.of(facet.face);
            by_colour.entry(colour).or_default().push(facet);
        }
        let one = |(colour, facets): (Option<Colour>, Vec<&Facet>)| {
            let material = match colour {
                Some(colour) => {
                    let parts = colour.linear().map(|part| part as f32);
                    self.material(&colour.to_string(), parts)
                }
                None => self.material("faces", FACES),
            };
            self.faces(single, &facets, material)
        };
        by_colour.into_iter().map(one).collect()
    }

    /// Triangles. A corner occurs once for each of its normals.
    fn faces(
        &mut self,
        single: &F32Points,
        facets: &[&Facet],
        material: Index<Material>,
    ) -> Primitive {
        let mut place: HashMap<(u32, [u32; 3]), u32> = HashMap::new();
        let (mut points, mut normals, mut indices) = (Vec::new(), Vec::new(), Vec::new());
        for facet in facets {
            for (&corner, normal) in facet.corners.iter().zip(&facet.normals) {
                let normal: [f32; 3] = normal.map(|x| x as f32).into();
                let key = (corner, normal.map(f32::to_bits));
                indices.push(*place.entry(key).or_insert_with(|| {
                    points.push(single.points[corner as usize]);
                    normals.push(normal);
                    points.len() as u32 - 1
                }));
            }
        }
        let attributes = [
            (Semantic::Positions, self.vectors(&points)),
            (Semantic::Normals, self.vectors(&normals)),
        ];
        self.primitive(Mode::Triangles, &attributes, &indices, material)
    }

    /// The edges: a line for each two consecutive points of one.
    fn edges(&mut self, lines: &[Vec<Point3<f64>>], centre: &Point3<f64>) -> Primitive {
        let (mut points, mut indices) = (Vec::new(), Vec::new());
        for line in lines {
            let first = points.len() as u32;
            points.extend(line.iter().map(|p| rounded(p, centre)));
            let last = points.len() as u32 - 1;
            indices.extend((first..last).flat_map(|i| [i, i + 1]));
        }
        let attributes = [(Semantic::Positions, self.vectors(&points))];
        let material = self.material("edges", EDGES);
        self.primitive(Mode::Lines, &attributes, &indices, material)
    }

    fn primitive(
        &mut self,
        mode: Mode,
        attributes: &[(Semantic, Index<Accessor>)],
        indices: &[u32],
        material: Index<Material>,
    ) -> Primitive {
        let bytes = indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        let view = self.view(bytes, Target::ElementArrayBuffer);
        let indices = self.accessor(view, indices.len(), ComponentType::U32, Type::Scalar);
        let attributes = attributes.iter().cloned();
        Primitive {
            attributes: attributes
                .map(|(semantic, at)| (Checked::Valid(semantic), at))
                .collect::<BTreeMap<_, _>>(),
            extensions: None,
            extras: Extras::default(),
            indices: Some(self.root.push(indices)),
            material: Some(material),
            mode: Checked::Valid(mode),
            targets: None,
        }
    }

    fn material(&mut self, name: &str, colour: [f32; 4]) -> Index<Material> {
        self.root.push(Material {
            name: Some(name.to_owned()),
            alpha_mode: Checked::Valid(match colour[3] < 1.0 {
                true => AlphaMode::Blend,
                false => AlphaMode::Opaque,
            }),
            pbr_metallic_roughness: PbrMetallicRoughness {
                base_color_factor: PbrBaseColorFactor(colour),
                metallic_factor: StrengthFactor(0.0),
                roughness_factor: StrengthFactor(ROUGH),
                ..PbrMetallicRoughness::default()
            },
            ..Material::default()
        })
    }

    /// Vectors, with their bounding box.
    fn vectors(&mut self, vectors: &[[f32; 3]]) -> Index<Accessor> {
        let numbers = vectors.iter().flatten();
        let bytes = numbers.flat_map(|x| x.to_le_bytes()).collect();
        let view = self.view(bytes, Target::ArrayBuffer);
        let mut accessor = self.accessor(view, vectors.len(), ComponentType::F32, Type::Vec3);
        let over = |pick: fn(f32, f32) -> f32| {
            let one = |a: [f32; 3], b: [f32; 3]| [0, 1, 2].map(|i: usize| pick(a[i], b[i]));
            vectors.iter().copied().reduce(one)
        };
        accessor.min = over(f32::min).map(|v| v.to_vec().into());
        accessor.max = over(f32::max).map(|v| v.to_vec().into());
        self.root.push(accessor)
    }

    fn accessor(
        &self,
        view: Index<View>,
        count: usize,
        component: ComponentType,
        shape: Type,
    ) -> Accessor {
        Accessor {
            buffer_view: Some(view),
            byte_offset: None,
            component_type: Checked::Valid(GenericComponentType(component)),
            count: USize64::from(count),
            extensions: None,
            extras: Extras::default(),
            max: None,
            min: None,
            name: None,
            normalized: false,
            sparse: None,
            type_: Checked::Valid(shape),
        }
    }

    /// A view of the buffer. All views consist of numbers of four bytes, so each is aligned.
    fn view(&mut self, bytes: Vec<u8>, target: Target) -> Index<View> {
        let view = View {
            buffer: Index::new(0),
            byte_length: USize64::from(bytes.len()),
            byte_offset: Some(USize64::from(self.bytes.len())),
            byte_stride: None,
            extensions: None,
            extras: Extras::default(),
            name: None,
            target: Some(Checked::Valid(target)),
        };
        self.bytes.extend(bytes);
        self.root.push(view)
    }

    /// The bytes of the file; `None` if there are more than its 32-bit lengths can count.
    fn finish(mut self) -> Option<Vec<u8>> {
        self.root.asset = Asset {
            generator: Some("premio".to_owned()),
            ..Asset::default()
        };
        self.root.push(Buffer {
            byte_length: USize64::from(self.bytes.len()),
            extensions: None,
            extras: Extras::default(),
            name: None,
            uri: None,
        });
        let json = escape::json(serialize::to_string(&self.root).ok()?).into_bytes();
        // Every length has 32 bits; the chunks' headers and padding take less than this.
        const HEADS: usize = 64;
        let length = u32::try_from(HEADS + json.len() + self.bytes.len()).ok()?;
        let glb = Glb {
            // The length includes the header.
            header: Header {
                magic: *b"glTF",
                version: 2,
                length,
            },
            json: json.into(),
            bin: Some(self.bytes.into()),
        };
        glb.to_vec().ok()
    }
}
