//! The image formation: radiance, coverage of pixels, blur, noise and grey levels.

pub(crate) mod bitmap;
pub(crate) mod blur;
pub(crate) mod exposure;
mod field;
pub(crate) mod response;
pub mod shading;
