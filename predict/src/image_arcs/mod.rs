//! What divides an image into regions: the visible pieces of contours, the boundaries of cast shadows
//! and the outlines of highlights.

pub mod arc;
pub mod crossings;
pub mod flatten;
pub mod highlight;
pub mod lit_scene;
pub mod pierce;
pub mod regions;
pub mod scanline;
pub mod shadow;

pub use arc::{ArcSource, PredictedArc};
pub use lit_scene::LitScene;
pub use regions::{Region, RegionSample, Regions};
