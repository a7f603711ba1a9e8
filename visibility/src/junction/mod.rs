//! T-junctions: the pairs of contours that can cross in the image, and where they do.

mod arc_position;
mod broad_phase;
mod crossing_effect;
mod intersect;
mod intersect_general;
pub(crate) mod overlap;
pub(crate) mod snap;

use crate::contour_generator::contour_arc::{ArcJunction, Change, ContourArc, Split};
use crate::contour_generator::junctions::{JunctionKind, JunctionSupport, Junctions};
use crate::image_curve::{Image, image_distance};
use crate::junction::arc_position::{ArcPosition, ArcSplit, CrossedArc, IndexedArc};
use crate::junction::broad_phase::candidates;
use crate::junction::crossing_effect::{change, is_turned_away};
use crate::junction::intersect::{Overlap, cross, parameters_at};
use crate::junction::snap::{Settled, nearest_turn, settle, split_at_touches};
use crate::scene::Scene;
use crate::scene::tolerance::IMAGE_TOLERANCE;
use nalgebra::{Point3, Vector3};
use premio_kernel::number::predicates::Compare;
use std::collections::HashSet;

/// Whether an arc passes a junction in the image at that junction and nowhere else: one of its own,
/// and it is straight.
fn passes_once(contour_arc: &ContourArc<'_>, id: u32) -> bool {
    matches!(contour_arc.image, Image::Line { .. })
        && contour_arc.junctions().any(|own| own.junction == id)
}

/// The index of the end of an arc that is nearest to a parameter.
fn nearest_end(contour_arc: &ContourArc<'_>, t: f64) -> usize {
    let [lo, hi] = contour_arc.range;
    usize::from((t - lo).is_beyond(hi - t))
}

struct Search<'s, 'a, 'j, 'p> {
    scene: &'s Scene<'a>,
    junctions: &'j mut Junctions<'p>,
    /// The splits found so far.
    splits: Vec<ArcSplit>,
    /// By arc: the image points at which overlapping arcs end and that were already processed.
    processed: Vec<Vec<[f64; 2]>>,
    /// The passages behind junctions of other arcs.
    behind: Vec<Behind>,
    /// The arcs that are cut at junctions in which others end, by their indices.
    cut_at_ends: HashSet<(u32, u32)>,
}

/// A junction of a nearer arc that coincides with a point of a farther arc in the image.
#[derive(Clone, Copy, Debug)]
struct Behind {
    /// The farther arc, and its parameter.
    contour_arc: u32,
    t: f64,
    /// The contours of the nearer and of the farther arc.
    contours: [u32; 2],
}

