//! Volume, area and centroid of the exact boundary.
//!
//! By the divergence theorem each is a sum over faces of ∫ g dA, and by Green's in the surface's
//! parameters (u, v) a sum over edges: with G(u, v) = ∫ g |P_u × P_v| dv from a fixed v, the face
//! gives −∮ G du. What a period or a pole adds is told by the area, which lies between nothing and
//! the whole surface. Notation: P relative to a reference point, N the surface's normal, h = P·N.

mod ground;
mod strip;

use super::Brep;
use super::locate::{FaceLocator, Place};
use super::topology::{CoedgeId, FaceId};
use crate::geometry::bounds::{self, Box3};
use crate::geometry::frame::Frame;
use crate::geometry::section::plane_roots;
use crate::geometry::surface::{Plane, Sphere, Surface, Torus};
use crate::geometry::vector::{Length, rounded};
use crate::number::precision::Number;
use crate::number::quadrature::adaptive;
use crate::number::sign::Sign;
use ground::{Between, Ground, OnEdge};
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

/// ∫ dA, ∫ h dA and ∫ h P dA over a face.
type Moments<N> = [N; 5];

/// The mass properties of the solid that a boundary encloses: the sum over its shells, each reckoned
/// about a point amid it, so that how far apart they lie costs no digits.
pub fn mass<N: Number>(brep: &Brep<N>) -> Mass {
    let (mass, _) = measured::<N, _>(
        |care| summed_up(brep, care),
        |(mass, noise)| (SLENDER * mass.volume).is_beyond(*noise),
    );
    mass
}

/// Where the volume is at least so much more than what doubles may make of it, they tell it.
const SLENDER: f64 = 1.0 / (1_u64 << 20) as f64;

/// The mass properties, and what rounding may make of the volume.
fn summed_up<N: Number>(brep: &Brep<N>, care: Care) -> (Mass, f64) {
    let all = Amid::of(brep, brep.topology.face_ids(), care);
    let reference = all.reference;
    let (mut area, mut volume, mut first) = (N::ZERO, N::ZERO, Vector3::zeros());
    for shell in &brep.topology.shells {
        let amid = Amid::of(brep, shell.faces.iter().copied(), care);
        let m = shell_moments(brep, &shell.faces, &amid);
        let enclosed = m[1] / N::of(3.0);
        area += m[0];
        volume += enclosed;
        first += (amid.reference - reference) * enclosed;
        first += Vector3::new(m[2], m[3], m[4]) / N::of(4.0);
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
    let noise = all.noise(brep, brep.topology.face_ids(), area * all.size);
    (mass, noise.rounded())
}

/// The signed volume that a shell encloses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Enclosed<N: Number = f64> {
    /// The volume, negative for a void, in cubic units.
    pub volume: N,
    /// What rounding may make of it.
    pub noise: N,
}

impl<N: Number> Enclosed<N> {
    /// Whether its sign is known.
    pub fn is_clear(&self) -> bool {
        self.volume.abs().is_beyond(self.noise)
    }
}

/// How closely integrals are followed.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Care {
    /// As doubles tell them.
    Doubles,
    /// With more digits to far more than is told; as doubles tell them where there are no more.
    Digits,
    /// To the last digit.
    Last,
}

impl Care {
    /// What sums are known to, relative to their terms.
    fn part<N: Number>(self) -> N {
        match self {
            Self::Doubles => N::of(f64::rules().settled / NOISE),
            Self::Digits => N::rules().settled / N::of(NOISE),
            Self::Last => N::ROUNDING,
        }
    }
}

/// What is measured by doubles where that is good enough, else with more digits if there are any.
fn measured<N: Number, T>(measure: impl Fn(Care) -> T, is_good: impl Fn(&T) -> bool) -> T {
    let rough = measure(Care::Doubles);
    match N::IS_DOUBLE || is_good(&rough) {
        true => rough,
        false => measure(Care::Digits),
    }
}

/// How many times the rounding of its area times the part's size a volume may be off.
const NOISE: f64 = 64.0;

/// The size of a part, in terms of which its coordinates are rounded.
pub fn size<N: Number>(brep: &Brep<N>) -> N {
    Amid::of(brep, brep.topology.face_ids(), Care::Doubles).size
}

