//! Sheets: views side by side on paper, as ISO 5456-2 places them, with a frame and a title block.
//!
//! Lengths are millimetres on the paper, from its lower left corner, y up.

use super::Drawing;
use nalgebra::{Point2, Point3, Vector2, Vector3};
use premio_kernel::unit::Unit;
use premio_text::number;
use premio_visibility::camera::{CameraError, ViewCamera};
use std::collections::BTreeMap;

/// A view along an axis of the part's frame, z up, or the isometric one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum StandardView {
    /// Along y: x to the right.
    Front,
    /// Against y.
    Back,
    /// Along x.
    Left,
    /// Against x: y to the right.
    Right,
    /// From above: x to the right, y up.
    Top,
    /// From below.
    Bottom,
    /// Front, right and top at once, the three axes of one length.
    Isometric,
}

impl StandardView {
    /// The name used in outputs.
    pub fn name(self) -> &'static str {
        match self {
            Self::Front => "front",
            Self::Back => "back",
            Self::Left => "left",
            Self::Right => "right",
            Self::Top => "top",
            Self::Bottom => "bottom",
            Self::Isometric => "iso",
        }
    }

    /// The camera of the view of a part about its middle, which is the origin of the image; `size`
    /// is any length of the part's order.
    ///
    /// # Errors
    /// `middle` or `size` is not finite or beyond 1e100, or `size` is so small that the eye is in
    /// the middle.
    pub fn camera(self, middle: Point3<f64>, size: f64) -> Result<ViewCamera, CameraError> {
        let (from, up) = match self {
            Self::Front => (-Vector3::y(), Vector3::z()),
            Self::Back => (Vector3::y(), Vector3::z()),
            Self::Left => (-Vector3::x(), Vector3::z()),
            Self::Right => (Vector3::x(), Vector3::z()),
            Self::Top => (Vector3::z(), Vector3::y()),
            Self::Bottom => (-Vector3::z(), -Vector3::y()),
            Self::Isometric => (Vector3::new(1.0, -1.0, 1.0), Vector3::z()),
        };
        ViewCamera::orthographic(middle + from * size, middle, up)
    }
}

/// The projection method: the side of the front view on which another is placed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Angle {
    /// Opposite to the viewing side: the view from above is placed below.
    #[default]
    First,
    /// On the viewing side: the view from above is placed above.
    Third,
}

impl Angle {
    /// The column and the row of a view relative to the front view, to the right and up.
    fn cell(self, view: StandardView) -> [i32; 2] {
        let side = match self {
            Self::First => -1,
            Self::Third => 1,
        };
        match view {
            StandardView::Front => [0, 0],
            StandardView::Right => [side, 0],
            StandardView::Left => [-side, 0],
            StandardView::Top => [0, side],
            StandardView::Bottom => [0, -side],
            StandardView::Back => [2, 0],
            StandardView::Isometric => [side, side],
        }
    }
}

/// A paper of ISO 216 in landscape format.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Paper {
    /// 1189 mm by 841 mm.
    A0,
    /// 841 mm by 594 mm.
    A1,
    /// 594 mm by 420 mm.
    A2,
    /// 420 mm by 297 mm.
    #[default]
    A3,
    /// 297 mm by 210 mm.
    A4,
}

impl Paper {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::A0 => "A0",
            Self::A1 => "A1",
            Self::A2 => "A2",
            Self::A3 => "A3",
            Self::A4 => "A4",
        }
    }

    /// Its width and height.
    pub fn size(self) -> Vector2<f64> {
        let [width, height] = match self {
            Self::A0 => [1189.0, 841.0],
            Self::A1 => [841.0, 594.0],
            Self::A2 => [594.0, 420.0],
            Self::A3 => [420.0, 297.0],
            Self::A4 => [297.0, 210.0],
        };
        Vector2::new(width, height)
    }
}

/// The scale: a length on the paper for a length of the part.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scale {
    /// On the paper.
    pub drawn: f64,
    /// Of the part.
    pub of: f64,
}

impl Scale {
    /// The quotient.
    pub(crate) fn ratio(self) -> f64 {
        self.drawn / self.of
    }

