//! The connected shrink operator (Haralick & Shapiro ch. 6): border pixels are removed as long as
//! connected pixels stay connected.

use super::gradient::{Gradient, ROUNDING};
use super::parameters::Thinning;
use super::workspace::{Workspace, neighbours};

/// By the set of neighbours: whether a pixel can be removed. Yokoi's connectivity number for
/// 8-neighbours is one, so that they stay connected, and the pixel is not the end of a line.
const REMOVABLE: [bool; 256] = {
    let mut table = [false; 256];
    let mut ring = 0;
    while ring < 256 {
        table[ring] = yokoi(ring) == 1 && ring.count_ones() > 1;
        ring += 1;
    }
    table
};

/// Yokoi's connectivity number of a pixel: how many pieces of border pass through it. Bit k of the
/// ring is neighbour k, in turn; the even ones share a side.
const fn yokoi(ring: usize) -> usize {
    let mut number = 0;
    let mut k = 0;
    while k < 8 {
        let here = 1 & !(ring >> k);
        let next = 1 & !(ring >> (k + 1));
        let after = 1 & !(ring >> ((k + 2) % 8));
        number += here - here * next * after;
        k += 2;
    }
    number
}

/// Makes the marked pixels one pixel thick. After non-maximum suppression only pixels in thicker
/// places are processed.
pub(super) fn shrink(thinning: Thinning, work: &mut Workspace) {
    let (gradient, marks, queue) = (&work.gradient, &mut work.marks, &mut work.queue);
    let every = thinning == Thinning::Shrink;
    queue.clear();
    let thick = work.found.iter().copied();
    queue.extend(thick.filter(|&p| every || is_removable(marks, p, gradient.width)));
    queue.sort_unstable_by(|&p, &q| {
        let [a, b] = [p, q].map(|place| gradient.size[place as usize]);
        a.total_cmp(&b).then(p.cmp(&q))
    });
    let before = queue.len();
    // First towards stronger pixels, and then wherever it is still thick.
    for uphill in [true, false] {
        while peel(gradient, marks, queue, uphill) {}
    }
    if queue.len() < before {
        work.found.retain(|&place| marks[place as usize] != 0);
    }
    queue.clear();
}

/// Removes one layer on each side in turn, the weakest pixels first, so that thick lines are not
/// shortened from their ends. Uphill only across the edge, and only pixels that are not stronger
/// than the next one inwards. Returns whether there were any.
fn peel(gradient: &Gradient, marks: &mut [u32], queue: &mut Vec<u32>, uphill: bool) -> bool {
    let before = queue.len();
    let size = |place: u32| gradient.size[place as usize];
    // Sides 0 and 4 are along the rows.
    let across = |place: u32, side: usize| {
        let [x, y] = [&gradient.x, &gradient.y].map(|g| g[place as usize].abs());
        if side.is_multiple_of(4) {
            x >= y
        } else {
            y >= x
        }
    };
    let mut layer = Vec::new();
    for side in [0, 2, 4, 6] {
        layer.clear();
        layer.extend(queue.iter().copied().filter(|&place| {
            let near = neighbours(place, gradient.width);
            let [out, inward] = [near[side], near[(side + 4) % 8]];
            let outermost = marks[out as usize] == 0 && marks[inward as usize] != 0;
            outermost
                && (!uphill
                    || across(place, side) && size(place) <= size(inward) * (1.0 + ROUNDING))
        }));
        for &place in &layer {
            if is_removable(marks, place, gradient.width) {
                marks[place as usize] = 0;
            }
        }
        queue.retain(|&place| marks[place as usize] != 0);
    }
    queue.len() < before
}

fn is_removable(marks: &[u32], place: u32, width: usize) -> bool {
    let near = neighbours(place, width);
    let bit = |k: usize| usize::from(marks[near[k] as usize] != 0) << k;
    REMOVABLE[(0..8).map(bit).sum::<usize>()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn yokoi_numbers() {
        // Without neighbours, or with all: not on a removable border.
        assert_eq!((yokoi(0), yokoi(255)), (0, 0));
        assert_eq!(yokoi(0b0000_0001), 1);
        assert_eq!(yokoi(0b0001_0001), 2);
        assert_eq!(yokoi(0b1010_1010), 4);
        assert_eq!(yokoi(0b0101_0101), 0);
        assert_eq!(yokoi(0b0000_0111), 1);
        assert_eq!(yokoi(0b0000_1010), 2);
    }

    #[test]
    fn a_bar_becomes_a_line() {
        let (width, height) = (20, 12);
        let mut work = Workspace::new();
        work.resize(width, height);
        for (x, y) in (4..8).flat_map(|y| (3..17).map(move |x| (x, y))) {
            let place = y * width + x;
            work.found.push(place as u32);
            work.marks[place] = 1;
            work.gradient.size[place] = if y == 6 { 9.0 } else { 2.0 };
            work.gradient.y[place] = work.gradient.size[place];
        }
        shrink(Thinning::Shrink, &mut work);
        assert!(work.found.iter().all(|&p| p as usize / width == 6));
        assert!(work.found.len() >= 13, "{}", work.found.len());
        work.clear();
        assert!(work.marks.iter().all(|&m| m == 0));
    }
}
