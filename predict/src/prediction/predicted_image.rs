//! The data of a prediction: arcs, regions, and the levels of the pixels next to the arcs.

use crate::feature::arc_raster::ArcRaster;
use crate::feature::contrast::{Contrast, contrast};
use crate::feature::detected_arc::{DetectedArc, DetectionState, evidence};
use crate::feature::reason::{Measure, Reason, reason};
use crate::highlight::add_highlights;
use crate::image::blur::{self, blur, blur_by};
use crate::image::exposure::expose;
use crate::image::response::respond;
use crate::image::shading::{Finishes, Shading};
use crate::image_arcs::flatten::ImageWindow;
use crate::image_arcs::lit_scene::{Eyes, StageError};
use crate::image_arcs::shadow::add_shadows;
use crate::image_arcs::{LitScene, PredictedArc, Regions};
use crate::prepared_part::PreparedPart;
use crate::setup::{Conditions, Setup};
use crate::statistics::hash;
use premio_detect::{Detection, Grey, PixelMask, Workspace};
use std::cell::RefCell;

/// What a prediction is made of.
#[derive(Debug)]
pub struct PredictedImage<'s> {
    /// The part in front of its camera and under its lights.
    pub stage: &'s LitScene<'s>,
    /// The conditions.
    pub conditions: &'s Conditions,
    /// The light of every point.
    pub shading: Shading<'s>,
    /// The arcs: pieces of contours, boundaries of shadows, outlines of highlights.
    pub arcs: Vec<PredictedArc>,
    /// The regions between them.
    pub regions: Regions,
    /// Their pixels.
    pub ink: ArcRaster,
    /// The pixels that are predicted.
    pub domain: PixelMask,
    /// Their levels before noise and steps.
    pub image: Grey,
    memory: RefCell<Memory>,
}

/// The memory of one prediction, reused by the next one.
#[derive(Debug, Default)]
pub struct Memory {
    levels: Vec<f32>,
    noisy: Vec<f32>,
    across: Vec<f32>,
    ink: Vec<u32>,
    detector: Workspace,
}

/// What the detector finds in one image.
#[derive(Clone, Debug)]
pub struct ImageEvidence {
    /// The detection.
    pub(crate) detection: Detection,
    /// By arc: the edges found of it.
    pub arcs: Vec<DetectedArc>,
}

/// The detections of each arc over noise draws.
#[derive(Clone, Debug)]
pub struct DetectionOutcome {
    /// The detection in one draw, in which each arc has its most frequent state.
    pub detection: Detection,
    /// By arc: its detection in the first draw with its most frequent state.
    pub evidence: Vec<DetectedArc>,
    /// By arc: the number of each state, in the order of [`DetectionState::ALL`].
    pub counts: Vec<[u32; 3]>,
}

