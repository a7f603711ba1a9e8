//! The quadrature rules of a precision.

/// The nodes of a quadrature rule.
pub(crate) type GaussRule<N = f64> = Vec<GaussNode<N>>;

/// A node of a quadrature rule.
#[derive(Clone, Copy, Debug)]
pub(crate) struct GaussNode<N = f64> {
    /// The place in (-1, 1).
    pub x: N,
    /// The weight.
    pub weight: N,
}

/// The quadrature rules of a precision.
#[derive(Debug)]
pub struct GaussRules<N = f64> {
    /// For smooth functions over about a quarter turn.
    pub(crate) smooth: GaussRule<N>,
    /// Two rules for functions that are nearly polynomials. If they agree, the second is used.
    pub(crate) short: [GaussRule<N>; 2],
    /// The relative difference of two sums below which the integral has converged.
    pub(crate) settled: N,
}
