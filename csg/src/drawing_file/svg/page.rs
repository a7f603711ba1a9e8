//! The size of a page, its unit of length and its origin.

use super::super::DrawingShape;
use super::attributes::decimal;
use super::name;
use crate::figure::{ContourCorner, FigureArc, FigureEdge, FigurePoint, PlaneMap};
use premio_kernel::number::rational::{Rational, to_f64};
use roxmltree::{Document, Node};
use std::str::FromStr;
use svgtypes::{Align, AspectRatio, Length, LengthUnit, ViewBox};

/// The page: the element `svg`. Like in OpenSCAD the last one counts for all shapes.
pub(super) struct Page {
    /// The factors of lengths along the axes.
    scale: [Rational; 2],
    /// The first corner of the view box.
    corner: FigurePoint,
    /// The height in millimetres.
    height: Rational,
    /// The distance from the corner of the page to that of the view box.
    margin: [Rational; 2],
}

impl Page {
    pub fn new(document: &Document<'_>, dpi: &Rational) -> Self {
        let mut page = None;
        let mut end = 0;
        for node in document.descendants().filter(Node::is_element) {
            // Elements come in the order of the file: those within `defs` begin before it ends.
            match name(&node) {
                "defs" => end = end.max(node.range().end),
                "svg" if node.range().start >= end => page = Some(node),
                _ => {}
            }
        }
        let zero = || Rational::ZERO;
        let mut result = Self {
            scale: [Rational::ONE, Rational::ONE],
            corner: [zero(), zero()],
            height: zero(),
            margin: [zero(), zero()],
        };
        let default = Rational::from(72);
        let dpi = match *dpi > Rational::ZERO {
            true => dpi,
            false => &default,
        };
        if let Some(node) = page {
            result.read(&node, dpi);
        }
        result
    }

    fn read(&mut self, node: &Node<'_, '_>, dpi: &Rational) {
        let view = node.attribute("viewBox").and_then(numbers);
        let length = |name: &str, index: usize| {
            let length = Length::from_str(node.attribute(name).unwrap_or_default());
            millimetres(length.ok(), view.as_ref().map(|view| &view[2 + index]), dpi)
        };
        let size = [length("width", 0), length("height", 1)];
        self.height = size[1].clone();
        let Some([x, y, width, height]) = view else {
            return;
        };
        let extent = [width, height];
        self.corner = [x, y];
        self.scale = [0, 1].map(|i| &size[i] / &extent[i]);
        let ratio = node.attribute("preserveAspectRatio").unwrap_or_default();
        let ratio = AspectRatio::from_str(ratio);
        let (align, slice) = ratio.map_or((Align::XMidYMid, false), |r| (r.align, r.slice));
        let Some(parts) = before(align) else {
            return;
        };
        let [a, b] = self.scale.clone();
        let scale = if slice { a.max(b) } else { a.min(b) };
        let two = Rational::from(2);
        self.margin = [0, 1].map(|i| {
            let rest = &size[i] - &scale * &extent[i];
            rest * Rational::from(parts[i]) / &two
        });
        self.scale = [scale.clone(), scale];
    }

    /// The scale of the page, with the second axis upwards.
    pub fn linear(&self) -> PlaneMap {
        let [x, y] = self.scale.clone();
        PlaneMap {
            matrix: [[x, Rational::ZERO], [Rational::ZERO, -y]],
            offset: [Rational::ZERO, Rational::ZERO],
        }
    }

    /// What is added to the shapes. Like in OpenSCAD a corner of the view box above or below the
    /// first axis moves them to the wrong side, and the middle of the drawing is not the origin if
    /// the corner of the view box is not.
    pub fn offset(&self, shapes: &[DrawingShape], is_centred: bool) -> FigurePoint {
        let [x, y] = [0, 1].map(|i| &self.scale[i] * &self.corner[i]);
        if !is_centred {
            let [left, top] = &self.margin;
            return [left - x, &self.height - y - top];
        }
        let half = Rational::ONE / Rational::from(2);
        let middle = |axis| {
            let ends = extent(shapes, axis);
            ends.map_or(Rational::ZERO, |[lo, hi]| (lo + hi) * &half)
        };
        [-middle(0) - x, -middle(1) - y]
    }
}