/// The signed volume that a shell encloses; `size` is that of the part.
pub fn shell_volume<N: Number>(brep: &Brep<N>, faces: &[FaceId], size: N) -> Enclosed<N> {
    let enclosed = |care| {
        let amid = Amid::of(brep, faces.iter().copied(), care);
        let [area, volume, ..] = shell_moments(brep, faces, &amid);
        Enclosed {
            volume: volume / N::of(3.0),
            noise: amid.noise(brep, faces.iter().copied(), area * size),
        }
    };
    let told = measured::<N, _>(enclosed, Enclosed::is_clear);
    match N::IS_DOUBLE || told.is_clear() {
        true => told,
        false => enclosed(Care::Last),
    }
}

/// The moments of a shell: its area, and the others signed.
fn shell_moments<N: Number>(brep: &Brep<N>, faces: &[FaceId], amid: &Amid<N>) -> Moments<N> {
    let mut total = [N::ZERO; 5];
    for &face in faces {
        let m = moments(brep, face, amid);
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
pub struct Covered<N: Number = f64> {
    /// The area, in square units.
    pub area: N,
    /// What rounding may make of it.
    pub noise: N,
}

/// The areas of all faces, by id.
pub fn face_areas<N: Number>(brep: &Brep<N>) -> Vec<Covered<N>> {
    let nothing = Covered {
        area: N::ZERO,
        noise: N::ZERO,
    };
    let mut areas = vec![nothing; brep.topology.faces.len()];
    for shell in &brep.topology.shells {
        let amid = |care| Amid::of(brep, shell.faces.iter().copied(), care);
        let [rough, fine] = [Care::Doubles, Care::Digits].map(amid);
        for &face in &shell.faces {
            let covered = |care| {
                let amid = match care {
                    Care::Doubles => &rough,
                    Care::Digits | Care::Last => &fine,
                };
                let [floor, ..] = amid.floor(brep, face);
                Covered {
                    area: moments(brep, face, amid)[0],
                    noise: N::of(NOISE) * floor,
                }
            };
            let is_clear = |c: &Covered<N>| c.area.is_beyond(c.noise);
            areas[face.index()] = measured::<N, _>(covered, is_clear);
        }
    }
    areas
}

/// A point amid some faces, relative to which sums do not cancel, and their size.
struct Amid<N: Number = f64> {
    reference: Point3<N>,
    size: N,
    /// How closely integrals are followed.
    care: Care,
}

impl<N: Number> Amid<N> {
    fn of(brep: &Brep<N>, faces: impl Iterator<Item = FaceId>, care: Care) -> Self {
        let (mut edges, mut all) = (Box3::EMPTY, Box3::EMPTY);
        for face in faces {
            edges = edges.hull(&box_of(brep, face));
            // What bulges beyond its edges is of the size of its surface.
            if let Surface::Sphere(_) | Surface::Torus(_) = brep.surface(face) {
                all = all.hull(&Box3::of(&brep.surface(face).frame().origin));
            }
        }
        let size = N::of(all.hull(&edges).diagonal());
        let reference = if size.is_finite() {
            edges.centre().map(N::of)
        } else {
            Point3::origin()
        };
        Self {
            reference,
            size,
            care,
        }
    }

    /// What sums are known to, relative to their terms.
    fn part(&self) -> N {
        self.care.part()
    }

    /// What the volume of faces may be off, by their area times the size of the part. Where numbers
    /// of more digits are asked about in doubles, that area may itself be next to nothing.
    fn noise(&self, brep: &Brep<N>, faces: impl Iterator<Item = FaceId>, bulk: N) -> N {
        let by_area = self.part() * bulk;
        let floors = match self.tells_in_doubles() {
            true => faces.map(|face| self.floor(brep, face)[1]).sum(),
            false => N::ZERO,
        };
        N::of(NOISE) * (by_area + floors)
    }

    /// Whether doubles tell for numbers of more digits.
    fn tells_in_doubles(&self) -> bool {
        !N::IS_DOUBLE && self.care == Care::Doubles
    }

    /// The errors of a face's moments that do not matter: what the rounding of its edges makes.
    fn floor(&self, brep: &Brep<N>, face: FaceId) -> Moments<N> {
        let along = N::of(box_of(brep, face).diagonal()).min(self.size);
        let area = self.part() * self.size * along;
        let (volume, first) = (area * self.size, area * self.size * self.size);
        [area, volume, first, first, first]
    }
}

/// A box amid a face: of its edges' ends and middles, or of the whole surface, where it has none.
fn box_of<N: Number>(brep: &Brep<N>, face: FaceId) -> Box3 {
    let topology = &brep.topology;
    let mut b = Box3::EMPTY;
    for &l in &topology.face(face).loops {
        for &c in &topology.ring(l).coedges {
            let edge = topology.coedge(c).edge;
            let (curve, [lo, hi]) = (brep.curve(edge), brep.range(edge));
            b = b.hull(&Box3::of(&curve.point(lo)));
            b = b.hull(&Box3::of(&curve.point(N::HALF * (lo + hi))));
        }
    }
    let surface = brep.surface(face);
    let radius = match surface {
        _ if !topology.face(face).loops.is_empty() => return b,
        Surface::Sphere(s) => s.radius,
        Surface::Torus(t) => t.major + t.minor,
        Surface::Plane(_) | Surface::Cylinder(_) | Surface::Cone(_) => return b,
    };
    Box3::of(&surface.frame().origin).grown(radius)
}

/// What a face is measured by.
struct Density<'a, N: Number = f64> {
    ground: Ground<N>,
    /// The same in doubles, where these may tell.
    doubles: Option<Ground>,
    amid: &'a Amid<N>,
    /// The errors that do not matter.
    floor: Moments<N>,
}

impl<N: Number> Density<'_, N> {
    /// Where the integral along v starts for a loop: amid its edges, so that what is the same on all
    /// of them does not have to cancel.
    fn start(&self, brep: &Brep<N>, coedges: &[CoedgeId]) -> N {
        let Ground { surface, base, .. } = &self.ground;
        match surface {
            // At the apex u leaps, where nothing may be between.
            Surface::Cone(c) if reaches(brep, coedges, &c.frame.origin) => *base,
            _ => amid_edges(brep, surface, *base, coedges),
        }
    }

    /// The integral over all that lies between two v.
    fn between(&self, from: N, to: N) -> Moments<N> {
        self.over([N::ZERO, N::TAU], [from, to])
    }

    /// The integral over a range of u and of v.
    fn over(&self, [a, b]: [N; 2], range: [N; 2]) -> Moments<N> {
        let between = Between {
            ground: &self.ground,
            range,
            doubles: self.doubles.as_ref(),
        };
        adaptive(a, b, &self.floor, &between)
    }
}

