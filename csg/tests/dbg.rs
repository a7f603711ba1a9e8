//! dbg
use premio_csg::boundary::{EvaluationOptions, evaluate};
use premio_csg::reader::{Format, Options, read};
#[test]
fn dbg() {
    let text = std::env::var("TREE").unwrap();
    let d = read("x", text.as_bytes(), Format::Json, &Options::default()).unwrap();
    match evaluate(&d.tree, &EvaluationOptions::default()) {
        Ok(e) => println!(
            "ok {:?} faces {} edges {} close {:?}",
            premio_kernel::brep::mass::mass(&e.brep),
            e.brep.topology.faces.len(),
            e.brep.topology.edges.len(),
            e.decisions.close_calls
        ),
        Err(e) => println!("ERR {e}"),
    }
}
