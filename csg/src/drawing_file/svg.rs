//! The elements of an SVG file as shapes.
//!
//! The meaning is that of OpenSCAD 2021.01. Shapes are filled by the even-odd rule, whatever their
//! style says, and open paths are stroked. Elements that are hidden, clip others or are symbols
//! are shapes like all others. Newer versions of OpenSCAD add `use` of elements in `defs`, and the
//! selection of an element by its id or by its layer.

mod attributes;
mod outline;
mod page;
mod path;
mod shapes;
mod transform;

use super::curves::{EdgeMap, check_numbers};
use super::error::DrawingFileError;
use super::{Drawing, DrawingOptions, DrawingShape};
use crate::figure::{ContourCorner, FigureEdge, FigurePoint, MAX_EDGES, PlaneMap};
use outline::Outline;
use page::{Page, moved};
use roxmltree::{Document, Node, ParsingOptions};
use std::collections::HashMap;

/// The largest number of elements and texts, and of elements after `use`.
const MAX_ELEMENTS: u32 = 1 << 18;

/// The largest number of uses within uses.
const MAX_USES: u32 = 32;

const SVG_NAMESPACE: &str = "http://www.w3.org/2000/svg";
const INKSCAPE_NAMESPACE: &str = "http://www.inkscape.org/namespaces/inkscape";

/// Reads an SVG file.
///
/// # Errors
/// The file is no XML, an attribute is malformed, elements use each other in a circle, or there are
/// too many.
pub(crate) fn read_svg(
    bytes: &[u8],
    options: &mut DrawingOptions<'_>,
) -> Result<Drawing, DrawingFileError> {
    let text = std::str::from_utf8(bytes).map_err(|_| DrawingFileError::Encoding)?;
    let parsing = ParsingOptions {
        allow_dtd: true,
        nodes_limit: MAX_ELEMENTS,
        ..ParsingOptions::default()
    };
    let document = Document::parse_with_options(text, parsing);
    let document = document.map_err(|error| DrawingFileError::Xml {
        message: error.to_string(),
    })?;
    let page = Page::new(&document, &options.dpi);
    let is_centred = options.is_centred;
    let mut reader = Reader {
        targets: targets(&document),
        page: &page,
        options,
        drawing: Drawing::default(),
        edge_count: 0,
    };
    reader.read(document.root_element())?;
    let mut drawing = reader.drawing;
    let offset = page.offset(&drawing.shapes, is_centred);
    drawing.shapes = moved(drawing.shapes, &offset);
    Ok(drawing)
}

/// The elements in `defs` by their ids. The first one counts.
fn targets<'d>(document: &'d Document<'_>) -> HashMap<&'d str, Node<'d, 'd>> {
    let mut targets = HashMap::new();
    let mut end = 0;
    for node in document.descendants().filter(Node::is_element) {
        // Elements come in the order of the file: those within `defs` begin before it ends.
        if name(&node) == "defs" {
            end = end.max(node.range().end);
        }
        if node.range().start < end
            && let Some(id) = node.attribute("id")
        {
            targets.entry(id).or_insert(node);
        }
    }
    targets
}

/// The name of an SVG element; empty for an element of another kind.
fn name<'d>(node: &Node<'d, '_>) -> &'d str {
    match node.tag_name().namespace() {
        None | Some(SVG_NAMESPACE) => node.tag_name().name(),
        Some(_) => "",
    }
}

/// The line at which an element starts.
fn line(node: &Node<'_, '_>) -> u32 {
    node.document().text_pos_at(node.range().start).row
}

/// Refuses maps whose numbers are too large or too long: the digits of maps within maps add up.
fn check_map(map: &PlaneMap) -> Result<(), DrawingFileError> {
    let [a, b] = map.matrix.clone();
    let offset = FigureEdge::line(map.offset.clone(), map.offset.clone());
    check_numbers(&[FigureEdge::line(a, b), offset])
}

/// An element that waits, and what it has from the elements around it.
struct Waiting<'d> {
    node: Node<'d, 'd>,
    map: PlaneMap,
    /// Whether an element around it is selected.
    is_selected: bool,
    /// Whether an element around it is the layer.
    is_in_layer: bool,
    uses: u32,
}

struct Reader<'d, 'p, 'a, 'o> {
    targets: HashMap<&'d str, Node<'d, 'd>>,
    page: &'p Page,
    options: &'o mut DrawingOptions<'a>,
    drawing: Drawing,
    edge_count: usize,
}