/// Evaluates a function on the predicted image of a part in a setup.
///
/// `finishes` are those of the setup's conditions, where they are already known, as for many
/// setups.
///
/// # Errors
/// The setup cannot be used, the camera or a light has no view of the part, or the image does not
/// show it.
pub fn with_draft<T>(
    subject: &PreparedPart<'_>,
    finishes: Option<&Finishes>,
    setup: &Setup,
    memory: &mut Memory,
    ask: impl FnOnce(&PredictedImage<'_>) -> T,
) -> Result<T, StageError> {
    let eyes = Eyes::new(subject, setup)?;
    let stage = LitScene::new(subject, &eyes)?;
    let own;
    let finishes = match finishes {
        Some(known) => known,
        None => {
            own = Finishes::new(subject, &setup.conditions)?;
            &own
        }
    };
    let draft =
        PredictedImage::within(&stage, finishes, &setup.conditions, std::mem::take(memory))?;
    let answer = ask(&draft);
    *memory = draft.into_memory();
    Ok(answer)
}

impl<'s> PredictedImage<'s> {
    /// The predicted image of a scene under conditions, in memory that [`Self::into_memory`]
    /// returns.
    fn within(
        stage: &'s LitScene<'s>,
        finishes: &'s Finishes,
        conditions: &'s Conditions,
        mut memory: Memory,
    ) -> Result<Self, StageError> {
        let sensor = &conditions.sensor;
        let size = sensor.resolution;
        let window = ImageWindow::new(size);
        let mut arcs = stage.arcs(&window);
        add_shadows(stage, &window, &mut arcs);
        let regions = Regions::new(stage, &arcs, size);
        let shading = Shading::new(stage, finishes, conditions)?;
        add_highlights(&shading, &regions, conditions, &mut arcs);
        let ink = ArcRaster::within(&arcs, size, std::mem::take(&mut memory.ink));
        if ink.pixels.is_empty() {
            return Err(StageError::OutOfSight(out_of_sight(stage, size)));
        }
        let margin = conditions.features.reach.ceil() as usize + conditions.detector.radius();
        let near = ink.bitmap().grown(margin);
        let domain = near.domain();
        let mut levels = std::mem::take(&mut memory.levels);
        levels.resize(size[0] * size[1], 0.0);
        let mut image = Grey {
            width: size[0],
            height: size[1],
            levels,
        };
        let reach = blur::reach(sensor.blur);
        let around = if reach > 0 {
            near.grown(reach).domain()
        } else {
            domain.clone()
        };
        expose(&shading, &regions, &around, &mut image);
        blur_by(&mut image, &domain, sensor.blur, &mut memory.across);
        Ok(Self {
            stage,
            conditions,
            shading,
            arcs,
            regions,
            ink,
            domain,
            image,
            memory: RefCell::new(memory),
        })
    }

    /// Returns its memory.
    fn into_memory(self) -> Memory {
        Memory {
            levels: self.image.levels,
            ink: self.ink.into_memory(),
            ..self.memory.into_inner()
        }
    }

    /// The detections of each arc over noise draws.
    pub(crate) fn outcome(&self) -> DetectionOutcome {
        let sensor = &self.conditions.sensor;
        let noisy = sensor.electrons > 0.0 || sensor.read_noise > 0.0;
        let draws = if noisy {
            self.conditions.features.draws
        } else {
            1
        };
        let mut counts = vec![[0u32; 3]; self.arcs.len()];
        let mut all = Vec::new();
        for draw in 0..draws {
            let mut image = Grey {
                levels: std::mem::take(&mut self.memory.borrow_mut().noisy),
                ..self.image
            };
            image.levels.clear();
            image.levels.extend_from_slice(&self.image.levels);
            let seed = hash(self.conditions.seed, u64::from(draw), 0);
            respond(&mut image, &self.domain, sensor, seed);
            let evidence = self.evidence_in(&image, &self.domain);
            for (count, found) in counts.iter_mut().zip(&evidence.arcs) {
                count[found.state.index()] += 1;
            }
            all.push(evidence);
            self.memory.borrow_mut().noisy = image.levels;
        }
        let usual: Vec<DetectionState> = counts.iter().map(usual).collect();
        let off = |evidence: &&ImageEvidence| {
            let arcs = evidence.arcs.iter();
            arcs.zip(&usual).filter(|(e, s)| e.state != **s).count()
        };
        let best = all
            .iter()
            .min_by_key(off)
            .map(|evidence| evidence.detection.clone());
        let shown = |i: usize| {
            let found = all.iter().find(|e| e.arcs[i].state == usual[i]);
            found.map(|e| e.arcs[i].clone())
        };
        DetectionOutcome {
            detection: best.unwrap_or_default(),
            evidence: (0..self.arcs.len()).filter_map(shown).collect(),
            counts,
        }
    }

    /// The detections of each arc in an image of the same setup: predicted, rendered or taken.
    pub fn evidence_in(&self, image: &Grey, domain: &PixelMask) -> ImageEvidence {
        let detector = &self.conditions.detector;
        let work = &mut self.memory.borrow_mut().detector;
        let detection = detector.detect_with(work, image, domain);
        let found = evidence(&detection, detector, &self.conditions.features, &self.ink);
        ImageEvidence {
            detection,
            arcs: found,
        }
    }

    /// The brightness on both sides along an arc.
    pub(crate) fn contrast(&self, arc: usize) -> Vec<Contrast> {
        let [start, end] = self.ink.spans[arc];
        match start <= end {
            true => contrast(
                &self.shading,
                &self.regions,
                arc,
                &self.arcs[arc],
                [start, end],
            ),
            false => Vec::new(),
        }
    }

    /// Why an arc is not whole.
    pub(crate) fn reason(
        &self,
        arc: usize,
        evidence: &[DetectedArc],
        contrast: &[Contrast],
        measure: &Measure,
    ) -> Option<Reason> {
        reason(arc, evidence, contrast, &self.ink, measure)
    }

    /// The quantities that determine reasons.
    pub(crate) fn measure(&self) -> Measure {
        let (sensor, detector) = (&self.conditions.sensor, &self.conditions.detector);
        Measure {
            top: f64::from(sensor.levels - 1),
            needed: detector.threshold / step_response(self.conditions),
            shortest: detector.shortest,
            radius: detector.radius(),
        }
    }
}

/// The most frequent state; of equal ones the better one.
pub fn usual(counts: &[u32; 3]) -> DetectionState {
    let most = counts.iter().max().copied().unwrap_or(0);
    let found = DetectionState::ALL
        .into_iter()
        .find(|s| counts[s.index()] == most);
    found.unwrap_or(DetectionState::Missed)
}

/// The gradient that the detector finds at a step of one level.
fn step_response(conditions: &Conditions) -> f64 {
    let reach = blur::reach(conditions.sensor.blur);
    let half = 2 * (reach + conditions.detector.radius()) + 4;
    let size = 2 * half + 1;
    // Higher than one, so that no threshold of the detector's own matters.
    let high = 4096.0;
    let row = (0..size).map(|x| match x.cmp(&half) {
        std::cmp::Ordering::Less => 0.0,
        std::cmp::Ordering::Equal => 0.5 * high,
        std::cmp::Ordering::Greater => high,
    });
    let row: Vec<f32> = row.collect();
    let mut step = Grey {
        width: size,
        height: size,
        levels: (0..size).flat_map(|_| row.iter().copied()).collect(),
    };
    let all = PixelMask::full(size, size);
    blur(&mut step, &all, conditions.sensor.blur);
    let detector = premio_detect::Detector {
        threshold: 1.0,
        low: None,
        ..conditions.detector.clone()
    };
    let strengths = detector.detect(&step, &all).pixels;
    let strengths = strengths.iter().map(|p| p.gradient[0].hypot(p.gradient[1]));
    let most = strengths.fold(0.0, f64::max);
    if most > 0.0 {
        most / f64::from(high)
    } else {
        0.5
    }
}

/// The position of the part, if none of its arcs is in the image.
fn out_of_sight(stage: &LitScene<'_>, [width, height]: [usize; 2]) -> String {
    let projection = stage.view.scene.projection;
    let middle = [width, height].map(|n| 0.5 * (n as f64 - 1.0));
    if stage.seen(middle).is_some() {
        return "it fills the image, and none of its contours is in it".to_owned();
    }
    if projection.depth(&stage.subject.centre) <= 0.0 {
        return "it lies behind the camera".to_owned();
    }
    let p = projection.project(&stage.subject.centre);
    format!(
        "its centre projects to ({:.0}, {:.0}), and the image has {width} x {height} pixels",
        p.x, p.y
    )
}
