//! Descriptions of solids: primitives, the tree of set operations, and the readers.
pub mod boundary;
pub mod builder;
pub mod model;
pub mod primitive;
pub mod rays;
pub mod reader;
pub mod tree;
