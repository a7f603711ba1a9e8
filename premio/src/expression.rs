//! Solids as expressions: primitives, set operations and motions.

mod description;
mod motions;
mod operators;
mod primitives;

pub use primitives::{
    block, cone, cylinder, ellipsoid, frustum, half_space, infinite_cone, infinite_cylinder,
    oblique_frustum, polyhedron, sphere, torus, wedge,
};

use crate::number::{ExactNumber, NumberError};
use crate::solid::Solid;
use crate::{Error, Rational, Result};
use description::Description;
use premio_csg::builder::{Builder, SolidId};
use premio_csg::construction::{AffineMap, ConstructionError, convex_hull, mapped, scaled_prism};
use premio_csg::evaluate::{EvaluationOptions, evaluate};
use premio_csg::figure::{Figure, FigureError};
use premio_csg::polyhedron::PolyhedronError;
use premio_csg::primitive::{Primitive, PrimitiveError, UnboundedPrimitive};
use premio_csg::reader::{Format, Note};
use premio_csg::recover::recovered;
use premio_csg::transform::Transform;
use premio_csg::tree::{Operation, Tree};
use premio_csg::writer;
use premio_kernel::motion::MotionError;
use std::collections::HashMap;
use std::fmt;
use std::path::Path;
use std::sync::Arc;

