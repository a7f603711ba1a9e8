//! The laws of set algebra for boundaries: both sides must have the same combinatorics, volume and
//! area.

use crate::random::tree;
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_kernel::brep::face_integrals::Mass;
use premio_kernel::brep::signature::Signature;
use rayon::prelude::*;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// The allowed difference of volumes and areas, relative to those of the greatest part.
const APART: f64 = 1e-9;

/// The properties by which the two sides of a law are compared.
#[derive(Clone, Debug)]
pub struct Side {
    /// The combinatorics.
    pub signature: Signature,
    /// Volume and area.
    pub mass: Mass,
    /// Whether a decision was close.
    pub close: bool,
}

/// A law: its name, both sides, and the ratio of their units.
pub struct Law {
    /// What it says.
    pub name: &'static str,
    /// Both sides.
    pub sides: [Value; 2],
    /// The second side's unit in the first's.
    pub scale: f64,
}

/// An operation on any number of trees.
pub fn join(op: &str, children: &[&Value]) -> Value {
    json!({"op": op, "children": children})
}

/// The laws for three trees.
pub fn laws(a: &Value, b: &Value, c: &Value) -> Vec<Law> {
    let (or, and, less) = (
        |x: &Value, y: &Value| join("union", &[x, y]),
        |x: &Value, y: &Value| join("intersection", &[x, y]),
        |x: &Value, y: &Value| join("difference", &[x, y]),
    );
    let all = &json!({"prim": "block", "size": [64, 64, 64],
        "transform": [{"translate": [-32.25, -32.25, -32.25]}]});
    let not = |x: &Value| less(all, x);
    let block = |at: f64| json!({"prim": "block", "size": [1, 1, 1], "transform": [{"translate": [at, 0, 0]}]});
    let nothing = and(&block(0.0), &block(2.0));
    let law = |name, sides| Law {
        name,
        sides,
        scale: 1.0,
    };
    vec![
        law("A or A = A", [or(a, a), a.clone()]),
        law("A and A = A", [and(a, a), a.clone()]),
        law("A less A = nothing", [less(a, a), nothing]),
        law("A or B = B or A", [or(a, b), or(b, a)]),
        law("A and B = B and A", [and(a, b), and(b, a)]),
        law(
            "(A or B) or C = A or (B or C)",
            [or(&or(a, b), c), or(a, &or(b, c))],
        ),
        law(
            "(A and B) and C = A and (B and C)",
            [and(&and(a, b), c), and(a, &and(b, c))],
        ),
        law(
            "A less (B or C) = (A less B) less C",
            [less(a, &or(b, c)), less(&less(a, b), c)],
        ),
        law(
            "(A less B) or (A and B) = A",
            [or(&less(a, b), &and(a, b)), a.clone()],
        ),
        law(
            "not (A or B) = not A and not B",
            [not(&or(a, b)), and(&not(a), &not(b))],
        ),
        law(
            "not (A and B) = not A or not B",
            [not(&and(a, b)), or(&not(a), &not(b))],
        ),
        law(
            "A and (B or C) = (A and B) or (A and C)",
            [and(a, &or(b, c)), or(&and(a, b), &and(a, c))],
        ),
    ]
}

/// The invariance under motions and scaling.
pub fn motions(a: &Value) -> Vec<Law> {
    let moved = |steps: Value| json!({"op": "union", "children": [a], "transform": steps});
    vec![
        Law {
            name: "moved",
            sides: [a.clone(), moved(json!([{"translate": [0.3, -7.25, 11.0]}]))],
            scale: 1.0,
        },
        Law {
            name: "turned",
            sides: [
                a.clone(),
                moved(json!([{"rotate": [[1, 2, 3], 17]}, {"translate": [3.0, 0.7, -0.1]}])),
            ],
            scale: 1.0,
        },
        Law {
            name: "scaled",
            sides: [a.clone(), scaled(a, 1024.0)],
            scale: 1024.0,
        },
    ]
}

