//! Close calls of which it is not yet known whether they concern the boundary.

use premio_kernel::number::predicates::CloseCall;

/// The entities between which a close call lies.
#[derive(Clone, Debug)]
pub(super) enum Between {
    /// Two corners.
    Corners([usize; 2]),
    /// A corner and a point, defined by these carriers, that was merged with it.
    CornerAndPoint(usize, Vec<usize>),
    /// A curve, by its index, and a carrier.
    Curve(usize, usize),
    /// Two carriers.
    Carriers([usize; 2]),
}

/// A close call, not yet listed.
pub(super) type Unlisted = (CloseCall, Between);
