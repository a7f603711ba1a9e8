//! Corners: points where segments end at an angle to each other (Haralick & Shapiro ch. 11).

use super::detection::{DetectedCorner, DetectedSegment, EdgeChain, EdgePixel, SegmentShape};
use super::fit::foot_on_conic;
use super::joining::End;
use super::parameters::Detector;

/// The sine of the least angle at which segments make a corner: 20 degrees.
const MARKED: f64 = 0.342_020_143_325_668_7;

/// The greatest distance of a corner from the ends that form it, in radii of the detector
/// (`reach`). Farther away, nearly parallel lines do not determine it.
const FAR: f64 = 3.0;

/// An end of a segment that may be at a corner.
struct Arm {
    segment: u32,
    end: End,
    /// Whether the chain ends there.
    free: bool,
}

/// Finds the corners of segments. Ends of chains are near each other where one mask can cover both.
pub(super) fn corners(
    detector: &Detector,
    pixels: &[EdgePixel],
    chains: &[EdgeChain],
    segments: &[DetectedSegment],
) -> Vec<DetectedCorner> {
    let reach = reach(detector);
    let SegmentEnds { arms, mut groups } = SegmentEnds::new(pixels, chains, segments);
    let mut free: Vec<usize> = (0..arms.len()).filter(|&i| arms[i].free).collect();
    free.sort_by(|&i, &j| arms[i].end.at[1].total_cmp(&arms[j].end.at[1]));
    for (k, &i) in free.iter().enumerate() {
        for &j in &free[k + 1..] {
            let step = [0, 1].map(|c| arms[j].end.at[c] - arms[i].end.at[c]);
            if step[1] > reach {
                break;
            }
            let near = step[0].hypot(step[1]) <= reach;
            if near && arms[i].segment != arms[j].segment && marked(&arms[i], &arms[j]) {
                unite(&mut groups, i, j);
            }
        }
    }
    let mut members = vec![Vec::new(); arms.len()];
    for i in 0..arms.len() {
        members[root(&groups, i)].push(i);
    }
    let corner = |m: &Vec<usize>| {
        let arms: Vec<&Arm> = m.iter().map(|&i| &arms[i]).collect();
        corner_of(&arms, FAR * reach)
    };
    members.iter().filter_map(corner).collect()
}

/// The greatest distance between ends of chains that form a corner, in pixels.
fn reach(detector: &Detector) -> f64 {
    detector.gap.max((2 * detector.radius() + 1) as f64)
}

/// Extends the ends of lines that form corners to these: near a corner the mask rounds the edge off
/// or finds none.
pub(super) fn extend(
    detector: &Detector,
    corners: &[DetectedCorner],
    segments: &mut [DetectedSegment],
) {
    let reach = reach(detector);
    for corner in corners {
        for &s in &corner.segments {
            let SegmentShape::Line { ends } = &mut segments[s as usize].shape else {
                continue;
            };
            let away = ends.map(|p| (p[0] - corner.at[0]).hypot(p[1] - corner.at[1]));
            let near = usize::from(away[1] < away[0]);
            let along = unit([ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]]);
            let step = [0, 1].map(|c| corner.at[c] - ends[near][c]);
            let length = along[0] * step[0] + along[1] * step[1];
            // A line is not reversed.
            let shorter = (ends[1][0] - ends[0][0]).hypot(ends[1][1] - ends[0][1]) / 2.0;
            if away[near] <= reach && length.abs() < shorter {
                ends[near] = [0, 1].map(|c| ends[near][c] + length * along[c]);
            }
        }
    }
}

/// The ends of all segments.
struct SegmentEnds {
    /// Two ends for each segment.
    arms: Vec<Arm>,
    /// By end: the index of the end that it is joined to along the chain, or its own.
    groups: Vec<usize>,
}

