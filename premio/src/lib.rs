//! Exact solids from set operations, their views and drawings, the features that a sensor and a
//! detector will find of them, and their poses in pictures.
//!
//! ```
//! # let folder = tempfile::tempdir().unwrap();
//! # std::env::set_current_dir(&folder).unwrap();
//! use premio::prelude::*;
//! let plate = block(60.0, 40.0, 20.0) - cylinder(8.0, 30.0).translate([30.0, 20.0, -5.0]);
//! let solid = plate.evaluate()?;                      // the exact boundary
//! assert!((solid.volume() - (48000.0 - 1280.0 * std::f64::consts::PI)).abs() < 1e-6);
//! let view = solid.view(&Camera::orthographic([1.0, -1.0, 1.0]))?;
//! for arc in view.visible() { println!("{:?}", arc.image_curve()); }
//! solid.write_step("plate.step")?; view.write_svg("plate.svg")?;
//! # assert!(std::path::Path::new("plate.step").exists());
//! # assert!(std::path::Path::new("plate.svg").exists());
//! # Ok::<(), premio::Error>(())
//! ```
//!
//! # A tour
//!
//! 1. An [`Expression`] says what a solid is. The functions [`block`], [`wedge`], [`cylinder`],
//!    [`cone`], [`frustum`], [`sphere`] and [`torus`] make primitives; `+`, `-` and `&` combine
//!    them; [`translate`](Expression::translate), [`rotate_x`](Expression::rotate_x) and the like
//!    move them. [`read`] makes an expression of a file. Lengths are exact numbers, see
//!    [`ExactNumber`]: `0.1` is one tenth.
//! 2. [`Expression::evaluate`] makes a [`Solid`]: its exact boundary. It has measures, faces, edges
//!    and vertices with their surfaces and curves, self-checks, meshes and files.
//! 3. [`Solid::view`] makes a [`View`] for a [`Camera`]: arcs of edges and limbs, each with its
//!    curve in the image, its curve in space and the number of faces that hide it.
//! 4. [`Solid::predict`] says which features a detector finds in a [`Setup`] of camera, lights and
//!    sensor. [`Model::train`] sums up many setups.
//! 5. [`PartFinder`] looks for a solid in pictures. A [`PartTracker`] follows it through a
//!    sequence.
//!
//! # Errors, progress, threads
//!
//! Every call that can fail returns [`Error`]. Long work takes a [`Progress`]: a callback for its
//! steps and a [`CancelToken`]. Solids, views and expressions are `Send` and `Sync`, never change,
//! and are cheap to clone.
//!
//! # Units
//!
//! A length has no unit before it is written: [`ExportSettings::unit`] and [`SheetOptions::unit`]
//! say what 1 is. Angles are degrees.
//!
//! # Which crate is for what
//!
//! This crate has no algorithm of its own. Who needs more than it has depends on one of these:
//!
//! | crate | for |
//! |---|---|
//! | `premio-kernel` | exact numbers, surfaces, curves and their intersections, the boundary representation |
//! | `premio-csg` | description languages, the tree of set operations, boundary evaluation |
//! | `premio-visibility` | contours, junctions, quantitative invisibility |
//! | `premio-drawing` | line drawings and sheets, SVG and DXF |
//! | `premio-exchange` | STEP, STL, OBJ, glTF and 3MF |
//! | `premio-detect` | the edge detector |
//! | `premio-predict` | reflectance, lights, sensor, predicted features, models |
//! | `premio-matching` | features of a picture, correspondences, poses |
//! | `premio-verify` | self-checks, random and realistic parts, trials |
//! | `premio-cli` | the program |

mod camera;
mod check;
mod error;
mod expression;
pub mod files;
mod find;
pub mod fuzz;
mod mesh;
mod model;
mod number;
mod picture;
mod predict;
pub mod prelude;
mod progress;
mod read;
mod sheet;
mod sketch;
mod solid;
mod topology;
mod view;
mod write;

pub use camera::Camera;
pub use error::{Error, Result};
pub use expression::{
    Expression, ExpressionError, block, cone, cylinder, ellipsoid, frustum, half_space,
    infinite_cone, infinite_cylinder, oblique_frustum, polyhedron, sphere, torus, wedge,
};
pub use find::{PartFinder, PartTracker, PictureMatch};
pub use mesh::{Fineness, TriangleMesh};
pub use model::{Model, shards};
pub use number::{ExactNumber, NumberError};
pub use picture::{
    JpegError, MAX_PIXELS, NetpbmError, PictureError, PictureFormat, PngError, decode_picture,
    draw_prediction, encode_picture, read_picture, write_picture,
};
pub use predict::{PredictionAgreement, read_setup, read_setups, rendered};
pub use progress::{CancelToken, Cancelled, Progress, ProgressStep};
pub use read::{read, read_bytes, read_text, read_with};
pub use sketch::{Sketch, disc, polygon, rectangle};
pub use solid::Solid;
pub use topology::{EdgeRef, FaceRef, VertexRef};
pub use view::{View, ViewArc};
pub use write::{ExportSettings, SolidFormat, sheet_to_dxf, sheet_to_svg};

pub use premio_csg::evaluate::{Arithmetic, Evaluation, EvaluationError, EvaluationOptions};
pub use premio_csg::figure::{Figure, OffsetJoin};
pub use premio_csg::lettering::Fonts;
pub use premio_csg::reader::{FacetLimit, Format, Includes, ReadOptions, ValueOverride};
pub use premio_csg::recover::rounding::Rounding;
pub use premio_csg::recover::{PrimitiveRelation, PrimitiveRelationCount, Recovery};
pub use premio_csg::tree::{Operation, Tree};
pub use premio_detect::{Detector, Grey};
pub use premio_drawing::sheet::{Paper, Sheet, SheetOptions, StandardView};
pub use premio_drawing::{Drawing, DrawingOptions};
pub use premio_kernel::colour::Colour;
pub use premio_kernel::concurrency::with_threads;
pub use premio_kernel::geometry::bounds::Aabb;
pub use premio_kernel::geometry::curve::Curve;
pub use premio_kernel::geometry::surface::Surface;
pub use premio_kernel::number::predicates::{CloseCall, CoincidencePolicy};
pub use premio_kernel::number::rational::Rational;
pub use premio_kernel::unit::Unit;
pub use premio_matching::camera::{CameraFile, Pinhole};
pub use premio_matching::image::detector as default_detector;
pub use premio_matching::output::report::{MatchReport, Pose};
pub use premio_matching::part::detectability_prior::DetectabilityPrior;
pub use premio_matching::search::Strategy;
pub use premio_matching::verification::part_match::SearchOptions;
pub use premio_predict::prediction::Prediction;
pub use premio_predict::setup::Setup;
pub use premio_predict::setup::setups::Setups;
pub use premio_verify::checks::CheckReport;
pub use premio_visibility::contours::{ContourKind, Contours, ImageCurve, Junction, JunctionKind};
