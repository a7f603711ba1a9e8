//! The detector on drawn images.

use super::*;
use proptest::prelude::*;

const FINE: usize = 8;

/// An anti-aliased picture: level 200 where a point is inside, and 50 elsewhere.
fn draw(width: usize, height: usize, inside: impl Fn(f64, f64) -> bool) -> Grey {
    let place = |pixel: usize, k: usize| pixel as f64 - 0.5 + (k as f64 + 0.5) / FINE as f64;
    Grey::new(width, height, |x, y| {
        let row = |j| {
            (0..FINE)
                .filter(|&i| inside(place(x, i), place(y, j)))
                .count()
        };
        let count: usize = (0..FINE).map(row).sum();
        50.0 + 150.0 * count as f32 / (FINE * FINE) as f32
    })
}

fn detect(detector: &Detector, grey: &Grey) -> Detection {
    detector.validate().unwrap();
    let found = detector.detect(grey, &PixelMask::full(grey.width, grey.height));
    check(&found);
    found
}

/// Checks the invariants of every detection.
fn check(found: &Detection) {
    for chain in &found.chains {
        assert!(chain.pixels.len() > 1);
        for pair in chain.pixels.windows(2) {
            let [p, q] = [pair[0], pair[1]].map(|i| &found.pixels[i as usize]);
            let dot = p.gradient[0] * q.gradient[0] + p.gradient[1] * q.gradient[1];
            assert!(dot > 0.0 || p.x.abs_diff(q.x).max(p.y.abs_diff(q.y)) > 1);
        }
    }
    let mut ends = vec![0; found.chains.len()];
    for s in &found.segments {
        assert_eq!(ends[s.chain as usize], s.range[0]);
        assert!(s.range[0] < s.range[1] && s.rms.is_finite());
        ends[s.chain as usize] = s.range[1];
    }
    for (chain, end) in found.chains.iter().zip(ends) {
        assert_eq!(chain.pixels.len(), end as usize);
    }
    for corner in &found.corners {
        assert!(corner.at.iter().all(|x| x.is_finite()) && !corner.segments.is_empty());
    }
}

fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    (p[0] - q[0]).hypot(p[1] - q[1])
}

/// A rotated square about a centre.
fn square(middle: [f64; 2], half: f64, turn: f64) -> impl Fn(f64, f64) -> bool {
    let (sin, cos) = turn.sin_cos();
    move |x, y| {
        let [x, y] = [x - middle[0], y - middle[1]];
        (cos * x + sin * y).abs() < half && (cos * y - sin * x).abs() < half
    }
}

fn noise(seed: &mut u64) -> f32 {
    *seed = seed
        .wrapping_mul(6364136223846793005)
        .wrapping_add(1442695040888963407);
    (*seed >> 40) as f32 / (1 << 24) as f32
}

const MASKS: [Mask; 4] = [
    Mask::Roberts,
    Mask::Prewitt,
    Mask::Sobel,
    Mask::Gaussian { sigma: 1.0 },
];

/// The allowed error: a parabola through two pixels of an edge without blur is not exact.
fn exactness(mask: Mask, allowed: f64) -> f64 {
    if mask == Mask::Roberts {
        allowed.max(0.2)
    } else {
        allowed
    }
}

#[test]
fn a_step_is_found_between_pixels() {
    for mask in MASKS {
        for (tenth, thinning) in (0..10)
            .flat_map(|t| [Thinning::NonMaximum, Thinning::Shrink].map(|thinning| (t, thinning)))
        {
            let edge = 20.0 + f64::from(tenth) / 10.0;
            // Exactly by areas.
            let level = |x: usize| (x as f64 + 0.5 - edge).clamp(0.0, 1.0) as f32;
            let detector = Detector {
                mask,
                threshold: 20.0,
                thinning,
                ..Detector::default()
            };
            let found = detect(&detector, &Grey::new(40, 30, |x, _| 100.0 * level(x)));
            assert!(found.pixels.len() >= 18, "{mask:?}");
            for p in &found.pixels {
                let off = (p.at[0] - edge).abs();
                assert!(
                    off < exactness(mask, 0.05),
                    "{mask:?} {thinning:?} {edge}: {off}"
                );
            }
            assert_eq!(found.segments.len(), 1);
        }
    }
}

