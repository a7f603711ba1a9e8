//! What passes through a point and along a curve, proven without rounding: for exact evaluation.
//!
//! Extended precision (237 bits) proposes the vertices and the carriers through each, the curves
//! and the carriers that contain them. Here each vertex becomes the exact zero of three
//! polynomials. Every other polynomial that should vanish there is proven to vanish: the implicit
//! forms of its carriers, and the determinants of gradients that seem to depend on one another. A
//! carrier contains a curve if it passes through more points of it than it could otherwise
//! (Bézout).

use super::arrangement::Arrangement;
use super::distinct_surfaces::Source;
use super::edge_candidates::EdgeCandidate;
use super::error::EvaluationError;
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::curve::Curve;
use premio_kernel::geometry::surface::Surface;
use premio_kernel::geometry::vector::{Length, rounded};
use premio_kernel::number::float::Float;
use premio_kernel::number::predicates::{Compare, Predicates};
use premio_kernel::number::rational::Rational;
use premio_kernel::proof::{AlgebraicPoint, Polynomial, ZeroTest, deflated};
use std::cell::OnceCell;

/// The polynomials of the carriers.
struct Forms<'a, N: Float> {
    carriers: &'a [Surface<N>],
    sources: &'a [Source<'a>],
    known: Vec<OnceCell<Polynomial>>,
}

impl<'a, N: Float> Forms<'a, N> {
    fn new(carriers: &'a [Surface<N>], sources: &'a [Source<'a>]) -> Self {
        let known = carriers.iter().map(|_| OnceCell::new()).collect();
        Self {
            carriers,
            sources,
            known,
        }
    }

    fn level(&self, carrier: usize) -> &Polynomial {
        let make = || Polynomial::new(&self.carriers[carrier], &self.sources[carrier].exact());
        self.known[carrier].get_or_init(make)
    }
}

/// Proves the incidences of an arrangement, and counts the proofs.
pub(super) fn prove<N: Float>(
    arrangement: &Arrangement<N>,
    pieces: &[EdgeCandidate<N>],
    sources: &[Source<'_>],
    predicates: &Predicates,
) -> Result<(), EvaluationError> {
    let forms = Forms::new(&arrangement.carriers, sources);
    for corner in &arrangement.corners {
        let (point, carriers) = (corner.point, &corner.carriers);
        let incidence = Incidence::new(&forms, carriers, &point, predicates);
        if !incidence.is_simple() {
            let reach = predicates.resolution::<N>() * N::from_f64(tangency::<N>());
            let near = Neighbourhood {
                place: &point,
                reach,
            };
            incidence.settle("point on surfaces", None, near, predicates)?;
        }
    }
    for piece in pieces {
        if piece.carriers.len() > 2 || !piece.tangent.is_empty() {
            let curve = &arrangement.meetings[piece.meeting].curve;
            Holding::new(&forms, curve, piece).settle(predicates)?;
        }
    }
    Ok(())
}

/// The neighbourhood of a place.
struct Neighbourhood<'a, N: Float = f64> {
    place: &'a Point3<N>,
    /// The radius.
    reach: N,
}

/// The polynomials that must vanish at a point close to a given place.
struct Incidence<'f> {
    /// The implicit forms of the carriers.
    levels: Vec<&'f Polynomial>,
    /// The determinants that express linear dependence of normals.
    dependences: Vec<Polynomial>,
}

impl<'f> Incidence<'f> {
    /// The incidences of carriers that seem to pass through a point. Where their normals seem
    /// linearly dependent, this is to be proven, too; and an apex must be one.
    fn new<N: Float>(
        forms: &'f Forms<'_, N>,
        carriers: &[usize],
        place: &Point3<N>,
        predicates: &Predicates,
    ) -> Self {
        let levels: Vec<&Polynomial> = carriers.iter().map(|&c| forms.level(c)).collect();
        let mut dependences = Vec::new();
        let mut normals: Vec<(usize, Vector3<N>)> = Vec::new();
        for (i, &c) in carriers.iter().enumerate() {
            let surface = &forms.carriers[c];
            let mut apexes = surface.apexes();
            match apexes.any(|apex| is_there(&(apex - place), predicates)) {
                true => dependences.extend(levels[i].gradient()),
                false => normals.push((i, surface.normal(place))),
            }
        }
        for (n, &(i, a)) in normals.iter().enumerate() {
            for (m, &(j, b)) in normals.iter().enumerate().skip(n + 1) {
                let across = a.cross(&b);
                if is_flat(across.length()) {
                    dependences.extend(levels[i].touching(levels[j]));
                    continue;
                }
                for &(k, c) in &normals[m + 1..] {
                    let parallel = [a, b].iter().any(|n| is_flat(n.cross(&c).length()));
                    if !parallel && is_flat(across.unit().dot(&c)) {
                        dependences.push(levels[i].dependence(levels[j], levels[k]));
                    }
                }
            }
        }
        dependences.retain(|p| p.degree() > 0);
        Self {
            levels,
            dependences,
        }
    }

    /// Whether it is a transversal intersection of three surfaces, which needs no proof.
    fn is_simple(&self) -> bool {
        self.levels.len() <= 3 && self.dependences.is_empty()
    }

