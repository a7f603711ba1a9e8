//! Predicted images compared with ray casting: the contents of regions, grey levels, and
//! detections.

use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_detect::PixelMask;
use premio_predict::image_arcs::ArcSource;
use premio_predict::image_arcs::lit_scene::StageError;
use premio_predict::prediction::{self, Memory, PredictedImage, prediction};
use premio_predict::prediction_score::{PredictionScore, matches};
use premio_predict::prepared_part::PreparedPart;
use premio_predict::render;
use premio_predict::setup::Setup;
use premio_tests::parts::{cube_with_cuts, plate, tee};
use premio_tests::random;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::fs;
use std::path::{Path, PathBuf};

fn part(json: &Value) -> Evaluation {
    let text = json.to_string();
    let tree = read(
        "part",
        text.as_bytes(),
        Format::Json,
        &ReadOptions::default(),
    )
    .unwrap();
    evaluate(&tree.tree, &EvaluationOptions::default()).unwrap()
}

/// A small picture of a part from one direction, lit from another; both are in units of the part's
/// size, relative to its centre.
fn setup(subject: &PreparedPart<'_>, eye: [f64; 3], light: [f64; 3], more: &str) -> Setup {
    let at = |d: [f64; 3]| {
        let [x, y, z] = [0, 1, 2].map(|i| subject.centre[i] + subject.radius * d[i]);
        format!("[{x}, {y}, {z}]")
    };
    let text = format!(
        "[camera]\neye = {}\n[[light]]\nposition = {}\n[sensor]\nresolution = [160, 120]\n{more}",
        at(eye),
        at(light)
    );
    Setup::from_toml(&text).unwrap()
}

