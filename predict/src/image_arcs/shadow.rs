//! Cast shadows. Where a contour of the light's view lies in front of another face, it casts the
//! boundary of a shadow on that face. So shadow boundaries are the contours of the light's view,
//! extended along its lines of sight.

use super::arc::{ArcSide, ArcSource, PredictedArc, Shade};
use super::crossings::{Lines, PolylineCrossing};
use super::flatten::{
    FINE, FlatteningTolerance, ImageWindow, Polyline, PolylinePoint, ProjectedPoint, flatten, shown,
};
use super::lit_scene::{LitScene, Sightings, StageLight, ordinals};
use super::pierce::front;
use nalgebra::{Point2, Point3, Vector3};
use premio_kernel::brep::topology::FaceId;
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::surface::Surface;
use premio_visibility::contours::Contour;
use premio_visibility::ray_casting::FirstHit;

/// The lateral distance from a contour at which its sides are evaluated, relative to the part's
/// size.
const ASIDE: f64 = 1.0 / 65_536.0;
/// The accuracy of the polylines of a light's view, relative to the part's size. They only
/// determine which curve another one ends on, and approximately where.
const LIGHT_FINE: f64 = 1.0 / 4096.0;
/// The least distance of a face behind a contour for a shadow on it to be distinguished, relative
/// to the part's size.
const BEHIND: f64 = 1.0 / 1024.0;
/// The length in pixels by which the ends of a shadow's boundary are extended, so that they reach
/// the arcs on which they end, which are accurate to [`FINE`].
const OVERLAP: f64 = 2.0 * FINE;

/// The end of a shadow's boundary on an arc.
struct ArcEnd {
    arc: u32,
    point: [f64; 2],
}

/// A piece of a contour of a light's view, in front of a face that it partly hides.
struct Cast<'c> {
    contour: &'c Contour,
    range: [f64; 2],
    ground: FaceId,
    /// The distance of the ground from the start of the light's lines of sight, at the middle.
    hint: f64,
    /// A lit point of the ground, near the middle.
    lit: Point3<f64>,
}

/// Adds the visible boundaries of cast shadows to the arcs of a view, and stops the arcs where
/// these end.
pub fn add_shadows(stage: &LitScene<'_>, window: &ImageWindow, arcs: &mut Vec<PredictedArc>) {
    let lines = Lines::new(arcs);
    let mut found = Vec::new();
    let mut ends = Vec::new();
    for (light, StageLight { views, .. }) in stage.lights.iter().enumerate() {
        if stage.is_next_to_camera(light) {
            continue;
        }
        for view in views {
            let ordinals = ordinals(&view.contours);
            let seen = seen_by_light(stage, view, &ordinals);
            let mut add = |source: ArcSource, shade: Option<Shade>, line: &Polyline| {
                let ground = source.ground();
                for part in visible_parts(stage, &lines, ground, line, &mut ends) {
                    found.push(PredictedArc {
                        source,
                        contour: None,
                        smooth: matches!(source, ArcSource::Terminator { .. }),
                        coefficients: Vec::new(),
                        line: part,
                        stops: Vec::new(),
                        shade,
                        within: None,
                    });
                }
            };
            for cast in casts(stage, view, &seen) {
                if let Some(line) = shadow(stage, view, &cast, window) {
                    let lit = lit_side(stage, view, &cast);
                    let shade = lit.map(|lit| Shade { light, lit });
                    add(source(light, &cast, &ordinals), shade, &line);
                }
            }
            for limb in &seen {
                if let Some(found) = terminator(stage, light, view, limb, window) {
                    add(found.source, None, &found.line);
                }
            }
        }
    }
    for ArcEnd { arc, point } in ends {
        let arc: &mut PredictedArc = &mut arcs[arc as usize];
        if let Some(at) = arc.line.nearest(&point) {
            arc.stop_at(point, at);
        }
    }
    arcs.extend(found);
}

fn source(light: usize, cast: &Cast<'_>, ordinals: &[u32]) -> ArcSource {
    let (light, face) = (light as u32, cast.ground.0);
    match cast.contour.edge {
        Some(edge) => ArcSource::EdgeShadow {
            light,
            edge: edge.0,
            face,
        },
        None => ArcSource::LimbShadow {
            light,
            caster: cast.contour.faces[0].0,
            ordinal: ordinals[cast.contour.id as usize],
            face,
        },
    }
}

/// The view of a light.
fn seen_by_light(
    stage: &LitScene<'_>,
    view: &Sightings<'_>,
    ordinals: &[u32],
) -> Vec<PredictedArc> {
    let everywhere = ImageWindow {
        min: [f64::NEG_INFINITY; 2],
        max: [f64::INFINITY; 2],
    };
    view.arcs(ordinals, light_unit(stage, view) * LIGHT_FINE, &everywhere)
}

/// The boundary between the parts of a face that are turned towards a light and away from it.
struct Terminator {
    source: ArcSource,
    line: Polyline,
}

