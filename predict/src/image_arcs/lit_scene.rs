//! The lit scene: a part in front of a camera and under its lights, with the views of all of them.

use super::arc::{ArcSource, PredictedArc};
use super::flatten::{FINE, FlatteningTolerance, ImageWindow, NearestPoint, flatten, shown};
use crate::prepared_part::{PreparedPart, SubjectError};
use crate::setup::light::{self, LightPlace};
use crate::setup::viewpoint::Matrices;
use crate::setup::{Setup, SetupError};
use nalgebra::{Point2, Point3, Vector3};
use premio_kernel::brep::topology::FaceId;
use premio_visibility::camera::projection::Projection;
use premio_visibility::camera::{CameraError, ViewCamera};
use premio_visibility::contours::{Contour, ContourPiece, Contours, ImageCurve, JunctionKind};
use premio_visibility::ray_casting::{FirstHit, OriginIncidence};
use premio_visibility::scene::Scene;
use premio_visibility::{ViewError, contours};
use std::collections::HashMap;

/// Why nothing can be predicted.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum StageError {
    /// The setup cannot be used.
    #[error(transparent)]
    Setup(#[from] SetupError),
    /// The camera has no view of the part.
    #[error("the camera: {0}")]
    View(ViewError),
    /// A light has no view of the part.
    #[error("light {0}, as an eye: {1}")]
    Light(usize, ViewError),
    /// The part cannot be seen from anywhere.
    #[error(transparent)]
    Subject(#[from] SubjectError),
    /// No part of the image shows the part.
    #[error("the camera sees nothing of the part: {0}")]
    OutOfSight(String),
}

impl StageError {
    /// The error of the setup with its key.
    pub fn setup_error(&self) -> Option<SetupError> {
        match self {
            Self::Setup(error) => Some(error.clone()),
            Self::View(error) => Some(no_view("camera", "eye", error)),
            Self::Light(i, error) => Some(no_view(&format!("light[{i}]"), "position", error)),
            Self::OutOfSight(why) => {
                let reason = format!("sees nothing of the part: {why}");
                Some(SetupError::value("camera", reason))
            }
            Self::Subject(_) => None,
        }
    }
}

/// A camera with its projection.
#[derive(Clone, Debug)]
pub(crate) struct Eye {
    /// The camera.
    pub camera: ViewCamera,
    /// Its projection.
    pub projection: Projection,
}

impl Eye {
    fn new(camera: ViewCamera, subject: &PreparedPart<'_>) -> Self {
        let projection = Projection::new(&camera, 2.0 * subject.radius);
        Self { camera, projection }
    }
}

/// A light with its eyes.
#[derive(Clone, Debug)]
pub(crate) struct LightEyes {
    /// The light.
    pub source: light::LightSource,
    /// Its eyes.
    pub eyes: Vec<Eye>,
}

/// The eyes of a setup: the camera's, and those of the lights. A light within the bounding ball of
/// the part has two eyes, which look in opposite directions.
#[derive(Clone, Debug)]
pub(crate) struct Eyes {
    /// The camera's matrices.
    pub matrices: Matrices,
    /// The camera.
    pub camera: Eye,
    /// The lights with their eyes.
    pub lights: Vec<LightEyes>,
}

impl Eyes {
    /// The eyes of a setup about a part.
    pub fn new(subject: &PreparedPart<'_>, setup: &Setup) -> Result<Self, StageError> {
        let eye = setup.camera.eye.map(Point3::from);
        if eye.is_some_and(|eye| subject.contains(&eye)) {
            return Err(SetupError::value("camera.eye", INSIDE).into());
        }
        let matrices = setup
            .camera
            .matrices(&setup.conditions.sensor, &subject.centre)?;
        let centre = -(matrices.r.transpose() * matrices.t);
        if eye.is_none() && subject.contains(&centre.into()) {
            return Err(SetupError::value("camera.t", INSIDE).into());
        }
        let mut lights = Vec::with_capacity(setup.lights.len());
        for (i, light) in setup.lights.iter().enumerate() {
            let source = light::LightSource::new(light, &subject.centre);
            if matches!(source.place(), LightPlace::Near(p) if subject.contains(&p)) {
                return Err(SetupError::value(format!("light[{i}].position"), INSIDE).into());
            }
            let cameras = light_cameras(&source, subject).map_err(|error| {
                SetupError::value(format!("light[{i}].position"), error.to_string())
            })?;
            let eyes = cameras.into_iter().map(|c| Eye::new(c, subject)).collect();
            lights.push(LightEyes { source, eyes });
        }
        Ok(Self {
            matrices,
            camera: Eye::new(matrices.camera()?, subject),
            lights,
        })
    }
}

/// The error of an eye or a light in the part.
const INSIDE: &str = "is inside the part: expected a point outside";

/// The error of a camera or a light that sees nothing of the part, at the key of its position where
/// that is the reason.
fn no_view(table: &str, place: &str, error: &ViewError) -> SetupError {
    let key = format!("{table}.{place}");
    match error {
        ViewError::EyeInside(_) => SetupError::value(key, INSIDE),
        ViewError::EyeFar { .. } => SetupError::value(key, format!("is too far: {error}")),
        _ => SetupError::value(table, format!("has no view of the part: {error}")),
    }
}

fn light_cameras(
    source: &light::LightSource,
    subject: &PreparedPart<'_>,
) -> Result<Vec<ViewCamera>, CameraError> {
    let centre = subject.centre;
    match source.place() {
        LightPlace::Far(d) => {
            let eye = centre + d * (4.0 * subject.radius);
            Ok(vec![ViewCamera::orthographic(eye, centre, upright(&d))?])
        }
        LightPlace::Near(p) => {
            let away = centre - p;
            let far = away.norm() > subject.radius;
            let towards = if far { away } else { Vector3::z() };
            let looking = |d: Vector3<f64>| ViewCamera::perspective(p, p + d, upright(&d), 1.0);
            match far {
                true => Ok(vec![looking(towards)?]),
                false => Ok(vec![looking(towards)?, looking(-towards)?]),
            }
        }
    }
}

fn upright(d: &Vector3<f64>) -> Vector3<f64> {
    Vector3::ith(d.abs().imin(), 1.0)
}

/// The view of one eye, with the boundary prepared for its lines of sight.
#[derive(Debug)]
pub struct Sightings<'a> {
    /// The contours.
    pub contours: Contours,
    /// The boundary.
    pub scene: Scene<'a>,
}

