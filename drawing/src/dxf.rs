//! Drawings as DXF, release 2000, in text: LINE, CIRCLE, ARC, ELLIPSE and LWPOLYLINE, one layer
//! for each kind and visibility, with its line weight.
//!
//! On a sheet the part has its true size, in its own unit. Paper, frame and title block are scaled
//! up by the inverse of the scale.

use super::sheet::{Sheet, SheetMark, Weight};
use super::{Drawing, Layer, Stroke, StrokeShape};
use nalgebra::{Point2, Vector2};
use premio_kernel::unit::Unit;
use premio_text::escape;
use std::f64::consts::TAU;
use std::fmt::Write;

/// The relative difference of half axes below which an ellipse is written as a circle.
const ROUND: f64 = premio_kernel::number::predicates::ROUNDING * 1024.0;

/// The writer of groups: a code and its value, on a line each.
struct Groups {
    text: String,
    next: u32,
}

impl Groups {
    fn put(&mut self, code: u32, value: impl std::fmt::Display) {
        let _ = write!(self.text, "{code:3}\n{value}\n");
    }

    fn number(&mut self, code: u32, value: f64) {
        // The format requires a decimal point.
        let value = if value == 0.0 { 0.0 } else { value };
        let _ = write!(self.text, "{code:3}\n{value:?}\n");
    }

    fn point(&mut self, code: u32, x: f64, y: f64) {
        self.number(code, x);
        self.number(code + 10, y);
        self.number(code + 20, 0.0);
    }

    fn handle(&mut self) -> u32 {
        self.next += 1;
        self.next
    }

    /// Starts an object: type, handle, owner and subclasses.
    fn object(&mut self, name: &str, owner: u32, classes: &[&str]) -> u32 {
        self.put(0, name);
        let handle = self.handle();
        self.put(5, format!("{handle:X}"));
        self.put(330, format!("{owner:X}"));
        for class in classes {
            self.put(100, class);
        }
        handle
    }

    fn section(&mut self, name: &str) {
        self.put(0, "SECTION");
        self.put(2, name);
    }

    fn table(&mut self, name: &str, entries: usize) -> u32 {
        self.put(0, "TABLE");
        self.put(2, name);
        let handle = self.handle();
        self.put(5, format!("{handle:X}"));
        self.put(330, 0);
        self.put(100, "AcDbSymbolTable");
        self.put(70, entries);
        handle
    }

    fn record(&mut self, name: &str, owner: u32, class: &str, value: &str) -> u32 {
        let handle = self.object(name, owner, &["AcDbSymbolTableRecord", class]);
        self.put(2, value);
        self.put(70, 0);
        handle
    }
}

fn layer_name(layer: Layer, visible: bool) -> String {
    let seen = if visible { "VISIBLE" } else { "HIDDEN" };
    format!("{}_{seen}", layer.name().to_uppercase())
}

/// The map from image units to those of the document.
#[derive(Clone, Copy)]
struct Placing {
    scale: f64,
    at: Vector2<f64>,
}

impl Placing {
    fn point(&self, p: &Point2<f64>) -> Point2<f64> {
        p * self.scale + self.at
    }
}

/// The drawing as a DXF document.
pub fn write(drawing: &Drawing) -> String {
    let [lo, hi] = drawing.extent;
    let head = Head {
        // Millimetres where the image is in the part's unit; otherwise none.
        units: if drawing.to_scale { 4 } else { 0 },
        extent: [lo, hi],
        // Dashes that fit the drawing, whatever its size.
        dashes: (hi - lo).norm().max(f64::MIN_POSITIVE) / 1000.0,
    };
    let placing = Placing {
        scale: 1.0,
        at: Vector2::zeros(),
    };
    document(&head, &[], |g, space| {
        for stroke in &drawing.strokes {
            entity(g, stroke, placing, space);
        }
    })
}

/// Twelve units of a line type's dash are 3 mm on paper.
const DASH: f64 = 0.25;

/// The sheet as a DXF document.
pub fn write_sheet(sheet: &Sheet) -> String {
    // Document units for a millimetre on paper, and for an image unit.
    let (paper, image, units) = match sheet.scale {
        Some(_) => (1.0 / sheet.factor, 1.0, code(sheet.options.unit)),
        None => (1.0, sheet.factor, code(Unit::Millimetre)),
    };
    let head = Head {
        units,
        extent: [Point2::origin(), Point2::from(sheet.size * paper)],
        dashes: DASH * paper,
    };
    document(&head, &[FRAME, TITLE], |g, space| {
        for view in &sheet.views {
            let placing = Placing {
                scale: image,
                at: view.at.coords * paper,
            };
            for stroke in &view.drawing.strokes {
                entity(g, stroke, placing, space);
            }
        }
        for mark in &sheet.marks {
            furniture(g, mark, paper, space);
        }
    })
}

