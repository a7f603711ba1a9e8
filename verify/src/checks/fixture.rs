//! A part seen from the front, for the tests of checks.

use premio_csg::boundary::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, Options, read};
use premio_csg::tree::Tree;
use premio_drawing::Drawing;
use premio_drawing::sheet::View;
use premio_kernel::geometry::bounds::Box3;
use premio_visibility::{Camera, Contours, contours};

/// A part and its front view.
pub(super) struct FrontView {
    pub tree: Tree,
    pub bounds: Box3,
    pub camera: Camera,
    pub seen: Contours,
    pub drawing: Drawing,
}

/// The front view of a part in PADL.
pub(super) fn front_view(text: &str) -> FrontView {
    let (format, options) = (Format::Padl, Options::default());
    let tree = read("part", text.as_bytes(), format, &options)
        .unwrap()
        .tree;
    let known = evaluate(&tree, &EvaluationOptions::default()).unwrap();
    let bounds = known.tight_bounds();
    let camera = View::Front
        .camera(bounds.centre(), bounds.diagonal())
        .unwrap();
    let seen = contours(&known.brep, &camera, known.resolution).unwrap();
    let drawing = Drawing::new(&seen, &premio_drawing::Options::default());
    FrontView {
        tree,
        bounds,
        camera,
        seen,
        drawing,
    }
}
