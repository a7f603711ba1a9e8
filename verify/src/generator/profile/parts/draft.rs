//! A part as it is put together: lengths, primitives in common positions, operations.

use crate::generator::model::{Axis, Model, NodeId, Notation, Operation, Primitive, Step};
use crate::generator::random::Random;

/// A length in ten-thousandths of the unit, so that sums and halves of lengths are exact.
pub type Length = i64;

/// The unit of length.
pub const UNIT: Length = 10_000;

/// A place.
pub type Place = [Length; 3];

/// A part in the making.
pub struct Draft<'r> {
    /// The numbers that it is made by.
    pub random: &'r mut Random,
    /// What is made.
    pub model: Model,
    /// The smallest step of a length.
    step: Length,
}

/// Bounds of a length, both included.
#[derive(Clone, Copy, Debug)]
pub struct Range {
    /// The smallest.
    pub min: Length,
    /// The largest.
    pub max: Length,
}

/// The part of a length from one percentage to another.
pub fn percent(of: Length, from: Length, to: Length) -> Range {
    Range {
        min: of * from / 100,
        max: of * to / 100,
    }
}

fn number(length: Length) -> f64 {
    length as f64 / UNIT as f64
}

impl<'r> Draft<'r> {
    /// Nothing yet; lengths will have 0 to 3 decimals.
    pub fn new(random: &'r mut Random) -> Self {
        let step = random.choose(&[UNIT, UNIT, UNIT / 10, UNIT / 10, UNIT / 100, UNIT / 1000]);
        let model = Model::with_notation(Notation::Decimal);
        Self {
            random,
            model,
            step,
        }
    }

    /// A length in units from one to another.
    pub fn length(&mut self, min: Length, max: Length) -> Length {
        self.between(Range {
            min: min * UNIT,
            max: max * UNIT,
        })
    }

    /// A length between bounds, with more decimals only where there is none with the part's own.
    pub fn between(&mut self, Range { min, max }: Range) -> Length {
        let mut step = self.step;
        loop {
            let first = (min + step - 1).div_euclid(step);
            let last = max.div_euclid(step);
            if first <= last {
                return step * (first + self.random.below((last - first + 1) as usize) as Length);
            }
            if step == 1 {
                return min;
            }
            step /= 10;
        }
    }

    /// The part of a length from one percentage to another.
    pub fn part_of(&mut self, of: Length, from: Length, to: Length) -> Length {
        self.between(percent(of, from, to))
    }

    /// True once in `n` times.
    pub fn once_in(&mut self, n: usize) -> bool {
        self.random.once_in(n)
    }

    fn leaf(&mut self, primitive: Primitive, mut steps: Vec<Step>, at: Place) -> NodeId {
        if at != [0; 3] {
            steps.push(Step::Shift(at.map(number)));
        }
        self.model.leaf(primitive, steps)
    }

    /// A block with its lowest corner at a place.
    pub fn block(&mut self, size: Place, at: Place) -> NodeId {
        self.leaf(Primitive::Block(size.map(number)), Vec::new(), at)
    }

    /// A block with x and y centred about a place, its base there.
    pub fn centred(&mut self, [x, y, z]: Place, at: Place) -> NodeId {
        self.block([x, y, z], [at[0] - x / 2, at[1] - y / 2, at[2]])
    }

    /// A wedge with its right-angled edge along y through a place, turned about z by right angles.
    pub fn wedge(&mut self, size: Place, right_angles: usize, at: Place) -> NodeId {
        let steps = match right_angles % 4 {
            0 => Vec::new(),
            n => vec![Step::Turn(Axis::Z, 90.0 * n as f64)],
        };
        self.leaf(Primitive::Wedge(size.map(number)), steps, at)
    }

    /// A cylinder from the middle of its base at a place, in the direction of an axis.
    pub fn cylinder(&mut self, axis: Axis, r: Length, h: Length, at: Place) -> NodeId {
        let (r, h) = (number(r), number(h));
        self.leaf(Primitive::Cylinder { r, h }, along(axis), at)
    }

    /// A frustum about z, or a cylinder where both radii are the same.
    pub fn frustum(&mut self, r1: Length, r2: Length, h: Length, at: Place) -> NodeId {
        if r1 == r2 {
            return self.cylinder(Axis::Z, r1, h, at);
        }
        let [r1, r2, h] = [r1, r2, h].map(number);
        self.leaf(Primitive::Frustum { r1, r2, h }, Vec::new(), at)
    }