/// The number of a unit in `$INSUNITS`.
fn code(unit: Unit) -> u32 {
    match unit {
        Unit::Inch => 1,
        Unit::Millimetre => 4,
        Unit::Centimetre => 5,
        Unit::Metre => 6,
        Unit::Micrometre => 13,
    }
}

/// The parameters of a document's head.
struct Head {
    units: u32,
    extent: [Point2<f64>; 2],
    dashes: f64,
}

/// A layer of a sheet's furniture.
#[derive(Clone, Copy)]
struct FurnitureLayer {
    name: &'static str,
    /// The line weight, in hundredths of a millimetre.
    weight: u32,
}

/// The layers of a sheet's frame and of the rest of its title block.
const FRAME: FurnitureLayer = FurnitureLayer {
    name: "FRAME",
    weight: 70,
};
const TITLE: FurnitureLayer = FurnitureLayer {
    name: "TITLE",
    weight: 25,
};

fn document(
    head: &Head,
    layers: &[FurnitureLayer],
    entities: impl FnOnce(&mut Groups, u32),
) -> String {
    let mut g = Groups {
        text: String::new(),
        next: 0x10,
    };
    header(&mut g, head);
    let spaces = tables(&mut g, layers);
    blocks(&mut g, spaces);
    g.section("ENTITIES");
    entities(&mut g, spaces[0]);
    g.put(0, "ENDSEC");
    g.section("OBJECTS");
    let root = g.object("DICTIONARY", 0, &["AcDbDictionary"]);
    let group = g.next + 1;
    g.put(3, "ACAD_GROUP");
    g.put(350, format!("{group:X}"));
    g.object("DICTIONARY", root, &["AcDbDictionary"]);
    g.put(0, "ENDSEC");
    g.put(0, "EOF");
    g.text
}

fn header(g: &mut Groups, head: &Head) {
    g.section("HEADER");
    g.put(9, "$ACADVER");
    g.put(1, "AC1015");
    g.put(9, "$HANDSEED");
    g.put(5, "FFFFFFF");
    g.put(9, "$INSUNITS");
    g.put(70, head.units);
    g.put(9, "$MEASUREMENT");
    g.put(70, 1);
    let [lo, hi] = head.extent;
    g.put(9, "$EXTMIN");
    g.point(10, lo.x, lo.y);
    g.put(9, "$EXTMAX");
    g.point(10, hi.x, hi.y);
    g.put(9, "$LTSCALE");
    g.number(40, head.dashes);
    g.put(0, "ENDSEC");
}

/// Writes the tables; returns the records of the model space and the paper space.
fn tables(g: &mut Groups, more: &[FurnitureLayer]) -> [u32; 2] {
    g.section("TABLES");
    g.table("VPORT", 0);
    g.put(0, "ENDTAB");
    let t = g.table("LTYPE", 4);
    for name in ["ByBlock", "ByLayer", "Continuous"] {
        line_type(g, t, name, &[]);
    }
    line_type(g, t, "DASHED", &[12.0, -6.0]);
    g.put(0, "ENDTAB");
    let t = g.table("LAYER", 7 + more.len());
    layer(g, t, "0", true, SEEN);
    for l in Layer::ALL {
        for visible in [true, false] {
            let weight = match l {
                Layer::Boundary | Layer::Limb if visible => SEEN,
                _ => SEEN / 2,
            };
            layer(g, t, &layer_name(l, visible), visible, weight);
        }
    }
    for &FurnitureLayer { name, weight } in more {
        layer(g, t, name, true, weight);
    }
    g.put(0, "ENDTAB");
    let t = g.table("STYLE", 1);
    g.record("STYLE", t, "AcDbTextStyleTableRecord", "Standard");
    g.number(40, 0.0);
    g.number(41, 1.0);
    g.number(50, 0.0);
    g.put(71, 0);
    g.number(42, 2.5);
    g.put(3, "txt");
    g.put(4, "");
    g.put(0, "ENDTAB");
    for name in ["VIEW", "UCS"] {
        g.table(name, 0);
        g.put(0, "ENDTAB");
    }
    let t = g.table("APPID", 1);
    g.record("APPID", t, "AcDbRegAppTableRecord", "ACAD");
    g.put(0, "ENDTAB");
    g.table("DIMSTYLE", 0);
    g.put(100, "AcDbDimStyleTable");
    g.put(0, "ENDTAB");
    let t = g.table("BLOCK_RECORD", 2);
    let spaces = ["*Model_Space", "*Paper_Space"].map(|name| {
        let class = ["AcDbSymbolTableRecord", "AcDbBlockTableRecord"];
        let handle = g.object("BLOCK_RECORD", t, &class);
        g.put(2, name);
        handle
    });
    g.put(0, "ENDTAB");
    g.put(0, "ENDSEC");
    spaces
}