impl SegmentEnds {
    fn new(pixels: &[EdgePixel], chains: &[EdgeChain], segments: &[DetectedSegment]) -> Self {
        let mut arms = Vec::new();
        let mut groups: Vec<usize> = Vec::new();
        let mut first = 0;
        for (number, s) in (0_u32..).zip(segments) {
            let chain = &chains[s.chain as usize];
            let last = s.range[1] as usize == chain.pixels.len();
            if s.range[0] == 0 {
                first = arms.len();
            }
            let at = |k: u32| pixels[chain.pixels[k as usize] as usize].at;
            let bare = [at(s.range[0]), at(s.range[1] - 1)];
            let ends = tangents(&s.shape, bare);
            for (k, end) in ends.into_iter().enumerate() {
                let outer = if k == 0 { s.range[0] == 0 } else { last };
                groups.push(arms.len());
                arms.push(Arm {
                    segment: number,
                    end,
                    free: outer && !chain.closed,
                });
            }
            let here = arms.len() - 2;
            if s.range[0] > 0 {
                groups[here] = here - 1;
            }
            if last && chain.closed && here > first {
                groups[here + 1] = first;
            }
        }
        Self { arms, groups }
    }
}

/// The ends of a shape, with the tangents there; points without tangents where it has none.
fn tangents(shape: &SegmentShape, bare: [[f64; 2]; 2]) -> [End; 2] {
    match shape {
        SegmentShape::Line { ends } => {
            let along = unit([ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]]);
            ends.map(|at| End { at, along })
        }
        SegmentShape::Arc { conic, ends, .. } => ends.map(|at| End {
            at,
            along: tangent(conic, at),
        }),
        SegmentShape::Ellipse { conic, .. } => bare.map(|p| {
            let at = foot_on_conic(conic, p);
            End {
                at,
                along: tangent(conic, at),
            }
        }),
    }
}

/// The tangent direction of a conic at a point of it, of either sign.
fn tangent([a, b, c, d, e, _]: &[f64; 6], [x, y]: [f64; 2]) -> [f64; 2] {
    unit([-(b * x + 2.0 * c * y + e), 2.0 * a * x + b * y + d])
}

fn unit(v: [f64; 2]) -> [f64; 2] {
    let length = v[0].hypot(v[1]);
    if length > 0.0 {
        v.map(|x| x / length)
    } else {
        [0.0; 2]
    }
}

/// Whether the lines of two ends have an angle of at least `MARKED`.
fn marked(p: &Arm, q: &Arm) -> bool {
    let [a, b] = [p.end.along, q.end.along];
    (a[0] * b[1] - a[1] * b[0]).abs() >= MARKED
}

/// The corner of ends, if two of them have an angle of at least `MARKED`: the point nearest to
/// their lines.
fn corner_of(arms: &[&Arm], far: f64) -> Option<DetectedCorner> {
    let pair = |(i, p): (usize, &&Arm)| arms[i + 1..].iter().any(|q| marked(p, q));
    if !arms.iter().enumerate().any(pair) {
        return None;
    }
    let n = arms.len() as f64;
    let middle = [0, 1].map(|c| arms.iter().map(|a| a.end.at[c]).sum::<f64>() / n);
    // The sum of squared distances, about the middle.
    let [mut xx, mut xy, mut yy, mut x, mut y] = [0.0; 5];
    for arm in arms {
        let normal = [-arm.end.along[1], arm.end.along[0]];
        let [px, py] = [0, 1].map(|c| arm.end.at[c] - middle[c]);
        let offset = normal[0] * px + normal[1] * py;
        xx += normal[0] * normal[0];
        xy += normal[0] * normal[1];
        yy += normal[1] * normal[1];
        x += offset * normal[0];
        y += offset * normal[1];
    }
    let determinant = xx * yy - xy * xy;
    let step = [
        (yy * x - xy * y) / determinant,
        (xx * y - xy * x) / determinant,
    ];
    let told = step[0].hypot(step[1]) <= far;
    let mut segments: Vec<u32> = arms.iter().map(|a| a.segment).collect();
    segments.sort_unstable();
    segments.dedup();
    Some(DetectedCorner {
        at: [0, 1].map(|c| middle[c] + if told { step[c] } else { 0.0 }),
        segments,
    })
}

fn root(groups: &[usize], mut i: usize) -> usize {
    while groups[i] != i {
        i = groups[i];
    }
    i
}

fn unite(groups: &mut [usize], i: usize, j: usize) {
    let [i, j] = [root(groups, i), root(groups, j)];
    groups[i.max(j)] = i.min(j);
}
