//! STEP: ISO 10303, as AP242 or AP214, advanced boundary representations.
//!
//! Planes, cylinders, cones, spheres and tori are themselves, and so are lines, circles, ellipses,
//! parabolas and hyperbolas; every other curve is a spline within a stated distance of the curve, with
//! one in the parameters of each face next to it. The whole is one product, a solid for each solid,
//! voids as voids. Of ISO 10303-42 no more is used than every application protocol with boundary
//! representations has.

mod clearance;
mod part21;
mod product;
mod shape;
mod thin;

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

/// What a file is to say.
#[derive(Clone, Debug)]
pub struct StepOptions {
    /// What the product is called.
    pub name: String,
    /// The protocol.
    pub protocol: Protocol,
    /// What the part's unit is.
    pub unit: Unit,
    /// How far splines may be from the curves they follow, in the part's unit.
    pub accuracy: f64,
    /// The part's resolution.
    pub resolution: f64,
}

/// Why a boundary is not written.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum StepError {
    /// There is no solid.
    #[error("the part is empty: there is no solid to write")]
    Empty,
    /// A face closes around its surface and was not cut.
    #[error(transparent)]
    Seam(#[from] SeamError),
    /// A curve was not followed.
    #[error(transparent)]
    Spline(#[from] SplineError),
    /// Something is as thin as points and edges of other kernels are wide, which are valid nowhere then.
    #[error(
        "{what} {size:.3e} at ({:.9}, {:.9}, {:.9}): other kernels take what is not more than \
         {least:.0e} apart for one",
        place[0], place[1], place[2]
    )]
    Thin {
        /// What it is.
        what: Thin,
        /// A point of it.
        place: [f64; 3],
        /// How long or wide it is, in the part's unit.
        size: f64,
        /// What it had to be more than.
        least: f64,
    },
}

/// Splines are within this part of the part's size of the curves they follow, where nothing is said.
pub const ACCURACY: f64 = 1.0 / 1_000_000.0;

/// Splines are this many times closer to their curves than is requested: what their distance makes of
/// a volume goes with the area next to it, which of a slender part is much.
const NEARER: f64 = 64.0;

/// The text of a file.
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
    product::product(&mut exchange, options, context, &solids);
    Ok(exchange.finish(options))
}
