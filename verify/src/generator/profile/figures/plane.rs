//! Random figures on a half-unit grid: sides continue each other, arcs touch sides and corners.

use crate::generator::figure::{CircleForm, ModelFigure, OffsetCorner};
use crate::generator::model::ModelOperation;
use crate::generator::random::RandomChoices;

/// Any figure.
pub(super) fn figure(random: &mut RandomChoices) -> ModelFigure {
    nested(random, 3)
}

/// A figure with operations inside each other up to a depth.
fn nested(random: &mut RandomChoices, depth: usize) -> ModelFigure {
    let kind = match depth {
        0 => 0,
        _ => random.below(10),
    };
    match kind {
        0..3 => outline(random),
        3..7 => {
            use ModelOperation::{Difference, Intersection, Union};
            let op = random.choose(&[Union, Difference, Difference, Intersection]);
            ModelFigure::Operation(op, operands(random, depth))
        }
        7 => ModelFigure::Hull(operands(random, 1)),
        _ => ModelFigure::Offset {
            distance: random.half(1, 3) * random.choose(&[1.0, 1.0, -0.5]),
            corner: random.choose(&[
                OffsetCorner::Round,
                OffsetCorner::Round,
                OffsetCorner::Sharp,
                OffsetCorner::Chamfer,
            ]),
            of: Box::new(nested(random, depth - 1)),
        },
    }
}

/// Two to four moved figures.
fn operands(random: &mut RandomChoices, depth: usize) -> Vec<ModelFigure> {
    let count = random.between(2, 4);
    (0..count)
        .map(|_| {
            let of = nested(random, depth - 1);
            moved(random, of)
        })
        .collect()
}

/// A figure, moved on the grid; one in three rotated.
fn moved(random: &mut RandomChoices, of: ModelFigure) -> ModelFigure {
    let turn = match random.once_in(3) {
        true => random.choose(&[90.0, 180.0, 45.0, 30.0, 17.0]),
        false => 0.0,
    };
    let shift = [0; 2].map(|_| random.half(0, 10) - 2.0);
    let of = Box::new(of);
    ModelFigure::Moved { turn, shift, of }
}

/// A rectangle, a disc or a polygon.
fn outline(random: &mut RandomChoices) -> ModelFigure {
    match random.below(6) {
        0 | 1 => ModelFigure::Rectangle([0; 2].map(|_| random.half(1, 8))),
        2 | 3 => ModelFigure::Disc {
            r: random.half(1, 5),
            form: form(random),
        },
        4 => convex(random),
        _ => star(random),
    }
}

/// A true circle, or one time in four a polygon.
fn form(random: &mut RandomChoices) -> CircleForm {
    match random.once_in(4) {
        true => CircleForm::Polygon(random.choose(&[3, 4, 5, 6, 8, 12])),
        false => CircleForm::Circle,
    }
}

/// A convex polygon: a regular one, or a triangle.
pub(super) fn convex(random: &mut RandomChoices) -> ModelFigure {
    if random.once_in(2) {
        return ModelFigure::Disc {
            r: random.half(1, 5),
            form: CircleForm::Polygon(random.choose(&[3, 4, 5, 6, 8])),
        };
    }
    let [x, y] = [0; 2].map(|_| random.half(1, 6));
    let top = random.half(0, 6);
    ModelFigure::Polygon(vec![[0.0, 0.0], [x, 0.0], [top, y]])
}

/// A polygon about the origin whose corners are at rounded points of rays.
fn star(random: &mut RandomChoices) -> ModelFigure {
    let count = random.between(4, 9);
    let corner = |k: usize| {
        let angle = std::f64::consts::TAU * k as f64 / count as f64;
        let r = random.half(2, 8);
        // Adding zero makes zero of minus zero.
        [r * angle.cos(), r * angle.sin()].map(|x| (100.0 * x).round() / 100.0 + 0.0)
    };
    ModelFigure::Polygon((0..count).map(corner).collect())
}

/// The part of a figure right of the y axis.
pub(super) fn right_of_axis(random: &mut RandomChoices) -> ModelFigure {
    let first = nested(random, 2);
    let half = ModelFigure::Moved {
        turn: 0.0,
        shift: [random.choose(&[0.0, 0.0, 0.5]), -32.0],
        of: Box::new(ModelFigure::Rectangle([32.0, 64.0])),
    };
    let shift = [random.half(0, 8), 0.0];
    let of = Box::new(first);
    let moved = ModelFigure::Moved {
        turn: 0.0,
        shift,
        of,
    };
    ModelFigure::Operation(ModelOperation::Intersection, vec![half, moved])
}
