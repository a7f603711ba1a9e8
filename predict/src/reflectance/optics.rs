//! Fresnel's equations for a conductor or a dielectric in air.

/// The optical constants of a material at the wavelength of the light: n − ik.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Optics {
    /// The index of refraction, over that of air.
    pub n: f64,
    /// The extinction coefficient; 0 for a dielectric.
    pub k: f64,
}

/// The reflected shares of the intensity at a smooth plane, each from 0 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reflectivity {
    /// Of light whose electric field lies in the plane of incidence: ρ∥.
    pub parallel: f64,
    /// Of light whose electric field is perpendicular to it: ρ⊥.
    pub perpendicular: f64,
}

/// How the intensity of a light is divided between its two polarised components.
///
/// The components are those parallel and perpendicular to the plane of incidence of the facet that
/// reflects, as the model of the paper takes them for every facet alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Polarisation {
    parallel: f64,
}

impl Polarisation {
    /// Both components alike: ψ = 45°.
    pub const UNPOLARISED: Self = Self { parallel: 0.5 };

    /// The division of the intensities I∥ and I⊥, in any one unit; none where one of them is
    /// negative or not finite, or where there is no light at all.
    pub fn new(parallel: f64, perpendicular: f64) -> Option<Self> {
        let total = parallel + perpendicular;
        let sound = parallel >= 0.0 && perpendicular >= 0.0 && total > 0.0 && total.is_finite();
        sound.then(|| Self {
            parallel: parallel / total,
        })
    }
}

impl Default for Polarisation {
    fn default() -> Self {
        Self::UNPOLARISED
    }
}

impl Reflectivity {
    /// The share of a light that is reflected: F = ρ∥ cos²ψ + ρ⊥ sin²ψ = (ρ∥ I∥ + ρ⊥ I⊥)/(I∥ + I⊥).
    #[inline]
    pub fn reflectivity(self, light: Polarisation) -> f64 {
        self.perpendicular + (self.parallel - self.perpendicular) * light.parallel
    }
}

impl Optics {
    /// The reflectivity for light that comes at the angle θ to the normal, given by its cosine,
    /// which is held to 0 to 1.
    ///
    /// The form without complex numbers (Siegel and Howell, Thermal Radiation Heat Transfer, 1981;
    /// Cook and Torrance, 1982, appendix): with c = n² − k² − sin²θ, a² and b² are
    /// (√(c² + 4n²k²) ± c)/2. The quotients are written as sums of squares and multiplied out by
    /// cos²θ, so that nothing cancels near Brewster's angle, or is infinite at grazing incidence.
    #[inline]
    pub fn fresnel(&self, cos_theta: f64) -> Reflectivity {
        let cos = cos_theta.clamp(0.0, 1.0);
        let cos2 = cos * cos;
        let sin2 = (1.0 - cos) * (1.0 + cos);
        let nk = self.n * self.k;
        let c = self.n * self.n - self.k * self.k - sin2;
        let modulus = (c * c + 4.0 * nk * nk).sqrt();
        // The smaller of a² and b² by their product n²k²: their difference would cancel.
        let large = 0.5 * (modulus + c.abs());
        let small = if large > 0.0 { nk * nk / large } else { 0.0 };
        let (a2, b2) = if c >= 0.0 {
            (large, small)
        } else {
            (small, large)
        };
        let a = a2.sqrt();
        let square = |x: f64| x * x;
        let perpendicular = (square(a - cos) + b2) / (square(a + cos) + b2);
        let b2_cos2 = b2 * cos2;
        let quotient = (square(a * cos - sin2) + b2_cos2) / (square(a * cos + sin2) + b2_cos2);
        Reflectivity {
            parallel: perpendicular * quotient,
            perpendicular,
        }
    }

    /// The share of light that is reflected at normal incidence, whatever its polarisation: F(0).
    pub fn normal(&self) -> f64 {
        self.fresnel(1.0).perpendicular
    }
}
