//! 3MF: points in f64, an object for each solid, the faces' colours, and the unit.

use super::{Facet, Facets, MeshError};
use crate::FaceColours;
use premio_kernel::colour::Colour;
use premio_kernel::unit::Unit;
use premio_text::escape;
use std::collections::{BTreeSet, HashMap};
use std::io::{Cursor, Read, Write};
use threemf2::model::builder::{MeshObjectBuilder, ModelBuilder, ObjectType, Unit as Length};
use threemf2::model::{OptionalResourceId, OptionalResourceIndex, ResourceId};
use threemf2::package::ThreemfPackageBuilder;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipArchive, ZipWriter};

/// The bytes of a file.
///
/// # Errors
/// There are too many triangles for the format.
pub fn write(
    facets: &Facets,
    colours: &FaceColours,
    name: &str,
    unit: Unit,
) -> Result<Vec<u8>, MeshError> {
    // The errors that can occur concern extensions, which are not used, and writing.
    written(facets, colours, name, unit).ok_or(MeshError::TooMany {
        triangles: facets.facets.len(),
    })
}

fn written(facets: &Facets, colours: &FaceColours, name: &str, unit: Unit) -> Option<Vec<u8>> {
    let unit = match unit {
        Unit::Metre => Length::Meter,
        Unit::Centimetre => Length::Centimeter,
        Unit::Millimetre => Length::Millimeter,
        Unit::Micrometre => Length::Micron,
        Unit::Inch => Length::Inch,
    };
    // The writer inserts texts without escaping.
    let name = escape::xml(name);
    let mut model = ModelBuilder::new(unit, true);
    model.add_metadata("Title", Some(&name));
    model.add_build(None).ok()?;
    let materials = Materials::new(facets, colours, &mut model);
    for of_solid in facets.solids() {
        let id = model.add_mesh_object(|object| {
            object.object_type(ObjectType::Model).name(&name);
            let material = |facet: &Facet| materials.place(colours.of(facet.face));
            if let (Some(materials), Some(first)) = (&materials.id, of_solid.first()) {
                // The default of triangles without a property of their own.
                object.pid(*materials).pindex(material(first));
            }
            add(object, facets, of_solid, |facet| {
                let id = materials.id?;
                Some((id, material(facet)))
            });
            Ok(())
        });
        model.add_build_item(id.ok()?).ok()?;
    }
    let mut package = ThreemfPackageBuilder::new();
    let mut model = model.build().ok()?;
    // The builder numbers materials and objects separately, and a file has one numbering. It also
    // requires an extension that it does not declare; materials are of the core.
    for group in &mut model.resources.basematerials {
        group.id = MATERIALS_ID;
    }
    if materials.id.is_some() {
        model.requiredextensions = Default::default();
    }
    package.set_root_model(model);
    let mut bytes = Cursor::new(Vec::new());
    package.build().ok()?.write(&mut bytes).ok()?;
    let bytes = bytes.into_inner();
    match materials.id {
        Some(_) => with_materials_first(&bytes),
        None => Some(bytes),
    }
}

/// The package with the materials of its model before the objects that use them, as readers expect.
fn with_materials_first(package: &[u8]) -> Option<Vec<u8>> {
    let mut from = ZipArchive::new(Cursor::new(package)).ok()?;
    let mut to = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().compression_method(CompressionMethod::Deflated);
    for index in 0..from.len() {
        let mut file = from.by_index(index).ok()?;
        if !file.name().ends_with(".model") {
            to.raw_copy_file(file).ok()?;
            continue;
        }
        let mut text = String::new();
        file.read_to_string(&mut text).ok()?;
        to.start_file(file.name(), options).ok()?;
        to.write_all(reordered(&text)?.as_bytes()).ok()?;
    }
    Some(to.finish().ok()?.into_inner())
}

/// The text of a model with the materials as the first resources. Names are escaped, so each tag occurs
/// once.
fn reordered(model: &str) -> Option<String> {
    const END: &str = "</basematerials>";
    const RESOURCES: &str = "<resources>";
    let (before, rest) = model.split_at(model.find("<basematerials")?);
    let (materials, after) = rest.split_at(rest.find(END)? + END.len());
    let (head, objects) = before.split_at(before.find(RESOURCES)? + RESOURCES.len());
    Some([head, materials, objects, after].concat())
}

/// The materials of the faces.
struct Materials {
    /// The resource; `None` if no face has a colour.
    id: Option<ResourceId>,
    colours: Vec<Option<Colour>>,
}

impl Materials {
    fn new(facets: &Facets, colours: &FaceColours, model: &mut ModelBuilder) -> Self {
        let all = facets.facets.iter().map(|facet| colours.of(facet.face));
        let used: BTreeSet<Option<Colour>> = all.collect();
        let colours: Vec<Option<Colour>> = used.into_iter().collect();
        let has_any = colours.iter().any(Option::is_some);
        if has_any {
            model.add_base_materials(|group| {
                for colour in &colours {
                    let shown = colour.unwrap_or(NO_COLOUR).to_string();
                    let name = if colour.is_some() { &shown } else { "none" };
                    group.add_base(name, &shown);
                }
            });
        }
        Self {
            id: has_any.then_some(MATERIALS_ID),
            colours,
        }
    }

    /// The index of a colour.
    fn place(&self, colour: Option<Colour>) -> u32 {
        let place = self.colours.iter().position(|known| *known == colour);
        place.unwrap_or_default() as u32
    }
}

/// The number of the materials, which no object has.
const MATERIALS_ID: ResourceId = 1 << 30;

/// The colour of faces without one, where others have one.
const NO_COLOUR: Colour = Colour {
    rgb: [166, 173, 184],
    alpha: 255,
};

/// Adds the triangles of a solid to an object, with only the points they use. `material` gives the
/// resource and the index of a triangle's material.
fn add(
    object: &mut MeshObjectBuilder,
    facets: &Facets,
    of_solid: &[Facet],
    material: impl Fn(&Facet) -> Option<(ResourceId, u32)>,
) {
    let mut place: HashMap<u32, usize> = HashMap::new();
    for facet in of_solid {
        let corners = facet.corners.map(|corner| {
            let next = place.len();
            *place.entry(corner).or_insert_with(|| {
                let p = facets.points[corner as usize];
                object.add_vertex(&[p.x, p.y, p.z]);
                next
            })
        });
        match material(facet) {
            Some((id, index)) => object.add_triangle_with_properties(
                &corners,
                OptionalResourceIndex::new(index),
                OptionalResourceIndex::none(),
                OptionalResourceIndex::none(),
                OptionalResourceId::new(id),
            ),
            None => object.add_triangle(&corners),
        };
    }
}
