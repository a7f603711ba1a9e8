//! Solids with their exact boundary.

use crate::check::checked;
use crate::topology::{EdgeRef, FaceRef, VertexRef};
use crate::{Camera, Error, Expression, Result, View};
use nalgebra::Point3;
use premio_csg::evaluate::{Evaluation, EvaluationOptions, face_colours};
use premio_csg::object_model::ObjectModel;
use premio_csg::recover::Recovery;
use premio_csg::tree::Tree;
use premio_kernel::brep::Brep;
use premio_kernel::brep::point_in_solid::contains;
use premio_kernel::brep::topology::VertexId;
use premio_kernel::colour::Colour;
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::number::predicates::{CloseCall, CoincidencePolicy, DecisionStats};
use premio_predict::model::record::DescriptionRecord;
use premio_verify::checks::CheckReport;
use std::fmt;
use std::sync::Arc;

/// A solid with its exact boundary, from [`Expression::evaluate`].
///
/// A solid never changes. It is `Send` and `Sync`, and a clone is cheap.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let solid = (block(6, 4, 2) - cylinder(1, 4).translate([3, 2, -1])).evaluate()?;
/// assert!((solid.volume() - (48.0 - 2.0 * std::f64::consts::PI)).abs() < 1e-12);
/// assert_eq!(solid.faces().count(), 7);
/// let other = solid.clone();
/// let area = std::thread::spawn(move || other.area()).join().unwrap();
/// assert_eq!(area, solid.area());
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone)]
pub struct Solid(Arc<SolidData>);

/// The place of a solid.
pub(crate) struct SolidExtent {
    /// The middle of its box.
    pub middle: Point3<f64>,
    /// The diagonal of its box.
    pub size: f64,
}

struct SolidData {
    tree: Tree,
    evaluation: Evaluation,
    recovery: Option<Recovery>,
    expression: Expression,
    options: EvaluationOptions,
}

/// Shows the counts of its faces, edges and vertices.
impl fmt::Debug for Solid {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Solid")
            .field("faces", &self.faces().count())
            .field("edges", &self.edges().count())
            .field("vertices", &self.vertices().count())
            .finish_non_exhaustive()
    }
}

impl Solid {
    pub(crate) fn new(
        tree: Tree,
        evaluation: Evaluation,
        recovery: Option<Recovery>,
        expression: Expression,
        options: &EvaluationOptions,
    ) -> Self {
        Self(Arc::new(SolidData {
            tree,
            evaluation,
            recovery,
            expression,
            options: *options,
        }))
    }

