//! Samples along the edges and limbs of a part, at which images are evaluated.

use nalgebra::{Point3, Vector3};
use premio_kernel::brep::Brep;
use premio_kernel::brep::topology::EdgeId;
use std::ops::Range;

/// The number of samples along the size of the part, and the fewest and most of an edge.
const ALONG: f64 = 24.0;
const MIN_RATE: usize = 6;
const MOST: usize = 64;

/// A sampled edge of a part.
#[derive(Clone, Debug, PartialEq)]
pub struct SampledEdge {
    /// The edge.
    pub edge: EdgeId,
    /// The range of its samples.
    pub marks: Range<usize>,
    /// The probabilities that it is whole, broken and missed where it is visible: with both its
    /// faces, and with one of them, as an outline.
    pub states: [[f64; 3]; 2],
    /// Its ends, where it has any.
    pub ends: Option<[EdgeEnd; 2]>,
    /// Its length.
    pub length: f64,
}

/// An end of an edge.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeEnd {
    /// The point.
    pub point: Point3<f64>,
    /// The unit tangent that points away from the edge.
    pub outwards: Vector3<f64>,
}

/// A point of an edge or of a limb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EdgeSample {
    /// The point.
    pub point: Point3<f64>,
    /// The unit tangent.
    pub tangent: Vector3<f64>,
    /// The outward normals of the faces on both sides; none for a limb, which is known to be
    /// visible.
    pub normals: Option<[Vector3<f64>; 2]>,
    /// The parameter on the edge's curve.
    pub parameter: f64,
    /// The index of its edge; for a limb the number of edges plus its own index.
    pub stroke: usize,
    /// The length that it represents.
    pub step: f64,
}

impl EdgeSample {
    /// Whether only one of its faces is turned towards an eye.
    pub fn is_outline(&self, eye: &Point3<f64>) -> bool {
        let towards = eye - self.point;
        let turned = |n: &[Vector3<f64>; 2]| n[0].dot(&towards) * n[1].dot(&towards) < 0.0;
        self.normals.as_ref().is_none_or(turned)
    }

    /// Whether a face on either side is turned towards an eye.
    pub fn faces(&self, eye: &Point3<f64>) -> bool {
        let towards = eye - self.point;
        let turned = |n: &[Vector3<f64>; 2]| n[0].dot(&towards) > 0.0 || n[1].dot(&towards) > 0.0;
        self.normals.as_ref().is_none_or(turned)
    }
}

/// The visibility of a part from a direction.
#[derive(Clone, Debug, Default)]
pub struct PartView {
    /// By sample: whether a face occludes it.
    pub hidden: Vec<bool>,
    /// The samples of visible limbs.
    pub limbs: Vec<EdgeSample>,
}

/// The sharp edges of a part, with their samples.
#[derive(Clone, Debug)]
pub struct SampledEdges {
    /// The edges.
    pub strokes: Vec<SampledEdge>,
    /// The samples of all edges.
    pub marks: Vec<EdgeSample>,
}

/// The sharp edges of a part, with their samples.
pub fn marks(brep: &Brep, radius: f64, states: impl Fn(EdgeId) -> [[f64; 3]; 2]) -> SampledEdges {
    let (mut strokes, mut marks) = (Vec::new(), Vec::new());
    for edge in brep.topology.edge_ids() {
        if brep.topology.edge(edge).smooth {
            continue;
        }
        let curve = brep.curve(edge);
        let [from, to] = brep.range(edge);
        let fine = 64;
        let at = |k: usize, n: usize| from + (to - from) * (k as f64 + 0.5) / n as f64;
        let speeds = (0..fine).map(|k| curve.speed(at(k, fine)));
        let length = speeds.sum::<f64>() * (to - from) / f64::from(fine as u32);
        let count = (length / (2.0 * radius) * ALONG).ceil() as usize;
        let count = count.clamp(MIN_RATE, MOST);
        let mut faces = brep.topology.faces_of(edge);
        let Some(first) = faces.next() else { continue };
        let second = faces.next().unwrap_or(first);
        let start = marks.len();
        for k in 0..count {
            let parameter = at(k, count);
            let point = curve.point(parameter);
            let tangent = curve.tangent(parameter);
            marks.push(EdgeSample {
                point,
                tangent,
                normals: Some([first, second].map(|f| brep.outward(f, &point))),
                parameter,
                stroke: strokes.len(),
                step: length / count as f64,
            });
        }
        strokes.push(SampledEdge {
            edge,
            marks: start..marks.len(),
            states: states(edge),
            ends: brep.topology.edge(edge).ends.map(|_| {
                let end = |t: f64, sign: f64| EdgeEnd {
                    point: curve.point(t),
                    outwards: curve.tangent(t) * sign,
                };
                [end(from, -1.0), end(to, 1.0)]
            }),
            length,
        });
    }
    SampledEdges { strokes, marks }
}
