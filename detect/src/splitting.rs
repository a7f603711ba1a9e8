//! Splitting of chains where they leave their chords (Ramer 1972; Haralick & Shapiro ch. 11).

/// The indices at which the pieces of an open chain begin, and at last its end: no point of a piece
/// is farther from its chord than the tolerance.
pub(super) fn split(points: &[[f64; 2]], tolerance: f64) -> Vec<usize> {
    let Some(last) = points.len().checked_sub(1) else {
        return Vec::new();
    };
    let mut breaks = vec![0];
    divide(points, [0, last], tolerance, &mut breaks);
    breaks.push(points.len());
    breaks
}

/// The breaks of a closed chain whose first point is a start; the last piece ends at the first
/// point.
pub(super) fn split_closed(points: &[[f64; 2]], tolerance: f64) -> Vec<usize> {
    let n = points.len();
    let mut around = points.to_vec();
    around.extend(points.first());
    let far = farthest(points.iter().map(|&p| distance(p, points[0])));
    let mut breaks = vec![0];
    if let Some(far) = far.map(|far| far.index).filter(|&far| far > 0) {
        divide(&around, [0, far], tolerance, &mut breaks);
        breaks.push(far);
        divide(&around, [far, n], tolerance, &mut breaks);
    }
    breaks.push(n);
    breaks
}

/// The point from which to start around a closed chain: farthest from the middle, so that it is a
/// corner if there are any.
pub(super) fn outermost(points: &[[f64; 2]]) -> usize {
    let n = points.len() as f64;
    let middle = [0, 1].map(|i| points.iter().map(|p| p[i]).sum::<f64>() / n);
    farthest(points.iter().map(|&p| distance(p, middle))).map_or(0, |far| far.index)
}

/// Adds the indices at which the range between two points, inclusive, is split.
fn divide(points: &[[f64; 2]], stretch: [usize; 2], tolerance: f64, breaks: &mut Vec<usize>) {
    // The ranges still to do, the first one on top.
    let mut left = vec![stretch];
    while let Some([from, to]) = left.pop() {
        let chord = [points[from], points[to]];
        let inner = from + 1..to;
        let far = farthest(inner.map(|i| from_chord(points[i], chord)));
        match far {
            Some(far) if far.distance > tolerance => {
                let at = from + 1 + far.index;
                left.push([at, to]);
                left.push([from, at]);
            }
            _ if from > stretch[0] => breaks.push(from),
            _ => {}
        }
    }
}

/// The largest of some distances.
#[derive(Clone, Copy)]
struct Farthest {
    /// The index.
    index: usize,
    distance: f64,
}

/// The first of the largest distances.
fn farthest(distances: impl Iterator<Item = f64>) -> Option<Farthest> {
    let mut best: Option<Farthest> = None;
    for (index, distance) in distances.enumerate() {
        if best.is_none_or(|b| distance > b.distance) {
            best = Some(Farthest { index, distance });
        }
    }
    best
}

fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

/// The distance of a point from a chord, as a segment.
fn from_chord(p: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let [dx, dy] = [b[0] - a[0], b[1] - a[1]];
    let [x, y] = [p[0] - a[0], p[1] - a[1]];
    let square = dx * dx + dy * dy;
    let share = if square > 0.0 {
        ((x * dx + y * dy) / square).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let [x, y] = [x - share * dx, y - share * dy];
    (x * x + y * y).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn walk(corners: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let side = |c: &[[f64; 2]]| {
            let [a, b] = [c[0], c[1]];
            (0..20).map(move |i| [0, 1].map(|k| a[k] + (b[k] - a[k]) * f64::from(i) / 20.0))
        };
        corners.windows(2).flat_map(side).collect()
    }

    #[test]
    fn a_bend_is_a_break() {
        let points = walk(&[[0.0, 0.0], [20.0, 0.0], [20.0, 20.0], [50.0, 20.0]]);
        assert_eq!(split(&points, 1.0), [0, 20, 40, 60]);
        assert_eq!(split(&points, 100.0), [0, 60]);
        assert!(split(&[], 1.0).is_empty());
        assert_eq!(split(&points[..1], 1.0), [0, 1]);
    }

    #[test]
    fn around_a_square() {
        let corners = [
            [0.0, 0.0],
            [20.0, 0.0],
            [20.0, 20.0],
            [0.0, 20.0],
            [0.0, 0.0],
        ];
        let mut points = walk(&corners);
        points.rotate_left(7);
        let start = outermost(&points);
        points.rotate_left(start);
        assert_eq!(split_closed(&points, 1.0), [0, 20, 40, 60, 80]);
    }
}
