//! Predicted features as a drawing: found pieces are coloured by their contrast, the rest is
//! dashed, with the reason why it is missing.

use crate::feature::detected_arc::DetectionState;
use crate::prediction::{ArcGeometry, ArcLevel, Prediction};
use std::fmt::Write;

/// The contrast of the strongest colour, in grey levels.
const STRONG: f64 = 128.0;
/// The colours of contrasts from zero to [`STRONG`]: viridis at equal steps (van der Walt and Smith
/// 2015).
const COLOURS: [[u8; 3]; 5] = [
    [68, 1, 84],
    [59, 82, 139],
    [33, 145, 140],
    [94, 201, 98],
    [253, 231, 37],
];
/// The colour of missing pieces.
pub const MISSING: [u8; 3] = [214, 39, 40];

/// The colour of a contrast in grey levels.
pub fn colour(contrast: f64) -> [u8; 3] {
    let place = (contrast / STRONG).clamp(0.0, 1.0) * (COLOURS.len() - 1) as f64;
    let i = (place as usize).min(COLOURS.len() - 2);
    let part = place - i as f64;
    let mix = |k: usize| {
        let [a, b] = [COLOURS[i][k], COLOURS[i + 1][k]].map(f64::from);
        (a + (b - a) * part).round() as u8
    };
    [mix(0), mix(1), mix(2)]
}

/// A line of the overlay.
#[derive(Clone, Debug, PartialEq)]
pub struct OverlayStroke {
    /// Its points in pixels.
    pub points: Vec<[f64; 2]>,
    /// The mean contrast along it, where it is found.
    pub contrast: Option<f64>,
    /// The arc.
    pub arc: u32,
}

/// The lines of the overlay of a prediction within the image.
pub fn strokes(prediction: &Prediction) -> Vec<OverlayStroke> {
    let size = prediction.image.setup.conditions.sensor.resolution;
    // The centre of the first pixel is at (0, 0).
    let window = Window {
        low: [-0.5; 2],
        high: size.map(|n| n as f64 - 0.5),
    };
    let features = prediction.arcs.iter().filter(|arc| !arc.smooth);
    features
        .flat_map(|arc| arc_strokes(arc, prediction))
        .flat_map(|stroke| {
            let pieces = window.clipped(&stroke.points);
            pieces
                .into_iter()
                .map(move |points| OverlayStroke { points, ..stroke })
        })
        .collect()
}

/// A rectangle of the image.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Window {
    low: [f64; 2],
    high: [f64; 2],
}

impl Window {
    /// The pieces of a polyline in the window.
    fn clipped(&self, points: &[[f64; 2]]) -> Vec<Vec<[f64; 2]>> {
        let mut pieces: Vec<Vec<[f64; 2]>> = Vec::new();
        for pair in points.windows(2) {
            let Some([a, b]) = self.segment([pair[0], pair[1]]) else {
                continue;
            };
            match pieces.last_mut() {
                // It continues where the last one ended, at the same point of the line.
                Some(piece) if piece.last() == Some(&a) => piece.push(b),
                _ => pieces.push(vec![a, b]),
            }
        }
        pieces
    }

    /// The part of a segment in the window (Liang and Barsky 1984).
    fn segment(&self, [a, b]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
        let (mut from, mut to) = (0.0f64, 1.0f64);
        for i in 0..2 {
            let step = b[i] - a[i];
            let sides = [(-step, a[i] - self.low[i]), (step, self.high[i] - a[i])];
            for (speed, room) in sides {
                let at = room / speed;
                if speed < 0.0 {
                    from = from.max(at);
                } else if speed > 0.0 {
                    to = to.min(at);
                } else if room < 0.0 {
                    return None;
                }
            }
        }
        let point = |s: f64| match s {
            0.0 => a,
            1.0 => b,
            s => [0, 1].map(|i| (a[i] + s * (b[i] - a[i])).clamp(self.low[i], self.high[i])),
        };
        (from < to).then(|| [point(from), point(to)])
    }
}

