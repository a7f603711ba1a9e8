//! The options of an evaluation, and what they mean for the part.

use super::{Arithmetic, EvaluationError, EvaluationOptions, MAX_ENTITIES};
use premio_kernel::geometry::bounds::Aabb;
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{
    CoincidencePolicy, Compare, Predicates, RELATIVE_RESOLUTION,
};

/// The options of an evaluation, for every component of the part.
#[derive(Clone, Copy, Debug)]
pub(super) struct Settings {
    /// The requested resolution.
    pub requested: Option<f64>,
    /// The size of the part. Tools that are far larger than their result do not count.
    pub size: f64,
    /// The relative noise of the coordinates.
    pub noise: f64,
    /// The coincidence policy.
    pub zeros: CoincidencePolicy,
    /// The arithmetic of the decisions.
    pub digits: Arithmetic,
    /// The maximum number of curves and points of curves of a component.
    pub entity_limit: usize,
}

impl Settings {
    /// The options for a part of a size.
    pub fn new(options: &EvaluationOptions, size: f64) -> Self {
        Self {
            requested: options.resolution,
            size,
            noise: options.noise.unwrap_or(0.0),
            zeros: options.zeros,
            digits: options.digits,
            entity_limit: options.entity_limit.unwrap_or(MAX_ENTITIES),
        }
    }

    /// The same with a requested resolution.
    pub fn with_resolution(&self, resolution: f64) -> Self {
        Self {
            requested: Some(resolution),
            ..*self
        }
    }

    /// The same for coordinates that are exact.
    pub fn without_noise(&self) -> Self {
        Self {
            noise: 0.0,
            ..*self
        }
    }

    /// The resolution where none is requested and the part is near the origin.
    pub fn default_resolution(&self) -> f64 {
        self.resolution_for(self.size)
    }

    /// The default resolution for a size.
    fn resolution_for(&self, size: f64) -> f64 {
        RELATIVE_RESOLUTION.max(self.noise) * size
    }

    /// The distance beyond which faces are not compared; `None` if the requested resolution is
    /// invalid.
    pub fn gap(&self) -> Option<f64> {
        let resolution = self.requested.unwrap_or(self.default_resolution());
        let is_valid = resolution.lies_in([0.0, self.size]);
        is_valid.then(|| Predicates::new(resolution).reach())
    }

    /// The requested resolution, or the default for a component in a box. The default is coarser if
    /// the component is so far from the origin that its coordinates are rounded by more.
    pub fn resolution<N: Float>(&self, bounds: &Aabb) -> Result<f64, EvaluationError> {
        let size = self.size.max(bounds.diagonal());
        let far = bounds.min.iter().chain(&bounds.max);
        let far = far.fold(bounds.diagonal(), |far, x| far.max(x.abs()));
        let (least, most) = (N::ROUNDING.rounded() * far, COARSEST * size);
        if least.is_beyond(size * FARTHEST) {
            return Err(EvaluationError::TooFarFromOrigin { far, size });
        }
        let default = self.resolution_for(size).max(least);
        let resolution = self.requested.unwrap_or(default);
        if !resolution.lies_in([least, most]) {
            return Err(EvaluationError::Resolution {
                asked: resolution,
                least,
                most,
            });
        }
        Ok(resolution)
    }
}

/// The coarsest resolution, relative to the part's size.
const COARSEST: f64 = 0.01;

/// The greatest rounding of coordinates, relative to the part's size.
const FARTHEST: f64 = 1.0 / (1 << 20) as f64;