/// A light with its views of the part.
#[derive(Debug)]
pub(crate) struct StageLight<'a> {
    /// The light.
    pub source: light::LightSource,
    /// Its views.
    pub views: Vec<Sightings<'a>>,
}

/// A part in front of its camera and under its lights.
#[derive(Debug)]
pub struct LitScene<'a> {
    /// The part.
    pub(crate) subject: &'a PreparedPart<'a>,
    /// The camera's matrices.
    pub(crate) matrices: Matrices,
    /// The camera's view.
    pub view: Sightings<'a>,
    /// The lights with their views.
    pub(crate) lights: Vec<StageLight<'a>>,
    /// By contour: the index of a limb among those of its face.
    ordinals: Vec<u32>,
}

impl<'a> LitScene<'a> {
    /// The views of all eyes.
    pub(crate) fn new(subject: &'a PreparedPart<'a>, eyes: &'a Eyes) -> Result<Self, StageError> {
        let see = |eye: &'a Eye| -> Result<Sightings<'a>, ViewError> {
            Ok(Sightings {
                contours: contours(subject.brep, &eye.camera, subject.resolution)?,
                scene: Scene::new(subject.brep, &eye.projection, subject.resolution),
            })
        };
        let view = see(&eyes.camera).map_err(StageError::View)?;
        let mut lights = Vec::with_capacity(eyes.lights.len());
        for (i, light) in eyes.lights.iter().enumerate() {
            let seen: Result<Vec<_>, _> = light.eyes.iter().map(see).collect();
            lights.push(StageLight {
                source: light.source,
                views: seen.map_err(|e| StageError::Light(i, e))?,
            });
        }
        let ordinals = ordinals(&view.contours);
        Ok(Self {
            subject,
            matrices: eyes.matrices,
            view,
            lights,
            ordinals,
        })
    }

