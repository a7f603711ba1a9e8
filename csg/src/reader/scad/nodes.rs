//! The meaning of OpenSCAD's nodes.

use std::ops::Range;
use std::sync::Arc;

use premio_kernel::number::rational::Rational;

use super::super::ReadOptions;
use super::super::error::SpannedError;
use super::super::lexer::{Cursor, Lexeme};
use super::super::notes::Notes;
use super::super::refusal::construction_error;
use super::super::region::{Region, bad_figure};
use super::super::sweep::operation;
use super::SIX_DIGITS;
use super::arguments::Arguments;
use super::colour::colours;
use super::facets::FacetRule;
use super::figures;
use super::import::{self, ImportFormat, ImportedFiles};
use super::matrix::Matrix;
use super::measures::{Shape, remark_negative};
use super::resize;
use super::shapes;
use super::sweep::{Raise, Spin};
use super::syntax::{ScadFile, ScadNode};
use super::text;
use crate::builder::{Builder, SolidId};
use crate::construction::{
    AffineMap, ConstructionError, convex_hull, extent, mapped, minkowski_sum, section, shadow,
};
use crate::figure::{Figure, FigureError, FigureOperation, OffsetJoin, PlaneMap};
use crate::polyhedron::Polyhedron;
use crate::primitive::Primitive;
use premio_text::escape::quote;

/// What a node makes.
enum Geometry {
    Nothing,
    Plane(Region),
    Solid(SolidId),
}

/// The largest error of a number of six digits, relative to the number.
const ROUNDING: f64 = 5.0 * SIX_DIGITS;

/// The supported nodes.
const KNOWN: [&str; 25] = [
    "group",
    "union",
    "hull",
    "difference",
    "intersection",
    "render",
    "color",
    "multmatrix",
    "cube",
    "sphere",
    "cylinder",
    "polyhedron",
    "linear_extrude",
    "rotate_extrude",
    "circle",
    "square",
    "polygon",
    "offset",
    "minkowski",
    "projection",
    "resize",
    "fill",
    "text",
    "import",
    "surface",
];

/// Evaluates the nodes of a file, children first.
pub(super) struct Evaluator<'c, 'a> {
    cursor: &'c Cursor<'a>,
    options: &'c ReadOptions,
    pub builder: Builder,
    pub notes: Notes,
    pub rule: FacetRule,
    /// The files that were imported.
    pub files: ImportedFiles<'c>,
    /// Whether a text has a font that is not embedded.
    pub has_other_fonts: bool,
}

/// The children of a node.
struct Children {
    each: Vec<Geometry>,
    /// The names of those that make something.
    names: Vec<Lexeme>,
}

impl<'c, 'a> Evaluator<'c, 'a> {
    pub fn new(cursor: &'c Cursor<'a>, name: &'c str, options: &'c ReadOptions) -> Self {
        Self {
            cursor,
            options,
            builder: Builder::new(),
            notes: Notes::of_digits(SIX_DIGITS),
            rule: FacetRule::new(options.facets),
            files: ImportedFiles::new(name, &options.includes),
            has_other_fonts: false,
        }
    }

    /// The solid of a file: the first subtree marked `!`, or all nodes.
    pub fn solid(&mut self, file: ScadFile) -> Result<SolidId, SpannedError> {
        let ScadFile { nodes, top } = file;
        let names: Vec<Lexeme> = nodes.iter().map(|node| node.name).collect();
        let colours = colours(&nodes, self.cursor);
        let mut made: Vec<Option<Geometry>> = Vec::with_capacity(nodes.len());
        let mut root: Option<Geometry> = None;
        for (mut node, colour) in nodes.into_iter().zip(colours) {
            if !node.is_live {
                made.push(None);
                continue;
            }
            let live: Vec<usize> = node
                .children
                .iter()
                .copied()
                .filter(|&c| made[c].is_some())
                .collect();
            let children = Children {
                names: live.iter().map(|&c| names[c]).collect(),
                each: live.into_iter().filter_map(|c| made[c].take()).collect(),
            };
            self.builder.set_colour(colour);
            let geometry = self.geometry(&mut node, children)?;
            match node.is_root {
                true => {
                    root.get_or_insert(geometry);
                    made.push(None);
                }
                false => made.push(Some(geometry)),
            }
        }
        self.builder.set_colour(None);
        if let Some(root) = root {
            return self.as_solid(root);
        }
        let parts = top.into_iter().filter_map(|node| made[node].take());
        let parts: Vec<SolidId> = parts.map(|g| self.as_solid(g)).collect::<Result<_, _>>()?;
        Ok(self
            .builder
            .operation(crate::tree::Operation::Union, &parts))
    }

