//! Texts from outside, and texts for other programs.
//!
//! JSON and TOML become one tree of values that know their places in the text ([`Value`]), from which
//! typed values are read ([`Document::read`]): an array too long, an unknown key, a number that is not
//! finite are errors at their place. [`escape`] writes any text so that a terminal or a format takes it.

mod deserializer;
mod document;
pub mod escape;
mod json;
mod number;
mod place;
mod toml_text;
mod value;

pub use document::Document;
pub use number::number;
pub use place::{LineColumn, nearest};
pub use value::{Content, Member, TextError, Value};
