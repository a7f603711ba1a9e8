//! The items that most callers need: `use premio::prelude::*;`.
//!
//! # Examples
//!
//! ```
//! use premio::prelude::*;
//!
//! assert!((block(1, 2, 3).evaluate()?.volume() - 6.0).abs() < 1e-12);
//! # Ok::<(), premio::Error>(())
//! ```

pub use crate::{
    Camera, CameraFile, CancelToken, Colour, ContourKind, Curve, Detector, Drawing, DrawingOptions,
    EdgeRef, EvaluationOptions, ExactNumber, ExportSettings, Expression, FaceRef, Fineness, Format,
    Grey, ImageCurve, JunctionKind, Model, OffsetJoin, Operation, Paper, PartFinder, PartTracker,
    PictureMatch, Progress, Rational, ReadOptions, SearchOptions, Setup, Setups, SheetOptions,
    Sketch, Solid, SolidFormat, StandardView, Strategy, Surface, TriangleMesh, Unit, ValueOverride,
    VertexRef, View, ViewArc, block, cone, cylinder, disc, ellipsoid, frustum, half_space,
    infinite_cone, infinite_cylinder, oblique_frustum, polygon, polyhedron, rectangle, sphere,
    torus, wedge,
};
