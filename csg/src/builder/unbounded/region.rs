//! The set of points of a part, and whether cells are inside or outside.

use super::enclosure::Ball;
use super::linear_form::{Cell, LinearForm, square};
use crate::builder::expansion::Expansion;
use crate::builder::{Builder, BuilderNode, MAX_MOTION_BITS, Placement, TreeError, UnboundedNode};
use crate::polyhedron::HalfSpace;
use crate::primitive::UnboundedPrimitive;
use crate::ray_casting::RayOracle;
use crate::tree::Operation;
use premio_kernel::number::rational::to_f64;
use std::rc::Rc;

/// A solid in space.
#[derive(Debug, Clone)]
enum Shape {
    /// All points.
    Everything,
    /// No point.
    Nothing,
    /// n · p <= d, as a form that is negative inside.
    HalfSpace(LinearForm),
    /// The points within the radius of an axis, by the coordinates across it.
    Cylinder {
        across: [LinearForm; 2],
        radius: f64,
    },
    /// The nappe of a cone, by the coordinates across its axis and along it.
    Cone {
        across: [LinearForm; 2],
        along: LinearForm,
        slope: f64,
    },
    /// Something within the box from the first corner to the second.
    Bounded([[f64; 3]; 2]),
}

/// A node of a region.
#[derive(Debug, Clone)]
enum RegionNode {
    Leaf(Shape),
    Operation { op: Operation, children: Vec<usize> },
}

/// The relation of a node to a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Status {
    Inside,
    Outside,
    /// Not known, for the node of this index in the reduced region.
    Unknown(usize),
}

/// A use of an unbounded solid, or of an intersection with such a solid.
#[derive(Debug, Clone)]
struct UnboundedUse {
    draft: usize,
    /// The coordinates in the frame of the solid.
    local: [LinearForm; 3],
    factor: f64,
}

impl UnboundedUse {
    fn new(draft: usize, placement: &Placement) -> Self {
        let turn = placement.motion.rotation_f64();
        let shift = placement.motion.translation_f64();
        let factor = placement.factor.as_ref().map_or(1.0, to_f64);
        let local = [0, 1, 2].map(|i| {
            let is_mirrored = placement.mirrored && i == 1;
            let mirror = if is_mirrored { -1.0 } else { 1.0 };
            let axis = turn.column(i) * (mirror / factor);
            LinearForm {
                a: axis.into(),
                b: -axis.dot(&shift),
            }
        });
        Self {
            draft,
            local,
            factor,
        }
    }
}

/// The set of points of a part. A node comes after its components; the last one is the part.
#[derive(Debug, Clone, Default)]
pub(super) struct Region {
    nodes: Vec<RegionNode>,
    uses: Vec<UnboundedUse>,
    reach: f64,
}

/// What is known of a region in a cell.
#[derive(Debug, Clone)]
pub(super) enum RegionInCell {
    Inside,
    Outside,
    /// The nodes on which the cell depends.
    Unknown(Region),
}

/// A step of the construction of a region.
enum Step {
    Enter(usize, Rc<Placement>),
    Combine { op: Operation, count: usize },
}

/// A placement followed by another one.
fn moved(inner: &Placement, outer: &Placement) -> Result<Rc<Placement>, TreeError> {
    let both = inner.then(outer);
    let bits = both.bits();
    match bits > MAX_MOTION_BITS {
        true => Err(TreeError::NumbersTooLong { bits }),
        false => Ok(Rc::new(both)),
    }
}

/// The box of a draft without unbounded solids.
fn bounded_shape(
    builder: &Builder,
    draft: usize,
    placement: Placement,
) -> Result<Shape, TreeError> {
    let mut expansion = Expansion::new(builder);
    expansion.run(draft, placement)?;
    let bounds = RayOracle::new(&expansion.tree).bounds().to_owned();
    let is_empty = (0..3).any(|i| bounds.min[i] > bounds.max[i]);
    Ok(match is_empty {
        true => Shape::Nothing,
        false => Shape::Bounded([bounds.min, bounds.max]),
    })
}

