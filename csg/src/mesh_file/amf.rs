//! The Additive Manufacturing File Format (ISO/ASTM 52915): objects of triangles, as text or
//! packed.
//!
//! The volumes of an object are one set of faces. Units, constellations, materials and curved
//! triangles are not read: OpenSCAD does not read them either.

use super::xml::{XmlEvent, XmlReader};
use super::zip_package::ZipPackage;
use super::{MeshBuilder, MeshCoordinate, MeshFileError};

pub(super) fn read<C: MeshCoordinate>(
    bytes: &[u8],
    mesh: &mut MeshBuilder<C>,
) -> Result<(), MeshFileError> {
    if !ZipPackage::is_package(bytes) {
        return AmfReader::new(bytes, mesh)?.read();
    }
    let is_amf = |name: &str| name.to_ascii_lowercase().ends_with(".amf");
    let part = ZipPackage::open(bytes)?.only_part(is_amf)?;
    let part = part.ok_or(MeshFileError::NoPart {
        part: "one AMF file",
    })?;
    AmfReader::new(&part, mesh)?.read()
}

/// An element that matters, by its own name and that of the element around it.
#[derive(Clone, Copy)]
enum AmfElement {
    Amf,
    Object,
    Coordinates,
    /// x, y or z.
    Axis(usize),
    Triangle,
    /// A corner of a triangle.
    Corner(usize),
    Other,
}

impl AmfElement {
    fn new(around: Option<Self>, name: &str) -> Self {
        match (around, name) {
            (None, "amf") => Self::Amf,
            (Some(Self::Amf), "object") => Self::Object,
            (Some(Self::Other), "coordinates") => Self::Coordinates,
            (Some(Self::Coordinates), "x") => Self::Axis(0),
            (Some(Self::Coordinates), "y") => Self::Axis(1),
            (Some(Self::Coordinates), "z") => Self::Axis(2),
            (Some(Self::Other), "triangle") => Self::Triangle,
            (Some(Self::Triangle), "v1") => Self::Corner(0),
            (Some(Self::Triangle), "v2") => Self::Corner(1),
            (Some(Self::Triangle), "v3") => Self::Corner(2),
            _ => Self::Other,
        }
    }
}

struct AmfReader<'t, 'm, C: MeshCoordinate> {
    xml: XmlReader<'t>,
    mesh: &'m mut MeshBuilder<C>,
    /// The elements around the place that is read.
    open: Vec<AmfElement>,
    /// The text of the innermost element, if it is a number.
    number: String,
    point: [Option<C>; 3],
    corners: [Option<usize>; 3],
    /// The index of the object's first point.
    first: usize,
}

impl<'t, 'm, C: MeshCoordinate> AmfReader<'t, 'm, C> {
    fn new(bytes: &'t [u8], mesh: &'m mut MeshBuilder<C>) -> Result<Self, MeshFileError> {
        Ok(Self {
            xml: XmlReader::new(bytes)?,
            mesh,
            open: Vec::new(),
            number: String::new(),
            point: [None, None, None],
            corners: [None; 3],
            first: 0,
        })
    }

    fn read(mut self) -> Result<(), MeshFileError> {
        let mut has_root = false;
        while let Some(event) = self.xml.next()? {
            match event {
                XmlEvent::Start(element) => {
                    let element = AmfElement::new(self.open.last().copied(), element.name());
                    has_root |= matches!(element, AmfElement::Amf);
                    self.open.push(element);
                    self.start(element);
                }
                XmlEvent::Text(text) => {
                    if let Some(AmfElement::Axis(_) | AmfElement::Corner(_)) = self.open.last() {
                        self.number.push_str(&text);
                    }
                }
                XmlEvent::End => {
                    if let Some(element) = self.open.pop() {
                        self.end(element)?;
                    }
                }
            }
        }
        match has_root {
            true => Ok(()),
            false => Err(self.xml.wrong("the element `amf`")),
        }
    }

    fn start(&mut self, element: AmfElement) {
        match element {
            AmfElement::Object => {
                self.mesh.begin_object();
                self.first = self.mesh.mesh.points.len();
            }
            AmfElement::Coordinates => self.point = [None, None, None],
            AmfElement::Triangle => self.corners = [None; 3],
            AmfElement::Axis(_) | AmfElement::Corner(_) => self.number.clear(),
            AmfElement::Amf | AmfElement::Other => {}
        }
    }

    fn end(&mut self, element: AmfElement) -> Result<(), MeshFileError> {
        match element {
            AmfElement::Axis(axis) => {
                let value = C::from_decimal(self.number.trim());
                let value = value.ok_or_else(|| self.xml.wrong("a finite number"))?;
                self.point[axis] = Some(value);
            }
            AmfElement::Corner(corner) => {
                let index: Option<usize> = self.number.trim().parse().ok();
                let index = index.and_then(|index| index.checked_add(self.first));
                let index = index.filter(|index| *index < self.mesh.mesh.points.len());
                let index =
                    index.ok_or_else(|| self.xml.wrong("the index of a point before it"))?;
                self.corners[corner] = Some(index);
            }
            AmfElement::Coordinates => {
                let [Some(x), Some(y), Some(z)] = std::mem::take(&mut self.point) else {
                    return Err(self.xml.wrong("`x`, `y` and `z`"));
                };
                self.mesh.point([x, y, z])?;
            }
            AmfElement::Triangle => {
                let [Some(a), Some(b), Some(c)] = self.corners else {
                    return Err(self.xml.wrong("`v1`, `v2` and `v3`"));
                };
                self.mesh.face(&[a, b, c])?;
            }
            AmfElement::Amf | AmfElement::Object | AmfElement::Other => {}
        }
        Ok(())
    }
}
