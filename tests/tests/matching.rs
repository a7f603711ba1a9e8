//! Matching in rendered pictures: known poses, absent parts, clutter.

use nalgebra::{Isometry3, Matrix3, Rotation3, Translation3, UnitQuaternion, Vector3};
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions as Reading, read};
use premio_detect::Grey;
use premio_matching::camera::Pinhole;
use premio_matching::image::{ImageFeatures, detector};
use premio_matching::matcher::Matcher;
use premio_matching::part::SoughtPart;
use premio_matching::part::detectability_prior::DetectabilityPrior;
use premio_matching::search::Strategy;
use premio_matching::search::monitor::{SEARCH_STEPS, SearchMonitor};
use premio_matching::verification::part_match::{
    PartMatch, SearchLimits, SearchOptions, SearchResult,
};
use premio_predict::prediction::{Memory, with_draft};
use premio_predict::prepared_part::PreparedPart;
use premio_predict::render;
use premio_predict::setup::Setup;
use premio_tests::parts::cube_with_cuts;
use rayon::ThreadPoolBuilder;
use serde_json::{Value, json};
use std::sync::Mutex;

const SIZE: [usize; 2] = [320, 240];
const FOCAL: f64 = 350.0;

fn part(json: &Value) -> Evaluation {
    let text = json.to_string();
    let tree = read("part", text.as_bytes(), Format::Json, &Reading::default()).unwrap();
    evaluate(&tree.tree, &EvaluationOptions::default()).unwrap()
}

fn camera() -> Pinhole {
    let (cx, cy) = (0.5 * (SIZE[0] as f64 - 1.0), 0.5 * (SIZE[1] as f64 - 1.0));
    Pinhole::new(&Matrix3::new(FOCAL, 0.0, cx, 0.0, FOCAL, cy, 0.0, 0.0, 1.0)).unwrap()
}

/// A camera at `eye` that looks at the part's centre with z upwards; both are in units of the
/// part's radius, relative to the centre.
fn pose(subject: &PreparedPart<'_>, eye: [f64; 3], target: [f64; 3]) -> Isometry3<f64> {
    let at = |d: [f64; 3]| subject.centre + Vector3::from(d) * subject.radius;
    let (eye, target) = (at(eye), at(target));
    let z = (target - eye).normalize();
    let x = z.cross(&Vector3::z()).normalize();
    let r = Matrix3::from_rows(&[x.transpose(), z.cross(&x).transpose(), z.transpose()]);
    let turn = UnitQuaternion::from_rotation_matrix(&Rotation3::from_matrix_unchecked(r));
    Isometry3::from_parts(Translation3::from(-(turn * eye.coords)), turn)
}

/// The picture of a part at a pose, with noise.
fn picture(subject: &PreparedPart<'_>, pose: &Isometry3<f64>, seed: u64) -> Grey {
    let k = camera();
    let r = pose.rotation.to_rotation_matrix();
    let row = |i: usize| format!("[{}, {}, {}]", r[(i, 0)], r[(i, 1)], r[(i, 2)]);
    let t = pose.translation.vector;
    let light = pose.inverse() * nalgebra::Point3::new(0.6 * t.z, -0.9 * t.z, 0.1 * t.z);
    let text = format!(
        "ambient = 0.3\nbackground = 0.02\n[camera]\n\
         K = [[{f}, 0, {cx}], [0, {f}, {cy}], [0, 0, 1]]\nR = [{}, {}, {}]\nt = [{}, {}, {}]\n\
         [[light]]\nposition = [{}, {}, {}]\n[material]\nambient = 0.3\ndiffuse = 0.25\n\
         s = 0\nd = 1\nm = 0.3\nn = 1.5\nk = 0\n\
         [sensor]\nresolution = [{}, {}]\nwhite = 200\nblur = 0.6\nelectrons = 10000\nread_noise = 1\n",
        row(0),
        row(1),
        row(2),
        t.x,
        t.y,
        t.z,
        light.x,
        light.y,
        light.z,
        SIZE[0],
        SIZE[1],
        f = FOCAL,
        cx = k.centre[0],
        cy = k.centre[1],
    );
    let setup = Setup::from_toml(&text).unwrap();
    let drawn = with_draft(subject, None, &setup, &mut Memory::default(), |draft| {
        let levels = render::rows(&draft.shading, SIZE[0], 0..SIZE[1]);
        render::finished(levels, &draft.conditions.sensor, seed)
    });
    drawn.unwrap()
}

