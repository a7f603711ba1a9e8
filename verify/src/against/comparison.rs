//! The comparison of stated measures with the true ones.

use super::answer::StatedMeasures;
use crate::generator::model::PartModel;
use crate::trial::{TrialMeasures, diagonal};
use serde::{Deserialize, Serialize};
use std::fmt;

/// A compared measure.
#[derive(Clone, Copy, Debug, Deserialize, Eq, Ord, PartialEq, PartialOrd, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum ComparedMeasure {
    /// The volume.
    Volume,
    /// The area.
    Area,
    /// The coordinate of the box that differs most.
    Bounds,
    /// The number of connected solids.
    Solids,
}

impl ComparedMeasure {
    /// Every measure.
    pub const ALL: [Self; 4] = [Self::Volume, Self::Area, Self::Bounds, Self::Solids];

    /// The name, as it is written in the summary.
    pub fn name(self) -> &'static str {
        match self {
            Self::Volume => "volume",
            Self::Area => "area",
            Self::Bounds => "bounds",
            Self::Solids => "solids",
        }
    }
}

/// A measure that differs by more than the tolerance.
#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Serialize)]
pub struct MeasureDifference {
    /// Which measure.
    pub measure: ComparedMeasure,
    /// The stated value.
    pub theirs: f64,
    /// The true value.
    pub ours: f64,
    /// The difference relative to the value that the tolerance is relative to.
    pub relative: f64,
}

impl fmt::Display for MeasureDifference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            measure,
            theirs,
            ours,
            relative,
        } = self;
        let name = measure.name();
        match measure {
            ComparedMeasure::Solids => write!(f, "{theirs} solids, expected {ours}"),
            _ => write!(f, "{name} {theirs}, expected {ours}: off by {relative:.1e}"),
        }
    }
}

/// What is known of a part, and how exactly.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct KnownPart {
    /// The true measures.
    pub measures: TrialMeasures,
    /// The diagonal of the part's box; that of its primitives where the part is empty.
    size: f64,
    /// The number of primitives.
    primitives: usize,
    /// The distance by which a face may lie elsewhere, because coordinates are rounded.
    displacement: f64,
}

impl KnownPart {
    /// A part whose faces may lie elsewhere by a distance.
    pub fn new(model: &PartModel, measures: TrialMeasures, displacement: f64) -> Self {
        let size = match measures.bounds {
            Some([low, high]) => {
                let squares = (0..3).map(|i| (high[i] - low[i]).powi(2));
                squares.sum::<f64>().sqrt()
            }
            None => diagonal(&[model]),
        };
        Self {
            measures,
            size,
            primitives: model.leaves().count(),
            displacement,
        }
    }

    /// The measures that differ by more than a relative tolerance, the accuracy that is stated with
    /// them, and the effect of the rounding of coordinates.
    pub fn differences(&self, stated: &StatedMeasures, tolerance: f64) -> Vec<MeasureDifference> {
        let tolerance = tolerance + stated.accuracy.relative;
        let known = &self.measures;
        let compare = |measure, theirs: Option<f64>, ours: f64, scale: f64, more: f64| {
            let theirs = theirs?;
            let off = (theirs - ours).abs();
            let allowed = tolerance * scale + more;
            // A value that is no number differs.
            let differs = off.is_nan() || off > allowed;
            differs.then(|| MeasureDifference {
                measure,
                theirs,
                ours,
                relative: off / scale,
            })
        };
        let scale = |value: f64, whole: f64| value.abs().max(whole / SMALL).max(f64::MIN_POSITIVE);
        let volume = compare(
            ComparedMeasure::Volume,
            stated.volume,
            known.volume,
            scale(known.volume, self.size.powi(3)),
            stated.accuracy.volume + self.moved_volume(),
        );
        let area = compare(
            ComparedMeasure::Area,
            stated.area,
            known.area,
            scale(known.area, self.size.powi(2)),
            stated.accuracy.area + self.moved_area(),
        );
        let more = LAYERS * self.displacement;
        let bounds = stated.bounds.zip(known.bounds).and_then(|(theirs, ours)| {
            let of = |bounds: [[f64; 3]; 2]| bounds.into_iter().flatten();
            let each = of(theirs).zip(of(ours)).filter_map(|(theirs, ours)| {
                let measure = ComparedMeasure::Bounds;
                compare(measure, Some(theirs), ours, scale(self.size, 0.0), more)
            });
            each.max_by(|a, b| a.relative.total_cmp(&b.relative))
        });
        let solids = stated.solids.filter(|n| *n != known.solids as u64);
        let solids = solids.map(|theirs| MeasureDifference {
            measure: ComparedMeasure::Solids,
            theirs: theirs as f64,
            ours: known.solids as f64,
            relative: 1.0,
        });
        [volume, area, bounds, solids]
            .into_iter()
            .flatten()
            .collect()
    }