#[test]
fn a_square_has_four_lines() {
    for (turn, mask) in [0.0, 0.2, 0.5, 0.785, 1.3]
        .into_iter()
        .flat_map(|t| MASKS.map(|m| (t, m)))
    {
        let detector = Detector {
            mask,
            ..Detector::default()
        };
        let middle = [50.3, 47.8];
        let found = detect(&detector, &draw(100, 100, square(middle, 25.2, turn)));
        let name = format!("{mask:?} {turn}: {found:#?}");
        let name = &name[name.find("chains").unwrap()..];
        assert_eq!(found.segments.len(), 4, "{mask:?} {turn} {name}");
        assert_eq!(found.corners.len(), 4, "{mask:?} {turn} {name}");
        for corner in &found.corners {
            assert_eq!(corner.segments.len(), 2);
            let near = (0..4).map(|k| {
                let angle = turn + std::f64::consts::FRAC_PI_4 * f64::from(2 * k + 1);
                let r = 25.2 * 2_f64.sqrt();
                distance(
                    corner.at,
                    [middle[0] + r * angle.cos(), middle[1] + r * angle.sin()],
                )
            });
            let near = near.fold(9.0, f64::min);
            assert!(near < exactness(mask, 0.1), "{mask:?} {turn}: {near}");
        }
    }
}

#[test]
fn a_circle_is_one_ellipse() {
    for (radius, mask) in [8.0, 20.4, 41.0]
        .into_iter()
        .flat_map(|r| MASKS.map(|m| (r, m)))
    {
        let middle = [50.3, 49.8];
        let inside = |x: f64, y: f64| distance([x, y], middle) < radius;
        let detector = Detector {
            mask,
            ..Detector::default()
        };
        let found = detect(&detector, &draw(100, 100, inside));
        assert_eq!(
            found.segments.len(),
            1,
            "{mask:?} {radius} {:?}",
            found.segments
        );
        assert!(found.corners.is_empty());
        let SegmentShape::Ellipse { centre, axes, .. } = found.segments[0].shape else {
            panic!("{:?}", found.segments);
        };
        assert!(distance(centre, middle) < 0.05, "{mask:?} {centre:?}");
        let allowed = if radius < 10.0 { 0.1 } else { 0.05 };
        for [x, y] in axes {
            assert!(
                (x.hypot(y) - radius).abs() < allowed,
                "{mask:?} {radius}: {}",
                x.hypot(y)
            );
        }
    }
}

#[test]
fn a_half_circle_is_an_arc() {
    let middle = [50.3, 40.2];
    let inside = |x: f64, y: f64| distance([x, y], middle) < 30.0 && y > middle[1];
    let found = detect(&Detector::default(), &draw(100, 100, inside));
    assert_eq!(
        (found.segments.len(), found.corners.len()),
        (2, 2),
        "{:#?}",
        found.segments
    );
    let line = found
        .segments
        .iter()
        .find(|s| matches!(s.shape, SegmentShape::Line { .. }));
    assert!(line.is_some());
    let arc = found.segments.iter().find_map(|s| match s.shape {
        SegmentShape::Arc { middle, ends, .. } => Some((middle, ends)),
        _ => None,
    });
    let (at, ends) = arc.unwrap();
    for p in [at, ends[0], ends[1]] {
        assert!((distance(p, middle) - 30.0).abs() < 0.25, "{p:?}");
    }
    assert!(distance(at, [50.3, 70.2]) < 2.0);
    for corner in &found.corners {
        let off = [20.3, 80.3].map(|x| distance(corner.at, [x, 40.2]));
        assert!(off[0].min(off[1]) < 0.3, "{corner:?}");
    }
}

