//! The seams of a face.
//!
//! A seam is a ruling of a cylinder or a cone, a meridian of a sphere or of a torus that reaches its
//! axis, a circle about the tube of any other torus or a parallel of it. Its crossings with the edges
//! of its face determine which part of it lies in the face (`kernel::brep::surface_path`). Of several
//! candidate tracks the one with the fewest cuts is used. Two seams of a torus cross in a vertex of
//! their own.

mod rulings;
mod splitting;

use super::SeamError;
use super::gaps::{Samples, axes};
use super::short::length;
use super::tracks::{Course, Track, elliptic_meridian, meridian, tube};
use crate::parameters::{ParameterWindow, with_axis};
use nalgebra::{Point3, Vector3};
use premio_kernel::brep::Brep;
use premio_kernel::brep::locate::{FaceLocator, PointLocation};
use premio_kernel::brep::surface_path::{CrossingSense, DirectedArc, PathCrossing, SurfacePath};
use premio_kernel::brep::topology::{CoedgeId, FaceId, Sense};
use premio_kernel::geometry::curve::{Circle, Curve};
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::surface::{Surface, Torus};
use std::f64::consts::TAU;

/// The cut of a face.
#[derive(Debug)]
pub(super) struct Cut {
    /// The surface, and the starts of its angles, which are at the seams.
    pub window: ParameterWindow,
    /// The seams, pieces of which lie in the face.
    pub seams: Vec<Seam>,
}

/// A piece of a seam that lies in the face.
#[derive(Clone, Debug)]
pub(super) struct Seam {
    pub curve: Curve,
    /// The parameter of the curve at both ends, increasing.
    pub range: [f64; 2],
    /// The kinds of its ends.
    pub ends: [End; 2],
    /// The parameter of the surface that is constant along it.
    pub across: usize,
}

/// An end of a piece of a seam.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum End {
    /// It ends at an edge.
    Edge {
        /// The side of the edge.
        coedge: CoedgeId,
        /// The parameter on the edge's curve.
        t: f64,
    },
    /// A pole or an apex inside the face, where the seam turns back.
    Pole(Point3<f64>),
    /// The crossing of the two seams of a torus inside the face, or the middle of a seam that is
    /// divided.
    Crossing,
}

/// An end of a piece of a track in a face.
#[derive(Clone, Copy)]
struct TrackEnd {
    /// The parameter of the track's curve.
    t: f64,
    end: End,
}

/// A point at which a track enters or leaves a face.
#[derive(Clone, Copy)]
struct TrackStop {
    passage: CrossingSense,
    at: TrackEnd,
}

/// The part of a track along which an arc runs.
enum Coverage {
    Nothing,
    /// Between two parameters of the track's curve.
    Range([f64; 2]),
    Everything,
}

struct Faced<'a> {
    brep: &'a Brep,
    face: FaceId,
    resolution: f64,
    coedges: Vec<CoedgeId>,
    /// The number of coedges of each loop.
    rings: Vec<usize>,
    arcs: Vec<DirectedArc<'a>>,
    samples: Samples,
}

impl Cut {
    /// The cut of a face; `rings` are its loops without slits.
    pub fn new(
        brep: &Brep,
        face: FaceId,
        rings: &[Vec<CoedgeId>],
        resolution: f64,
    ) -> Result<Self, SeamError> {
        let coedges: Vec<CoedgeId> = rings.iter().flatten().copied().collect();
        let edges = coedges.iter().map(|c| brep.topology.coedge(*c).edge);
        let faced = Faced {
            brep,
            face,
            resolution,
            arcs: coedges.iter().map(|c| DirectedArc::new(brep, *c)).collect(),
            samples: Samples::new(brep, face, edges, resolution),
            rings: rings.iter().map(Vec::len).collect(),
            coedges,
        };
        faced.cut().ok_or_else(|| {
            let place = faced.samples.points().next().copied();
            let place = place.unwrap_or(brep.surface(face).frame().origin).into();
            SeamError::Blocked { face, place }
        })
    }

    /// Whether a seam is so short that other kernels may take it for a point.
    fn has_short_seam(&self) -> bool {
        let mut lengths = self.seams.iter().map(|s| length(&s.curve, s.range));
        lengths.any(|length| length <= SHORT * self.window.reach)
    }
}