    /// The greatest scale of ISO 5455 (1, 2 and 5, and their tenfolds) that is at most a ratio.
    fn at_most(ratio: f64) -> Self {
        let steps = |ten: i32| [1.0, 2.0, 5.0].map(|step| step * 10f64.powi(ten));
        let tens = |range: std::ops::Range<i32>| range.flat_map(steps);
        let enlarging = tens(0..DECADES).rfind(|n| *n <= ratio);
        match enlarging {
            Some(drawn) => Self { drawn, of: 1.0 },
            None => {
                let least = tens(0..DECADES).find(|n| 1.0 <= ratio * n);
                let of = least.unwrap_or(f64::INFINITY);
                Self { drawn: 1.0, of }
            }
        }
    }
}

/// The number of powers of ten in each direction over which a scale is searched.
const DECADES: i32 = 16;

impl std::fmt::Display for Scale {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}:{}", number(self.drawn), number(self.of))
    }
}

/// The options of a sheet.
#[derive(Clone, Debug, PartialEq)]
pub struct SheetOptions {
    /// The title.
    pub title: String,
    /// The part's unit.
    pub unit: Unit,
    /// The paper.
    pub paper: Paper,
    /// The scale; none for the greatest that fits.
    pub scale: Option<Scale>,
    /// The projection method.
    pub angle: Angle,
}

impl SheetOptions {
    /// A title on the default sheet: millimetres, A3, the greatest scale, first angle projection.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio_drawing::sheet::{Paper, SheetOptions};
    ///
    /// assert_eq!(SheetOptions::new("plate").paper, Paper::A3);
    /// ```
    pub fn new(title: impl Into<String>) -> Self {
        Self {
            title: title.into(),
            unit: Unit::default(),
            paper: Paper::default(),
            scale: None,
            angle: Angle::default(),
        }
    }
}

/// Why views cannot be placed on a sheet.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SheetError {
    /// There is no room for them.
    #[error("at {scale} the views take {} mm by {} mm, and {paper} has {room_width:.0} mm by {room_height:.0} mm for them; use a larger `--paper`, a smaller `--scale`, or no `--scale`", number(width.round()), number(height.round()), paper = paper.name())]
    Room {
        /// The scale.
        scale: Scale,
        /// The size of the views.
        width: f64,
        /// The size of the views.
        height: f64,
        /// The paper.
        paper: Paper,
        /// The available room.
        room_width: f64,
        /// The available room.
        room_height: f64,
    },
    /// A view in perspective has a scale.
    #[error("a view in perspective has no scale")]
    Perspective,
    /// The views are so small or so large that no scale fits them onto paper.
    #[error("no scale fits a size of {size:e} mm onto paper")]
    Size {
        /// The size of the views.
        size: f64,
    },
}

/// The weight of a line of the frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Weight {
    /// The frame.
    Thick,
    /// Between the cells of the title block, and in its symbol.
    Thin,
}

/// An element of the frame or the title block.
#[derive(Clone, Debug, PartialEq)]
pub enum SheetMark {
    /// A straight line.
    Line([Point2<f64>; 2], Weight),
    /// A circle, by centre and radius.
    Circle(Point2<f64>, f64),
    /// A line of text: the left end of its base line, the height of its capital letters, and the
    /// text.
    Text(Point2<f64>, f64, String),
}

/// A placed view.
#[derive(Clone, Debug)]
pub struct PlacedView {
    /// Its name.
    pub name: &'static str,
    /// Its strokes.
    pub drawing: Drawing,
    /// The position of the origin of its image on the paper.
    pub at: Point2<f64>,
}

/// Views on a paper.
#[derive(Clone, Debug)]
pub struct Sheet {
    /// The width and height of the paper.
    pub size: Vector2<f64>,
    /// The views.
    pub views: Vec<PlacedView>,
    /// Frame and title block.
    pub marks: Vec<SheetMark>,
    /// The millimetres on paper of one image unit.
    pub factor: f64,
    /// The scale; none where the views are in perspective.
    pub scale: Option<Scale>,
    /// The options.
    pub options: SheetOptions,
}

/// The distance of the frame from the left edge of the paper, for filing, and from the other edges
/// (ISO 5457).
const FILING: f64 = 20.0;
const MARGIN: f64 = 10.0;
/// The title block.
const TITLE: [f64; 2] = [180.0, 24.0];
/// The least distance between views, and between them and the frame.
const GAP: f64 = 12.0;

