//! Descriptions of solids: primitives, the tree of set operations, the readers, and the writers.
pub mod boundary;
pub mod builder;
pub mod model;
pub mod moves;
pub mod primitive;
pub mod rays;
pub mod reader;
pub mod tree;
pub mod writer;
