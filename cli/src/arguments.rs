//! The command line.

mod camera;
mod fuzz;
mod matching;
mod predict;
mod sheet;

use crate::session::InputLimits;
pub use camera::{CameraChoice, CameraOptions};
use clap::{Args, Parser, Subcommand, ValueEnum};
use clap_complete::Shell;
pub use fuzz::{FuzzOptions, ProfileChoice};
pub use matching::{MatchOptions, SoughtOptions, StrategyName, TrackOptions};
pub use predict::{
    AdviseOptions, CompareOptions, GoalName, MergeOptions, ModelCommand, ModelOptions, ModelOutput,
    ModelRunOptions, PredictOptions, RecordsFormat, RenderOptions, SchemaName, SchemaOptions,
};
use premio::files::SystemFonts;
use premio_csg::lettering::Fonts;
use premio_csg::reader::{FacetLimit, Includes, ReadOptions, ValueOverride};
use premio_kernel::unit::Unit;
pub use sheet::{SheetArguments, ViewName};
use std::path::{Path, PathBuf};

/// From a description of a solid to its exact boundary and to what a camera sees of it.
#[derive(Debug, Parser)]
#[command(name = "premio", version, after_help = EXIT_STATUS)]
pub struct Arguments {
    /// The command.
    #[command(subcommand)]
    pub command: Command,
    /// Write JSON: measures, checks and summaries, and messages on standard error
    /// (premio.message/1, one per line)
    #[arg(long, global = true, display_order = 900)]
    pub json: bool,
    /// Use at most N threads; the output is the same for any number [default: the number of cores]
    #[arg(long, global = true, value_name = "N", display_order = 901,
          value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
    /// The most that is read.
    #[command(flatten)]
    pub limits: InputLimits,
}

const EXIT_STATUS: &str = "Example: premio info part.padl

Exit status: 0 done; 1 a self-check failed; 2 the input or the arguments are wrong; 3 the geometry
is beyond a stated limit, or a close call under --strict.";