/// Finds all T-junctions and records them as splits of the farther arcs.
pub fn find(contour_arcs: &mut [ContourArc<'_>], scene: &Scene<'_>, junctions: &mut Junctions<'_>) {
    split_at_touches(contour_arcs, scene, junctions);
    let pairs = candidates(
        contour_arcs,
        scene.projection,
        IMAGE_TOLERANCE * scene.resolution,
    );
    let mut search = Search {
        scene,
        junctions,
        splits: Vec::new(),
        processed: vec![Vec::new(); contour_arcs.len()],
        behind: Vec::new(),
        cut_at_ends: HashSet::new(),
    };
    for (i, j) in pairs {
        search.pair(
            IndexedArc::new(i, &contour_arcs[i as usize]),
            IndexedArc::new(j, &contour_arcs[j as usize]),
        );
    }
    for (i, a) in contour_arcs.iter().enumerate() {
        search.alone(IndexedArc::new(i as u32, a));
    }
    let Search { splits, behind, .. } = search;
    for ArcSplit { index, split } in splits {
        contour_arcs[index as usize].splits.push(split);
    }
    for behind in behind {
        behind.cut(
            &mut contour_arcs[behind.contour_arc as usize],
            scene,
            junctions,
        );
    }
}

impl Behind {
    /// Cuts the farther arc, where it is not cut yet. More changes there than the crossing contour
    /// determines.
    fn cut(
        self,
        contour_arc: &mut ContourArc<'_>,
        scene: &Scene<'_>,
        junctions: &mut Junctions<'_>,
    ) {
        let near = 2.0 * IMAGE_TOLERANCE * scene.resolution;
        let curve = contour_arc.curve;
        let p = curve.point(self.t);
        let here = |t: f64| (curve.point(t) - p).norm().is_within(near);
        let is_cut = contour_arc.junctions().any(|own| here(own.t));
        for split in contour_arc.splits.iter_mut().filter(|split| here(split.t)) {
            split.change = Change::Correct;
        }
        if is_cut {
            return;
        }
        let junction = junctions.add(JunctionKind::T, JunctionSupport::Alone, &p);
        junctions.list[junction as usize].contours = self.contours.to_vec();
        contour_arc.splits.push(Split {
            t: self.t,
            junction,
            change: Change::Correct,
        });
    }
}

impl Search<'_, '_, '_, '_> {
    /// Finds the crossings and overlaps of two arcs, or of an arc with itself.
    fn pair(&mut self, first: IndexedArc<'_, '_>, second: IndexedArc<'_, '_>) {
        let (a, b) = (first.arc, second.arc);
        let Scene {
            projection,
            resolution,
            ..
        } = *self.scene;
        let mut found = |t: f64, s: f64| self.crossing(first.at(t), second.at(s));
        let overlap = cross(a, b, projection, resolution, &mut found);
        self.mark_passed_ambiguous(a, b);
        self.mark_passed_ambiguous(b, a);
        self.pass_behind(a, second);
        self.pass_behind(b, first);
        if first.index == second.index {
            return;
        }
        self.turns(first, second);
        self.turns(second, first);
        if overlap == Overlap::Yes {
            self.overlap(first, b);
            self.overlap(second, a);
            self.mark_all_ambiguous(a);
            self.mark_all_ambiguous(b);
        }
    }

    /// Finds where an image that turns back overlaps itself.
    fn alone(&mut self, contour_arc: IndexedArc<'_, '_>) {
        let a = contour_arc.arc;
        if !a.turns.is_empty() {
            self.overlap(contour_arc, a);
        }
        if !a.turns.is_empty() || matches!(a.image, Image::Point) {
            self.mark_all_ambiguous(a);
        }
    }

    /// Settles a parameter on its arc. A point where the image turns back on itself counts as an
    /// end.
    fn settle(&self, contour_arc: &ContourArc<'_>, t: f64) -> Option<Settled> {
        let near = IMAGE_TOLERANCE * self.scene.resolution;
        let settled = settle(contour_arc, t, near)?;
        if !contour_arc.turns.is_empty() {
            // The image has zero speed at a turning point: a short piece of the image is a long
            // piece of the curve.
            let p = contour_arc.curve.point(settled.t);
            if let Some(t) = self.stop_next_to(contour_arc, settled.t, &p, near) {
                return Some(Settled { t, at_end: true });
            }
        }
        Some(settled)
    }

    /// The turning point or end of an arc that its image reaches from `t` in a straight line and
    /// that lies within `near` of `q` in the image.
    fn stop_next_to(
        &self,
        contour_arc: &ContourArc<'_>,
        t: f64,
        q: &Point3<f64>,
        near: f64,
    ) -> Option<f64> {
        let ends = (!contour_arc.closed).then_some(contour_arc.range);
        let mut stops = contour_arc
            .turns
            .iter()
            .copied()
            .chain(ends.into_iter().flatten());
        stops.find(|&stop| {
            let apart = self.apart(q, &contour_arc.curve.point(stop));
            apart.is_at_most(near) && self.straight(contour_arc, stop, t)
        })
    }

    /// The distance of two points in the image, as a distance in space.
    fn apart(&self, p: &Point3<f64>, q: &Point3<f64>) -> f64 {
        image_distance(self.scene.projection, p, q)
    }

    /// Whether the image between two parameters is straight within the resolution.
    fn straight(&self, contour_arc: &ContourArc<'_>, from: f64, to: f64) -> bool {
        if let Image::Line { .. } = contour_arc.image {
            return true;
        }
        let [p, m, q] = [from, 0.5 * (from + to), to].map(|t| contour_arc.curve.point(t));
        let chord = Point3::from((p.coords + q.coords) * 0.5);
        self.apart(&m, &chord)
            .is_at_most(IMAGE_TOLERANCE * self.scene.resolution)
    }

    /// Whether a crossing is the common junction of both arcs. Their images may be tangent there,
    /// as those of a limb and of the edge on which it ends, and rounding moves such a root a long
    /// way. Between the root and the junction both images are straight within the resolution, so
    /// they coincide.
    fn at_shared(&self, a: &ContourArc<'_>, t: f64, b: &ContourArc<'_>, s: f64) -> bool {
        a.junctions().any(|own| {
            b.junctions()
                .filter(|other| other.junction == own.junction)
                .any(|other| {
                    self.straight(a, nearest_turn(a, own.t, t), t)
                        && self.straight(b, nearest_turn(b, other.t, s), s)
                })
        })
    }

    fn crossing(&mut self, first: ArcPosition<'_, '_>, second: ArcPosition<'_, '_>) {
        let (a, b) = (first.arc, second.arc);
        let near = IMAGE_TOLERANCE * self.scene.resolution;
        if a.junctions()
            .any(|own| passes_once(a, own.junction) && passes_once(b, own.junction))
        {
            return;
        }
        let Some(t) = self.settle(a, first.t) else {
            return;
        };
        let Some(s) = self.settle(b, second.t) else {
            return;
        };
        if self.at_shared(a, t.t, b, s.t) {
            return;
        }
        let (p, q) = (a.curve.point(t.t), b.curve.point(s.t));
        let v = self.scene.projection.towards_eye(&p).direction;
        let ahead = (q - p).dot(&v);
        if ahead.is_within(2.0 * near) {
            self.mark_ambiguous(a, t);
            self.mark_ambiguous(b, s);
            let both = [first.moved_to(t.t), second.moved_to(s.t)];
            return match [t.at_end, s.at_end] {
                [false, false] => self.meeting(both, &p),
                [false, true] => self.cut_at_end(both[0], b, s),
                [true, false] => self.cut_at_end(both[1], a, t),
                [true, true] => {}
            };
        }
        let (first, second) = (first.crossed(t, p), second.crossed(s, q));
        if ahead.is_above_zero() {
            self.junction(second, first, &v);
        } else {
            self.junction(first, second, &v);
        }
    }

    /// Contours of faces that touch intersect in space. The front one may change there, and neither
    /// contour determines what hides them.
    fn meeting(&mut self, both: [ArcPosition<'_, '_>; 2], p: &Point3<f64>) {
        let junction = self
            .junctions
            .add(JunctionKind::T, JunctionSupport::Alone, p);
        self.junctions.list[junction as usize].contours =
            both.iter().map(|position| position.arc.contour).collect();
        self.junctions.mark_ambiguous(junction);
        let change = Change::Correct;
        self.splits.extend(both.map(|position| ArcSplit {
            index: position.index,
            split: Split {
                t: position.t,
                junction,
                change,
            },
        }));
    }

    /// Cuts an arc that passes, in space, through the end of another, such as a limb through a corner
    /// of its face. At a turning point of the other there is nothing to cut.
    fn cut_at_end(&mut self, position: ArcPosition<'_, '_>, other: &ContourArc<'_>, end: Settled) {
        let nearest = nearest_end(other, end.t);
        let curve = other.curve;
        let away = (curve.point(other.range[nearest]) - curve.point(end.t)).norm();
        let near = 2.0 * IMAGE_TOLERANCE * self.scene.resolution;
        let Some(junction) = other.ends[nearest].filter(|_| away.is_within(near)) else {
            return;
        };
        if !self.cut_at_ends.insert((position.index, junction)) {
            return;
        }
        let contours = &mut self.junctions.list[junction as usize].contours;
        contours.push(position.arc.contour);
        self.splits.push(ArcSplit {
            index: position.index,
            split: Split {
                t: position.t,
                junction,
                change: Change::Correct,
            },
        });
    }

    /// Handles turning points of an arc's image that touch another contour without a crossing of
    /// the images.
    fn turns(&mut self, first: IndexedArc<'_, '_>, second: IndexedArc<'_, '_>) {
        let (a, b) = (first.arc, second.arc);
        let near = IMAGE_TOLERANCE * self.scene.resolution;
        for &t in &a.turns {
            let p = a.curve.point(t);
            let mut met = Vec::new();
            parameters_at(b, &p, self.scene, &mut |s| met.push(s));
            for s in met {
                if self.apart(&p, &b.curve.point(s)).is_at_most(near) {
                    self.crossing(first.at(t), second.at(s));
                }
            }
        }
    }

    /// Marks the end of an arc at a parameter as ambiguous, because another contour passes it.
    fn mark_ambiguous(&mut self, contour_arc: &ContourArc<'_>, at: Settled) {
        if !at.at_end {
            return;
        }
        let p = contour_arc.curve.point(at.t);
        let nearest = nearest_end(contour_arc, at.t);
        for (k, (id, t)) in contour_arc.ends.iter().zip(contour_arc.range).enumerate() {
            let near = 2.0 * IMAGE_TOLERANCE * self.scene.resolution;
            let passed =
                k == nearest || self.apart(&p, &contour_arc.curve.point(t)).is_at_most(near);
            if let (true, &Some(id)) = (passed, id) {
                self.junctions.mark_ambiguous(id);
            }
        }
    }

    /// Marks the junctions of `far` that `near` passes in front of in the image, even if it only
    /// touches there. Where the images are nearly tangent, two crossings count as a touch. If `far`
    /// ends between the two, it has only one of them: `near` may lie behind the end and come in front
    /// within the length of the tangency.
    fn mark_passed_ambiguous(&mut self, far: &ContourArc<'_>, near: &ContourArc<'_>) {
        let margin = 2.0 * IMAGE_TOLERANCE * self.scene.resolution;
        let tangency = (margin * self.scene.bounds().diagonal()).sqrt();
        for ArcJunction { junction: id, t } in far.junctions() {
            let known = passes_once(near, id) || self.junctions.is_ambiguous(id);
            if known || !near.hull.contains(self.junctions.image(id)) {
                continue;
            }
            let p = far.curve.point(t);
            let v = self.scene.projection.towards_eye(&p).direction;
            let least = match near.junctions().any(|own| own.junction == id) {
                true => margin,
                false => -tangency,
            };
            let mut passed = false;
            parameters_at(near, &p, self.scene, &mut |s| {
                let q = near.curve.point(s);
                let ahead = (q - p).dot(&v);
                passed |= ahead.is_beyond(least) && self.apart(&p, &q).is_at_most(margin);
            });
            if passed {
                self.junctions.mark_ambiguous(id);
            }
        }
    }

    /// Records where `far` passes behind the junctions of `near` in the image. Contours that only
    /// touch it there end there or become hidden, so it may pass between their surfaces.
    fn pass_behind(&mut self, near: &ContourArc<'_>, far: IndexedArc<'_, '_>) {
        for own in near.junctions() {
            let image = self.junctions.image(own.junction);
            if !far.arc.hull.contains(image) || passes_once(far.arc, own.junction) {
                continue;
            }
            let q = near.curve.point(own.t);
            let mut behind = std::mem::take(&mut self.behind);
            parameters_at(far.arc, &q, self.scene, &mut |t| {
                behind.extend(self.behind_at(near, own.junction, &q, far.at(t)));
            });
            self.behind = behind;
        }
    }

    /// The passage behind one junction of `near` with the position `q`, at a position on a farther
    /// arc.
    fn behind_at(
        &self,
        near: &ContourArc<'_>,
        junction: u32,
        q: &Point3<f64>,
        position: ArcPosition<'_, '_>,
    ) -> Option<Behind> {
        let margin = 2.0 * IMAGE_TOLERANCE * self.scene.resolution;
        let far = position.arc;
        let Settled { t, at_end: false } = self.settle(far, position.t)? else {
            return None;
        };
        let p = far.curve.point(t);
        let v = self.scene.projection.towards_eye(&p).direction;
        let ahead = (q - p).dot(&v);
        if ahead.is_at_most(margin) || self.apart(&p, q).is_beyond(margin) {
            return None;
        }
        // A cusp's own contour overlaps itself in the image over a long way.
        let own = |other: ArcJunction| {
            other.junction == junction && self.straight(far, nearest_turn(far, other.t, t), t)
        };
        if far.junctions().any(own) || is_turned_away(self.scene, near, q, &v) {
            return None;
        }
        Some(Behind {
            contour_arc: position.index,
            t,
            contours: [near.contour, far.contour],
        })
    }

    /// Marks all junctions of an arc as ambiguous, because another contour overlaps it.
    fn mark_all_ambiguous(&mut self, contour_arc: &ContourArc<'_>) {
        for own in contour_arc.junctions() {
            self.junctions.mark_ambiguous(own.junction);
        }
    }

    /// Splits the farther arc at a T-junction.
    fn junction(
        &mut self,
        nearer: CrossedArc<'_, '_>,
        farther: CrossedArc<'_, '_>,
        v: &Vector3<f64>,
    ) {
        let (near, far) = (nearer.arc, farther.arc);
        let (t, p) = (farther.at, farther.point);
        if t.at_end {
            return self.mark_ambiguous(far, t);
        }
        // An invisible contour has no junction.
        let Some(change) = change(self.scene, &nearer, &farther, v) else {
            return;
        };
        let position = IndexedArc::new(farther.index, far).at(t.t);
        self.split(position, &p, [near.contour, far.contour], change);
    }

    /// Splits an arc at a new junction of two contours.
    fn split(
        &mut self,
        position: ArcPosition<'_, '_>,
        p: &Point3<f64>,
        contours: [u32; 2],
        change: Change,
    ) {
        let junction = self
            .junctions
            .add(JunctionKind::T, JunctionSupport::Alone, p);
        self.junctions.list[junction as usize].contours = contours.to_vec();
        self.splits.push(ArcSplit {
            index: position.index,
            split: Split {
                t: position.t,
                junction,
                change,
            },
        });
    }

    /// Splits an arc where `b`, which overlaps it in the image, begins and ends.
    fn overlap(&mut self, first: IndexedArc<'_, '_>, b: &ContourArc<'_>) {
        if b.closed && b.turns.is_empty() {
            return;
        }
        for s in b.turns.iter().copied().chain(b.range) {
            let q = b.curve.point(s);
            if self.was_processed(first.index, &q) {
                continue;
            }
            let mut met = Vec::new();
            parameters_at(first.arc, &q, self.scene, &mut |t| met.push(t));
            for t in met {
                self.overlap_end(first.at(t), &q, b.contour);
            }
        }
    }

    /// Whether an arc was already split at an image point, which is recorded. In a symmetric view
    /// many ends coincide.
    fn was_processed(&mut self, index: u32, q: &Point3<f64>) -> bool {
        let h = self.scene.projection.homogeneous(q);
        let processed = &mut self.processed[index as usize];
        let at = [h.x / h.z, h.y / h.z];
        let near = self.scene.resolution * h.z.recip();
        let is_known = processed
            .iter()
            .any(|p| (p[0] - at[0]).hypot(p[1] - at[1]).is_within(near));
        if !is_known {
            processed.push(at);
        }
        is_known
    }

    /// Splits an arc where the end `q` of an arc of another contour lies on it in the image.
    fn overlap_end(&mut self, position: ArcPosition<'_, '_>, q: &Point3<f64>, other: u32) {
        let a = position.arc;
        let near = IMAGE_TOLERANCE * self.scene.resolution;
        let Some(t) = self.settle(a, position.t) else {
            return;
        };
        let p = a.curve.point(t.t);
        // Where a curve without a closed form is not reached, its nearest point is no end.
        let apart = self.apart(&p, q);
        if t.at_end || apart.is_beyond(4.0 * IMAGE_TOLERANCE * self.scene.resolution) {
            return;
        }
        // Near a turning point or an end, where no monotone arc has a direction, that point is
        // meant.
        if self.stop_next_to(a, t.t, q, apart.max(near)).is_some() {
            return;
        }
        let contours = [other, a.contour];
        self.split(position.moved_to(t.t), &p, contours, Change::Correct);
    }
}