fn line_type(g: &mut Groups, table: u32, name: &str, dashes: &[f64]) {
    g.record("LTYPE", table, "AcDbLinetypeTableRecord", name);
    g.put(3, if dashes.is_empty() { "" } else { "__ __ __ __" });
    g.put(72, 65);
    g.put(73, dashes.len());
    g.number(40, dashes.iter().map(|d| d.abs()).sum());
    for &dash in dashes {
        g.number(49, dash);
        g.put(74, 0);
    }
}

/// The line weight of visible lines, in hundredths of a millimetre; hidden lines and smooth
/// boundaries have half of it (ISO 128).
const SEEN: u32 = 50;

fn layer(g: &mut Groups, table: u32, name: &str, visible: bool, weight: u32) {
    g.record("LAYER", table, "AcDbLayerTableRecord", name);
    g.put(62, if visible { 7 } else { 8 });
    g.put(6, if visible { "Continuous" } else { "DASHED" });
    g.put(370, weight);
}

fn blocks(g: &mut Groups, spaces: [u32; 2]) {
    g.section("BLOCKS");
    for (name, owner) in ["*Model_Space", "*Paper_Space"].iter().zip(spaces) {
        g.object("BLOCK", owner, &["AcDbEntity"]);
        g.put(8, "0");
        g.put(100, "AcDbBlockBegin");
        g.put(2, name);
        g.put(70, 0);
        g.point(10, 0.0, 0.0);
        g.put(3, name);
        g.put(1, "");
        g.object("ENDBLK", owner, &["AcDbEntity"]);
        g.put(8, "0");
        g.put(100, "AcDbBlockEnd");
    }
    g.put(0, "ENDSEC");
}

/// Starts an entity on a layer.
fn start(g: &mut Groups, name: &str, class: &str, layer: &str, owner: u32) {
    g.object(name, owner, &["AcDbEntity"]);
    g.put(8, layer);
    g.put(100, class);
}

/// Writes a part of a sheet's frame or title block; `paper` is the length of a millimetre on paper.
fn furniture(g: &mut Groups, mark: &SheetMark, paper: f64, owner: u32) {
    match mark {
        SheetMark::Line([a, b], weight) => {
            let layer = match weight {
                Weight::Thick => FRAME,
                Weight::Thin => TITLE,
            };
            start(g, "LINE", "AcDbLine", layer.name, owner);
            g.point(10, a.x * paper, a.y * paper);
            g.point(11, b.x * paper, b.y * paper);
        }
        SheetMark::Circle(centre, radius) => {
            start(g, "CIRCLE", "AcDbCircle", TITLE.name, owner);
            g.point(10, centre.x * paper, centre.y * paper);
            g.number(40, radius * paper);
        }
        SheetMark::Text(at, height, text) => {
            start(g, "TEXT", "AcDbText", TITLE.name, owner);
            g.point(10, at.x * paper, at.y * paper);
            g.number(40, height * paper);
            g.put(1, escape::dxf(text));
            g.put(7, "Standard");
            g.put(100, "AcDbText");
        }
    }
}

fn entity(g: &mut Groups, stroke: &Stroke, placing: Placing, owner: u32) {
    let layer = &layer_name(stroke.layer, stroke.visible);
    match &stroke.shape {
        StrokeShape::Line(ends) => {
            let [a, b] = ends.map(|p| placing.point(&p));
            start(g, "LINE", "AcDbLine", layer, owner);
            g.point(10, a.x, a.y);
            g.point(11, b.x, b.y);
        }
        StrokeShape::Path(points) => {
            start(g, "LWPOLYLINE", "AcDbPolyline", layer, owner);
            g.put(90, points.len());
            g.put(70, 0);
            for p in points.iter().map(|p| placing.point(p)) {
                g.number(10, p.x);
                g.number(20, p.y);
            }
        }
        StrokeShape::Ellipse {
            centre,
            major,
            ratio,
            from,
            sweep,
        } => {
            let whole = *sweep >= TAU;
            let (centre, major) = (placing.point(centre), major * placing.scale);
            let radius = major.norm();
            if 1.0 - ratio > ROUND {
                start(g, "ELLIPSE", "AcDbEllipse", layer, owner);
                g.point(10, centre.x, centre.y);
                g.point(11, major.x, major.y);
                g.number(40, *ratio);
                let from = if whole { 0.0 } else { from.rem_euclid(TAU) };
                g.number(41, from);
                g.number(42, from + sweep);
                return;
            }
            let name = if whole { "CIRCLE" } else { "ARC" };
            start(g, name, "AcDbCircle", layer, owner);
            g.point(10, centre.x, centre.y);
            g.number(40, radius);
            if !whole {
                let from = from + major.y.atan2(major.x);
                g.put(100, "AcDbArc");
                g.number(50, from.rem_euclid(TAU).to_degrees());
                g.number(51, (from + sweep).rem_euclid(TAU).to_degrees());
            }
        }
    }
}
