//! Models as statements of a program in another language, put into a template.

use crate::generator::model::{
    ModelAxis, ModelNode, ModelNodeKind, ModelOperation, ModelPrimitive, ModelStep, PartModel,
};
use std::fmt::Write;

/// The language of a template.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum TemplateLanguage {
    /// Python: `s3 = difference([s1, s2])`.
    Python,
    /// C++: `auto s3 = difference({s1, s2});`.
    Cpp,
}

impl TemplateLanguage {
    /// Every language.
    pub const ALL: [Self; 2] = [Self::Python, Self::Cpp];

    /// The ending of its files.
    pub fn ending(self) -> &'static str {
        match self {
            Self::Python => "py",
            Self::Cpp => "cpp",
        }
    }

    /// The language of an ending.
    pub fn from_ending(ending: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|known| known.ending() == ending)
    }
}

/// A program with one line for the model.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelTemplate {
    language: TemplateLanguage,
    before: String,
    indent: String,
    after: String,
}

/// The mark of the line that a model replaces.
const MARK: &str = "{{model}}";

/// Why a text is no template.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("found {found} lines with `{{{{model}}}}`, expected one")]
pub struct TemplateError {
    /// The number of lines with the mark.
    found: usize,
}

impl ModelTemplate {
    /// A template of a text. The line with the mark is replaced; its indentation is kept.
    ///
    /// # Errors
    /// Not exactly one line has the mark.
    pub fn new(text: &str, language: TemplateLanguage) -> Result<Self, TemplateError> {
        let is_marked = |line: &&str| line.contains(MARK);
        let found = text.lines().filter(is_marked).count();
        let mut lines = text.split_inclusive('\n');
        let mut before = String::new();
        for line in lines.by_ref() {
            if line.contains(MARK) && found == 1 {
                let end = line.len() - line.trim_start().len();
                return Ok(Self {
                    language,
                    before,
                    indent: line[..end].to_owned(),
                    after: lines.collect(),
                });
            }
            before += line;
        }
        Err(TemplateError { found })
    }

    /// The ending of its programs.
    pub fn ending(&self) -> &'static str {
        self.language.ending()
    }

    /// The program of a model: a statement for each node, the last one defines `model`. `None` if
    /// the model has figures, hulls or Minkowski sums, for which there are no statements.
    pub fn program(&self, model: &PartModel) -> Option<String> {
        let mut text = self.before.clone();
        let last = model.nodes().len().saturating_sub(1);
        for (id, node) in model.nodes().iter().enumerate() {
            let name = match id == last {
                true => "model".to_owned(),
                false => format!("s{id}"),
            };
            text += &self.indent;
            text += &self.statement(&name, node)?;
        }
        text += &self.after;
        Some(text)
    }

    fn statement(&self, name: &str, node: &ModelNode) -> Option<String> {
        let mut value = match &node.kind {
            ModelNodeKind::Leaf(primitive) => call(primitive),
            ModelNodeKind::Operation(op, children) => {
                let names: Vec<String> = children.iter().map(|id| format!("s{id}")).collect();
                let list = self.list(&names);
                format!("{}({list})", operation(*op))
            }
            ModelNodeKind::Sweep(_) | ModelNodeKind::Construction(..) => return None,
        };
        if !node.steps.is_empty() {
            let rows = matrix(&node.steps).map(|row| self.list(&row.map(number)));
            value = format!("moved({value}, {})", self.list(&rows));
        }
        Some(match self.language {
            TemplateLanguage::Python => format!("{name} = {value}\n"),
            TemplateLanguage::Cpp => format!("auto {name} = {value};\n"),
        })
    }

    fn list(&self, items: &[String]) -> String {
        let items = items.join(", ");
        match self.language {
            TemplateLanguage::Python => format!("[{items}]"),
            TemplateLanguage::Cpp => format!("{{{items}}}"),
        }
    }
}

/// The shortest decimal that is read as the same f64, with a point or an exponent.
fn number(value: f64) -> String {
    // A negative zero is the same number.
    format!("{:?}", value + 0.0)
}

fn call(primitive: &ModelPrimitive) -> String {
    let (name, lengths): (&str, &[f64]) = match primitive {
        ModelPrimitive::ObliqueFrustum {
            axes: [[a, b, c], [d, e, f], [g, h, i]],
            top,
        } => (
            "oblique_frustum",
            &[*a, *b, *c, *d, *e, *f, *g, *h, *i, *top],
        ),
        ModelPrimitive::Ellipsoid(radii) => ("ellipsoid", radii.as_flattened()),
        ModelPrimitive::Block(size) => ("block", size),
        ModelPrimitive::Wedge(size) => ("wedge", size),
        ModelPrimitive::Cylinder { r, h } => ("cylinder", &[*r, *h]),
        ModelPrimitive::Frustum { r1, r2: 0.0, h } => ("cone", &[*r1, *h]),
        ModelPrimitive::Frustum { r1, r2, h } => ("frustum", &[*r1, *r2, *h]),
        ModelPrimitive::Sphere(r) => ("sphere", &[*r]),
        ModelPrimitive::Torus { major, minor } => ("torus", &[*major, *minor]),
    };
    let mut text = format!("{name}(");
    for (k, length) in lengths.iter().enumerate() {
        let comma = if k > 0 { ", " } else { "" };
        // A string takes everything.
        let _ = write!(text, "{comma}{}", number(*length));
    }
    text + ")"
}