/// The moments of a face.
fn moments<N: Number>(brep: &Brep<N>, face: FaceId, amid: &Amid<N>) -> Moments<N> {
    let loops = &brep.topology.face(face).loops;
    let coedges: Vec<CoedgeId> = loops
        .iter()
        .flat_map(|&l| brep.topology.ring(l).coedges.iter().copied())
        .collect();
    let surface = match *brep.surface(face) {
        Surface::Sphere(s) => Surface::Sphere(Sphere {
            frame: clear_axis(brep, &s, &coedges),
            ..s
        }),
        other => other,
    };
    let base = match &surface {
        Surface::Plane(_) | Surface::Cylinder(_) | Surface::Cone(_) => N::ZERO,
        Surface::Sphere(_) => -N::PI / N::TWO,
        Surface::Torus(_) => N::of(BASE),
    };
    let ground = Ground {
        surface,
        reference: amid.reference,
        base,
    };
    let d = Density {
        doubles: amid.tells_in_doubles().then(|| ground.in_doubles()),
        ground,
        amid,
        floor: amid.floor(brep, face),
    };
    match &surface {
        Surface::Plane(_) | Surface::Cylinder(_) | Surface::Cone(_) => {
            boundary_sum(brep, face, &d, &|_| Vec::new())
        }
        Surface::Sphere(s) => {
            let sum = boundary_sum(brep, face, &d, &|_| Vec::new());
            let whole = d.between(base, N::PI / N::TWO);
            let opposite = s.frame.point(N::ZERO, N::ZERO, s.radius);
            if holds_far(brep, face, amid, sum[0] / whole[0], &opposite) {
                add(sum, whole)
            } else {
                sum
            }
        }
        Surface::Torus(t) => torus_moments(brep, face, &coedges, t, &d),
    }
}

