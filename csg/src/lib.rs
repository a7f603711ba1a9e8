//! Descriptions of solids: primitives, the tree of set operations, the readers, and the writers.
pub mod builder;
pub mod construction;
mod drawing_file;
pub mod evaluate;
pub mod figure;
mod height_field;
pub mod lettering;
pub mod mesh_file;
pub mod object_model;
pub mod polyhedron;
pub mod primitive;
pub mod ray_casting;
pub mod reader;
pub mod recover;
pub mod transform;
pub mod tree;
pub mod writer;
