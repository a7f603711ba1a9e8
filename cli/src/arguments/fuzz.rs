//! The options of `fuzz`.

use super::{ModelFormat, positive, seconds};
use clap::builder::PossibleValue;
use clap::{Args, ValueEnum};
use premio_verify::generator::profile::Profile;
use std::path::PathBuf;

/// Options of `fuzz`.
#[derive(Debug, Args)]
pub struct FuzzOptions {
    /// Descriptions to compare the program of --against on, in place of random trees
    #[arg(value_name = "FILES", conflicts_with_all = ["profile", "from", "count"])]
    pub files: Vec<PathBuf>,
    /// The kinds of trees
    #[arg(
        long,
        value_name = "P",
        value_enum,
        value_delimiter = ',',
        default_value = "all"
    )]
    pub profile: Vec<ProfileChoice>,
    /// The first seed
    #[arg(long, value_name = "SEED", default_value_t = 0)]
    pub from: u64,
    /// The number of seeds of each profile
    #[arg(long, value_name = "N", default_value_t = 1000)]
    pub count: u64,
    /// Evaluate each tree again without decisions in f64, and compare
    #[arg(long)]
    pub unfiltered: bool,
    /// Draw five views, check the boundary of the shadow in each, and read the sheets back
    #[arg(long)]
    pub sheets: bool,
    /// Recount the pieces of five views, and search for missing contours
    #[arg(long)]
    pub views: bool,
    /// Write STEP files and meshes, read them back and compare them with the boundary
    #[arg(long)]
    pub step: bool,
    /// Run a program on each model too, and compare its measures with ours: `{}` is the model's
    /// file, `{out.stl}` (off, obj, step) a file that it writes; without one it prints a line of JSON
    /// with any of volume, area, bounds and solids, or error
    #[arg(long, value_name = "COMMAND")]
    pub against: Option<String>,
    /// Write each model for the program as statements in place of the line of this file that has
    /// `{{model}}`: a py or a cpp
    #[arg(
        long,
        value_name = "FILE",
        requires = "against",
        conflicts_with = "write_format"
    )]
    pub template: Option<PathBuf>,
    /// The memory that the program may address, in MiB
    #[arg(long, value_name = "MIB", default_value_t = 4096, requires = "against",
          value_parser = clap::value_parser!(u64).range(1..=1 << 30))]
    pub memory: u64,
    /// The relative tolerance of the program's volume and area; of its bounds relative to their
    /// diagonal
    #[arg(long, value_name = "REL", default_value = "1e-6", value_parser = positive,
          requires = "against")]
    pub tolerance: f64,
    /// The time limit of a tree, in seconds, and of the program of --against
    #[arg(long, value_name = "SECONDS", value_parser = seconds, default_value = "120")]
    pub limit: f64,
    /// The number of rays that measure each volume
    #[arg(long, value_name = "N", default_value_t = 10_000)]
    pub rays: u32,
    /// Shrink the first findings of each kind as long as they fail in the same way
    #[arg(long)]
    pub shrink: bool,
    /// Write the models to a folder, with a manifest of their true measures
    #[arg(long, value_name = "DIR")]
    pub write: Option<PathBuf>,
    /// The formats of the models of --write, or the format of those of --against [default: padl]
    #[arg(long, value_name = "F", value_enum, value_delimiter = ',')]
    pub write_format: Vec<ModelFormat>,
    /// Keep the state of the run in a file; with the same arguments it continues from there
    #[arg(long, value_name = "FILE")]
    pub state: Option<PathBuf>,
    /// Points nearer than this coincide, in the part's unit [default: 1e-11 of its size]
    #[arg(long, value_name = "D", value_parser = positive)]
    pub resolution: Option<f64>,
    /// Refuse a tree where a decision was closer than a hundred to one
    #[arg(long)]
    pub strict: bool,
    /// Where to write the summary [default: standard output]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// Be a worker: run the trials of models from standard input, with this configuration
    #[arg(long, hide = true, value_name = "TERMS")]
    pub worker: Option<String>,
    /// Start a program, the words after `--`, with this limit of memory in MiB
    #[arg(long, hide = true, value_name = "MIB")]
    pub launch: Option<u64>,
}

/// A profile, or all of them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProfileChoice {
    /// Every profile.
    All,
    /// This one.
    One(Profile),
}

impl ValueEnum for ProfileChoice {
    fn value_variants<'a>() -> &'a [Self] {
        const CHOICES: [ProfileChoice; Profile::ALL.len() + 1] = {
            let mut choices = [ProfileChoice::All; Profile::ALL.len() + 1];
            let mut i = 0;
            while i < Profile::ALL.len() {
                choices[i + 1] = ProfileChoice::One(Profile::ALL[i]);
                i += 1;
            }
            choices
        };
        &CHOICES
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        match self {
            Self::All => Some(PossibleValue::new("all").help("Every profile")),
            Self::One(profile) => {
                Some(PossibleValue::new(profile.name()).help(profile.description()))
            }
        }
    }
}
