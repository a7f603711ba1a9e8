//! The quadrature rules of a precision.

/// The nodes in (-1, 1) and the weights of a quadrature rule.
pub(crate) type GaussRule<N = f64> = Vec<(N, N)>;

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