/// The terminator of a face, if the light's view has a limb there, as the camera sees it.
fn terminator(
    stage: &LitScene<'_>,
    light: usize,
    view: &Sightings<'_>,
    limb: &PredictedArc,
    window: &ImageWindow,
) -> Option<Terminator> {
    let ArcSource::Limb { face, ordinal } = limb.source else {
        return None;
    };
    let contour = &view.contours.contours[limb.contour? as usize];
    let camera = stage.view.scene.projection;
    let curve = |t: f64| {
        let p = contour.space_curve.point(t);
        (camera.depth(&p) > camera.near).then(|| shown(camera, &p))
    };
    let range = [limb.line.parameters[0], *limb.line.parameters.last()?];
    let straight = matches!(contour.space_curve, Curve::Line(_));
    let mut line = flatten(curve, range, straight, tolerance(window))?;
    draw_out(&mut line);
    let source = ArcSource::Terminator {
        light: light as u32,
        face,
        ordinal,
    };
    Some(Terminator { source, line })
}

/// The pieces of a light's view that cast a shadow on the part.
fn casts<'v>(
    stage: &LitScene<'_>,
    view: &'v Sightings<'_>,
    seen: &[PredictedArc],
) -> Vec<Cast<'v>> {
    let size = light_unit(stage, view);
    let mut casts = Vec::new();
    for arc in seen.iter().filter(|arc| !arc.smooth) {
        let Some(contour) = arc.contour.map(|id| &view.contours.contours[id as usize]) else {
            continue;
        };
        let last = arc.line.points.len() - 1;
        let mut from = 0;
        for &to in arc.stops.iter().chain([&last]) {
            let ends = [from, to].map(|k| stage_parameter(view, contour, &arc.line, k));
            from = to;
            casts.extend(cast(stage, view, contour, ends, size));
        }
    }
    casts
}

/// The length in a light's image of the part's radius near its centre.
fn light_unit(stage: &LitScene<'_>, view: &Sightings<'_>) -> f64 {
    let projection = view.scene.projection;
    let centre = stage.subject.centre;
    let across = Vector3::ith(projection.axis().abs().imin(), stage.subject.radius);
    (projection.project(&(centre + across)) - projection.project(&centre)).norm()
}

/// The parameter at a point of a polyline; where an arc ends behind it, as accurate as f64 allows.
fn stage_parameter(view: &Sightings<'_>, contour: &Contour, line: &Polyline, k: usize) -> f64 {
    let mut t = line.parameters[k];
    if k == 0 || k + 1 == line.points.len() {
        return t;
    }
    let p = Point2::from(line.points[k]);
    let step = (line.parameters[k + 1] - line.parameters[k - 1]) * ASIDE;
    for _ in 0..4 {
        let at = |t: f64| view.scene.projection.project(&contour.space_curve.point(t));
        let along = (at(t + step) - at(t - step)) / (2.0 * step);
        let off = (p - at(t)).dot(&along) / along.norm_squared();
        if !off.is_finite() {
            break;
        }
        t += off;
    }
    let [lo, hi] = [line.parameters[k - 1], line.parameters[k + 1]];
    t.clamp(lo.min(hi), lo.max(hi))
}

/// The cast of a piece: there is one where a face lies behind one side of it.
fn cast<'v>(
    stage: &LitScene<'_>,
    view: &Sightings<'_>,
    contour: &'v Contour,
    range: [f64; 2],
    size: f64,
) -> Option<Cast<'v>> {
    let projection = view.scene.projection;
    let t = 0.5 * (range[0] + range[1]);
    let p = contour.space_curve.point(t);
    let step = (range[1] - range[0]) * ASIDE;
    let image = |t: f64| projection.project(&contour.space_curve.point(t));
    let along = image(t + step) - image(t - step);
    let across = nalgebra::Vector2::new(-along.y, along.x) / along.norm();
    if !across.x.is_finite() {
        return None;
    }
    let outwards = open_direction(stage, view, contour, &p)?;
    let depth = projection.depth(&p);
    let towards = projection.project(&(p + outwards * (stage.subject.radius * ASIDE)));
    let first = (towards - projection.project(&p)).dot(&across).signum();
    [first, -first].into_iter().find_map(|side| {
        let aside = projection.project(&p) + across * (side * size * ASIDE);
        let FirstHit { face, point: q } = view.scene.nearest(&aside)?;
        let jump = projection.depth(&q) - depth;
        let origin = projection.line_of_sight(&aside).origin;
        (jump > BEHIND * stage.subject.radius).then(|| Cast {
            contour,
            range,
            ground: face,
            hint: (q - origin).norm(),
            lit: q,
        })
    })
}