impl Region {
    /// The region of a draft without complements.
    ///
    /// # Errors
    /// The tree exceeds a limit.
    pub fn new(builder: &Builder, top: usize) -> Result<Self, TreeError> {
        let mut region = Self::default();
        let mut steps = vec![Step::Enter(top, Rc::default())];
        let mut done: Vec<usize> = Vec::new();
        while let Some(step) = steps.pop() {
            match step {
                Step::Enter(draft, placement) if !builder.has_unbounded_part[draft] => {
                    let shape = bounded_shape(builder, draft, Rc::unwrap_or_clone(placement))?;
                    done.push(region.add(RegionNode::Leaf(shape)));
                }
                Step::Enter(draft, placement) => match builder.draft(draft) {
                    BuilderNode::Unbounded(UnboundedNode::Leaf(primitive)) => {
                        let shape = region.place(draft, primitive, &placement);
                        done.push(region.add(RegionNode::Leaf(shape)));
                    }
                    BuilderNode::Operation { op, children } => {
                        let count = children.len();
                        if *op == Operation::Intersection {
                            region.uses.push(UnboundedUse::new(draft, &placement));
                        }
                        steps.push(Step::Combine { op: *op, count });
                        let enter = |&child: &usize| Step::Enter(child, Rc::clone(&placement));
                        steps.extend(children.iter().rev().map(enter));
                    }
                    BuilderNode::Moved {
                        child,
                        placement: inner,
                        ..
                    } => steps.push(Step::Enter(*child, moved(inner, &placement)?)),
                    BuilderNode::Leaf(_) | BuilderNode::Unbounded(UnboundedNode::Complement(_)) => {
                    }
                },
                Step::Combine { op, count } => {
                    let children = done.split_off(done.len().saturating_sub(count));
                    done.push(region.add(RegionNode::Operation { op, children }));
                }
            }
        }
        region.reach = region.furthest();
        Ok(region)
    }

    fn add(&mut self, node: RegionNode) -> usize {
        self.nodes.push(node);
        self.nodes.len() - 1
    }

    fn place(
        &mut self,
        draft: usize,
        primitive: &UnboundedPrimitive,
        placement: &Placement,
    ) -> Shape {
        let used = UnboundedUse::new(draft, placement);
        let local = used.local;
        self.uses.push(used);
        let [x, y, z] = local;
        match primitive {
            UnboundedPrimitive::HalfSpace(HalfSpace { normal, offset }) => {
                let normal = normal.each_ref().map(to_f64);
                let sum = |parts: [f64; 3]| -> f64 {
                    normal.iter().zip(parts).map(|(n, part)| n * part).sum()
                };
                Shape::HalfSpace(LinearForm {
                    a: [0, 1, 2].map(|i| sum(local.map(|form| form.a[i]))),
                    b: sum(local.map(|form| form.b)) - to_f64(offset),
                })
            }
            UnboundedPrimitive::Cylinder { radius } => Shape::Cylinder {
                across: [x, y],
                radius: to_f64(radius),
            },
            UnboundedPrimitive::Cone { slope } => Shape::Cone {
                across: [x, y],
                along: z,
                slope: to_f64(slope),
            },
        }
    }

    /// The distance from the origin within which all boxes are, and the closest points of all planes,
    /// axes and apexes.
    fn furthest(&self) -> f64 {
        let boxes = self.nodes.iter().map(|node| match node {
            RegionNode::Leaf(Shape::Bounded(corners)) => {
                let most = corners
                    .iter()
                    .flatten()
                    .fold(0.0, |most: f64, x| most.max(x.abs()));
                2.0 * most
            }
            RegionNode::Leaf(Shape::HalfSpace(LinearForm { a, b })) => {
                let size = a.iter().map(|x| x * x).sum::<f64>().sqrt();
                b.abs() / size
            }
            RegionNode::Leaf(Shape::Cylinder { across, radius }) => {
                let [x, y] = across.map(|form| form.b);
                let unit = across[0].a.iter().map(|x| x * x).sum::<f64>().sqrt();
                (x.hypot(y) + radius) / unit
            }
            RegionNode::Leaf(Shape::Cone { across, along, .. }) => {
                let [x, y] = across.map(|form| form.b);
                let unit = along.a.iter().map(|x| x * x).sum::<f64>().sqrt();
                x.hypot(y).hypot(along.b) / unit
            }
            RegionNode::Leaf(Shape::Everything | Shape::Nothing) | RegionNode::Operation { .. } => {
                0.0
            }
        });
        boxes.filter(|far| far.is_finite()).fold(0.0, f64::max)
    }

    /// The distance from the origin within which the solids are, or the closest points of unbounded ones.
    pub fn reach(&self) -> f64 {
        match self.reach > 0.0 {
            true => self.reach,
            false => 1.0,
        }
    }

    /// The number of nodes.
    pub fn node_count(&self) -> usize {
        self.nodes.len()
    }

