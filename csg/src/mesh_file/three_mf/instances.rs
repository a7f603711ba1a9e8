//! The meshes of a 3MF file where they are placed.

use super::{Instance, ThreeMfModel, ThreeMfObject};
use crate::mesh_file::placement::PlacementMap;
use crate::mesh_file::{MeshBuilder, MeshCoordinate, MeshFileError};

/// The largest number of placed objects, with those that have no faces: components of components
/// double in number with every line of a file.
const MAX_INSTANCES: usize = 50_000;

/// The longest number of a map, in bits. Each map of a chain makes the numbers longer.
const MAX_BITS: usize = 1 << 11;

/// Adds every mesh once with its own numbers.
pub(super) fn add_meshes<C: MeshCoordinate>(
    model: &ThreeMfModel<C>,
    mesh: &mut MeshBuilder<C>,
) -> Result<(), MeshFileError> {
    let objects = model.objects.iter();
    objects
        .filter(|object| !object.faces.is_empty())
        .try_for_each(|object| add(object, None, mesh))
}

/// Adds every mesh where the build places it, in millimetres.
pub(super) fn add_build<C: MeshCoordinate>(
    model: &ThreeMfModel<C>,
    mesh: &mut MeshBuilder<C>,
) -> Result<(), MeshFileError> {
    let unit = model.unit.clone().map(PlacementMap::scale);
    let placed = |item: &Instance<C>| item.within(unit.as_ref());
    // The last one is placed next.
    let mut waiting: Vec<Instance<C>> = model.build.iter().rev().map(placed).collect();
    let mut left = MAX_INSTANCES;
    let too_many = MeshFileError::TooManyInstances {
        limit: MAX_INSTANCES,
    };
    while let Some(instance) = waiting.pop() {
        left = left.checked_sub(1).ok_or_else(|| too_many.clone())?;
        let map = instance.map.as_ref();
        let bits = map.map_or(0, PlacementMap::bits);
        if !(0..=MAX_BITS).contains(&bits) {
            return Err(MeshFileError::LongTransform { limit: MAX_BITS });
        }
        let Some(object) = model.objects.get(instance.object) else {
            continue;
        };
        if !object.faces.is_empty() {
            add(object, map, mesh)?;
        }
        // So many could not be placed in any case.
        if waiting.len() + object.components.len() > MAX_INSTANCES {
            return Err(too_many);
        }
        let components = object.components.iter().rev();
        waiting.extend(components.map(|component| component.within(map)));
    }
    Ok(())
}

impl<C: MeshCoordinate> Instance<C> {
    /// The instance of which the whole is placed by a map.
    fn within(&self, whole: Option<&PlacementMap<C>>) -> Self {
        let map = match (&self.map, whole) {
            (Some(own), Some(whole)) => Some(own.then(whole)),
            (own, None) => own.clone(),
            (None, whole) => whole.cloned(),
        };
        Self {
            object: self.object,
            map,
        }
    }
}

fn add<C: MeshCoordinate>(
    object: &ThreeMfObject<C>,
    map: Option<&PlacementMap<C>>,
    mesh: &mut MeshBuilder<C>,
) -> Result<(), MeshFileError> {
    mesh.begin_object();
    let first = mesh.mesh.points.len();
    for point in &object.points {
        mesh.point(map.map_or_else(|| point.clone(), |map| map.image(point)))?;
    }
    let is_mirror = map.is_some_and(PlacementMap::is_mirror);
    for corners in object.faces.iter() {
        let mut corners: Vec<usize> = corners.iter().map(|corner| first + corner).collect();
        if is_mirror {
            corners.reverse();
        }
        mesh.face(&corners)?;
    }
    Ok(())
}
