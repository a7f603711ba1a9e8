//! Quantitative invisibility of the pieces of contours (Appel 1967, Loutrel 1970; section 4.1.2
//! of the paper).

mod chain;
pub(crate) mod correction;

use crate::contour_generator::contour_arc::{Change, ContourArc, Passing};
use crate::contour_generator::junctions::Junctions;
use crate::image_curve::Image;
use crate::invisibility::chain::{Chain, Span};
use crate::invisibility::correction::{Corrections, End};
use crate::ray_casting::{Occluders, OriginIncidence};
use crate::scene::Scene;
use crate::scene::tolerance::SPACE_TOLERANCE;
use nalgebra::{Point3, Vector3};
use premio_kernel::brep::topology::FaceId;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::number::predicates::{Compare, ROUNDING};
use serde::Serialize;

/// A piece of a contour between two junctions, with constant visibility.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ContourPiece {
    /// The range of the curve's parameter, increasing; it may pass the end of a period.
    #[serde(rename = "t")]
    pub range: [f64; 2],
    /// Whether no face occludes it.
    pub visible: bool,
    /// The number of faces turned towards the eye that lie in front of it.
    #[serde(rename = "qi")]
    pub quantitative_invisibility: u32,
    /// The one of them nearest to the eye.
    pub occluder: Option<FaceId>,
    /// The junction at its start; none for a whole closed contour.
    pub start: Option<u32>,
    /// The junction at its end.
    pub end: Option<u32>,
    /// Points of it, where requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub samples: Option<Vec<[f64; 3]>>,
}

/// How the quantitative invisibility of the pieces is computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Method {
    /// Counted once for each connected part of the contours, and propagated from there.
    #[default]
    Propagated,
    /// Counted for every piece.
    Recounted,
}

/// The positions in a piece at which its occluders are counted, one after the other until a count
/// is unambiguous. The middle is not used, because a symmetric part has its special points there.
/// The last ones are near the ends, where contours that diverge slowly are farthest from each
/// other.
const PLACES: [f64; 5] = [0.47, 0.31, 0.73, 0.07, 0.93];

/// The count for a piece of an arc over [lo, hi].
pub(crate) fn count(scene: &Scene<'_>, arc: &ContourArc<'_>, [lo, hi]: [f64; 2]) -> Occluders {
    let at = |part: f64| count_at(scene, arc, lo + (hi - lo) * part);
    let mut ambiguous = Vec::with_capacity(PLACES.len());
    for place in PLACES {
        let count = at(place);
        if count.unambiguous {
            return count;
        }
        ambiguous.push(count);
    }
    // Contours that overlap are ambiguous everywhere, and the counts agree.
    ambiguous.sort_by_key(|c| c.quantitative_invisibility);
    ambiguous.swap_remove(PLACES.len() / 2)
}

fn count_at(scene: &Scene<'_>, arc: &ContourArc<'_>, t: f64) -> Occluders {
    let p = &arc.curve.point(t);
    let v = scene.projection.towards_eye(p).direction;
    let own = |face: FaceId| {
        if !arc.faces.iter().any(|f| f.face == face) {
            return OriginIncidence::No;
        }
        let surface = scene.brep.surface(face);
        // A limb along the edge is within the tolerance of points computed in two ways: over this
        // length the normal turns with the surface's curvature.
        let bend = surface.normal_curvature(p, &v).abs();
        let turned = SPACE_TOLERANCE * (scene.resolution * bend + ROUNDING);
        let grazing = surface.normal(p).dot(&v).is_within(turned);
        if arc.limb || grazing {
            OriginIncidence::Tangent
        } else {
            OriginIncidence::Through
        }
    };
    if matches!(arc.image, Image::Point) {
        return scene.count_end_on(p, &inward(scene, arc, p, &v), &own);
    }
    scene.count(p, &arc.curve.tangent(t), &own)
}

/// The directions perpendicular to the line of sight that bisect the material around an edge, which
/// lies between each two of its faces.
fn inward(
    scene: &Scene<'_>,
    arc: &ContourArc<'_>,
    p: &Point3<f64>,
    v: &Vector3<f64>,
) -> Vec<Vector3<f64>> {
    let halved = arc.faces.chunks(2).map(|pair| {
        let normals = pair.iter().map(|f| scene.brep.outward(f.face, p));
        let inward = -normals.sum::<Vector3<f64>>();
        inward - v * inward.dot(v)
    });
    let directions = halved.map(|d| d / d.norm());
    directions.filter(|d| d.norm().is_beyond(0.5)).collect()
}