    fn as_solid(&self, geometry: Geometry) -> Result<SolidId, SpannedError> {
        match geometry {
            Geometry::Nothing => Ok(SolidId::EMPTY),
            Geometry::Solid(solid) => Ok(solid),
            Geometry::Plane(region) => {
                let found = "a plane figure outside an extrusion";
                Err(SpannedError::input(region.span(), found, "a solid"))
            }
        }
    }

    fn geometry(
        &mut self,
        node: &mut ScadNode,
        children: Children,
    ) -> Result<Geometry, SpannedError> {
        let name = self.cursor.text(node.name);
        let is_whole = node.is_operand;
        let arguments = &mut node.arguments;
        if name != "offset" {
            remark_negative(arguments, &mut self.notes);
        }
        let union = FigureOperation::Union;
        match name {
            "group" | "union" | "render" | "color" => self.combined(union, children),
            "intersection" => self.combined(FigureOperation::Intersection, children),
            "difference" => self.combined(FigureOperation::Difference, children),
            "multmatrix" => {
                let matrix = Matrix::new(arguments, &mut self.notes)?;
                match self.combined(union, children)? {
                    Geometry::Nothing => Ok(Geometry::Nothing),
                    Geometry::Plane(region) => matrix.of_region(region).map(Geometry::Plane),
                    Geometry::Solid(part) => matrix
                        .of_solid(&mut self.builder, part)
                        .map(Geometry::Solid),
                }
            }
            "linear_extrude" => {
                let raise = Raise::new(arguments)?;
                let region = self.sweepable(children, name, is_whole)?;
                let rule = &self.rule;
                let part = region.map(|r| raise.solid(&mut self.builder, &r, arguments, rule));
                Ok(solid(part.transpose()?))
            }
            "rotate_extrude" => {
                let spin = Spin::new(arguments)?;
                let region = self.sweepable(children, name, is_whole)?;
                let rule = &mut self.rule;
                let part = region.map(|r| spin.solid(&mut self.builder, &r, arguments, rule));
                Ok(solid(part.transpose()?))
            }
            "cube" => shapes::cube(arguments).map(|shape| self.placed(shape)),
            "sphere" => shapes::sphere(arguments, &mut self.rule).map(|shape| self.placed(shape)),
            "cylinder" => {
                shapes::cylinder(arguments, &mut self.rule).map(|shape| self.placed(shape))
            }
            "polyhedron" => {
                shapes::polyhedron(arguments, &mut self.notes).map(|shape| self.placed(shape))
            }
            "circle" | "square" | "polygon" => {
                let figure = figures::figure(name, arguments, &mut self.rule)?;
                let span = node.name.span();
                Ok(plane(figure.map(|figure| Region::new(figure, span))))
            }
            "hull" => self.hull(children, &arguments.span),
            "minkowski" => self.minkowski(children, &arguments.span),
            "offset" => {
                let region = self.region(children, name)?;
                self.offset(region, arguments)
            }
            "fill" => {
                let region = self.region(children, name)?;
                let figure = region
                    .map(|r| r.evaluated(&arguments.span))
                    .transpose()?
                    .flatten();
                let filled = figure.map(|figure| figure.filled());
                Ok(plane(
                    filled.map(|figure| Region::new(figure, arguments.span.clone())),
                ))
            }
            "text" => {
                let fonts = &self.options.fonts;
                self.has_other_fonts |= !text::has_embedded_font(arguments)?;
                text::text(arguments, fonts, &mut self.notes).map(plane)
            }
            "import" => self.import(arguments),
            "surface" => self.surface(arguments),
            "projection" => self.projection(children, arguments),
            "resize" => self.resize(children, arguments),
            _ => Err(unknown(name, node.name)),
        }
    }

