//! Drawings as DXF, release 2000, in text: LINE, CIRCLE, ARC, ELLIPSE and LWPOLYLINE, one layer
//! for each kind and visibility.

use super::{Drawing, Layer, Shape, Stroke};
use std::f64::consts::TAU;
use std::fmt::Write;

/// An ellipse as round as this is a circle.
const ROUND: f64 = premio_kernel::number::sign::ROUNDING * 1024.0;

/// Writes groups: a code and its value, a line each.
struct Groups {
    text: String,
    next: u32,
}

impl Groups {
    fn put(&mut self, code: u32, value: impl std::fmt::Display) {
        let _ = write!(self.text, "{code:3}\n{value}\n");
    }

    fn number(&mut self, code: u32, value: f64) {
        // The format wants a decimal point.
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

/// The drawing as a DXF document.
pub fn write(drawing: &Drawing) -> String {
    let mut g = Groups {
        text: String::new(),
        next: 0x10,
    };
    header(&mut g, drawing);
    let spaces = tables(&mut g);
    blocks(&mut g, spaces);
    g.section("ENTITIES");
    for stroke in &drawing.strokes {
        entity(&mut g, stroke, spaces[0]);
    }
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

fn header(g: &mut Groups, drawing: &Drawing) {
    g.section("HEADER");
    g.put(9, "$ACADVER");
    g.put(1, "AC1015");
    g.put(9, "$HANDSEED");
    g.put(5, "FFFFFFF");
    // Millimetres where the image is in the part's unit, else none.
    g.put(9, "$INSUNITS");
    g.put(70, if drawing.to_scale { 4 } else { 0 });
    g.put(9, "$MEASUREMENT");
    g.put(70, 1);
    let [lo, hi] = drawing.extent;
    g.put(9, "$EXTMIN");
    g.point(10, lo.x, lo.y);
    g.put(9, "$EXTMAX");
    g.point(10, hi.x, hi.y);
    // Dashes that fit the drawing, whatever its size.
    g.put(9, "$LTSCALE");
    g.number(40, (hi - lo).norm().max(f64::MIN_POSITIVE) / 1000.0);
    g.put(0, "ENDSEC");
}

/// Writes the tables; gives the records of the model's and the paper's space.
fn tables(g: &mut Groups) -> [u32; 2] {
    g.section("TABLES");
    g.table("VPORT", 0);
    g.put(0, "ENDTAB");
    let t = g.table("LTYPE", 4);
    for name in ["ByBlock", "ByLayer", "Continuous"] {
        line_type(g, t, name, &[]);
    }
    line_type(g, t, "DASHED", &[12.0, -6.0]);
    g.put(0, "ENDTAB");
    let t = g.table("LAYER", 7);
    layer(g, t, "0", true);
    for l in Layer::ALL {
        for visible in [true, false] {
            layer(g, t, &layer_name(l, visible), visible);
        }
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

fn layer(g: &mut Groups, table: u32, name: &str, visible: bool) {
    g.record("LAYER", table, "AcDbLayerTableRecord", name);
    g.put(62, if visible { 7 } else { 8 });
    g.put(6, if visible { "Continuous" } else { "DASHED" });
    g.put(370, if visible { 35 } else { 18 });
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

fn entity(g: &mut Groups, stroke: &Stroke, owner: u32) {
    let layer = layer_name(stroke.layer, stroke.visible);
    let mut start = |name: &str, classes: &[&str]| {
        g.object(name, owner, &["AcDbEntity"]);
        g.put(8, &layer);
        for class in classes {
            g.put(100, class);
        }
    };
    match &stroke.shape {
        Shape::Line([a, b]) => {
            start("LINE", &["AcDbLine"]);
            g.point(10, a.x, a.y);
            g.point(11, b.x, b.y);
        }
        Shape::Path(points) => {
            start("LWPOLYLINE", &["AcDbPolyline"]);
            g.put(90, points.len());
            g.put(70, 0);
            for p in points {
                g.number(10, p.x);
                g.number(20, p.y);
            }
        }
        Shape::Ellipse {
            centre,
            major,
            ratio,
            from,
            sweep,
        } => {
            let whole = *sweep >= TAU;
            let radius = major.norm();
            if 1.0 - ratio > ROUND {
                start("ELLIPSE", &["AcDbEllipse"]);
                g.point(10, centre.x, centre.y);
                g.point(11, major.x, major.y);
                g.number(40, *ratio);
                let from = if whole { 0.0 } else { from.rem_euclid(TAU) };
                g.number(41, from);
                g.number(42, from + sweep);
                return;
            }
            let name = if whole { "CIRCLE" } else { "ARC" };
            start(name, &["AcDbCircle"]);
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