/// The pieces of all arcs, in order: one count at one piece of each connected part of the contours,
/// propagated from there where the change of the occluders is unambiguous.
pub(crate) fn pieces(
    scene: &Scene<'_>,
    contour_arcs: &mut [ContourArc<'_>],
    junctions: &mut Junctions<'_>,
    method: Method,
) -> Vec<Vec<ContourPiece>> {
    let near = SPACE_TOLERANCE * scene.resolution;
    let cut = contour_arcs.iter_mut();
    let chains: Vec<Chain> = cut.map(|s| Chain::new(s, junctions, near)).collect();
    let contour_arcs = &*contour_arcs;
    let carried = match method {
        Method::Propagated => Carrying::new(scene, contour_arcs, &chains, junctions).counts(),
        Method::Recounted => None,
    };
    let counted = || {
        let all = contour_arcs.iter().zip(&chains);
        let of = |(arc, chain): (_, &Chain)| {
            let spans = chain.spans.iter();
            spans.map(|s| count(scene, arc, s.clear)).collect()
        };
        all.map(of).collect()
    };
    let counts: Vec<Vec<Occluders>> = carried.unwrap_or_else(counted);
    let pieces = chains.iter().zip(counts).map(|(chain, counts)| {
        let spans = chain.spans.iter().zip(counts);
        spans.map(|(span, count)| piece(span, &count)).collect()
    });
    pieces.collect()
}

fn piece(span: &Span, count: &Occluders) -> ContourPiece {
    ContourPiece {
        range: span.range,
        visible: count.quantitative_invisibility == 0,
        quantitative_invisibility: count.quantitative_invisibility,
        occluder: count.occluder(),
        start: span.ends[0],
        end: span.ends[1],
        samples: None,
    }
}

/// An arc through a junction.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Through {
    junction: u32,
    arc: u32,
}

/// The faces that hide a span next to the junction at one of its ends.
struct Local {
    junction: u32,
    hiding: Vec<FaceId>,
}

/// The propagation of quantitative invisibility through the connected parts of the contours.
struct Carrying<'s, 'a> {
    scene: &'s Scene<'a>,
    contour_arcs: &'s [ContourArc<'s>],
    chains: &'s [Chain],
    junctions: &'s Junctions<'s>,
    corrections: Corrections<'s, 'a>,
    /// By junction: the occluders of all contours there, without the faces through the junction.
    beyond: Vec<Option<Occluders>>,
    /// The arcs through the junctions, in order.
    through: Vec<Through>,
    /// By arc: the occluders of each span.
    counts: Vec<Vec<Option<Occluders>>>,
    /// The arcs that are connected to known spans.
    next: Vec<u32>,
    /// Whether the results propagated to each junction on different ways agree.
    sound: bool,
}

impl<'s, 'a> Carrying<'s, 'a> {
    fn new(
        scene: &'s Scene<'a>,
        contour_arcs: &'s [ContourArc<'s>],
        chains: &'s [Chain],
        junctions: &'s Junctions<'s>,
    ) -> Self {
        let mut through: Vec<Through> = Vec::with_capacity(2 * junctions.list.len());
        for (i, chain) in chains.iter().enumerate() {
            let ids = chain.spans.iter().flat_map(|s| s.ends).flatten();
            through.extend(ids.map(|junction| Through {
                junction,
                arc: i as u32,
            }));
        }
        through.sort_unstable();
        through.dedup();
        Self {
            scene,
            contour_arcs,
            chains,
            junctions,
            corrections: Corrections::new(scene),
            beyond: vec![None; junctions.list.len()],
            through,
            counts: chains.iter().map(|c| vec![None; c.spans.len()]).collect(),
            next: Vec::new(),
            sound: true,
        }
    }

    /// The occluders of every span; none where the ways to a junction contradict each other, so
    /// that a change must have been missed.
    fn counts(mut self) -> Option<Vec<Vec<Occluders>>> {
        for i in 0..self.contour_arcs.len() as u32 {
            self.next.push(i);
            while let Some(i) = self.next.pop() {
                if self.counts[i as usize].iter().any(Option::is_none) {
                    self.arc(i as usize);
                }
                if !self.sound {
                    return None;
                }
            }
        }
        let whole = |counts: Vec<Option<Occluders>>| counts.into_iter().collect();
        self.counts.into_iter().map(whole).collect()
    }

    /// Propagates along an arc, from the end at which a count is known.
    fn arc(&mut self, i: usize) {
        let n = self.chains[i].spans.len();
        let first = self.enter(i, 0, 0);
        let last = match first {
            Some(_) => None,
            None => self.enter(i, n - 1, 1),
        };
        let backward = last.is_some();
        let mut known = first.or(last);
        for step in 0..n {
            let k = if backward { n - 1 - step } else { step };
            let [entry, exit] = if backward { [1, 0] } else { [0, 1] };
            let span = self.chains[i].spans[k];
            let now = known.take().unwrap_or_else(|| {
                let now = count(self.scene, &self.contour_arcs[i], span.clear);
                self.leave(i, k, entry, &now);
                now
            });
            self.leave(i, k, exit, &now);
            let between = if backward { k.checked_sub(1) } else { Some(k) };
            let change = between.and_then(|b| self.chains[i].between.get(b));
            let then = if backward { k.wrapping_sub(1) } else { k + 1 };
            known = match change {
                // Counts where contours overlap are not propagated.
                Some(Change::Pass(passing)) if now.unambiguous => {
                    let p = self.contour_arcs[i].curve.point(span.range[exit]);
                    let passing = if backward {
                        passing.reversed()
                    } else {
                        *passing
                    };
                    carry(self.scene, &p, now.clone(), &passing)
                }
                Some(Change::Correct) => self.enter(i, then, entry),
                Some(Change::Pass(_)) | None => None,
            };
            self.counts[i][k] = Some(now);
        }
    }

    /// The faces at a junction at an end of a span that hide it there, where it is unambiguous that
    /// these alone make the difference between the contours at the junction.
    fn local(&self, i: usize, k: usize, which: usize) -> Option<Local> {
        let Span { range, ends, .. } = self.chains[i].spans[k];
        let junction = ends[which]?;
        if self.junctions.is_ambiguous(junction) {
            return None;
        }
        let end = End {
            arc: &self.contour_arcs[i],
            t: range[which],
            middle: 0.5 * (range[0] + range[1]),
        };
        let hiding = self.corrections.hiding(self.junctions, junction, &end)?;
        Some(Local { junction, hiding })
    }

    /// The occluders of a span at one of its ends, from those known at the junction there.
    fn enter(&self, i: usize, k: usize, which: usize) -> Option<Occluders> {
        let junction = self.chains[i].spans[k].ends[which]?;
        let beyond = self.beyond[junction as usize].as_ref()?;
        let Local { hiding, .. } = self.local(i, k, which)?;
        Some(beyond.before(&hiding))
    }

    /// Records the occluders of a span for the others at the junction at one of its ends.
    fn leave(&mut self, i: usize, k: usize, which: usize, count: &Occluders) {
        if !count.unambiguous {
            return;
        }
        let Some(Local { junction, hiding }) = self.local(i, k, which) else {
            return;
        };
        let Some(beyond) = count.beyond(&hiding) else {
            self.sound = false;
            return;
        };
        match &self.beyond[junction as usize] {
            Some(known) => {
                self.sound &= known.quantitative_invisibility == beyond.quantitative_invisibility
            }
            None => {
                self.beyond[junction as usize] = Some(beyond);
                let first = self.through.partition_point(|t| t.junction < junction);
                let past = self.through.partition_point(|t| t.junction <= junction);
                let others = self.through[first..past].iter().rev().map(|t| t.arc);
                self.next.extend(others.filter(|&o| o != i as u32));
            }
        }
    }
}