    /// Proves all incidences at the point in a neighbourhood. With `cut`, the point is on that
    /// plane.
    fn settle<N: Float>(
        &self,
        question: &'static str,
        cut: Option<&Polynomial>,
        near: Neighbourhood<'_, N>,
        predicates: &Predicates,
    ) -> Result<(), EvaluationError> {
        let Neighbourhood { place, reach } = near;
        let vanishing = || self.levels.iter().copied().chain(&self.dependences);
        let mut defining: Vec<Polynomial> = vanishing().chain(cut).cloned().collect();
        let mut point = None;
        for _ in 0..DEFLATIONS {
            defining.sort_by_key(|p| (p.degree(), p.height()));
            let found = AlgebraicPoint::next_to(&defining, place);
            point = found.filter(|point| point.from(place).length().is_within(reach));
            if point.is_some() {
                break;
            }
            defining.extend(deflated(&defining, place));
        }
        let Some(mut point) = point else {
            predicates.count_assumed(vanishing().count() as u64);
            return Ok(());
        };
        for p in vanishing()
            .filter(|&p| !point.is_defined_by(p))
            .collect::<Vec<_>>()
        {
            match point.is_zero_of(p) {
                ZeroTest::Zero => predicates.count_proven(1),
                ZeroTest::Open => predicates.count_assumed(1),
                ZeroTest::Apart => {
                    let place = rounded(place);
                    return Err(EvaluationError::UnprovenCoincidence { question, place });
                }
            }
        }
        Ok(())
    }
}

/// The number of attempts to find a point; each adds polynomials by deflation.
const DEFLATIONS: usize = 3;

/// The precision of points of tangency, in multiples of the resolution.
fn tangency<N: Float>() -> f64 {
    N::TANGENCY / N::FINEST_RESOLUTION
}

/// Whether an angle is zero to the precision with which points of tangency are known.
fn is_flat<N: Float>(angle: N) -> bool {
    angle.is_within(N::from_f64(N::TANGENCY))
}

/// Whether a vector to a point is zero, to the same precision.
fn is_there<N: Float>(way: &Vector3<N>, predicates: &Predicates) -> bool {
    predicates.within(way.length() / N::from_f64(tangency::<N>()))
}

/// The carriers that must contain a piece of a curve.
struct Holding<'f, N: Float> {
    forms: &'f Forms<'f, N>,
    curve: &'f Curve<N>,
    piece: &'f EdgeCandidate<N>,
    /// The number of points: more than a curve can have in common with a surface that does not
    /// contain it.
    points: u32,
}

impl<'f, N: Float> Holding<'f, N> {
    fn new(forms: &'f Forms<'f, N>, curve: &'f Curve<N>, piece: &'f EdgeCandidate<N>) -> Self {
        let degrees = piece.carriers.iter().map(|&c| forms.level(c).degree());
        let mut degrees: Vec<u32> = degrees.collect();
        degrees.sort_unstable();
        // The curve is a component of the intersection of two carriers. If these are tangent, the
        // cross product of their gradients vanishes.
        let least: u32 = degrees.iter().take(2).product();
        let most = degrees.last().copied().unwrap_or(1);
        let most = match piece.tangent.is_empty() {
            true => most,
            false => most.max(2 * most - 2),
        };
        Self {
            forms,
            curve,
            piece,
            points: least * most + 1,
        }
    }

    fn settle(&self, predicates: &Predicates) -> Result<(), EvaluationError> {
        let [lo, hi] = self.piece.range;
        let curve = self.curve;
        let step = (hi - lo) / N::whole(self.points + 1);
        for k in 1..=self.points {
            // The points are not at even fractions, where a symmetric curve may be singular.
            let t = lo + step * (N::whole(k) + N::from_f64(POSITION));
            let place = curve.point(t);
            let next = curve.point(t + step);
            let incidence = Incidence::new(self.forms, &self.piece.carriers, &place, predicates);
            let way = (next - place).length();
            let Some(cut) = across(&place, &curve.tangent(t), way) else {
                predicates.count_assumed(incidence.levels.len() as u64);
                continue;
            };
            let near = Neighbourhood {
                place: &place,
                reach: N::HALF * way,
            };
            incidence.settle("curve on surfaces", Some(&cut), near, predicates)?;
        }
        Ok(())
    }
}

/// A plane across a curve, close to a point of it, with few digits. Its distance from the point is
/// a small fraction of `step`.
fn across<N: Float>(place: &Point3<N>, tangent: &Vector3<N>, step: N) -> Option<Polynomial> {
    let digits = N::from_f64(DIGITS) - N::from_f64(step.rounded().log2()).floor();
    let one = N::TWO.powi(digits.rounded() as i32);
    let rounded = |x: N, one: N| Some((x * one).round().exact()? / one.exact()?);
    let all = |v: &Vector3<N>, one: N| -> Option<[Rational; 3]> {
        Some([rounded(v.x, one)?, rounded(v.y, one)?, rounded(v.z, one)?])
    };
    let point = all(&place.coords, one)?;
    let direction = all(tangent, N::TWO.powi(DIGITS as i32))?;
    let plane = Polynomial::plane(&point, &direction);
    (plane.degree() == 1).then_some(plane)
}

/// The offset of a curve's sample points from even fractions.
const POSITION: f64 = -0.381_966;
/// The precision of a plane across a curve, in bits, relative to the distance between points.
const DIGITS: f64 = 8.0;