    fn import(&mut self, arguments: &mut Arguments) -> Result<Geometry, SpannedError> {
        arguments.bind(&[
            "file", "layer", "id", "origin", "scale", "center", "dpi", "width", "height",
        ])?;
        let place = arguments.require("file")?.clone();
        let file = arguments.words("file")?;
        let Some(format) = ImportFormat::from_path(file) else {
            let found = format!("the file {}", quote(file));
            let expected = "a file of `dxf`, `svg`, `stl`, `off`, `obj`, `3mf` or `amf`";
            return Err(SpannedError::input(place.span.clone(), found, expected));
        };
        let bytes = self.files.bytes(file, &place)?;
        match format {
            ImportFormat::Drawing(format) => {
                let (rule, notes) = (&mut self.rule, &mut self.notes);
                import::drawing(format, &bytes, arguments, rule, notes).map(plane)
            }
            ImportFormat::Mesh(format) => {
                let polyhedra = import::mesh(format, &bytes, arguments)?;
                let parts: Vec<SolidId> = polyhedra
                    .into_iter()
                    .map(|polyhedron| self.polyhedron(polyhedron))
                    .collect();
                let union = crate::tree::Operation::Union;
                Ok(solid(Some(self.builder.operation(union, &parts))))
            }
        }
    }

    fn surface(&mut self, arguments: &mut Arguments) -> Result<Geometry, SpannedError> {
        arguments.bind(&["file", "center", "invert"])?;
        let place = arguments.require("file")?.clone();
        let file = arguments.words("file")?;
        let bytes = self.files.bytes(file, &place)?;
        let field = import::surface(file, &bytes, arguments)?;
        Ok(solid(Some(self.polyhedron(field))))
    }

    fn polyhedron(&mut self, polyhedron: Polyhedron) -> SolidId {
        let polyhedron = Arc::new(polyhedron);
        self.builder.primitive(Primitive::Polyhedron { polyhedron })
    }

    fn placed(&mut self, shape: Shape) -> Geometry {
        let Some(part) = shape else {
            return Geometry::Nothing;
        };
        let solid = self.builder.primitive(part.primitive);
        Geometry::Solid(self.builder.moved(solid, part.moves))
    }

    /// A set operation on solids or on plane figures.
    fn combined(
        &mut self,
        op: FigureOperation,
        children: Children,
    ) -> Result<Geometry, SpannedError> {
        let is_plane = |g: &Geometry| matches!(g, Geometry::Plane(_));
        let is_solid = |g: &Geometry| matches!(g, Geometry::Solid(_));
        let planes = children.each.iter().any(is_plane);
        if planes && let Some(k) = children.each.iter().position(is_solid) {
            return Err(self.mixed(children.names[k], "beside a plane figure"));
        }
        if planes {
            let operands = children.each.into_iter().map(|g| match g {
                Geometry::Plane(region) => Some(region),
                Geometry::Nothing | Geometry::Solid(_) => None,
            });
            return Region::combined(op, operands.collect()).map(plane);
        }
        let parts = children.each.into_iter().map(|g| match g {
            Geometry::Solid(part) => part,
            Geometry::Nothing | Geometry::Plane(_) => SolidId::EMPTY,
        });
        let parts: Vec<SolidId> = parts.collect();
        Ok(solid(Some(self.builder.operation(operation(op), &parts))))
    }

    /// The error of a node that is not of the expected kind.
    fn mixed(&self, name: Lexeme, place: &str) -> SpannedError {
        let found = format!("{} {place}", quote(self.cursor.text(name)));
        SpannedError::input(name.span(), found, "a plane figure")
    }

    /// The union of plane figures inside a node.
    fn region(&mut self, children: Children, outer: &str) -> Result<Option<Region>, SpannedError> {
        let is_solid = |g: &Geometry| matches!(g, Geometry::Solid(_));
        if let Some(k) = children.each.iter().position(is_solid) {
            return Err(self.mixed(children.names[k], &format!("inside `{outer}`")));
        }
        match self.combined(FigureOperation::Union, children)? {
            Geometry::Plane(region) => Ok(Some(region)),
            Geometry::Nothing | Geometry::Solid(_) => Ok(None),
        }
    }

