//! The options for a sheet of views.

use super::{LengthUnit, positive};
use clap::{Args, ValueEnum};
use premio_drawing::sheet::{Angle, Paper, Scale, StandardView};

/// A sheet of paper with a frame and a title block; any of these options requests it.
#[derive(Debug, Args)]
pub struct SheetArguments {
    /// Several views on a sheet, instead of a camera (svg, dxf)
    #[arg(long, value_enum, value_name = "VIEWS", value_delimiter = ',',
          conflicts_with_all = ["view", "camera", "eye", "target", "up", "focal", "ortho"])]
    pub views: Vec<ViewName>,
    /// The paper, landscape (svg, dxf) [default: a3]
    #[arg(long, value_enum, value_name = "PAPER")]
    pub paper: Option<PaperSize>,
    /// The scale, as 1:2 (svg, dxf) [default: the greatest of 1, 2, 5, 10 and so on that fits]
    #[arg(long, value_name = "A:B", value_parser = scale)]
    pub scale: Option<Scale>,
    /// The title in the title block (svg, dxf) [default: the file's name]
    #[arg(long, value_name = "TEXT")]
    pub title: Option<String>,
    /// The part's unit (svg, dxf) [default: mm]
    #[arg(long, value_enum, value_name = "UNIT")]
    pub unit: Option<LengthUnit>,
    /// First-angle or third-angle projection (svg, dxf) [default: first]
    #[arg(long, value_enum, value_name = "ANGLE")]
    pub projection: Option<ProjectionAngle>,
}

impl SheetArguments {
    /// Whether a sheet is requested.
    pub fn is_requested(&self) -> bool {
        !self.views.is_empty()
            || self.paper.is_some()
            || self.scale.is_some()
            || self.title.is_some()
            || self.unit.is_some()
            || self.projection.is_some()
    }
}

/// The views of a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ViewName {
    /// Along y: x to the right, z up
    Front,
    /// Against y
    Back,
    /// Along x
    Left,
    /// Against x: y to the right, z up
    Right,
    /// From above: x to the right, y up
    Top,
    /// From below
    Bottom,
    /// Front, right and top at once
    Iso,
}

/// The papers of a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PaperSize {
    /// 1189 mm by 841 mm
    A0,
    /// 841 mm by 594 mm
    A1,
    /// 594 mm by 420 mm
    A2,
    /// 420 mm by 297 mm
    A3,
    /// 297 mm by 210 mm
    A4,
}

/// The projection method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ProjectionAngle {
    /// The view from above is placed below
    First,
    /// The view from above is placed above
    Third,
}

impl From<ViewName> for StandardView {
    fn from(name: ViewName) -> Self {
        match name {
            ViewName::Front => Self::Front,
            ViewName::Back => Self::Back,
            ViewName::Left => Self::Left,
            ViewName::Right => Self::Right,
            ViewName::Top => Self::Top,
            ViewName::Bottom => Self::Bottom,
            ViewName::Iso => Self::Isometric,
        }
    }
}

impl From<PaperSize> for Paper {
    fn from(size: PaperSize) -> Self {
        match size {
            PaperSize::A0 => Self::A0,
            PaperSize::A1 => Self::A1,
            PaperSize::A2 => Self::A2,
            PaperSize::A3 => Self::A3,
            PaperSize::A4 => Self::A4,
        }
    }
}

impl From<ProjectionAngle> for Angle {
    fn from(angle: ProjectionAngle) -> Self {
        match angle {
            ProjectionAngle::First => Self::First,
            ProjectionAngle::Third => Self::Third,
        }
    }
}

/// Parses a scale: two positive numbers with a colon between.
fn scale(text: &str) -> Result<Scale, String> {
    let wrong = || "expected two positive numbers, as in `1:2`".to_owned();
    let (drawn, of) = text.split_once(':').ok_or_else(wrong)?;
    let number = |text: &str| positive(text.trim()).map_err(|_| wrong());
    Ok(Scale {
        drawn: number(drawn)?,
        of: number(of)?,
    })
}
