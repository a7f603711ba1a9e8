//! Which circles are meant as polygons, by `$fn`, `$fa` and `$fs`.

use std::ops::Range;

use premio_kernel::number::rational::{Rational, to_f64};

use super::super::FacetLimit;
use super::super::error::SpannedError;
use super::super::notes::Notes;
use super::arguments::Arguments;

/// Decides which circles are polygons, and counts them.
pub(super) struct FacetRule {
    limit: FacetLimit,
    /// The nodes with `$fn` that are polygons, and those that are circles.
    counts: [usize; 2],
    first: Option<Range<usize>>,
}

/// The largest number of sides.
const MAX_SIDES: f64 = 10_000.0;

impl FacetRule {
    pub fn new(limit: FacetLimit) -> Self {
        Self {
            limit,
            counts: [0; 2],
            first: None,
        }
    }

    /// Whether OpenSCAD's own solid is wanted: every circle is a polygon, by its size.
    pub fn is_literal(&self) -> bool {
        self.limit == FacetLimit::All
    }

    /// The number of sides of the polygon that stands for a circle of this radius; `None` if it is
    /// a circle.
    pub fn sides(
        &mut self,
        arguments: &Arguments,
        radius: &Rational,
    ) -> Result<Option<u32>, SpannedError> {
        let count = match arguments.find("$fn") {
            Some(argument) => to_f64(argument.number()?),
            None => 0.0,
        };
        let is_written = count > 0.0;
        let sides = match self.limit {
            FacetLimit::None => None,
            FacetLimit::UpTo(limit) => {
                let is_polygon = is_written && count < f64::from(limit) + 1.0 && count >= 3.0;
                is_polygon.then_some(count)
            }
            FacetLimit::All => Some(fragments(arguments, to_f64(radius))?),
        };
        if is_written {
            self.counts[usize::from(sides.is_none())] += 1;
            self.first.get_or_insert(arguments.span.clone());
        }
        Ok(sides.map(|sides| sides.min(MAX_SIDES) as u32))
    }

    /// Says what circles were taken for.
    pub fn remark(&self, notes: &mut Notes) {
        let [polygons, circles] = self.counts;
        let Some(span) = &self.first else { return };
        if polygons > 0 {
            let text = format!(
                "round nodes with `$fn`: {polygons} read as polygons, {circles} as true circles \
                 (`--facets` moves the limit)"
            );
            notes.add(text, span.clone());
        }
    }
}

/// How finely a node is cut into segments: `$fn`, `$fa` and `$fs`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fineness {
    /// The number of segments of a whole turn; `None` if the other two limit it.
    pub sides: Option<f64>,
    /// The least angle of a segment in degrees.
    pub angle: f64,
    /// The least length of a segment.
    pub length: f64,
}

impl Fineness {
    /// The least value of `$fa` and `$fs`.
    const LEAST: f64 = 0.01;

    pub fn new(arguments: &Arguments) -> Result<Self, SpannedError> {
        let number = |name: &str, default: f64| match arguments.find(name) {
            Some(argument) => Ok(to_f64(argument.number()?)),
            None => Ok(default),
        };
        let sides = number("$fn", 0.0)?;
        Ok(Self {
            sides: (sides > 0.0).then_some(sides),
            angle: number("$fa", 12.0)?.max(Self::LEAST),
            length: number("$fs", 2.0)?.max(Self::LEAST),
        })
    }
}

/// The number of segments that OpenSCAD gives a circle.
pub(super) fn fragments(arguments: &Arguments, radius: f64) -> Result<f64, SpannedError> {
    let Fineness {
        sides,
        angle,
        length,
    } = Fineness::new(arguments)?;
    Ok(match sides {
        Some(sides) => sides.max(3.0).floor(),
        None => {
            let by_length = radius * std::f64::consts::TAU / length;
            (360.0 / angle).min(by_length).max(5.0).ceil()
        }
    })
}
