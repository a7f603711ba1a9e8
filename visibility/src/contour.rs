//! The contours for a viewpoint, as they are handed on (`premio.contours/1`).

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

/// Where pieces of contours end.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum JunctionKind {
    /// A vertex of the part, or the apex of a cone.
    Vertex,
    /// Two contours cross in the image, one before the other in space (definition 4.4).
    T,
    /// The line of sight is along the limb (definition 4.5).
    Cusp,
    /// A limb ends on the boundary of its face.
    Limb,
    /// A limb crosses itself in space.
    #[serde(rename = "node")]
    SelfCrossing,
    /// The image of the curve turns back on itself.
    #[serde(rename = "turn")]
    ImageTurn,
    /// The near plane cuts the contour.
    #[serde(rename = "cut")]
    NearPlane,
}

/// A point where pieces of contours end.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Junction {
    /// Its place in the list.
    pub id: u32,
    /// What happens there.
    pub kind: JunctionKind,
    /// Its place in the image, in the camera's unit.
    pub point2: [f64; 2],
    /// Its place in space; at a T-junction, on the contour behind.
    pub point3: [f64; 3],
    /// The contours that meet there; at a T-junction the nearer one first.
    pub contours: Vec<u32>,
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

/// A piece of a contour between two junctions: one visibility.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContourPiece {
    /// The range of the curve's parameter, increasing; it may pass the end of a period.
    pub t: [f64; 2],
    /// Whether nothing lies before it.
    pub visible: bool,
    /// How many faces turned towards the eye lie before it.
    pub qi: u32,
    /// The one of them nearest to the eye.
    pub occluder: Option<FaceId>,
    /// The junction at its start; none for a whole closed contour.
    pub start: Option<u32>,
    /// The junction at its end.
    pub end: Option<u32>,
    /// Points of it, where asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub samples: Option<Vec<[f64; 3]>>,
}

/// A contour: the projection of an edge, of a part of one, or of a limb inside a face.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contour {
    /// Its place in the list.
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
    #[serde(serialize_with = "json::curve")]
    pub curve3: Curve,
    /// The curve in the image.
    pub curve2: ImageCurve,
    /// Its pieces, in order; none where all of it lies behind the near plane.
    pub pieces: Vec<ContourPiece>,
}

/// How long the steps took, in seconds.
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
    /// What lies this near to each other coincides, in the part's unit.
    pub resolution: f64,
    /// The contours.
    pub contours: Vec<Contour>,
    /// The junctions.
    pub junctions: Vec<Junction>,
    /// How long it took.
    pub seconds: ContourSeconds,
}

impl Contours {
    /// Puts `n` points, spread over the inside of each piece, into its samples.
    pub fn sample(&mut self, n: usize) {
        for contour in &mut self.contours {
            for piece in &mut contour.pieces {
                let [lo, hi] = piece.t;
                let at = |k: usize| lo + (hi - lo) * ((k as f64 + 0.5) / n as f64);
                let points = (0..n).map(|k| contour.curve3.point(at(k)).into());
                piece.samples = Some(points.collect());
            }
        }
    }
}