impl<'d> Reader<'d, '_, '_, '_> {
    fn read(&mut self, root: Node<'d, 'd>) -> Result<(), DrawingFileError> {
        let mut waiting = vec![Waiting {
            node: root,
            map: PlaneMap::identity(),
            is_selected: self.options.id.is_none() && self.layer().is_none(),
            is_in_layer: false,
            uses: 0,
        }];
        let mut count = 0;
        while let Some(element) = waiting.pop() {
            count += 1;
            if count > MAX_ELEMENTS {
                return Err(DrawingFileError::TooManyEdges);
            }
            self.element(element, &mut waiting)?;
        }
        Ok(())
    }

    fn layer(&self) -> Option<&str> {
        self.options.layer.filter(|layer| !layer.is_empty())
    }

    /// Whether an element is the layer that is read.
    fn is_layer(&self, node: &Node<'_, '_>) -> bool {
        let attribute = |name| node.attribute((INKSCAPE_NAMESPACE, name));
        let label = attribute("label").filter(|_| attribute("groupmode") == Some("layer"));
        label.is_some() && label == self.layer()
    }

    /// Notes whether an element is in the layer that is read, and whether it is read.
    fn select(&self, element: &mut Waiting<'d>) {
        let node = &element.node;
        element.is_in_layer |= self.is_layer(node);
        element.is_selected |= match (self.options.id, self.layer()) {
            (Some(id), Some(_)) => element.is_in_layer && node.attribute("id") == Some(id),
            (Some(id), None) => node.attribute("id") == Some(id),
            (None, _) => element.is_in_layer,
        };
    }

    fn element(
        &mut self,
        mut element: Waiting<'d>,
        waiting: &mut Vec<Waiting<'d>>,
    ) -> Result<(), DrawingFileError> {
        let node = element.node;
        self.select(&mut element);
        match name(&node) {
            "defs" => return Ok(()),
            "text" => {
                self.drawing.passed_over += 1;
                return Ok(());
            }
            "g" => element.map = self.mapped(&element)?,
            "use" => {
                element.map = self.mapped(&element)?;
                waiting.extend(self.used(element)?);
                return Ok(());
            }
            kind if shapes::is_shape(kind) => {
                element.map = self.mapped(&element)?;
                if element.is_selected {
                    self.shape(kind, &element)?;
                }
                return Ok(());
            }
            // Other elements have no effect, but their children have.
            _ => {}
        }
        let children = node.children().filter(Node::is_element).rev();
        waiting.extend(children.map(|node| Waiting {
            node,
            map: element.map.clone(),
            ..element
        }));
        Ok(())
    }

    /// The map of an element's contents.
    fn mapped(&self, element: &Waiting<'d>) -> Result<PlaneMap, DrawingFileError> {
        let own = transform::read(&element.node)?;
        let map = own.then(&element.map);
        check_map(&map)?;
        Ok(map)
    }

    /// The element that another one uses.
    fn used(&self, element: Waiting<'d>) -> Result<Option<Waiting<'d>>, DrawingFileError> {
        let node = element.node;
        let href = node
            .attributes()
            .find(|attribute| attribute.name() == "href");
        let id = href.and_then(|attribute| attribute.value().strip_prefix('#'));
        let Some(target) = id.and_then(|id| self.targets.get(id)) else {
            return Ok(None);
        };
        if element.uses == MAX_USES {
            return Err(DrawingFileError::Nesting { line: line(&node) });
        }
        let offset = PlaneMap {
            offset: ["x", "y"].map(|name| attributes::number(&node, name)),
            ..PlaneMap::identity()
        };
        Ok(Some(Waiting {
            node: *target,
            map: offset.then(&element.map),
            uses: element.uses + 1,
            ..element
        }))
    }

    fn shape(&mut self, kind: &str, element: &Waiting<'d>) -> Result<(), DrawingFileError> {
        let map = EdgeMap::new(element.map.then(&self.page.linear()));
        let mut outline = Outline::new(self.options, map.factor.clone());
        shapes::add(kind, &element.node, &mut outline)?;
        let contours = outline.contours(&element.node)?;
        self.drawing.approximated += contours.approximated;
        let mut shape = DrawingShape::new();
        for edges in &contours.contours {
            self.edge_count += edges.len();
            if self.edge_count > MAX_EDGES {
                return Err(DrawingFileError::TooManyEdges);
            }
            // Arcs that the map makes elliptic are cut already.
            let images: Vec<FigureEdge> = edges.iter().filter_map(|e| map.apply(e)).collect();
            check_numbers(&images)?;
            shape.push(corners(&images));
        }
        shape.retain(|contour| !contour.is_empty());
        if !shape.is_empty() {
            self.drawing.shapes.push(shape);
        }
        Ok(())
    }
}

/// The contour of consecutive edges. A segment closes it.
fn corners(edges: &[FigureEdge]) -> Vec<ContourCorner> {
    let corner = |point: &FigurePoint, edge: Option<&FigureEdge>| ContourCorner {
        point: point.clone(),
        arc: edge.and_then(|edge| edge.arc.clone()),
    };
    let starts = edges.iter().map(|edge| corner(&edge.start, Some(edge)));
    let last = edges.last().map(|edge| corner(&edge.end, None));
    starts.chain(last).collect()
}
