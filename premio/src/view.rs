//! The view of a solid from a camera.

use crate::check::{ConfirmedContours, confirmed_contours};
use crate::topology::{EdgeRef, FaceRef};
use crate::write::{json_text, whole_file};
use crate::{Camera, Error, Result, Solid};
use nalgebra::Point3;
use premio_drawing::{Drawing, DrawingOptions, dxf, svg};
use premio_kernel::geometry::curve::Curve;
use premio_visibility::camera::projection::Projection;
use premio_visibility::contours::{
    Contour, ContourKind, ContourPiece, Contours, ImageCurve, Junction,
};
use std::fmt;
use std::path::Path;
use std::sync::Arc;

/// The contours of a solid for a camera, from [`Solid::view`].
///
/// A contour is the image of an edge or of a limb. Junctions divide it into arcs of constant
/// visibility. A view is `Send` and `Sync`, and a clone is cheap.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let view = cylinder(1, 3).evaluate()?.view(&Camera::orthographic([1.0, 0.0, 1.0]))?;
/// let limbs = view.visible().filter(|arc| arc.kind() == ContourKind::Limb);
/// assert_eq!(limbs.count(), 2);
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone)]
pub struct View(Arc<ViewData>);

struct ViewData {
    solid: Solid,
    contours: Contours,
    projection: Projection,
}

/// Shows the counts of its arcs and junctions.
impl fmt::Debug for View {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("View")
            .field("visible", &self.visible().count())
            .field("hidden", &self.hidden().count())
            .field("junctions", &self.junctions().len())
            .finish_non_exhaustive()
    }
}

impl View {
    pub(crate) fn new(solid: &Solid, camera: &Camera) -> Result<Self> {
        let camera = camera.resolve(solid)?;
        let contours = match confirmed_contours(solid.tree(), solid.evaluation(), &camera)? {
            ConfirmedContours::Confirmed(contours) => *contours,
            ConfirmedContours::Contradicted(detail) => {
                return Err(Error::UncertainView { detail });
            }
            ConfirmedContours::Limited(limit) => return Err(Error::ViewLimit(limit)),
        };
        Ok(Self(Arc::new(ViewData {
            solid: solid.clone(),
            contours,
            projection: Projection::new(&camera, 1.0),
        })))
    }

