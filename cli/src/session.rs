//! The options of every command.

use crate::diagnostics::{CliError, Reporter};
use clap::Args;
use std::collections::TryReserveError;
use std::fs::File;
use std::io::{ErrorKind, Read};
use std::path::Path;

/// The reporter, and the limits of input.
#[derive(Clone, Copy, Debug, Default)]
pub struct Session {
    /// The reporter of messages.
    pub voice: Reporter,
    /// The limits of input.
    pub limits: InputLimits,
}

/// The most that is read.
#[derive(Args, Clone, Copy, Debug)]
pub struct InputLimits {
    /// Refuse a file, a pipe or a device with more bytes: a number, or one with KiB, MiB or GiB
    /// [default: 1GiB]
    #[arg(long = "max-input", global = true, value_name = "BYTES", value_parser = bytes,
          default_value = "1GiB", hide_default_value = true, help_heading = "Limits")]
    pub input: u64,
    /// Refuse a picture, or a sensor, with more pixels [default: 100000000]
    #[arg(long = "max-pixels", global = true, value_name = "N", value_parser = pixels,
          default_value = "100000000", hide_default_value = true, help_heading = "Limits")]
    pub pixels: u64,
}

/// The default limits, for tests.
impl Default for InputLimits {
    fn default() -> Self {
        Self {
            input: 1 << 30,
            pixels: 100_000_000,
        }
    }
}

fn bytes(text: &str) -> Result<u64, String> {
    let wrong = || "expected a number of bytes, as 1000000, 512MiB or 2GiB".to_owned();
    let digits = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let shift = match text[digits.len()..].to_ascii_lowercase().as_str() {
        "" | "b" => 0,
        "k" | "kib" => 10,
        "m" | "mib" => 20,
        "g" | "gib" => 30,
        _ => return Err(wrong()),
    };
    let number: u64 = digits.parse().map_err(|_| wrong())?;
    match number.checked_mul(1 << shift) {
        Some(bytes) if bytes > 0 => Ok(bytes),
        _ => Err(wrong()),
    }
}

fn pixels(text: &str) -> Result<u64, String> {
    match text.parse() {
        Ok(number) if number > 0 => Ok(number),
        _ => Err("expected a whole number above zero".to_owned()),
    }
}

/// The number of bytes that are read at once.
const PIECE: usize = 1 << 20;

impl InputLimits {
    /// The content of a file, a pipe or a device.
    ///
    /// # Errors
    /// It cannot be read, it is longer than the limit, or there is no memory for it.
    pub fn read(&self, path: &Path) -> Result<Vec<u8>, CliError> {
        let read = self.read_at_most(path, self.input);
        read.map_err(|why| CliError::input(format!("{}: {why}", path.display())))
    }

    /// The content of a file of at most so many bytes, or why it is not read.
    pub fn read_at_most(&self, path: &Path, most: u64) -> Result<Vec<u8>, String> {
        let failed = |e: &dyn std::fmt::Display| e.to_string();
        let mut file = File::open(path).map_err(|e| failed(&e))?;
        let too_long = || {
            let words = "found more than the limit of bytes";
            failed(&format!(
                "{words}, {}: --max-input sets another",
                self.input
            ))
        };
        let known = file.metadata().map_or(0, |found| found.len());
        if known > most {
            return Err(too_long());
        }
        let mut bytes = Vec::new();
        let no_memory = |e: TryReserveError| failed(&format!("no memory for what is read: {e}"));
        let known = usize::try_from(known).unwrap_or(usize::MAX);
        crate::MEMORY
            .telling(|| bytes.try_reserve_exact(known))
            .map_err(no_memory)?;
        let mut piece = vec![0; PIECE];
        loop {
            let read = match file.read(&mut piece) {
                Ok(0) => return Ok(bytes),
                Ok(read) => read,
                Err(e) if e.kind() == ErrorKind::Interrupted => continue,
                Err(e) => return Err(failed(&e)),
            };
            if (bytes.len() + read) as u64 > most {
                return Err(too_long());
            }
            if bytes.capacity() - bytes.len() < read {
                // Half as much again, because twice as much memory may not be available.
                let more = (bytes.len() / 2).max(PIECE);
                let left = (most as usize).saturating_sub(bytes.len()).max(PIECE);
                let more = more.min(left);
                crate::MEMORY
                    .telling(|| bytes.try_reserve_exact(more))
                    .map_err(no_memory)?;
            }
            bytes.extend_from_slice(&piece[..read]);
        }
    }

    /// The text of a file.
    ///
    /// # Errors
    /// As [`InputLimits::read`]; or it is not a text in UTF-8.
    pub fn read_text(&self, path: &Path) -> Result<String, CliError> {
        String::from_utf8(self.read(path)?).map_err(|e| {
            let at = e.utf8_error().valid_up_to();
            let bytes = e.as_bytes();
            let byte = bytes.get(at).copied().unwrap_or_default();
            let words = format!("found the byte {byte:#04x}, expected a text in UTF-8");
            let name = path.display().to_string();
            CliError::in_bytes(&name, bytes, at..at + 1, &words)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_have_units() {
        assert_eq!(bytes("1000"), Ok(1000));
        assert_eq!(bytes("2GiB"), Ok(2 << 30));
        assert_eq!(bytes("512mib"), Ok(512 << 20));
        for wrong in [
            "",
            "0",
            "-1",
            "GiB",
            "1.5GiB",
            "1TiB",
            "99999999999999999999",
            "99999999999GiB",
        ] {
            assert!(bytes(wrong).is_err(), "{wrong}");
        }
    }

    #[test]
    fn what_is_longer_than_the_limit_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        std::fs::write(&path, "12345").unwrap();
        let limits = |input| InputLimits {
            input,
            ..InputLimits::default()
        };
        assert_eq!(limits(5).read(&path).unwrap(), b"12345");
        let refused = format!("{:?}", limits(4).read(&path).unwrap_err());
        assert!(refused.contains("--max-input"), "{refused}");
    }
}