/// Two edges at an angle in degrees, 300 and 45 pixels long, with some noise; at the border of the
/// image no edge is found.
fn bend(degrees: f64) -> Grey {
    let slope = degrees.to_radians().tan();
    let mut grey = draw(80, 350, |x, y| {
        x > 30.3 + 0.1 * y + slope * (y - 305.0).max(0.0)
    });
    let mut seed = 7;
    for level in &mut grey.levels {
        *level += noise(&mut seed);
    }
    grey
}

#[test]
fn a_slight_bend_is_a_corner_and_no_arc() {
    let detector = Detector {
        mask: Mask::Gaussian { sigma: 1.0 },
        ..Detector::default()
    };
    for degrees in [2.0, 2.5, 3.0, 5.0] {
        let found = detect(&detector, &bend(degrees));
        let lines = |s: &DetectedSegment| matches!(s.shape, SegmentShape::Line { .. });
        assert!(
            found.segments.iter().all(lines),
            "{degrees}: {:?}",
            found.segments
        );
        assert_eq!(found.segments.len(), 2, "{degrees}");
        let ends = ends_of_lines(&found);
        let gap = distance(ends[0][1], ends[1][0]).min(distance(ends[0][0], ends[1][1]));
        assert!(gap < 3.0, "{degrees}: {ends:?}");
    }
}

/// An arc with as little curvature over the same length is still found as one.
#[test]
fn a_flat_arc_is_an_arc() {
    for radius in [400.0, 1500.0, 3000.0] {
        let grey = draw(80, 420, |x, y| {
            (x - 40.0 - radius).hypot(y - 210.0) < radius
        });
        let found = detect(&Detector::default(), &grey);
        let [segment] = &found.segments[..] else {
            panic!("{radius}: {:?}", found.segments);
        };
        assert!(
            matches!(segment.shape, SegmentShape::Arc { .. }),
            "{radius}"
        );
    }
}

#[test]
fn an_ellipse_and_a_slot() {
    let ellipse = |x: f64, y: f64| ((x - 60.0) / 40.0).powi(2) + ((y - 50.0) / 15.0).powi(2) < 1.0;
    let found = detect(&Detector::default(), &draw(120, 100, ellipse));
    let SegmentShape::Ellipse { axes, .. } = found.segments[0].shape else {
        panic!("{:#?}", found.segments);
    };
    assert!((distance(axes[0], [0.0; 2]) - 40.0).abs() < 0.1, "{axes:?}");
    assert!((distance(axes[1], [0.0; 2]) - 15.0).abs() < 0.1, "{axes:?}");
    let slot = |x: f64, y: f64| distance([x, y], [x.clamp(40.0, 80.0), 50.0]) < 20.0;
    let found = detect(&Detector::default(), &draw(120, 100, slot));
    assert_eq!(found.segments.len(), 4, "{:#?}", found.segments);
    let lines = found
        .segments
        .iter()
        .filter(|s| matches!(s.shape, SegmentShape::Line { .. }));
    assert_eq!(lines.count(), 2);
}

#[test]
fn weak_pixels_are_kept_by_strong_ones() {
    // A step that fades downwards, and a weak one by itself.
    let level = |x: usize, y: usize| match x {
        0..20 => 0.0,
        20..40 => 60.0 - y as f32,
        _ => 60.0 - y as f32 + 12.0,
    };
    let grey = Grey::new(60, 50, level);
    let count = |low| {
        let detector = Detector {
            threshold: 20.0,
            low,
            ..Detector::default()
        };
        detect(&detector, &grey).pixels.len()
    };
    let (strong, joined) = (count(None), count(Some(5.1)));
    assert!((15..25).contains(&strong), "{strong}");
    assert!((joined as i32 - 46).abs() < 2, "{joined}");
}

