//! Rigid motions as the sequence of steps by which a description gives them, so that they can be
//! written as they were read.

use premio_kernel::motion::{Motion, MotionError, RationalMatrix};
use premio_kernel::number::rational::Rational;

/// A step of a motion, in the frame of the surroundings.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum TransformStep {
    /// A translation along x, y and z.
    Shift([Rational; 3]),
    /// A rotation about an axis through the origin.
    Turn {
        /// The axis; its length is ignored.
        axis: [Rational; 3],
        /// The angle in degrees, right-handed.
        degrees: Rational,
    },
    /// The rotation of a quaternion `w + x i + y j + z k` of any length.
    Quaternion([Rational; 4]),
}

impl TransformStep {
    /// A rotation about a coordinate axis, given by its index.
    pub(crate) fn about(axis: usize, degrees: Rational) -> Self {
        Self::Turn {
            axis: along(axis, Rational::ONE),
            degrees,
        }
    }

    /// The motion of this step.
    pub(crate) fn motion(&self) -> Result<Motion, MotionError> {
        match self {
            Self::Shift(offset) => Ok(Motion::translation(offset.clone())),
            Self::Turn { axis, degrees } => Motion::rotation(axis.clone(), degrees),
            Self::Quaternion(quaternion) => {
                Motion::from_quaternion(quaternion.clone()).ok_or(MotionError::ZeroAxis)
            }
        }
    }

    /// Whether it is a translation, or maps coordinate axes to coordinate axes.
    pub(crate) fn is_simple(&self) -> bool {
        match self {
            Self::Shift(_) => true,
            Self::Turn { axis, degrees } => {
                let across = axis.iter().filter(|x| x.is_zero()).count();
                across == 2 && (degrees / Rational::from(90)).is_int()
            }
            Self::Quaternion(_) => false,
        }
    }

    /// The mirror image of this step under `y -> -y`.
    pub(crate) fn mirrored_y(&self) -> Self {
        match self {
            Self::Shift([x, y, z]) => Self::Shift([x.clone(), -y, z.clone()]),
            // A mirror reverses an axis, except its component perpendicular to the mirror.
            Self::Turn {
                axis: [x, y, z],
                degrees,
            } => Self::Turn {
                axis: [-x, y.clone(), -z],
                degrees: degrees.clone(),
            },
            Self::Quaternion([w, x, y, z]) => Self::Quaternion([w.clone(), -x, y.clone(), -z]),
        }
    }

    /// This step with all lengths multiplied by `factor`.
    pub(crate) fn scaled(&self, factor: &Rational) -> Self {
        match self {
            Self::Shift(offset) => Self::Shift(offset.each_ref().map(|x| x * factor)),
            Self::Turn { .. } | Self::Quaternion(_) => self.clone(),
        }
    }
}

/// A vector along a coordinate axis, given by its index.
pub(crate) fn along(axis: usize, length: Rational) -> [Rational; 3] {
    let mut vector: [Rational; 3] = Default::default();
    vector[axis] = length;
    vector
}

/// A sequence of steps, and the motion that they compose to.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Transform {
    pub(crate) steps: Vec<TransformStep>,
    /// The motion to which the steps compose.
    pub(crate) motion: Motion,
}

impl Transform {
    /// No steps.
    pub fn new() -> Self {
        Self::default()
    }

    /// A single translation.
    /// The steps of a motion: a rotation, and then a shift.
    pub(crate) fn from_motion(motion: &Motion) -> Self {
        let mut steps = Vec::new();
        let turn = Motion::from_quaternion(motion.quaternion()).unwrap_or_default();
        if !turn.is_identity() {
            steps.push(TransformStep::Quaternion(motion.quaternion()));
        }
        if motion.offset().iter().any(|x| !x.is_zero()) {
            steps.push(TransformStep::Shift(motion.offset().clone()));
        }
        Self {
            steps,
            motion: motion.clone(),
        }
    }

    pub(crate) fn shift(offset: [Rational; 3]) -> Self {
        let motion = Motion::translation(offset.clone());
        let steps = vec![TransformStep::Shift(offset)];
        Self { steps, motion }
    }

    /// The quarter turns about coordinate axes that compose to a matrix of zeros, ones and minus
    /// ones; `None` for another matrix and for a mirror.
    pub(crate) fn quarter_turns(matrix: &RationalMatrix) -> Option<Self> {
        // Every such matrix is a rotation about x, then one about y, then one about z.
        let quarters = || [0, 90, 180, 270];
        let angles = quarters().into_iter().flat_map(|x| {
            let rest = quarters().into_iter();
            rest.flat_map(move |y| quarters().map(move |z| [x, y, z]))
        });
        angles
            .map(Self::about_axes)
            .find(|moves| moves.motion.rotation_matrix() == *matrix)
    }

    /// Rotations about x, y and z in this order, by whole degrees.
    fn about_axes(degrees: [i32; 3]) -> Self {
        let mut moves = Self::new();
        for (axis, degrees) in degrees.into_iter().enumerate() {
            if degrees != 0 {
                // A coordinate axis has a direction.
                let _ = moves.push(TransformStep::about(axis, degrees.into()));
            }
        }
        moves
    }

