//! Places in a range at which functions are sampled.

use super::float::Float;

/// The number of probes: more than twice the number of zeros that any function along the curves can
/// have. A function that is within the resolution at so many probes is so in between.
const PROBES: u32 = 67;

/// Fractions of a range by golden-section steps: the first few are already far from each other.
pub fn probes<N: Float>() -> impl Iterator<Item = N> {
    (1..=PROBES).map(|k| (N::whole(k) * N::from_f64(0.618_033_988_749_895)).fract())
}
