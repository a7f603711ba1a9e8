//! Chains oriented edges to closed contours, and joins segments in line.

use super::scalar::{FilteredPoint, orientation};
use super::{FigureEdge, FigurePoint};
use premio_kernel::number::rational::{Rational, to_f64};
use std::cmp::Ordering;
use std::collections::BTreeMap;

/// The closed contours of edges of which as many start as end at every point. At a point where
/// several start, the one that turns most to the left continues, so contours touch rather than
/// cross themselves.
pub(super) fn chained(edges: Vec<FigureEdge>) -> Vec<Vec<FigureEdge>> {
    let mut from: BTreeMap<FigurePoint, Vec<usize>> = BTreeMap::new();
    for (i, edge) in edges.iter().enumerate() {
        from.entry(edge.start.clone()).or_default().push(i);
    }
    let mut used = vec![false; edges.len()];
    let mut contours = Vec::new();
    for first in 0..edges.len() {
        let mut contour = Vec::new();
        let mut next = Some(first);
        while let Some(i) = next.filter(|&i| !used[i]) {
            used[i] = true;
            contour.push(edges[i].clone());
            let edge = &edges[i];
            let open = from.get(&edge.end).into_iter().flatten();
            let open = open.copied().filter(|&j| !used[j]);
            let left = |j: usize| turn(edge, &edges[j]);
            next = open.max_by(|&a, &b| left(a).total_cmp(&left(b)));
        }
        if !contour.is_empty() {
            contours.push(contour);
        }
    }
    contours
}

/// The angle by which a segment turns left from another one.
fn turn(edge: &FigureEdge, next: &FigureEdge) -> f64 {
    let [u, v] = [edge, next].map(|e| [0, 1].map(|i| to_f64(&(&e.end[i] - &e.start[i]))));
    (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1])
}

/// The edges of a closed contour with segments in line joined.
pub(super) fn joined(edges: Vec<FigureEdge>) -> Vec<FigureEdge> {
    let mut kept: Vec<FigureEdge> = Vec::with_capacity(edges.len());
    for edge in edges {
        match kept.last_mut() {
            Some(last) if continues(last, &edge) => last.end = edge.end,
            _ => kept.push(edge),
        }
    }
    while let [first, .., last] = &kept[..]
        && kept.len() > 2
        && continues(last, first)
    {
        kept[0].start = last.start.clone();
        kept.pop();
    }
    kept
}

/// Whether an edge runs on from the end of another one in the same direction.
fn continues(edge: &FigureEdge, next: &FigureEdge) -> bool {
    if edge.arc.is_some() || next.arc.is_some() || edge.end != next.start {
        return false;
    }
    let [a, b, c] = [&edge.start, &edge.end, &next.end].map(FilteredPoint::new);
    let [u, v] = [&edge, &next].map(|e| [0, 1].map(|i| &e.end[i] - &e.start[i]));
    orientation(&a, &b, &c) == Ordering::Equal && &u[0] * &v[0] + &u[1] * &v[1] > Rational::ZERO
}