    /// The same motion in fewer steps: consecutive translations and quarter turns are merged.
    pub(crate) fn tidied(steps: Vec<TransformStep>) -> Vec<TransformStep> {
        let mut tidy = Vec::with_capacity(steps.len());
        for run in steps.chunk_by(|a, b| a.is_simple() == b.is_simple()) {
            let fewer = Self::in_one_turn(run).filter(|fewer| fewer.len() < run.len());
            tidy.extend(fewer.unwrap_or_else(|| run.to_vec()));
        }
        tidy
    }

    /// Quarter turns and translations merged to quarter turns and one translation.
    fn in_one_turn(run: &[TransformStep]) -> Option<Vec<TransformStep>> {
        let mut all = Self::new();
        for step in run {
            all.push(step.clone()).ok()?;
        }
        let mut fewer = Self::quarter_turns(&all.motion.rotation_matrix())?.steps;
        let offset = all.motion.offset();
        if offset.iter().any(|x| !x.is_zero()) {
            fewer.push(TransformStep::Shift(offset.clone()));
        }
        Some(fewer)
    }

    /// Appends a step.
    ///
    /// # Errors
    /// The step is a rotation whose axis is zero or beyond the range of f64. It is not appended.
    pub fn push(&mut self, step: TransformStep) -> Result<(), MotionError> {
        self.motion = self.motion.then(&step.motion()?);
        self.steps.push(step);
        Ok(())
    }

    /// The composition: these steps first, then the others.
    pub(crate) fn then(mut self, later: Self) -> Self {
        self.motion = self.motion.then(&later.motion);
        self.steps.extend(later.steps);
        self
    }

    /// The composition of the steps.
    pub(crate) fn motion(&self) -> &Motion {
        &self.motion
    }

    /// The steps, in order.
    pub(crate) fn steps(&self) -> &[TransformStep] {
        &self.steps
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn steps() -> [TransformStep; 4] {
        let n = |values: [i32; 3]| values.map(Rational::from);
        [
            TransformStep::Shift(n([1, 2, 3])),
            TransformStep::Turn {
                axis: n([1, -2, 5]),
                degrees: 31.into(),
            },
            TransformStep::Turn {
                axis: n([0, 0, -3]),
                degrees: 90.into(),
            },
            TransformStep::Quaternion([3, 1, -4, 1].map(Rational::from)),
        ]
    }

    #[test]
    fn a_mirrored_step_is_the_motion_in_the_mirror() {
        for step in steps() {
            let mirrored = step.mirrored_y().motion().unwrap();
            assert_eq!(mirrored, step.motion().unwrap().mirrored_y(), "{step:?}");
        }
    }

    #[test]
    fn every_quarter_turn_is_found() {
        let mut found = std::collections::HashSet::new();
        for x in 0..4 {
            for y in 0..4 {
                for z in 0..4 {
                    let moves = Transform::about_axes([x, y, z].map(|quarter| 90 * quarter));
                    let matrix = moves.motion().rotation_matrix();
                    let again = Transform::quarter_turns(&matrix).unwrap();
                    assert_eq!(again.motion(), moves.motion());
                    found.insert(format!("{matrix:?}"));
                }
            }
        }
        assert_eq!(found.len(), 24);
        let mirror = [[-1, 0, 0], [0, 1, 0], [0, 0, 1]].map(|row| row.map(Rational::from));
        assert_eq!(Transform::quarter_turns(&mirror), None);
    }

    #[test]
    fn quarter_turns_and_shifts_are_tidied() {
        let shift = |x: i32, y: i32, z: i32| TransformStep::Shift([x, y, z].map(Rational::from));
        let there = [
            shift(1, 2, 3),
            TransformStep::about(0, 90.into()),
            shift(0, 3, 0),
        ];
        let back = [
            shift(0, -3, 0),
            TransformStep::about(0, 270.into()),
            shift(-1, -2, -3),
        ];
        assert_eq!(Transform::tidied([there.clone(), back].concat()), []);
        // A sequence that cannot be shortened stays as it was written.
        let [before, turn, _] = there.clone();
        let two = vec![before, turn];
        assert_eq!(Transform::tidied(two.clone()), two);
        let oblique = TransformStep::about(2, 7.into());
        let steps = [&there[..], std::slice::from_ref(&oblique), &there].concat();
        let fewer = [TransformStep::about(0, 90.into()), shift(1, 0, 2)];
        let expected = [&fewer[..], &[oblique], &fewer].concat();
        assert_eq!(Transform::tidied(steps), expected);
    }

    #[test]
    fn steps_come_to_one_motion() {
        let mut moves = Transform::new();
        let mut motion = Motion::identity();
        for step in steps() {
            motion = motion.then(&step.motion().unwrap());
            moves.push(step).unwrap();
        }
        assert_eq!(moves.motion(), &motion);
        let nothing = TransformStep::Quaternion([0, 0, 0, 0].map(Rational::from));
        assert_eq!(moves.push(nothing), Err(MotionError::ZeroAxis));
        assert_eq!(moves.steps().len(), 4);
    }
}
