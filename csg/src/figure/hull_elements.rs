//! The elements of which convex hulls are made: points, discs and arcs.

use super::FigurePoint;
use premio_kernel::number::rational::{Rational, to_f64};

/// A disc, or a point if its radius is zero.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Disc {
    /// The centre.
    pub centre: FigurePoint,
    /// The radius.
    pub radius: Rational,
}

impl Disc {
    /// A point.
    pub fn point(centre: FigurePoint) -> Self {
        let radius = Rational::ZERO;
        Self { centre, radius }
    }

    /// Whether it is a point at this place.
    pub(super) fn is_at(&self, point: &FigurePoint) -> bool {
        self.radius.is_zero() && self.centre == *point
    }

    /// Whether it contains another one.
    pub(super) fn contains(&self, other: &Self) -> bool {
        let more = &self.radius - &other.radius;
        more >= Rational::ZERO && square(self, other) <= &more * &more
    }
}

/// The square of the distance between two centres.
pub(super) fn square(a: &Disc, b: &Disc) -> Rational {
    let [x, y] = [0, 1].map(|i| &b.centre[i] - &a.centre[i]);
    &x * &x + &y * &y
}

/// An element of which a hull is made.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum HullElement {
    /// A whole disc, or a point if its radius is zero.
    Disc(Disc),
    /// An arc that bulges, counterclockwise from an end to another one.
    Arc {
        /// The disc of its circle.
        disc: Disc,
        /// Its ends.
        ends: [FigurePoint; 2],
    },
}

impl HullElement {
    /// The disc of its circle.
    pub fn disc(&self) -> &Disc {
        match self {
            Self::Disc(disc) | Self::Arc { disc, .. } => disc,
        }
    }

    /// It with other points.
    pub(super) fn with_points(&self, mut at: impl FnMut(&FigurePoint) -> FigurePoint) -> Self {
        match self {
            Self::Disc(disc) if disc.radius.is_zero() => Self::Disc(Disc::point(at(&disc.centre))),
            Self::Disc(_) => self.clone(),
            Self::Arc { disc, ends } => Self::Arc {
                disc: disc.clone(),
                ends: ends.each_ref().map(at),
            },
        }
    }

    /// The greatest distance of its circle from the axes, rounded.
    pub(crate) fn reach(&self) -> f64 {
        let disc = self.disc();
        let [x, y] = disc.centre.each_ref().map(|x| to_f64(x).abs());
        x.max(y) + to_f64(&disc.radius)
    }

    /// The image under a motion of the plane, which may turn it over.
    pub fn placed(&self, place: impl Fn(&FigurePoint) -> FigurePoint, is_over: bool) -> Self {
        let disc = self.disc();
        let disc = Disc {
            centre: place(&disc.centre),
            radius: disc.radius.clone(),
        };
        match self {
            Self::Disc(_) => Self::Disc(disc),
            Self::Arc { ends, .. } => {
                let mut ends = ends.each_ref().map(place);
                if is_over {
                    ends.reverse();
                }
                Self::Arc { disc, ends }
            }
        }
    }
}
