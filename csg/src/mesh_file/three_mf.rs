//! 3MF (core specification 1.3): objects of triangles, objects of placed objects, and the build
//! that places them.
//!
//! Extensions are not read: objects in other parts, beam lattices, slices and colours.

mod instances;
mod model;

use super::placement::PlacementMap;
use super::xml::{XmlEvent, XmlReader};
use super::zip_package::ZipPackage;
use super::{MeshBuilder, MeshCoordinate, MeshFaces, MeshFileError, ObjectPlacement};

/// The part that names the part of the model.
const RELATIONSHIPS: &str = "_rels/.rels";

/// The end of the type of the relationship to the model.
const MODEL_TYPE: &str = "/3dmodel";

/// What is read of a 3MF file.
struct ThreeMfModel<C> {
    /// The length of its unit in millimetres, if it is another.
    unit: Option<C>,
    objects: Vec<ThreeMfObject<C>>,
    build: Vec<Instance<C>>,
}

/// An object has a mesh or components.
struct ThreeMfObject<C> {
    points: Vec<[C; 3]>,
    faces: MeshFaces,
    components: Vec<Instance<C>>,
}

impl<C> Default for ThreeMfObject<C> {
    fn default() -> Self {
        Self {
            points: Vec::new(),
            faces: MeshFaces::default(),
            components: Vec::new(),
        }
    }
}

/// A placed object.
struct Instance<C> {
    /// The index of the object.
    object: usize,
    /// The map that places it, if it is moved.
    map: Option<PlacementMap<C>>,
}

pub(super) fn read<C: MeshCoordinate>(
    bytes: &[u8],
    placement: ObjectPlacement,
    mesh: &mut MeshBuilder<C>,
) -> Result<(), MeshFileError> {
    let mut package = ZipPackage::open(bytes)?;
    let relationships = package.part(RELATIONSHIPS)?;
    let relationships = relationships.ok_or(MeshFileError::NoPart {
        part: "relationships",
    })?;
    let name = model_name(&relationships)?;
    let part = match name {
        Some(name) => package.part(&name)?,
        None => None,
    };
    let part = part.ok_or(MeshFileError::NoPart { part: "a 3D model" })?;
    let model = model::read(&part, mesh.limit)?;
    match placement {
        ObjectPlacement::Build => instances::add_build(&model, mesh),
        ObjectPlacement::AsWritten => instances::add_meshes(&model, mesh),
    }
}

/// The name of the model's part.
fn model_name(relationships: &[u8]) -> Result<Option<String>, MeshFileError> {
    let mut xml = XmlReader::new(relationships)?;
    let mut found = None;
    while let Some(event) = xml.next()? {
        let XmlEvent::Start(element) = event else {
            continue;
        };
        if element.name() != "Relationship" || found.is_some() {
            continue;
        }
        let kind = element.attribute("Type").unwrap_or_default();
        if kind.ends_with(MODEL_TYPE) {
            let target = element.attribute("Target").unwrap_or_default();
            found = Some(target.trim_start_matches('/').to_owned());
        }
    }
    Ok(found)
}
