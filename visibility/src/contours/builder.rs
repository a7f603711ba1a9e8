//! The contours of a part for a viewpoint.

use crate::camera::ViewCamera;
use crate::camera::projection::Projection;
use crate::contour_generator::contour_arc::{ArcFace, ArcJunction, Change, ContourArc, Split};
use crate::contour_generator::facing::is_limb;
use crate::contour_generator::junctions::{JunctionSupport, Junctions};
use crate::contour_generator::limb_arcs::{LimbArcs, limb_arcs};
use crate::contours::{
    Contour, ContourKind, ContourPiece, ContourSeconds, Contours, ImageCurve, Junction,
    JunctionKind, SCHEMA,
};
use crate::image_curve::edgewise::Edgewise;
use crate::image_curve::image_box::ImageBox;
use crate::image_curve::monotone_arc::{self, MonotoneArc, stretches};
use crate::image_curve::{Image, image};
use crate::invisibility::{Method, pieces};
use crate::junction;
use crate::scene::Scene;
use crate::scene::tolerance::SPACE_TOLERANCE;
use nalgebra::Point3;
use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::{EdgeId, FaceId, Sense};
use premio_kernel::geometry::bounds::{Aabb, bounds};
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::curve_plane::plane_roots;
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::Plane;
use premio_kernel::geometry::unresolved::Unresolved;
use premio_kernel::number::predicates::{Compare, ROUNDING};
use std::time::Instant;

/// Why there are no contours.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ViewError {
    /// The eye lies in the material.
    #[error("the eye ({}, {}, {}) lies inside the material", .0.x, .0.y, .0.z)]
    EyeInside(Point3<f64>),
    /// The eye is so far away that f64 coordinates there cannot resolve the resolution.
    #[error(
        "the eye is {distance:.3e} away from the part, beyond the limit of {most:.3e} for this resolution"
    )]
    EyeFar {
        /// From the middle of the part.
        distance: f64,
        /// The greatest distance.
        most: f64,
    },
    /// A limb of a torus could not be resolved.
    #[error("a limb: {0}")]
    Limb(#[from] Unresolved),
}

/// The contours of a part seen by a camera; `resolution` is the part's resolution.
///
/// # Errors
/// The eye is in the material or too far away, or a limb of a torus could not be resolved.
pub fn contours(brep: &Brep, camera: &ViewCamera, resolution: f64) -> Result<Contours, ViewError> {
    contours_with(brep, camera, resolution, Method::Propagated)
}

/// The contours, with the method for quantitative invisibility.
///
/// # Errors
/// As [`contours`].
pub fn contours_with(
    brep: &Brep,
    camera: &ViewCamera,
    resolution: f64,
    method: Method,
) -> Result<Contours, ViewError> {
    let started = Instant::now();
    let projection = Projection::new(camera, part_size(brep));
    let scene = Scene::new(brep, &projection, resolution);
    check_eye(&scene)?;
    let mut junctions = Junctions::new(&projection, brep.topology.vertices as usize);
    let limbs = limb_arcs(&scene, &mut junctions)?;
    let mut seconds = ContourSeconds {
        limbs: started.elapsed().as_secs_f64(),
        ..ContourSeconds::default()
    };
    let started = Instant::now();
    let BuiltContours {
        mut contours,
        mut contour_arcs,
    } = ContourBuilder::build(&scene, &mut junctions, &limbs);
    junction::find(&mut contour_arcs, &scene, &mut junctions);
    seconds.junctions = started.elapsed().as_secs_f64();
    let started = Instant::now();
    let found = pieces(&scene, &mut contour_arcs, &mut junctions, method);
    for (contour_arc, pieces) in contour_arcs.iter().zip(found) {
        contours[contour_arc.contour as usize].add(pieces);
    }
    let mut junctions = junctions.list;
    add_contours(&mut junctions, &contours);
    seconds.visibility = started.elapsed().as_secs_f64();
    Ok(Contours {
        schema: SCHEMA,
        camera: camera.clone(),
        resolution,
        contours,
        junctions,
        seconds,
    })
}

