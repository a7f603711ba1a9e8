//! Volume, area and centroid of the exact boundary.
//!
//! By the divergence theorem each is a sum over faces of ∫ g dA. By Green's theorem in the
//! surface's parameters (u, v) that is a sum over edges: with G(u, v) = ∫ g |P_u × P_v| dv from a
//! fixed v, the face contributes −∮ G du. The contribution of a period or a pole follows from the
//! area, which lies between zero and that of the whole surface. Notation: P relative to a reference
//! point, N the surface's normal, h = P·N.

mod closed_form;
mod density;
mod ellipsoid_strip;
mod face;
mod ground;
mod outline;
mod pole_turns;
mod strip;
mod waves;

use super::Brep;
use super::topology::{FaceId, ShellId};
use crate::concurrency;
use crate::geometry::bounds::Aabb;
use crate::geometry::surface::Surface;
use crate::geometry::vector::{Length, rounded};
use crate::number::float::Float;
use crate::number::predicates::{Compare, ROUNDING};
use face::face_sum;
use nalgebra::{Point3, Vector3};

/// The mass properties of a body of density one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mass {
    /// The volume, in cubic units.
    pub volume: f64,
    /// The area of the boundary, in square units.
    pub area: f64,
    /// The centroid; the reference point where the volume is zero.
    pub centroid: Point3<f64>,
}

impl Mass {
    /// The mass properties of bodies that have no point in common.
    pub fn sum(bodies: &[Self]) -> Self {
        let volume = bodies.iter().map(|body| body.volume).sum::<f64>();
        let first = bodies.iter().map(|body| body.centroid.coords * body.volume);
        let first = first.sum::<Vector3<f64>>();
        Self {
            volume,
            area: bodies.iter().map(|body| body.area).sum(),
            centroid: match volume.is_exactly(0.0) {
                true => bodies
                    .first()
                    .map_or(Point3::origin(), |body| body.centroid),
                false => (first / volume).into(),
            },
        }
    }
}

/// ∫ dA, ∫ h dA and ∫ h P dA over a face.
type Moments<N> = [N; 5];

/// The integrals over the faces of a boundary, computed once for all queries.
#[derive(Clone, Debug)]
pub struct FaceIntegrals<N: Float = f64> {
    /// Reference point of all faces.
    whole: Amid<N>,
    /// Reference point of each shell, so that the distance between shells costs no digits.
    shells: Vec<Amid<N>>,
    /// The moments of each face about the reference point of its shell.
    faces: Vec<Moments<N>>,
    /// The defect of the closure of each face's boundary.
    defects: Vec<N>,
}

impl<N: Float> FaceIntegrals<N> {
    /// The integrals over the faces of a boundary, to the precision of f64.
    pub fn new(brep: &Brep<N>) -> Self {
        Self::with(brep, Care::Doubles, EdgeDivision::Plain)
    }

    /// The same integrals with every edge divided ever finer towards its ends, to check those of
    /// [`Self::new`]: where a quadrature has no node in a part of an edge, the two differ.
    pub(crate) fn with_graded_edges(brep: &Brep<N>) -> Self {
        Self::with(brep, Care::Doubles, EdgeDivision::Graded)
    }

    fn with(brep: &Brep<N>, care: Care, division: EdgeDivision) -> Self {
        let shells = brep.topology.shells.iter();
        let shells: Vec<Amid<N>> = shells
            .map(|shell| Amid {
                division,
                ..Amid::new(brep, shell.faces.iter().copied(), care)
            })
            .collect();
        let about = |face| &shells[brep.topology.face(face).shell.index()];
        let faces: Vec<FaceId> = brep.topology.face_ids().collect();
        let sums = concurrency::map(&faces, FACE_GRAIN, |&face| {
            face_sum(brep, face, about(face))
        });
        Self {
            whole: Amid::new(brep, brep.topology.face_ids(), care),
            defects: sums.iter().map(|sum| sum.defect).collect(),
            faces: sums.into_iter().map(|sum| sum.moments).collect(),
            shells,
        }
    }

    /// The precision of the integrals that the boundary's edges allow, relative to the part's size.
    /// Where surfaces nearly touch, the direction of an edge is known less accurately than its
    /// points, and the integral of du around a face does not close by as much.
    pub fn precision(&self) -> N {
        self.defects
            .iter()
            .fold(N::ZERO, |most, defect| most.max(*defect))
    }