/// The direction in which a light's lines of sight probably pass a point of a contour: out of the
/// faces that are turned away from it. None where both faces of an edge are turned towards the
/// light, so that no face next to the edge lies behind it.
fn open_direction(
    stage: &LitScene<'_>,
    view: &Sightings<'_>,
    contour: &Contour,
    p: &Point3<f64>,
) -> Option<Vector3<f64>> {
    let towards = view.scene.projection.towards_eye(p).direction;
    let outward = |face: &FaceId| stage.subject.brep.outward(*face, p);
    let is_turned = |n: &Vector3<f64>| n.dot(&towards) > 0.0;
    let normals = || contour.faces.iter().map(outward);
    if contour.edge.is_some() && normals().count() == 2 && normals().all(|n| is_turned(&n)) {
        return None;
    }
    let away: Vector3<f64> = normals().filter(|n| !is_turned(n)).sum();
    // The normal of a limb is perpendicular to the line of sight, whatever the computed sign.
    Some(if away == Vector3::zeros() {
        normals().sum()
    } else {
        away
    })
}

/// The projection on the ground of the point of a cast at a parameter, as the camera sees it.
fn fall(
    stage: &LitScene<'_>,
    view: &Sightings<'_>,
    cast: &Cast<'_>,
    t: f64,
) -> Option<ProjectedPoint> {
    let light = view.scene.projection;
    let camera = stage.view.scene.projection;
    let image = light.project(&cast.contour.space_curve.point(t));
    let sight = light.line_of_sight(&image);
    let far = front(stage.subject.brep, cast.ground, &sight, cast.hint)?;
    let p = sight.origin + sight.direction * far;
    (camera.depth(&p) > camera.near).then(|| shown(camera, &p))
}

/// The image of the projection of a cast on its ground.
fn shadow(
    stage: &LitScene<'_>,
    view: &Sightings<'_>,
    cast: &Cast<'_>,
    window: &ImageWindow,
) -> Option<Polyline> {
    let straight = matches!(cast.contour.space_curve, Curve::Line(_))
        && matches!(stage.subject.brep.surface(cast.ground), Surface::Plane(_));
    let curve = |t: f64| fall(stage, view, cast, t);
    let mut line = flatten(curve, cast.range, straight, tolerance(window))?;
    draw_out(&mut line);
    Some(line)
}

fn tolerance(window: &ImageWindow) -> FlatteningTolerance<'_> {
    FlatteningTolerance { fine: FINE, window }
}

/// Extends both ends of a polyline by [`OVERLAP`].
fn draw_out(line: &mut Polyline) {
    let n = line.points.len();
    for (end, before) in [(0, 1), (n - 1, n - 2)] {
        let [p, q] = [line.points[end], line.points[before]];
        let length = (p[0] - q[0]).hypot(p[1] - q[1]);
        if length > OVERLAP {
            let by = OVERLAP / length;
            line.points[end] = [p[0] + by * (p[0] - q[0]), p[1] + by * (p[1] - q[1])];
        }
    }
}

/// The lit side of a shadow's boundary: the side of a point next to its middle, which is nearer to
/// the boundary than the accuracy of its polyline.
fn lit_side(stage: &LitScene<'_>, view: &Sightings<'_>, cast: &Cast<'_>) -> Option<ArcSide> {
    let [from, to] = cast.range;
    let (t, step) = (0.5 * (from + to), (to - from) * ASIDE);
    let at = |t: f64| fall(stage, view, cast, t).map(|p| [p.image.x, p.image.y]);
    let [before, middle, after] = [at(t - step)?, at(t)?, at(t + step)?];
    let lit = stage.view.scene.projection.project(&cast.lit);
    let along = [after[0] - before[0], after[1] - before[1]];
    let ahead = [middle[0] + along[0], middle[1] + along[1]];
    Some(ArcSide::new([lit.x, lit.y], [middle, ahead]))
}

/// The parts of a curve on a face that the camera sees, with the arcs on which these end.
fn visible_parts(
    stage: &LitScene<'_>,
    lines: &Lines,
    ground: Option<FaceId>,
    line: &Polyline,
    ends: &mut Vec<ArcEnd>,
) -> Vec<Polyline> {
    let mut cuts = lines.crossings(line);
    let last = line.points.len() - 2;
    let end = |segment: usize, fraction: f64| PolylineCrossing {
        at: PolylinePoint { segment, fraction },
        arc: None,
    };
    cuts.push(end(0, 0.0));
    cuts.push(end(last, 1.0));
    cuts.sort_by(|a, b| {
        let order = a.at.segment.cmp(&b.at.segment);
        order.then(a.at.fraction.total_cmp(&b.at.fraction))
    });
    let mut parts = Vec::new();
    for pair in cuts.windows(2) {
        let [from, to] = [pair[0], pair[1]];
        let part = line.part(from.at, to.at);
        let Some(middle) = part.middle().filter(|_| part.length() > OVERLAP) else {
            continue;
        };
        let i = middle.segment;
        let depth = 0.5 * (part.depths[i] + part.depths[i + 1]);
        let is_seen = stage.seen(part.position(middle)).is_some_and(|hit| {
            let off = stage.view.scene.projection.scale(&hit.point) - depth;
            Some(hit.face) == ground && off.abs() < stage.subject.radius * 64.0 * BEHIND
        });
        if is_seen {
            for cut in [from, to] {
                let point = line.position(cut.at);
                ends.extend(cut.arc.map(|arc| ArcEnd { arc, point }));
            }
            parts.push(part);
        }
    }
    parts
}