fn with_draft<T>(
    subject: &PreparedPart<'_>,
    setup: &Setup,
    ask: impl FnOnce(&PredictedImage<'_>) -> T,
) -> Result<T, StageError> {
    prediction::with_draft(subject, None, setup, &mut Memory::default(), ask)
}

/// A ring, a ball and a slanted pin: limbs with cusps, and round shadows on round faces.
fn ring() -> Value {
    json!({"op": "union", "children": [
        {"prim": "torus", "R": 3.0, "r": 1.0},
        {"prim": "sphere", "r": 1.5},
        {"prim": "cylinder", "r": 0.7, "h": 4.0, "transform": [{"rotate": [[0, 1, 0], 70]}]},
    ]})
}

fn cone_on_a_table() -> Value {
    json!({"op": "union", "children": [
        {"prim": "block", "size": [8.0, 8.0, 1.0], "transform": [{"translate": [-4, -4, -1]}]},
        {"prim": "cone", "r": 2.0, "h": 3.0},
    ]})
}

const PLACES: [([f64; 3], [f64; 3]); 3] = [
    ([2.6, 2.0, 2.3], [1.1, 2.9, 4.0]),
    ([-2.9, 1.1, 1.9], [2.2, -1.4, 3.6]),
    ([0.7, -3.3, 1.2], [-2.9, -2.0, 2.6]),
];

/// A region's content must be what a ray through any of its points hits, and its lights those that
/// rays find, except close to arcs.
fn regions_show_what_rays_meet(
    draft: &PredictedImage<'_>,
    context: &str,
    wrong: &mut Vec<String>,
) -> usize {
    let [width, height] = draft.conditions.sensor.resolution;
    let near = draft.ink.bitmap().grown(1);
    let mut tested = 0;
    for k in 0..600usize {
        // Points without a regular pattern.
        let x = (k as f64 * 0.754_877_666).fract() * (width as f64 - 1.0);
        let y = (k as f64 * 0.569_840_291).fract() * (height as f64 - 1.0);
        if near.contains(x.round() as usize, y.round() as usize) {
            continue;
        }
        let Some(shown) = draft.regions.all[draft.regions.at([x, y]) as usize].seen else {
            continue;
        };
        let hit = draft.shading.cast([x, y]);
        // A light that illuminates a region may be behind the face at this point.
        let same = shown.face == hit.face && hit.lit & !shown.lit == 0;
        if !same {
            wrong.push(format!("{context}: at ({x}, {y}) {shown:?}, hit {hit:?}"));
        }
        tested += 1;
    }
    tested
}

#[test]
fn regions_of_parts_show_what_rays_meet() {
    let parts = [
        ("cube", cube_with_cuts()),
        ("plate", plate(3, 1.0)),
        ("tee", tee(1)),
        ("ring", ring()),
        ("cone", cone_on_a_table()),
    ];
    let mut wrong = Vec::new();
    for (name, json) in parts {
        let part = part(&json);
        let subject = PreparedPart::new(&part.brep, part.resolution).unwrap();
        for (k, (eye, light)) in PLACES.into_iter().enumerate() {
            let setup = setup(&subject, eye, light, "");
            let tested = with_draft(&subject, &setup, |draft| {
                regions_show_what_rays_meet(draft, &format!("{name} {k}"), &mut wrong)
            });
            assert!(tested.unwrap() > 100, "{name} {k}");
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn regions_of_named_cases_show_what_rays_meet() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let mut names: Vec<_> = fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().path())
        .collect();
    names.sort();
    let part = |case: &PathBuf| {
        let text = fs::read(case.join("model.padl")).ok()?;
        let tree = read("part", &text, Format::Padl, &ReadOptions::default()).ok()?;
        let part = evaluate(&tree.tree, &EvaluationOptions::default()).ok()?;
        let resolution = part.view_resolution()?;
        PreparedPart::new(&part.brep, resolution).ok()?;
        Some((case.display().to_string(), part, resolution))
    };
    let parts: Vec<_> = names.par_iter().filter_map(part).collect();
    let wrong = |(i, (context, part, resolution)): (usize, &(String, Evaluation, f64))| {
        let subject = PreparedPart::new(&part.brep, *resolution).unwrap();
        let (eye, light) = PLACES[i % PLACES.len()];
        let setup = setup(&subject, eye, light, "");
        let mut wrong = Vec::new();
        let tested = with_draft(&subject, &setup, |draft| {
            regions_show_what_rays_meet(draft, context, &mut wrong);
            prediction(draft, &setup);
        });
        match tested {
            Ok(()) | Err(StageError::OutOfSight(_) | StageError::View(_)) => wrong,
            Err(error) => panic!("{context}: {error}"),
        }
    };
    assert!(parts.len() > 100, "{} cases", parts.len());
    let wrong: Vec<String> = parts.par_iter().enumerate().flat_map_iter(wrong).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Views along axes, with lights along axes, at the camera and elsewhere, of random trees on a
/// grid.
#[test]
fn regions_of_random_trees_show_what_rays_meet() {
    let places = [
        ([4.0, 0.0, 0.0], [0.0, 0.0, 4.0]),
        ([0.0, 0.0, 4.0], [0.0, 0.0, 4.0]),
        ([2.6, 2.0, 2.3], [2.6, 2.0, 2.3]),
        ([-1.9, 2.4, 1.7], [1.1, 2.9, 4.0]),
    ];
    let mut wrong = Vec::new();
    let (mut views, mut undetermined, mut all) = (0, 0.0, 0.0);
    for seed in 0..24u64 {
        let text = random::tree(seed).to_string();
        let tree = read(
            "part",
            text.as_bytes(),
            Format::Json,
            &ReadOptions::default(),
        )
        .unwrap();
        let Ok(part) = evaluate(&tree.tree, &EvaluationOptions::default()) else {
            continue;
        };
        let Ok(subject) = PreparedPart::new(&part.brep, part.resolution) else {
            continue;
        };
        let (eye, light) = places[seed as usize % places.len()];
        let setup = setup(&subject, eye, light, "");
        let seen = with_draft(&subject, &setup, |draft| {
            regions_show_what_rays_meet(draft, &format!("seed {seed}"), &mut wrong);
            let area = |determined: bool| {
                let those = draft
                    .regions
                    .all
                    .iter()
                    .filter(|r| r.seen.is_some() || !determined);
                those.map(|r| r.area).sum::<f64>()
            };
            (area(false) - area(true), area(false))
        });
        if let Ok((none, area)) = seen {
            (views, undetermined, all) = (views + 1, undetermined + none, all + area);
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(views > 15, "{views}");
    // Undetermined pixels are decided by rays, which is correct but slow.
    assert!(undetermined < 0.05 * all, "{undetermined} of {all} pixels");
}

/// Where a ball's limb approaches the rim of a flat cut, a sliver lies between them, thinner than
/// the polylines' accuracy. It separates the background from the cut.
#[test]
fn a_sliver_between_a_limb_and_an_edge_parts_what_is_beside_it() {
    let ball = json!({"op": "difference", "children": [
        {"prim": "sphere", "r": 2.5},
        {"prim": "block", "size": [6.0, 6.0, 6.0], "transform": [{"translate": [-3, -3, 1.0]}]},
    ]});
    let part = part(&ball);
    let subject = PreparedPart::new(&part.brep, part.resolution).unwrap();
    for k in 0..24 {
        // The limb touches the rim if the eye is close to the plane of the tangent cone.
        let tilt = 0.2 + 0.04 * f64::from(k);
        let eye = [3.0 * tilt.cos(), 0.7, 3.0 * tilt.sin()];
        let setup = setup(&subject, eye, [1.1, 2.9, 4.0], "");
        with_draft(&subject, &setup, |draft| {
            let (last, regions) = draft.regions.all.split_last().unwrap();
            let undetermined = regions.iter().filter(|r| r.area > 1.0 && r.seen.is_none());
            let undetermined: Vec<_> = undetermined.map(|r| r.area).collect();
            assert!(undetermined.is_empty(), "tilt {tilt}: {undetermined:?} px");
            // A few rows of 160 pixels, where limb and rim approach each other at both ends.
            assert!(last.area < 6.0 * 160.0, "tilt {tilt}: {} px", last.area);
        })
        .unwrap();
    }
}

#[test]
fn predicted_pixels_are_those_of_rays() {
    for (name, json) in [
        ("cube", cube_with_cuts()),
        ("ring", ring()),
        ("cone", cone_on_a_table()),
    ] {
        let part = part(&json);
        let subject = PreparedPart::new(&part.brep, part.resolution).unwrap();
        let (eye, light) = PLACES[0];
        let setup = setup(
            &subject,
            eye,
            light,
            "blur = 0.0\n[detector]\nthreshold = 8\n",
        );
        with_draft(&subject, &setup, |draft| {
            let [width, height] = draft.conditions.sensor.resolution;
            let levels = render::rows(&draft.shading, width, 0..height);
            let (mut sum, mut most, mut count) = (0.0f64, 0.0f64, 0usize);
            for y in 0..height {
                for run in draft.domain.spans(y) {
                    for x in run.start as usize..run.end as usize {
                        let at = y * width + x;
                        let off = f64::from(draft.image.levels[at] - levels[at]).abs();
                        (sum, most, count) = (sum + off, most.max(off), count + 1);
                    }
                }
            }
            let mean = sum / count as f64;
            // A pixel of 64 samples gives the shares of its regions to some percent of their
            // contrast.
            assert!(mean < 0.25, "{name}: {mean} levels off, at most {most}");
            assert!(most < 12.0, "{name}: {mean} levels off, at most {most}");
        })
        .unwrap();
    }
}

#[test]
fn features_are_found_as_predicted() {
    let more =
        "electrons = 10000\nread_noise = 1.0\n[detector]\nthreshold = 8\n[features]\ndraws = 8\n";
    let mut all = Vec::new();
    for json in [cube_with_cuts(), ring(), cone_on_a_table(), plate(2, 1.0)] {
        let part = part(&json);
        let subject = PreparedPart::new(&part.brep, part.resolution).unwrap();
        for (eye, light) in PLACES {
            let setup = setup(&subject, eye, light, more);
            with_draft(&subject, &setup, |draft| {
                let [width, height] = draft.conditions.sensor.resolution;
                let sensor = &draft.conditions.sensor;
                let levels = render::rows(&draft.shading, width, 0..height);
                let image = render::finished(levels, sensor, 77);
                let domain = PixelMask::full(width, height);
                let found = draft.evidence_in(&image, &domain).arcs;
                let predicted = prediction(draft, &setup);
                all.extend(matches(
                    &predicted.arcs,
                    &found,
                    draft.conditions.detector.shortest,
                ));
            })
            .unwrap();
        }
    }
    let agreement = PredictionScore::new(all.iter());
    assert!(agreement.features > 100, "{}", agreement.features);
    assert!(agreement.baseline_same < 0.9, "too easy: {agreement:?}");
    assert!(agreement.same >= 0.95, "{agreement:?}");
    assert!(
        agreement.brier <= 0.5 * agreement.baseline_brier,
        "{agreement:?}"
    );
}

/// A post on a table, lit along (1, 0, -1): its shadow is as long as the post is high.
#[test]
fn a_shadow_lies_where_it_is_cast() {
    let json = json!({"op": "union", "children": [
        {"prim": "block", "size": [10.0, 6.0, 1.0], "transform": [{"translate": [-2, -3, -1]}]},
        {"prim": "block", "size": [1.0, 1.0, 2.0], "transform": [{"translate": [-1, 0, 0]}]},
    ]});
    let part = part(&json);
    let subject = PreparedPart::new(&part.brep, part.resolution).unwrap();
    let text = "[camera]\neye = [6, -14, 16]\n[[light]]\ndirection = [-1, 0, 1]\n";
    let setup = Setup::from_toml(text).unwrap();
    with_draft(&subject, &setup, |draft| {
        let shadows = draft
            .arcs
            .iter()
            .filter(|a| matches!(a.source, ArcSource::EdgeShadow { .. }));
        let project = |x: f64, y: f64| {
            let p = draft
                .stage
                .view
                .scene
                .projection
                .project(&[x, y, 0.0].into());
            [p.x, p.y]
        };
        // The far edge of the shadow, from the post's upper edge at x = 0: at x = 2, y from 0 to 1.
        let [a, b] = [project(2.0, 0.0), project(2.0, 1.0)];
        let ends = |p: [f64; 2], q: [f64; 2]| {
            let off = |u: [f64; 2], v: [f64; 2]| (u[0] - v[0]).hypot(u[1] - v[1]);
            off(p, a).max(off(q, b)).min(off(p, b).max(off(q, a)))
        };
        let nearest = shadows
            .map(|arc| {
                ends(
                    arc.line.points[0],
                    arc.line.points[arc.line.points.len() - 1],
                )
            })
            .fold(f64::INFINITY, f64::min);
        // Ends are extended by 1/32 pixel.
        assert!(nearest < 0.05, "{nearest} px off");
        let dark = draft.regions.all.iter().filter(|r| {
            r.seen.is_some_and(|s| {
                s.face.is_some_and(|f| {
                    let n = subject.brep.outward(f, &s.point);
                    n.z > 0.5 && s.point.z.abs() < 1e-6 && s.lit == 0
                })
            })
        });
        // Two by one in the plane z = 0, minus what the post hides of it, which is nothing from
        // there.
        let area: f64 = dark.map(|r| r.area).sum();
        let corners = [
            project(0.0, 0.0),
            project(2.0, 0.0),
            project(2.0, 1.0),
            project(0.0, 1.0),
        ];
        let twice: f64 = (0..4)
            .map(|i| {
                let ([x, y], [u, v]) = (corners[i], corners[(i + 1) % 4]);
                x * v - u * y
            })
            .sum();
        let expected = 0.5 * twice.abs();
        assert!(
            (area - expected).abs() < 0.01 * expected,
            "{area} px, expected {expected}"
        );
    })
    .unwrap();
}

/// On a ball a light is reflected half-way between the directions to it and to the camera.
#[test]
fn a_light_beside_the_camera_casts_no_shadow_that_is_seen() {
    let part = part(&ring());
    let subject = PreparedPart::new(&part.brep, part.resolution).unwrap();
    let place = PLACES[0].0;
    let is_of_light = |source: &ArcSource| {
        matches!(
            source,
            ArcSource::EdgeShadow { .. }
                | ArcSource::LimbShadow { .. }
                | ArcSource::Terminator { .. }
        )
    };
    let shadows = |light: [f64; 3]| {
        let setup = setup(&subject, place, light, "");
        let ask = |draft: &PredictedImage<'_>| {
            let mut wrong = Vec::new();
            regions_show_what_rays_meet(draft, "a light by the camera", &mut wrong);
            assert!(wrong.is_empty(), "{wrong:#?}");
            draft.arcs.iter().filter(|a| is_of_light(&a.source)).count()
        };
        with_draft(&subject, &setup, ask).unwrap()
    };
    assert_eq!(shadows(place), 0);
    assert_ne!(shadows(place.map(|x| 1.1 * x + 0.3)), 0);
}

#[test]
fn a_highlight_lies_where_the_light_is_mirrored() {
    let part = part(&json!({"prim": "sphere", "r": 1.0}));
    let subject = PreparedPart::new(&part.brep, part.resolution).unwrap();
    let text = "material = \"plastic\"\n[camera]\neye = [50, 0, 0]\n[sensor]\nfocal = 150\n[[light]]\ndirection = [1, 1, 0]\n";
    let setup = Setup::from_toml(text).unwrap();
    with_draft(&subject, &setup, |draft| {
        let glow = draft
            .arcs
            .iter()
            .find(|a| matches!(a.source, ArcSource::Highlight { .. }))
            .unwrap();
        let count = glow.line.points.len() as f64;
        let sum = glow
            .line
            .points
            .iter()
            .fold([0.0; 2], |s, p| [s[0] + p[0], s[1] + p[1]]);
        let (sin, cos) = (std::f64::consts::PI / 8.0).sin_cos();
        let at = draft
            .stage
            .view
            .scene
            .projection
            .project(&[cos, sin, 0.0].into());
        let off = (sum[0] / count - at.x).hypot(sum[1] / count - at.y);
        // The outline is not a circle; its centre is the brightest point to a fraction of its
        // width.
        let width = (glow.line.points[0][0] - at.x).hypot(glow.line.points[0][1] - at.y);
        assert!(off < 0.2 * width, "{off} px off, {width} px wide");
    })
    .unwrap();
}

#[test]
fn impossible_setups_are_refused() {
    let part = part(&cube_with_cuts());
    let subject = PreparedPart::new(&part.brep, part.resolution).unwrap();
    let message = |text: &str| {
        let setup = Setup::from_toml(text).unwrap();
        with_draft(&subject, &setup, |_| ())
            .unwrap_err()
            .to_string()
    };
    let camera = "[camera]\neye = [9, 7, 8]\n";
    let inside = message(&format!("{camera}[[light]]\nposition = [2, 2, 1.5]\n"));
    assert!(
        inside.contains("light[0]") && inside.contains("inside"),
        "{inside}"
    );
    let eye = message("[camera]\neye = [2, 2, 1.5]\n[[light]]\nposition = [9, 9, 9]\n");
    assert!(eye.contains("camera") && eye.contains("inside"), "{eye}");
    let away = message(
        "[camera]\neye = [9, 7, 8]\ntarget = [18, 14, 16]\n[[light]]\nposition = [9, 9, 9]\n",
    );
    assert!(away.contains("behind the camera"), "{away}");
    let lateral =
        message("[camera]\neye = [9, 7, 8]\ntarget = [9, 0, 8]\n[[light]]\nposition = [9, 9, 9]\n");
    assert!(lateral.contains("projects to"), "{lateral}");
    let face = message(&format!(
        "{camera}[[light]]\nposition = [9, 9, 9]\n[[surface]]\nfaces = [0, 99]\nmaterial = \"steel\"\n"
    ));
    assert!(face.contains("face 99"), "{face}");
}
