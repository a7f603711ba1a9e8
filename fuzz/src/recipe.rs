//! Bytes read in sequence as choices.

use premio_verify::generator::model::{
    ModelAxis, ModelNodeId, ModelOperation, ModelPrimitive, ModelStep, PartModel,
};

/// Bytes that are read as choices; after their end every choice is the first one.
#[derive(Debug)]
pub struct Recipe<'a> {
    bytes: &'a [u8],
}

/// The viewpoint of a part.
#[derive(Clone, Copy, Debug)]
pub struct Sight {
    /// From the part towards the eye.
    pub direction: [f64; 3],
    /// The distance of a perspective camera in multiples of the part's size; none for an
    /// orthographic one.
    pub distance: Option<f64>,
}

/// The most primitives of a model.
const MOST: usize = 5;

/// The angles of the grid, in degrees.
const TURNS: [f64; 8] = [90.0, -90.0, 180.0, 45.0, 30.0, 17.0, 60.0, 36.875];

impl<'a> Recipe<'a> {
    /// The choices of these bytes.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    fn byte(&mut self) -> u8 {
        match self.bytes.split_first() {
            Some((&first, rest)) => {
                self.bytes = rest;
                first
            }
            None => 0,
        }
    }

    /// A whole number from 0 to `n` - 1.
    fn below(&mut self, n: usize) -> usize {
        usize::from(self.byte()) % n
    }

    /// A model of up to five primitives.
    pub fn model(&mut self) -> PartModel {
        let mut model = PartModel::default();
        let count = 1 + self.below(MOST);
        let mut open: Vec<ModelNodeId> = Vec::new();
        for _ in 0..count {
            let primitive = self.primitive();
            let steps = self.steps();
            open.push(model.leaf(primitive, steps));
            // Operations on the open solids, now or at the end.
            while open.len() > 1 && self.below(2) == 1 {
                let last = open.split_off(open.len() - 2);
                let steps = self.rarely_steps();
                open.push(model.operation(self.operation(), last, steps));
            }
        }
        if open.len() > 1 {
            let steps = self.rarely_steps();
            model.operation(self.operation(), open, steps);
        }
        model
    }

    fn operation(&mut self) -> ModelOperation {
        ModelOperation::ALL[self.below(ModelOperation::ALL.len())]
    }

    fn primitive(&mut self) -> ModelPrimitive {
        match self.below(7) {
            0 => ModelPrimitive::Block([0; 3].map(|_| self.length())),
            1 => ModelPrimitive::Wedge([0; 3].map(|_| self.length())),
            2 => ModelPrimitive::Cylinder {
                r: self.length(),
                h: self.length(),
            },
            3 => ModelPrimitive::Frustum {
                r1: self.length(),
                r2: 0.0,
                h: self.length(),
            },
            4 => {
                let (r1, h) = (self.length(), self.length());
                let r2 = match self.length() {
                    same if same == r1 => 0.0,
                    other => other,
                };
                ModelPrimitive::Frustum { r1, r2, h }
            }
            5 => ModelPrimitive::Sphere(self.length()),
            _ => {
                let minor = self.length();
                let major = minor + self.length();
                ModelPrimitive::Torus { major, minor }
            }
        }
    }

    /// A length of up to four units.
    fn length(&mut self) -> f64 {
        let half = |n: usize| (n + 1) as f64 / 2.0;
        match self.below(8) {
            0..=4 => half(self.below(8)),
            5 => (1 + self.below(32)) as f64 / 8.0,
            6 => half(self.below(8)) + self.little(),
            _ => (1.0 + self.fraction()) * 4.0 * (0.5 + self.fraction() / 2.0),
        }
    }

    /// A coordinate from -4 to 4.
    fn coordinate(&mut self) -> f64 {
        let half = |n: usize| n as f64 / 2.0 - 2.0;
        match self.below(8) {
            0..=5 => half(self.below(13)),
            6 => half(self.below(9)) + self.little(),
            _ => 8.0 * self.fraction() - 4.0,
        }
    }

    /// A number from 0 to 1.
    fn fraction(&mut self) -> f64 {
        let [high, low] = [self.byte(), self.byte()];
        f64::from(u16::from_be_bytes([high, low])) / 65536.0
    }

    /// A small number of any order of magnitude.
    fn little(&mut self) -> f64 {
        let size = 2f64.powi(-(10 + self.below(51) as i32));
        match self.below(2) {
            0 => size,
            _ => -size,
        }
    }

    fn rarely_steps(&mut self) -> Vec<ModelStep> {
        match self.below(4) {
            3 => self.steps(),
            _ => Vec::new(),
        }
    }

    fn steps(&mut self) -> Vec<ModelStep> {
        let mut steps = Vec::new();
        if self.below(3) == 2 {
            steps.push(self.turn());
        }
        if self.below(4) > 0 {
            steps.push(ModelStep::Shift([0; 3].map(|_| self.coordinate())));
        }
        if self.below(8) == 7 {
            steps.push(self.turn());
        }
        steps
    }

    fn turn(&mut self) -> ModelStep {
        let axis = ModelAxis::ALL[self.below(3)];
        let degrees = match self.below(4) {
            0 | 1 => TURNS[self.below(TURNS.len())],
            2 => self.little(),
            _ => 360.0 * self.fraction(),
        };
        ModelStep::Turn(axis, degrees)
    }

    /// A viewpoint.
    pub fn sight(&mut self) -> Sight {
        let distance = [None, Some(0.8), Some(2.0), Some(20.0)][self.below(4)];
        let direction = self.direction();
        Sight {
            direction,
            distance,
        }
    }

    /// Along an axis, a diagonal, or any.
    fn direction(&mut self) -> [f64; 3] {
        match self.below(2) {
            0 => [0; 3].map(|_| self.below(3) as f64 - 1.0),
            _ => [0; 3].map(|_| 2.0 * self.fraction() - 1.0),
        }
    }
}
