//! Surfaces and curves: the geometry attached to the entities of a boundary.

pub mod bivariate_trig_poly;
mod blow_up;
pub mod bounds;
pub mod curve;
pub mod curve_plane;
pub mod curve_surface;
pub mod elliptic_surface;
mod float_intersections;
pub mod frame;
mod implicit_on_curve;
pub mod intersect;
pub mod json;
pub mod quadric_curve;
pub mod region_of_interest;
pub mod sense;
mod singular;
pub mod surface;
pub mod surface_pair;
mod torus_circles;
pub mod torus_curve;
mod torus_grid;
pub(crate) mod torus_parameter;
pub mod trace;
mod tracer;
pub(crate) mod trigonometric;
pub mod unresolved;
pub mod vector;