impl Faced<'_> {
    fn cut(&self) -> Option<Cut> {
        let surface = self.brep.surface(self.face);
        let axes = match surface {
            Surface::Sphere(s) => {
                let arm = |p: &Point3<f64>| p - s.frame.origin;
                axes(&s.frame, arm, &self.samples, &self.circles())
            }
            Surface::Ellipsoid(s) => {
                let unit = Frame::world();
                let arm = |p: &Point3<f64>| s.on_unit_sphere(&s.frame.coordinates(p));
                axes(&unit, arm, &self.samples, &[])
            }
            _ => return self.cut_of(*surface),
        };
        let of_axis = |z: Vector3<f64>| self.cut_of(with_axis(surface, z));
        let mut cuts = axes.into_iter().take(AXES).map(of_axis);
        let first = cuts.next()?;
        // If seams run from both poles to one loop, readers ignore them.
        match first.as_ref().is_some_and(|cut| cut.seams.len() < 2) {
            true => first,
            false => least(std::iter::once(first).chain(cuts)),
        }
    }

    /// The cut of a face with the parameters of a given surface.
    fn cut_of(&self, surface: Surface) -> Option<Cut> {
        let starts = [0.0; 2];
        let origin = surface.frame().origin;
        let away = self.samples.points().map(|p| (p - origin).norm());
        let whole = ParameterWindow {
            surface,
            starts,
            reach: away.fold(0.0, f64::max),
        };
        if let Surface::Plane(_) = surface {
            let seams = Vec::new();
            return Some(Cut {
                window: whole,
                seams,
            });
        }
        let candidates = self.samples.candidates(&whole, 0);
        let around = |u: f64| {
            let window = whole.cut_at(whole.angle_at(u));
            let seams = self.seams(&window.surface, 0, window.starts[0])?;
            Some(Cut { window, seams })
        };
        let found = candidates.into_iter().map(around);
        let mut cut = match self.winds(&whole, 0) {
            true => least(found.filter(cuts_something))?,
            false => self.unless_parted(&whole, 0, least(found))?,
        };
        if surface.is_ring_torus() {
            let candidates = self.samples.candidates(&cut.window, 1);
            let found = candidates.into_iter().map(|v| {
                let seams = self.seams(&cut.window.surface, 1, v)?;
                let window = ParameterWindow {
                    starts: [0.0, v],
                    ..cut.window
                };
                Some(Cut { window, seams })
            });
            let other = self.unless_parted(&cut.window, 1, least(found))?;
            cut.window = other.window;
            cut.seams.extend(other.seams);
            cut.split_at_crossing();
        }
        if let Surface::Torus(torus) = surface
            && torus.is_horn()
        {
            cut.split_between_poles();
        }
        Some(cut)
    }

    /// Whether a loop winds around an angle of the surface, so that it closes only along a seam. A
    /// loop through a pole, where the angle is undefined, is inconclusive.
    fn winds(&self, window: &ParameterWindow, i: usize) -> bool {
        // A face of a torus that touches itself is closed thereby, and still winds around.
        if window.surface.is_ring_torus() {
            return false;
        }
        let mut senses = self
            .coedges
            .iter()
            .map(|c| self.brep.topology.coedge(*c).sense);
        let mut turns = self.samples.turns(window, i).into_iter();
        self.rings.iter().any(|&count| {
            let ring = turns.by_ref().take(count).zip(senses.by_ref());
            let sum: f64 = ring.map(|(turn, sense)| turn * sense.sign::<f64>()).sum();
            sum.abs() > 0.5 * TAU
        })
    }

    /// A cut across an angle; none if the face touches itself, so that it does not close.
    fn unless_parted(
        &self,
        window: &ParameterWindow,
        across: usize,
        cut: Option<Cut>,
    ) -> Option<Cut> {
        if cut.as_ref().is_some_and(|cut| cut.seams.is_empty()) {
            return cut;
        }
        let values = self.samples.critical(window, across);
        let mut windows = values.into_iter().map(|at| match across {
            0 => window.cut_at(window.angle_at(at)),
            _ => ParameterWindow {
                starts: [0.0, at],
                ..*window
            },
        });
        let parted = windows.find(|w| {
            let tracks = self.tracks(&w.surface, across, w.starts[across]);
            let first = tracks.first();
            first.is_some_and(|t| self.is_parted(&w.surface, t))
        });
        match parted {
            Some(window) => Some(Cut {
                window,
                seams: Vec::new(),
            }),
            None => cut,
        }
    }

    /// Whether a track runs along edges or passes vertices wherever it is in the face.
    fn is_parted(&self, surface: &Surface, track: &Track) -> bool {
        let side = self.brep.sense(self.face);
        let crossings = track
            .walk
            .crossings(surface, side, &self.arcs, self.resolution);
        // Close to a vertex, and where edges touch, a crossing is inconclusive.
        let is_clear = |at: f64| {
            let mut unclear = crossings
                .iter()
                .filter(|c| c.passage == CrossingSense::Unclear);
            unclear.all(|c| (c.at - at).abs() > 2.0 * self.resolution)
        };
        if crossings.iter().any(|c| is_clear(c.at)) {
            return false;
        }
        let passed = crossings.iter().map(|c| match track.course {
            Course::Round => (track.start + c.at * track.by).rem_euclid(TAU),
            Course::Open { .. } => track.start + c.at * track.by,
        });
        let mut covered: Vec<[f64; 2]> = passed.map(|t| [t, t]).collect();
        for arc in &self.arcs {
            match self.coverage(arc, track) {
                Coverage::Nothing => {}
                Coverage::Range(range) => covered.push(range),
                Coverage::Everything => return true,
            }
        }
        !covered.is_empty() && self.is_outside_between(covered, track)
    }

    /// The part of a track along which an arc runs.
    fn coverage(&self, arc: &DirectedArc<'_>, track: &Track) -> Coverage {
        let parameter = |p: &Point3<f64>| track.curve.parameter(p);
        let near = |p: &Point3<f64>| {
            let on = track.curve.point(parameter(p));
            (on - p).norm() <= self.resolution
        };
        let [lo, hi] = arc.range;
        let at = |part: f64| arc.curve.point(lo + part * (hi - lo));
        if ![0.13, 0.37, 0.5, 0.81].iter().all(|part| near(&at(*part))) {
            return Coverage::Nothing;
        }
        if (at(0.0) - at(1.0)).norm() <= self.resolution {
            // All of a circle.
            return Coverage::Everything;
        }
        // The end that comes first, as the midpoint shows.
        let [a, m, b] = [0.0, 0.5, 1.0].map(|part| parameter(&at(part)));
        Coverage::Range(match track.course {
            Course::Open { .. } => [a.min(b), a.max(b)],
            Course::Round if (m - a).rem_euclid(TAU) < (b - a).rem_euclid(TAU) => {
                [a, a + (b - a).rem_euclid(TAU)]
            }
            Course::Round => [b, b + (a - b).rem_euclid(TAU)],
        })
    }

    /// Whether a track is outside the face wherever edges do not cover it.
    fn is_outside_between(&self, mut covered: Vec<[f64; 2]>, track: &Track) -> bool {
        let poles = match track.course {
            Course::Round => [None, None],
            Course::Open { first, last } => [first, last],
        };
        covered.extend(poles.into_iter().flatten().map(|t| [t, t]));
        covered.sort_by(|x, y| x[0].total_cmp(&y[0]));
        let first = covered[0];
        if let Course::Round = track.course {
            covered.push(first.map(|t| t + TAU));
        }
        let mut end = first[1];
        covered[1..].iter().all(|next| {
            let gap = [end, next[0]];
            end = end.max(next[1]);
            // Crossings at the same point have parameters that differ by rounding.
            let is_none = gap[1] - gap[0] <= 2.0 * self.resolution * track.by;
            is_none || self.place_between(track, gap) == PointLocation::Outside
        })
    }

    /// The location of a track between two of its parameters. It is on the face's boundary only if
    /// several of its points are.
    fn place_between(&self, track: &Track, [a, b]: [f64; 2]) -> PointLocation {
        let parts = [0.5, 0.31, 0.73].into_iter();
        let mut places = parts.map(|part| self.place(&track.curve.point(a + part * (b - a))));
        let clear = places.find(|place| *place != PointLocation::On);
        clear.unwrap_or(PointLocation::On)
    }

    /// The pieces of a seam in the face, at a value of the angle `across`; `None` if they are
    /// ambiguous.
    fn seams(&self, surface: &Surface, across: usize, at: f64) -> Option<Vec<Seam>> {
        let tracks = self.tracks(surface, across, at);
        tracks.iter().find_map(|track| {
            let pieces = self.pieces(surface, track)?;
            let seam = |[a, b]: [TrackEnd; 2]| Seam {
                curve: track.curve.clone(),
                range: [a.t, if b.t > a.t { b.t } else { b.t + TAU }],
                ends: [a.end, b.end],
                across,
            };
            Some(pieces.into_iter().map(seam).collect())
        })
    }

    /// The line of a constant angle; from several starting points if it closes.
    fn tracks(&self, surface: &Surface, across: usize, at: f64) -> Vec<Track> {
        match surface {
            Surface::Plane(_) => Vec::new(),
            Surface::Cylinder(s) => self.cylinder_track(surface, s).into_iter().collect(),
            Surface::Cone(s) => self.cone_track(surface, s).into_iter().collect(),
            Surface::Sphere(s) => meridian(surface, s.radius).into_iter().collect(),
            Surface::Ellipsoid(s) => elliptic_meridian(s, at).into_iter().collect(),
            Surface::EllipticCylinder(_) => self.oval_track(surface, at).into_iter().collect(),
            Surface::EllipticCone(_) => self.oblique_track(surface, at).into_iter().collect(),
            Surface::Torus(s) if !s.is_ring() => self.sheet_track(surface, s).into_iter().collect(),
            Surface::Torus(s) => {
                let window = ParameterWindow {
                    surface: *surface,
                    starts: [0.0; 2],
                    reach: s.major + s.minor,
                };
                let mut from = self.samples.candidates(&window, 1 - across);
                from.truncate(STARTS);
                let tracks = from.into_iter().filter_map(|other| match across {
                    0 => Some(tube_track(surface, s, at, other)),
                    _ => self.parallel_track(surface, s, at, other),
                });
                tracks.collect()
            }
        }
    }

    /// The meridian of a torus that reaches its axis, from pole to pole. Where edges end at a pole, it
    /// ends before the pole. None if edges end at one pole and the other is inside the face: readers
    /// drop a seam that leads from a pole to an edge of such a loop.
    fn sheet_track(&self, surface: &Surface, s: &Torus) -> Option<Track> {
        let end = s.pole_angle();
        let near = self.resolution / s.minor;
        let limit = |sign: f64| {
            let from_pole = |p| end - sign * surface.parameters(p)[1];
            let away: Vec<f64> = self.samples.points().map(from_pole).collect();
            let apart = away.iter().copied().filter(|d| *d > near);
            let nearest = apart.fold(end, f64::min);
            match away.into_iter().fold(end, f64::min) > near {
                true => (sign * end, Some(sign * end)),
                false => (sign * (end - 0.25 * nearest), None),
            }
        };
        let [(from, first), (to, last)] = [limit(-1.0), limit(1.0)];
        let only_free = match (first, last) {
            (Some(v), None) | (None, Some(v)) => Some(surface.point(0.0, v)),
            _ => None,
        };
        if only_free.is_some_and(|pole| self.contains(&pole)) {
            return None;
        }
        let walk = SurfacePath::meridian_from(s, [0.0, from], Sense::Along);
        Some(Track {
            walk: walk.upto((to - from) * s.minor),
            curve: tube(surface, s.major, s.minor),
            start: from,
            by: 1.0 / s.minor,
            course: Course::Open { first, last },
        })
    }

    /// The parallel of a torus at an angle of the tube, from an angle about the axis.
    fn parallel_track(&self, surface: &Surface, s: &Torus, at: f64, start: f64) -> Option<Track> {
        let f = &s.frame;
        let from = surface.point(start, at);
        let radius = s.major + s.minor * at.cos();
        let centre = f.origin + f.z * (s.minor * at.sin());
        let frame = f.at(centre);
        Some(Track {
            walk: SurfacePath::parallel(surface, &from, Sense::Along, self.resolution)?,
            curve: Curve::Circle(Circle { frame, radius }),
            start,
            by: 1.0 / radius,
            course: Course::Round,
        })
    }

    /// The ends of the pieces of a track in the face.
    fn pieces(&self, surface: &Surface, track: &Track) -> Option<Vec<[TrackEnd; 2]>> {
        let mut stops = self.stops(surface, track);
        let starts_inside = match stops.first() {
            Some(stop) => stop.passage == CrossingSense::Leaving,
            None => self.contains(&track.walk.point(1.0 / track.by)),
        };
        match &track.course {
            Course::Round if stops.is_empty() => {
                let ends = [0.0, TAU].map(|on| TrackEnd {
                    t: track.start + on,
                    end: End::Crossing,
                });
                return Some(if starts_inside {
                    vec![ends]
                } else {
                    Vec::new()
                });
            }
            Course::Round => {
                if starts_inside {
                    stops.rotate_left(1);
                }
            }
            Course::Open { first, last } => {
                let pole = |passage: CrossingSense, t: f64| TrackStop {
                    passage,
                    at: TrackEnd {
                        t,
                        end: End::Pole(track.curve.point(t)),
                    },
                };
                if starts_inside {
                    stops.insert(0, pole(CrossingSense::Entering, (*first)?));
                }
                if stops.len() % 2 == 1 {
                    stops.push(pole(CrossingSense::Leaving, (*last)?));
                }
            }
        }
        let pieces = stops.chunks(2).map(|pair| match pair {
            [from, to]
                if from.passage == CrossingSense::Entering
                    && to.passage == CrossingSense::Leaving =>
            {
                Some([from.at, to.at])
            }
            _ => None,
        });
        pieces.collect()
    }

    /// The crossings of a track with the edges of the face, in order.
    fn stops(&self, surface: &Surface, track: &Track) -> Vec<TrackStop> {
        let side = self.brep.sense(self.face);
        let crossings = track
            .walk
            .crossings(surface, side, &self.arcs, self.resolution);
        let stop = |c: &PathCrossing| TrackStop {
            passage: c.passage,
            at: TrackEnd {
                t: track.start + c.at * track.by,
                end: End::Edge {
                    coedge: self.coedges[c.arc],
                    t: c.t,
                },
            },
        };
        let mut stops: Vec<TrackStop> = crossings.iter().map(stop).collect();
        // Where the face touches itself, the track leaves it before entering it again.
        for k in 1..stops.len() {
            let (before, after) = (stops[k - 1], stops[k]);
            let together = (after.at.t - before.at.t).abs() <= self.resolution * track.by;
            let passages = (before.passage, after.passage);
            if together && passages == (CrossingSense::Entering, CrossingSense::Leaving) {
                stops.swap(k - 1, k);
            }
        }
        stops
    }

    /// The axes of the edges that are circles.
    fn circles(&self) -> Vec<Vector3<f64>> {
        let axis = |arc: &DirectedArc<'_>| match arc.curve {
            Curve::Circle(c) => Some(c.frame.z),
            _ => None,
        };
        self.arcs.iter().filter_map(axis).collect()
    }

    /// Whether the face contains a point of its surface that is not on an edge.
    fn contains(&self, p: &Point3<f64>) -> bool {
        self.place(p) == PointLocation::Inside
    }

    fn place(&self, p: &Point3<f64>) -> PointLocation {
        let surface = self.brep.surface(self.face);
        let (side, arcs) = (self.brep.sense(self.face), self.arcs.clone());
        FaceLocator::new(surface, side, arcs, self.resolution).place(p)
    }
}

