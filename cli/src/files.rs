//! The inputs and outputs of a command, checked before anything is computed.

use crate::arguments::{Command, DescriptionOptions, ModelCommand, SoughtOptions};
use crate::diagnostics::CliError;
use crate::fuzz::archive::MANIFEST;
use std::fs::{self, Metadata};
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// The outputs of the command.
static OUTPUTS: OnceLock<Vec<Identity>> = OnceLock::new();

/// Whether a file is an output of the command.
pub fn is_output(path: &Path) -> bool {
    let outputs = OUTPUTS.get().map_or(&[][..], Vec::as_slice);
    identity(path).is_some_and(|identity| outputs.contains(&identity))
}

/// The option with a folder of many outputs.
const MODELS: &str = "--write";

/// The inputs and outputs of a command.
#[derive(Debug, Default)]
pub struct Files {
    inputs: Vec<Named>,
    outputs: Vec<Named>,
    /// A folder of many outputs.
    folder: Option<PathBuf>,
}

/// A file, and its name on the command line.
#[derive(Debug)]
struct Named {
    option: &'static str,
    path: PathBuf,
}

/// The identity of a file: equal for two paths to one file.
#[derive(Debug, PartialEq, Eq)]
enum Identity {
    /// An existing file.
    Present(FileId),
    /// A file that does not exist yet, by the real path of its folder.
    Absent(PathBuf),
}

/// Device and inode, where the system has them; otherwise the real path.
#[cfg(unix)]
#[derive(Clone, Debug, PartialEq, Eq)]
struct FileId {
    device: u64,
    inode: u64,
}
#[cfg(not(unix))]
type FileId = PathBuf;

impl Files {
    /// The files of a command.
    pub fn new(command: &Command) -> Self {
        let mut files = Self::default();
        match command {
            Command::Info(options) => files.reads_part(&options.description),
            Command::Contours(options) => {
                files.reads_part(&options.description);
                files.reads("--camera", options.camera.camera.as_deref());
                files.writes("-o", options.output.path());
            }
            Command::Check(options) => files.reads_part(&options.description),
            Command::Export(options) => {
                files.reads_part(&options.description);
                files.writes("-o", options.output.path());
            }
            Command::Convert(options) => {
                files.reads("IN", Some(&options.file));
                files.writes("OUT", Some(&options.output));
            }
            Command::Predict(options) => {
                files.reads_part(&options.description);
                files.reads("--setup", Some(&options.setup));
                files.writes("--overlay", options.overlay.as_deref());
                files.writes("-o", options.output.as_deref());
            }
            Command::Render(options) => {
                files.reads_part(&options.description);
                files.reads("--setup", Some(&options.setup));
                files.writes("-o", Some(&options.output));
            }
            Command::Compare(options) => {
                files.reads_part(&options.description);
                files.reads("--setup", Some(&options.setup));
                files.reads("--image", options.image.as_deref());
                files.writes("--overlay", options.overlay.as_deref());
                files.writes("-o", options.output.as_deref());
            }
            Command::Advise(options) => {
                files.reads_part(&options.description);
                files.reads("--setups", Some(&options.setups));
                files.writes("-o", options.output.path());
            }
            Command::Model(options) => {
                if let Some(ModelCommand::Merge(merge)) = &options.command {
                    for shard in &merge.shards {
                        files.reads("SHARD", Some(shard));
                    }
                    files.writes("-o", merge.output.output.as_deref());
                } else if let Some(run) = &options.run.0 {
                    files.reads_part(&run.description);
                    files.reads("--setups", Some(&run.setups));
                    files.writes("-o", run.output.output.as_deref());
                }
            }
            Command::Match(options) => files.sought(&options.sought),
            Command::Track(options) => files.sought(&options.sought),
            // The words of a program to start are no files.
            Command::Fuzz(options) if options.launch.is_some() => {}
            Command::Fuzz(options) => {
                for file in &options.files {
                    files.reads("FILES", Some(file));
                }
                files.reads("--template", options.template.as_deref());
                files.writes("--state", options.state.as_deref());
                // A folder that does not exist yet contains no file that could be lost.
                let folder = options.write.as_ref().filter(|folder| folder.is_dir());
                let manifest = folder.map(|folder| folder.join(MANIFEST));
                files.writes(MODELS, manifest.as_deref());
                files.writes("-o", options.output.as_deref());
                files.folder = options.write.clone();
            }
            Command::Schema(options) => files.writes("-o", options.output.path()),
            Command::Man(options) => files.writes("-o", options.output.path()),
            Command::Completions(options) => files.writes("-o", options.output.path()),
        }
        files
    }

    fn reads_part(&mut self, description: &DescriptionOptions) {
        self.reads("FILE", Some(&description.file));
    }

    fn sought(&mut self, options: &SoughtOptions) {
        self.reads("MODEL", Some(&options.model));
        self.reads("--camera", Some(&options.camera));
        self.reads("--detector", options.detector.as_deref());
        for image in &options.images {
            self.reads("IMAGE", Some(image));
        }
        self.writes("--overlay", options.overlay.as_deref());
        self.writes("--csv", options.csv.as_deref());
        self.writes("-o", options.output.as_deref());
    }

    fn reads(&mut self, option: &'static str, path: Option<&Path>) {
        self.inputs.extend(Named::new(option, path));
    }

    fn writes(&mut self, option: &'static str, path: Option<&Path>) {
        self.outputs.extend(Named::new(option, path));
    }

