//! `multmatrix`: motions, mirrors and scales of solids and of regions of the plane.

use std::ops::Range;

use premio_kernel::motion::RationalMatrix;
use premio_kernel::number::rational::{Rational, exact_sqrt, from_decimal, to_f64};

use super::super::error::SpannedError;
use super::super::notes::Notes;
use super::super::refusal::construction_error;
use super::super::region::Region;
use super::super::rigid_fit::{NotRigid, Placement, placement};
use super::arguments::{Argument, Arguments};
use crate::builder::{Builder, SolidId};
use crate::construction::{AffineMap, mapped};
use crate::figure::PlaneMap;

/// A matrix as it is written, and the rigid placement that it stands for.
pub(super) struct Matrix {
    linear: RationalMatrix,
    offset: [Rational; 3],
    found: Result<Placement, NotRigid>,
    span: Range<usize>,
}

/// The rows of a 4 by 4 matrix.
fn rows(argument: &Argument) -> Result<[[Rational; 4]; 4], SpannedError> {
    let mut matrix: [[Rational; 4]; 4] = Default::default();
    let rows: &[Argument; 4] = argument.list("a matrix of four rows")?;
    for (row, argument) in matrix.iter_mut().zip(rows) {
        let entries: &[Argument; 4] = argument.list("a row of four numbers")?;
        for (entry, argument) in row.iter_mut().zip(entries) {
            *entry = argument.number()?.clone();
        }
    }
    let last = [0, 0, 0, 1].map(Rational::from);
    if matrix[3] != last {
        return Err(rows[3].wrong("the last row [0, 0, 0, 1] of an affine map"));
    }
    Ok(matrix)
}

impl Matrix {
    pub fn new(arguments: &mut Arguments, notes: &mut Notes) -> Result<Self, SpannedError> {
        arguments.bind(&["m"])?;
        let argument = arguments.require("m")?;
        let [a, b, c, _] = rows(argument)?;
        let split = |[x, y, z, t]: [Rational; 4]| ([x, y, z], t);
        let ((a, x), (b, y), (c, z)) = (split(a), split(b), split(c));
        let (linear, offset) = ([a, b, c], [x, y, z]);
        let found = placement(&linear, offset.clone());
        if let Ok(placement) = &found
            && placement.replaces()
        {
            notes.snapped(placement.residual, argument.span.clone());
        }
        Ok(Self {
            linear,
            offset,
            found,
            span: argument.span.clone(),
        })
    }

    /// The image of a region.
    pub fn of_region(self, region: Region) -> Result<Region, SpannedError> {
        let [a, b, c] = &self.linear;
        let beyond = [&a[2], &b[2], &c[0], &c[1]];
        if beyond.iter().any(|x| !x.is_zero()) {
            let found = "a matrix that leaves the plane, of a plane figure";
            let expected = "a map of the xy plane";
            return Err(SpannedError::input(self.span, found, expected));
        }
        let written = PlaneMap {
            matrix: [a, b].map(|row| [row[0].clone(), row[1].clone()]),
            offset: [self.offset[0].clone(), self.offset[1].clone()],
        };
        let Ok(placement) = self.found else {
            return Ok(region.mapped(&written, None));
        };
        let motion = placement.moves.motion();
        let [[a, b, _], [c, d, _], [_, _, up]] = motion.rotation_matrix();
        let matrix = match placement.mirrored {
            true => [[a, -b], [c, -d]],
            false => [[a, b], [c, d]],
        };
        let map = PlaneMap {
            matrix,
            offset: written.offset,
        };
        let is_motion = up.is_one() && !placement.mirrored && self.offset[2].is_zero();
        Ok(region.mapped(&map, is_motion.then_some(&placement.moves)))
    }

    /// The image of a solid.
    pub fn of_solid(self, builder: &mut Builder, part: SolidId) -> Result<SolidId, SpannedError> {
        if part.is_empty() {
            return Ok(part);
        }
        let (factor, placement) = match self.found {
            Ok(placement) => (Rational::ONE, placement),
            Err(_) => match self.uniform() {
                Some(uniform) => uniform,
                None => {
                    let map = AffineMap {
                        matrix: self.linear,
                        offset: self.offset,
                    };
                    let image = mapped(builder, part, &map);
                    return image.map_err(|error| construction_error(&error, &self.span));
                }
            },
        };
        let part = builder.scaled(part, factor);
        let part = match placement.mirrored {
            true => builder.mirrored_y(part),
            false => part,
        };
        Ok(builder.moved(part, placement.moves))
    }

    /// The factor and the placement of a map that scales equally in all directions.
    fn uniform(&self) -> Option<(Rational, Placement)> {
        let square = self.linear.iter().map(|row| &row[0] * &row[0]);
        let square = square.fold(Rational::ZERO, |sum, x| sum + x);
        let factor = exact_sqrt(&square).or_else(|| rounded_root(&square));
        let factor = factor.filter(|factor| !factor.is_zero())?;
        let rows = self.linear.each_ref();
        let unscaled = rows.map(|row| row.each_ref().map(|x| x / &factor));
        let placement = placement(&unscaled, self.offset.clone()).ok()?;
        Some((factor, placement))
    }
}

/// The square root rounded to the six digits that OpenSCAD writes.
fn rounded_root(square: &Rational) -> Option<Rational> {
    let root = to_f64(square).sqrt();
    from_decimal(&format!("{root:.5e}")).ok()
}