/// The extent of columns, or of rows: how far the views in each extend on both sides of the
/// origins.
type Bands = BTreeMap<i32, [f64; 2]>;

/// A drawing to be placed on a sheet.
#[derive(Clone, Debug)]
pub struct SheetView {
    /// The view that it shows; none for another viewpoint.
    pub view: Option<StandardView>,
    /// The drawing.
    pub drawing: Drawing,
}

/// How large the views of a sheet are.
struct Fit {
    /// The millimetres of an image unit.
    factor: f64,
    /// The corresponding scale; none where the views have none.
    scale: Option<Scale>,
}

impl Sheet {
    /// Places views on a paper. A view without a name must be the only one.
    ///
    /// # Errors
    /// The paper has no room for the views at the requested scale, a scale is requested for a view
    /// in perspective, or the views are too small or too large for any scale.
    pub fn new(views: Vec<SheetView>, options: SheetOptions) -> Result<Self, SheetError> {
        let cell = |view: Option<StandardView>| view.map_or([0, 0], |v| options.angle.cell(v));
        let mut resolutions: [Bands; 2] = Default::default();
        for SheetView { view, drawing } in &views {
            let [low, high] = drawing.extent;
            for (axis, resolutions) in resolutions.iter_mut().enumerate() {
                let nothing = [f64::NEG_INFINITY; 2];
                let reach = resolutions.entry(cell(*view)[axis]).or_insert(nothing);
                reach[0] = reach[0].max(-low[axis]);
                reach[1] = reach[1].max(high[axis]);
            }
        }
        let [low, high] = room(options.paper);
        let to_scale = views.iter().all(|view| view.drawing.to_scale);
        let taken = resolutions.each_ref().map(|b| b.values().flatten().sum());
        let gaps = resolutions.each_ref().map(|b| (b.len() + 1) as f64 * GAP);
        let Fit { factor, scale } = fitted(taken, gaps, high - low, to_scale, &options)?;
        let places = [0, 1].map(|axis: usize| {
            let free = (high - low)[axis] - taken[axis] * factor;
            let gap = free / (resolutions[axis].len() + 1) as f64;
            origins(&resolutions[axis], low[axis], gap, factor)
        });
        let placed = views.into_iter().map(|SheetView { view, drawing }| {
            let [column, row] = cell(view);
            PlacedView {
                name: view.map_or("view", StandardView::name),
                drawing,
                at: Point2::new(places[0][&column], places[1][&row]),
            }
        });
        Ok(Self {
            size: options.paper.size(),
            views: placed.collect(),
            marks: marks(&options, scale),
            factor,
            scale,
            options,
        })
    }
}

/// The lower left and the upper right corner of the room for views.
fn room(paper: Paper) -> [Vector2<f64>; 2] {
    let low = Vector2::new(FILING, MARGIN + TITLE[1]);
    [low, paper.size() - Vector2::new(MARGIN, MARGIN)]
}

/// The largest size in which views fit, or that of the requested scale.
fn fitted(
    taken: [f64; 2],
    gaps: [f64; 2],
    room: Vector2<f64>,
    to_scale: bool,
    options: &SheetOptions,
) -> Result<Fit, SheetError> {
    let fits = |axis: usize| (room[axis] - gaps[axis]) / taken[axis];
    let most = fits(0).min(fits(1));
    let size = taken[0].max(taken[1]) * options.unit.millimetres();
    if !(most > 0.0 && most.is_finite()) {
        return Err(SheetError::Size { size });
    }
    if !to_scale {
        return match options.scale {
            Some(_) => Err(SheetError::Perspective),
            None => Ok(Fit {
                factor: most,
                scale: None,
            }),
        };
    }
    let scale = match options.scale {
        Some(scale) => scale,
        None => Scale::at_most(most / options.unit.millimetres()),
    };
    let factor = scale.ratio() * options.unit.millimetres();
    if !(factor > 0.0 && factor.is_finite()) {
        return Err(SheetError::Size { size });
    }
    if factor > most {
        return Err(SheetError::Room {
            scale,
            width: taken[0] * factor + gaps[0],
            height: taken[1] * factor + gaps[1],
            paper: options.paper,
            room_width: room.x,
            room_height: room.y,
        });
    }
    Ok(Fit {
        factor,
        scale: Some(scale),
    })
}