    /// The defect of the closure of each face's boundary: in radians, or relative to the part's size on a
    /// plane.
    pub(crate) fn defects(&self) -> &[N] {
        &self.defects
    }

    /// The faces over which two computations of the integrals differ by more than their errors.
    pub(crate) fn different_faces<'a>(
        &'a self,
        brep: &'a Brep<N>,
        other: &'a Self,
    ) -> impl Iterator<Item = FaceDifference> + 'a {
        let defect = N::TWO * self.precision().max(other.precision());
        brep.topology.face_ids().filter_map(move |face| {
            let [ours, theirs] = [self, other].map(|known| known.faces[face.index()]);
            let shell = &self.shells[brep.topology.face(face).shell.index()];
            // A closed surface may be far larger than its edges.
            let size = shell.size.max(ours[0].abs().sqrt());
            let origin = brep.surface(face).frame().origin;
            let coordinates = shell.reference.coords.length() + (origin - shell.reference).length();
            let rounding = N::from_f64(NOISE * ROUNDING) * coordinates / size;
            let part = N::from_f64(MAX_DIFFERENCE) + defect + rounding;
            let (area, volume) = (size * size, size * size * size);
            let first = volume * size;
            let sizes = [area, volume, first, first, first];
            let is_same = (0..sizes.len()).all(|k| {
                let difference = (ours[k] - theirs[k]).abs();
                difference.is_at_most(part * sizes[k])
            });
            (!is_same).then(|| FaceDifference {
                face,
                areas: [ours[0], theirs[0]].map(N::rounded),
            })
        })
    }

    /// The mass properties of the solid that the boundary encloses.
    pub fn mass(&self, brep: &Brep<N>) -> Mass {
        let MassEstimate { mass, noise } = self.summed_up(brep);
        match N::IS_DOUBLE || (SLENDER * mass.volume).is_beyond(noise) {
            true => mass,
            false => {
                Self::with(brep, Care::Digits, EdgeDivision::Plain)
                    .summed_up(brep)
                    .mass
            }
        }
    }

    /// The mass properties, with the rounding error of the volume.
    fn summed_up(&self, brep: &Brep<N>) -> MassEstimate {
        let reference = self.whole.reference;
        let (mut area, mut volume, mut first) = (N::ZERO, N::ZERO, Vector3::zeros());
        for (shell, amid) in brep.topology.shells.iter().zip(&self.shells) {
            let m = shell_moments(brep, self.moments_of(&shell.faces));
            let enclosed = m[1] / N::from_f64(3.0);
            area += m[0];
            volume += enclosed;
            first += (amid.reference - reference) * enclosed;
            first += Vector3::new(m[2], m[3], m[4]) / N::from_f64(4.0);
        }
        let centroid = if volume.is_exactly(N::ZERO) {
            reference
        } else {
            reference + first / volume
        };
        let mass = Mass {
            volume: volume.rounded(),
            area: area.rounded(),
            centroid: rounded(&centroid).into(),
        };
        let bulk = area * self.whole.size;
        let noise = self.whole.noise(brep, brep.topology.face_ids(), bulk);
        MassEstimate {
            mass,
            noise: noise.rounded(),
        }
    }

    /// The moments of some faces.
    fn moments_of(&self, faces: &[FaceId]) -> impl Iterator<Item = FaceMoments<N>> {
        faces.iter().map(|&face| FaceMoments {
            face,
            moments: self.faces[face.index()],
        })
    }

    /// The signed volume that a shell encloses.
    ///
    /// # Panics
    /// The boundary has no such shell.
    pub fn enclosed(&self, brep: &Brep<N>, shell: ShellId) -> ShellVolume<N> {
        let faces = &brep.topology.shells[shell.index()].faces;
        let amid = &self.shells[shell.index()];
        let moments = shell_moments(brep, self.moments_of(faces));
        let integral = enclosed(brep, faces, moments, amid, self.whole.size);
        match N::IS_DOUBLE || integral.is_clear() {
            true => integral,
            false => shell_volume(brep, faces, self.whole.size),
        }
    }

    /// The areas of all faces, by id.
    pub fn areas(&self, brep: &Brep<N>) -> Vec<FaceArea<N>> {
        let covered = |face: FaceId, amid: &Amid<N>, area: N| {
            let [floor, ..] = amid.floor(brep, face);
            FaceArea {
                area,
                noise: N::from_f64(NOISE) * floor,
            }
        };
        let of_face = |face: FaceId| {
            let shell = brep.topology.face(face).shell.index();
            let integral = covered(face, &self.shells[shell], self.faces[face.index()][0]);
            if N::IS_DOUBLE || integral.area.is_beyond(integral.noise) {
                return integral;
            }
            let amid = Amid {
                care: Care::Digits,
                ..self.shells[shell]
            };
            covered(face, &amid, face_sum(brep, face, &amid).moments[0])
        };
        brep.topology.face_ids().map(of_face).collect()
    }
}