    /// The region of an extrusion or a revolution. An operand of a hull or a Minkowski sum is
    /// combined in the plane, because these need the faces of the result.
    fn sweepable(
        &mut self,
        children: Children,
        outer: &str,
        is_whole: bool,
    ) -> Result<Option<Region>, SpannedError> {
        let region = self.region(children, outer)?;
        match region {
            Some(region) if is_whole && !region.is_union() => {
                let span = region.span();
                let figure = region.evaluated(&span)?;
                Ok(figure.map(|figure| Region::new(figure, span)))
            }
            region => Ok(region),
        }
    }

    fn hull(&mut self, children: Children, span: &Range<usize>) -> Result<Geometry, SpannedError> {
        let solids = solids(&children);
        if !solids.is_empty() || children.each.is_empty() {
            let hull = convex_hull(&mut self.builder, &solids, ROUNDING);
            if let Ok(hull) = &hull
                && hull.moved > 0.0
            {
                let text = format!(
                    "the corners of a hull are taken to be about common axes; coordinates change by \
                     up to {:.1e}",
                    hull.moved
                );
                self.notes.add(text, span.clone());
            }
            return constructed(hull.map(|hull| hull.solid), span).map(solid);
        }
        let mut figures: Vec<Figure> = Vec::new();
        for geometry in &children.each {
            let Geometry::Plane(region) = geometry else {
                continue;
            };
            match region.figures()? {
                Some(own) => figures.extend(own),
                None => figures.extend(region.evaluated(span)?),
            }
        }
        if figures.is_empty() {
            return Ok(Geometry::Nothing);
        }
        let hull = Figure::hull_of(&figures.iter().collect::<Vec<_>>());
        Ok(plane(
            made(hull, span)?.map(|f| Region::new(f, span.clone())),
        ))
    }

    fn minkowski(
        &mut self,
        children: Children,
        span: &Range<usize>,
    ) -> Result<Geometry, SpannedError> {
        let solids = solids(&children);
        if !solids.is_empty() || children.each.is_empty() {
            let sum = minkowski_sum(&mut self.builder, &solids);
            return constructed(sum, span).map(solid);
        }
        let mut sum: Option<Figure> = None;
        for geometry in &children.each {
            let Geometry::Plane(region) = geometry else {
                continue;
            };
            let Some(figure) = region.evaluated(span)? else {
                return Ok(Geometry::Nothing);
            };
            sum = match sum {
                None => Some(figure),
                Some(sum) => made(sum.minkowski_sum(&figure), span)?,
            };
        }
        Ok(plane(sum.map(|figure| Region::new(figure, span.clone()))))
    }

    fn offset(
        &mut self,
        region: Option<Region>,
        arguments: &mut Arguments,
    ) -> Result<Geometry, SpannedError> {
        arguments.bind(&["r", "delta", "chamfer"])?;
        let (distance, join) = match (arguments.find("r"), arguments.find("delta")) {
            (Some(r), _) => self.rounded(r.number()?.clone(), arguments)?,
            (None, Some(delta)) => {
                let join = match arguments.flag("chamfer")? {
                    true => OffsetJoin::Chamfer,
                    false => OffsetJoin::Miter,
                };
                (delta.number()?.clone(), join)
            }
            (None, None) => self.rounded(arguments.require("r")?.number()?.clone(), arguments)?,
        };
        let span = arguments.span.clone();
        let figure = region.map(|r| r.evaluated(&span)).transpose()?.flatten();
        let Some(figure) = figure else {
            return Ok(Geometry::Nothing);
        };
        let grown = made(figure.offset(&distance, join), &span)?;
        Ok(plane(grown.map(|figure| Region::new(figure, span))))
    }

    /// The distance of an `offset` by `r`, and how its corners are filled.
    fn rounded(
        &mut self,
        distance: Rational,
        arguments: &Arguments,
    ) -> Result<(Rational, OffsetJoin), SpannedError> {
        let radius = match distance < Rational::ZERO {
            true => -&distance,
            false => distance.clone(),
        };
        let sides = self.rule.sides(arguments, &radius)?;
        Ok((
            distance,
            sides.map_or(OffsetJoin::Round, OffsetJoin::Faceted),
        ))
    }

