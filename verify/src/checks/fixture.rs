//! A part with its front view, for the tests of checks.

use premio_csg::evaluate::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_csg::tree::Tree;
use premio_drawing::Drawing;
use premio_drawing::sheet::StandardView;
use premio_kernel::geometry::bounds::Aabb;
use premio_visibility::{Contours, ViewCamera, contours};

/// A part and its front view.
pub(super) struct FrontView {
    pub tree: Tree,
    pub bounds: Aabb,
    pub camera: ViewCamera,
    pub seen: Contours,
    pub drawing: Drawing,
}

/// The tree of a part in PADL.
pub(super) fn tree(text: &str) -> Tree {
    let options = ReadOptions::default();
    let part = read("part", text.as_bytes(), Format::Padl, &options);
    part.unwrap().tree
}

/// The front view of a part in PADL.
pub(super) fn front_view(text: &str) -> FrontView {
    let tree = tree(text);
    let known = evaluate(&tree, &EvaluationOptions::default()).unwrap();
    let bounds = known.tight_bounds();
    let camera = StandardView::Front
        .camera(bounds.centre(), bounds.diagonal())
        .unwrap();
    let seen = contours(&known.brep, &camera, known.resolution).unwrap();
    let drawing = Drawing::new(&seen, &premio_drawing::DrawingOptions::default());
    FrontView {
        tree,
        bounds,
        camera,
        seen,
        drawing,
    }
}
