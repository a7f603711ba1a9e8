//! The part of a 3MF file that has the model.

use std::collections::HashMap;

use super::{Instance, ThreeMfModel, ThreeMfObject};
use crate::mesh_file::placement::PlacementMap;
use crate::mesh_file::xml::{XmlElement, XmlEvent, XmlReader};
use crate::mesh_file::{MeshCoordinate, MeshFileError};

/// Reads the model. There are at most `limit` points and at most `limit` corners.
pub(super) fn read<C: MeshCoordinate>(
    part: &[u8],
    limit: usize,
) -> Result<ThreeMfModel<C>, MeshFileError> {
    let reader = ModelReader {
        xml: XmlReader::new(part)?,
        open: Vec::new(),
        has_root: false,
        unit: None,
        objects: Vec::new(),
        known: HashMap::new(),
        build: Vec::new(),
        left: limit,
        limit,
    };
    reader.read()
}

/// An element that matters, by its own name and that of the element around it.
#[derive(Clone, Copy)]
enum ModelElement {
    Model,
    Resources,
    Object,
    Mesh,
    Vertices,
    Vertex,
    Triangles,
    Triangle,
    Components,
    Component,
    Build,
    Item,
    Other,
}

impl ModelElement {
    fn new(around: Option<Self>, name: &str) -> Self {
        match (around, name) {
            (None, "model") => Self::Model,
            (Some(Self::Model), "resources") => Self::Resources,
            (Some(Self::Model), "build") => Self::Build,
            (Some(Self::Resources), "object") => Self::Object,
            (Some(Self::Object), "mesh") => Self::Mesh,
            (Some(Self::Object), "components") => Self::Components,
            (Some(Self::Mesh), "vertices") => Self::Vertices,
            (Some(Self::Mesh), "triangles") => Self::Triangles,
            (Some(Self::Vertices), "vertex") => Self::Vertex,
            (Some(Self::Triangles), "triangle") => Self::Triangle,
            (Some(Self::Components), "component") => Self::Component,
            (Some(Self::Build), "item") => Self::Item,
            _ => Self::Other,
        }
    }
}

struct ModelReader<'t, C> {
    xml: XmlReader<'t>,
    /// The elements around the place that is read.
    open: Vec<ModelElement>,
    has_root: bool,
    unit: Option<C>,
    objects: Vec<ThreeMfObject<C>>,
    /// The indices of the objects that are complete, by their ids.
    known: HashMap<u32, usize>,
    build: Vec<Instance<C>>,
    /// The number of points and triangles that may follow.
    left: usize,
    limit: usize,
}

impl<C: MeshCoordinate> ModelReader<'_, C> {
    fn read(mut self) -> Result<ThreeMfModel<C>, MeshFileError> {
        // An object may refer to those before it, and not to itself.
        let mut id = None;
        while let Some(event) = self.xml.next()? {
            match event {
                XmlEvent::Start(start) => {
                    let element = ModelElement::new(self.open.last().copied(), start.name());
                    self.open.push(element);
                    if let ModelElement::Object = element {
                        id = Some(self.id(&start, "id")?);
                    }
                    self.start(element, &start)?;
                }
                XmlEvent::End => {
                    if let Some(ModelElement::Object) = self.open.pop()
                        && let Some(id) = id.take()
                    {
                        self.known.insert(id, self.objects.len() - 1);
                    }
                }
                XmlEvent::Text(_) => {}
            }
        }
        if !self.has_root {
            return Err(self.xml.wrong("the element `model`"));
        }
        Ok(ThreeMfModel {
            unit: self.unit,
            objects: self.objects,
            build: self.build,
        })
    }

    fn start(
        &mut self,
        element: ModelElement,
        start: &XmlElement<'_>,
    ) -> Result<(), MeshFileError> {
        match element {
            ModelElement::Model => {
                self.has_root = true;
                self.unit = self.unit(start)?;
            }
            ModelElement::Object => self.objects.push(ThreeMfObject::default()),
            ModelElement::Vertex => {
                self.count()?;
                let point = self.point(start)?;
                self.object()?.points.push(point);
            }
            ModelElement::Triangle => {
                self.count()?;
                let corners = self.corners(start)?;
                self.object()?.faces.push(&corners);
            }
            ModelElement::Component => {
                let instance = self.instance(start)?;
                self.object()?.components.push(instance);
            }
            ModelElement::Item => {
                let instance = self.instance(start)?;
                self.build.push(instance);
            }
            _ => {}
        }
        Ok(())
    }

    /// The object that is read.
    fn object(&mut self) -> Result<&mut ThreeMfObject<C>, MeshFileError> {
        let objects = &mut self.objects;
        let none = || self.xml.wrong("an object around it");
        objects.last_mut().ok_or_else(none)
    }

    fn count(&mut self) -> Result<(), MeshFileError> {
        let limit = self.limit;
        let left = self.left.checked_sub(1);
        self.left = left.ok_or(MeshFileError::TooManyCorners { limit })?;
        Ok(())
    }

    /// The length of the unit in millimetres, if it is another.
    fn unit(&self, start: &XmlElement<'_>) -> Result<Option<C>, MeshFileError> {
        match start.attribute("unit").as_deref() {
            None | Some("millimeter") => Ok(None),
            Some("micron") => Ok(Some(C::from_quotient(1, 1000))),
            Some("centimeter") => Ok(Some(C::from_quotient(10, 1))),
            Some("inch") => Ok(Some(C::from_quotient(254, 10))),
            Some("foot") => Ok(Some(C::from_quotient(3048, 10))),
            Some("meter") => Ok(Some(C::from_quotient(1000, 1))),
            Some(_) => Err(self.xml.wrong("a unit of length")),
        }
    }

    fn id(&self, start: &XmlElement<'_>, name: &str) -> Result<u32, MeshFileError> {
        let id = start.attribute(name).and_then(|id| id.trim().parse().ok());
        id.ok_or_else(|| self.xml.wrong("the id of an object"))
    }

    fn point(&self, start: &XmlElement<'_>) -> Result<[C; 3], MeshFileError> {
        let coordinate = |name| {
            let text = start.attribute(name).unwrap_or_default();
            let value = C::from_decimal(text.trim());
            value.ok_or_else(|| self.xml.wrong("finite numbers `x`, `y` and `z`"))
        };
        Ok([coordinate("x")?, coordinate("y")?, coordinate("z")?])
    }

    fn corners(&self, start: &XmlElement<'_>) -> Result<[usize; 3], MeshFileError> {
        let points = self.objects.last().map_or(0, |object| object.points.len());
        let corner = |name| {
            let text = start.attribute(name).unwrap_or_default();
            let index: Option<usize> = text.trim().parse().ok();
            let index = index.filter(|index| (0..points).contains(index));
            index.ok_or_else(|| self.xml.wrong("indices `v1`, `v2` and `v3` of points"))
        };
        Ok([corner("v1")?, corner("v2")?, corner("v3")?])
    }

    fn instance(&self, start: &XmlElement<'_>) -> Result<Instance<C>, MeshFileError> {
        if start.attribute("path").is_some() {
            return Err(self.xml.wrong("an object of this part, without a path"));
        }
        let object = self.known.get(&self.id(start, "objectid")?);
        let object = object.ok_or_else(|| self.xml.wrong("the id of an object before it"))?;
        let map = match start.attribute("transform") {
            None => None,
            Some(text) => {
                let map = PlacementMap::from_text(&text);
                Some(map.ok_or_else(|| self.xml.wrong("a transform of twelve numbers"))?)
            }
        };
        Ok(Instance {
            object: *object,
            map,
        })
    }
}
