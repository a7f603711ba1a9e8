//! Materials by name.
//!
//! Only `n` and `k` are measured, by whom each material says; they are for green light of 550 nm.
//! The roughness `m`, the fractions `s` and `d`, the ambient reflectance, and `R_d` where it is given,
//! are our choice of a likely specimen: they depend on how a surface was made, and whoever knows
//! better writes them down.

use super::{Constants, Material, SpecularForm};

/// The names of the library.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Named {
    /// Aluminium, milled. n and k: A. D. Rakić, Applied Optics 34, 4755 (1995), between the values
    /// at 516.60 nm (0.8734, 6.2418) and 563.57 nm (1.0728, 6.7839). F(0) = 0.915.
    Aluminium,
    /// Steel, ground, by the constants of iron. P. B. Johnson and R. W. Christy, Physical Review B 9,
    /// 5056 (1974), at 549 nm. F(0) = 0.512; steels differ from iron, and among themselves, by some
    /// hundredths.
    Steel,
    /// Copper, milled. P. B. Johnson and R. W. Christy, Physical Review B 6, 4370 (1972), at
    /// 548.6 nm. F(0) = 0.619.
    Copper,
    /// A plastic, pigmented light grey, moulded: polymethyl methacrylate. N. Sultanova, S. Kasarova
    /// and I. Nikolov, Acta Physica Polonica A 116, 585 (2009): n² − 1 = 1.1819 λ²/(λ² − 0.011313),
    /// λ in µm. F(0) = 0.039. Its pigment makes it diffuse, so `R_d` is given.
    Plastic,
    /// White paper, by its fibres of cellulose. H. Chen et al., RSC Advances 10 (2020), delignified
    /// wood at 589 nm: 1.525 ± 0.008 to 1.537 ± 0.005. F(0) = 0.044. `R_d` is given: light is
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

    /// The material of the name.
    pub fn material(self) -> Material {
        let metal = |n, k, ambient, m| Constants {
            ambient,
            diffuse: None,
            s: 0.8,
            d: 0.2,
            m,
            n,
            k,
            form: SpecularForm::Normalised,
        };
        let dielectric = |n, ambient, diffuse, s, m| Constants {
            ambient,
            diffuse: Some(diffuse),
            s,
            d: 1.0 - s,
            m,
            n,
            k: 0.0,
            form: SpecularForm::Normalised,
        };
        Material::known(match self {
            Self::Aluminium => metal(1.015, 6.627, 0.9, 0.25),
            Self::Steel => metal(2.95, 2.93, 0.5, 0.3),
            Self::Copper => metal(1.02, 2.577, 0.6, 0.25),
            Self::Plastic => dielectric(1.493, 0.4, 0.2, 0.4, 0.2),
            Self::Paper => dielectric(1.53, 0.8, 0.28, 0.05, 0.7),
        })
    }
}

impl Material {
    /// The material of a name of [`Named`], written as [`Named::name`] does.
    pub fn named(name: &str) -> Option<Self> {
        let known = Named::ALL.into_iter().find(|known| known.name() == name);
        known.map(Named::material)
    }
}
