//! Optical constants by wavelength.

use super::Optics;
use std::ops::RangeInclusive;

/// How the optical constants of a material depend on the wavelength, which is in nanometres.
#[derive(Clone, Copy, Debug)]
pub(super) enum Dispersion {
    /// Measured values of λ, n and k, by rising λ; straight lines between them.
    Measured(&'static [[f64; 3]]),
    /// Sellmeier's equation of one term, n² − 1 = `strength` λ²/(λ² − `pole`²), over a range of λ;
    /// k = 0.
    Sellmeier {
        strength: f64,
        pole: f64,
        from: f64,
        to: f64,
    },
}

impl Dispersion {
    /// The wavelengths for which it is known.
    pub(super) fn range(self) -> RangeInclusive<f64> {
        match self {
            Self::Measured(values) => values[0][0]..=values[values.len() - 1][0],
            Self::Sellmeier { from, to, .. } => from..=to,
        }
    }

    /// The constants at a wavelength; none where it is out of the range.
    pub(super) fn at(self, wavelength: f64) -> Option<Optics> {
        if !self.range().contains(&wavelength) {
            return None;
        }
        Some(match self {
            Self::Measured(values) => {
                let next = values.partition_point(|v| v[0] <= wavelength);
                let next = next.clamp(1, values.len() - 1);
                let ([a, n, k], [b, n_next, k_next]) = (values[next - 1], values[next]);
                let part = (wavelength - a) / (b - a);
                Optics {
                    n: n + part * (n_next - n),
                    k: k + part * (k_next - k),
                }
            }
            Self::Sellmeier { strength, pole, .. } => {
                let square = wavelength * wavelength;
                Optics {
                    n: (1.0 + strength * square / (square - pole * pole)).sqrt(),
                    k: 0.0,
                }
            }
        })
    }
}

/// Aluminium: A. D. Rakić, Applied Optics 34, 4755 (1995).
pub(super) const ALUMINIUM: Dispersion = Dispersion::Measured(&[
    [309.96, 0.28003, 3.7081],
    [326.28, 0.31474, 3.9165],
    [364.66, 0.39877, 4.3957],
    [413.28, 0.52135, 5.0008],
    [442.80, 0.60790, 5.3676],
    [476.87, 0.72780, 5.7781],
    [516.60, 0.87340, 6.2418],
    [563.57, 1.0728, 6.7839],
    [619.93, 1.3660, 7.4052],
    [652.25, 1.5724, 7.7354],
    [688.81, 1.8301, 8.0601],
    [729.32, 2.1606, 8.3565],
    [774.91, 2.6154, 8.4914],
    [794.78, 2.7675, 8.3866],
    [815.69, 2.7668, 8.2573],
    [837.74, 2.6945, 8.1878],
    [885.61, 2.2802, 8.1134],
    [911.66, 1.9739, 8.3058],
    [939.28, 1.6784, 8.5970],
    [968.63, 1.4867, 9.0655],
    [999.88, 1.4359, 9.4939],
    [1033.2, 1.3998, 9.8914],
    [1127.1, 1.3281, 10.969],
]);

/// Iron: P. B. Johnson and R. W. Christy, Physical Review B 9, 5056 (1974).
pub(super) const IRON: Dispersion = Dispersion::Measured(&[
    [301.0, 1.67, 2.00],
    [311.0, 1.69, 2.06],
    [320.0, 1.74, 2.12],
    [332.0, 1.78, 2.19],
    [342.0, 1.85, 2.27],
    [354.0, 1.93, 2.35],
    [368.0, 2.02, 2.43],
    [381.0, 2.12, 2.50],
    [397.0, 2.24, 2.58],
    [413.0, 2.35, 2.65],
    [431.0, 2.48, 2.71],
    [451.0, 2.59, 2.77],
    [471.0, 2.67, 2.82],
    [496.0, 2.74, 2.88],
    [521.0, 2.86, 2.91],
    [549.0, 2.95, 2.93],
    [582.0, 2.94, 2.99],
    [617.0, 2.88, 3.05],
    [659.0, 2.92, 3.10],
    [704.0, 2.86, 3.19],
    [756.0, 2.87, 3.28],
    [821.0, 2.94, 3.39],
    [892.0, 2.96, 3.56],
    [984.0, 2.92, 3.79],
    [1088.0, 2.97, 4.06],
]);

/// Copper: P. B. Johnson and R. W. Christy, Physical Review B 6, 4370 (1972).
pub(super) const COPPER: Dispersion = Dispersion::Measured(&[
    [300.9, 1.40, 1.679],
    [310.7, 1.38, 1.729],
    [320.4, 1.38, 1.783],
    [331.5, 1.34, 1.821],
    [342.5, 1.36, 1.864],
    [354.2, 1.37, 1.916],
    [367.9, 1.36, 1.975],
    [381.5, 1.33, 2.045],
    [397.4, 1.32, 2.116],
    [413.3, 1.28, 2.207],
    [430.5, 1.25, 2.305],
    [450.9, 1.24, 2.397],
    [471.4, 1.25, 2.483],
    [495.9, 1.22, 2.564],
    [520.9, 1.18, 2.608],
    [548.6, 1.02, 2.577],
    [582.1, 0.70, 2.704],
    [616.8, 0.30, 3.205],
    [659.5, 0.22, 3.747],
    [704.5, 0.21, 4.205],
    [756.0, 0.24, 4.665],
    [821.1, 0.26, 5.180],
    [892.0, 0.30, 5.768],
    [984.0, 0.32, 6.421],
    [1088.0, 0.36, 7.217],
]);

/// Polymethyl methacrylate: N. Sultanova, S. Kasarova and I. Nikolov, Acta Physica Polonica A 116,
/// 585 (2009), for 437 to 1052 nm: n² − 1 = 1.1819 λ²/(λ² − 0.011313), λ in µm.
pub(super) const ACRYLIC: Dispersion = Dispersion::Sellmeier {
    strength: 1.1819,
    // √0.011313 µm.
    pole: 106.363,
    from: 437.0,
    to: 1052.0,
};

/// Cellulose: N. Sultanova, S. Kasarova and I. Nikolov, Acta Physica Polonica A 116, 585 (2009),
/// measured n² − 1 = 1.124 λ²/(λ² − 0.011087) of films; fibres of wood have 1.53 at 589 nm (H. Chen
/// et al., RSC Advances 10, 2020), which the strength is fitted to.
pub(super) const CELLULOSE: Dispersion = Dispersion::Sellmeier {
    strength: 1.2981,
    // √0.011087 µm.
    pole: 105.295,
    from: 437.0,
    to: 1052.0,
};
