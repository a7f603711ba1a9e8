//! A part found in a picture, and where it is.
//!
//! What the detector finds in a picture ([`picture`]) is matched with what is predicted of a part
//! ([`part`]).

pub mod astray;
pub mod camera;
pub mod clutter;
pub mod correspondence;
mod ends;
pub mod evidence;
pub mod explain;
pub mod finding;
mod framed;
pub mod hypotheses;
pub mod learned;
pub mod look;
pub mod part;
pub mod picture;
pub mod pose;
pub mod predicted;
pub mod report;
pub mod rounds;
pub mod search;
pub mod shape;
pub mod track;
pub mod worth;
