//! A part under construction: lengths, primitives in common positions, operations.

use crate::generator::model::{
    ModelAxis, ModelNodeId, ModelOperation, ModelPrimitive, ModelStep, Notation, PartModel,
};
use crate::generator::random::RandomChoices;

/// A length in ten-thousandths of the unit, so that sums and halves of lengths are exact.
pub type PartLength = i64;

/// The unit of length.
pub const UNIT: PartLength = 10_000;

/// A position.
pub type PlanePoint = [PartLength; 3];

/// A part under construction.
pub struct PartDraft<'r> {
    /// The random choices.
    pub random: &'r mut RandomChoices,
    /// The model so far.
    pub model: PartModel,
    /// The smallest step of a length.
    step: PartLength,
}

/// Bounds of a length, both included.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// The smallest.
    pub min: PartLength,
    /// The largest.
    pub max: PartLength,
}

/// The range of a length between two percentages.
pub fn percent(of: PartLength, from: PartLength, to: PartLength) -> Range {
    Range {
        min: of * from / 100,
        max: of * to / 100,
    }
}

fn number(length: PartLength) -> f64 {
    length as f64 / UNIT as f64
}

impl<'r> PartDraft<'r> {
    /// An empty part; its lengths will have 0 to 3 decimals.
    pub fn new(random: &'r mut RandomChoices) -> Self {
        let step = random.choose(&[UNIT, UNIT, UNIT / 10, UNIT / 10, UNIT / 100, UNIT / 1000]);
        let model = PartModel::with_notation(Notation::Decimal);
        Self {
            random,
            model,
            step,
        }
    }

    /// A random length between two numbers of units.
    pub fn length(&mut self, min: PartLength, max: PartLength) -> PartLength {
        self.between(Range {
            min: min * UNIT,
            max: max * UNIT,
        })
    }

    /// A random length between bounds. It has more decimals than the part's only if necessary.
    pub fn between(&mut self, Range { min, max }: Range) -> PartLength {
        let mut step = self.step;
        loop {
            let first = (min + step - 1).div_euclid(step);
            let last = max.div_euclid(step);
            if first <= last {
                return step
                    * (first + self.random.below((last - first + 1) as usize) as PartLength);
            }
            if step == 1 {
                return min;
            }
            step /= 10;
        }
    }

    /// A random length between two percentages of another.
    pub fn part_of(&mut self, of: PartLength, from: PartLength, to: PartLength) -> PartLength {
        self.between(percent(of, from, to))
    }

    /// True with probability 1/n.
    pub fn once_in(&mut self, n: usize) -> bool {
        self.random.once_in(n)
    }

    fn leaf(
        &mut self,
        primitive: ModelPrimitive,
        mut steps: Vec<ModelStep>,
        at: PlanePoint,
    ) -> ModelNodeId {
        if at != [0; 3] {
            steps.push(ModelStep::Shift(at.map(number)));
        }
        self.model.leaf(primitive, steps)
    }

    /// A block with its lowest corner at a position.
    pub fn block(&mut self, size: PlanePoint, at: PlanePoint) -> ModelNodeId {
        self.leaf(ModelPrimitive::Block(size.map(number)), Vec::new(), at)
    }

    /// A block with x and y centred about a position, on which its base lies.
    pub fn centred(&mut self, [x, y, z]: PlanePoint, at: PlanePoint) -> ModelNodeId {
        self.block([x, y, z], [at[0] - x / 2, at[1] - y / 2, at[2]])
    }

    /// A wedge with its right-angled edge along y through a position, rotated about z by right
    /// angles.
    pub fn wedge(&mut self, size: PlanePoint, right_angles: usize, at: PlanePoint) -> ModelNodeId {
        let steps = match right_angles % 4 {
            0 => Vec::new(),
            n => vec![ModelStep::Turn(ModelAxis::Z, 90.0 * n as f64)],
        };
        self.leaf(ModelPrimitive::Wedge(size.map(number)), steps, at)
    }

    /// A cylinder from the centre of its base at a position, in the direction of an axis.
    pub fn cylinder(
        &mut self,
        axis: ModelAxis,
        r: PartLength,
        h: PartLength,
        at: PlanePoint,
    ) -> ModelNodeId {
        let (r, h) = (number(r), number(h));
        self.leaf(ModelPrimitive::Cylinder { r, h }, along(axis), at)
    }

    /// A frustum about z, or a cylinder if both radii are equal.
    pub fn frustum(
        &mut self,
        r1: PartLength,
        r2: PartLength,
        h: PartLength,
        at: PlanePoint,
    ) -> ModelNodeId {
        if r1 == r2 {
            return self.cylinder(ModelAxis::Z, r1, h, at);
        }
        let [r1, r2, h] = [r1, r2, h].map(number);
        self.leaf(ModelPrimitive::Frustum { r1, r2, h }, Vec::new(), at)
    }

    /// A sphere about a position.
    pub fn sphere(&mut self, r: PartLength, at: PlanePoint) -> ModelNodeId {
        self.leaf(ModelPrimitive::Sphere(number(r)), Vec::new(), at)
    }

