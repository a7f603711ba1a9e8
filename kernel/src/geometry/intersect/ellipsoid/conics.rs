//! Members of the pencil that consist of two planes, so that the intersection consists of conics.

use super::super::plane::plane_sphere;
use super::super::{SurfaceIntersection, place};
use super::{Member, Pencil, SAMPLES, plane_ellipsoid, sample};
use crate::geometry::frame::Frame;
use crate::geometry::surface::{Plane, Surface};
use crate::geometry::surface_pair::{Carrier, SurfacePair};
use crate::geometry::vector::Length;
use crate::number::float::Float;
use crate::number::predicates::Predicates;
use nalgebra::{Point3, Vector3};

/// Planes of a degenerate member.
struct PlanePair<N: Float> {
    planes: Vec<Plane<N>>,
    /// Whether both are one plane, so that the surfaces are tangent along its conic.
    is_double: bool,
    /// Whether the ellipsoids are coaxial, so that a plane may touch the first one and the point is all
    /// of its conic.
    may_touch: bool,
    /// The points in which the conics cross.
    crossings: Vec<Point3<N>>,
}

impl<N: Float> Pencil<N> {
    /// The intersection, where it consists of conics.
    pub(super) fn conics(
        &self,
        pair: &SurfacePair<'_, N>,
        predicates: &Predicates,
    ) -> Option<SurfaceIntersection<N>> {
        let mut pairs = vec![self.radical_plane(), self.crossing_planes()];
        for (i, others) in [(2, [0, 1]), (0, [1, 2])] {
            pairs.extend(self.parallel_planes(i, others));
        }
        let found = pairs.into_iter().find_map(|planes| {
            let conics = self.sections(&planes, pair, predicates)?;
            Some((planes, conics))
        });
        let (planes, mut meeting) = found?;
        for p in planes.crossings {
            if predicates.within(pair.b.surface.distance(&p)) {
                meeting.cross_at(p, predicates);
            }
        }
        Some(meeting)
    }

    /// The conics in which the planes cut the first surface, if they lie on the second.
    fn sections(
        &self,
        pair_of_planes: &PlanePair<N>,
        pair: &SurfacePair<'_, N>,
        predicates: &Predicates,
    ) -> Option<SurfaceIntersection<N>> {
        let mut meeting = SurfaceIntersection::nothing();
        for plane in &pair_of_planes.planes {
            let section = Surface::Plane(*plane);
            let both = SurfacePair::new(Carrier::constructed(&section), pair.a, pair.extent);
            let conic = match pair.a.surface {
                Surface::Sphere(s) => plane_sphere(plane, s, &both, predicates),
                _ => plane_ellipsoid(plane, &self.first, &both, predicates),
            };
            meeting.branches.extend(conic.branches);
            if pair_of_planes.may_touch {
                meeting.nodes.extend(conic.nodes);
            }
        }
        let off = |p: &Point3<N>| pair.b.surface.distance(p).abs();
        let mut worst = meeting.nodes.iter().map(|n| off(&n.point)).reduce(N::max);
        for branch in &mut meeting.branches {
            branch.tangent = pair_of_planes.is_double;
            for i in 0..SAMPLES {
                let p = branch.curve.point(sample(branch, i));
                let off = match branch.tangent {
                    true => off(&p),
                    false => self.distance_to_curve(pair, &p),
                };
                worst = Some(worst.map_or(off, |worst: N| worst.max(off)));
            }
        }
        let at = place(&self.first.frame.origin);
        let is_held = predicates.coincide("ellipsoids meeting in conics", worst?, at);
        is_held.then_some(meeting)
    }

    /// The plane n·y = level.
    fn plane(&self, normal: [N; 3], level: N) -> Plane<N> {
        let n: Vector3<N> = (0..3).map(|i| self.axes[i] * normal[i]).sum();
        let size = n.length_squared();
        let along: [N; 3] = std::array::from_fn(|i| normal[i] * level / size);
        // Normals map by the inverse of the transpose.
        let frame = &self.first.frame;
        let normal = frame.vector(&self.first.on_unit_sphere(&n)).unit();
        Plane {
            frame: Frame::about(self.point(along), normal),
        }
    }

    /// The plane of all common points of similar ellipsoids, for which all m are equal.
    fn radical_plane(&self) -> PlanePair<N> {
        let [m, d] = [self.forms, self.centre];
        let square: N = (0..3).map(|i| m[i] * d[i] * d[i]).sum();
        let level = N::HALF * (square - N::ONE + m[1]);
        let normal = std::array::from_fn(|i| m[i] * d[i]);
        let is_none = normal.iter().all(|n| *n == N::ZERO);
        PlanePair {
            planes: (!is_none)
                .then(|| self.plane(normal, level))
                .into_iter()
                .collect(),
            is_double: false,
            may_touch: false,
            crossings: Vec::new(),
        }
    }

    /// The planes q₁ (y₁ - t₁)² + q₃ (y₃ - t₃)² = 0 of λ = m₂.
    fn crossing_planes(&self) -> PlanePair<N> {
        let mut member = self.member([1, 2], N::ZERO);
        member.excess[0] = self.forms[0] - self.forms[1];
        let [s, t] = [0, 2].map(|i| self.apex(&member, i));
        let [across, along] = [0, 2].map(|i| member.excess[i].abs().sqrt());
        let planes = match across > N::ZERO && along > N::ZERO {
            true => [N::ONE, -N::ONE]
                .map(|side| {
                    let normal = [across, N::ZERO, side * along];
                    self.plane(normal, across * s + side * along * t)
                })
                .into(),
            false => Vec::new(),
        };
        let square = N::ONE - s * s - t * t;
        let crossings = match square > N::ZERO {
            true => [N::ONE, -N::ONE]
                .map(|side| self.point([s, side * square.sqrt(), t]))
                .into(),
            false => Vec::new(),
        };
        PlanePair {
            planes,
            is_double: false,
            may_touch: false,
            crossings,
        }
    }

    /// The planes q_i (y_i - t_i)² = -f of coaxial ellipsoids of revolution about e_i, for which the
    /// other two m are equal: both as one, and each.
    fn parallel_planes(&self, i: usize, [j, k]: [usize; 2]) -> Vec<PlanePair<N>> {
        let level = N::HALF * (self.forms[j] + self.forms[k]);
        let member = Member {
            level,
            excess: self.forms.map(|m| m - level),
        };
        let (q, t) = (member.excess[i], self.apex(&member, i));
        if q == N::ZERO {
            return Vec::new();
        }
        let mut normal = [N::ZERO; 3];
        normal[i] = N::ONE;
        let none = || PlanePair {
            planes: Vec::new(),
            is_double: false,
            may_touch: self.is_double(j, k) && [j, k].iter().all(|&i| self.centre[i] == N::ZERO),
            crossings: Vec::new(),
        };
        let both = PlanePair {
            planes: vec![self.plane(normal, t)],
            is_double: true,
            ..none()
        };
        let rest = (level - N::ONE) - level * (t * self.centre[i]);
        let half = (-rest / q).sqrt();
        let each = match half > N::ZERO {
            true => PlanePair {
                planes: [t - half, t + half].map(|at| self.plane(normal, at)).into(),
                ..none()
            },
            false => none(),
        };
        vec![both, each]
    }
}