/// Refuses an eye in the material, and one too far away for the resolution.
fn check_eye(scene: &Scene<'_>) -> Result<(), ViewError> {
    let eye = scene.projection.origin();
    let hull = scene.bounds();
    let (distance, most) = ((eye - hull.centre()).norm(), scene.resolution / ROUNDING);
    if hull.diagonal().is_finite() && distance.is_beyond(most) {
        return Err(ViewError::EyeFar { distance, most });
    }
    match scene.eye_inside() {
        true => Err(ViewError::EyeInside(eye)),
        false => Ok(()),
    }
}

impl Contour {
    /// Adds the pieces of one of its arcs.
    fn add(&mut self, pieces: Vec<ContourPiece>) {
        match self.pieces.is_empty() {
            true => self.pieces = pieces,
            false => self.pieces.extend(pieces),
        }
    }
}

/// Adds to every junction the contours whose pieces end there.
fn add_contours(junctions: &mut [Junction], contours: &[Contour]) {
    for contour in contours {
        for id in contour.pieces.iter().flat_map(ends).flatten() {
            let at = &mut junctions[id as usize].contours;
            if !at.contains(&contour.id) {
                at.push(contour.id);
            }
        }
    }
}

fn ends(piece: &ContourPiece) -> [Option<u32>; 2] {
    [piece.start, piece.end]
}

/// The size of a part: the diagonal of the box of its edges and closed surfaces.
pub fn part_size(brep: &Brep) -> f64 {
    use premio_kernel::geometry::surface::Surface;
    let mut hull = Aabb::EMPTY;
    for edge in brep.topology.edge_ids() {
        hull = hull.hull(&bounds(brep.curve(edge), brep.range(edge)));
    }
    for face in brep.topology.face_ids() {
        let around = |f: &Frame, r: f64| Aabb::new(&f.origin).grown(r);
        match brep.surface(face) {
            Surface::Sphere(s) => hull = hull.hull(&around(&s.frame, s.radius)),
            Surface::Torus(s) => hull = hull.hull(&around(&s.frame, s.circumradius())),
            Surface::Ellipsoid(s) => hull = hull.hull(&around(&s.frame, s.circumradius())),
            Surface::Plane(_)
            | Surface::Cylinder(_)
            | Surface::Cone(_)
            | Surface::EllipticCylinder(_)
            | Surface::EllipticCone(_) => {}
        }
    }
    let size = hull.diagonal();
    if size.is_finite() { size } else { 1.0 }
}

/// An arc from which the arcs of a contour are made.
#[derive(Clone)]
struct Source<'a> {
    curve: &'a Curve,
    range: [f64; 2],
    closed: bool,
    ends: [Option<u32>; 2],
    contour: u32,
    edge: Option<EdgeId>,
    faces: Vec<ArcFace>,
    limb: bool,
    marks: Vec<ArcJunction>,
}

/// A parameter at which an arc is cut, and the junction there.
#[derive(Clone, Copy)]
struct Stop {
    t: f64,
    junction: Option<u32>,
}

/// A part of a smooth edge.
struct SmoothPart<'a> {
    source: Source<'a>,
    kind: ContourKind,
}

impl Source<'_> {
    /// A parameter shifted into the cycle that starts with the range.
    fn in_cycle(&self, t: f64) -> f64 {
        let lo = self.range[0];
        match self.curve.period() {
            Some(period) => lo + (t - lo).rem_euclid(period),
            None => t,
        }
    }

    /// The parts between stops, which are in the order of their parameters; a closed arc without
    /// any stays closed.
    fn cut(&self, mut stops: Vec<Stop>) -> Vec<Self> {
        let [lo, hi] = self.range;
        let closed = self.closed && stops.is_empty();
        if let (true, Some(&first)) = (self.closed, stops.first()) {
            let t = first.t + (hi - lo);
            stops.push(Stop { t, ..first });
        } else {
            let end = |t: f64, junction: Option<u32>| Stop { t, junction };
            stops.insert(0, end(lo, self.ends[0]));
            stops.push(end(hi, self.ends[1]));
        }
        let part = |pair: &[Stop]| Self {
            range: [pair[0].t, pair[1].t],
            closed,
            ends: [pair[0].junction, pair[1].junction],
            ..self.clone()
        };
        stops.windows(2).map(part).collect()
    }
}

