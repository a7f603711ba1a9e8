//! Drawings as SVG for browsers, with exact lines and ellipses.

use super::sheet::{PlacedView, Sheet, SheetMark, Weight};
use super::{Drawing, Layer, Stroke, StrokeShape};
use nalgebra::{Point2, Vector2};
use premio_text::escape;
use std::f64::consts::TAU;
use std::fmt::Write;

/// The longer side of the page, without its margin, in user units.
const PAGE: f64 = 1000.0;
/// The margin.
const MARGIN: f64 = 40.0;

const STYLE: &str = "svg{background:#fff}path{fill:none;stroke:#000;stroke-linecap:round;stroke-linejoin:round}\
.boundary{stroke-width:2}.limb{stroke-width:2}.smooth{stroke-width:1;stroke:#888}\
.hidden{stroke-width:1;stroke-dasharray:7 5;stroke:#777}";

/// Line weights in millimetres by ISO 128: 0.5 for visible lines, half of it for hidden lines, for
/// smooth boundaries and inside the title block.
const SHEET_STYLE: &str = "svg{background:#fff}path,circle{fill:none;stroke:#000;stroke-linecap:round;stroke-linejoin:round}\
text{font-family:sans-serif}\
.boundary,.limb{stroke-width:.5}.smooth{stroke-width:.25;stroke:#888}\
.hidden{stroke-width:.25;stroke-dasharray:3 .75}.thick{stroke-width:.7}.thin{stroke-width:.25}";

/// The map from image units to the page, whose y is down.
struct Page {
    /// The position of the image's origin.
    origin: Vector2<f64>,
    /// The length of an image unit.
    scale: f64,
}

impl Page {
    fn at(&self, p: &Point2<f64>) -> (f64, f64) {
        (
            self.origin.x + p.x * self.scale,
            self.origin.y - p.y * self.scale,
        )
    }

    fn stroke(&self, stroke: &Stroke, out: &mut String) {
        let seen = if stroke.visible { "visible" } else { "hidden" };
        let _ = write!(out, "<path class=\"{} {seen}\" d=\"", stroke.layer.name());
        match &stroke.shape {
            StrokeShape::Line([a, b]) => self.polyline(&[*a, *b], out),
            StrokeShape::Path(points) => self.polyline(points, out),
            StrokeShape::Ellipse { .. } => self.ellipse(&stroke.shape, out),
        }
        out.push_str("\"/>\n");
    }

    fn polyline(&self, points: &[Point2<f64>], out: &mut String) {
        for (i, p) in points.iter().enumerate() {
            let (x, y) = self.at(p);
            let command = if i == 0 { 'M' } else { 'L' };
            let _ = write!(out, "{command}{} {}", short(x), short(y));
        }
    }

    fn ellipse(&self, shape: &StrokeShape, out: &mut String) {
        let StrokeShape::Ellipse {
            centre,
            major,
            ratio,
            from,
            sweep,
        } = shape
        else {
            return;
        };
        let minor = nalgebra::Vector2::new(-major.y, major.x) * *ratio;
        let point = |s: f64| self.at(&(centre + major * s.cos() + minor * s.sin()));
        let (x, y) = point(*from);
        let _ = write!(out, "M{} {}", long(x), long(y));
        let (rx, ry) = (major.norm() * self.scale, major.norm() * ratio * self.scale);
        // The page's y is down, so the angle changes its sign and the arc is counterclockwise.
        let turn = -major.y.atan2(major.x).to_degrees();
        // At most a quarter turn at once: near half a turn the centre depends on the last digit of
        // the radius.
        let parts = (sweep / (TAU / 4.0)).ceil().clamp(1.0, 4.0) as u32;
        for k in 1..=parts {
            let (x, y) = point(from + sweep * f64::from(k) / f64::from(parts));
            let _ = write!(
                out,
                "A{} {} {} 0 0 {} {}",
                long(rx),
                long(ry),
                long(turn),
                long(x),
                long(y)
            );
        }
    }
}

/// A length with as many digits as the page can show.
fn short(x: f64) -> String {
    trimmed(format!("{x:.4}"))
}

/// A number of an arc with more digits: the centre follows from the ends, and on a thin ellipse an
/// error across it is an error along it divided by the ratio.
fn long(x: f64) -> String {
    trimmed(format!("{x:.7}"))
}

