//! Joining of chains across gaps.

use super::detection::{EdgeChain, EdgePixel};
use super::parameters::Detector;

/// The cosine of the greatest angle between chains that are joined: 30 degrees.
const AGREEING: f64 = 0.866_025_403_784_438_6;

/// The number of pixels that determine the direction of an end.
const REACH: usize = 6;

/// Ends nearer to each other than this, in pixels, are joined whatever the direction from one to
/// the other.
const TOUCHING: f64 = 2.0;

/// The fewest pixels of a chain that is joined to itself.
const RING: usize = 8;

/// An end of a chain: where it is, and the direction of the chain there, of length one.
#[derive(Clone, Copy, Debug)]
pub(super) struct End {
    pub at: [f64; 2],
    pub along: [f64; 2],
}

/// The first end of a chain, and the last; both directions are along the chain.
pub(super) fn ends(chain: &EdgeChain, pixels: &[EdgePixel]) -> [End; 2] {
    let list = &chain.pixels;
    let reach = list.len().min(REACH);
    let [first, last] = [&list[..reach], &list[list.len() - reach..]];
    let at = |i: u32| pixels[i as usize].at;
    [
        End {
            at: at(first[0]),
            along: direction(first, pixels),
        },
        End {
            at: at(last[reach - 1]),
            along: direction(last, pixels),
        },
    ]
}

/// The direction of a few pixels in order: from end to end, or where they are too few, the one with
/// the gradient on the right.
fn direction(list: &[u32], pixels: &[EdgePixel]) -> [f64; 2] {
    let [first, last] = [list[0], list[list.len() - 1]].map(|i| pixels[i as usize].at);
    let mut along = [last[0] - first[0], last[1] - first[1]];
    if list.len() < 4 {
        along = [0.0; 2];
        for &i in list {
            let slope = pixels[i as usize].gradient;
            along[0] += slope[1];
            along[1] -= slope[0];
        }
    }
    let length = along[0].hypot(along[1]);
    if length > 0.0 {
        along.map(|x| x / length)
    } else {
        [1.0, 0.0]
    }
}

/// Joins chains whose ends are within the detector's gap, drops the short ones, and sorts the
/// others by their first pixels.
pub(super) fn join(
    chains: Vec<EdgeChain>,
    pixels: &[EdgePixel],
    detector: &Detector,
) -> Vec<EdgeChain> {
    let next = partners(&chains, pixels, detector.gap);
    let mut preceded = vec![false; chains.len()];
    for &n in next.iter().flatten() {
        preceded[n] = true;
    }
    let mut used = vec![false; chains.len()];
    let mut joined = Vec::new();
    // First from the chains that no other precedes, and then around rings.
    let order = (0..chains.len()).filter(|&i| !preceded[i]);
    for start in order.chain(0..chains.len()) {
        if !used[start] {
            joined.push(concatenate(start, &chains, &next, &mut used));
        }
    }
    joined.retain(|c| c.pixels.len() > 1 && length(c, pixels) >= detector.shortest);
    joined.sort_by(|a, b| a.pixels.cmp(&b.pixels));
    joined
}

/// By chain: the one that follows it, if any.
fn partners(chains: &[EdgeChain], pixels: &[EdgePixel], gap: f64) -> Vec<Option<usize>> {
    let mut next = vec![None; chains.len()];
    let mut taken = vec![false; chains.len()];
    for Continuation { tail, head, .. } in continuations(chains, pixels, gap) {
        if next[tail].is_none() && !taken[head] {
            next[tail] = Some(head);
            taken[head] = true;
        }
    }
    next
}

/// A pair of chains of which the second may follow the first.
struct Continuation {
    /// The cost, in pixels.
    cost: f64,
    /// The index of the first chain.
    tail: usize,
    /// The index of the second chain.
    head: usize,
}

/// An end of a chain.
#[derive(Clone, Copy)]
struct ChainEnd {
    /// The index of the chain.
    chain: usize,
    end: End,
}

/// The pairs of chains that may continue each other, the nearest and straightest first.
fn continuations(chains: &[EdgeChain], pixels: &[EdgePixel], gap: f64) -> Vec<Continuation> {
    let open = (0..chains.len()).filter(|&i| !chains[i].closed);
    let ends = open.map(|chain| ends(&chains[chain], pixels).map(|end| ChainEnd { chain, end }));
    let ends: Vec<[ChainEnd; 2]> = ends.collect();
    let mut heads: Vec<ChainEnd> = ends.iter().map(|[head, _]| *head).collect();
    heads.sort_by(|a, b| a.end.at[1].total_cmp(&b.end.at[1]));
    let slope = |i: &u32| pixels[*i as usize].gradient;
    let agree = |tail: Option<&u32>, head: Option<&u32>| {
        let both = tail.map(slope).zip(head.map(slope));
        both.is_some_and(|(a, b)| a[0] * b[0] + a[1] * b[1] > 0.0)
    };
    let mut pairs = Vec::new();
    for [_, last] in &ends {
        let (tail, end) = (last.chain, &last.end);
        let first = heads.partition_point(|h| h.end.at[1] < end.at[1] - gap);
        let near = heads[first..].iter();
        for first in near.take_while(|h| h.end.at[1] <= end.at[1] + gap) {
            let head = first.chain;
            if tail == head && chains[tail].pixels.len() < RING {
                continue;
            }
            let one_side = agree(chains[tail].pixels.last(), chains[head].pixels.first());
            if let Some(cost) = cost(end, &first.end, gap).filter(|_| one_side) {
                pairs.push(Continuation { cost, tail, head });
            }
        }
    }
    pairs.sort_by(|a, b| {
        let chains = [a.tail, a.head].cmp(&[b.tail, b.head]);
        a.cost.total_cmp(&b.cost).then(chains)
    });
    pairs
}

/// The cost of the continuation of a chain, in pixels; none where they do not continue each other.
fn cost(tail: &End, head: &End, gap: f64) -> Option<f64> {
    let step = [head.at[0] - tail.at[0], head.at[1] - tail.at[1]];
    let distance = step[0].hypot(step[1]);
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let agreement = dot(tail.along, head.along);
    let straight = [tail, head].map(|e| dot(e.along, step) >= AGREEING * distance);
    let reached = distance <= gap && agreement >= AGREEING;
    let on = distance <= TOUCHING || straight == [true; 2];
    (reached && on).then_some(distance + (1.0 - agreement))
}

/// A chain joined with all that follow it.
fn concatenate(
    start: usize,
    chains: &[EdgeChain],
    next: &[Option<usize>],
    used: &mut [bool],
) -> EdgeChain {
    let mut chain = chains[start].clone();
    used[start] = true;
    let mut here = start;
    while let Some(following) = next[here] {
        if following == start {
            chain.closed = true;
            // Both ends are one pixel where edges branch.
            if chain.pixels.len() > 1 && chain.pixels.first() == chain.pixels.last() {
                chain.pixels.pop();
            }
            break;
        }
        let more = &chains[following].pixels;
        let shared = usize::from(chain.pixels.last() == more.first());
        chain.pixels.extend(&more[shared..]);
        used[following] = true;
        here = following;
    }
    chain
}

fn length(chain: &EdgeChain, pixels: &[EdgePixel]) -> f64 {
    let at = |i: u32| pixels[i as usize].at;
    let steps = chain.pixels.windows(2);
    let steps = steps.map(|pair| [at(pair[0]), at(pair[1])]);
    steps.map(|[p, q]| (q[0] - p[0]).hypot(q[1] - p[1])).sum()
}