/// The least number of faces for a thread.
const FACE_GRAIN: usize = 32;

/// The ratio of rounding error to volume below which f64 is accurate enough.
const SLENDER: f64 = 1.0 / (1_u64 << 20) as f64;

/// The signed volume that a shell encloses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShellVolume<N: Float = f64> {
    /// The volume, negative for a void, in cubic units.
    pub volume: N,
    /// The bound of its rounding error.
    pub noise: N,
}

impl<N: Float> ShellVolume<N> {
    /// Whether its sign is known.
    pub(crate) fn is_clear(&self) -> bool {
        self.volume.abs().is_beyond(self.noise)
    }
}

/// The largest difference of two computations of an integral over a face, relative to the part's size.
const MAX_DIFFERENCE: f64 = 1.0 / (1_u64 << 33) as f64;

/// A face over which two computations of the same integrals differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FaceDifference {
    /// The face.
    pub face: FaceId,
    /// Its areas.
    pub areas: [f64; 2],
}

/// How edges are divided before a quadrature.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum EdgeDivision {
    /// As their curves require.
    Plain,
    /// Also at points ever closer to both ends.
    Graded,
}

/// The precision of the integrals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Care {
    /// That of f64.
    Doubles,
    /// Extended precision, to far more than is reported; f64 where there is no other.
    Digits,
    /// Full precision.
    Last,
}

impl Care {
    /// The error of sums relative to their terms.
    fn part<N: Float>(self) -> N {
        match self {
            Self::Doubles => N::from_f64(f64::rules().settled / NOISE),
            Self::Digits => N::rules().settled / N::from_f64(NOISE),
            Self::Last => N::ROUNDING,
        }
    }
}

/// The volume's error bound, in multiples of area times the part's size times rounding.
const NOISE: f64 = 64.0;

/// The size of a part, to which the rounding of its coordinates is proportional.
pub(crate) fn size<N: Float>(brep: &Brep<N>) -> N {
    Amid::new(brep, brep.topology.face_ids(), Care::Doubles).size
}

/// The signed volume that a shell encloses; `size` is that of the part.
pub(crate) fn shell_volume<N: Float>(brep: &Brep<N>, faces: &[FaceId], size: N) -> ShellVolume<N> {
    let volume = |care| {
        let amid = Amid::new(brep, faces.iter().copied(), care);
        let of = faces.iter().map(|&face| FaceMoments {
            face,
            moments: face_sum(brep, face, &amid).moments,
        });
        enclosed(brep, faces, shell_moments(brep, of), &amid, size)
    };
    let rough = volume(Care::Doubles);
    if N::IS_DOUBLE || rough.is_clear() {
        return rough;
    }
    let fine = volume(Care::Digits);
    match fine.is_clear() {
        true => fine,
        false => volume(Care::Last),
    }
}

/// The volume of some faces, and its error, from their moments.
fn enclosed<N: Float>(
    brep: &Brep<N>,
    faces: &[FaceId],
    [area, volume, ..]: Moments<N>,
    amid: &Amid<N>,
    size: N,
) -> ShellVolume<N> {
    ShellVolume {
        volume: volume / N::from_f64(3.0),
        noise: amid.noise(brep, faces.iter().copied(), area * size),
    }
}

/// The moments of a face.
struct FaceMoments<N: Float = f64> {
    face: FaceId,
    moments: Moments<N>,
}

/// Mass properties, and the rounding error of the volume.
struct MassEstimate {
    mass: Mass,
    noise: f64,
}

/// The moments of a shell from those of its faces. The area is summed without signs, the others
/// with signs.
fn shell_moments<N: Float>(
    brep: &Brep<N>,
    faces: impl Iterator<Item = FaceMoments<N>>,
) -> Moments<N> {
    let mut total = [N::ZERO; 5];
    for FaceMoments { face, moments: m } in faces {
        let sign = brep.sense(face).sign::<N>();
        total[0] += m[0];
        for i in 1..5 {
            total[i] += sign * m[i];
        }
    }
    total
}