fn operation(op: ModelOperation) -> &'static str {
    match op {
        ModelOperation::Union => "united",
        ModelOperation::Intersection => "intersection",
        ModelOperation::Difference => "difference",
    }
}

/// The matrix of steps in order: three rows of a rotation with a translation behind.
pub fn matrix(steps: &[ModelStep]) -> [[f64; 4]; 3] {
    let mut rows = [[0.0; 4]; 3];
    for (i, row) in rows.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    for step in steps {
        match *step {
            ModelStep::Shift(by) => {
                for (row, by) in rows.iter_mut().zip(by) {
                    row[3] += by;
                }
            }
            ModelStep::Turn(axis, degrees) => {
                let [sine, cosine] = sine_and_cosine(degrees);
                let [i, j] = turned_axes(axis);
                let (a, b) = (rows[i], rows[j]);
                rows[i] = std::array::from_fn(|k| cosine * a[k] - sine * b[k]);
                rows[j] = std::array::from_fn(|k| sine * a[k] + cosine * b[k]);
            }
        }
    }
    rows
}

/// The axes that a rotation about another one turns into each other.
fn turned_axes(axis: ModelAxis) -> [usize; 2] {
    [1, 2].map(|k| (axis.index() + k) % 3)
}

/// The sine and the cosine of an angle, exact for whole quarter turns.
fn sine_and_cosine(degrees: f64) -> [f64; 2] {
    let quarters = (degrees / 90.0).round();
    let rest = degrees - 90.0 * quarters;
    let (sine, cosine) = match rest == 0.0 {
        true => (0.0, 1.0),
        false => rest.to_radians().sin_cos(),
    };
    match quarters.rem_euclid(4.0) as u8 {
        0 => [sine, cosine],
        1 => [cosine, -sine],
        2 => [-sine, -cosine],
        _ => [-cosine, sine],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn model() -> PartModel {
        let steps = vec![
            ModelStep::Turn(ModelAxis::Z, 90.0),
            ModelStep::Shift([1.0, 0.5, 0.1]),
        ];
        let mut model = PartModel::new(ModelPrimitive::Block([1.0, 2.0, 3.5]), Vec::new());
        let cone = model.leaf(
            ModelPrimitive::Frustum {
                r1: 1.0,
                r2: 0.0,
                h: 2f64.powi(-60),
            },
            steps,
        );
        model.operation(ModelOperation::Difference, vec![0, cone], Vec::new());
        model
    }

    #[test]
    fn a_model_is_a_statement_for_each_node() {
        let text = "begin\n  # {{model}}\nend\n";
        let python = ModelTemplate::new(text, TemplateLanguage::Python).unwrap();
        let moved = "[[0.0, -1.0, 0.0, 1.0], [1.0, 0.0, 0.0, 0.5], [0.0, 0.0, 1.0, 0.1]]";
        let expected = format!(
            "begin\n  s0 = block(1.0, 2.0, 3.5)\n  \
             s1 = moved(cone(1.0, 8.673617379884035e-19), {moved})\n  \
             model = difference([s0, s1])\nend\n"
        );
        assert_eq!(python.program(&model()).unwrap(), expected);
        let cpp = ModelTemplate::new("{{model}}", TemplateLanguage::Cpp).unwrap();
        let last = cpp
            .program(&model())
            .unwrap()
            .lines()
            .last()
            .map(str::to_owned);
        assert_eq!(last.as_deref(), Some("auto model = difference({s0, s1});"));
    }

    #[test]
    fn a_template_has_one_mark() {
        let error = |text| ModelTemplate::new(text, TemplateLanguage::Python).unwrap_err();
        assert!(
            error("")
                .to_string()
                .contains("found 0 lines with `{{model}}`")
        );
        assert!(
            error("{{model}}\n{{model}}")
                .to_string()
                .contains("found 2")
        );
    }

    #[test]
    fn quarter_turns_are_exact() {
        for quarters in -9..9 {
            let [sine, cosine] = sine_and_cosine(f64::from(quarters) * 90.0);
            let angle = f64::from(quarters) * std::f64::consts::FRAC_PI_2;
            assert_eq!([sine, cosine], [angle.sin().round(), angle.cos().round()]);
        }
        let [sine, cosine] = sine_and_cosine(150.0);
        assert!((sine - 0.5).abs() < 1e-15 && (cosine + 0.75f64.sqrt()).abs() < 1e-15);
    }
}