/// A tree with all its lengths multiplied by a factor.
fn scaled(tree: &Value, by: f64) -> Value {
    let lengths = ["size", "r", "R", "r1", "r2", "h", "translate"];
    let times = |value: &Value| match value {
        Value::Array(all) => all
            .iter()
            .map(|v| json!(v.as_f64().unwrap_or(0.0) * by))
            .collect(),
        other => json!(other.as_f64().unwrap_or(0.0) * by),
    };
    match tree {
        Value::Object(members) => {
            let one = |(name, value): (&String, &Value)| {
                let value = match lengths.contains(&name.as_str()) {
                    true => times(value),
                    false => scaled(value, by),
                };
                (name.clone(), value)
            };
            Value::Object(members.iter().map(one).collect())
        }
        // An axis and an angle are not scaled.
        Value::Array(all) => all.iter().map(|v| scaled(v, by)).collect(),
        other => other.clone(),
    }
}

/// The boundary of a tree, as compared by the laws.
///
/// # Errors
/// The tree cannot be read or evaluated, or its boundary breaks a rule.
pub fn side(tree: &Value) -> Result<Side, String> {
    let text = tree.to_string();
    let read = read(
        "tree",
        text.as_bytes(),
        Format::Json,
        &ReadOptions::default(),
    );
    let tree = read.map_err(|error| error.to_string())?.tree;
    let part: Evaluation =
        evaluate(&tree, &EvaluationOptions::default()).map_err(|e| e.to_string())?;
    if let Some(defect) = part.violations().first() {
        return Err(format!("{defect:?}"));
    }
    Ok(Side {
        signature: Signature::new(&part.brep),
        mass: part.mass(),
        close: !part.decisions.close_calls.is_empty(),
    })
}

/// How the sides of a law differ; `None` if they agree, or if a decision on one side was close.
fn broken(law: &Law, sides: [&Result<Side, String>; 2]) -> Option<String> {
    let [a, b] = match sides {
        [Ok(a), Ok(b)] => [a, b],
        [Err(error), _] | [_, Err(error)] => return Some(format!("{}: {error}", law.name)),
    };
    if a.close || b.close {
        return None;
    }
    let near = |x: f64, y: f64, scale: f64| (x - y / scale).abs() <= APART * (1.0 + x.abs());
    let same = a.signature == b.signature
        && near(a.mass.volume, b.mass.volume, law.scale.powi(3))
        && near(a.mass.area, b.mass.area, law.scale.powi(2));
    (!same).then(|| {
        let say = |s: &Side| {
            format!(
                "{:?} volume {} area {}",
                s.signature.counts, s.mass.volume, s.mass.area
            )
        };
        format!("{}: {} for {}", law.name, say(a), say(b))
    })
}

/// The laws that three random trees violate.
pub fn broken_by(seed: u64) -> Vec<String> {
    let [a, b, c] = [0, 1, 2].map(|k| tree(3 * seed + k));
    let laws: Vec<Law> = laws(&a, &b, &c).into_iter().chain(motions(&a)).collect();
    // A tree that is a side of several laws is evaluated once.
    let trees = laws.iter().flat_map(|law| &law.sides);
    let trees: BTreeMap<String, &Value> = trees.map(|tree| (tree.to_string(), tree)).collect();
    let sides = trees.into_par_iter().map(|(text, tree)| (text, side(tree)));
    let sides: BTreeMap<String, Result<Side, String>> = sides.collect();
    let of = |law: &Law| law.sides.each_ref().map(|tree| &sides[&tree.to_string()]);
    laws.iter().filter_map(|law| broken(law, of(law))).collect()
}

#[cfg(test)]
mod tests {
    use super::{join, side};
    use serde_json::{Value, json};

    fn block(size: [f64; 3], at: [f64; 3]) -> Value {
        json!({"prim": "block", "size": size, "transform": [{"translate": at}]})
    }

    /// A block with two more on it.
    fn towers(first: [f64; 3], second: [f64; 3]) -> Value {
        let base = block([9.0, 9.0, 1.0], [0.0; 3]);
        let [a, b] = [first, second].map(|at| block([1.0; 3], at));
        join("union", &[&base, &a, &b])
    }

    #[test]
    fn what_is_the_same_but_for_its_place_has_one_signature() {
        let of = |tree: &Value| side(tree).map(|s| s.signature);
        let apart = of(&towers([2.0, 2.0, 1.0], [5.0, 5.0, 1.0]));
        assert!(apart.is_ok());
        assert_eq!(apart, of(&towers([6.0, 2.0, 1.0], [1.0, 5.0, 1.0])));
        // As many faces, edges and vertices, but one tower is below.
        let below = of(&towers([2.0, 2.0, 1.0], [5.0, 5.0, -1.0]));
        assert_ne!(apart, below);
    }
}