    /// The volume of layers on the faces that rounded coordinates make.
    fn moved_volume(&self) -> f64 {
        LAYERS * self.measures.area * self.displacement
    }

    /// The area of steps along the outlines of the primitives that rounded coordinates make.
    fn moved_area(&self) -> f64 {
        let outlines = SIDES * self.size * self.primitives as f64;
        LAYERS * outlines * self.displacement
    }
}

/// The number of displaced layers on a face: of the face, of the one it touches, and of a cut.
const LAYERS: f64 = 3.0;

/// The length of the outline of a primitive's faces within a part, in diagonals of the part.
const SIDES: f64 = 4.0;

/// A volume or an area less than one part in so many of the box's is compared relative to that.
const SMALL: f64 = 1000.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generator::model::ModelPrimitive;

    const TOLERANCE: f64 = 1.0 / 1_000_000.0;

    fn known(displacement: f64) -> KnownPart {
        let model = PartModel::new(ModelPrimitive::Block([1.0, 2.0, 2.0]), Vec::new());
        let measures = TrialMeasures {
            volume: 4.0,
            area: 16.0,
            bounds: Some([[0.0; 3], [1.0, 2.0, 2.0]]),
            solids: 1,
        };
        KnownPart::new(&model, measures, displacement)
    }

    fn stated(volume: f64) -> StatedMeasures {
        StatedMeasures {
            volume: Some(volume),
            ..StatedMeasures::default()
        }
    }

    fn wrong(known: &KnownPart, stated: &StatedMeasures) -> Vec<ComparedMeasure> {
        let differences = known.differences(stated, TOLERANCE);
        differences.iter().map(|d| d.measure).collect()
    }

    #[test]
    fn what_is_stated_is_compared() {
        let known = known(0.0);
        assert_eq!(wrong(&known, &stated(4.000_003)), []);
        assert_eq!(wrong(&known, &stated(4.000_005)), [ComparedMeasure::Volume]);
        assert_eq!(wrong(&known, &stated(f64::NAN)), [ComparedMeasure::Volume]);
        let other = StatedMeasures {
            area: Some(15.0),
            bounds: Some([[0.0; 3], [1.0, 2.0, 2.1]]),
            solids: Some(2),
            ..stated(4.0)
        };
        let all = [
            ComparedMeasure::Area,
            ComparedMeasure::Bounds,
            ComparedMeasure::Solids,
        ];
        assert_eq!(wrong(&known, &other), all);
        let text = known.differences(&other, TOLERANCE)[1].to_string();
        assert_eq!(text, "bounds 2.1, expected 2: off by 3.3e-2");
    }

    #[test]
    fn facets_and_rounded_coordinates_are_allowed_for() {
        let mut facets = stated(4.01);
        facets.accuracy.volume = 0.02;
        assert_eq!(wrong(&known(0.0), &facets), []);
        facets.accuracy = Default::default();
        facets.accuracy.relative = 0.01;
        assert_eq!(wrong(&known(0.0), &facets), []);
        assert_eq!(wrong(&known(0.001), &stated(4.01)), []);
        assert_eq!(
            wrong(&known(0.0001), &stated(4.01)),
            [ComparedMeasure::Volume]
        );
    }

    #[test]
    fn an_empty_part_has_the_size_of_its_primitives() {
        let model = PartModel::new(ModelPrimitive::Sphere(1.0), Vec::new());
        let measures = TrialMeasures {
            volume: 0.0,
            area: 0.0,
            bounds: None,
            solids: 0,
        };
        let known = KnownPart::new(&model, measures, 0.0);
        assert_eq!(wrong(&known, &stated(1e-12)), []);
        assert_eq!(wrong(&known, &stated(0.001)), [ComparedMeasure::Volume]);
    }
}
