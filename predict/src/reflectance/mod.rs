//! The physical object model: the share of the incident light that a surface reflects to the
//! sensor.
//!
//! The model of Cook and Torrance (ACM Transactions on Graphics 1, 1982), with the Fresnel term for
//! light that is polarised of Yi, Haralick and Shapiro (PREMIO, section 3.1.2): of each light the
//! reflected radiance is its irradiance, with the cosine N·L in it, times `s R_s + d R_d`; the
//! ambient light is reflected by `R_a`. Angles and formulas are those of the literature where the
//! printed ones are damaged; each function says its own.

mod dispersion;
mod library;
mod material;
mod microfacet;
mod optics;
mod surface;

pub(crate) use library::GREEN;
pub use library::Named;
pub use material::{Constants, Material, SpecularForm};
pub(crate) use optics::{Optics, Polarisation};
pub(crate) use surface::SurfaceFinish;

#[cfg(test)]
mod tests;