/// The area of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FaceArea<N: Float = f64> {
    /// The area, in square units.
    pub area: N,
    /// The bound of its rounding error.
    pub noise: N,
}

/// A reference point amid some faces, relative to which sums do not cancel, the size of these faces,
/// and how integrals over them are computed.
#[derive(Clone, Debug)]
struct Amid<N: Float = f64> {
    reference: Point3<N>,
    size: N,
    /// The precision of the integrals.
    care: Care,
    /// How edges are divided.
    division: EdgeDivision,
}

impl<N: Float> Amid<N> {
    fn new(brep: &Brep<N>, faces: impl Iterator<Item = FaceId>, care: Care) -> Self {
        let (mut edges, mut all) = (Aabb::EMPTY, Aabb::EMPTY);
        for face in faces {
            edges = edges.hull(&box_of(brep, face));
            // A face that bulges beyond its edges has about the size of its surface.
            if let Surface::Sphere(_) | Surface::Torus(_) | Surface::Ellipsoid(_) =
                brep.surface(face)
            {
                all = all.hull(&Aabb::new(&brep.surface(face).frame().origin));
            }
        }
        let size = N::from_f64(all.hull(&edges).diagonal());
        let reference = if size.is_finite() {
            edges.centre().map(N::from_f64)
        } else {
            Point3::origin()
        };
        Self {
            reference,
            size,
            care,
            division: EdgeDivision::Plain,
        }
    }

    /// The error of sums relative to their terms.
    fn part(&self) -> N {
        self.care.part()
    }

    /// The error of the volume of faces; `bulk` is their area times the part's size. If f64 stands
    /// in for extended precision, that area may itself be close to zero.
    fn noise(&self, brep: &Brep<N>, faces: impl Iterator<Item = FaceId>, bulk: N) -> N {
        let by_area = self.part() * bulk;
        let floors = match self.tells_in_doubles() {
            true => faces.map(|face| self.floor(brep, face)[1]).sum(),
            false => N::ZERO,
        };
        N::from_f64(NOISE) * (by_area + floors)
    }

    /// Whether f64 stands in for extended precision.
    fn tells_in_doubles(&self) -> bool {
        !N::IS_DOUBLE && self.care == Care::Doubles
    }

    /// The errors of a face's moments that may be ignored: those caused by the rounding of its
    /// edges.
    fn floor(&self, brep: &Brep<N>, face: FaceId) -> Moments<N> {
        let along = N::from_f64(box_of(brep, face).diagonal()).min(self.size);
        let area = self.part() * self.size * along;
        let (volume, first) = (area * self.size, area * self.size * self.size);
        [area, volume, first, first, first]
    }
}

/// A fraction of an edge that is neither its end nor its middle.
const ASYMMETRIC: f64 = 0.3;

/// A box amid a face: of points of its edges, or of the whole surface if it has no edges.
fn box_of<N: Float>(brep: &Brep<N>, face: FaceId) -> Aabb {
    let mut b = Aabb::EMPTY;
    for edge in brep.topology.edges_of(face) {
        let (curve, [lo, hi]) = (brep.curve(edge), brep.range(edge));
        b = b.hull(&Aabb::new(&curve.point(lo)));
        b = b.hull(&Aabb::new(&curve.point(N::HALF * (lo + hi))));
        // The end and the middle of a closed curve that crosses itself may be one point.
        if brep
            .topology
            .edge(edge)
            .ends
            .is_none_or(|[from, to]| from == to)
        {
            let other = lo + (hi - lo) * N::from_f64(ASYMMETRIC);
            b = b.hull(&Aabb::new(&curve.point(other)));
        }
    }
    let surface = brep.surface(face);
    let radius = match surface {
        _ if !brep.topology.face(face).loops.is_empty() => return b,
        Surface::Sphere(s) => s.radius,
        Surface::Torus(t) => t.circumradius(),
        Surface::Ellipsoid(s) => s.circumradius(),
        Surface::Plane(_)
        | Surface::Cylinder(_)
        | Surface::Cone(_)
        | Surface::EllipticCylinder(_)
        | Surface::EllipticCone(_) => return b,
    };
    Aabb::new(&surface.frame().origin).grown(radius)
}
