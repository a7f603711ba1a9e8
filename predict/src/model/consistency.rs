//! Consistency checks of the records of a model.

use super::observation::{ATTRIBUTES, Observation};
use super::record::{
    Aspect, Attributes, Codetection, DescriptionRecord, FeatureRecord, ModelHead, NO_DIGEST, Rate,
    Record, RelationRecord, SCHEMA,
};
use super::summary::MAX_PAIRED;
use crate::image_arcs::ArcSource;
use crate::setup::setups::Setups;
use premio_kernel::brep::Brep;
use premio_text::number;

/// A value that is inconsistent with the rest.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("`{key}` {reason}")]
pub struct Inconsistency {
    /// Its path of keys in the record.
    pub key: String,
    /// The error.
    pub reason: String,
}

type Checked = Result<(), Inconsistency>;

fn check(is_met: bool, key: impl Into<String>, reason: impl Into<String>) -> Checked {
    match is_met {
        true => Ok(()),
        false => Err(Inconsistency {
            key: key.into(),
            reason: reason.into(),
        }),
    }
}

/// The numbers of edges, faces and lights, which limit the sources of features.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SourceLimits {
    edges: usize,
    faces: usize,
    lights: usize,
}

impl SourceLimits {
    /// No limits, where neither part nor setups are known.
    pub const NONE: Self = Self {
        edges: usize::MAX,
        faces: usize::MAX,
        lights: usize::MAX,
    };

    /// Those of a part.
    pub fn of_part(brep: &Brep) -> Self {
        Self {
            edges: brep.topology.edges.len(),
            faces: brep.topology.faces.len(),
            ..Self::NONE
        }
    }

    /// Those of setups.
    pub(crate) fn of_setups(setups: &Setups) -> Self {
        Self::NONE.with_setups(setups)
    }

    /// The limits with those of setups.
    #[must_use]
    pub fn with_setups(self, setups: &Setups) -> Self {
        let lights = setups.lights.len() + usize::from(setups.illumination.is_some());
        Self { lights, ..self }
    }

    /// Checks that the source of a feature exists.
    ///
    /// # Errors
    /// It is beyond the limits.
    pub(crate) fn check(&self, key: &str, source: &ArcSource) -> Result<(), Inconsistency> {
        let [face, caster] = [source.face(), source.caster()];
        let all = [
            source.edge().map(|id| ("edge", id.0, self.edges, "edges")),
            face.map(|id| ("face", id.0, self.faces, "faces")),
            caster.map(|id| ("caster", id.0, self.faces, "faces")),
            source
                .light()
                .map(|light| ("light", light, self.lights, "lights")),
        ];
        for (name, number, count, what) in all.into_iter().flatten() {
            let reason = format!("is {number}, and there are {count} {what}");
            check((number as usize) < count, format!("{key}.{name}"), reason)?;
        }
        Ok(())
    }
}

/// Checks that a description is consistent.
///
/// # Errors
/// Its resolution is no distance.
pub fn check_description(description: &DescriptionRecord) -> Result<(), Inconsistency> {
    let Some(resolution) = description.resolution else {
        return Ok(());
    };
    positive("description.resolution", resolution)?;
    let reason = "is given together with `exact`, expected one of them";
    check(!description.exact, "description.resolution", reason)
}

/// Checks that an observation is consistent.
///
/// # Errors
/// A value is out of its range, or features are not in order.
pub fn check_observation(observation: &Observation, limits: &SourceLimits) -> Checked {
    let sights = &observation.sights;
    for (i, sight) in sights.iter().enumerate() {
        let key = |name: &str| format!("sights[{i}].{name}");
        limits.check(&key("source"), &sight.source)?;
        let is_next = i == 0 || sights[i - 1].source < sight.source;
        check(is_next, key("source"), "is out of order or repeated")?;
        positive(&key("length"), sight.length)?;
        share(&key("share"), sight.share)?;
        for growth in sight.growth.iter().flatten() {
            positive(&key("growth"), *growth)?;
        }
    }
    for (i, tuple) in observation.tuples.iter().enumerate() {
        let key = format!("tuples[{i}].members");
        check(tuple.members.len() > 1, &*key, "are fewer than two")?;
        for member in &tuple.members {
            let reason = format!("has {member}, and there are {} sights", sights.len());
            check((*member as usize) < sights.len(), &*key, reason)?;
        }
    }
    let [near, pairs] = observation.chance;
    check(near <= pairs, "chance", "counts more near pairs than pairs")?;
    for deviation in observation.pose.iter().flatten() {
        positive("pose", *deviation)?;
    }
    let is_nothing = observation.unseen.is_none() || sights.is_empty();
    check(is_nothing, "unseen", "is given together with sights")
}

