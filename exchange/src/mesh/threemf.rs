//! 3MF: points in f64, an object for each solid, and the unit.

use super::{Facet, Facets, MeshError};
use premio_kernel::unit::Unit;
use premio_text::escape;
use std::collections::HashMap;
use std::io::Cursor;
use threemf2::model::builder::{MeshObjectBuilder, ModelBuilder, ObjectType, Unit as Length};
use threemf2::package::ThreemfPackageBuilder;

/// The bytes of a file.
///
/// # Errors
/// There are too many triangles for the format.
pub fn write(facets: &Facets, name: &str, unit: Unit) -> Result<Vec<u8>, MeshError> {
    // The errors that can occur concern extensions, which are not used, and writing.
    written(facets, name, unit).ok_or(MeshError::TooMany {
        triangles: facets.facets.len(),
    })
}

fn written(facets: &Facets, name: &str, unit: Unit) -> Option<Vec<u8>> {
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
    for of_solid in facets.solids() {
        let id = model.add_mesh_object(|object| {
            object.object_type(ObjectType::Model).name(&name);
            add(object, facets, of_solid);
            Ok(())
        });
        model.add_build_item(id.ok()?).ok()?;
    }
    let mut package = ThreemfPackageBuilder::new();
    package.set_root_model(model.build().ok()?);
    let mut bytes = Cursor::new(Vec::new());
    package.build().ok()?.write(&mut bytes).ok()?;
    Some(bytes.into_inner())
}

/// Adds the triangles of a solid to an object, with only the points they use.
fn add(object: &mut MeshObjectBuilder, facets: &Facets, of_solid: &[Facet]) {
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
        object.add_triangle(&corners);
    }
}
