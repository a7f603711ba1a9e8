//! What the sensor makes of the light: radiance, coverage of pixels, blur, noise and grey levels.

pub mod bitmap;
pub mod blur;
pub mod exposure;
mod field;
pub mod response;
pub mod shading;
