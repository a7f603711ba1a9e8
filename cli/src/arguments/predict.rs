//! Options of the commands about images.

use super::DescriptionOptions;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// Options of `predict`.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true)]
pub struct PredictOptions {
    #[command(flatten)]
    pub description: DescriptionOptions,
    /// The setup: camera, lights, sensor, materials, detector (TOML)
    #[arg(long, value_name = "SETUP")]
    pub setup: PathBuf,
    /// Draw the predicted features: OUT.svg, or OUT.png
    #[arg(long, value_name = "OUT")]
    pub overlay: Option<PathBuf>,
    /// Where to write the prediction [default: standard output]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
}

/// Options of `render`.
#[derive(Debug, Args)]
pub struct RenderOptions {
    #[command(flatten)]
    pub description: DescriptionOptions,
    /// The setup: camera, lights, sensor, materials, detector (TOML)
    #[arg(long, value_name = "SETUP")]
    pub setup: PathBuf,
    /// The image: .png or .pgm
    #[arg(short, long, value_name = "IMAGE")]
    pub output: PathBuf,
}

/// Options of `compare`.
#[derive(Debug, Args)]
pub struct CompareOptions {
    #[command(flatten)]
    pub description: DescriptionOptions,
    /// The setup that the image was taken in (TOML)
    #[arg(long, value_name = "SETUP")]
    pub setup: PathBuf,
    /// The image (.png, .pgm, .jpg); without one it is rendered
    #[arg(long, value_name = "IMAGE")]
    pub image: Option<PathBuf>,
    /// Draw what is found of the features: OUT.svg, or OUT.png
    #[arg(long, value_name = "OUT")]
    pub overlay: Option<PathBuf>,
    /// Where to write the comparison [default: standard output]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
}

/// The published schemas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SchemaName {
    /// premio.prediction/1
    Prediction,
}
