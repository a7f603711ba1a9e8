//! Options of the commands that find parts in pictures.

use super::DefineOptions;
use clap::{Args, ValueEnum};
use std::path::PathBuf;

/// The part and the options of the search.
#[derive(Debug, Args)]
pub struct SoughtOptions {
    /// The part: a model of `premio model`, or a description (without predictions)
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,
    /// The pictures: .png, .pgm or .jpg
    #[arg(value_name = "IMAGE", required = true)]
    pub images: Vec<PathBuf>,
    /// The camera: OpenCV's matrix, {"K": [[fx,0,cx],[0,fy,cy],[0,0,1]], "width": w, "height": h}
    #[arg(long, value_name = "CAMERA")]
    pub camera: PathBuf,
    /// The detector, as in a setup's [detector] (TOML) [default: the model's]
    #[arg(long, value_name = "FILE")]
    pub detector: Option<PathBuf>,
    #[command(flatten)]
    pub define: DefineOptions,
    /// How correspondences are searched
    #[arg(long, value_enum, default_value_t)]
    pub strategy: StrategyName,
    /// Ignore the predictions: one detectability for all features, no relations
    #[arg(long)]
    pub uniform: bool,
    /// Draw the found part on the picture, for one picture: OUT.png
    #[arg(long, value_name = "OUT")]
    pub overlay: Option<PathBuf>,
    /// Write the poses as CSV for the tools of the BOP challenge
    #[arg(long, value_name = "OUT")]
    pub csv: Option<PathBuf>,
    /// The scene and the object of the CSV; pictures are numbered by their names, or in order
    #[arg(long, value_name = "SCENE,OBJECT", value_parser = pair, default_value = "1,1")]
    pub ids: [u32; 2],
    /// Where to write the result [default: standard output]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
}

/// Options of `match`.
#[derive(Debug, Args)]
pub struct MatchOptions {
    #[command(flatten)]
    pub sought: SoughtOptions,
    /// Explain in words why the winning correspondences won, and list what the score is made of
    #[arg(long)]
    pub explain: bool,
}

/// Options of `track`.
#[derive(Debug, Args)]
pub struct TrackOptions {
    #[command(flatten)]
    pub sought: SoughtOptions,
}

/// How correspondences are searched.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum StrategyName {
    /// Depth-first branch and bound
    #[default]
    Bounded,
    /// IDA*: rounds with a threshold that falls to the greatest pruned bound
    Deepening,
    /// Rounds with a threshold that falls in steps
    Stepped,
}

fn pair(text: &str) -> Result<[u32; 2], String> {
    let wrong = || "expected SCENE,OBJECT, as in 1,5".to_owned();
    let (a, b) = text.split_once(',').ok_or_else(wrong)?;
    let number = |s: &str| s.trim().parse().map_err(|_| wrong());
    Ok([number(a)?, number(b)?])
}
