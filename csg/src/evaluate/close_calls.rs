//! Close calls of which it is not yet known whether they concern the boundary.

use premio_kernel::number::predicates::CloseCall;

/// The entities between which a close call lies.
#[derive(Clone, Debug)]
pub(super) enum Between {
    /// Two corners.
    Corners([usize; 2]),
    /// A corner and a point, defined by these carriers, that was merged with it.
    CornerAndPoint { corner: usize, carriers: Vec<usize> },
    /// A curve, by its index, and a carrier.
    Curve { meeting: usize, carrier: usize },
    /// Two carriers.
    Carriers([usize; 2]),
}

/// A close call, not yet listed.
#[derive(Clone, Debug)]
pub(super) struct Unlisted {
    pub call: CloseCall,
    pub between: Between,
}
