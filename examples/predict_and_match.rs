//! Predicts the features of a part in a picture, renders the picture, and finds the part in it.
//!
//! `cargo run -p premio --example predict_and_match -- FOLDER`
#![allow(clippy::print_stdout, reason = "an example prints what it finds")]

use premio::prelude::*;
use std::path::PathBuf;

/// The camera, the light and the sensor.
const SETUP: &str = r#"
material = "plastic"
[camera]
eye = [130, -160, 120]
[[light]]
position = [40, -160, 300]
[sensor]
focal = 16
film = [8.8, 6.6]
resolution = [480, 360]
"#;

/// The cameras and lights of a model.
const SETUPS: &str = r#"
material = "plastic"
[viewing]
count = 12
radius = 230
[[light]]
position = [40, -160, 300]
[sensor]
resolution = [240, 180]
"#;

fn main() -> premio::Result<()> {
    let folder = PathBuf::from(std::env::args().nth(1).unwrap_or_else(|| ".".to_owned()));

    // A stepped block, which no turn brings onto itself.
    let step = block(60, 40, 15) + block(25, 40, 40) + block(60, 12, 28);
    let part = step - block(12, 14, 60).translate([36, 20, -1]);
    let solid = part.evaluate()?;

    let setup = Setup::from_toml(SETUP)?;
    let prediction = solid.predict(&setup)?;
    println!("{} arcs are predicted", prediction.arcs.len());

    let rows = |step: premio::ProgressStep| {
        if step.done == step.total {
            println!("{} rows are rendered", step.total);
        }
    };
    let picture = solid.render(&setup, &Progress::new().with_callback(rows))?;
    premio::write_picture(&picture, folder.join("step.png"))?;

    let setups = Setups::from_toml(SETUPS)?;
    let model = Model::train(&solid, &setups, &Progress::new())?;
    println!("the model has {} features", model.head().features);
    model.write(folder.join("step.model"))?;

    let k = prediction.image.k;
    let camera = CameraFile::from_json(&format!(r#"{{"K": {k:?}}}"#))?;
    let found = PartFinder::with_model(&solid, &model)?.find(&picture, &camera)?;
    println!(
        "found: {}, with probability {:.3}",
        found.is_found(),
        found.probability()
    );
    if let Some(pose) = found.pose() {
        println!("at {:?}, rendered at {:?}", pose.t, prediction.image.t);
        let off: f64 = (0..3)
            .map(|i| (pose.t[i] - prediction.image.t[i]).abs())
            .sum();
        assert!(found.is_found() && off < 2.0, "the pose is {off} away");
    }
    Ok(())
}
