//! The two angles of a torus.

/// The angle that a segment is parameterised by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TorusParameter {
    /// θ, about the axis.
    Around,
    /// φ, about the tube.
    Tube,
}

/// (θ, φ), with the angle `axis` at `run` and the other one at `other`.
pub(super) fn arrange<T>(axis: TorusParameter, run: T, other: T) -> [T; 2] {
    match axis {
        TorusParameter::Around => [run, other],
        TorusParameter::Tube => [other, run],
    }
}