/// The checker of a model's records: it counts the records of each kind.
#[derive(Clone, Debug)]
pub(crate) struct Consistency {
    head: ModelHead,
    features: usize,
    aspects: usize,
    tuples: usize,
    codetections: usize,
}

impl Consistency {
    /// Begins with the head of a model.
    ///
    /// # Errors
    /// It is inconsistent.
    pub fn new(head: &ModelHead) -> Result<Self, Inconsistency> {
        let schema = format!("is \"{}\", expected \"{SCHEMA}\"", head.schema);
        check(head.schema == SCHEMA, "schema", schema)?;
        check_description(&head.description)?;
        let setups = head.setups.len() as u64;
        let reason = format!("is {}, and there are {setups} setups", head.count);
        check(head.count == setups, "count", reason)?;
        let unseen = head
            .unseen
            .values()
            .try_fold(0u64, |sum, n| sum.checked_add(*n));
        let fits = |n: Option<u64>| n.is_some_and(|n| n <= head.count);
        check(
            fits(unseen),
            "unseen",
            "counts more setups than the model has",
        )?;
        check(
            fits(Some(head.posed)),
            "posed",
            "counts more setups than the model has",
        )?;
        let others = fits(Some(head.other_aspects));
        check(
            others,
            "other_aspects",
            "counts more setups than the model has",
        )?;
        share("chance", head.chance)?;
        let positive = |pose: [f64; 2]| pose.iter().all(|x| *x >= 0.0);
        check(head.pose.is_none_or(positive), "pose", "is below zero")?;
        let digits = head.sha256.len() == NO_DIGEST.len();
        let digits = digits && head.sha256.bytes().all(|b| b.is_ascii_hexdigit());
        check(digits, "sha256", "is not 64 hexadecimal digits")?;
        Ok(Self {
            head: head.clone(),
            features: 0,
            aspects: 0,
            tuples: 0,
            codetections: 0,
        })
    }

    /// Checks the next record.
    ///
    /// # Errors
    /// It is inconsistent with the head or an earlier record.
    pub fn next(&mut self, record: &Record) -> Checked {
        match record {
            Record::Model(_) => check(false, "record", "is `model` twice, expected it once"),
            Record::Feature(feature) => {
                ranked(feature.rank, &mut self.features, self.head.features)?;
                self.feature(feature)
            }
            Record::Aspect(aspect) => {
                ranked(aspect.rank, &mut self.aspects, self.head.aspects)?;
                self.aspect(aspect)
            }
            Record::Tuple(tuple) => {
                ranked(tuple.rank, &mut self.tuples, self.head.tuples)?;
                self.tuple(tuple)
            }
            Record::Codetection(codetection) => {
                self.codetections += 1;
                let once = self.codetections == 1;
                check(once, "record", "is `codetection` twice, expected it once")?;
                self.codetection(codetection)
            }
        }
    }

    /// Checks that all records that the head counts were present; the key of an error is one of the
    /// head.
    ///
    /// # Errors
    /// Some are missing.
    pub fn finish(&self) -> Checked {
        let counts = [
            ("features", self.features, self.head.features),
            ("aspects", self.aspects, self.head.aspects),
            ("tuples", self.tuples, self.head.tuples),
        ];
        for (key, found, expected) in counts {
            let reason = format!("is {expected}, and {found} of them follow");
            check(found == expected, key, reason)?;
        }
        let reason = "is `codetection` in no line, expected one such line";
        check(self.codetections == 1, "record", reason)
    }

    fn feature(&self, feature: &FeatureRecord) -> Checked {
        let visible = self.states("states", &feature.states)?;
        rate("detectability", &feature.detectability, self.head.count)?;
        rate(
            "detectability_visible",
            &feature.detectability_visible,
            visible,
        )?;
        rate("reliability", &feature.reliability, feature.reliability.of)?;
        let grows = |g: [f64; 2]| g.iter().all(|x| *x >= 0.0);
        check(
            feature.accuracy.is_none_or(grows),
            "accuracy",
            "is below zero",
        )?;
        let counted = feature
            .fragments
            .iter()
            .try_fold(0u64, |sum, n| sum.checked_add(*n));
        let within = counted.is_some_and(|n| n <= self.head.count);
        check(within, "fragments", "count more setups than the model has")?;
        share("share", feature.share)?;
        SourceLimits::of_setups(&self.head.setups).check("source", &feature.source)?;
        attributes("attributes", feature.attributes.as_ref())
    }

