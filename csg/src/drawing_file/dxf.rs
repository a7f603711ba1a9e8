//! The entities of a DXF file as edges.
//!
//! A DXF file is a sequence of pairs of lines, a group code and a value. The meaning is that of
//! OpenSCAD 2021.01: of the entities LINE, LWPOLYLINE, CIRCLE, ARC, ELLIPSE and INSERT have an
//! effect. Bulges of polylines, the base point of a block and the layers within blocks have none,
//! and a block inserts what the file has defined of it before.

mod entity;

use super::curves::{CircularArc, EdgeMap, EllipticArc, check_numbers, cut, polyline};
use super::error::DrawingFileError;
use super::joining::joined;
use super::{Drawing, DrawingOptions};
use crate::figure::{FigureEdge, FigurePoint, MAX_EDGES, PlaneMap, direction};
use entity::{Entity, Groups};
use premio_kernel::number::rational::{Rational, to_f64};
use std::collections::HashMap;

/// Reads a DXF file.
///
/// # Errors
/// A group code or a coordinate is no number, an entity lacks coordinates, or there are too many
/// edges.
pub(crate) fn read_dxf(
    bytes: &[u8],
    options: &mut DrawingOptions<'_>,
) -> Result<Drawing, DrawingFileError> {
    let text = String::from_utf8_lossy(bytes);
    let mut reader = Reader {
        options,
        section: Section::Other,
        block: None,
        blocks: HashMap::new(),
        block_edges: 0,
        edges: Vec::new(),
        drawing: Drawing::default(),
    };
    let mut entity: Option<Entity<'_>> = None;
    for group in Groups::new(&text) {
        let group = group?;
        match (group.code, &mut entity) {
            (0, _) => {
                // Like in OpenSCAD an entity counts once the next one begins.
                if let Some(entity) = entity.replace(Entity::new(&group)) {
                    reader.add(&entity)?;
                }
            }
            (_, Some(entity)) => entity.add(&group),
            (_, None) => {}
        }
    }
    let joined = joined(reader.edges)?;
    reader.drawing.completed = joined.completed;
    reader.drawing.shapes = vec![joined.contours];
    Ok(reader.drawing)
}

/// The sections with entities.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Section {
    Entities,
    Blocks,
    Other,
}

struct Reader<'t, 'a, 'o> {
    options: &'o mut DrawingOptions<'a>,
    section: Section,
    block: Option<&'t str>,
    blocks: HashMap<&'t str, Vec<FigureEdge>>,
    /// The number of edges of all blocks.
    block_edges: usize,
    edges: Vec<FigureEdge>,
    drawing: Drawing,
}

impl<'t> Reader<'t, '_, '_> {
    fn add(&mut self, entity: &Entity<'t>) -> Result<(), DrawingFileError> {
        match entity.kind {
            "SECTION" => {
                self.section = match entity.name {
                    "ENTITIES" => Section::Entities,
                    "BLOCKS" => Section::Blocks,
                    _ => Section::Other,
                };
            }
            "BLOCK" => self.block = Some(entity.name),
            "ENDBLK" => self.block = None,
            "ENDSEC" => {}
            _ if self.is_read(entity) => {
                let edges = self.edges_of(entity)?;
                return self.keep(edges);
            }
            _ => {}
        }
        Ok(())
    }

    /// Whether an entity is in a section and on a layer that are read.
    fn is_read(&self, entity: &Entity<'t>) -> bool {
        let mut layer = self.options.layer.iter().filter(|layer| !layer.is_empty());
        match self.section {
            Section::Entities => layer.all(|layer| *layer == entity.layer),
            Section::Blocks => true,
            Section::Other => false,
        }
    }

    fn keep(&mut self, edges: Vec<FigureEdge>) -> Result<(), DrawingFileError> {
        check_numbers(&edges)?;
        match (self.section, self.block) {
            (Section::Entities, _) => self.edges.extend(edges),
            (Section::Blocks, Some(name)) => {
                self.block_edges += edges.len();
                self.blocks.entry(name).or_default().extend(edges);
            }
            _ => {}
        }
        // A block may insert itself, which doubles it.
        match self.edges.len().max(self.block_edges) > MAX_EDGES {
            true => Err(DrawingFileError::TooManyEdges),
            false => Ok(()),
        }
    }

    fn edges_of(&mut self, entity: &Entity<'t>) -> Result<Vec<FigureEdge>, DrawingFileError> {
        match entity.kind {
            "LINE" => {
                let [start, end] = [self.point(entity, 0)?, self.point(entity, 1)?];
                Ok(vec![FigureEdge::line(start, end)])
            }
            "LWPOLYLINE" => self.polyline(entity),
            "CIRCLE" => {
                let centre = self.point(entity, 0)?;
                let radius = self.radius(entity)?;
                self.arc(CircularArc::full(centre, radius))
            }
            "ARC" => self.circular_arc(entity),
            "ELLIPSE" => self.ellipse(entity),
            "INSERT" => self.insert(entity),
            _ => {
                self.drawing.passed_over += 1;
                Ok(Vec::new())
            }
        }
    }

    /// A point of an entity. Coordinates in blocks have the origin and the unit of the file.
    fn point(&self, entity: &Entity<'t>, index: usize) -> Result<FigurePoint, DrawingFileError> {
        let point = entity.point(index)?;
        Ok(match self.section {
            Section::Blocks => point,
            _ => [0, 1].map(|i| (&point[i] - &self.options.origin[i]) * &self.options.scale),
        })
    }