/// Whether edges may pass through a point.
fn reaches<N: Number>(brep: &Brep<N>, coedges: &[CoedgeId], p: &Point3<N>) -> bool {
    coedges.iter().any(|&c| {
        let e = brep.topology.coedge(c).edge;
        let around = bounds::bounds(brep.curve(e), brep.range(e));
        around.grown(around.diagonal()).holds(p)
    })
}

/// A v amid the edges of a face, where a torus or a sphere is cut open at `base`.
fn amid_edges<N: Number>(brep: &Brep<N>, surface: &Surface<N>, base: N, coedges: &[CoedgeId]) -> N {
    let middle = |&c: &CoedgeId| {
        let e = brep.topology.coedge(c).edge;
        let [lo, hi] = brep.range(e);
        let [_, v] = surface.parameters(&brep.curve(e).point(N::HALF * (lo + hi)));
        match surface {
            Surface::Torus(_) => base + (v - base).rem_euclid(N::TAU),
            _ => v,
        }
    };
    match coedges.len() {
        0 => base,
        n => coedges.iter().map(middle).sum::<N>() / N::of(n as f64),
    }
}

/// Whether a face of a closed surface holds what is farthest from the base, where no edge comes: of
/// the face's part of the whole surface all or nothing is missing, so its sign tells, unless next to
/// nothing is left.
fn holds_far<N: Number>(
    brep: &Brep<N>,
    face: FaceId,
    amid: &Amid<N>,
    part: N,
    far: &Point3<N>,
) -> bool {
    if brep.topology.face(face).loops.is_empty() {
        return true;
    }
    if part.abs().is_beyond(N::of(FEW) * amid.part()) {
        return part.is_below_zero();
    }
    let locator = FaceLocator::of(brep, face, amid.size * N::of(BAND) * N::ROUNDING);
    locator.place(far) != Place::Outside
}

/// Of areas below this part of the whole surface, in terms of rounding, the sign may be rounding.
const FEW: f64 = 256.0;
/// How far edges are off, in terms of the part's size and of rounding.
const BAND: f64 = 4096.0;
/// The angle about the tube at which a torus is cut open.
const BASE: f64 = 2.0;

fn add<N: Number>(a: Moments<N>, b: Moments<N>) -> Moments<N> {
    std::array::from_fn(|i| a[i] + b[i])
}

/// −∮ G du over the boundary of a face, each edge broken where `marks` says, and G counted from the
/// base.
fn boundary_sum<N: Number>(
    brep: &Brep<N>,
    face: FaceId,
    density: &Density<'_, N>,
    marks: &dyn Fn(CoedgeId) -> Vec<N>,
) -> Moments<N> {
    let loops = brep.topology.face(face).loops.iter();
    let rings = loops.map(|&l| &brep.topology.ring(l).coedges);
    let side = brep.sense(face).sign::<N>();
    let sums = rings.map(|ring| loop_sum(brep, ring, density, marks).map(|m| -side * m));
    sums.fold([N::ZERO; 5], add)
}

/// ∮ G du over a loop, G counted from the base: what lies between that and where it starts counts as
/// often as the loop goes round.
fn loop_sum<N: Number>(
    brep: &Brep<N>,
    coedges: &[CoedgeId],
    density: &Density<'_, N>,
    marks: &dyn Fn(CoedgeId) -> Vec<N>,
) -> Moments<N> {
    let [a, v, x, y, z] = density.floor;
    let floor = [a, v, x, y, z, density.amid.part()];
    let start = density.start(brep, coedges);
    let mut total = [N::ZERO; 6];
    for &c in coedges {
        let coedge = brep.topology.coedge(c);
        let curve = brep.curve(coedge.edge);
        let rough = density
            .doubles
            .as_ref()
            .map(|ground| (ground, curve.in_doubles()));
        let [lo, hi] = brep.range(coedge.edge);
        let mut breaks = curve.breaks(lo, hi);
        breaks.extend(marks(c));
        breaks.sort_by(N::total_cmp);
        let sign = coedge.sense.sign::<N>();
        // What does not matter is shared by the pieces; to doubles it is their rounding.
        let floor = match N::IS_DOUBLE {
            true => floor,
            false => floor.map(|f| f / N::of(breaks.len() as f64)),
        };
        for pair in breaks.windows(2) {
            // The middle tells on which side of a cut the piece lies.
            let middle = curve.point(N::HALF * (pair[0] + pair[1]));
            let [_, near] = density.ground.surface.parameters(&middle);
            let on_edge = OnEdge {
                ground: &density.ground,
                curve,
                from: [start, near],
                doubles: rough.as_ref().map(|(ground, curve)| (*ground, curve)),
            };
            let part = adaptive(pair[0], pair[1], &floor, &on_edge);
            for (s, v) in total.iter_mut().zip(part) {
                *s += sign * v;
            }
        }
    }
    let [a, v, x, y, z, way] = total;
    let sum = [a, v, x, y, z];
    let turns = (way / N::TAU).round();
    if turns.is_exactly(N::ZERO) || matches!(density.ground.surface, Surface::Plane(_)) {
        return sum;
    }
    add(
        sum,
        density
            .between(density.ground.base, start)
            .map(|k| k * turns),
    )
}

