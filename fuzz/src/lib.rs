//! Parts generated from bytes, for the targets of the geometry.
//!
//! A few bytes give a small tree whose lengths lie on a half-unit grid, near it by any power of
//! two, or anywhere. So a change of one byte moves, rotates or scales one primitive, and
//! coincidences are frequent.

mod recipe;

use nalgebra::{Point3, Vector3};
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{ReadOptions, read};
use premio_csg::tree::Tree;
use premio_verify::generator::model::PartModel;
use premio_verify::generator::write::{Format, write};
use premio_visibility::ViewCamera;

pub use recipe::{Recipe, Sight};
use std::sync::LazyLock;

/// A block with a bore, for the targets of models and cameras.
pub static BORED_BLOCK: LazyLock<Evaluation> = LazyLock::new(|| {
    let text = "PART = BLO(X=6, Y=4, Z=2) DIF (CYL(R=1, H=4) AT (MOVX=3, MOVY=2, MOVZ=-1))";
    let format = premio_csg::reader::Format::Padl;
    let read = read("part", text.as_bytes(), format, &ReadOptions::default());
    evaluate(
        &read.expect("it is read").tree,
        &EvaluationOptions::default(),
    )
    .expect("it is simple")
});

/// A part to be tried.
#[derive(Debug)]
pub struct Part {
    /// The description, for the report of a failure.
    pub text: String,
    /// The tree of the description.
    pub tree: Tree,
    /// Its boundary.
    pub evaluation: Evaluation,
}

impl Part {
    /// The part of a model; none where it is refused, which is not a finding.
    pub fn new(model: &PartModel) -> Option<Self> {
        let text = write(model, Format::Padl);
        let json = write(model, Format::Json);
        let format = premio_csg::reader::Format::Json;
        let read = read("model", json.as_bytes(), format, &ReadOptions::default());
        let tree = read.ok()?.tree;
        let evaluation = evaluate(&tree, &EvaluationOptions::default()).ok()?;
        Some(Self {
            text,
            tree,
            evaluation,
        })
    }

    /// A camera that looks at the part; none along no direction.
    pub fn camera(&self, sight: &Sight) -> Option<ViewCamera> {
        let direction = Vector3::from(sight.direction);
        let bounds = &self.evaluation.bounds;
        let size = bounds.diagonal();
        let centre = bounds.centre();
        let up = match direction.x == 0.0 && direction.y == 0.0 {
            true => Vector3::y(),
            false => Vector3::z(),
        };
        let towards = direction.try_normalize(0.0)?;
        let eye = |distance: f64| centre + towards * (distance * size);
        match sight.distance {
            Some(distance) => ViewCamera::perspective(eye(distance), centre, up, 1.0).ok(),
            None => ViewCamera::orthographic(eye(1.0), centre, up).ok(),
        }
    }

    /// The k-th of points spread evenly over a box slightly larger than the part's (Halton's
    /// sequence).
    pub fn place(&self, k: u32) -> Point3<f64> {
        let bounds = &self.evaluation.bounds;
        let part = [2, 3, 5].map(|base| inverse(k + 1, base));
        let at = |i: usize| {
            let length = bounds.max[i] - bounds.min[i];
            bounds.min[i] + length * (1.1 * part[i] - 0.05)
        };
        Point3::new(at(0), at(1), at(2))
    }
}

/// The radical inverse of a number in a base: its digits reversed behind the point.
fn inverse(mut n: u32, base: u32) -> f64 {
    let (mut value, mut digit) = (0.0, 1.0);
    while n > 0 {
        digit /= f64::from(base);
        value += digit * f64::from(n % base);
        n /= base;
    }
    value
}
