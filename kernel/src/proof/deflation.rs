//! Deflation (Leykin, Verschelde and Zhao 2006): at a common zero of polynomials whose gradients
//! are linearly dependent, the dependence gives further polynomials that vanish there.

use super::fixed::Place;
use super::point::{FIRST, Form};
use super::polynomial::Polynomial;
use crate::number::float::Float;
use nalgebra::{Point3, Vector3};

/// The number of polynomials, simplest first, whose gradients are compared.
const FEW: usize = 6;
/// The highest degree of a new polynomial.
const HIGH: u32 = 12;
/// The number of bits by which a gradient that is not zero exceeds its rounding. Where surfaces are
/// tangent the point is known to some hundred bits, so every gradient there differs slightly from
/// zero.
const CLEAR: usize = FIRST - 74;
/// The sine of the angle below which two directions are equal.
const ONE: f64 = 1.0 / (1u64 << 40) as f64;

/// Further polynomials that vanish at a point, because the gradients of the given ones are linearly
/// dependent there.
pub fn deflated<N: Float>(polynomials: &[Polynomial], p: &Point3<N>) -> Vec<Polynomial> {
    let Some(place) = Place::new(p, FIRST) else {
        return Vec::new();
    };
    let mut simplest: Vec<&Polynomial> = polynomials.iter().collect();
    simplest.sort_by_key(|p| (p.degree(), p.height()));
    let forms = simplest.into_iter().take(FEW).map(Form::new);
    let all: Vec<(Form, Option<Vector3<f64>>)> = forms
        .map(|form| {
            let direction = form.direction(&place, CLEAR);
            (form, direction)
        })
        .collect();
    let mut more: Vec<Polynomial> = Vec::new();
    for (i, (a, along)) in all.iter().enumerate() {
        for (j, (b, other)) in all.iter().enumerate().skip(i + 1) {
            let across = along.zip(*other).map(|(a, b)| a.cross(&b));
            let Some(across) = across.filter(|c| c.norm() > ONE) else {
                more.extend(a.level.touching(&b.level));
                continue;
            };
            for (c, third) in &all[j + 1..] {
                if third.is_none_or(|d| across.dot(&d).abs() <= ONE) {
                    more.push(a.level.dependence(&b.level, &c.level));
                }
            }
        }
    }
    more.retain(|p| (1..=HIGH).contains(&p.degree()));
    more
}