    /// All arcs, each of constant visibility.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = block(6, 4, 2).evaluate()?.view(&Camera::orthographic([1.0, 1.0, 1.0]))?;
    /// assert_eq!(view.arcs().count(), view.visible().count() + view.hidden().count());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn arcs(&self) -> impl Iterator<Item = ViewArc<'_>> {
        self.0.contours.contours.iter().flat_map(|contour| {
            let pieces = contour.pieces.iter();
            pieces.map(|piece| ViewArc {
                view: self,
                contour,
                piece,
            })
        })
    }

    /// The visible arcs that a drawing shows: without smooth edges.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = sphere(1).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// assert_eq!(view.visible().count(), 1);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn visible(&self) -> impl Iterator<Item = ViewArc<'_>> {
        self.arcs()
            .filter(|arc| arc.is_visible() && !arc.is_smooth())
    }

    /// The hidden arcs that a drawing shows: without smooth edges.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = block(6, 4, 2).evaluate()?.view(&Camera::orthographic([1.0, 2.0, 3.0]))?;
    /// assert!(view.hidden().all(|arc| arc.quantitative_invisibility() > 0));
    /// assert!(view.hidden().count() >= 3);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn hidden(&self) -> impl Iterator<Item = ViewArc<'_>> {
        self.arcs()
            .filter(|arc| !arc.is_visible() && !arc.is_smooth())
    }

    /// The junctions: where arcs end.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let post = block(6, 6, 1) + cylinder(1, 4).translate([3, 3, 0]);
    /// let view = post.evaluate()?.view(&Camera::orthographic([3.0, -4.0, 2.0]))?;
    /// assert!(view.junctions().iter().any(|junction| junction.kind == JunctionKind::T));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn junctions(&self) -> &[Junction] {
        &self.0.contours.junctions
    }

    /// The contours with the camera, as `premio contours --format json` writes them.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = sphere(1).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// assert_eq!(view.contours().contours.len(), 1);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn contours(&self) -> &Contours {
        &self.0.contours
    }

    /// The solid that is seen.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = block(6, 4, 2).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// assert_eq!(view.solid().faces().count(), 6);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn solid(&self) -> &Solid {
        &self.0.solid
    }

    /// The line drawing, in which every line is drawn once.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = block(6, 4, 2).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// // The edges below have the same images as those above.
    /// assert_eq!(view.drawing(&DrawingOptions::default()).strokes.len(), 4);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn drawing(&self, options: &DrawingOptions) -> Drawing {
        Drawing::new(&self.0.contours, options)
    }

    /// The drawing as SVG, hidden lines dashed.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = sphere(1).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// assert!(view.to_svg().starts_with("<"));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn to_svg(&self) -> String {
        svg::write(&self.drawing(&DrawingOptions::default()))
    }

    /// The drawing as DXF, hidden lines dashed.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = sphere(1).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// assert!(view.to_dxf().contains("CIRCLE"));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn to_dxf(&self) -> String {
        dxf::write(&self.drawing(&DrawingOptions::default()))
    }

    /// The contours as JSON (`premio.contours/1`).
    ///
    /// # Errors
    /// A number is not finite.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = sphere(1).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// assert!(view.to_json()?.starts_with(r#"{"schema":"premio.contours/1""#));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn to_json(&self) -> Result<String> {
        json_text(&self.0.contours)
    }

    /// Writes the drawing as SVG. The file appears whole or not at all.
    ///
    /// # Errors
    /// The file cannot be written.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// # let folder = tempfile::tempdir().unwrap();
    /// # std::env::set_current_dir(&folder).unwrap();
    /// let view = sphere(1).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// view.write_svg("ball.svg")?;
    /// assert_eq!(std::fs::read_to_string("ball.svg").unwrap(), view.to_svg());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn write_svg(&self, path: impl AsRef<Path>) -> Result<()> {
        whole_file(path.as_ref(), self.to_svg())
    }

    /// Writes the drawing as DXF. The file appears whole or not at all.
    ///
    /// # Errors
    /// The file cannot be written.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// # let folder = tempfile::tempdir().unwrap();
    /// # std::env::set_current_dir(&folder).unwrap();
    /// let view = sphere(1).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// view.write_dxf("ball.dxf")?;
    /// assert!(view.write_dxf("no such folder/ball.dxf").is_err());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn write_dxf(&self, path: impl AsRef<Path>) -> Result<()> {
        whole_file(path.as_ref(), self.to_dxf())
    }

    /// Writes the view in the format that the file's ending names: `.svg`, `.dxf` or `.json`. The
    /// file appears whole or not at all.
    ///
    /// # Errors
    /// The ending names no format, or the file cannot be written.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// # let folder = tempfile::tempdir().unwrap();
    /// # std::env::set_current_dir(&folder).unwrap();
    /// let view = sphere(1).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// view.write("ball.dxf")?;
    /// assert!(matches!(view.write("ball.txt"), Err(premio::Error::UnknownFormat { .. })));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let ending = path.extension().map(|e| e.to_ascii_lowercase());
        match ending.as_ref().and_then(|e| e.to_str()) {
            Some("svg") => self.write_svg(path),
            Some("dxf") => self.write_dxf(path),
            Some("json") => whole_file(path, self.to_json()? + "\n"),
            _ => Err(Error::UnknownFormat {
                path: path.to_owned(),
                expected: ".svg, .dxf or .json",
            }),
        }
    }
}

/// A piece of a contour between two junctions, with constant visibility.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let view = sphere(2).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
/// let limb = view.visible().next().unwrap();
/// assert_eq!(limb.kind(), ContourKind::Limb);
/// assert!(matches!(limb.image_curve(), ImageCurve::Conic { .. }));
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone, Copy)]
pub struct ViewArc<'v> {
    view: &'v View,
    contour: &'v Contour,
    piece: &'v ContourPiece,
}

impl fmt::Debug for ViewArc<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("ViewArc")
            .field("contour", &self.contour.id)
            .field("kind", &self.contour.kind)
            .field("range", &self.range())
            .field(
                "quantitative_invisibility",
                &self.quantitative_invisibility(),
            )
            .finish_non_exhaustive()
    }
}

