//! Reads the strokes of a sheet written as DXF.

use super::Placing;
use nalgebra::{Point2, Vector2};
use premio_drawing::sheet::Sheet;
use premio_drawing::{Layer, Stroke, StrokeShape};
use std::f64::consts::TAU;

/// A group of the document.
#[derive(Clone, Copy, PartialEq)]
struct Group<'t> {
    code: u32,
    value: &'t str,
}

/// What a layer of the document shows.
struct ShownLayer {
    /// The layer of the drawing.
    layer: Layer,
    /// Whether its lines are visible.
    visible: bool,
}

/// The strokes of the views on a sheet, in the coordinates of the drawing.
pub(super) fn read(text: &str, sheet: &Sheet, paper: &Placing) -> Result<Vec<Stroke>, String> {
    // The part is at true size: a millimetre on paper is this many units.
    let unit = match sheet.scale {
        Some(_) => sheet.factor,
        None => 1.0,
    };
    let mut lines = text.lines();
    let mut groups: Vec<Group<'_>> = Vec::new();
    while let (Some(code), Some(value)) = (lines.next(), lines.next()) {
        let code = code.trim().parse().map_err(|e| format!("{code}: {e}"))?;
        groups.push(Group { code, value });
    }
    let entities = Group {
        code: 2,
        value: "ENTITIES",
    };
    let start = groups.iter().position(|g| *g == entities);
    let groups = &groups[start.ok_or("no entities")?..];
    let starts = groups.iter().enumerate().filter(|(_, g)| g.code == 0);
    let starts: Vec<usize> = starts.map(|(i, _)| i).collect();
    let mut strokes = Vec::new();
    for pair in starts.windows(2) {
        let entity = Entity {
            groups: &groups[pair[0]..pair[1]],
            unit,
            paper,
        };
        if entity.groups[0].value == "ENDSEC" {
            break;
        }
        let name = entity.text(8).ok_or("an entity without a layer")?;
        let Some(ShownLayer { layer, visible }) = shown_layer(name) else {
            continue;
        };
        strokes.push(Stroke {
            shape: entity.shape()?,
            layer,
            visible,
        });
    }
    Ok(strokes)
}

/// The layer of the drawing that a layer of the document shows; none for the frame and the title
/// block.
fn shown_layer(name: &str) -> Option<ShownLayer> {
    let (kind, seen) = name.rsplit_once('_')?;
    let mut all = Layer::ALL.into_iter();
    let layer = all.find(|layer| layer.name().eq_ignore_ascii_case(kind))?;
    Some(ShownLayer {
        layer,
        visible: seen == "VISIBLE",
    })
}

struct Entity<'t> {
    groups: &'t [Group<'t>],
    unit: f64,
    paper: &'t Placing,
}

impl Entity<'_> {
    fn text(&self, code: u32) -> Option<&str> {
        self.groups.iter().find(|g| g.code == code).map(|g| g.value)
    }

    fn numbers(&self, code: u32) -> impl Iterator<Item = Result<f64, String>> {
        let mine = self.groups.iter().filter(move |g| g.code == code);
        mine.map(|g| {
            let number = g.value.parse();
            number.map_err(|e| format!("{}: {e}", g.value))
        })
    }

    fn number(&self, code: u32) -> Result<f64, String> {
        self.numbers(code)
            .next()
            .ok_or(format!("no group {code}"))?
    }

    fn place(&self, x: f64, y: f64) -> Point2<f64> {
        self.paper.back(x * self.unit, y * self.unit)
    }

    /// The point of the group `code`; its y has the code plus ten.
    fn point(&self, code: u32) -> Result<Point2<f64>, String> {
        Ok(self.place(self.number(code)?, self.number(code + 10)?))
    }

    fn shape(&self) -> Result<StrokeShape, String> {
        let length = |x: f64| x * self.unit / self.paper.factor;
        match self.groups[0].value {
            "LINE" => Ok(StrokeShape::Line([self.point(10)?, self.point(11)?])),
            "LWPOLYLINE" => {
                let points = self.numbers(10).zip(self.numbers(20));
                let place =
                    |(x, y): (Result<f64, String>, Result<f64, String>)| Ok(self.place(x?, y?));
                let points: Result<Vec<_>, String> = points.map(place).collect();
                Ok(StrokeShape::Path(points?))
            }
            name @ ("CIRCLE" | "ARC") => {
                let [from, to] = match name {
                    "ARC" => [self.number(50)?, self.number(51)?].map(f64::to_radians),
                    _ => [0.0, TAU],
                };
                Ok(StrokeShape::Ellipse {
                    centre: self.point(10)?,
                    major: Vector2::new(length(self.number(40)?), 0.0),
                    ratio: 1.0,
                    from,
                    sweep: sweep(from, to),
                })
            }
            "ELLIPSE" => {
                let [from, to] = [self.number(41)?, self.number(42)?];
                Ok(StrokeShape::Ellipse {
                    centre: self.point(10)?,
                    major: Vector2::new(length(self.number(11)?), length(self.number(21)?)),
                    ratio: self.number(40)?,
                    from,
                    sweep: sweep(from, to),
                })
            }
            other => Err(format!("the entity {other}")),
        }
    }
}

/// The angle of an arc; a whole turn if it ends where it starts.
fn sweep(from: f64, to: f64) -> f64 {
    let sweep = (to - from).rem_euclid(TAU);
    if sweep > 0.0 { sweep } else { TAU }
}