fn arc_strokes(arc: &ArcLevel, prediction: &Prediction) -> Vec<OverlayStroke> {
    let points = points(&arc.geometry);
    let top = f64::from(prediction.image.setup.conditions.sensor.levels - 1);
    let mut strokes = Vec::new();
    if arc.state != DetectionState::Whole {
        strokes.push(OverlayStroke {
            points: points.clone(),
            contrast: None,
            arc: arc.id,
        });
    }
    for piece in &arc.fragments {
        let within = |along: f64| piece.along[0] <= along && along <= piece.along[1];
        let on = arc.contrast.iter().filter(|c| within(c.along));
        let all: Vec<f64> = on.map(|c| c.difference(top)).collect();
        let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
        strokes.push(OverlayStroke {
            points: part(&points, piece.along),
            contrast: Some(mean),
            arc: arc.id,
        });
    }
    strokes
}

/// The points of a form.
pub(crate) fn points(geometry: &ArcGeometry) -> Vec<[f64; 2]> {
    match geometry {
        ArcGeometry::Line { ends } => ends.to_vec(),
        ArcGeometry::Conic { points, .. } | ArcGeometry::Sampled { points } => points.clone(),
    }
}

/// The part of a polyline between two lengths along it.
fn part(points: &[[f64; 2]], [from, to]: [f64; 2]) -> Vec<[f64; 2]> {
    let mut kept = Vec::new();
    let mut before = 0.0;
    for pair in points.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let at = |along: f64| {
            let s = ((along - before) / length).clamp(0.0, 1.0);
            [a[0] + s * (b[0] - a[0]), a[1] + s * (b[1] - a[1])]
        };
        if length > 0.0 && before + length >= from && before <= to {
            if kept.is_empty() {
                kept.push(at(from));
            }
            kept.push(at(to));
        }
        before += length;
    }
    kept
}

/// The position of an arc's label: the middle of its line.
pub fn label_place(arc: &ArcLevel) -> [f64; 2] {
    let points = points(&arc.geometry);
    let line = part(&points, [0.5 * arc.length, 0.5 * arc.length + 1.0]);
    line.first().or(points.first()).copied().unwrap_or_default()
}

/// The position of a label in the image.
fn shown_label(arc: &ArcLevel, size: [f64; 2]) -> [f64; 2] {
    let [x, y] = label_place(arc);
    [x.clamp(0.0, size[0]), y.clamp(0.0, size[1])]
}

/// An arc that is not detected as a whole.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingArc {
    /// Its index in the prediction.
    pub arc: u32,
    /// Its name, its state and the reason.
    pub reason: String,
}

/// The arcs of a prediction that are not whole.
pub fn missing(prediction: &Prediction) -> Vec<MissingArc> {
    let features = prediction
        .arcs
        .iter()
        .filter(|arc| !arc.smooth && arc.length > 0.0);
    let labels = features.filter_map(|arc| {
        let reason = arc.reason?;
        let word = arc.source.word();
        Some(MissingArc {
            arc: arc.id,
            reason: format!("{}: {word} {}, {reason}", arc.id, arc.state.word()),
        })
    });
    labels.collect()
}

const STYLE: &str = "svg{background:#fff}path{fill:none;stroke-linecap:round;stroke-linejoin:round;stroke-width:2}\
.missing{stroke:#d62728;stroke-width:1;stroke-dasharray:4 3}\
text{font-family:sans-serif;font-size:9px;fill:#d62728}.key{fill:#000}";

