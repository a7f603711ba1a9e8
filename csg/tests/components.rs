//! A part of components that are apart has one boundary.

use crate::common::{block, evaluated, shifted};
use approx::assert_relative_eq;
use premio_csg::builder::{Builder, SolidId};
use premio_csg::tree::{Operation, Tree};
use premio_kernel::brep::topology::Topology;

fn block_at(builder: &mut Builder, size: [i32; 3], at: [i32; 3]) -> SolidId {
    let block = block(builder, size);
    shifted(builder, block, at)
}

/// Two blocks of 4 x 4 x 4, 6 apart, with a bar of 2 x 2 taken from both and a corner of
/// 1 x 1 x 1 from the second one.
fn two_blocks() -> Tree {
    let mut builder = Builder::new();
    let blocks = [0, 10].map(|x| block_at(&mut builder, [4, 4, 4], [x, 0, 0]));
    let blocks = builder.operation(Operation::Union, &blocks);
    let bar = block_at(&mut builder, [20, 2, 2], [-1, 1, 1]);
    let corner = block_at(&mut builder, [2, 2, 2], [13, 3, 3]);
    let part = builder.operation(Operation::Difference, &[blocks, bar, corner]);
    builder.finish(part).unwrap()
}

fn is_consistent(topology: &Topology) -> bool {
    let mut coedges = topology.edges.iter().zip(0..);
    let mut faces = topology.faces.iter().zip(0..);
    let mut shells = topology.shells.iter().zip(0..);
    coedges.all(|(edge, id)| {
        let mut own = edge.coedges.iter();
        own.all(|&coedge| topology.coedge(coedge).edge.0 == id)
    }) && faces.all(|(face, id)| face.loops.iter().all(|&of| topology.ring(of).face.0 == id))
        && shells.all(|(shell, id)| {
            let mut own = shell.faces.iter();
            own.all(|&face| topology.face(face).shell.0 == id)
        })
}

#[test]
fn the_boundary_of_components_is_that_of_the_part() {
    let known = evaluated(&two_blocks());
    let mass = known.mass();
    // Two blocks without their bars, and the corner of the second one.
    assert_relative_eq!(mass.volume, 2.0 * (64.0 - 16.0) - 1.0, max_relative = 1e-12);
    assert_relative_eq!(mass.area, 2.0 * (96.0 - 8.0 + 32.0), max_relative = 1e-12);
    // The corner, at (13.5, 3.5, 3.5), moves the centroid from (7, 2, 2).
    assert_relative_eq!(
        mass.centroid.x,
        (7.0 * 96.0 - 13.5) / 95.0,
        max_relative = 1e-12
    );
    assert_relative_eq!(
        mass.centroid.z,
        (2.0 * 96.0 - 3.5) / 95.0,
        max_relative = 1e-12
    );
    let topology = &known.brep.topology;
    assert!(is_consistent(topology));
    assert_eq!(topology.census().genus, [1, 1]);
    assert_eq!(topology.solids.len(), 2);
    let bounds = known.tight_bounds();
    assert_eq!([bounds.min, bounds.max], [[0.0; 3], [14.0, 4.0, 4.0]]);
}
