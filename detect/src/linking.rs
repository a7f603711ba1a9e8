//! Linking of edge pixels to chains, between ends and branches and around closed curves (Haralick &
//! Shapiro ch. 11).

use super::detection::{EdgeChain, EdgePixel};
use super::gradient::Gradient;
use super::workspace::{Workspace, neighbours};

/// Branches shorter than this, in pixels, are spurs: artefacts of thinning.
const SPUR: usize = 2;

/// The neighbours along edges of one pixel.
#[derive(Clone, Copy, Debug, Default)]
struct Near {
    count: u8,
    pixels: [u32; 8],
}

impl Near {
    fn list(&self) -> &[u32] {
        &self.pixels[..usize::from(self.count)]
    }
}

/// The adjacency of edge pixels.
#[derive(Clone, Debug, Default)]
pub(super) struct Links {
    near: Vec<Near>,
}

/// Links the found pixels and removes spurs.
pub(super) fn link(work: &mut Workspace) -> Links {
    let links = Links::new(work);
    let spurs = links.spurs();
    if spurs.is_empty() {
        return links;
    }
    for &pixel in &spurs {
        work.marks[work.found[pixel as usize] as usize] = 0;
    }
    let marks = &work.marks;
    work.found.retain(|&place| marks[place as usize] != 0);
    Links::new(work)
}

impl Links {
    /// Marks each pixel with its index plus one, and collects its neighbours.
    fn new(work: &mut Workspace) -> Self {
        for (number, &place) in work.found.iter().enumerate() {
            work.marks[place as usize] = number as u32 + 1;
        }
        let near = |&place: &u32| near(place, &work.gradient, &work.marks);
        Self {
            near: work.found.iter().map(near).collect(),
        }
    }

    fn count(&self, pixel: u32) -> usize {
        usize::from(self.near[pixel as usize].count)
    }

    /// The pixels of spurs, in order.
    fn spurs(&self) -> Vec<u32> {
        let mut counts: Vec<u8> = self.near.iter().map(|n| n.count).collect();
        let mut spurs = Vec::new();
        for end in (0..self.near.len() as u32).filter(|&p| self.count(p) == 1) {
            let (mut path, mut before, mut here) = ([end; SPUR], end, end);
            for length in 1..=SPUR {
                path[length - 1] = here;
                let next = self.near[here as usize].list();
                let Some(&next) = next.iter().find(|&&q| q != before) else {
                    break;
                };
                if counts[next as usize] > 2 {
                    counts[next as usize] -= 1;
                    spurs.extend(&path[..length]);
                    break;
                }
                (before, here) = (here, next);
                if self.count(here) != 2 {
                    break;
                }
            }
        }
        spurs.sort_unstable();
        spurs
    }

    /// The chains between ends and branches, and the closed ones, each with the bright side on the
    /// right. Where edges branch, the pixel ends each of the chains.
    pub fn chains(&self, pixels: &[EdgePixel]) -> Vec<EdgeChain> {
        let mut chains = Vec::new();
        let mut taken = vec![false; self.near.len()];
        let all = 0..self.near.len() as u32;
        for node in all.clone().filter(|&p| self.count(p) != 2) {
            if self.count(node) == 0 {
                chains.push(EdgeChain {
                    pixels: vec![node],
                    closed: false,
                });
            }
            for &next in self.near[node as usize].list() {
                let inner = self.count(next) == 2;
                // Two adjacent nodes are linked from the first of them.
                if if inner {
                    !taken[next as usize]
                } else {
                    node < next
                } {
                    chains.push(self.follow(node, next, &mut taken));
                }
            }
        }
        for start in all.filter(|&p| self.count(p) == 2) {
            if !taken[start as usize] {
                taken[start as usize] = true;
                let next = self.near[start as usize].pixels[0];
                chains.push(self.follow(start, next, &mut taken));
            }
        }
        for chain in &mut chains {
            orient(chain, pixels);
        }
        chains
    }

    /// The chain that starts with two pixels.
    fn follow(&self, start: u32, next: u32, taken: &mut [bool]) -> EdgeChain {
        let mut path = vec![start, next];
        let (mut before, mut here) = (start, next);
        while here != start && self.count(here) == 2 {
            taken[here as usize] = true;
            let near = self.near[here as usize].pixels;
            let next = if near[0] == before { near[1] } else { near[0] };
            path.push(next);
            (before, here) = (here, next);
        }
        let closed = here == start;
        if closed {
            path.pop();
        }
        EdgeChain {
            pixels: path,
            closed,
        }
    }
}

/// The marked neighbours of a pixel with a gradient to the same side. A diagonal one is left out
/// where another lies between.
fn near(place: u32, gradient: &Gradient, marks: &[u32]) -> Near {
    let around = neighbours(place, gradient.width);
    let agree = |p: u32, q: u32| {
        let [p, q] = [p as usize, q as usize];
        gradient.x[p] * gradient.x[q] + gradient.y[p] * gradient.y[q] > 0.0
    };
    let linked = around.map(|q| marks[q as usize] != 0 && agree(place, q));
    let mut near = Near::default();
    for k in (0..8).filter(|&k| linked[k]) {
        let between = |side: usize| linked[side] && agree(around[side], around[k]);
        if k % 2 == 1 && (between(k - 1) || between((k + 1) % 8)) {
            continue;
        }
        near.pixels[usize::from(near.count)] = marks[around[k] as usize] - 1;
        near.count += 1;
    }
    near
}

/// Orients a chain so that the gradients point to its right.
fn orient(chain: &mut EdgeChain, pixels: &[EdgePixel]) {
    let mut side = 0.0;
    for pair in chain.pixels.windows(2) {
        let [p, q] = [pair[0], pair[1]].map(|i| &pixels[i as usize]);
        let step = [0, 1].map(|i| q.at[i] - p.at[i]);
        let slope = [0, 1].map(|i| p.gradient[i] + q.gradient[i]);
        side += step[0] * slope[1] - step[1] * slope[0];
    }
    if side < 0.0 {
        chain.pixels.reverse();
    }
}
