//! Meshes in files: STL, OFF, OBJ, 3MF and AMF.
//!
//! Nothing of a file is trusted. Its bytes bound what a reader keeps of them; what a file repeats
//! or packs, [`MeshReadOptions`] and constants bound. Coordinates are of the caller's kind
//! ([`MeshCoordinate`]): exact numbers for solids, f64 for measures. No coordinate is rounded to
//! make two points one.

mod amf;
mod coordinate;
mod faces;
mod obj;
mod off;
mod placement;
mod polyhedra;
mod stl;
mod three_mf;
mod words;
mod xml;
mod zip_package;

pub use coordinate::MeshCoordinate;
pub use faces::MeshFaces;

use std::collections::HashMap;
use std::fmt;

/// A format of meshes.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum MeshFormat {
    /// STL, binary or text.
    Stl,
    /// The object file format of Geomview.
    Off,
    /// Wavefront OBJ.
    Obj,
    /// The 3D Manufacturing Format.
    ThreeMf,
    /// The Additive Manufacturing File Format, as text or packed.
    Amf,
}

impl MeshFormat {
    /// Every format.
    pub const ALL: [Self; 5] = [Self::Stl, Self::Off, Self::Obj, Self::ThreeMf, Self::Amf];

    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Stl => "stl",
            Self::Off => "off",
            Self::Obj => "obj",
            Self::ThreeMf => "3mf",
            Self::Amf => "amf",
        }
    }
}

impl fmt::Display for MeshFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.ending())
    }
}

/// Why a file is no mesh.
#[derive(Clone, Debug, Eq, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum MeshFileError {
    /// The file, or a part of it, is no text.
    #[error("byte {byte}: expected a text in UTF-8")]
    Text {
        /// The offset of the first other byte.
        byte: usize,
    },
    /// A line has another form.
    #[error("line {line}: expected {expected}")]
    Line {
        /// The line, from 1.
        line: usize,
        /// What was expected.
        expected: &'static str,
    },
    /// A triangle of a binary file has a coordinate that is not finite.
    #[error("triangle {number}: expected finite numbers")]
    Triangle {
        /// The triangle, from 1.
        number: usize,
    },
    /// There are too many points, or corners of faces.
    #[error("expected at most {limit} points and at most {limit} corners of faces")]
    TooManyCorners {
        /// The limit.
        limit: usize,
    },
    /// Objects are placed too often.
    #[error("expected at most {limit} placed objects")]
    TooManyInstances {
        /// The limit.
        limit: usize,
    },
    /// A transform has long numbers, or those of components in components make them long.
    #[error("expected transforms whose products have numbers of at most {limit} bits")]
    LongTransform {
        /// The limit.
        limit: usize,
    },
    /// An archive is damaged or is packed in another way.
    #[error("expected a zip archive of stored or deflated parts")]
    Archive,
    /// An archive has not the part that is needed.
    #[error("expected an archive with {part}")]
    NoPart {
        /// What the part is.
        part: &'static str,
    },
    /// A part of an archive is too long.
    #[error("expected at most {limit} bytes in a part of an archive")]
    LongPart {
        /// The limit.
        limit: u64,
    },
}

/// Which objects of a 3MF file are read, and where.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum ObjectPlacement {
    /// Those that the build places, in millimetres: what the file means.
    #[default]
    Build,
    /// Every mesh once with the numbers that the file states, whatever its unit: what OpenSCAD
    /// 2021.01 reads.
    AsWritten,
}

/// How a file is read.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct MeshReadOptions {
    /// The largest number of points, and of corners of faces.
    pub max_corners: usize,
    /// Which objects of a 3MF file are read. The other formats place no objects; units and
    /// constellations of an AMF file are not applied, as OpenSCAD does not.
    pub placement: ObjectPlacement,
}

/// The faces of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct MeshFile<C> {
    /// The points of all objects. STL repeats points; there equal points are one.
    pub points: Vec<[C; 3]>,
    /// The objects, each of which bounds solids of its own. All formats but 3MF and AMF have one.
    pub objects: Vec<MeshFaces>,
    /// Whether the coordinates were rounded to single precision.
    pub is_single_precision: bool,
}

impl<C: MeshCoordinate> MeshFile<C> {
    /// Reads a file.
    ///
    /// # Errors
    /// The file is not of this format, or has too much of something.
    pub fn read(
        bytes: &[u8],
        format: MeshFormat,
        options: &MeshReadOptions,
    ) -> Result<Self, MeshFileError> {
        let mut builder = MeshBuilder::new(options.max_corners);
        match format {
            MeshFormat::Stl => stl::read(bytes, &mut builder),
            MeshFormat::Off => off::read(words::text(bytes)?, &mut builder),
            MeshFormat::Obj => obj::read(words::text(bytes)?, &mut builder),
            MeshFormat::ThreeMf => three_mf::read(bytes, options.placement, &mut builder),
            MeshFormat::Amf => amf::read(bytes, &mut builder),
        }?;
        Ok(builder.mesh)
    }
}

/// A mesh that grows up to a limit.
struct MeshBuilder<C: MeshCoordinate> {
    mesh: MeshFile<C>,
    /// The points that equal points are replaced by.
    known: HashMap<[C::Key; 3], usize>,
    corners: usize,
    limit: usize,
}

impl<C: MeshCoordinate> MeshBuilder<C> {
    fn new(limit: usize) -> Self {
        let mesh = MeshFile {
            points: Vec::new(),
            objects: Vec::new(),
            is_single_precision: false,
        };
        Self {
            mesh,
            known: HashMap::new(),
            corners: 0,
            limit,
        }
    }

    fn begin_object(&mut self) {
        self.mesh.objects.push(MeshFaces::default());
    }

    fn point(&mut self, point: [C; 3]) -> Result<usize, MeshFileError> {
        let index = self.mesh.points.len();
        self.check(index)?;
        self.mesh.points.push(point);
        Ok(index)
    }

    /// The first point with these coordinates.
    fn distinct_point(&mut self, point: [C; 3]) -> Result<usize, MeshFileError> {
        let key = point.each_ref().map(C::key);
        if let Some(known) = self.known.get(&key) {
            return Ok(*known);
        }
        let index = self.point(point)?;
        self.known.insert(key, index);
        Ok(index)
    }

    /// Adds a face to the last object.
    fn face(&mut self, corners: &[usize]) -> Result<(), MeshFileError> {
        self.corners = self.corners.saturating_add(corners.len());
        self.check(self.corners.saturating_sub(1))?;
        if self.mesh.objects.is_empty() {
            self.begin_object();
        }
        if let Some(object) = self.mesh.objects.last_mut() {
            object.push(corners);
        }
        Ok(())
    }

    /// Whether there may be more than `count` points or corners.
    fn check(&self, count: usize) -> Result<(), MeshFileError> {
        let limit = self.limit;
        match (0..limit).contains(&count) {
            true => Ok(()),
            false => Err(MeshFileError::TooManyCorners { limit }),
        }
    }
}

#[cfg(test)]
mod tests;
