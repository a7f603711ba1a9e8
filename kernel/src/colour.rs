//! Colours, which matter to files only.

use std::fmt;

/// A colour in sRGB, with its opacity.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Colour {
    /// Red, green and blue.
    pub rgb: [u8; 3],
    /// The opacity: 255 if nothing is seen through it.
    pub alpha: u8,
}

impl Colour {
    /// The colour of red, green, blue and opacity from 0 to 1. What is beyond is clamped, and what is
    /// no number counts as 0.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio_kernel::colour::Colour;
    ///
    /// let orange = Colour::new([1.0, 0.5, 0.0, 1.0]);
    /// assert_eq!(orange.to_string(), "#FF8000FF");
    /// ```
    pub fn new(parts: [f64; 4]) -> Self {
        // The conversion saturates.
        let [r, g, b, alpha] = parts.map(|part| (255.0 * part).round() as u8);
        Self {
            rgb: [r, g, b],
            alpha,
        }
    }

    /// Red, green, blue and opacity from 0 to 1.
    pub fn parts(self) -> [f64; 4] {
        let [r, g, b] = self.rgb;
        [r, g, b, self.alpha].map(|part| f64::from(part) / 255.0)
    }

    /// The intensities of red, green and blue, which are linear in the light, and the opacity, from 0
    /// to 1 (IEC 61966-2-1).
    pub fn linear(self) -> [f64; 4] {
        let [r, g, b, alpha] = self.parts();
        let linear = |part: f64| match part <= 0.040_45 {
            true => part / 12.92,
            false => ((part + 0.055) / 1.055).powf(2.4),
        };
        [linear(r), linear(g), linear(b), alpha]
    }
}

/// `#RRGGBBAA`.
impl fmt::Display for Colour {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [r, g, b] = self.rgb;
        write!(f, "#{r:02X}{g:02X}{b:02X}{:02X}", self.alpha)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_clamped() {
        assert_eq!(
            Colour::new([-1.0, 2.0, f64::NAN, 0.5]).to_string(),
            "#00FF0080"
        );
        let grey = Colour::new([0.5, 1.0, 0.0, 1.0]).linear();
        // 128/255 has 0.2159 of the light.
        assert!((grey[0] - 0.215_86).abs() < 1e-5);
        assert_eq!(grey[1..], [1.0, 0.0, 1.0]);
    }
}