    /// A torus about a position, with its axis in the direction of a coordinate axis.
    pub fn torus(
        &mut self,
        axis: ModelAxis,
        major: PartLength,
        minor: PartLength,
        at: PlanePoint,
    ) -> ModelNodeId {
        let (major, minor) = (number(major), number(minor));
        self.leaf(ModelPrimitive::Torus { major, minor }, along(axis), at)
    }

    /// The union of nodes.
    pub fn union(&mut self, of: Vec<ModelNodeId>) -> ModelNodeId {
        match of.as_slice() {
            &[only] => only,
            _ => self.model.operation(ModelOperation::Union, of, Vec::new()),
        }
    }

    /// The difference of a node and tools.
    pub fn difference(&mut self, of: ModelNodeId, tools: Vec<ModelNodeId>) -> ModelNodeId {
        if tools.is_empty() {
            return of;
        }
        let mut all = vec![of];
        all.extend(tools);
        self.model
            .operation(ModelOperation::Difference, all, Vec::new())
    }

    /// The intersection of two nodes.
    pub fn intersection(&mut self, a: ModelNodeId, b: ModelNodeId) -> ModelNodeId {
        self.model
            .operation(ModelOperation::Intersection, vec![a, b], Vec::new())
    }

    /// Rotates a node about z.
    pub fn turn_about_z(&mut self, node: ModelNodeId, degrees: f64) -> ModelNodeId {
        if let (true, Some(node)) = (degrees != 0.0, self.model.node_mut(node)) {
            node.steps.push(ModelStep::Turn(ModelAxis::Z, degrees));
        }
        node
    }

    /// Copies spaced evenly about z, each created at the angle zero.
    pub fn circle(
        &mut self,
        count: usize,
        mut make: impl FnMut(&mut Self) -> ModelNodeId,
    ) -> Vec<ModelNodeId> {
        let start = self.random.choose(&[0.0, 0.0, 0.5]);
        let each = |k: usize| 360.0 * (k as f64 + start) / count as f64;
        (0..count)
            .map(|k| {
                let node = make(self);
                self.turn_about_z(node, each(k))
            })
            .collect()
    }

    /// A hole of radius `r` through `depth`: simple, blind, counterbored or countersunk to the
    /// radius `wide`.
    pub fn hole(&mut self, r: PartLength, wide: PartLength, depth: PartLength) -> Hole {
        let form = match self.random.below(6) {
            0 => Form::Blind {
                deep: self.part_of(depth, 40, 80),
                pointed: self.once_in(2),
            },
            1 if wide > r => Form::Counterbored {
                wide,
                deep: self.part_of(depth, 20, 60),
            },
            2 if wide > r => Form::Countersunk {
                wide,
                deep: (wide - r).min(depth / 2),
            },
            _ => Form::Plain,
        };
        Hole { r, depth, form }
    }

    /// The tools that cut a hole downwards from a position. They protrude above, and below for a
    /// through hole.
    pub fn drill(&mut self, hole: &Hole, [x, y, top]: PlanePoint) -> Vec<ModelNodeId> {
        let Hole { r, depth, form } = *hole;
        if let Form::Blind { deep, pointed } = form {
            let floor = top - deep;
            let mut tools = vec![self.cylinder(ModelAxis::Z, r, deep + UNIT, [x, y, floor])];
            // The conical end that a drill leaves.
            let point = (r / 2).min((depth - deep) / 2);
            if pointed && point > 0 {
                tools.push(self.frustum(0, r, point, [x, y, floor - point]));
            }
            return tools;
        }
        let low = top - depth - UNIT;
        let mut tools = vec![self.cylinder(ModelAxis::Z, r, depth + 2 * UNIT, [x, y, low])];
        match form {
            Form::Plain | Form::Blind { .. } => {}
            Form::Counterbored { wide, deep } => {
                tools.push(self.cylinder(ModelAxis::Z, wide, deep + UNIT, [x, y, top - deep]));
            }
            Form::Countersunk { wide, deep } => {
                tools.push(self.frustum(r, wide, deep, [x, y, top - deep]));
            }
        }
        tools
    }
}

/// A hole that is cut at one or several positions.
#[derive(Clone, Copy, Debug)]
pub struct Hole {
    r: PartLength,
    depth: PartLength,
    form: Form,
}

/// The form of a hole below its rim.
#[derive(Clone, Copy, Debug)]
enum Form {
    Plain,
    Blind { deep: PartLength, pointed: bool },
    Counterbored { wide: PartLength, deep: PartLength },
    Countersunk { wide: PartLength, deep: PartLength },
}

/// The rotation from the direction of z to that of an axis.
fn along(axis: ModelAxis) -> Vec<ModelStep> {
    match axis {
        ModelAxis::X => vec![ModelStep::Turn(ModelAxis::Y, 90.0)],
        ModelAxis::Y => vec![ModelStep::Turn(ModelAxis::X, -90.0)],
        ModelAxis::Z => Vec::new(),
    }
}