fn trimmed(text: String) -> String {
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

/// The head of a document of a size, in user units and written with a unit.
fn head([width, height]: [f64; 2], unit: &str, style: &str, out: &mut String) {
    let [width, height] = [short(width), short(height)];
    let _ = writeln!(
        out,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" \
         width=\"{width}{unit}\" height=\"{height}{unit}\" viewBox=\"0 0 {width} {height}\">\n\
         <style>{style}</style>"
    );
}

/// The strokes of a drawing, in a group for each layer, named with a prefix.
fn layers(page: &Page, drawing: &Drawing, prefix: &str, out: &mut String) {
    for visible in [false, true] {
        for layer in Layer::ALL {
            let mine = |s: &&Stroke| s.visible == visible && s.layer == layer;
            let mut strokes = drawing.strokes.iter().filter(mine).peekable();
            if strokes.peek().is_none() {
                continue;
            }
            let seen = if visible { "visible" } else { "hidden" };
            let _ = writeln!(out, "<g id=\"{prefix}{}-{seen}\">", layer.name());
            for stroke in strokes {
                page.stroke(stroke, out);
            }
            out.push_str("</g>\n");
        }
    }
}

/// The drawing as an SVG document.
pub fn write(drawing: &Drawing) -> String {
    let [lo, hi] = &drawing.extent;
    let (w, h) = (hi.x - lo.x, hi.y - lo.y);
    let size = w.max(h);
    let scale = if size > 0.0 { PAGE / size } else { 1.0 };
    let page = Page {
        origin: Vector2::new(MARGIN - lo.x * scale, MARGIN + hi.y * scale),
        scale,
    };
    let mut out = String::new();
    let size = [w, h].map(|x| x * scale + 2.0 * MARGIN);
    head(size, "", STYLE, &mut out);
    layers(&page, drawing, "", &mut out);
    out.push_str("</svg>\n");
    out
}

/// The sheet as an SVG document, in millimetres.
pub fn write_sheet(sheet: &Sheet) -> String {
    let mut out = String::new();
    head(sheet.size.into(), "mm", SHEET_STYLE, &mut out);
    let _ = writeln!(out, "<title>{}</title>", escape::xml(&sheet.options.title));
    let down = |p: &Point2<f64>| Vector2::new(p.x, sheet.size.y - p.y);
    for PlacedView { name, drawing, at } in &sheet.views {
        let page = Page {
            origin: down(at),
            scale: sheet.factor,
        };
        let _ = writeln!(out, "<g id=\"{name}\">");
        layers(&page, drawing, &format!("{name}-"), &mut out);
        out.push_str("</g>\n");
    }
    out.push_str("<g id=\"frame\">\n");
    let paper = Page {
        origin: Vector2::new(0.0, sheet.size.y),
        scale: 1.0,
    };
    for mark in &sheet.marks {
        paper.mark(mark, &mut out);
    }
    out.push_str("</g>\n</svg>\n");
    out
}

/// The height of capital letters of most typefaces, relative to the type size.
const CAPITAL: f64 = 0.72;

impl Page {
    fn mark(&self, mark: &SheetMark, out: &mut String) {
        let at = |p: &Point2<f64>| {
            let (x, y) = self.at(p);
            (short(x), short(y))
        };
        let _ = match mark {
            SheetMark::Line([a, b], weight) => {
                let weight = match weight {
                    Weight::Thick => "thick",
                    Weight::Thin => "thin",
                };
                let ((x, y), (to_x, to_y)) = (at(a), at(b));
                writeln!(
                    out,
                    "<path class=\"{weight}\" d=\"M{x} {y}L{to_x} {to_y}\"/>"
                )
            }
            SheetMark::Circle(centre, radius) => {
                let ((x, y), radius) = (at(centre), short(*radius));
                writeln!(
                    out,
                    "<circle class=\"thin\" cx=\"{x}\" cy=\"{y}\" r=\"{radius}\"/>"
                )
            }
            SheetMark::Text(start, height, text) => {
                let ((x, y), size) = (at(start), short(height / CAPITAL));
                let text = escape::xml(text);
                writeln!(
                    out,
                    "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\">{text}</text>"
                )
            }
        };
    }
}
