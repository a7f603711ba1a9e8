//! The contours for a viewpoint, as they are written (`premio.contours/1`).

mod builder;

pub use crate::contour_generator::junctions::{Junction, JunctionKind};
pub use crate::invisibility::ContourPiece;
pub use builder::{ViewError, contours, contours_with, part_size};

use crate::camera::ViewCamera;
use premio_kernel::brep::topology::{EdgeId, FaceId};
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::json;
use serde::Serialize;

/// The name of the format.
pub const SCHEMA: &str = "premio.contours/1";

/// What a contour is the projection of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ContourKind {
    /// An edge of the part (definition 4.1 of the paper).
    #[serde(rename = "boundary")]
    Edge,
    /// A curve along which the line of sight touches the part (definition 4.2): inside a face, or
    /// along a smooth edge whose faces are turned differently.
    Limb,
}

/// A curve in the image.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub enum ImageCurve {
    /// The contour is seen end-on.
    Point {
        /// Where.
        point: [f64; 2],
    },
    /// A straight line a x + b y + c = 0 with a² + b² = 1.
    Line {
        /// a, b, c.
        coefficients: [f64; 3],
    },
    /// A conic a x² + b x y + c y² + d x + e y + f = 0.
    Conic {
        /// a to f, the largest of magnitude one.
        coefficients: [f64; 6],
    },
    /// The projection of the curve in space, which has the same parameter.
    Projected,
}

/// A contour: the projection of an edge, of a part of one, or of a limb inside a face.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contour {
    /// Its index in the list.
    pub id: u32,
    /// What it is the projection of.
    pub kind: ContourKind,
    /// Whether it is a boundary along which the normal does not jump.
    pub smooth: bool,
    /// The faces along it; of a limb inside a face that face, for both of its sheets.
    pub faces: Vec<FaceId>,
    /// The edge, of a boundary and of a limb along a smooth edge.
    pub edge: Option<EdgeId>,
    /// The curve in space.
    #[serde(rename = "curve3", serialize_with = "json::curve")]
    pub space_curve: Curve,
    /// The curve in the image.
    #[serde(rename = "curve2")]
    pub image_curve: ImageCurve,
    /// Its pieces, in order; none where all of it lies behind the near plane.
    pub pieces: Vec<ContourPiece>,
}

/// The run times of the steps, in seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct ContourSeconds {
    /// Limbs and cusps.
    pub limbs: f64,
    /// Projection and junctions.
    pub junctions: f64,
    /// Quantitative invisibility.
    pub visibility: f64,
}

/// The contours for a viewpoint.
#[derive(Clone, Debug, Serialize)]
pub struct Contours {
    /// [`SCHEMA`].
    pub schema: &'static str,
    /// The viewpoint.
    pub camera: ViewCamera,
    /// The distance within which points coincide, in the part's unit.
    pub resolution: f64,
    /// The contours.
    pub contours: Vec<Contour>,
    /// The junctions.
    pub junctions: Vec<Junction>,
    /// The run times.
    pub seconds: ContourSeconds,
}

impl Contours {
    /// Sets the samples of each piece to `n` points spread over its inside.
    pub fn sample(&mut self, n: usize) {
        for contour in &mut self.contours {
            for piece in &mut contour.pieces {
                let [lo, hi] = piece.range;
                let at = |k: usize| lo + (hi - lo) * ((k as f64 + 0.5) / n as f64);
                let points = (0..n).map(|k| contour.space_curve.point(at(k)).into());
                piece.samples = Some(points.collect());
            }
        }
    }
}
