//! What more can be said of a point at which all of some polynomials vanish and too many of their
//! gradients depend on one another: that they do (deflation: Leykin, Verschelde and Zhao 2006).

use super::fixed::Place;
use super::point::{FIRST, Form};
use super::polynomial::Polynomial;
use crate::number::float::Float;
use nalgebra::{Point3, Vector3};

/// Of how many polynomials, the simplest ones, gradients are compared.
const FEW: usize = 6;
/// No polynomial of a higher degree is made.
const HIGH: u32 = 12;
/// The bits by which a gradient is longer than its rounding if it is one: next to the point, which
/// is known to some hundred bits where surfaces touch, all are a little.
const CLEAR: usize = FIRST - 74;
/// Directions that are closer are one.
const ONE: f64 = 1.0 / (1u64 << 40) as f64;

/// The polynomials that vanish at a point with the given ones because the gradients of these depend
/// on one another there.
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
        for (j, (b, beside)) in all.iter().enumerate().skip(i + 1) {
            let across = along.zip(*beside).map(|(a, b)| a.cross(&b));
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