    /// The visible pieces of the camera's contours, cut where others end on them.
    pub(crate) fn arcs(&self, window: &ImageWindow) -> Vec<PredictedArc> {
        self.view.arcs(&self.ordinals, FINE, window)
    }

    /// Whether a light is so near to the camera that every visible point is lit, within the
    /// accuracy of polylines: shadows are hidden behind their casters.
    pub(crate) fn is_next_to_camera(&self, light: usize) -> bool {
        let LightPlace::Near(source) = self.lights[light].source.place() else {
            return false;
        };
        let Matrices { k, r, t } = &self.matrices;
        let eye = Point3::from(-(r.transpose() * t));
        let nearest = (eye - self.subject.centre).norm() - self.subject.radius;
        let scale = k[(0, 0)].abs().max(k[(1, 1)].abs());
        (source - eye).norm() * scale <= FINE * nearest
    }

    /// Whether a light reaches a point of a face that is turned towards it.
    pub(crate) fn is_lit(&self, light: usize, p: &Point3<f64>, face: FaceId) -> bool {
        let views = &self.lights[light].views;
        let before = |v: &&Sightings<'_>| views.len() == 1 || v.scene.projection.depth(p) > 0.0;
        let own = |other| {
            if other == face {
                OriginIncidence::Through
            } else {
                OriginIncidence::No
            }
        };
        views
            .iter()
            .find(before)
            .is_some_and(|v| !v.scene.is_hidden(p, &own))
    }

    /// The face that is visible at a point of the image, and the point of it.
    pub(crate) fn seen(&self, at: [f64; 2]) -> Option<FirstHit> {
        self.view.scene.nearest(&Point2::from(at))
    }
}

impl Sightings<'_> {
    /// The visible pieces of the contours, cut where others end on them, as polylines within
    /// `fine`. `ordinals` gives the index of each limb among those of its face.
    pub(crate) fn arcs(
        &self,
        ordinals: &[u32],
        fine: f64,
        window: &ImageWindow,
    ) -> Vec<PredictedArc> {
        let contours = &self.contours;
        let projection = self.scene.projection;
        let tolerance = FlatteningTolerance { fine, window };
        let mut arcs: Vec<PredictedArc> = Vec::new();
        for contour in &contours.contours {
            let straight = is_straight(contour);
            for piece in contour.pieces.iter().filter(|piece| piece.visible) {
                let curve = |t: f64| Some(shown(projection, &contour.space_curve.point(t)));
                let Some(mut line) = flatten(curve, piece.range, straight, tolerance) else {
                    continue;
                };
                // Pieces with a common end get the same end point, however it was computed.
                pin(&mut line, contours, piece);
                arcs.push(PredictedArc {
                    source: source(contour, ordinals[contour.id as usize]),
                    contour: Some(contour.id),
                    smooth: contour.smooth,
                    coefficients: coefficients(contour),
                    line,
                    stops: Vec::new(),
                    shade: None,
                    within: None,
                });
            }
        }
        stop(&mut arcs, contours);
        arcs
    }
}

/// By contour: the index of a limb among those of its face.
pub(crate) fn ordinals(contours: &Contours) -> Vec<u32> {
    let mut count: HashMap<FaceId, u32> = HashMap::new();
    let ordinal = |contour: &Contour| match contour.edge {
        Some(_) => 0,
        None => {
            let next = count.entry(contour.faces[0]).or_default();
            *next += 1;
            *next - 1
        }
    };
    contours.contours.iter().map(ordinal).collect()
}

/// Whether the image of a contour is a straight line that is traversed in one direction.
pub(crate) fn is_straight(contour: &Contour) -> bool {
    matches!(
        (&contour.image_curve, &contour.space_curve),
        (
            ImageCurve::Line { .. },
            premio_kernel::geometry::curve::Curve::Line(_)
        )
    )
}