    /// Checks that no other output is in the folder of outputs.
    fn check_folder(&self) -> Result<(), CliError> {
        let Some(folder) = &self.folder else {
            return Ok(());
        };
        let Ok(folder) = fs::canonicalize(folder).or_else(|_| absent(folder)) else {
            return Ok(());
        };
        for output in self.outputs.iter().filter(|o| o.option != MODELS) {
            let target = premio::files::target(&output.path);
            let real = target.and_then(|target| absent(&target));
            if real.is_ok_and(|path| path.starts_with(&folder)) {
                return Err(output.refused(&format!(
                    "`{}` is in the folder of `{MODELS}`, expected a file outside of {}",
                    output.option,
                    folder.display()
                )));
            }
        }
        Ok(())
    }

    /// Checks that every output is a separate file in an existing folder.
    ///
    /// # Errors
    /// Two outputs are one file, an output is an input, or an output cannot be a file.
    pub fn check(&self) -> Result<(), CliError> {
        self.check_folder()?;
        let mut known: Vec<(&Named, Identity)> = Vec::new();
        for output in &self.outputs {
            let Some(identity) = output.identity_of_output()? else {
                continue;
            };
            if let Some((other, _)) = known.iter().find(|(_, known)| *known == identity) {
                return Err(output.refused(&format!(
                    "`{}` and `{}` are one file, expected a file for each",
                    other.option, output.option
                )));
            }
            known.push((output, identity));
        }
        self.check_inputs(&known)?;
        // A description may include files that are not on the command line.
        let identities = known.into_iter().map(|(_, identity)| identity);
        let _ = OUTPUTS.set(identities.collect());
        Ok(())
    }

    /// Checks that no output is an input, or standard output.
    fn check_inputs(&self, known: &[(&Named, Identity)]) -> Result<(), CliError> {
        let stdout = stdout_identity();
        for input in &self.inputs {
            let Some(identity) = identity(&input.path) else {
                continue;
            };
            if let Some((output, _)) = known.iter().find(|(_, known)| *known == identity) {
                return Err(output.refused(&format!(
                    "`{}` is the input `{}`, {}: expected another file",
                    output.option,
                    input.option,
                    input.path.display()
                )));
            }
            if stdout.as_ref() == Some(&identity) {
                return Err(input.refused("standard output is this input: expected another file"));
            }
        }
        match known
            .iter()
            .find(|(_, known)| stdout.as_ref() == Some(known))
        {
            Some((output, _)) => Err(output.refused(&format!(
                "standard output and `{}` are one file, expected a file for each",
                output.option
            ))),
            None => Ok(()),
        }
    }
}

impl Named {
    fn new(option: &'static str, path: Option<&Path>) -> Option<Self> {
        let path = path?.to_owned();
        Some(Self { option, path })
    }

    fn refused(&self, why: &str) -> CliError {
        CliError::input(format!("{}: {why}", self.path.display()))
    }

    /// The identity of an output file; none for devices and pipes, whose content is not replaced.
    fn identity_of_output(&self) -> Result<Option<Identity>, CliError> {
        if is_folder(&self.path) {
            return Err(self.refused("found the path of a folder, expected that of a file"));
        }
        let target = premio::files::target(&self.path).map_err(|e| self.refused(&e.to_string()))?;
        match fs::metadata(&target) {
            Ok(found) if found.is_dir() => Err(self.refused("found a folder, expected a file")),
            Ok(found) if !found.is_file() => Ok(None),
            Ok(found) => Ok(present(&target, &found).map(Identity::Present)),
            Err(_) => absent(&target)
                .map(|path| Some(Identity::Absent(path)))
                .map_err(|e| self.refused(&format!("its folder: {e}"))),
        }
    }
}

/// Whether a path that does not exist can only be that of a folder.
fn is_folder(path: &Path) -> bool {
    let text = path.to_string_lossy();
    let last = text.rsplit(std::path::is_separator).next();
    matches!(last, Some("" | "." | "..")) && !text.is_empty()
}

fn identity(path: &Path) -> Option<Identity> {
    match fs::metadata(path) {
        Ok(found) if found.is_file() => present(path, &found).map(Identity::Present),
        _ => None,
    }
}

#[cfg(unix)]
fn present(_: &Path, found: &Metadata) -> Option<FileId> {
    use std::os::unix::fs::MetadataExt;
    Some(FileId {
        device: found.dev(),
        inode: found.ino(),
    })
}

#[cfg(not(unix))]
fn present(path: &Path, _: &Metadata) -> Option<FileId> {
    fs::canonicalize(path).ok()
}

/// The path of a file that does not exist yet, with its folder resolved.
fn absent(path: &Path) -> std::io::Result<PathBuf> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty());
    let folder = fs::canonicalize(folder.unwrap_or(Path::new(".")))?;
    Ok(folder.join(path.file_name().unwrap_or_default()))
}

/// The file that standard output goes to, if it is one.
#[cfg(unix)]
fn stdout_identity() -> Option<Identity> {
    use std::os::fd::AsFd;
    let descriptor = std::io::stdout().as_fd().try_clone_to_owned().ok()?;
    let found = fs::File::from(descriptor).metadata().ok()?;
    let is_file = found.is_file();
    is_file.then(|| present(Path::new(""), &found).map(Identity::Present))?
}

#[cfg(not(unix))]
fn stdout_identity() -> Option<Identity> {
    None
}
