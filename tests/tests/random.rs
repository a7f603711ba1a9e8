//! Random trees: none may be wrong in any way that is detectable from outside.

use premio_tests::examine::{Depth, VIEWS, examine_within};
use premio_tests::random::tree;
use std::fmt::Write;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

/// Trees that were once wrong, each in its own way, with what is hard about them.
const MENDED: [(u64, &str); 40] = [
    (586, "a slit along a parallel of a torus"),
    (
        1878,
        "a line parallel to a hyperbola's asymptote in the image",
    ),
    (
        2474,
        "a limb that touches another in the image where it ends",
    ),
    (
        6530,
        "a plane that leaves a torus along a direction without curvature",
    ),
    (893, "an edge passes close to where a limb ends on it"),
    (1200, "junctions on both sides of a closed contour's seam"),
    (
        2495,
        "a cone cut by a cylinder parallel to a ruling: a branch with a pole",
    ),
    (2911, "a torus cut through, with a hole in what is left"),
    (3592, "a circle seen almost edge-on, touched by a limb"),
    (
        5895,
        "a limb of a torus along an equator that is an edge elsewhere",
    ),
    (6127, "an arc that touches a plane in its middle"),
    (
        1_000_025,
        "ends of contours on one another, next to a vertex where faces touch",
    ),
    (
        229,
        "mouths of tori that fall on one another along the axis",
    ),
    (2804, "an edge below the sharp edge of an overhang"),
    (7115, "an edge below a narrow gap's edge"),
    (
        4515,
        "limbs that touch in space and evenly in the image, and change places there",
    ),
    (
        2582,
        "a circle seen edge-on whose image ends on another contour",
    ),
    (7382, "a limb that runs along the edge on which it ends"),
    (3052, "an edge below a touch of a plane and a torus"),
    (3081, "a limb below a touch of tori"),
    (
        4498,
        "a limb that ends on an edge where it leaves another one that it touches",
    ),
    (3792, "an edge that leaves another one which it touches"),
    (1429, "a fold that begins where a face ends"),
    (2851, "parallel tori whose top circles cross"),
    (
        5564,
        "a plane through a crossing of a torus's curve with itself, almost along it",
    ),
    (
        6699,
        "a cone with its apex on a torus whose tangent plane holds its axis",
    ),
    (4864, "a limb along a torus's curve next to a crossing"),
    (21000, "an edge below the sharp edge of a very narrow wedge"),
    (20994, "an edge along a wedge thinner than the resolution"),
    (23640, "a sphere across the spine of a torus"),
    (23783, "a sphere with a long narrow hole, for the mesh"),
    (32313, "an edge through the apex of a cone"),
    (9615, "an edge just inside an equator of its own torus"),
    (31400, "a face seen almost edge-on next to its vertex"),
    (
        36160,
        "an edge below a fin that is narrower than lines of sight tell",
    ),
    (43837, "an edge that touches a spherical cavity"),
    (
        45204,
        "branches of one curve that touch, and a face between them",
    ),
    (
        205_132,
        "an edge along the top of a torus, cut where they are apart by less than the resolution",
    ),
    (
        205_852,
        "a corner beside a torus's top circle, nearer to the plane it touches than the resolution",
    ),
    (
        208_224,
        "a slit from a loop that is cut by the torus's equator",
    ),
];

/// The views in which they were wrong.
const MENDED_IN: [&str; 3] = ["perspective 3", "orthographic 1", "along z"];

/// Trees that were wrong along the other axes.
const MENDED_ALONG: [(u64, &str); 12] = [
    (122, "a slit along the top of a torus"),
    (237, "a limb that ends at a vertex of three edges"),
    (
        7115,
        "an edge that touches the limb of a torus beyond its end",
    ),
    (
        9990,
        "a line behind the end of a limb on an edge, and tangent to both",
    ),
    (
        20860,
        "a line that touches a torus's top circle four times over",
    ),
    (22229, "edges along limbs of a torus"),
    (28215, "a cone along one of its rulings"),
    (22433, "a limb tangent to another where that one ends"),
    (
        33461,
        "a fin between circles that touch, thinner than the resolution",
    ),
    (34295, "sides of a cusp that bend back and cross"),
    (
        37930,
        "the far half of a torus's top circle, behind its near half",
    ),
    (38677, "a limb on another one, in front of an edge"),
];

/// The views in which those were wrong.
const MENDED_ALONG_IN: [&str; 2] = ["along x", "along y"];

/// A tree that takes longer is taken for one without end. It is not a measure of speed: the longest
/// takes a tenth of it.
const ENDLESS: Duration = Duration::from_secs(600);

/// Examines the trees of some seeds on two threads.
fn assert_all_right(seeds: &[u64], views: &'static [&'static str]) {
    let depth = Depth {
        rays: 20_000,
        views,
    };
    let next = AtomicUsize::new(0);
    let wrong = Mutex::new(String::new());
    std::thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                loop {
                    let Some(&seed) = seeds.get(next.fetch_add(1, Ordering::Relaxed)) else {
                        return;
                    };
                    let json = tree(seed).to_string();
                    let found = examine_within(&json, depth, ENDLESS);
                    if !found.is_empty() {
                        let all = found.join("\n  ");
                        let mut wrong = wrong.lock().unwrap();
                        writeln!(wrong, "seed {seed}\n  {all}\n  {json}").unwrap();
                    }
                }
            });
        }
    });
    let wrong = wrong.into_inner().unwrap();
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn solids() {
    assert_all_right(&Vec::from_iter(0..300), &[]);
}

#[test]
fn views() {
    assert_all_right(&Vec::from_iter(0..60), &VIEWS);
}

#[test]
fn mended() {
    assert_all_right(&MENDED.map(|(seed, _)| seed), &MENDED_IN);
    assert_all_right(&MENDED_ALONG.map(|(seed, _)| seed), &MENDED_ALONG_IN);
}