impl<'v> ViewArc<'v> {
    /// Whether no face occludes the arc.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = sphere(2).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// assert!(view.arcs().all(|arc| arc.is_visible()));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn is_visible(self) -> bool {
        self.piece.visible
    }

    /// The number of faces turned towards the eye that lie in front of the arc.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// // A small block behind two walls.
    /// let wall = |y: i32| block(9, 1, 9).translate([0, y, 0]);
    /// let part = wall(0) + wall(2) + block(1, 1, 1).translate([4, 4, 4]);
    /// let view = part.evaluate()?.view(&Camera::orthographic([0.0, -1.0, 0.0]))?;
    /// assert_eq!(view.arcs().map(|arc| arc.quantitative_invisibility()).max(), Some(3));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn quantitative_invisibility(self) -> u32 {
        self.piece.quantitative_invisibility
    }

    /// The face in front of the arc that is nearest to the eye.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = block(6, 4, 2).evaluate()?.view(&Camera::orthographic([1.0, 1.0, 1.0]))?;
    /// assert!(view.arcs().all(|arc| arc.is_visible() == arc.occluder().is_none()));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn occluder(self) -> Option<FaceRef<'v>> {
        let face = self.piece.occluder?;
        Some(FaceRef::new(self.view.0.solid.brep(), face))
    }

    /// Whether the arc is of an edge or of a limb.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = block(6, 4, 2).evaluate()?.view(&Camera::orthographic([1.0, 1.0, 1.0]))?;
    /// assert!(view.arcs().all(|arc| arc.kind() == ContourKind::Edge));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn kind(self) -> ContourKind {
        self.contour.kind
    }

    /// Whether the arc is of a smooth edge.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let pin = (cylinder(1, 3) + sphere(1)).evaluate()?;
    /// let view = pin.view(&Camera::orthographic([1.0, 0.0, 0.2]))?;
    /// assert!(view.arcs().any(|arc| arc.is_smooth()));
    /// assert!(!view.visible().any(|arc| arc.is_smooth()));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn is_smooth(self) -> bool {
        self.contour.smooth
    }

    /// The edge, unless the arc is of a limb inside a face.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = block(6, 4, 2).evaluate()?.view(&Camera::orthographic([1.0, 1.0, 1.0]))?;
    /// let edges = view.visible().filter_map(|arc| arc.edge());
    /// assert_eq!(edges.count(), 9);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn edge(self) -> Option<EdgeRef<'v>> {
        let edge = self.contour.edge?;
        Some(EdgeRef::new(self.view.0.solid.brep(), edge))
    }

    /// The faces along the arc; of a limb inside a face that face, twice.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = sphere(2).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// assert_eq!(view.visible().next().unwrap().faces().count(), 2);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn faces(self) -> impl Iterator<Item = FaceRef<'v>> {
        let brep = self.view.0.solid.brep();
        let faces = self.contour.faces.iter();
        faces.map(move |&id| FaceRef::new(brep, id))
    }

    /// The curve in the image.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = block(6, 4, 2).evaluate()?.view(&Camera::orthographic([1.0, 1.0, 1.0]))?;
    /// assert!(view.arcs().all(|arc| matches!(arc.image_curve(), ImageCurve::Line { .. })));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn image_curve(self) -> &'v ImageCurve {
        &self.contour.image_curve
    }

    /// The curve in space.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = sphere(2).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// assert!(matches!(view.visible().next().unwrap().space_curve(), Curve::Circle(_)));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn space_curve(self) -> &'v Curve {
        &self.contour.space_curve
    }

    /// The range of the space curve's parameter, increasing; it may pass the end of a period.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = block(6, 4, 2).evaluate()?.view(&Camera::orthographic([1.0, 1.0, 1.0]))?;
    /// assert!(view.arcs().all(|arc| arc.range()[0] < arc.range()[1]));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn range(self) -> [f64; 2] {
        self.piece.range
    }

    /// The junctions at the start and the end; none of a whole closed contour.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = block(6, 4, 2).evaluate()?.view(&Camera::orthographic([1.0, 1.0, 1.0]))?;
    /// assert!(view.arcs().all(|arc| arc.junctions().iter().all(Option::is_some)));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn junctions(self) -> [Option<&'v Junction>; 2] {
        let ends = [self.piece.start, self.piece.end];
        ends.map(|id| id.and_then(|id| self.view.0.contours.junctions.get(id as usize)))
    }

    /// Points in the image, evenly spread over the inside of the range.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = sphere(2).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// let limb = view.visible().next().unwrap();
    /// assert!(limb.image_points(9).iter().all(|[x, y]| (x.hypot(*y) - 2.0).abs() < 1e-12));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn image_points(self, count: usize) -> Vec<[f64; 2]> {
        let points = self.space_points(count).into_iter();
        let project = |p| self.view.0.projection.project(&Point3::from(p)).into();
        points.map(project).collect()
    }

    /// Points in space, evenly spread over the inside of the range.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let view = sphere(2).evaluate()?.view(&Camera::orthographic([0.0, 0.0, 1.0]))?;
    /// let limb = view.visible().next().unwrap();
    /// assert!(limb.space_points(9).iter().all(|p| p[2].abs() < 1e-12));
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn space_points(self, count: usize) -> Vec<[f64; 3]> {
        let [lo, hi] = self.range();
        let at = |k: usize| lo + (hi - lo) * ((k as f64 + 0.5) / count as f64);
        let points = (0..count).map(|k| self.space_curve().point(at(k)).into());
        points.collect()
    }
}
