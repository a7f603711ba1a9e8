//! Numbers: exact rationals, enclosures, intervals, jets, root isolation, and the predicates, which
//! alone decide signs.

pub mod analytic;
pub mod bisection;
mod chebyshev_model;
pub mod double_double;
pub(crate) mod elementary_roots;
pub(crate) mod enclosable;
pub mod extended;
mod f64_float;
pub mod float;
pub mod function;
pub mod gauss_rules;
pub mod interval;
mod interval_fallback;
pub mod jet;
mod legendre;
mod monotone_samples;
pub mod predicates;
pub mod probes;
pub(crate) mod quadrature;
pub mod rational;
pub mod rational_interval;
pub mod roots;
pub(crate) mod separation_bound;
mod wide_float;