/// The count after a passage behind another contour at `p`, where it follows from the count
/// before.
///
/// Faces meet along edges only, so between passages those that hide keep their order.
fn carry(
    scene: &Scene<'_>,
    p: &Point3<f64>,
    before: Occluders,
    passing: &Passing,
) -> Option<Occluders> {
    let quantitative_invisibility = before
        .quantitative_invisibility
        .checked_add_signed(passing.by)?;
    let order = order_after(scene, p, before, passing)?;
    let known = order.len() as u32;
    let sound = known <= quantitative_invisibility && (known > 0 || quantitative_invisibility == 0);
    sound.then_some(Occluders {
        quantitative_invisibility,
        order,
        unambiguous: true,
    })
}

/// The order of the faces in front after a passage, as far as it is known.
fn order_after(
    scene: &Scene<'_>,
    p: &Point3<f64>,
    before: Occluders,
    passing: &Passing,
) -> Option<Vec<FaceId>> {
    let whole = before.is_whole();
    let mut order = before.order;
    let last = order.len();
    let Some(left) = passing.left else {
        let Some(entered) = passing.entered else {
            return Some(order);
        };
        match slot(scene, p, &order, passing.ahead) {
            Slot::Before(k) if k < last || whole => order.insert(k, entered),
            Slot::Before(_) => {}
            Slot::Unclear(k) => order.truncate(k),
        }
        return Some(order);
    };
    let Some(k) = order.iter().position(|&face| face == left) else {
        // It is behind all those known.
        let behind = !whole && slot(scene, p, &order, passing.ahead) == Slot::Before(last);
        return behind.then_some(order);
    };
    // A plane is intersected once; of another surface a second sheet may hide, and either may end
    // here.
    let plane = matches!(scene.brep.surface(left), Surface::Plane(_));
    if !plane && (!whole || order[k + 1..].contains(&left)) {
        order.truncate(k);
        return Some(order);
    }
    match passing.entered {
        Some(entered) => order[k] = entered,
        None => {
            order.remove(k);
        }
    }
    Some(order)
}

/// A position in the order of faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Slot {
    /// Just before the one with this index, behind all others before it.
    Before(usize),
    /// Behind those before this index; not clearly before or behind that one.
    Unclear(usize),
}

/// The position of the distance `ahead` in the order of the faces in front of `p`.
fn slot(scene: &Scene<'_>, p: &Point3<f64>, order: &[FaceId], ahead: f64) -> Slot {
    let margin = SPACE_TOLERANCE * scene.resolution;
    for (k, &face) in order.iter().enumerate() {
        let (mut before, mut behind) = (false, false);
        scene.depths(p, face, &mut |s| {
            before |= s.is_beyond(ahead - margin);
            behind |= s.is_short_of(ahead + margin);
        });
        match (before, behind) {
            (true, false) => {}
            (false, true) => return Slot::Before(k),
            _ => return Slot::Unclear(k),
        }
    }
    Slot::Before(order.len())
}
