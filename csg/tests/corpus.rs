//! The corpus's booleans: volumes against closed forms or rays.

use premio_csg::boundary::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, Options, read};
use premio_kernel::brep::mass::mass;

#[test]
fn cases() {
    let Ok(folder) = std::env::var("PREMIO_CORPUS") else {
        eprintln!("PREMIO_CORPUS is not set: the corpus is not tested");
        return;
    };
    let text = std::fs::read_to_string(format!("{folder}/cases.json")).unwrap();
    let cases: Vec<serde_json::Value> = serde_json::from_str(&text).unwrap();
    let mut bad = 0;
    for case in &cases {
        let id = case["id"].as_str().unwrap();
        if let Ok(only) = std::env::var("ONLY") {
            if !id.contains(&only) {
                continue;
            }
        }
        let tree = serde_json::to_string(&case["tree"]).unwrap();
        let d = match read(id, tree.as_bytes(), Format::Json, &Options::default()) {
            Ok(d) => d,
            Err(e) => {
                println!("{id}: {e}");
                bad += 1;
                continue;
            }
        };
        let t0 = std::time::Instant::now();
        let run = std::panic::catch_unwind(|| evaluate(&d.tree, &EvaluationOptions::default()));
        let e = match run {
            Ok(Ok(e)) => e,
            Ok(Err(e)) => {
                println!("FAIL {id}: {e} | {}", case["why_hard"]);
                bad += 1;
                continue;
            }
            Err(_) => {
                println!("PANIC {id}");
                bad += 1;
                continue;
            }
        };
        let ms = t0.elapsed().as_secs_f64() * 1e3;
        let m = mass(&e.brep);
        let (want, tol) = match case["volume"].as_f64() {
            Some(v) => (v, 1e-9 * v.abs().max(1e-3)),
            None => (
                case["volume_by_rays"].as_f64().unwrap(),
                5.0 * case["rays_std_error"].as_f64().unwrap(),
            ),
        };
        let t = &e.brep.topology;
        let ok = (m.volume - want).abs() <= tol;
        if !ok {
            bad += 1;
        }
        println!(
            "{} {id}: {} want {want} | F{} E{} V{} S{} close {} | {ms:.1} ms",
            if ok { "ok  " } else { "WRONG" },
            m.volume,
            t.faces.len(),
            t.edges.len(),
            t.vertices,
            t.solids.len(),
            e.decisions.close_calls.len()
        );
    }
    assert_eq!(bad, 0);
}