    fn projection(
        &mut self,
        children: Children,
        arguments: &mut Arguments,
    ) -> Result<Geometry, SpannedError> {
        arguments.bind(&["cut"])?;
        let span = arguments.span.clone();
        let is_cut = arguments.flag("cut")?;
        let Geometry::Solid(part) = self.combined(FigureOperation::Union, children)? else {
            return Ok(Geometry::Nothing);
        };
        let figure = match is_cut {
            true => section(&self.builder, part),
            false => shadow(&self.builder, part),
        };
        match figure {
            Ok(figure) => Ok(Geometry::Plane(Region::new(figure, span))),
            Err(error) if error.is_empty() => Ok(Geometry::Nothing),
            Err(error) => Err(construction_error(&error, &span)),
        }
    }

    fn resize(
        &mut self,
        children: Children,
        arguments: &mut Arguments,
    ) -> Result<Geometry, SpannedError> {
        arguments.bind(&["newsize", "auto"])?;
        let span = arguments.span.clone();
        let sizes = resize::sizes(arguments)?;
        let auto = resize::automatic(arguments)?;
        match self.combined(FigureOperation::Union, children)? {
            Geometry::Nothing => Ok(Geometry::Nothing),
            Geometry::Plane(region) => {
                let Some(figure) = region.evaluated(&span)? else {
                    return Ok(Geometry::Nothing);
                };
                let [lo, hi] = figure.bounds();
                let [x, y, _] = resize::factors(&sizes, &auto, &[hi[0] - lo[0], hi[1] - lo[1]]);
                let map = PlaneMap {
                    matrix: [[x, Rational::ZERO], [Rational::ZERO, y]],
                    ..PlaneMap::identity()
                };
                Ok(Geometry::Plane(region.mapped(&map, None)))
            }
            Geometry::Solid(part) => {
                let extent = match extent(&self.builder, part) {
                    Ok(Some(extent)) => extent,
                    Ok(None) => return Ok(Geometry::Nothing),
                    Err(error) => return Err(construction_error(&error, &span)),
                };
                let map = AffineMap::scale(&resize::factors(&sizes, &auto, &extent));
                let image = mapped(&mut self.builder, part, &map);
                constructed(image, &span).map(solid)
            }
        }
    }
}

fn solid(part: Option<SolidId>) -> Geometry {
    match part {
        Some(part) if !part.is_empty() => Geometry::Solid(part),
        _ => Geometry::Nothing,
    }
}

fn plane(region: Option<Region>) -> Geometry {
    region.map_or(Geometry::Nothing, Geometry::Plane)
}

fn solids(children: &Children) -> Vec<SolidId> {
    let each = children.each.iter().filter_map(|g| match g {
        Geometry::Solid(part) => Some(*part),
        Geometry::Nothing | Geometry::Plane(_) => None,
    });
    each.collect()
}

/// A figure, if it is not empty.
fn made(
    figure: Result<Figure, FigureError>,
    span: &Range<usize>,
) -> Result<Option<Figure>, SpannedError> {
    match figure {
        Ok(figure) => Ok(Some(figure)),
        Err(FigureError::Empty) => Ok(None),
        Err(error) => Err(bad_figure(&error, span)),
    }
}

/// A solid, if it is not empty.
fn constructed(
    part: Result<SolidId, ConstructionError>,
    span: &Range<usize>,
) -> Result<Option<SolidId>, SpannedError> {
    match part {
        Ok(part) => Ok(Some(part)),
        Err(error) if error.is_empty() => Ok(None),
        Err(error) => Err(construction_error(&error, span)),
    }
}

fn unknown(name: &str, place: Lexeme) -> SpannedError {
    let reason = match name {
        "roof" => "it is not a regularised set operation or a rigid motion",
        "translate" | "rotate" | "mirror" | "scale" | "for" | "if" | "module" => {
            "this is not flattened: write the file with `openscad -o part.csg part.scad`"
        }
        _ => {
            let found = format!("the unknown node {}", quote(name));
            let fault = SpannedError::input(place.span(), found, "a node that can be read");
            return fault.suggest(name, KNOWN);
        }
    };
    let found = format!("the node {}", quote(name));
    SpannedError::input(place.span(), found, "a node that can be read").help(reason)
}
