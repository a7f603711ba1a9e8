//! What divides an image into regions: the visible pieces of contours, the boundaries of cast shadows
//! and the outlines of highlights.

pub mod arc;
pub mod crossings;
pub mod flatten;
pub mod highlight;
pub mod pierce;
pub mod regions;
pub mod scanline;
pub mod shadow;
pub mod stage;

pub use arc::{Arc, Source};
pub use regions::{Region, Regions, Seen};
pub use stage::Stage;