/// Why an expression is not a solid.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let error = block(1, 1, 1).scale(-2).evaluate().unwrap_err();
/// assert!(matches!(error, premio::Error::Expression(premio::ExpressionError::Factor)));
/// ```
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ExpressionError {
    /// A length or an angle is not a number.
    #[error(transparent)]
    Number(#[from] NumberError),
    /// A primitive with these lengths is not a solid.
    #[error(transparent)]
    Primitive(#[from] PrimitiveError),
    /// A motion is invalid.
    #[error(transparent)]
    Motion(#[from] MotionError),
    /// A factor is not above zero.
    #[error("a scale factor must be greater than zero")]
    Factor,
    /// The angle of a revolution is not between 0 and 360 degrees.
    #[error("the angle of a revolution must be between 0 and 360 degrees")]
    Angle,
    /// A figure of the plane is not exact.
    #[error(transparent)]
    Figure(#[from] FigureError),
    /// Faces bound no polyhedron.
    #[error(transparent)]
    Polyhedron(#[from] PolyhedronError),
    /// A hull is not exact.
    #[error(transparent)]
    Construction(#[from] ConstructionError),
}

/// A solid as an expression of primitives, set operations and motions.
///
/// Operators make larger expressions: `+` is the union, `-` the difference, `&` the intersection.
/// All three are regularised, so that no face or edge hangs loose. `!` is the complement: everything
/// outside. The whole must be bounded. A clone is cheap. An expression
/// is `Send` and `Sync`.
///
/// Numbers are exact, see [`ExactNumber`]. What is wrong with a number or a primitive becomes an
/// error in [`Expression::evaluate`], so that expressions need no `?`.
///
/// # Examples
///
/// ```
/// use premio::prelude::*;
///
/// let dice = (block(20, 20, 20) & sphere(13).translate([10, 10, 10])).rotate_z(30);
/// let solid = dice.evaluate()?;
/// assert_eq!(solid.faces().count(), 7);
/// # Ok::<(), premio::Error>(())
/// ```
#[derive(Clone)]
pub struct Expression(Result<Arc<Node>, ExpressionError>);

/// A node of an expression.
enum Node {
    Empty,
    Leaf(Primitive),
    Unbounded(UnboundedPrimitive),
    Complement(Arc<Node>),
    Operation(Operation, Vec<Arc<Node>>),
    Hull(Vec<Arc<Node>>),
    Moved(Arc<Node>, Transform),
    MirroredY(Arc<Node>),
    Scaled(Arc<Node>, Rational),
    Stretched(Arc<Node>, [Rational; 3]),
    /// A prism by its figure, its height and the factor there.
    Prism(Arc<Figure>, [Rational; 2]),
    Described(Box<Description>),
}

/// The solid of an expression, with its builder.
struct BuiltExpression {
    builder: Builder,
    solid: SolidId,
}

impl Node {
    fn children(&self) -> &[Arc<Node>] {
        match self {
            Self::Operation(_, children) | Self::Hull(children) => children,
            Self::Moved(child, _)
            | Self::Complement(child)
            | Self::MirroredY(child)
            | Self::Scaled(child, _)
            | Self::Stretched(child, _) => std::slice::from_ref(child),
            Self::Empty
            | Self::Leaf(_)
            | Self::Unbounded(_)
            | Self::Prism(..)
            | Self::Described(_) => &[],
        }
    }

    fn take_children(&mut self) -> Vec<Arc<Node>> {
        match self {
            Self::Operation(_, children) | Self::Hull(children) => std::mem::take(children),
            Self::Moved(child, _)
            | Self::Complement(child)
            | Self::MirroredY(child)
            | Self::Scaled(child, _)
            | Self::Stretched(child, _) => {
                vec![std::mem::replace(child, Arc::new(Self::Empty))]
            }
            Self::Empty
            | Self::Leaf(_)
            | Self::Unbounded(_)
            | Self::Prism(..)
            | Self::Described(_) => Vec::new(),
        }
    }
}

/// Without recursion: expressions may be deeper than the stack.
impl Drop for Node {
    fn drop(&mut self) {
        if self.children().is_empty() {
            return;
        }
        let mut rest = self.take_children();
        while let Some(node) = rest.pop() {
            if let Some(mut node) = Arc::into_inner(node) {
                rest.extend(node.take_children());
            }
        }
    }
}

/// Shows the number of primitives.
impl fmt::Debug for Expression {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.0 {
            Ok(root) => {
                let leaves = nodes(root).into_iter();
                let leaves = leaves.filter(|node| node.children().is_empty());
                f.debug_struct("Expression")
                    .field("primitives", &leaves.count())
                    .finish()
            }
            Err(error) => f.debug_tuple("Expression").field(error).finish(),
        }
    }
}

/// The distinct nodes of an expression, children before their parents.
fn nodes(root: &Arc<Node>) -> Vec<&Arc<Node>> {
    let mut known: HashMap<*const Node, ()> = HashMap::new();
    let mut order = Vec::new();
    let mut rest = vec![(root, false)];
    while let Some((node, is_after)) = rest.pop() {
        if is_after {
            order.push(node);
        } else if known.insert(Arc::as_ptr(node), ()).is_none() {
            rest.push((node, true));
            rest.extend(node.children().iter().rev().map(|child| (child, false)));
        }
    }
    order
}

impl Expression {
    pub(crate) fn primitive(primitive: Result<Primitive, ExpressionError>) -> Self {
        Self(primitive.map(|primitive| Arc::new(Node::Leaf(primitive))))
    }

    fn unbounded(primitive: Result<UnboundedPrimitive, ExpressionError>) -> Self {
        Self(primitive.map(|primitive| Arc::new(Node::Unbounded(primitive))))
    }

    /// A figure extruded along z, and scaled about z by the factor `top` on the way.
    pub(crate) fn scaled_prism(figure: Arc<Figure>, height: Rational, top: Rational) -> Self {
        let checked = Primitive::check_prism(&height, &top).map_err(ExpressionError::from);
        Self(checked.map(|()| Arc::new(Node::Prism(figure, [height, top]))))
    }

    /// The solid without any points.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// assert!(Expression::empty().evaluate()?.is_empty());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn empty() -> Self {
        Self(Ok(Arc::new(Node::Empty)))
    }

    /// One operation on several expressions. The difference takes all later ones from the first.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let holes = (1..4).map(|k| cylinder(1, 2).translate([5 * k, 5, 0]));
    /// let plate = std::iter::once(block(20, 10, 2)).chain(holes);
    /// let solid = Expression::operation(Operation::Difference, plate).evaluate()?;
    /// assert_eq!(solid.genus(), [3]);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn operation(op: Operation, parts: impl IntoIterator<Item = Self>) -> Self {
        let nodes: Result<Vec<Arc<Node>>, ExpressionError> =
            parts.into_iter().map(|part| part.0).collect();
        Self(nodes.map(|nodes| Arc::new(Node::Operation(op, nodes))))
    }

    /// The convex hull of several expressions, where its faces are on planes, cylinders, cones,
    /// spheres and tori. Cylinders, cones and prisms with parallel axes may have any place and size.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let rod = Expression::hull([sphere(1), sphere(1).translate([6, 0, 0])]).evaluate()?;
    /// assert!((rod.volume() - (6.0 + 4.0 / 3.0) * std::f64::consts::PI).abs() < 1e-12);
    /// let other = Expression::hull([sphere(1), sphere(2).translate([6, 1, 0])]);
    /// assert!(other.evaluate().is_ok());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn hull(parts: impl IntoIterator<Item = Self>) -> Self {
        let nodes: Result<Vec<Arc<Node>>, ExpressionError> =
            parts.into_iter().map(|part| part.0).collect();
        Self(nodes.map(|nodes| Arc::new(Node::Hull(nodes))))
    }

    fn map(self, wrap: impl FnOnce(Arc<Node>) -> Result<Node, ExpressionError>) -> Self {
        Self(self.0.and_then(wrap).map(Arc::new))
    }

    /// The notes of the reader on all descriptions that the expression was made from.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let part = premio::read_text("A = BLO(X=1, Y=1, Z=1)", Format::Padl)?;
    /// assert!(part.notes().is_empty());
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn notes(&self) -> Vec<Note> {
        let notes = self.descriptions().into_iter();
        notes.flat_map(|d| d.program.notes.clone()).collect()
    }

    fn descriptions(&self) -> Vec<&Description> {
        let Ok(root) = &self.0 else {
            return Vec::new();
        };
        let described = |node: &&Arc<Node>| matches!(&***node, Node::Described(_));
        let all = nodes(root).into_iter().filter(described);
        all.filter_map(|node| match &**node {
            Node::Described(description) => Some(&**description),
            _ => None,
        })
        .collect()
    }

    /// The relative noise of the coordinates that were read.
    fn noise(&self) -> Option<f64> {
        let digits = self.descriptions().into_iter();
        digits.filter_map(|d| d.program.digits).reduce(f64::max)
    }

    /// The solid of the expression, in a builder of its own.
    fn build(&self) -> Result<BuiltExpression> {
        let root = self.0.as_ref().map_err(Clone::clone)?;
        let mut builder = Builder::new();
        let mut built: HashMap<*const Node, SolidId> = HashMap::new();
        let mut last = SolidId::EMPTY;
        for node in nodes(root) {
            let child = |node: &Arc<Node>| built[&Arc::as_ptr(node)];
            last = match &**node {
                Node::Empty => SolidId::EMPTY,
                Node::Leaf(primitive) => builder.primitive(primitive.clone()),
                Node::Unbounded(primitive) => builder.unbounded(primitive.clone()),
                Node::Complement(inner) => builder.complement(child(inner)),
                Node::Operation(op, children) => {
                    let children: Vec<SolidId> = children.iter().map(child).collect();
                    builder.operation(*op, &children)
                }
                Node::Hull(children) => {
                    let children: Vec<SolidId> = children.iter().map(child).collect();
                    let hull = convex_hull(&mut builder, &children, 0.0);
                    hull.map_err(ExpressionError::Construction)?.solid
                }
                Node::Moved(inner, transform) => builder.moved(child(inner), transform.clone()),
                Node::MirroredY(inner) => builder.mirrored_y(child(inner)),
                Node::Scaled(inner, factor) => builder.scaled(child(inner), factor.clone()),
                Node::Stretched(inner, factors) => {
                    let image = mapped(&mut builder, child(inner), &AffineMap::scale(factors));
                    image.map_err(ExpressionError::Construction)?
                }
                Node::Prism(figure, [height, top]) => {
                    let prism = scaled_prism(&mut builder, figure, height, top);
                    prism.map_err(ExpressionError::Construction)?
                }
                Node::Described(d) => builder.import(&d.program.builder, d.program.part)?,
            };
            built.insert(Arc::as_ptr(node), last);
        }
        Ok(BuiltExpression {
            builder,
            solid: last,
        })
    }

    /// The tree of set operations, with every motion at its leaves.
    ///
    /// # Errors
    /// A number, a primitive or a motion is invalid, the part has no bound, or the tree is beyond a
    /// limit.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let plate = block(6, 4, 2) - cylinder(1, 2) - cylinder(1, 2).translate([6, 4, 0]);
    /// assert_eq!(plate.tree()?.leaves().count(), 3);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn tree(&self) -> Result<Tree> {
        if let Ok(Node::Described(d)) = self.0.as_deref() {
            // The error has the place in the text.
            let text = d.read.as_deref().unwrap_or(&d.record.text);
            return Ok(d.program.tree(&d.name, text.as_bytes())?);
        }
        let BuiltExpression { builder, solid } = self.build()?;
        Ok(builder.finish(solid)?)
    }

    /// The exact boundary, with the default options.
    ///
    /// All cores share the work. [`with_threads`](crate::with_threads) sets another number of threads;
    /// the boundary is the same for any.
    ///
    /// # Errors
    /// A number, a primitive or a motion is invalid, or the boundary is beyond a stated limit.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let solid = (block(2, 2, 2) + block(2, 2, 2).translate([1, 1, 1])).evaluate()?;
    /// assert!((solid.volume() - 15.0).abs() < 1e-12);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn evaluate(&self) -> Result<Solid> {
        self.evaluate_with(&EvaluationOptions::default())
    }

    /// The exact boundary.
    ///
    /// # Errors
    /// As [`Expression::evaluate`]; or an option is out of its range.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let options = EvaluationOptions { resolution: Some(1e-6), ..EvaluationOptions::default() };
    /// let solid = block(1, 1, 1).evaluate_with(&options)?;
    /// assert_eq!(solid.resolution(), 1e-6);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn evaluate_with(&self, options: &EvaluationOptions) -> Result<Solid> {
        let tree = self.tree()?;
        let options = EvaluationOptions {
            noise: options.noise.or(self.noise()),
            ..*options
        };
        let recovery = options.recovers().then(|| recovered(&tree)).flatten();
        let tree = recovery
            .as_ref()
            .map_or(tree, |recovery| recovery.tree.clone());
        let evaluation = evaluate(&tree, &options)?;
        Ok(Solid::new(
            tree,
            evaluation,
            recovery,
            self.clone(),
            &options,
        ))
    }

    /// The expression as a description in PADL, as the tree's JSON or as `.csg`.
    ///
    /// A number that the language cannot express is written as the nearest f64.
    ///
    /// # Errors
    /// The expression is invalid, the language is read only, or the text would be too long.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// let plate = block(6, 4, 2) - cylinder(1, 2);
    /// let text = plate.to_description(Format::Padl)?;
    /// let again = premio::read_text(&text, Format::Padl)?;
    /// assert_eq!(again.tree()?, plate.tree()?);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn to_description(&self, format: Format) -> Result<String> {
        let BuiltExpression { builder, solid } = self.build()?;
        Ok(writer::write(&builder, solid, format)?)
    }

    /// Writes the expression as a description, in the language that the file's ending names.
    ///
    /// # Errors
    /// As [`Expression::to_description`]; the ending names no language, or the file cannot be written.
    ///
    /// # Examples
    ///
    /// ```
    /// use premio::prelude::*;
    ///
    /// # let folder = tempfile::tempdir().unwrap();
    /// # std::env::set_current_dir(&folder).unwrap();
    /// let plate = block(6, 4, 2) - cylinder(1, 2);
    /// plate.write("plate.csg")?;
    /// assert_eq!(premio::read("plate.csg")?.tree()?, plate.tree()?);
    /// # Ok::<(), premio::Error>(())
    /// ```
    pub fn write(&self, path: impl AsRef<Path>) -> Result<()> {
        let path = path.as_ref();
        let format = Format::from_path(path).ok_or_else(|| Error::UnknownFormat {
            path: path.to_owned(),
            expected: ".padl, .csg or .json",
        })?;
        crate::write::whole_file(path, self.to_description(format)?)
    }
}

fn vector<N: Into<ExactNumber>>(of: [N; 3]) -> Result<[Rational; 3], ExpressionError> {
    numbers(of.map(Into::into))
}

pub(crate) fn numbers<const N: usize>(
    of: [ExactNumber; N],
) -> Result<[Rational; N], ExpressionError> {
    let mut values = [const { Rational::ZERO }; N];
    for (value, number) in values.iter_mut().zip(of) {
        *value = number.value()?;
    }
    Ok(values)
}

#[cfg(test)]
mod tests;