#[test]
fn gaps_are_joined_up_to_a_width() {
    let grey = Grey::new(80, 30, |x, y| {
        let missing = (40..43).contains(&x);
        if y < 15 || missing { 50.0 } else { 150.0 }
    });
    let chains = |gap, known: &dyn Fn(usize, usize) -> bool| {
        let plain = Grey::new(80, 30, |_, y| if y < 15 { 50.0 } else { 150.0 });
        let mask: Vec<bool> = (0..80 * 30).map(|i| known(i % 80, i / 80)).collect();
        let domain = PixelMask::of_mask(80, 30, &mask);
        let detector = Detector {
            gap,
            ..Detector::default()
        };
        let found = detector.detect(&plain, &domain);
        check(&found);
        found.chains.len()
    };
    // One unknown column hides those within the radius, two to each side.
    assert_eq!(chains(3.0, &|x, _| x != 40), 2);
    assert_eq!(chains(6.5, &|x, _| x != 40), 1);
    assert_eq!(chains(6.5, &|x, _| !(40..43).contains(&x)), 2);
    // A gap is not bridged where the edge turns.
    let found = detect(
        &Detector {
            gap: 8.0,
            ..Detector::default()
        },
        &grey,
    );
    assert!(found.chains.len() >= 2 || found.segments.len() > 2);
}

#[test]
fn a_band_shows_what_the_whole_shows() {
    let scene = |x: f64, y: f64| {
        square([60.0, 60.0], 35.0, 0.3)(x, y) != (distance([x, y], [70.0, 62.0]) < 18.0)
    };
    let grey = draw(130, 120, scene);
    for (mask, thinning) in MASKS
        .into_iter()
        .flat_map(|m| [Thinning::NonMaximum, Thinning::Shrink].map(|t| (m, t)))
    {
        let detector = Detector {
            mask,
            thinning,
            ..Detector::default()
        };
        let whole = detect(&detector, &grey);
        // The thick edges must be known where shrinking processes them.
        let reach = 2 * detector.radius() as i32 + 2;
        let mut known = vec![false; 130 * 120];
        for p in &whole.pixels {
            for (dx, dy) in (-reach..=reach).flat_map(|y| (-reach..=reach).map(move |x| (x, y))) {
                let (x, y) = (p.x as i32 + dx, p.y as i32 + dy);
                if (0..130).contains(&x) && (0..120).contains(&y) {
                    known[(y * 130 + x) as usize] = true;
                }
            }
        }
        // Unknown pixels may have any value.
        let mut spoilt = grey.clone();
        for (level, known) in spoilt.levels.iter_mut().zip(&known) {
            *level = if *known { *level } else { f32::NAN };
        }
        let domain = PixelMask::of_mask(130, 120, &known);
        assert!(domain.len() < 130 * 120);
        assert_eq!(
            detector.detect(&spoilt, &domain),
            whole,
            "{mask:?} {thinning:?}"
        );
    }
}

#[test]
fn a_workspace_is_used_again() {
    let mut work = Workspace::new();
    let detector = Detector {
        low: Some(3.0),
        ..Detector::default()
    };
    for size in [40, 90, 33] {
        let half = size as f64 / 2.0;
        let grey = draw(size, size + 5, square([half, half], half / 2.0, 0.4));
        let domain = PixelMask::full(size, size + 5);
        let again = detector.detect_with(&mut work, &grey, &domain);
        assert_eq!(again, detector.detect(&grey, &domain));
        assert!(!again.segments.is_empty());
    }
}

#[test]
fn nothing_crashes() {
    let mut seed = 7;
    for (width, height) in [(0, 0), (1, 1), (0, 9), (5, 1), (4, 4), (5, 5), (70, 50)] {
        for (mask, thinning) in MASKS
            .into_iter()
            .flat_map(|m| [Thinning::NonMaximum, Thinning::Shrink].map(|t| (m, t)))
        {
            let mut grey = Grey::new(width, height, |_, _| 0.0);
            for level in &mut grey.levels {
                let value = noise(&mut seed);
                *level = if value > 0.99 {
                    f32::NAN
                } else {
                    255.0 * value
                };
            }
            let detector = Detector {
                mask,
                thinning,
                shortest: 0.0,
                low: Some(1.0),
                ..Detector::default()
            };
            check(&detector.detect(&grey, &PixelMask::full(width, height)));
            let mask: Vec<bool> = grey
                .levels
                .iter()
                .map(|_| noise(&mut seed) < 0.98)
                .collect();
            check(&detector.detect(&grey, &PixelMask::of_mask(width, height, &mask)));
        }
    }
}

