//! Boundaries that f64 cannot hold.

use crate::common::{evaluated, tree};
use premio_csg::evaluate::ViewLimit;
use premio_csg::reader::Format;

/// Two ellipsoids that differ by 2e-10 meet on a cone whose apex is 6e10 away.
#[test]
fn an_edge_over_a_distant_apex_has_no_view() {
    let known = evaluated(&tree(
        "PART = (
           ELL((2, 1, 0), (0, 2, 0.5), (0, 0, 1))
           UN ELL((2.00000000023283064365386962890625, 1, 0), (0, 2, 0.5), (0, 0, 1))
             AT (MOVY=0.5, MOVZ=-1)
         )\n",
        Format::Padl,
    ));
    let Some(ViewLimit::Rounded { gap }) = known.view_limit() else {
        panic!("{:?}", known.view_limit());
    };
    assert!(gap > 1e-6, "{gap}");
    assert_eq!(known.brep.topology.edge_ids().count(), 1);
}

#[test]
fn an_edge_of_near_contact_has_a_view() {
    let known = evaluated(&tree(
        "PART = SPH(R=1) UN CYL(R=1.0000000001, H=2)\n",
        Format::Padl,
    ));
    assert_eq!(known.view_limit(), None);
}