/// The commands.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Measures of the solid: volume, area, topology, decisions
    #[command(after_help = "Example: premio info part.padl --json")]
    Info(InfoOptions),
    /// What a camera sees: contours with their visibility
    #[command(after_help = "Examples: premio contours part.padl -o part.svg
          premio contours part.padl --eye 30,-40,25 -o part.svg
          premio contours part.padl --camera view.json --format json --samples 5
          premio contours part.padl --views front,top,right,iso --hidden -o part.dxf")]
    Contours(ContoursOptions),
    /// All self-checks on one description
    #[command(after_help = "Example: premio check part.padl")]
    Check(CheckOptions),
    /// The boundary in a chosen format
    #[command(after_help = "Examples: premio export part.padl -o part.step
          premio export part.padl --format json")]
    Export(ExportOptions),
    /// A description in another language
    #[command(after_help = "Examples: premio convert part.padl part.json
          premio convert model.asc --part all.g model.padl --exact")]
    Convert(ConvertOptions),
    /// The features of the part that a sensor and a detector find, under given lights
    #[command(
        after_help = "Examples: premio predict part.padl --setup setup.toml -o prediction.json
          premio predict part.padl --setup setup.toml --overlay part.svg -o prediction.json"
    )]
    Predict(PredictOptions),
    /// The model of predictions over many setups: the detectability of every feature
    #[command(
        after_help = "Examples: premio model part.padl --setups setups.toml -o part.model
          premio model part.padl --setups setups.toml --shard 2/5 -o part.2.shard
          premio model merge part.*.shard -o part.model"
    )]
    Model(ModelOptions),
    /// The best directions of camera and light, and the cost of others
    #[command(after_help = "Example: premio advise part.padl --setups setups.toml --goal pose")]
    Advise(AdviseOptions),
    /// The image of a setup, by a line of sight through every pixel
    #[command(after_help = "Example: premio render part.padl --setup setup.toml -o part.png")]
    Render(RenderOptions),
    /// The prediction compared with the detection in an image of the same setup
    #[command(after_help = "Examples: premio compare part.padl --setup setup.toml
          premio compare part.padl --setup setup.toml --image photo.png --json")]
    Compare(CompareOptions),
    /// The part in a picture: pose, correspondences, probability
    #[command(
        after_help = "Examples: premio match part.model photo.png --camera camera.json -o pose.json --overlay pose.png
          premio match part.model scene/*.png --camera camera.json --csv poses.csv -o poses.jsonl"
    )]
    Match(MatchOptions),
    /// The part in the pictures of a sequence, each from the previous pose
    #[command(
        after_help = "Example: premio track part.model film/*.png --camera camera.json -o poses.jsonl"
    )]
    Track(TrackOptions),
    /// The self-checks on thousands of random trees
    #[command(
        after_help = "Examples: premio fuzz --profile grid,near --count 10000 --state run.json --shrink
          premio fuzz --count 100 --write models --write-format padl,csg --json -o summary.json

Exit status: 0 no answer is wrong; 1 some are; 130 interrupted."
    )]
    Fuzz(FuzzOptions),
    /// The JSON schema of a command's output
    #[command(after_help = "Example: premio schema prediction -o prediction.schema.json")]
    Schema(SchemaOptions),
    /// The manual page of the program, or of one of its commands
    #[command(after_help = "Example: premio man contours | man -l -")]
    Man(ManOptions),
    /// Completions of the command line for a shell
    #[command(
        after_help = "Example: premio completions bash -o ~/.local/share/bash-completion/completions/premio"
    )]
    Completions(CompletionsOptions),
}

/// The description, and how it is read and evaluated.
#[derive(Debug, Default, Args)]
pub struct DescriptionOptions {
    /// The description: .padl, .csg (OpenSCAD's flattened output), .json, .asc (BRL-CAD's database
    /// as text) or .pov (POV-Ray's scene)
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Points nearer than this coincide, in the part's unit [default: 1e-11 of its size]
    #[arg(long, value_name = "D", value_parser = positive)]
    pub resolution: Option<f64>,
    /// Refuse the part where a decision was closer than a hundred to one
    #[arg(long)]
    pub strict: bool,
    /// Accept only proven coincidences, ten to a hundred times slower
    #[arg(long, conflicts_with = "resolution")]
    pub exact: bool,
    /// Make no decision in f64: the same boundary in extended precision (237 bits), some hundred
    /// times slower
    #[arg(long)]
    pub unfiltered: bool,
    #[command(flatten)]
    pub reading: ReadingOptions,
}

impl DescriptionOptions {
    /// The file's name, without its folder and its ending.
    pub fn stem(&self) -> String {
        let stem = self.file.file_stem().unwrap_or_default();
        stem.to_string_lossy().into_owned()
    }
}

/// The options for reading a description.
#[derive(Debug, Default, Args)]
pub struct ReadingOptions {
    /// The part of a .padl, .asc or .pov file to take [default: the last solid assigned, the object
    /// that no other contains, the whole scene]
    #[arg(long, value_name = "NAME")]
    pub part: Option<String>,
    /// The largest $fn of a .csg file that is meant as a polygon: a number, `none` or `all`
    #[arg(long, value_name = "N", default_value_t)]
    pub facets: FacetLimit,
    /// The same as `--facets none`
    #[arg(long, conflicts_with = "facets")]
    pub smooth: bool,
    #[command(flatten)]
    pub define: DefineOptions,
}

/// The values that override those of a description.
#[derive(Clone, Debug, Default, Args)]
pub struct DefineOptions {
    /// Another value for a number that a .padl file sets: an expression, as in L=2*40; repeatable
    #[arg(short = 'D', long = "define", value_name = "NAME=VALUE", value_parser = value_override)]
    pub overrides: Vec<ValueOverride>,
}

impl ReadingOptions {
    /// Which round shapes are polygons.
    pub fn facets(&self) -> FacetLimit {
        match self.smooth {
            true => FacetLimit::None,
            false => self.facets,
        }
    }

    /// The options of the readers, with the loader of included files and the fonts of the machine.
    pub fn options(&self, includes: Includes) -> ReadOptions {
        ReadOptions {
            facets: self.facets(),
            part: self.part.clone(),
            overrides: self.define.overrides.clone(),
            includes,
            fonts: Fonts::new(SystemFonts::default()),
        }
    }
}

/// A name and its value.
fn value_override(text: &str) -> Result<ValueOverride, String> {
    let (name, value) = match text.split_once('=') {
        Some((name, value)) if !name.trim().is_empty() => (name.trim(), value.trim()),
        _ => return Err("expected a name and its value, as L=80".to_owned()),
    };
    Ok(ValueOverride {
        name: name.to_owned(),
        value: value.to_owned(),
    })
}

/// The output of text.
#[derive(Debug, Args)]
pub struct OutputOptions {
    /// Where to write [default: standard output]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
}

impl OutputOptions {
    /// The file, if it is one.
    pub fn path(&self) -> Option<&Path> {
        self.output.as_deref()
    }
}

/// Options of `info`.
#[derive(Debug, Args)]
pub struct InfoOptions {
    #[command(flatten)]
    pub description: DescriptionOptions,
}

/// Options of `contours`.
#[derive(Debug, Args)]
pub struct ContoursOptions {
    #[command(flatten)]
    pub description: DescriptionOptions,
    #[command(flatten)]
    pub camera: CameraOptions,
    #[command(flatten)]
    pub sheet: SheetArguments,
    /// What to write [default: by the ending of OUT]
    #[arg(long, value_enum)]
    pub format: Option<ContoursFormat>,
    /// Add N points of the curve in space to each piece (json)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=10_000))]
    pub samples: Option<u32>,
    /// Draw hidden lines, too (svg, dxf)
    #[arg(long)]
    pub hidden: bool,
    /// Draw smooth edges, along which the normal does not jump, too (svg, dxf)
    #[arg(long)]
    pub smooth_edges: bool,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// Options of `check`.
#[derive(Debug, Args)]
pub struct CheckOptions {
    #[command(flatten)]
    pub description: DescriptionOptions,
    /// The number of rays that measure the volume
    #[arg(long, value_name = "N", default_value_t = 200_000)]
    pub rays: u32,
}

/// Options of `export`.
#[derive(Debug, Args)]
pub struct ExportOptions {
    #[command(flatten)]
    pub description: DescriptionOptions,
    /// What to write [default: by the ending of OUT]
    #[arg(long, value_enum)]
    pub format: Option<ExportFormat>,
    /// The greatest distance of splines from their curves, in the part's unit (step) [default: 1e-6
    /// of its size]
    #[arg(long, value_name = "D", value_parser = positive)]
    pub accuracy: Option<f64>,
    /// The application protocol to name (step) [default: ap242]
    #[arg(long, value_enum, value_name = "AP")]
    pub protocol: Option<StepProtocol>,
    /// The greatest distance of triangles from the boundary, in the part's unit (stl, obj, glb,
    /// 3mf) [default: 1/2000 of its size]
    #[arg(long, value_name = "D", value_parser = positive)]
    pub deviation: Option<f64>,
    /// The greatest angle of the normals along a side of a triangle, in degrees (stl, obj, glb,
    /// 3mf) [default: 15]
    #[arg(long, value_name = "DEGREES", value_parser = positive)]
    pub angle: Option<f64>,
    /// The part's unit (step, glb, 3mf) [default: mm]
    #[arg(long, value_enum, value_name = "UNIT")]
    pub unit: Option<LengthUnit>,
    /// The part's name (step, obj, glb, 3mf) [default: the file's name]
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// The unit of lengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LengthUnit {
    /// Metres
    M,
    /// Centimetres
    Cm,
    /// Millimetres
    Mm,
    /// Micrometres
    Um,
    /// Inches
    In,
}

impl From<LengthUnit> for Unit {
    fn from(unit: LengthUnit) -> Self {
        match unit {
            LengthUnit::M => Self::Metre,
            LengthUnit::Cm => Self::Centimetre,
            LengthUnit::Mm => Self::Millimetre,
            LengthUnit::Um => Self::Micrometre,
            LengthUnit::In => Self::Inch,
        }
    }
}

/// The application protocol of a STEP file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum StepProtocol {
    /// Managed model-based 3D engineering
    Ap242,
    /// Automotive design
    Ap214,
}

/// Options of `convert`.
#[derive(Debug, Args)]
pub struct ConvertOptions {
    /// The description: .padl, .csg, .json, .asc or .pov
    #[arg(value_name = "IN")]
    pub file: PathBuf,
    /// Where to write it: .padl, .csg or .json
    #[arg(value_name = "OUT")]
    pub output: PathBuf,
    /// Refuse numbers that the other language cannot hold exactly, instead of writing the nearest
    #[arg(long)]
    pub exact: bool,
    /// Recover the relations that rounded coordinates destroyed: coplanar, coaxial, tangent
    #[arg(long)]
    pub recover: bool,
    #[command(flatten)]
    pub reading: ReadingOptions,
}

/// Options of `man`.
#[derive(Debug, Args)]
pub struct ManOptions {
    /// The command to describe [default: the program]
    #[arg(value_name = "COMMAND")]
    pub command: Option<String>,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// Options of `completions`.
#[derive(Debug, Args)]
pub struct CompletionsOptions {
    /// The shell
    #[arg(value_enum, value_name = "SHELL")]
    pub shell: Shell,
    #[command(flatten)]
    pub output: OutputOptions,
}

/// The formats of models.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, ValueEnum)]
pub enum ModelFormat {
    /// PADL
    Padl,
    /// As OpenSCAD flattens
    Csg,
    /// The tree
    Json,
}

/// The formats of contours.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ContoursFormat {
    /// premio.contours/1, with exact curves
    Json,
    /// A drawing for the browser and the page
    Svg,
    /// A drawing for CAD programs
    Dxf,
}

/// The formats of boundaries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ExportFormat {
    /// premio.object/1: the topological object model
    Json,
    /// ISO 10303: an advanced boundary representation
    Step,
    /// Binary STL: triangles
    Stl,
    /// Wavefront OBJ: triangles with normals
    Obj,
    /// Binary glTF: triangles with normals, and the edges as lines
    Glb,
    /// 3MF: triangles, with the unit
    #[value(name = "3mf")]
    ThreeMf,
}

impl ExportFormat {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Json => "json",
            Self::Step => "step",
            Self::Stl => "stl",
            Self::Obj => "obj",
            Self::Glb => "glb",
            Self::ThreeMf => "3mf",
        }
    }
}

impl OutputOptions {
    /// The requested format, or otherwise that of the output's ending.
    ///
    /// # Errors
    /// There is no option, and the ending names no format.
    pub fn format<T: ValueEnum>(&self, requested: Option<T>) -> Result<T, String> {
        if let Some(format) = requested {
            return Ok(format);
        }
        let ending = self.output.as_deref().and_then(Path::extension);
        let ending = ending.map(|e| e.to_string_lossy().to_ascii_lowercase());
        let name = match ending.as_deref() {
            Some("stp") => Some("step"),
            other => other,
        };
        if let Some(format) = name.and_then(|name| T::from_str(name, false).ok()) {
            return Ok(format);
        }
        let all = T::value_variants().iter().filter_map(T::to_possible_value);
        let all: Vec<String> = all.map(|value| value.get_name().to_owned()).collect();
        let found = match (&self.output, ending) {
            (None, _) => "there is no `--format`, and no `-o` with an ending".to_owned(),
            (Some(path), None) => {
                format!(
                    "{}: there is no `--format`, and the file has no ending",
                    path.display()
                )
            }
            (Some(path), Some(ending)) => format!(
                "{}: there is no `--format`, and the ending `.{ending}` names no format",
                path.display()
            ),
        };
        Err(format!("{found}: expected one of {}", all.join(", ")))
    }
}

fn positive(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(value) if value > 0.0 && value.is_finite() => Ok(value),
        _ => Err("expected a positive number".to_owned()),
    }
}

/// A duration in seconds.
fn seconds(text: &str) -> Result<f64, String> {
    positive(text).and_then(|value| match value < 1e6 {
        true => Ok(value),
        false => Err("expected at most a million seconds".to_owned()),
    })
}

fn vector(text: &str) -> Result<[f64; 3], String> {
    let wrong = || "expected three numbers `x,y,z`".to_owned();
    let numbers: Result<Vec<f64>, _> = text.split(',').map(|n| n.trim().parse()).collect();
    let vector: [f64; 3] = numbers
        .map_err(|_| wrong())?
        .try_into()
        .map_err(|_| wrong())?;
    if vector.iter().all(|x| x.is_finite()) {
        Ok(vector)
    } else {
        Err(wrong())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_command_line_is_consistent() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn every_command_shows_an_example() {
        for command in Arguments::command().get_subcommands() {
            let help = command.get_after_help().map(ToString::to_string);
            assert!(help.is_some_and(|h| h.starts_with("Example")));
        }
    }

    #[test]
    fn cameras_on_the_command_line() {
        let parse = |words: &str| {
            let all = format!("premio contours a.padl --format json {words}");
            Arguments::try_parse_from(all.split_whitespace()).is_ok()
        };
        assert!(parse("--camera c.json"));
        assert!(parse("--eye -1,2,3 --target 0,0,-1"));
        assert!(parse("--eye 1,2,3 --target 0,0,0 --up 0,1,0 --focal 2"));
        assert!(parse("--eye 1,2,3 --target 0,0,0 --ortho"));
        assert!(parse(""));
        assert!(parse("--view top"));
        assert!(parse("--eye 1,2,3"));
        assert!(!parse("--view top --eye 1,2,3"));
        assert!(!parse("--view top --camera c.json"));
        assert!(!parse("--eye 1,2 --target 0,0,0"));
        assert!(!parse("--eye 1,2,nan --target 0,0,0"));
        assert!(!parse("--eye 1,2,3 --target 0,0,0 --focal 2 --ortho"));
        assert!(!parse("--camera c.json --ortho"));
        assert!(parse("--views front,iso --paper a4 --scale 1:2.5"));
        assert!(!parse("--views front --camera c.json"));
        assert!(!parse("--views front --eye 1,2,3 --target 0,0,0"));
        assert!(!parse("--views side"));
        assert!(!parse("--views front --scale 2"));
        assert!(!parse("--views front --scale 1:0"));
        assert!(!parse("--camera c.json --samples 0"));
    }
}
