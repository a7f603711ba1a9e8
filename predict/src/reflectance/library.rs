//! Materials by name.
//!
//! Only `n` and `k` are measured, by whom each says in [`dispersion`](super::dispersion). The
//! roughness `m`, the fractions `s` and `d`, the ambient reflectance, and `R_d` where it is given,
//! are our choice of a likely specimen: they depend on how a surface was made, and whoever knows
//! better writes them down.

use super::dispersion::{ACRYLIC, ALUMINIUM, CELLULOSE, COPPER, Dispersion, IRON};
use super::{Constants, Material, Optics, SpecularForm};
use std::ops::RangeInclusive;

/// The wavelength in nanometres of a light that specifies none: green.
pub const GREEN: f64 = 550.0;

/// The names of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Named {
    /// Aluminium, milled. At 550 nm F(0) = 0.915.
    Aluminium,
    /// Steel, ground, by the constants of iron. At 550 nm F(0) = 0.512; steels differ from iron,
    /// and among themselves, by some hundredths.
    Steel,
    /// Copper, milled. At 450 nm F(0) = 0.54, at 550 nm 0.62, at 650 nm 0.94: it is red.
    Copper,
    /// A plastic, pigmented light grey, moulded: polymethyl methacrylate. At 550 nm F(0) = 0.039.
    /// Its pigment makes it diffuse, so `R_d` is given.
    Plastic,
    /// White paper, by its fibres of cellulose. At 550 nm F(0) = 0.044. `R_d` is given: light is
    /// scattered among the fibres, not at their surface.
    Paper,
}

impl Named {
    /// All names.
    pub const ALL: [Self; 5] = [
        Self::Aluminium,
        Self::Steel,
        Self::Copper,
        Self::Plastic,
        Self::Paper,
    ];

    /// The name as it is written in a file.
    pub fn name(self) -> &'static str {
        match self {
            Self::Aluminium => "aluminium",
            Self::Steel => "steel",
            Self::Copper => "copper",
            Self::Plastic => "plastic",
            Self::Paper => "paper",
        }
    }

    fn dispersion(self) -> Dispersion {
        match self {
            Self::Aluminium => ALUMINIUM,
            Self::Steel => IRON,
            Self::Copper => COPPER,
            Self::Plastic => ACRYLIC,
            Self::Paper => CELLULOSE,
        }
    }

    /// The wavelengths for which its optical constants are known, in nanometres.
    pub fn wavelengths(self) -> RangeInclusive<f64> {
        self.dispersion().range()
    }

    /// The material of the name under light of a wavelength in nanometres; none where its constants
    /// are not known.
    pub fn material(self, wavelength: f64) -> Option<Material> {
        let optics = self.dispersion().at(wavelength)?;
        Some(self.specimen(optics))
    }

    fn specimen(self, Optics { n, k }: Optics) -> Material {
        let metal = |ambient, m| Constants {
            ambient,
            diffuse: None,
            s: 0.8,
            d: 0.2,
            m,
            n,
            k,
            form: SpecularForm::Normalised,
        };
        let dielectric = |ambient, diffuse, s, m| Constants {
            ambient,
            diffuse: Some(diffuse),
            s,
            d: 1.0 - s,
            m,
            n,
            k,
            form: SpecularForm::Normalised,
        };
        Material::known(match self {
            Self::Aluminium => metal(0.9, 0.25),
            Self::Steel => metal(0.5, 0.3),
            Self::Copper => metal(0.6, 0.25),
            Self::Plastic => dielectric(0.4, 0.2, 0.4, 0.2),
            Self::Paper => dielectric(0.8, 0.28, 0.05, 0.7),
        })
    }

    /// The name that is written as [`Self::name`] does.
    pub fn known(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|known| known.name() == name)
    }
}