/// The overlay as an SVG document, in pixels.
pub fn svg(prediction: &Prediction) -> String {
    let [width, height] = prediction.image.setup.conditions.sensor.resolution;
    let reasons = missing(prediction);
    let below = 14 * (reasons.len() + 2);
    let mut out = String::new();
    let _ = writeln!(
        out,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" \
         width=\"{width}\" height=\"{}\" viewBox=\"-0.5 -0.5 {width} {}\">\n<style>{STYLE}</style>\n\
         <rect x=\"-0.5\" y=\"-0.5\" width=\"{width}\" height=\"{height}\" fill=\"#f4f4f4\"/>",
        height + below,
        height + below
    );
    for stroke in strokes(prediction) {
        path(&stroke, prediction, &mut out);
    }
    for MissingArc { arc: id, .. } in &reasons {
        let arc = &prediction.arcs[*id as usize];
        let [x, y] = shown_label(arc, [width, height].map(|n| n as f64));
        let _ = writeln!(
            out,
            "<text x=\"{:.1}\" y=\"{:.1}\">{id}</text>",
            x + 3.0,
            y - 3.0
        );
    }
    key(width, height, &mut out);
    for (k, MissingArc { reason, .. }) in reasons.iter().enumerate() {
        let y = height + 14 * (k + 2);
        let _ = writeln!(out, "<text x=\"4\" y=\"{y}\">{reason}</text>");
    }
    out.push_str("</svg>\n");
    out
}

fn path(stroke: &OverlayStroke, prediction: &Prediction, out: &mut String) {
    let mut d = String::new();
    for (i, [x, y]) in stroke.points.iter().enumerate() {
        let command = if i == 0 { 'M' } else { 'L' };
        let _ = write!(d, "{command}{x:.2} {y:.2}");
    }
    let arc = &prediction.arcs[stroke.arc as usize];
    let why = arc
        .reason
        .map_or(String::new(), |reason| format!(", {reason}"));
    let title = format!(
        "{} {}: {}{why}",
        arc.source.word(),
        arc.id,
        arc.state.word()
    );
    let look = match stroke.contrast {
        None => "class=\"missing\"".to_owned(),
        Some(contrast) => {
            let [r, g, b] = colour(contrast);
            format!("stroke=\"#{r:02x}{g:02x}{b:02x}\"")
        }
    };
    let _ = writeln!(out, "<path {look} d=\"{d}\"><title>{title}</title></path>");
}

/// The key to the colours.
fn key(width: usize, height: usize, out: &mut String) {
    let y = height + 4;
    for k in 0..=8u32 {
        let contrast = STRONG * f64::from(k) / 8.0;
        let [r, g, b] = colour(contrast);
        let x = 70 + 22 * k;
        let _ = writeln!(
            out,
            "<rect x=\"{x}\" y=\"{y}\" width=\"22\" height=\"8\" fill=\"#{r:02x}{g:02x}{b:02x}\"/>"
        );
    }
    let text = y + 8;
    let _ = writeln!(
        out,
        "<text class=\"key\" x=\"4\" y=\"{text}\">contrast 0</text>"
    );
    let right = (70 + 22 * 9 + 4).min(width);
    let _ = writeln!(
        out,
        "<text class=\"key\" x=\"{right}\" y=\"{text}\">{STRONG}</text>"
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_at_the_border_of_the_image() {
        let window = Window {
            low: [0.0; 2],
            high: [10.0, 5.0],
        };
        // In, out above, and back in.
        let line = [[2.0, 2.0], [4.0, 10.0], [8.0, 2.0]];
        let pieces = window.clipped(&line);
        assert_eq!(pieces.len(), 2, "{pieces:?}");
        assert_eq!(pieces[0], [[2.0, 2.0], [2.75, 5.0]]);
        assert_eq!(pieces[1], [[6.5, 5.0], [8.0, 2.0]]);
        assert_eq!(
            window.clipped(&[[-5.0, 1.0], [20.0, 1.0]]),
            [[[0.0, 1.0], [10.0, 1.0]]]
        );
        assert!(window.clipped(&[[-5.0, -1.0], [20.0, -1.0]]).is_empty());
        let inside = [[1.0, 1.0], [2.0, 2.0], [3.0, 1.0]];
        assert_eq!(window.clipped(&inside), [inside.to_vec()]);
    }
}
