//! Options of the commands about images.

use super::{DescriptionOptions, OutputOptions};
use clap::{ArgMatches, Args, FromArgMatches, Subcommand, ValueEnum};
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
    /// Draw the detections of the features: OUT.svg, or OUT.png
    #[arg(long, value_name = "OUT")]
    pub overlay: Option<PathBuf>,
    /// Where to write the comparison [default: standard output]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
}

/// Options of `schema`.
#[derive(Debug, Args)]
pub struct SchemaOptions {
    /// The output format
    #[arg(value_enum, value_name = "FORMAT")]
    pub of: SchemaName,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// The published schemas.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum SchemaName {
    /// premio.prediction/1
    Prediction,
    /// premio.match/1
    Match,
}

/// Options of `model`.
#[derive(Debug, Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct ModelOptions {
    /// Instead of predicting: merge shards
    #[command(subcommand)]
    pub command: Option<ModelCommand>,
    #[command(flatten)]
    pub run: ModelRun,
}

/// The options of a run, if one is requested: clap reports options as absent only as a whole, which
/// fails where they contain others.
#[derive(Debug)]
pub struct ModelRun(pub Option<ModelRunOptions>);

impl FromArgMatches for ModelRun {
    fn from_arg_matches(matches: &ArgMatches) -> Result<Self, clap::Error> {
        let requested = matches.contains_id("setups");
        let options = requested.then(|| ModelRunOptions::from_arg_matches(matches));
        options.transpose().map(Self)
    }

    fn update_from_arg_matches(&mut self, matches: &ArgMatches) -> Result<(), clap::Error> {
        *self = Self::from_arg_matches(matches)?;
        Ok(())
    }
}

impl Args for ModelRun {
    fn augment_args(command: clap::Command) -> clap::Command {
        ModelRunOptions::augment_args(command)
    }

    fn augment_args_for_update(command: clap::Command) -> clap::Command {
        ModelRunOptions::augment_args_for_update(command)
    }
}

/// The other commands for models.
#[derive(Debug, Subcommand)]
pub enum ModelCommand {
    /// The model of all shards of one run
    #[command(after_help = "Example: premio model merge part.*.shard -o part.model")]
    Merge(MergeOptions),
}

/// Options of `model merge`.
#[derive(Debug, Args)]
pub struct MergeOptions {
    /// The shards: all of one run, in any order
    #[arg(value_name = "SHARD", required = true)]
    pub shards: Vec<PathBuf>,
    #[command(flatten)]
    pub output: ModelOutput,
}

/// The output of a model.
#[derive(Debug, Args)]
pub struct ModelOutput {
    /// Where to write the model, or the shard [default: standard output]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// The format of the model [default: by the ending of OUT, jsonl unless it is .parquet]
    #[arg(long, value_enum)]
    pub format: Option<RecordsFormat>,
}

/// The formats of models of many setups.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum RecordsFormat {
    /// premio.model/1: one JSON record per line
    Jsonl,
    /// The records as a table, where the program is built with it
    Parquet,
}

/// Options of `model` for predicting.
#[derive(Debug, Args)]
pub struct ModelRunOptions {
    #[command(flatten)]
    pub description: DescriptionOptions,
    /// The setups: the spheres of cameras and lights, sensor, materials, detector (TOML)
    #[arg(long, value_name = "SETUPS")]
    pub setups: PathBuf,
    #[command(flatten)]
    pub output: ModelOutput,
    /// Predict one of N shards only, I from 1: for `model merge`
    #[arg(long, value_name = "I/N", value_parser = shard)]
    pub shard: Option<ShardChoice>,
    /// Continue a run that was interrupted
    #[arg(long, conflicts_with = "shard", requires = "output")]
    pub resume: bool,
}

/// One of several shards.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShardChoice {
    /// The index, from 1.
    pub index: usize,
    /// The number of shards.
    pub of: usize,
}

fn shard(text: &str) -> Result<ShardChoice, String> {
    let wrong = || "expected a shard and their number, as 2/5".to_owned();
    let (index, of) = text.split_once('/').ok_or_else(wrong)?;
    let (index, of) = (
        index.parse().map_err(|_| wrong())?,
        of.parse().map_err(|_| wrong())?,
    );
    match (1..=of).contains(&index) {
        true => Ok(ShardChoice { index, of }),
        false => Err(wrong()),
    }
}

/// Options of `advise`.
#[derive(Debug, Args)]
pub struct AdviseOptions {
    #[command(flatten)]
    pub description: DescriptionOptions,
    /// The setups to try: the spheres of cameras and lights, sensor, materials, detector (TOML)
    #[arg(long, value_name = "SETUPS")]
    pub setups: PathBuf,
    /// What is sought
    #[arg(long, value_enum, default_value = "features")]
    pub goal: GoalName,
    /// The number of setups that are listed below the best
    #[arg(long, value_name = "N", default_value = "10")]
    pub top: u16,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// What is sought.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum GoalName {
    /// The greatest expected number of found features
    Features,
    /// The least standard deviation of the pose
    Pose,
}
