//! STEP: ISO 10303, as AP242 or AP214, advanced boundary representations.
//!
//! Planes, cylinders, cones, spheres and tori are written exactly, and so are lines, circles,
//! ellipses, parabolas and hyperbolas. Every other curve is a spline within a stated distance of
//! it, with one in the parameters of each adjacent face. The file has one product, with one solid
//! for each solid and voids as voids. It uses only entities of ISO 10303-42 that every application
//! protocol with boundary representations has.

mod clearance;
mod colours;
mod overlap;
mod part21;
mod product;
mod shape;
mod spline_surface;
mod thin;

use crate::FaceColours;
use crate::spline::SplineError;
use crate::two_manifold::{SeamError, TwoManifold};
use part21::Exchange;
use premio_kernel::brep::Brep;
use premio_kernel::unit::Unit;
pub use thin::Thin;

/// The application protocol that a file names.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Protocol {
    /// Managed model-based 3D engineering.
    #[default]
    Ap242,
    /// Core data for automotive mechanical design.
    Ap214,
}

/// The options of a file.
#[derive(Clone, Debug)]
pub struct StepOptions {
    /// The name of the product.
    pub name: String,
    /// The protocol.
    pub protocol: Protocol,
    /// The part's unit.
    pub unit: Unit,
    /// The largest distance of splines from their curves, in the part's unit.
    pub accuracy: f64,
    /// The part's resolution.
    pub resolution: f64,
    /// The colours of faces.
    pub colours: FaceColours,
}

/// Why a boundary cannot be written.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StepError {
    /// There is no solid.
    #[error("the part is empty: there is no solid to write")]
    Empty,
    /// A face that closes around its surface could not be cut.
    #[error(transparent)]
    Seam(#[from] SeamError),
    /// A curve could not be approximated.
    #[error(transparent)]
    Spline(#[from] SplineError),
    /// Something is as thin as the tolerance of points and edges in other kernels, where it would
    /// be invalid.
    #[error(
        "{what} {size:.3e} at ({:.9}, {:.9}, {:.9}): other kernels merge what is not more than \
         {least:.0e} apart",
        place[0], place[1], place[2]
    )]
    Thin {
        /// The kind of entity.
        what: Thin,
        /// A point of it.
        place: [f64; 3],
        /// Its length or width, in the part's unit.
        size: f64,
        /// The lower limit.
        least: f64,
    },
}

/// The default distance of splines from their curves, relative to the part's size.
pub const ACCURACY: f64 = 1.0 / 1_000_000.0;

/// The factor by which splines are closer to their curves than requested. The error that their
/// distance causes in the volume is proportional to the adjacent area, which is large for a slender
/// part.
const NEARER: f64 = 64.0;

/// The text of a file.
///
/// # Errors
/// The boundary is empty, a face could not be cut by a seam, a curve takes too many pieces of a
/// spline, or something is as thin as the tolerance of other kernels.
pub fn write(brep: &Brep, options: &StepOptions) -> Result<String, StepError> {
    if brep.topology.solids.is_empty() {
        return Err(StepError::Empty);
    }
    let least = thin::apart(options.unit);
    thin::check_shells(brep, least)?;
    let mut seamed = TwoManifold::new(brep, options.resolution)?;
    seamed.merge_short_edges(least);
    seamed.close_narrow(least);
    thin::check(brep, &seamed, options.resolution, least)?;
    let mut exchange = Exchange::default();
    let context = product::context(&mut exchange, options);
    let mut shape = shape::Shape::new(&mut exchange, &seamed, options.accuracy / NEARER);
    let solids = shape.solids()?;
    let faces = shape.take_faces();
    colours::styles(&mut exchange, &options.colours, context, &faces);
    product::product(&mut exchange, options, context, &solids);
    Ok(exchange.finish(options))
}
