//! Drawings as SVG: readable by a browser, lines and ellipses exact.

use super::{Drawing, Layer, Shape, Stroke};
use nalgebra::Point2;
use std::f64::consts::TAU;
use std::fmt::Write;

/// The longer side of the page, without its margin, in user units.
const PAGE: f64 = 1000.0;
/// The margin.
const MARGIN: f64 = 40.0;

const STYLE: &str = "svg{background:#fff}path{fill:none;stroke:#000;stroke-linecap:round;stroke-linejoin:round}\
.boundary{stroke-width:2}.limb{stroke-width:2}.smooth{stroke-width:1;stroke:#888}\
.hidden{stroke-width:1;stroke-dasharray:7 5;stroke:#777}";

struct Page<'d> {
    drawing: &'d Drawing,
    scale: f64,
}

impl Page<'_> {
    fn at(&self, p: &Point2<f64>) -> (f64, f64) {
        let [lo, hi] = &self.drawing.extent;
        (
            MARGIN + (p.x - lo.x) * self.scale,
            MARGIN + (hi.y - p.y) * self.scale,
        )
    }

    fn stroke(&self, stroke: &Stroke, out: &mut String) {
        let seen = if stroke.visible { "visible" } else { "hidden" };
        let _ = write!(out, "<path class=\"{} {seen}\" d=\"", stroke.layer.name());
        match &stroke.shape {
            Shape::Line([a, b]) => self.polyline(&[*a, *b], out),
            Shape::Path(points) => self.polyline(points, out),
            Shape::Ellipse { .. } => self.ellipse(&stroke.shape, out),
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

    fn ellipse(&self, shape: &Shape, out: &mut String) {
        let Shape::Ellipse {
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
        let _ = write!(out, "M{} {}", short(x), short(y));
        let (rx, ry) = (major.norm() * self.scale, major.norm() * ratio * self.scale);
        // The page's y is down, so the angle turns over and the arc runs against the clock.
        let turn = -major.y.atan2(major.x).to_degrees();
        // Up to half a turn at once: a longer arc is ambiguous where it nearly closes.
        let parts = if *sweep > TAU / 2.0 { 2 } else { 1 };
        for k in 1..=parts {
            let (x, y) = point(from + sweep * f64::from(k) / f64::from(parts));
            let _ = write!(
                out,
                "A{} {} {} 0 0 {} {}",
                short(rx),
                short(ry),
                short(turn),
                short(x),
                short(y)
            );
        }
    }
}

/// A number with as many digits as the page can show.
fn short(x: f64) -> String {
    let text = format!("{x:.4}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" {
        "0".to_owned()
    } else {
        text.to_owned()
    }
}

/// The drawing as an SVG document.
pub fn write(drawing: &Drawing) -> String {
    let [lo, hi] = &drawing.extent;
    let (w, h) = (hi.x - lo.x, hi.y - lo.y);
    let size = w.max(h);
    let scale = if size > 0.0 { PAGE / size } else { 1.0 };
    let page = Page { drawing, scale };
    let (w, h) = (w * scale + 2.0 * MARGIN, h * scale + 2.0 * MARGIN);
    let mut out = String::new();
    let _ = writeln!(
        out,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" \
         width=\"{0}\" height=\"{1}\" viewBox=\"0 0 {0} {1}\">\n<style>{STYLE}</style>",
        short(w),
        short(h)
    );
    for visible in [false, true] {
        for layer in Layer::ALL {
            let mine = |s: &&Stroke| s.visible == visible && s.layer == layer;
            let mut strokes = drawing.strokes.iter().filter(mine).peekable();
            if strokes.peek().is_none() {
                continue;
            }
            let seen = if visible { "visible" } else { "hidden" };
            let _ = writeln!(out, "<g id=\"{}-{seen}\">", layer.name());
            for stroke in strokes {
                page.stroke(stroke, &mut out);
            }
            out.push_str("</g>\n");
        }
    }
    out.push_str("</svg>\n");
    out
}