    /// The region in a cell.
    pub fn within(&self, cell: &Cell) -> RegionInCell {
        let mut reduced = Self::default();
        let mut statuses: Vec<Status> = Vec::with_capacity(self.nodes.len());
        for node in &self.nodes {
            let status = match node {
                RegionNode::Leaf(shape) => match shape.side(cell) {
                    Some(true) => Status::Inside,
                    Some(false) => Status::Outside,
                    None => Status::Unknown(reduced.add(node.clone())),
                },
                RegionNode::Operation { op, children } => {
                    let children: Vec<Status> =
                        children.iter().map(|&child| statuses[child]).collect();
                    reduced.combined(*op, &children)
                }
            };
            statuses.push(status);
        }
        match statuses.last() {
            Some(Status::Inside) => RegionInCell::Inside,
            Some(Status::Unknown(root)) => {
                // What comes after it is of decided nodes.
                reduced.nodes.truncate(root + 1);
                RegionInCell::Unknown(reduced)
            }
            Some(Status::Outside) | None => RegionInCell::Outside,
        }
    }

    /// Adds an operation on nodes, as far as it is not decided.
    fn combined(&mut self, op: Operation, children: &[Status]) -> Status {
        let unknown = children.iter().filter_map(|child| match child {
            Status::Unknown(index) => Some(*index),
            Status::Inside | Status::Outside => None,
        });
        let mut unknown: Vec<usize> = unknown.collect();
        let has = |status: Status, of: &[Status]| of.contains(&status);
        let (first, rest) = match children.split_first() {
            Some((first, rest)) => (*first, rest),
            None => return Status::Outside,
        };
        let decided = match op {
            Operation::Union if has(Status::Inside, children) => Some(Status::Inside),
            Operation::Intersection if has(Status::Outside, children) => Some(Status::Outside),
            Operation::Difference if first == Status::Outside || has(Status::Inside, rest) => {
                Some(Status::Outside)
            }
            Operation::Union if unknown.is_empty() => Some(Status::Outside),
            Operation::Intersection | Operation::Difference if unknown.is_empty() => {
                Some(Status::Inside)
            }
            _ => None,
        };
        if let Some(status) = decided {
            return status;
        }
        if op == Operation::Difference && first == Status::Inside {
            unknown.insert(0, self.add(RegionNode::Leaf(Shape::Everything)));
        }
        match unknown.as_slice() {
            [only] => Status::Unknown(*only),
            _ => Status::Unknown(self.add(RegionNode::Operation {
                op,
                children: unknown,
            })),
        }
    }

    /// A ball in the frame of a draft that contains a ball of space in every use of the draft; `None` if
    /// the draft is not used.
    pub fn local_ball(&self, draft: usize, ball: &Ball) -> Option<Ball> {
        let uses = self.uses.iter().filter(|used| used.draft == draft);
        let balls = uses.map(|used| Ball {
            centre: used.local.map(|form| form.at(&ball.centre)),
            radius: ball.radius / used.factor,
        });
        balls.reduce(|a, b| a.hull(&b))
    }
}

impl Shape {
    /// Whether a cell is inside or outside; `None` if that is not known.
    fn side(&self, cell: &Cell) -> Option<bool> {
        let decided = |is_inside: bool, is_outside: bool| match (is_inside, is_outside) {
            (true, _) => Some(true),
            (false, true) => Some(false),
            (false, false) => None,
        };
        let across = |forms: &[LinearForm; 2]| {
            let [x, y] = forms.map(|form| square(form.over(cell)));
            [x[0] + y[0], x[1] + y[1]]
        };
        match self {
            Self::Everything => Some(true),
            Self::Nothing => Some(false),
            Self::HalfSpace(form) => {
                let range = form.over(cell);
                decided(range.hi < 0.0, range.lo > 0.0)
            }
            Self::Cylinder {
                across: forms,
                radius,
            } => {
                let [least, most] = across(forms);
                let [near, far] = cell.w.map(|w| (radius * w) * (radius * w));
                decided(most < near, least > far)
            }
            Self::Cone {
                across: forms,
                along,
                slope,
            } => {
                let [least, most] = across(forms);
                let height = along.over(cell);
                let [low, high] = square(height).map(|square| slope * slope * square);
                decided(
                    height.lo > 0.0 && most < low,
                    height.hi < 0.0 || least > high,
                )
            }
            Self::Bounded([lo, hi]) => {
                let is_off = |i: usize| {
                    let unit = [0, 1, 2].map(|j| if i == j { 1.0 } else { 0.0 });
                    let from = |x: f64| LinearForm { a: unit, b: -x }.over(cell);
                    from(lo[i]).hi < 0.0 || from(hi[i]).lo > 0.0
                };
                decided(false, (0..3).any(is_off))
            }
        }
    }
}
