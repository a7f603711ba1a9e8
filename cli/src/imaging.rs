//! Picture files, with the limits and the messages of the program.

use crate::diagnostics::CliError;
use crate::session::Session;
use premio::{Grey, PictureError, PictureFormat, PictureMatch, decode_picture};
use premio_predict::overlay;
use premio_predict::prediction::Prediction;
use std::path::Path;

/// The grey image of a file: PNG, PGM or JPEG; a picture in colours by its luma.
///
/// # Errors
/// The file is not a complete picture, or it has more pixels than the limit, or none.
pub fn read(path: &Path, session: Session) -> Result<Grey, CliError> {
    let bytes = session.limits.read(path)?;
    decode_picture(&bytes, session.limits.pixels).map_err(|error| match error {
        PictureError::Large { .. } => {
            let help = "--max-pixels sets another limit";
            CliError::input(format!("{}: {error}: {help}", path.display()))
        }
        error => failed(path, &error),
    })
}

fn failed(path: &Path, error: &PictureError) -> CliError {
    CliError::input(format!("{}: {error}", path.display()))
}

/// The bytes of a grey image with a number of levels: PNG or PGM, by the file's ending.
pub fn bytes(image: &Grey, levels: u32, path: &Path) -> Result<Vec<u8>, CliError> {
    let bytes = premio::encode_picture(image, levels, format(path)?);
    bytes.map_err(|error| failed(path, &error))
}

/// The format that the ending of an output picture names.
///
/// # Errors
/// The ending is another.
pub fn format(path: &Path) -> Result<PictureFormat, CliError> {
    PictureFormat::from_path(path).ok_or_else(|| {
        let name = path.display();
        let expected = "expected a file that ends in .png or .pgm";
        CliError::input(format!("{name}: {expected}"))
    })
}

/// The format that the ending of an overlay names; none for SVG.
///
/// # Errors
/// The ending is another.
pub fn overlay_format(path: &Path) -> Result<Option<PictureFormat>, CliError> {
    let ending = path.extension();
    match ending.is_some_and(|e| e.eq_ignore_ascii_case("svg")) {
        true => Ok(None),
        false => format(path).map(Some),
    }
}

/// The bytes of the overlay of a prediction, over an image where there is one: SVG, or PNG.
pub fn overlay(
    prediction: &Prediction,
    below: Option<&Grey>,
    path: &Path,
) -> Result<Vec<u8>, CliError> {
    let Some(format) = overlay_format(path)? else {
        return Ok(overlay::svg(prediction).into_bytes());
    };
    let bytes = premio::draw_prediction(prediction, below, format);
    bytes.map_err(|error| failed(path, &error))
}

/// The bytes of a picture with the likeliest match drawn on it; none without a match.
pub fn matched(found: &PictureMatch, path: &Path) -> Result<Option<Vec<u8>>, CliError> {
    let bytes = found.overlay(format(path)?);
    bytes.map_err(|error| failed(path, &error))
}