/// A frame of a sphere whose poles keep clear of the edges.
fn clear_axis<N: Number>(brep: &Brep<N>, s: &Sphere<N>, coedges: &[CoedgeId]) -> Frame<N> {
    let o = s.frame.origin;
    let mut best = (-N::ONE, s.frame);
    for k in 0..12 {
        let (z, a) = (
            N::ONE - (N::TWO * N::whole(k) + N::ONE) / N::of(24.0),
            N::of(2.4) * N::whole(k) + N::of(0.3),
        );
        let across = (N::ONE - z * z).sqrt();
        let axis = Vector3::new(across * a.cos(), across * a.sin(), z);
        let mut clear: N = N::ONE;
        for &c in coedges {
            let e = brep.topology.coedge(c).edge;
            let [lo, hi] = brep.range(e);
            for i in 0..=16 {
                let p = brep
                    .curve(e)
                    .point(lo + (hi - lo) * N::whole(i) / N::of(16.0));
                let d = (p - o).unit();
                clear = clear.min(d.cross(&axis).length());
            }
        }
        if clear.is_beyond(best.0) {
            best = (clear, Frame::about(o, axis));
        }
    }
    best.1
}

/// A torus is cut open along the parallel v = BASE: what of it lies in the face is part of the
/// boundary of the opened face.
fn torus_moments<N: Number>(
    brep: &Brep<N>,
    face: FaceId,
    coedges: &[CoedgeId],
    t: &Torus<N>,
    d: &Density<'_, N>,
) -> Moments<N> {
    let side = brep.sense(face).sign::<N>();
    let height = t.minor * N::of(BASE).sin();
    let frame = t.frame.at(t.frame.origin + t.frame.z * height);
    let plane = Plane { frame };
    // (u, whether the face lies behind it, towards smaller u).
    let mut passes: Vec<(N, bool)> = Vec::new();
    let roots_of = |c: CoedgeId| {
        let coedge = brep.topology.coedge(c);
        let curve = brep.curve(coedge.edge);
        let mut roots = Vec::new();
        plane_roots(
            curve,
            brep.range(coedge.edge),
            &plane,
            N::ZERO,
            &mut |s, _| {
                let q = t.frame.coordinates(&curve.point(s));
                let outward = (q.x.hypot(q.y) - t.major) * N::of(BASE).cos();
                if outward.is_above_zero() {
                    roots.push(s);
                }
            },
        );
        roots
    };
    for &c in coedges {
        let coedge = brep.topology.coedge(c);
        let curve = brep.curve(coedge.edge);
        for s in roots_of(c) {
            let [u, _] = d.ground.surface.parameters(&curve.point(s));
            let rise = curve.derivative(s).dot(&t.frame.z) * N::of(BASE).cos();
            let up = rise * side * coedge.sense.sign::<N>();
            passes.push((u, up.is_above_zero()));
        }
    }
    let mut sum = boundary_sum(brep, face, d, &roots_of);
    passes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let top = N::of(BASE) + N::TAU;
    for (i, &(u, up)) in passes.iter().enumerate() {
        if !up {
            let (mut end, _) = passes[(i + 1) % passes.len()];
            if end.is_at_most(u) {
                end += N::TAU;
            }
            sum = add(sum, d.over([u, end], [N::of(BASE), top]));
        }
    }
    let whole = d.between(N::of(BASE), top);
    let far = t
        .frame
        .point(t.major + t.minor * N::of(BASE).cos(), N::ZERO, height);
    if passes.is_empty() && holds_far(brep, face, d.amid, sum[0] / whole[0], &far) {
        add(sum, whole)
    } else {
        sum
    }
}