struct ContourBuilder<'s, 'a, 'j, 'p> {
    scene: &'s Scene<'a>,
    junctions: &'j mut Junctions<'p>,
    contours: Vec<Contour>,
    contour_arcs: Vec<ContourArc<'a>>,
}

/// The contours, which have no pieces yet, and their arcs.
struct BuiltContours<'a> {
    contours: Vec<Contour>,
    contour_arcs: Vec<ContourArc<'a>>,
}

impl<'s, 'a, 'j, 'p> ContourBuilder<'s, 'a, 'j, 'p> {
    /// The contours of all edges and limbs.
    fn build(
        scene: &'s Scene<'a>,
        junctions: &'j mut Junctions<'p>,
        limbs: &'a LimbArcs,
    ) -> BuiltContours<'a> {
        let all = scene.brep.topology.edges.len() + limbs.arcs.len();
        let mut builder = Self {
            scene,
            junctions,
            contours: Vec::with_capacity(all),
            contour_arcs: Vec::with_capacity(all),
        };
        builder.edges(limbs);
        builder.limbs(limbs);
        BuiltContours {
            contours: builder.contours,
            contour_arcs: builder.contour_arcs,
        }
    }
}

impl<'a> ContourBuilder<'_, 'a, '_, '_> {
    fn edges(&mut self, limbs: &LimbArcs) {
        let brep = self.scene.brep;
        let topology = &brep.topology;
        for edge in topology.edge_ids() {
            let entity = topology.edge(edge);
            let ends = match entity.ends {
                Some(ends) => ends.map(|v| Some(self.junctions.vertex(v, &brep.point(v)))),
                None => [None, None],
            };
            let uses = entity.coedges.iter();
            let faces = uses.map(|&c| ArcFace {
                face: topology.face_of(c),
                sense: topology.coedge(c).sense,
            });
            let whole = Source {
                curve: brep.curve(edge),
                range: brep.range(edge),
                closed: entity.ends.is_none(),
                ends,
                contour: 0,
                edge: Some(edge),
                faces: faces.collect(),
                limb: false,
                marks: limbs.on_edges[edge.index()].clone(),
            };
            if !entity.smooth {
                self.edge(whole, ContourKind::Edge, false);
                continue;
            }
            for SmoothPart { source, kind } in self.smooth_parts(whole, edge) {
                self.edge(source, kind, kind == ContourKind::Edge);
            }
        }
    }

    /// Adds the contour of an edge, or of a part of it.
    fn edge(&mut self, mut source: Source<'a>, kind: ContourKind, smooth: bool) {
        source.contour = self.contours.len() as u32;
        let seen = self.image(&source);
        let contour = self.contour(&source, &seen, kind);
        self.contours.push(Contour { smooth, ..contour });
        self.contour_arc(source, seen);
    }

    /// The parts of a smooth edge, cut where it begins or ceases to be the limb.
    fn smooth_parts(&self, whole: Source<'a>, edge: EdgeId) -> Vec<SmoothPart<'a>> {
        let kind = |range: [f64; 2]| match is_limb(self.scene, edge, range) {
            true => ContourKind::Limb,
            false => ContourKind::Edge,
        };
        let mut stops: Vec<Stop> = Vec::new();
        let [lo, hi] = whole.range;
        for mark in &whole.marks {
            let t = whole.curve.in_cycle(mark.t, lo);
            if t.lies_between(whole.range) || whole.closed {
                let junction = Some(mark.junction);
                stops.push(Stop { t, junction });
            }
        }
        stops.sort_by(|a, b| a.t.total_cmp(&b.t));
        let parts = whole.cut(stops);
        let kinds: Vec<ContourKind> = parts.iter().map(|part| kind(part.range)).collect();
        match kinds.windows(2).all(|pair| pair[0] == pair[1]) {
            true => vec![SmoothPart {
                source: whole,
                kind: kinds.first().copied().unwrap_or(kind([lo, hi])),
            }],
            false => {
                let parts = parts.into_iter().zip(kinds);
                let part = |(source, kind)| SmoothPart { source, kind };
                parts.map(part).collect()
            }
        }
    }

    fn limbs<'l: 'a>(&mut self, limbs: &'l LimbArcs) {
        for arc in &limbs.arcs {
            let source = Source {
                curve: &arc.curve,
                range: arc.range,
                closed: arc.closed,
                ends: arc.ends,
                contour: self.contours.len() as u32,
                edge: None,
                faces: vec![ArcFace {
                    face: arc.face,
                    sense: Sense::Along,
                }],
                limb: true,
                marks: arc.marks.clone(),
            };
            let seen = self.image(&source);
            let contour = self.contour(&source, &seen, ContourKind::Limb);
            self.contours.push(contour);
            self.contour_arc(source, seen);
        }
    }

    fn image(&self, source: &Source<'_>) -> Image {
        let Scene {
            projection,
            resolution,
            ..
        } = *self.scene;
        image(source.curve, source.range, projection, resolution)
    }

    fn contour(&self, source: &Source<'_>, seen: &Image, kind: ContourKind) -> Contour {
        let mut faces: Vec<FaceId> = source.faces.iter().map(|f| f.face).collect();
        if source.limb {
            faces.push(source.faces[0].face);
        }
        Contour {
            id: source.contour,
            kind,
            smooth: false,
            faces,
            edge: source.edge,
            space_curve: source.curve.clone(),
            image_curve: image_curve(seen, source, self.scene.projection),
            pieces: Vec::new(),
        }
    }

    /// Cuts an arc at the near plane and keeps what lies beyond.
    fn contour_arc(&mut self, source: Source<'a>, seen: Image) {
        let projection = self.scene.projection;
        let least = self.least_depth(&bounds(source.curve, source.range));
        if least.is_beyond(projection.near) {
            return self.push(source, seen);
        }
        let stops = self.near_plane_stops(&source);
        for part in source.cut(stops) {
            let middle = source.curve.point(0.5 * (part.range[0] + part.range[1]));
            if projection.depth(&middle).is_beyond(projection.near) {
                let seen = self.image(&part);
                self.push(part, seen);
            }
        }
    }

    /// The least depth of a box's corners.
    fn least_depth(&self, hull: &Aabb) -> f64 {
        let corner = |k: usize| {
            let pick = |i: usize| {
                if k >> i & 1 == 0 {
                    hull.min[i]
                } else {
                    hull.max[i]
                }
            };
            let corner = Point3::new(pick(0), pick(1), pick(2));
            self.scene.projection.depth(&corner)
        };
        (0..8).map(corner).fold(f64::INFINITY, f64::min)
    }

    /// The stops of an arc at the near plane, in order, with new junctions.
    fn near_plane_stops(&mut self, source: &Source<'_>) -> Vec<Stop> {
        let projection = self.scene.projection;
        let plane = Plane {
            frame: Frame::about(
                projection.origin() + projection.axis() * projection.near,
                projection.axis().normalize(),
            ),
        };
        let mut cuts: Vec<f64> = Vec::new();
        plane_roots(
            source.curve,
            source.range,
            &plane,
            self.scene.resolution,
            &mut |t, unambiguous| {
                if unambiguous {
                    cuts.push(t);
                }
            },
        );
        cuts.sort_by(f64::total_cmp);
        let stop = |t: f64| {
            let p = source.curve.point(t);
            let kind = JunctionKind::NearPlane;
            Stop {
                t,
                junction: Some(self.junctions.add(kind, JunctionSupport::Alone, &p)),
            }
        };
        cuts.into_iter().map(stop).collect()
    }

    /// Adds an arc that is not cut.
    fn push(&mut self, source: Source<'a>, seen: Image) {
        let seen = self.seen_edgewise(&source, seen);
        let straight = self.monotone_arcs(&source, &seen);
        // Of a limb they are its cusps, which are known.
        let turns = match seen {
            Image::General if source.limb => Vec::new(),
            Image::General => monotone_arc::turns(source.curve, &straight, self.scene.projection),
            _ => seen.turns(source.range),
        };
        let splits = self.splits(&source, &turns);
        self.contour_arcs.push(ContourArc {
            curve: source.curve,
            range: source.range,
            closed: source.closed,
            ends: source.ends,
            contour: source.contour,
            edge: source.edge,
            faces: source.faces,
            limb: source.limb,
            image: seen,
            turns,
            stretches: straight,
            hull: ImageBox::EMPTY,
            splits,
        });
    }

    /// The image of an arc. A general one becomes that of a surface seen edgewise, if the arc lies on
    /// one.
    fn seen_edgewise(&self, source: &Source<'_>, seen: Image) -> Image {
        let Image::General = seen else {
            return seen;
        };
        let brep = self.scene.brep;
        let surfaces = source.faces.iter().map(|f| brep.surface(f.face));
        Edgewise::new(
            source.curve,
            source.range,
            surfaces,
            self.scene.projection,
            self.scene.resolution,
            self.scene.tilt,
        )
        .map_or(seen, Image::Edgewise)
    }

    /// The monotone arcs of an image without a closed form; none of one with it.
    fn monotone_arcs(&self, source: &Source<'_>, seen: &Image) -> Vec<MonotoneArc> {
        let Scene {
            projection,
            resolution,
            ..
        } = *self.scene;
        match seen {
            Image::General | Image::Edgewise(_) => {
                stretches(source.curve, source.range, projection, resolution)
            }
            _ => Vec::new(),
        }
    }

    /// The splits of an arc at its marks and at the turning points of its image.
    fn splits(&mut self, source: &Source<'_>, turns: &[f64]) -> Vec<Split> {
        let at = |t: f64, junction: u32| Split {
            t,
            junction,
            change: Change::Correct,
        };
        let mut splits: Vec<Split> = Vec::new();
        for &ArcJunction { t, junction } in &source.marks {
            let t = source.in_cycle(t);
            if t.lies_between(source.range) || source.closed {
                splits.push(at(t, junction));
            }
        }
        // A turning point at the end of an arc is not a separate point.
        let near = SPACE_TOLERANCE * self.scene.resolution;
        let ends = source.range.map(|end| source.curve.point(end));
        let at_end = |p: &Point3<f64>| ends.iter().any(|end| (p - end).norm().is_within(near));
        for &t in turns {
            let p = source.curve.point(t);
            if t.lies_between(source.range) && !at_end(&p) || source.closed {
                let kind = JunctionKind::ImageTurn;
                let junction = self.junctions.add(kind, JunctionSupport::Alone, &p);
                splits.push(at(t, junction));
            }
        }
        splits
    }
}

fn image_curve(seen: &Image, source: &Source<'_>, projection: &Projection) -> ImageCurve {
    match seen {
        Image::Point => ImageCurve::Point {
            point: projection
                .project(&source.curve.point(source.range[0]))
                .into(),
        },
        Image::Conic { conic, .. } => ImageCurve::Conic {
            coefficients: projection.conic(conic),
        },
        Image::Line { line, .. } | Image::Flat { line, .. } => ImageCurve::Line {
            coefficients: projection.line(line),
        },
        Image::Edgewise(_) | Image::General => ImageCurve::Projected,
    }
}