fn coefficients(contour: &Contour) -> Vec<f64> {
    match &contour.image_curve {
        ImageCurve::Line { coefficients } => coefficients.to_vec(),
        ImageCurve::Conic { coefficients } => coefficients.to_vec(),
        ImageCurve::Point { .. } | ImageCurve::Projected => Vec::new(),
    }
}

fn source(contour: &Contour, ordinal: u32) -> ArcSource {
    match (contour.edge, contour.faces.first()) {
        (Some(edge), _) => ArcSource::Edge { edge: edge.0 },
        (None, face) => ArcSource::Limb {
            face: face.map_or(0, |f| f.0),
            ordinal,
        },
    }
}

fn pin(line: &mut super::flatten::Polyline, contours: &Contours, piece: &ContourPiece) {
    let last = line.points.len() - 1;
    for (end, at) in [(piece.start, 0), (piece.end, last)] {
        if let Some(id) = end {
            line.points[at] = contours.junctions[id as usize].image_point;
        }
    }
}

/// Inserts a point into each arc where another one ends behind it.
fn stop(arcs: &mut [PredictedArc], contours: &Contours) {
    let mut by_contour: HashMap<u32, Vec<usize>> = HashMap::new();
    for (i, arc) in arcs.iter().enumerate() {
        by_contour
            .entry(arc.contour.unwrap_or(u32::MAX))
            .or_default()
            .push(i);
    }
    let visible = contours.contours.iter().flat_map(|c| {
        let pieces = c.pieces.iter().filter(|p| p.visible);
        pieces.flat_map(|p| [p.start, p.end]).flatten()
    });
    let mut ends: Vec<u32> = visible.collect();
    ends.sort_unstable();
    ends.dedup();
    for junction in ends {
        let junction = &contours.junctions[junction as usize];
        let Some(before) = junction.contours.first() else {
            continue;
        };
        if junction.kind != JunctionKind::T {
            continue;
        }
        let p = junction.image_point;
        // A limb may pass in front of itself: then one of its pieces ends here, and another does
        // not.
        let on = by_contour.get(before).into_iter().flatten();
        let passing = on.filter(|&&i| !arcs[i].ends_at(p));
        let found = passing.filter_map(|&i| arcs[i].line.nearest(&p).map(|at| (i, at)));
        let nearest = found.min_by(|a, b| a.1.square.total_cmp(&b.1.square));
        if let Some((i, at)) = nearest {
            arcs[i].stop_at(p, at);
        }
    }
}

/// The greatest squared distance, in square pixels, from an arc of one that ends on it.
const ON: f64 = 0.25;

impl PredictedArc {
    /// Whether a point of its polyline is this one.
    fn is_at(&self, k: usize, p: [f64; 2]) -> bool {
        let q = self.line.points[k];
        (q[0] - p[0]).hypot(q[1] - p[1]) < f64::EPSILON.sqrt()
    }

    /// Whether it starts or ends at a point.
    fn ends_at(&self, p: [f64; 2]) -> bool {
        self.is_at(0, p) || self.is_at(self.line.points.len() - 1, p)
    }

    /// Records that another arc ends at a point, given the nearest point of this one.
    pub(crate) fn stop_at(&mut self, p: [f64; 2], nearest: NearestPoint) {
        let i = nearest.at.segment;
        if nearest.square > ON || self.ends_at(p) {
            return;
        }
        if let Some(known) = (i..=i + 1).find(|&k| self.is_at(k, p)) {
            if let Err(place) = self.stops.binary_search(&known) {
                self.stops.insert(place, known);
            }
            return;
        }
        self.line.insert(nearest.at, p);
        self.stops
            .iter_mut()
            .filter(|k| **k > i)
            .for_each(|k| *k += 1);
        let place = self.stops.partition_point(|&k| k <= i);
        self.stops.insert(place, i + 1);
    }
}
