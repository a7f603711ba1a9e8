//! Microfacets: a surface as many small mirrors, with the distribution of their normals and their
//! masking and shadowing.

/// Beckmann's distribution D = exp(−(tan α/m)²)/(m² cos⁴α) of the facets' normals.
///
/// `m` is the root mean square slope, `cos_alpha` the cosine of the angle between the facets'
/// normal and that of the surface. Its integral over the hemisphere, each direction by its cosine,
/// is π (Beckmann and Spizzichino, 1963; Cook and Torrance, 1982, equation 6). Nothing where the
/// facet looks into the surface.
#[inline]
pub fn distribution(m: f64, cos_alpha: f64) -> f64 {
    let cos2 = cos_alpha * cos_alpha;
    let m2 = m * m;
    let exponent = (1.0 - cos2).max(0.0) / (m2 * cos2);
    // Beyond it the exponential is zero in f64, and 1/cos⁴α may be infinite.
    if cos_alpha > 0.0 && exponent < 746.0 {
        (-exponent).exp() / (m2 * cos2 * cos2)
    } else {
        0.0
    }
}
