//! Arcs with their indices, and positions on them.

use crate::contour_generator::contour_arc::{ContourArc, Split};
use crate::junction::snap::Settled;
use nalgebra::Point3;

/// An arc with its index.
#[derive(Clone, Copy)]
pub(super) struct IndexedArc<'x, 'a> {
    pub(super) index: u32,
    pub(super) arc: &'x ContourArc<'a>,
}

/// A parameter of an arc.
#[derive(Clone, Copy)]
pub(super) struct ArcPosition<'x, 'a> {
    pub(super) index: u32,
    pub(super) arc: &'x ContourArc<'a>,
    pub(super) t: f64,
}

/// An arc that crosses another one in the image.
#[derive(Clone, Copy)]
pub(super) struct CrossedArc<'x, 'a> {
    pub(super) index: u32,
    pub(super) arc: &'x ContourArc<'a>,
    /// The parameter of the crossing.
    pub(super) at: Settled,
    /// The point there.
    pub(super) point: Point3<f64>,
}

/// A split of the arc with an index.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArcSplit {
    pub(super) index: u32,
    pub(super) split: Split,
}

impl<'x, 'a> IndexedArc<'x, 'a> {
    pub(super) fn new(index: u32, arc: &'x ContourArc<'a>) -> Self {
        Self { index, arc }
    }

    pub(super) fn at(self, t: f64) -> ArcPosition<'x, 'a> {
        let Self { index, arc } = self;
        ArcPosition { index, arc, t }
    }
}

impl<'x, 'a> ArcPosition<'x, 'a> {
    /// The position with another parameter.
    pub(super) fn moved_to(self, t: f64) -> Self {
        Self { t, ..self }
    }

    /// The arc with a crossing there.
    pub(super) fn crossed(self, at: Settled, point: Point3<f64>) -> CrossedArc<'x, 'a> {
        let Self { index, arc, .. } = self;
        CrossedArc {
            index,
            arc,
            at,
            point,
        }
    }
}