    /// A sphere about a place.
    pub fn sphere(&mut self, r: Length, at: Place) -> NodeId {
        self.leaf(Primitive::Sphere(number(r)), Vec::new(), at)
    }

    /// A torus about a place, with its axis in the direction of an axis.
    pub fn torus(&mut self, axis: Axis, major: Length, minor: Length, at: Place) -> NodeId {
        let (major, minor) = (number(major), number(minor));
        self.leaf(Primitive::Torus { major, minor }, along(axis), at)
    }

    /// What is in any of these.
    pub fn union(&mut self, of: Vec<NodeId>) -> NodeId {
        match of.as_slice() {
            &[only] => only,
            _ => self.model.operation(Operation::Union, of, Vec::new()),
        }
    }

    /// What is in the first and in none of the tools.
    pub fn difference(&mut self, of: NodeId, tools: Vec<NodeId>) -> NodeId {
        if tools.is_empty() {
            return of;
        }
        let mut all = vec![of];
        all.extend(tools);
        self.model.operation(Operation::Difference, all, Vec::new())
    }

    /// What is in both.
    pub fn intersection(&mut self, a: NodeId, b: NodeId) -> NodeId {
        self.model
            .operation(Operation::Intersection, vec![a, b], Vec::new())
    }

    /// Turns a node about z.
    pub fn turn_about_z(&mut self, node: NodeId, degrees: f64) -> NodeId {
        if let (true, Some(node)) = (degrees != 0.0, self.model.node_mut(node)) {
            node.steps.push(Step::Turn(Axis::Z, degrees));
        }
        node
    }

    /// As many as wanted about z, evenly, each made at the angle zero.
    pub fn circle(
        &mut self,
        count: usize,
        mut make: impl FnMut(&mut Self) -> NodeId,
    ) -> Vec<NodeId> {
        let start = self.random.choose(&[0.0, 0.0, 0.5]);
        let each = |k: usize| 360.0 * (k as f64 + start) / count as f64;
        (0..count)
            .map(|k| {
                let node = make(self);
                self.turn_about_z(node, each(k))
            })
            .collect()
    }

    /// A hole of radius `r` through `depth`: plain, blind, counterbored or countersunk to the radius
    /// `wide`.
    pub fn hole(&mut self, r: Length, wide: Length, depth: Length) -> Hole {
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

    /// The tools that make a hole down from a place: they stand out above, and below if they go
    /// through.
    pub fn drill(&mut self, hole: &Hole, [x, y, top]: Place) -> Vec<NodeId> {
        let Hole { r, depth, form } = *hole;
        if let Form::Blind { deep, pointed } = form {
            let floor = top - deep;
            let mut tools = vec![self.cylinder(Axis::Z, r, deep + UNIT, [x, y, floor])];
            // As the drill leaves it.
            let point = (r / 2).min((depth - deep) / 2);
            if pointed && point > 0 {
                tools.push(self.frustum(0, r, point, [x, y, floor - point]));
            }
            return tools;
        }
        let low = top - depth - UNIT;
        let mut tools = vec![self.cylinder(Axis::Z, r, depth + 2 * UNIT, [x, y, low])];
        match form {
            Form::Plain | Form::Blind { .. } => {}
            Form::Counterbored { wide, deep } => {
                tools.push(self.cylinder(Axis::Z, wide, deep + UNIT, [x, y, top - deep]));
            }
            Form::Countersunk { wide, deep } => {
                tools.push(self.frustum(r, wide, deep, [x, y, top - deep]));
            }
        }
        tools
    }
}

/// A hole that is made in one place or many.
#[derive(Clone, Copy, Debug)]
pub struct Hole {
    r: Length,
    depth: Length,
    form: Form,
}

/// What a hole is like below its rim.
#[derive(Clone, Copy, Debug)]
enum Form {
    Plain,
    Blind { deep: Length, pointed: bool },
    Counterbored { wide: Length, deep: Length },
    Countersunk { wide: Length, deep: Length },
}

/// From the direction of z to that of an axis.
fn along(axis: Axis) -> Vec<Step> {
    match axis {
        Axis::X => vec![Step::Turn(Axis::Y, 90.0)],
        Axis::Y => vec![Step::Turn(Axis::X, -90.0)],
        Axis::Z => Vec::new(),
    }
}