/// The numbers of a view box; `None` if it is malformed.
fn numbers(text: &str) -> Option<[Rational; 4]> {
    let view = ViewBox::from_str(text).ok()?;
    let each = [view.x, view.y, view.w, view.h].map(|x| decimal(x).ok());
    let [x, y, w, h] = each;
    Some([x?, y?, w?, h?])
}

/// A length of the page in millimetres, or one that follows from the view box.
fn millimetres(length: Option<Length>, view: Option<&Rational>, dpi: &Rational) -> Rational {
    let inch = Rational::from(254) / Rational::from(10);
    let view = view.cloned().unwrap_or(Rational::ZERO);
    let length = length.and_then(|length| Some((decimal(length.number).ok()?, length.unit)));
    let Some((number, unit)) = length else {
        return inch * view / dpi;
    };
    let per_inch = |count: i32| &inch * &number / Rational::from(count);
    match unit {
        LengthUnit::None => &inch * &number / dpi,
        LengthUnit::Px => per_inch(96),
        LengthUnit::Pt => per_inch(72),
        LengthUnit::Pc => per_inch(6),
        LengthUnit::In => per_inch(1),
        LengthUnit::Cm => number * Rational::from(10),
        LengthUnit::Mm => number,
        // OpenSCAD takes user units for millimetres.
        LengthUnit::Em | LengthUnit::Ex | LengthUnit::Percent => view,
    }
}

/// The number of halves of the rest of a page that lie before the view box; `None` if it is
/// stretched.
fn before(align: Align) -> Option<[i32; 2]> {
    Some(match align {
        Align::None => return None,
        Align::XMinYMin => [0, 0],
        Align::XMidYMin => [1, 0],
        Align::XMaxYMin => [2, 0],
        Align::XMinYMid => [0, 1],
        Align::XMidYMid => [1, 1],
        Align::XMaxYMid => [2, 1],
        Align::XMinYMax => [0, 2],
        Align::XMidYMax => [1, 2],
        Align::XMaxYMax => [2, 2],
    })
}

/// The least and the greatest coordinate along an axis.
fn extent(shapes: &[DrawingShape], axis: usize) -> Option<[Rational; 2]> {
    let mut all: Option<[Rational; 2]> = None;
    for contour in shapes.iter().flatten() {
        let next = contour.iter().cycle().skip(1);
        for (corner, next) in contour.iter().zip(next) {
            let [lo, hi] = edge_extent(corner, next, axis);
            all = Some(match all {
                Some([least, greatest]) => [least.min(lo), greatest.max(hi)],
                None => [lo, hi],
            });
        }
    }
    all
}

fn edge_extent(corner: &ContourCorner, next: &ContourCorner, axis: usize) -> [Rational; 2] {
    let ends = [&corner.point[axis], &next.point[axis]];
    let mut extent = [ends[0].min(ends[1]).clone(), ends[0].max(ends[1]).clone()];
    if let Some(arc) = &corner.arc {
        let edge = FigureEdge {
            start: corner.point.clone(),
            end: next.point.clone(),
            arc: Some(arc.clone()),
        };
        // The bounds differ from those of the ends where the arc reaches farther.
        let bounds = edge.bounds().map(|point| point[axis].to_bits());
        let reaches = [0, 1].map(|i| to_f64(&extent[i]).to_bits() != bounds[i]);
        let [lo, hi] = reached(arc, axis);
        let [is_less, is_greater] = reaches;
        if is_less {
            extent[0] = lo;
        }
        if is_greater {
            extent[1] = hi;
        }
    }
    extent
}

/// The least and the greatest coordinate of a circle.
fn reached(arc: &FigureArc, axis: usize) -> [Rational; 2] {
    let centre = &arc.centre[axis];
    [centre - &arc.radius, centre + &arc.radius]
}

/// Shapes with an offset.
pub(super) fn moved(shapes: Vec<DrawingShape>, offset: &FigurePoint) -> Vec<DrawingShape> {
    let point = |p: FigurePoint| [&p[0] + &offset[0], &p[1] + &offset[1]];
    let corner = |corner: ContourCorner| ContourCorner {
        point: point(corner.point),
        arc: corner.arc.map(|arc| FigureArc {
            centre: point(arc.centre),
            ..arc
        }),
    };
    let contour = |contour: Vec<ContourCorner>| contour.into_iter().map(corner).collect();
    let shape = |shape: DrawingShape| shape.into_iter().map(contour).collect();
    shapes.into_iter().map(shape).collect()
}
