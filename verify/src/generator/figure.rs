//! Plane figures of a model, and the solids swept by them, in f64.

use super::operation::ModelOperation;
use serde::{Deserialize, Serialize};

/// A plane figure as a description writes it.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub enum ModelFigure {
    /// A rectangle with a corner at the origin.
    Rectangle([f64; 2]),
    /// A disc about the origin.
    Disc {
        /// The radius.
        r: f64,
        /// What its circles are.
        form: CircleForm,
    },
    /// A polygon, by its corners in order.
    Polygon(Vec<[f64; 2]>),
    /// An operation on figures.
    Operation(ModelOperation, Vec<ModelFigure>),
    /// The convex hull of figures.
    Hull(Vec<ModelFigure>),
    /// The figure grown by a distance, or shrunk by a negative one.
    Offset {
        /// The distance.
        distance: f64,
        /// The form of its new corners.
        corner: OffsetCorner,
        /// The figure.
        of: Box<ModelFigure>,
    },
    /// A figure, rotated about the origin and moved.
    Moved {
        /// The angle, in degrees.
        turn: f64,
        /// The translation after the rotation.
        shift: [f64; 2],
        /// The figure.
        of: Box<ModelFigure>,
    },
}

/// What a circle of a description is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum CircleForm {
    /// A true circle.
    Circle,
    /// A regular polygon with so many corners, the first on the positive x axis.
    Polygon(u32),
}

/// The form of the new corners of an offset.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, Serialize)]
pub enum OffsetCorner {
    /// An arc.
    Round,
    /// The sides continue until they meet.
    Sharp,
    /// A segment at the distance.
    Chamfer,
}

/// A solid that a figure sweeps.
#[derive(Clone, Debug, PartialEq, Deserialize, Serialize)]
pub struct ModelSweep {
    /// The figure.
    pub figure: ModelFigure,
    /// The motion.
    pub motion: SweepMotion,
}

/// The motion of a figure that sweeps a solid.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize, Serialize)]
pub enum SweepMotion {
    /// Along z.
    Extrusion {
        /// The height.
        h: f64,
        /// The scale of the figure at the top.
        scale: f64,
        /// Whether the middle of the height is at the origin.
        is_centred: bool,
    },
    /// About z; the figure's y is along z.
    Revolution {
        /// The angle, in degrees.
        degrees: f64,
        /// What its circles are.
        form: CircleForm,
    },
}

impl ModelFigure {
    /// The figures of which this one is made; none of a rectangle, a disc or a polygon.
    pub fn operands(&self) -> &[Self] {
        match self {
            Self::Rectangle(_) | Self::Disc { .. } | Self::Polygon(_) => &[],
            Self::Operation(_, of) | Self::Hull(of) => of,
            Self::Offset { of, .. } | Self::Moved { of, .. } => std::slice::from_ref(of),
        }
    }

    /// The same figure of other operands.
    #[must_use]
    pub(crate) fn with_operands(&self, operands: Vec<Self>) -> Self {
        let first = || Box::new(operands.first().unwrap_or(self).clone());
        match self {
            Self::Rectangle(_) | Self::Disc { .. } | Self::Polygon(_) => self.clone(),
            Self::Operation(op, _) => Self::Operation(*op, operands),
            Self::Hull(_) => Self::Hull(operands),
            Self::Offset {
                distance, corner, ..
            } => Self::Offset {
                distance: *distance,
                corner: *corner,
                of: first(),
            },
            Self::Moved { turn, shift, .. } => Self::Moved {
                turn: *turn,
                shift: *shift,
                of: first(),
            },
        }
    }

    /// All numbers of the figure and of its operands.
    pub(crate) fn numbers(&self) -> Vec<f64> {
        let mut all = match self {
            Self::Rectangle(size) => size.to_vec(),
            Self::Disc { r, .. } => vec![*r],
            Self::Polygon(corners) => corners.iter().flatten().copied().collect(),
            Self::Operation(..) | Self::Hull(_) => Vec::new(),
            Self::Offset { distance, .. } => vec![*distance],
            Self::Moved { turn, shift, .. } => vec![*turn, shift[0], shift[1]],
        };
        all.extend(self.operands().iter().flat_map(Self::numbers));
        all
    }

    /// The number of figures of which this one is made, with itself.
    pub(crate) fn count(&self) -> usize {
        1 + self.operands().iter().map(Self::count).sum::<usize>()
    }

    /// Figures that are simpler than this one: an operand in its place, one operand or corner less,
    /// and an operand or a number simplified.
    pub(crate) fn simpler(&self) -> Vec<Self> {
        let operands = self.operands();
        let mut found = operands.to_vec();
        if operands.len() > 1 {
            for gone in 0..operands.len() {
                let mut fewer = operands.to_vec();
                fewer.remove(gone);
                found.push(self.with_operands(fewer));
            }
        }
        for (k, operand) in operands.iter().enumerate() {
            for simpler in operand.simpler() {
                let mut changed = operands.to_vec();
                changed[k] = simpler;
                found.push(self.with_operands(changed));
            }
        }
        found.extend(self.rounder());
        found
    }

    /// The figure with a corner less, or a number simplified.
    fn rounder(&self) -> Vec<Self> {
        let rounder = |x: f64| [0.0, 1.0, x.trunc()].into_iter();
        match self {
            Self::Rectangle([x, y]) => {
                let wide = rounder(*x).map(|x| Self::Rectangle([x, *y]));
                let high = rounder(*y).map(|y| Self::Rectangle([*x, y]));
                wide.chain(high).collect()
            }
            Self::Disc { r, form } => {
                let disc = |r| Self::Disc { r, form: *form };
                rounder(*r).map(disc).collect()
            }
            Self::Polygon(corners) if corners.len() > 3 => (0..corners.len())
                .map(|gone| {
                    let mut fewer = corners.clone();
                    fewer.remove(gone);
                    Self::Polygon(fewer)
                })
                .collect(),
            Self::Polygon(_) | Self::Operation(..) | Self::Hull(_) => Vec::new(),
            Self::Offset {
                distance,
                corner,
                of,
            } => {
                let offset = |distance| Self::Offset {
                    distance,
                    corner: *corner,
                    of: of.clone(),
                };
                rounder(*distance).map(offset).collect()
            }
            Self::Moved { turn, shift, of } => {
                let moved = |turn, shift| Self::Moved {
                    turn,
                    shift,
                    of: of.clone(),
                };
                let [x, y] = *shift;
                let along_x = rounder(x).map(|x| moved(*turn, [x, y]));
                let along_y = rounder(y).map(|y| moved(*turn, [x, y]));
                let turned = [0.0, 90.0].into_iter().map(|turn| moved(turn, *shift));
                turned.chain(along_x).chain(along_y).collect()
            }
        }
    }
}