#[test]
fn what_is_no_detector_does_not_crash() {
    let grey = Grey {
        width: 3,
        height: 3,
        levels: vec![],
    };
    let found = Detector::default().detect(&grey, &PixelMask::full(3, 3));
    assert_eq!(found, Detection::default());
    let flat = Grey::new(40, 40, |x, y| (x + 2 * y) as f32);
    let wrong = Detector {
        threshold: f64::NAN,
        gap: f64::NAN,
        corner: f64::NAN,
        shortest: f64::NAN,
        mask: Mask::Gaussian { sigma: f64::NAN },
        ..Detector::default()
    };
    check(&wrong.detect(&flat, &PixelMask::full(40, 40)));
    let zero = Detector {
        threshold: 0.0,
        gap: 0.0,
        corner: 0.0,
        shortest: 0.0,
        ..Detector::default()
    };
    check(&zero.detect(
        &draw(60, 60, square([30.0, 30.0], 14.0, 0.3)),
        &PixelMask::full(60, 60),
    ));
}

/// The line nearest to a known one, by its ends.
fn ends_of_lines(found: &Detection) -> Vec<[[f64; 2]; 2]> {
    let ends = found.segments.iter().map(|s| match s.shape {
        SegmentShape::Line { ends } => ends,
        other => panic!("{other:?}"),
    });
    ends.collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn lines_at_any_angle(
        angle in 0.0..std::f64::consts::TAU,
        offset in prop::array::uniform2(-1.0..1.0_f64),
        long in 20.0..45.0_f64,
        mask in prop::sample::select(MASKS[1..].to_vec()),
        noisy in prop::bool::ANY,
    ) {
        // The long sides of a bar, both of known ends.
        let (sin, cos) = angle.sin_cos();
        let half = 8.0;
        let middle = [60.0 + offset[0], 60.0 + offset[1]];
        let inside = |x: f64, y: f64| {
            let [x, y] = [x - middle[0], y - middle[1]];
            (cos * x + sin * y).abs() < long && (cos * y - sin * x).abs() < half
        };
        let mut grey = draw(120, 120, inside);
        let mut seed = 3;
        if noisy {
            grey.levels.iter_mut().for_each(|l| *l += 4.0 * (noise(&mut seed) - 0.5));
        }
        let detector = Detector { mask, ..Detector::default() };
        let found = detect(&detector, &grey);
        prop_assert_eq!(found.segments.len(), 4, "{:?}", found.segments);
        let at = |u: f64, v: f64| [middle[0] + cos * u - sin * v, middle[1] + sin * u + cos * v];
        let lines = ends_of_lines(&found);
        let allowed = 1.5;
        for side in [-half, half] {
            let [p, q] = [at(-long, side), at(long, side)];
            let off = |[a, b]: &[[f64; 2]; 2]| {
                let [there, back] = [distance(*a, p).max(distance(*b, q)), distance(*a, q).max(distance(*b, p))];
                there.min(back)
            };
            let best = lines.iter().map(off).fold(f64::INFINITY, f64::min);
            prop_assert!(best < allowed, "{mask:?}: {best}");
        }
        for s in &found.segments {
            prop_assert!(s.rms < 0.15, "{}", s.rms);
        }
    }

    #[test]
    fn noise_gives_no_crash(levels in prop::collection::vec(0.0..255_f32, 400), low in 0.0..10.0) {
        let grey = Grey { width: 20, height: 20, levels };
        for thinning in [Thinning::NonMaximum, Thinning::Shrink] {
            let detector = Detector { thinning, low: Some(low), shortest: 0.0, corner: 0.5, ..Detector::default() };
            check(&detector.detect(&grey, &PixelMask::full(20, 20)));
        }
    }
}