    fn aspect(&self, aspect: &Aspect) -> Checked {
        let reason = "is more than the model has";
        check(aspect.setups <= self.head.count, "setups", reason)?;
        check(aspect.view.len() == 3, "view", "has not three numbers")?;
        for (i, feature) in aspect.features.iter().enumerate() {
            let key = |name: &str| format!("features[{i}].{name}");
            self.rank(&key("feature"), feature.feature)?;
            self.states(&key("states"), &feature.states)?;
            rate(&key("detectability"), &feature.detectability, aspect.setups)?;
            attributes(&key("attributes"), feature.attributes.as_ref())?;
        }
        Ok(())
    }

    fn tuple(&self, tuple: &RelationRecord) -> Checked {
        for (i, member) in tuple.members.iter().enumerate() {
            self.rank(&format!("members[{i}]"), *member)?;
        }
        check(tuple.members.len() > 1, "members", "are fewer than two")?;
        let [visible, seen, kept] = tuple.counts;
        let ordered = kept <= seen && seen <= visible;
        check(
            ordered,
            "counts",
            "grow: more are kept than seen, or seen than visible",
        )?;
        rate("kept", &tuple.kept, seen)?;
        share("chance", tuple.chance)
    }

    fn codetection(&self, codetection: &Codetection) -> Checked {
        let (found, expected) = (codetection.tree.len(), self.head.features.min(MAX_PAIRED));
        let reason = format!("has {found} features, expected {expected}");
        check(found == expected, "tree", reason)?;
        for (i, node) in codetection.tree.iter().enumerate() {
            let key = |name: &str| format!("tree[{i}].{name}");
            self.rank(&key("feature"), node.feature)?;
            if let Some(parent) = node.parent {
                self.rank(&key("parent"), parent)?;
                let before = codetection.tree[..i].iter().any(|n| n.feature == parent);
                check(before, key("parent"), "is not before it")?;
            }
            check(
                node.marginal.len() == 3,
                key("marginal"),
                "has not three numbers",
            )?;
            let square = node.table.iter().all(|row| row.len() == 3);
            // A feature without a parent has no table.
            let rows = node.table.len();
            let is_whole = square && (rows == 3 || rows == 0 && node.parent.is_none());
            check(is_whole, key("table"), "is not three by three")?;
            for value in node.marginal.iter().chain(node.table.iter().flatten()) {
                share(&key("table"), *value)?;
            }
        }
        Ok(())
    }

    fn rank(&self, key: &str, feature: usize) -> Checked {
        let count = self.head.features;
        let reason = format!("is {feature}, and there are {count} features");
        check(feature < count, key, reason)
    }

    /// The checked sum of counts of setups.
    fn states(&self, key: &str, states: &[u64; 3]) -> Result<u64, Inconsistency> {
        let sum = states.iter().try_fold(0u64, |sum, n| sum.checked_add(*n));
        let within = sum.filter(|sum| *sum <= self.head.count);
        check(
            within.is_some(),
            key,
            "count more setups than the model has",
        )?;
        Ok(within.unwrap_or_default())
    }
}

fn ranked(rank: usize, known: &mut usize, expected: usize) -> Checked {
    let reason = format!("is {rank}, expected {known}");
    check(rank == *known, "rank", reason)?;
    let reason = format!("is {rank}, and the head counts {expected}");
    check(rank < expected, "rank", reason)?;
    *known += 1;
    Ok(())
}

fn positive(key: &str, value: f64) -> Checked {
    let reason = format!("is {}, and must be above 0", number(value));
    check(value.is_finite() && value > 0.0, key, reason)
}

fn share(key: &str, value: f64) -> Checked {
    let reason = format!("is {}, and must be 0 to 1", number(value));
    check((0.0..=1.0).contains(&value), key, reason)
}

fn rate(key: &str, rate: &Rate, of: u64) -> Checked {
    let reason = format!("is {}, expected {of}", rate.of);
    check(rate.of == of, format!("{key}.of"), reason)?;
    share(&format!("{key}.mean"), rate.mean)?;
    let [low, high] = rate.interval;
    let ordered = 0.0 <= low && low <= high && high <= 1.0;
    check(
        ordered,
        format!("{key}.interval"),
        "is no interval of 0 to 1",
    )
}

fn attributes(key: &str, attributes: Option<&Attributes>) -> Checked {
    let Some(attributes) = attributes else {
        return Ok(());
    };
    let reason = format!("has not {ATTRIBUTES} numbers");
    let is_whole = attributes.mean.len() == ATTRIBUTES;
    check(is_whole, format!("{key}.mean"), reason)?;
    let rows = &attributes.covariance;
    let square = rows.len() == ATTRIBUTES && rows.iter().all(|row| row.len() == ATTRIBUTES);
    let reason = format!("is not {ATTRIBUTES} by {ATTRIBUTES}");
    check(square, format!("{key}.covariance"), reason)?;
    check(attributes.count > 0, format!("{key}.count"), "is 0")
}
