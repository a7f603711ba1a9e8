//! Numbers: exact rationals, enclosures, intervals, jets, root isolation, and the predicates, which
//! alone decide signs.

pub mod analytic;
pub mod bisection;
mod chebyshev_model;
pub mod enclosable;
pub mod extended;
pub mod f64_filter;
pub mod float;
pub mod interval;
mod interval_fallback;
pub mod jet;
mod monotone_samples;
pub mod predicates;
pub mod quadrature;
pub mod rational;
pub mod rational_interval;
pub mod roots;
pub mod separation_bound;