fn sought<'a>(evaluation: &'a Evaluation, learned: &DetectabilityPrior) -> SoughtPart<'a> {
    SoughtPart::new(&evaluation.brep, evaluation.resolution, learned)
}

/// Evaluates a function of a part that is searched for in a picture.
fn looked<T>(
    part: &SoughtPart<'_>,
    picture: &ImageFeatures,
    options: &SearchOptions,
    ask: impl FnOnce(&Matcher<'_>) -> T,
) -> T {
    ask(&Matcher {
        part,
        learned: &DetectabilityPrior::nothing(),
        picture,
        camera: &camera(),
        options,
        monitor: &(),
    })
}

fn look(part: &SoughtPart<'_>, grey: &Grey, options: &SearchOptions) -> SearchResult {
    let picture = ImageFeatures::new(grey, &detector());
    looked(part, &picture, options, |look| look.find()).unwrap()
}

/// The error of a pose, minimised over the part's symmetries: of the centre, in units of the part's
/// radius, and in radians.
fn off(part: &SoughtPart<'_>, found: &Isometry3<f64>, truth: &Isometry3<f64>) -> [f64; 2] {
    let each = part.turns().map(|s| {
        let pose = found * s;
        let moved = (pose * part.centre - truth * part.centre).norm() / part.radius;
        [moved, pose.rotation.angle_to(&truth.rotation)]
    });
    each.min_by(|a, b| (a[0] + a[1]).total_cmp(&(b[0] + b[1])))
        .unwrap()
}

const EYES: [[f64; 3]; 3] = [[3.1, 2.4, 2.6], [-3.6, 1.9, 2.2], [2.2, -3.4, 2.9]];

#[test]
fn a_part_is_found_where_it_is() {
    let evaluation = part(&cube_with_cuts());
    let subject = PreparedPart::new(&evaluation.brep, evaluation.resolution).unwrap();
    let part = sought(&evaluation, &DetectabilityPrior::nothing());
    for (seed, eye) in (1..).zip(EYES) {
        let truth = pose(&subject, eye, [0.15, -0.1, 0.05]);
        let grey = picture(&subject, &truth, seed);
        let finding = look(&part, &grey, &SearchOptions::default());
        let best = finding.best().unwrap();
        assert!(best.is_accepted(), "{eye:?}: ratio {}", best.ratio);
        let [moved, turned] = off(&part, &best.pose, &truth);
        assert!(moved < 0.02 && turned < 0.02, "{eye:?}: {moved} {turned}");
        assert!(best.found() * 2 > best.pairs.len(), "{:?}", best.pairs);
    }
}

/// Pixels determine angles only: a part a thousand million times as large, or as small, is as far
/// away in proportion.
#[test]
fn a_part_of_any_size_is_found() {
    let poses = [1.0, 1e9, 1e-9].map(|unit| {
        let block = json!({"prim": "block", "size": [3.0 * unit, 2.0 * unit, 4.0 * unit]});
        let evaluation = part(&block);
        let subject = PreparedPart::new(&evaluation.brep, evaluation.resolution).unwrap();
        let part = sought(&evaluation, &DetectabilityPrior::nothing());
        // One picture for all sizes: that of the block of the first size.
        let first = self::part(&json!({"prim": "block", "size": [3.0, 2.0, 4.0]}));
        let one = PreparedPart::new(&first.brep, first.resolution).unwrap();
        let grey = picture(&one, &pose(&one, EYES[0], [0.0; 3]), 5);
        let best = look(&part, &grey, &SearchOptions::default())
            .matches
            .remove(0);
        assert!(best.is_accepted());
        let truth = pose(&subject, EYES[0], [0.0; 3]);
        let [moved, turned] = off(&part, &best.pose, &truth);
        assert!(moved < 0.02 && turned < 0.02, "{unit}: {moved} {turned}");
        best.ratio
    });
    let same = |a: f64, b: f64| (a - b).abs() < 1e-6;
    assert!(poses.iter().all(|r| same(*r, poses[0])), "{poses:?}");
}

/// A cube with a pocket in its bottom, seen from above. The side with the pocket is undetermined,
/// so several poses are reported, among them the right one.
#[test]
fn poses_that_look_alike_are_reported() {
    let block = |size: [f64; 3], at: [f64; 3]| json!({"prim": "block", "size": size, "transform": [{"translate": at}]});
    let cube = block([2.0; 3], [0.0; 3]);
    let pocket = block([1.0, 1.0, 0.5], [0.5, 0.5, 0.0]);
    let evaluation = part(&json!({"op": "difference", "children": [cube, pocket]}));
    let subject = PreparedPart::new(&evaluation.brep, evaluation.resolution).unwrap();
    let part = sought(&evaluation, &DetectabilityPrior::nothing());
    let truth = pose(&subject, EYES[0], [0.0; 3]);
    let finding = look(
        &part,
        &picture(&subject, &truth, 7),
        &SearchOptions::default(),
    );
    let best = finding.best().unwrap();
    let all: Vec<&PartMatch> = std::iter::once(best).chain(finding.rivals()).collect();
    assert!(all.len() > 1, "{:?}", finding.matches.len());
    let right = |m: &&&PartMatch| off(&part, &m.pose, &truth).iter().all(|x| *x < 0.02);
    assert_eq!(all.iter().filter(right).count(), 1);
}

/// Seen along an axis a cube is a square, as many things are, so the evidence is insufficient.
#[test]
fn a_face_alone_is_not_taken_for_a_block() {
    let evaluation = part(&json!({"prim": "block", "size": [2.0, 2.0, 2.0]}));
    let subject = PreparedPart::new(&evaluation.brep, evaluation.resolution).unwrap();
    let part = sought(&evaluation, &DetectabilityPrior::nothing());
    let grey = picture(&subject, &pose(&subject, [0.0, -4.0, 0.0], [0.0; 3]), 2);
    let finding = look(&part, &grey, &SearchOptions::default());
    assert!(finding.best().is_none());
    assert!(finding.little.is_some_and(|few| few.found() <= 4));
}

/// A plate with a raised middle, nearly from the front: two nested rectangles. They also fit a deep
/// block that is rotated so that its side is as wide as the rim.
#[test]
fn a_frame_is_not_taken_for_a_block() {
    let frame = part(&json!({"op": "union", "children": [
        {"prim": "block", "size": [2.0, 1.5, 0.05]},
        {"prim": "block", "size": [1.9, 1.4, 0.1],
            "transform": [{"translate": [0.05, 0.05, 0.0]}]},
    ]}));
    let subject = PreparedPart::new(&frame.brep, frame.resolution).unwrap();
    let block = part(&json!({"prim": "block", "size": [2.0, 1.5, 1.0]}));
    let block = sought(&block, &DetectabilityPrior::nothing());
    for (i, eye) in [[0.2, -0.4, 4.0], [-0.6, -0.3, 4.0], [0.9, -0.9, 4.0]]
        .into_iter()
        .enumerate()
    {
        let grey = picture(&subject, &pose(&subject, eye, [0.0; 3]), i as u64);
        let finding = look(&block, &grey, &SearchOptions::default());
        let best = finding.best();
        assert!(
            best.is_none_or(|m| !m.is_accepted()),
            "{:?}",
            best.map(|m| m.shape)
        );
    }
}

/// A drawn chessboard, and tiles next to each other: squares could be the sides of cubes.
#[test]
fn what_is_drawn_is_not_taken_for_a_cube() {
    let board = |x: usize, y: usize| ((x / 120 + (y + 9) / 83) % 2) as f32 * 255.0;
    let panels = |x: usize, y: usize| match x % 140 < 4 || y % 140 < 4 {
        true => 255.0,
        false => 40.0 + ((x / 140 + 2 * (y / 140)) % 5) as f32 * 35.0,
    };
    let drawn: [&dyn Fn(usize, usize) -> f32; 2] = [&board, &panels];
    let cube = part(&json!({"prim": "block", "size": [1.0, 1.0, 1.0]}));
    let cube = sought(&cube, &DetectabilityPrior::nothing());
    for draw in drawn {
        let grey = Grey::new(640, 480, draw);
        let look = Matcher {
            part: &cube,
            learned: &DetectabilityPrior::nothing(),
            picture: &ImageFeatures::new(&grey, &detector()),
            camera: &Pinhole {
                focal: [700.0, 700.0],
                centre: [319.5, 239.5],
                skew: 0.0,
            },
            options: &SearchOptions::default(),
            monitor: &(),
        };
        let finding = look.find().unwrap();
        let best = finding.best().unwrap();
        assert!(!best.is_accepted(), "{} {}", best.ratio, best.odds);
        assert!(best.framed > 0.9, "{}", best.framed);
    }
}

/// A cube is found in its pictures. The cube with a tube next to it is not, wherever the tube might
/// be hidden or outside the picture.
#[test]
fn a_piece_of_a_part_is_not_the_part() {
    let cube = json!({"prim": "block", "size": [1.0, 1.0, 1.0]});
    let tube = json!({"prim": "cylinder", "r": 0.48, "h": 3.0,
        "transform": [{"translate": [2.0, 0.4, 0.0]}]});
    let both = part(&json!({"op": "union", "children": [cube, tube]}));
    let cube = part(&cube);
    let subject = PreparedPart::new(&cube.brep, cube.resolution).unwrap();
    let [cube, both] = [&cube, &both].map(|e| sought(e, &DetectabilityPrior::nothing()));
    for (seed, eye) in (1..).zip(EYES) {
        for target in [[0.0; 3], [0.9, 0.2, 0.0]] {
            let truth = pose(&subject, eye, target);
            let grey = picture(&subject, &truth, seed);
            let [alone, more] = [&cube, &both].map(|p| look(p, &grey, &SearchOptions::default()));
            let [alone, more] = [alone, more].map(|f| f.best().map(|m| m.is_accepted()));
            assert_eq!(alone, Some(true), "{eye:?} {target:?}");
            assert_ne!(more, Some(true), "{eye:?} {target:?}");
        }
    }
}

/// A shaft with a collar has no straight edge: ellipses propose its poses, and limbs determine
/// them.
#[test]
fn a_round_part_is_found_but_for_its_turn() {
    let evaluation = part(&json!({"op": "union", "children": [
        {"prim": "cylinder", "r": 2.0, "h": 1.0},
        {"prim": "cylinder", "r": 1.0, "h": 4.0},
    ]}));
    let subject = PreparedPart::new(&evaluation.brep, evaluation.resolution).unwrap();
    let part = sought(&evaluation, &DetectabilityPrior::nothing());
    assert!(part.axis.is_some());
    for (seed, eye) in (1..).zip(EYES) {
        let truth = pose(&subject, eye, [0.1, 0.1, 0.0]);
        let grey = picture(&subject, &truth, seed);
        let finding = look(&part, &grey, &SearchOptions::default());
        let best = finding.best().unwrap();
        let moved = (best.pose * part.centre - truth * part.centre).norm() / part.radius;
        let tilted = (best.pose * Vector3::z()).angle(&(truth * Vector3::z()));
        assert!(moved < 0.03 && tilted < 0.03, "{eye:?}: {moved} {tilted}");
        // There are no vertices, so the evidence is weaker than for a block.
        assert!(best.ratio > 0.0, "{eye:?}: ratio {}", best.ratio);
    }
}

#[test]
fn all_strategies_give_the_same_correspondences() {
    let evaluation = part(&cube_with_cuts());
    let subject = PreparedPart::new(&evaluation.brep, evaluation.resolution).unwrap();
    let part = sought(&evaluation, &DetectabilityPrior::nothing());
    let truth = pose(&subject, EYES[0], [0.0; 3]);
    let grey = picture(&subject, &truth, 7);
    let by = |strategy| {
        let options = SearchOptions {
            strategy,
            ..SearchOptions::default()
        };
        let finding = look(&part, &grey, &options);
        let best = finding.best().unwrap();
        assert!(best.complete, "{strategy:?}");
        (best.pose, best.score)
    };
    let bounded = by(Strategy::Bounded);
    assert_eq!(by(Strategy::Stepped), bounded);
    assert_eq!(by(Strategy::Deepening), bounded);
}

#[test]
fn what_is_found_does_not_depend_on_threads() {
    let evaluation = part(&cube_with_cuts());
    let subject = PreparedPart::new(&evaluation.brep, evaluation.resolution).unwrap();
    let part = sought(&evaluation, &DetectabilityPrior::nothing());
    let truth = pose(&subject, EYES[1], [0.0; 3]);
    let grey = picture(&subject, &truth, 3);
    let with = |threads: usize| {
        let pool = ThreadPoolBuilder::new()
            .num_threads(threads)
            .build()
            .unwrap();
        let finding = pool.install(|| look(&part, &grey, &SearchOptions::default()));
        let summary = |m: &PartMatch| (m.pose, m.ratio, m.effort);
        finding.matches.iter().map(summary).collect::<Vec<_>>()
    };
    assert_eq!(with(1), with(3));
}

#[test]
fn a_part_that_is_not_there_is_not_found() {
    let other = part(&json!({"op": "union", "children": [
        {"prim": "torus", "R": 3.0, "r": 1.0},
        {"prim": "block", "size": [6.0, 1.0, 1.0]},
    ]}));
    let subject = PreparedPart::new(&other.brep, other.resolution).unwrap();
    let evaluation = part(&cube_with_cuts());
    let part = sought(&evaluation, &DetectabilityPrior::nothing());
    for (seed, eye) in (1..).zip(EYES) {
        let grey = picture(&subject, &pose(&subject, eye, [0.0; 3]), seed);
        let finding = look(&part, &grey, &SearchOptions::default());
        let accepted = finding.best().filter(|m| m.is_accepted());
        assert!(
            accepted.is_none(),
            "{eye:?}: {:?}",
            accepted.map(|m| m.ratio)
        );
    }
}

#[test]
fn an_empty_picture_holds_nothing() {
    let evaluation = part(&cube_with_cuts());
    let part = sought(&evaluation, &DetectabilityPrior::nothing());
    for (width, height) in [(SIZE[0], SIZE[1]), (1, 1), (0, 0), (3, 200)] {
        let grey = Grey::new(width, height, |_, _| 90.0);
        let finding = look(&part, &grey, &SearchOptions::default());
        assert!(finding.best().is_none());
        assert_eq!(finding.proposed, 0);
    }
}

/// Records the steps of a search, and stops it after some of them.
#[derive(Debug)]
struct Stopper {
    steps: Mutex<Vec<u64>>,
    last: u64,
}

impl SearchMonitor for Stopper {
    fn advance(&self, done: u64) {
        self.steps.lock().unwrap().push(done);
    }

    fn is_stopped(&self) -> bool {
        self.steps.lock().unwrap().last() == Some(&self.last)
    }
}

#[test]
fn a_monitor_receives_every_step_and_stops_the_search() {
    let evaluation = part(&cube_with_cuts());
    let subject = PreparedPart::new(&evaluation.brep, evaluation.resolution).unwrap();
    let part = sought(&evaluation, &DetectabilityPrior::nothing());
    let truth = pose(&subject, [3.1, 2.4, 2.6], [0.0; 3]);
    let seen = ImageFeatures::new(&picture(&subject, &truth, 1), &detector());
    for last in 1..=SEARCH_STEPS + 1 {
        let monitor = Stopper {
            steps: Mutex::default(),
            last,
        };
        let result = looked(&part, &seen, &SearchOptions::default(), |look| {
            let monitor = &monitor;
            Matcher { monitor, ..*look }.find()
        });
        assert_eq!(result.is_ok(), last > SEARCH_STEPS);
        let steps = monitor.steps.into_inner().unwrap();
        assert_eq!(steps, Vec::from_iter(1..=last.min(SEARCH_STEPS)));
    }
}

/// Thousands of segments: the work is bounded, and the omitted part is reported.
#[test]
fn clutter_bounds_the_work() {
    let evaluation = part(&cube_with_cuts());
    let part = sought(&evaluation, &DetectabilityPrior::nothing());
    // Tiles of two levels, shifted from row to row.
    let grey = Grey::new(SIZE[0], SIZE[1], |x, y| {
        let row = y / 14;
        let tile = (x + 5 * row) / 17;
        if (tile + row) % 2 == 0 { 60.0 } else { 170.0 }
    });
    let options = SearchOptions {
        limits: SearchLimits {
            chains: 20,
            settled: 4,
            searched: 2,
            paths: 500,
        },
        ..SearchOptions::default()
    };
    let finding = look(&part, &grey, &options);
    assert!(finding.cut);
    assert!(finding.chains.iter().all(|c| *c <= 20));
    for found in &finding.matches {
        assert!(found.effort.opened <= 501);
    }
}

#[test]
fn a_part_is_followed_from_picture_to_picture() {
    let evaluation = part(&cube_with_cuts());
    let subject = PreparedPart::new(&evaluation.brep, evaluation.resolution).unwrap();
    let part = sought(&evaluation, &DetectabilityPrior::nothing());
    let mut last = pose(&subject, [3.1, 2.4, 2.6], [0.0; 3]);
    for k in 1..5u32 {
        let turn = 0.04 * f64::from(k);
        let eye = [3.1 - turn, 2.4 + turn, 2.6 - 0.5 * turn];
        let truth = pose(&subject, eye, [0.0; 3]);
        let grey = picture(&subject, &truth, u64::from(k));
        let seen = ImageFeatures::new(&grey, &detector());
        let next = looked(&part, &seen, &SearchOptions::default(), |look| {
            look.follow(&last)
        });
        let next = next.unwrap_or_else(|| panic!("lost in picture {k}"));
        let [moved, turned] = off(&part, &next.pose, &truth);
        assert!(moved < 0.02 && turned < 0.02, "{k}: {moved} {turned}");
        last = next.pose;
    }
}