    fn radius(&self, entity: &Entity<'t>) -> Result<Rational, DrawingFileError> {
        let radius = entity.number(40, 0)?;
        Ok(match self.section {
            Section::Blocks => radius,
            _ => radius * &self.options.scale,
        })
    }

    fn polyline(&mut self, entity: &Entity<'t>) -> Result<Vec<FigureEdge>, DrawingFileError> {
        let count = entity.point_count();
        let points = (0..count).map(|i| self.point(entity, i));
        let mut points: Vec<FigurePoint> = points.collect::<Result<_, _>>()?;
        if entity.is_closed()? {
            points.extend(points.first().cloned());
        }
        // The bulges of its arcs have no effect.
        let is_bulging = !entity.number(42, 0)?.is_zero();
        self.drawing.passed_over += usize::from(is_bulging);
        Ok(polyline(&points))
    }

    fn circular_arc(&mut self, entity: &Entity<'t>) -> Result<Vec<FigureEdge>, DrawingFileError> {
        let full = Rational::from(360);
        let [start, end] = [entity.number(50, 0)?, entity.number(51, 0)?];
        let between = &end - &start;
        let turns = Rational::from((&between / &full).floor());
        let mut sweep = &between - turns * &full;
        // An arc of several turns is a circle.
        if sweep.is_zero() && between > Rational::ZERO {
            sweep = full;
        }
        let arc = CircularArc {
            centre: self.point(entity, 0)?,
            radius: self.radius(entity)?,
            start,
            sweep,
        };
        self.arc(arc)
    }

    fn arc(&mut self, mut arc: CircularArc) -> Result<Vec<FigureEdge>, DrawingFileError> {
        if arc.radius < Rational::ZERO {
            arc.radius = -arc.radius;
            arc.start += Rational::from(180);
        }
        if arc.radius.is_zero() || arc.sweep.is_zero() {
            self.drawing.passed_over += 1;
            return Ok(Vec::new());
        }
        let Some(sides) = (self.options.sides)(&arc.radius) else {
            return Ok(arc.edges());
        };
        let count = (Rational::from(sides.max(1)) * &arc.sweep / Rational::from(360)).ceil();
        let count = u32::try_from(count)
            .ok()
            .filter(|n| *n as usize <= MAX_EDGES);
        Ok(arc.segments(count.ok_or(DrawingFileError::TooManyEdges)?))
    }

    /// Like OpenSCAD it moves the end of the first axis by the origin, and scales the ratio of the
    /// axes, too.
    fn ellipse(&mut self, entity: &Entity<'t>) -> Result<Vec<FigureEdge>, DrawingFileError> {
        let [centre, axis] = [self.point(entity, 0)?, self.point(entity, 1)?];
        let [centre, axis] = [centre, axis].map(|point| point.each_ref().map(to_f64));
        let ratio = to_f64(&self.radius(entity)?);
        let [start, end] = [
            to_f64(&entity.number(41, 0)?),
            to_f64(&entity.number(42, 0)?),
        ];
        let full = std::f64::consts::TAU;
        let missing = ((start - end) / full).ceil().max(0.0);
        let sweep = end + missing * full - start;
        let major = axis[0].hypot(axis[1]);
        let ellipse = EllipticArc {
            centre,
            radii: [major, major * ratio],
            tilt: axis[1].atan2(axis[0]),
            start,
            sweep,
        };
        let fragments = (self.options.fragments)(major);
        let steps = (f64::from(fragments) * sweep / full).ceil();
        if steps > MAX_EDGES as f64 {
            return Err(DrawingFileError::TooManyEdges);
        }
        self.drawing.approximated += 1;
        let points = ellipse.points((steps as u32).max(1));
        Ok(polyline(&points.ok_or(DrawingFileError::Coordinate)?))
    }

    /// The edges of a block. Like in OpenSCAD the scale of the drawing applies to every insertion,
    /// also to those within blocks.
    fn insert(&mut self, entity: &Entity<'t>) -> Result<Vec<FigureEdge>, DrawingFileError> {
        let [x, y] = [entity.number(41, 1)?, entity.number(42, 1)?];
        let [cos, sin] = direction(&entity.number(50, 0)?).map(|part| part * &self.options.scale);
        let map = EdgeMap::new(PlaneMap {
            matrix: [[&cos * &x, -&sin * &y], [sin * x, cos * y]],
            offset: self.point(entity, 0)?,
        });
        let Some(block) = self.blocks.get(entity.name) else {
            self.drawing.passed_over += 1;
            return Ok(Vec::new());
        };
        let fragments = self.options.fragments;
        let steps = |radius: f64, sweep: f64| {
            (f64::from(fragments(radius)) * sweep / std::f64::consts::TAU).ceil() as u32
        };
        let mut edges = Vec::with_capacity(block.len());
        for edge in block {
            match map.apply(edge) {
                Some(image) => edges.push(image),
                None => {
                    self.drawing.approximated += 1;
                    let points = cut(edge, steps);
                    let points: Vec<FigurePoint> =
                        points.iter().map(|p| map.map.apply(p)).collect();
                    edges.extend(polyline(&points));
                }
            }
            if edges.len() > MAX_EDGES {
                return Err(DrawingFileError::TooManyEdges);
            }
        }
        Ok(edges)
    }
}
