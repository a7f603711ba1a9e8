//! One operation on many primitives.

use crate::generator::model::{
    ModelAxis, ModelNodeId, ModelOperation, ModelPrimitive, ModelStep, PartModel,
};
use crate::generator::random::RandomChoices;

/// The random stream of this profile.
const PURPOSE: u64 = 4;

/// The distribution of primitives over the cells of a lattice.
struct Lattice {
    cells: [usize; 3],
    /// The distance between cells, in units.
    pitch: f64,
    /// The primitive for all cells; if none, each cell gets its own.
    common: Option<ModelPrimitive>,
}

/// A union of primitives in a lattice, a block minus such a lattice, or the intersection of large
/// primitives about the centre. Usually there are 10 to 60 primitives, one in 10 models has up to
/// 300, one in 100 up to 1500; intersections have 8 to 24.
pub(super) fn model(seed: u64) -> PartModel {
    let random = &mut RandomChoices::apart(seed, PURPOSE);
    match random.below(8) {
        0 => intersection(random),
        1..4 => lattice(random, ModelOperation::Union),
        _ => lattice(random, ModelOperation::Difference),
    }
}

fn lattice(random: &mut RandomChoices, op: ModelOperation) -> PartModel {
    let count = match random.below(100) {
        0 => random.between(300, 1500),
        1..10 => random.between(60, 300),
        _ => random.between(10, 60),
    };
    let cells = cells(random, count);
    let lattice = Lattice {
        cells,
        pitch: random.choose(&[1.0, 1.0, 1.5, 0.75]),
        common: (!random.once_in(4)).then(|| small(random)),
    };
    let mut model = PartModel::default();
    let mut children = Vec::new();
    if op == ModelOperation::Difference {
        children.push(plate(random, &mut model, &lattice));
    }
    let left_out = random.choose(&[0, 0, 8]);
    for cell in 0..cells.iter().product() {
        if left_out == 0 || !random.once_in(left_out) || children.is_empty() {
            children.push(in_cell(random, &mut model, &lattice, cell));
        }
    }
    if children.len() < 2 {
        children.push(in_cell(random, &mut model, &lattice, 0));
    }
    model.operation(op, children, Vec::new());
    model
}

/// The dimensions of a lattice of about so many cells: a row, a plane, or a block.
fn cells(random: &mut RandomChoices, count: usize) -> [usize; 3] {
    let count = count as f64;
    match random.below(8) {
        0 => [count as usize, 1, 1],
        1 | 2 => [count.cbrt().floor() as usize; 3],
        _ => {
            let side = count.sqrt() as usize;
            [side, count as usize / side, 1]
        }
    }
}

/// A block with the lattice inside it, through its faces or flush with them.
fn plate(random: &mut RandomChoices, model: &mut PartModel, lattice: &Lattice) -> ModelNodeId {
    let margin = random.choose(&[0.0, 0.5, 1.0]);
    let size = lattice
        .cells
        .map(|n| (n - 1) as f64 * lattice.pitch + 2.0 * margin + 0.5);
    let shift = ModelStep::Shift([-margin, -margin, -random.choose(&[0.0, 0.25, 0.5])]);
    model.leaf(ModelPrimitive::Block(size), vec![shift])
}

fn in_cell(
    random: &mut RandomChoices,
    model: &mut PartModel,
    lattice: &Lattice,
    cell: usize,
) -> ModelNodeId {
    let [nx, ny, _] = lattice.cells;
    let at = [cell % nx, cell / nx % ny, cell / (nx * ny)].map(|i| i as f64 * lattice.pitch);
    let primitive = lattice.common.unwrap_or_else(|| small(random));
    let mut steps = Vec::new();
    if lattice.common.is_none() && random.once_in(4) {
        let degrees = random.choose(&[90.0, 45.0, 30.0]);
        steps.push(ModelStep::Turn(ModelAxis::any(random), degrees));
    }
    steps.push(ModelStep::Shift(at));
    model.leaf(primitive, steps)
}

/// A primitive that touches its neighbours in a lattice, keeps a distance, or overlaps them.
fn small(random: &mut RandomChoices) -> ModelPrimitive {
    let r = random.choose(&[0.25, 0.375, 0.5, 0.5, 0.625]);
    let h = random.half(1, 3);
    match random.below(8) {
        0 | 1 => ModelPrimitive::Block([0; 3].map(|_| random.half(1, 3))),
        2 => ModelPrimitive::Wedge([0; 3].map(|_| random.half(1, 2))),
        3 | 4 => ModelPrimitive::Cylinder { r, h },
        5 => ModelPrimitive::Frustum {
            r1: r,
            r2: random.choose(&[0.0, 0.5 * r]),
            h,
        },
        6 => ModelPrimitive::Sphere(r),
        _ => ModelPrimitive::Torus {
            major: 0.375,
            minor: random.choose(&[0.125, 0.25]),
        },
    }
}

/// Large primitives that all contain the centre.
fn intersection(random: &mut RandomChoices) -> PartModel {
    let mut model = PartModel::default();
    let children = (0..random.between(8, 24))
        .map(|_| {
            let (primitive, middle) = match random.below(3) {
                0 => (ModelPrimitive::Block([8.0; 3]), [-4.0; 3]),
                1 => (ModelPrimitive::Sphere(4.0), [0.0; 3]),
                _ => {
                    let cylinder = ModelPrimitive::Cylinder { r: 4.0, h: 8.0 };
                    (cylinder, [0.0, 0.0, -4.0])
                }
            };
            let degrees = random.choose(&[0.0, 90.0, 45.0, 30.0, 17.0]);
            let turn = ModelStep::Turn(ModelAxis::any(random), degrees);
            let shift = [0; 3].map(|_| random.half(0, 8) - 2.0);
            model.leaf(
                primitive,
                vec![ModelStep::Shift(middle), turn, ModelStep::Shift(shift)],
            )
        })
        .collect();
    model.operation(ModelOperation::Intersection, children, Vec::new());
    model
}