/// The circle about a torus's tube at an angle about the axis, from an angle of the tube.
fn tube_track(surface: &Surface, s: &Torus, at: f64, start: f64) -> Track {
    Track {
        walk: SurfacePath::tube(s, &surface.point(at, start), Sense::Along),
        curve: tube(surface, s.major, s.minor),
        start,
        by: 1.0 / s.minor,
        course: Course::Round,
    }
}

/// The number of starting points tried for a closed seam.
const STARTS: usize = 4;
/// The length of a short seam, relative to the greatest distance of an edge from the surface's
/// centre.
const SHORT: f64 = 1.0 / (1 << 20) as f64;
/// The number of axes tried for a sphere that the first axis cuts into pieces.
const AXES: usize = 16;

fn cuts_something(cut: &Option<Cut>) -> bool {
    cut.as_ref().is_some_and(|cut| !cut.seams.is_empty())
}

/// The first cut with the fewest seams, among those without a short one if there are any; a cut
/// without seams is returned at once.
fn least(cuts: impl Iterator<Item = Option<Cut>>) -> Option<Cut> {
    let mut best: Option<((bool, usize), Cut)> = None;
    for cut in cuts.flatten() {
        if cut.seams.is_empty() {
            return Some(cut);
        }
        let rank = (cut.has_short_seam(), cut.seams.len());
        if best.as_ref().is_none_or(|(least, _)| rank < *least) {
            best = Some((rank, cut));
        }
    }
    best.map(|(_, cut)| cut)
}
