//! Numbers, motions, surfaces, curves and the boundary representation of PREMIO.
pub mod motion;
pub mod number;