    /// The relations between primitives that the rounding of the coordinates had destroyed, and that
    /// were recovered before the evaluation; none if the coordinates are not rounded.
    ///
    /// # Examples
    ///
    /// ```
    /// assert!(premio::block(6, 4, 2).evaluate()?.recovery().is_none());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn recovery(&self) -> Option<&Recovery> {
        self.0.recovery.as_ref()
    }

    /// The volume, in cubic units.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(6, 4, 2).evaluate()?;
    /// assert!((solid.volume() - 48.0).abs() < 1e-12);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn volume(&self) -> f64 {
        self.0.evaluation.mass().volume
    }

    /// The area of the boundary, in square units.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(6, 4, 2).evaluate()?;
    /// assert!((solid.area() - 88.0).abs() < 1e-12);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn area(&self) -> f64 {
        self.0.evaluation.mass().area
    }

    /// The centroid.
    ///
    /// # Examples
    ///
    /// ```
    /// let [x, y, z] = premio::block(6, 4, 2).evaluate()?.centroid();
    /// assert!((x - 3.0).abs() + (y - 2.0).abs() + (z - 1.0).abs() < 1e-12);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn centroid(&self) -> [f64; 3] {
        self.0.evaluation.mass().centroid.into()
    }

    /// The smallest axis-parallel box; of the empty solid a point at the origin.
    ///
    /// # Examples
    ///
    /// ```
    /// let bounds = premio::torus(5, 1).evaluate()?.bounds();
    /// assert!((bounds.max[0] - 6.0).abs() < 1e-12 && (bounds.min[2] + 1.0).abs() < 1e-12);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn bounds(&self) -> Aabb {
        match self.is_empty() {
            true => Aabb {
                min: [0.0; 3],
                max: [0.0; 3],
            },
            false => self.0.evaluation.tight_bounds(),
        }
    }

    /// Whether the solid has no faces.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// assert!((block(1, 1, 1) - block(2, 2, 2)).evaluate()?.is_empty());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn is_empty(&self) -> bool {
        self.brep().topology.faces.is_empty()
    }

    /// How many connected solids there are.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let pair = sphere(1) + sphere(1).translate([3, 0, 0]);
    /// assert_eq!(pair.evaluate()?.component_count(), 2);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn component_count(&self) -> usize {
        self.brep().topology.solids.len()
    }

    /// The genus of each shell.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// // The void in the ball has a shell of its own.
    /// assert_eq!((sphere(3) - torus(2, "0.5")).evaluate()?.genus(), [0, 1]);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn genus(&self) -> Vec<i32> {
        let shells = self.brep().topology.shells.iter();
        shells.map(|shell| shell.genus).collect()
    }

    /// The faces: maximal connected pieces of one surface.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::cylinder(1, 2).evaluate()?;
    /// let kinds: Vec<_> = solid.faces().map(|face| face.surface().kind().name()).collect();
    /// assert_eq!(kinds.iter().filter(|kind| **kind == "plane").count(), 2);
    /// assert_eq!(kinds.len(), 3);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn faces(&self) -> impl Iterator<Item = FaceRef<'_>> {
        let ids = self.brep().topology.face_ids();
        ids.map(|id| FaceRef::new(self.brep(), id))
    }

    /// The edges: pieces of curves between faces.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::cylinder(1, 2).evaluate()?;
    /// assert!(solid.edges().all(|edge| edge.is_closed() && edge.curve().name() == "circle"));
    /// assert_eq!(solid.edges().count(), 2);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn edges(&self) -> impl Iterator<Item = EdgeRef<'_>> {
        let ids = self.brep().topology.edge_ids();
        ids.map(|id| EdgeRef::new(self.brep(), id))
    }

    /// The vertices: points where edges end.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(6, 4, 2).evaluate()?;
    /// assert!(solid.vertices().any(|vertex| vertex.point() == [6.0, 4.0, 2.0]));
    /// assert_eq!(solid.vertices().count(), 8);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn vertices(&self) -> impl Iterator<Item = VertexRef<'_>> {
        let ids = (0..self.brep().topology.vertices).map(VertexId);
        ids.map(|id| VertexRef::new(self.brep(), id))
    }

    /// Whether a point is in the material. A point within the resolution of the boundary counts as
    /// inside.
    ///
    /// # Examples
    ///
    /// ```
    /// let ring = premio::torus(5, 1).evaluate()?;
    /// assert!(ring.contains([5.0, 0.5, 0.0]));
    /// assert!(!ring.contains([0.0, 0.0, 0.0]));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn contains(&self, point: [f64; 3]) -> bool {
        let resolution = self.0.evaluation.f64_resolution();
        let bounds = self.0.evaluation.bounds.grown(resolution);
        let inside = (0..3).all(|i| (bounds.min[i]..=bounds.max[i]).contains(&point[i]));
        let on = || contains(self.brep(), &Point3::from(point), resolution).unwrap_or(true);
        inside && !self.is_empty() && on()
    }

    /// The resolution: the distance within which points coincide, in the solid's unit.
    ///
    /// # Examples
    ///
    /// ```
    /// let resolution = premio::block(6, 4, 2).evaluate()?.resolution();
    /// assert!(resolution < 1e-10);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn resolution(&self) -> f64 {
        self.0.evaluation.resolution
    }

    /// The close calls: decisions within a factor of a hundred of the resolution, with their
    /// positions.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let gap = block(1, 1, 1) + block(1, 1, 1).translate(["1.0000000001", "0", "0"]);
    /// let solid = gap.evaluate()?;
    /// assert!(!solid.close_calls().is_empty());
    /// assert!(solid.close_calls().iter().all(|call| call.distance.abs() < 1e-8));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn close_calls(&self) -> &[CloseCall] {
        &self.0.evaluation.decisions.close_calls
    }

    /// The numbers of decisions by arithmetic.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(6, 4, 2).evaluate()?;
    /// assert!(solid.decisions().filtered > 0);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn decisions(&self) -> &DecisionStats {
        &self.0.evaluation.decisions
    }

    /// Runs every self-check: the rules of the boundary, the volume and the box by rays, the pieces
    /// and contours of several views, their drawings, and the files, read back.
    ///
    /// `rays` rays measure the volume; the program uses 20 000.
    ///
    /// # Examples
    ///
    /// ```
    /// let report = premio::block(6, 4, 2).evaluate()?.check(2000);
    /// assert!(report.passes(), "{report}");
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn check(&self, rays: usize) -> CheckReport {
        checked(&self.0.tree, &self.0.evaluation, rays)
    }

    /// The contours for a camera.
    ///
    /// # Errors
    /// The camera is invalid, its eye lies in the material or too far away, or f64 cannot separate
    /// the surfaces of the solid, and rays contradict the view.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = block(6, 4, 2).evaluate()?.view(&Camera::orthographic([1.0, -1.0, 1.0]))?;
    /// assert_eq!(view.visible().count(), 9);
    /// // The three edges behind, divided where others cross before them.
    /// assert!(view.hidden().count() >= 3);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn view(&self, camera: &Camera) -> Result<View> {
        View::new(self, camera)
    }

    /// The topological object model: solids, shells, faces, boundaries, arcs and their relations.
    /// It is what `premio export --format json` writes.
    ///
    /// # Examples
    ///
    /// ```
    /// let model = premio::block(6, 4, 2).evaluate()?.object_model();
    /// assert_eq!((model.faces.len(), model.arcs.len()), (6, 12));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn object_model(&self) -> ObjectModel {
        ObjectModel::new(self.brep())
    }

    /// The boundary representation.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(6, 4, 2).evaluate()?;
    /// assert_eq!(solid.brep().topology.loops.len(), 6);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn brep(&self) -> &Brep {
        &self.0.evaluation.brep
    }

    /// The evaluation: the boundary with the decisions that it rests on.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(6, 4, 2).evaluate()?;
    /// assert!(solid.evaluation().violations().is_empty());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn evaluation(&self) -> &Evaluation {
        &self.0.evaluation
    }

    /// The colour of every face, in the order of the faces, as an OpenSCAD file gives it; empty if no
    /// primitive has a colour. STEP, glTF and 3MF files have them.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let text = "union() { color([1, 0, 0, 1]) { cube(size = 2); } sphere(r = 1); }";
    /// let solid = premio::read_text(text, Format::Csg)?.evaluate()?;
    /// let red = solid.face_colours().iter().flatten().count();
    /// assert_eq!((red, solid.faces().count()), (6, 7));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn face_colours(&self) -> Vec<Option<Colour>> {
        face_colours(&self.0.tree, &self.0.evaluation)
    }

    /// The tree that was evaluated.
    ///
    /// # Examples
    ///
    /// ```
    /// let solid = premio::block(6, 4, 2).evaluate()?;
    /// assert_eq!(solid.tree().leaves().count(), 1);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn tree(&self) -> &Tree {
        &self.0.tree
    }

    /// The expression that was evaluated.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = block(6, 4, 2).evaluate()?;
    /// let half = solid.expression().clone() & block(3, 4, 2);
    /// assert!((half.evaluate()?.volume() - 24.0).abs() < 1e-12);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn expression(&self) -> &Expression {
        &self.0.expression
    }

    /// The description that a model carries.
    pub(crate) fn record(&self) -> Option<DescriptionRecord> {
        let options = &self.0.options;
        self.0.expression.record().map(|record| DescriptionRecord {
            resolution: options.resolution,
            exact: options.zeros == CoincidencePolicy::Exact,
            ..record
        })
    }

    pub(crate) fn view_resolution(&self) -> Result<f64> {
        self.0.evaluation.view_resolution().ok_or(Error::NoView)
    }

    /// The middle of the solid and its size; a point at the origin counts as of size one.
    pub(crate) fn extent(&self) -> SolidExtent {
        match self.is_empty() {
            true => SolidExtent {
                middle: Point3::origin(),
                size: 1.0,
            },
            false => {
                let bounds = self.bounds();
                SolidExtent {
                    middle: bounds.centre(),
                    size: bounds.diagonal(),
                }
            }
        }
    }
}
