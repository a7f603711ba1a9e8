//! Descriptions of solids: primitives, the tree of set operations, and the readers.
pub mod builder;
pub mod primitive;
pub mod reader;
pub mod tree;