/// The origins of columns, or of rows, one after the other, with the gap before and between them.
fn origins(resolutions: &Bands, start: f64, gap: f64, factor: f64) -> BTreeMap<i32, f64> {
    let mut at = start;
    let mut places = BTreeMap::new();
    for (&number, [before, after]) in resolutions {
        at += gap + before * factor;
        places.insert(number, at);
        at += after * factor;
    }
    places
}

/// The widths of the title block's cells: title, scale, unit, paper, projection.
const CELLS: [f64; 5] = [96.0, 24.0, 18.0, 18.0, 24.0];
/// The heights of capital letters: of labels, of their values, and at most of the title.
const LABEL: f64 = 1.8;
const VALUE: f64 = 3.5;
const NAME: f64 = 5.0;
/// The distance of text from the lines around it.
const INSET: f64 = 2.0;
/// The greatest width of a letter, relative to its height.
const WIDE: f64 = 0.9;

/// The frame and the title block.
fn marks(options: &SheetOptions, scale: Option<Scale>) -> Vec<SheetMark> {
    let [left, bottom] = [FILING, MARGIN];
    let corner = options.paper.size() - Vector2::new(MARGIN, MARGIN);
    let (right, top) = (corner.x, corner.y);
    let mut marks = Vec::new();
    let mut line = |from: [f64; 2], to: [f64; 2], weight| {
        marks.push(SheetMark::Line([from.into(), to.into()], weight));
    };
    line([left, bottom], [right, bottom], Weight::Thick);
    line([right, bottom], [right, top], Weight::Thick);
    line([right, top], [left, top], Weight::Thick);
    line([left, top], [left, bottom], Weight::Thick);
    let ceiling = bottom + TITLE[1];
    let mut x = right - TITLE[0];
    line([x, ceiling], [right, ceiling], Weight::Thick);
    line([x, bottom], [x, ceiling], Weight::Thick);
    let scale = scale.map_or("none".to_owned(), |s| s.to_string());
    let values = [
        ("TITLE", options.title.clone()),
        ("SCALE", scale),
        ("UNIT", options.unit.symbol().to_owned()),
        ("PAPER", options.paper.name().to_owned()),
    ];
    for ((label, value), width) in values.into_iter().zip(CELLS) {
        let highest = if label == "TITLE" { NAME } else { VALUE };
        let letters = value.chars().count().max(1) as f64;
        let height = highest.min((width - 2.0 * INSET) / (letters * WIDE));
        let text =
            |up: f64, height, text| SheetMark::Text([x + INSET, bottom + up].into(), height, text);
        marks.push(text(TITLE[1] - INSET - LABEL, LABEL, label.to_owned()));
        marks.push(text((TITLE[1] - highest) / 2.0, height, value));
        x += width;
        let divider = [[x, bottom].into(), [x, ceiling].into()];
        marks.push(SheetMark::Line(divider, Weight::Thin));
    }
    let middle = Point2::new(x + CELLS[4] / 2.0, bottom + TITLE[1] / 2.0);
    marks.extend(symbol(middle, options.angle));
    marks
}

/// The symbol of the projection: a truncated cone from the side, and from its small end. That view
/// is next to the small end in third angle projection, and next to the large end in first angle
/// projection.
fn symbol(middle: Point2<f64>, angle: Angle) -> Vec<SheetMark> {
    const SMALL: f64 = 2.0;
    const LARGE: f64 = 4.0;
    const LONG: f64 = 8.0;
    const APART: f64 = 5.5;
    let side = match angle {
        Angle::First => -APART,
        Angle::Third => APART,
    };
    let cone = middle + Vector2::new(side, 0.0);
    let corner = |x: f64, y: f64| cone + Vector2::new(x * LONG / 2.0, y);
    let corners = [
        corner(-1.0, SMALL),
        corner(1.0, LARGE),
        corner(1.0, -LARGE),
        corner(-1.0, -SMALL),
    ];
    let lines = (0..4).map(|i| SheetMark::Line([corners[i], corners[(i + 1) % 4]], Weight::Thin));
    let end = middle - Vector2::new(side, 0.0);
    let circles = [SMALL, LARGE].map(|radius| SheetMark::Circle(end, radius));
    lines.chain(circles).collect()
}

#[cfg(test)]
mod tests;
