//! Broad phase: the pairs of contours whose images may intersect. It uses boxes in an R-tree where
//! there are many, and chains of boxes for long contours.

use crate::camera::projection::Projection;
use crate::contour_generator::contour_arc::ContourArc;
use crate::image_curve::image_box::ImageBox;
use crate::image_curve::{Basis, Image, flat_of};
use premio_kernel::number::predicates::Compare;
use rstar::RTree;
use rstar::primitives::{GeomWithData, Rectangle};
use std::f64::consts::TAU;

/// A link of a chain.
struct Link {
    /// Its box in the image.
    bounds: ImageBox,
    /// The arc it belongs to.
    arc: u32,
}

/// The number of links up to which a sweep is faster than building a tree.
const FEW: usize = 192;

/// A contour is divided into links of about the image's size over this.
const LINKS: f64 = 24.0;

/// Up to four parameters at which an image is parallel to x or y.
#[derive(Clone, Copy, Debug, Default)]
struct Extremes {
    parameters: [f64; 4],
    count: usize,
}

/// The parameters at which the image of a conic is parallel to x or y, those of a closed one in the
/// period that begins at `lo`.
fn extremes(image: &Image, lo: f64) -> Extremes {
    let mut found = Extremes::default();
    let Image::Conic { basis, map, .. } = image else {
        return found;
    };
    let within = |t: f64| match basis {
        Basis::Circular => lo + (t - lo).rem_euclid(TAU),
        _ => t,
    };
    let q = map.row(2).transpose();
    for i in 0..2 {
        let p = map.row(i).transpose();
        let flat = Image::turns_of(*basis, &p, &q);
        for t in flat.into_iter().flatten() {
            found.parameters[found.count] = within(t);
            found.count += 1;
        }
    }
    found
}

/// The boxes of the links of an arc, each about `step` long.
fn links(
    contour_arc: &ContourArc<'_>,
    projection: &Projection,
    step: f64,
    push: &mut impl FnMut(ImageBox),
) {
    if !contour_arc.stretches.is_empty() {
        return contour_arc.stretches.iter().for_each(|s| push(s.bounds));
    }
    let [lo, hi] = contour_arc.range;
    let extremes = extremes(&contour_arc.image, lo);
    let turns = &extremes.parameters[..extremes.count];
    let point = |t: f64| flat_of(projection, &contour_arc.curve.point(t));
    let chain = |[from, to]: [f64; 2], ends: [[f64; 2]; 2]| {
        let mut b = ImageBox::EMPTY.with(ends[0]).with(ends[1]);
        for &t in turns.iter().filter(|t| t.lies_between([from, to])) {
            b = b.with(point(t));
        }
        for &t in contour_arc
            .turns
            .iter()
            .filter(|t| t.lies_between([from, to]))
        {
            b = b.with(point(t));
        }
        b
    };
    let whole = chain([lo, hi], [point(lo), point(hi)]);
    let [w, h] = whole.sides();
    let thick = match contour_arc.image {
        Image::Line { .. } => w.min(h),
        _ => w.max(h),
    };
    let n = (thick / step).ceil().clamp(1.0, 4.0 * LINKS);
    if n.is_at_most(1.0) {
        return push(whole);
    }
    let mut from = (lo, point(lo));
    for k in 1..=n as usize {
        let t = lo + (hi - lo) * (k as f64 / n);
        let to = (t, point(t));
        push(chain([from.0, to.0], [from.1, to.1]));
        from = to;
    }
}

/// The pairs of arcs whose images may intersect, each once and in order; also sets the hull of each
/// arc's image. `near` is the touching distance, as a distance in space.
pub fn candidates(
    contour_arcs: &mut [ContourArc<'_>],
    projection: &Projection,
    near: f64,
) -> Vec<(u32, u32)> {
    let mut part = ImageBox::EMPTY;
    let mut least = f64::INFINITY;
    for contour_arc in &*contour_arcs {
        for t in contour_arc.range {
            let p = contour_arc.curve.point(t);
            part = part.with(flat_of(projection, &p));
            least = least.min(projection.homogeneous(&p).z);
        }
    }
    let [w, h] = part.sides();
    let step = w.max(h) / LINKS;
    let grow = (near / least.max(near)).min(step);
    let mut all: Vec<Link> = Vec::with_capacity(contour_arcs.len() * 2);
    for (i, contour_arc) in contour_arcs.iter_mut().enumerate() {
        if matches!(contour_arc.image, Image::Point) {
            continue;
        }
        let mut hull = ImageBox::EMPTY;
        let arc = i as u32;
        links(contour_arc, projection, step, &mut |b| {
            let bounds = b.grown(grow);
            hull = hull.hull(&bounds);
            all.push(Link { bounds, arc });
        });
        contour_arc.hull = hull;
    }
    let mut pairs = if all.len() <= FEW {
        pairs_by_sweep(&mut all)
    } else {
        pairs_by_tree(&all)
    };
    let general = |s: &ContourArc<'_>| matches!(s.image, Image::General);
    let own = contour_arcs.iter().enumerate().filter(|(_, s)| general(s));
    pairs.extend(own.map(|(i, _)| (i as u32, i as u32)));
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// The pairs of arcs whose links intersect, by a sweep along x.
fn pairs_by_sweep(links: &mut [Link]) -> Vec<(u32, u32)> {
    links.sort_unstable_by(|a, b| a.bounds.min[0].total_cmp(&b.bounds.min[0]));
    let mut pairs = Vec::new();
    for (k, a) in links.iter().enumerate() {
        let end = a.bounds.max[0];
        let near = links[k + 1..].iter();
        for b in near.take_while(|b| b.bounds.min[0].is_at_most(end)) {
            if a.arc != b.arc && a.bounds.intersects(&b.bounds) {
                pairs.push((a.arc.min(b.arc), a.arc.max(b.arc)));
            }
        }
    }
    pairs
}

/// The pairs of arcs whose links intersect, by an R-tree.
fn pairs_by_tree(links: &[Link]) -> Vec<(u32, u32)> {
    let boxes = links.iter().map(|link| {
        let corners = Rectangle::from_corners(link.bounds.min, link.bounds.max);
        GeomWithData::new(corners, link.arc)
    });
    let tree = RTree::bulk_load(boxes.collect());
    tree.intersection_candidates_with_other_tree(&tree)
        .filter(|(a, b)| a.data < b.data)
        .map(|(a, b)| (a.data, b.data))
        .collect()
}
