//! Views of a torus against the torus's own equations. Every limb of the closed form is present, no
//! piece passes a cusp, and the invisibility of every piece agrees with the roots of the quartic on
//! its line of sight.
#![allow(clippy::print_stdout, reason = "tests")]

use nalgebra::{Point3, Vector3};
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_kernel::random::Random as Bits;
use premio_visibility::camera::projection::{Projection, ViewRay};
use premio_visibility::contours::contours_with;
use premio_visibility::contours::{ContourKind, Contours, JunctionKind};
use premio_visibility::invisibility::Method;
use premio_visibility::{ViewCamera, contours};
use std::f64::consts::TAU;

/// A torus about the z axis.
#[derive(Clone, Copy)]
struct Torus {
    major: f64,
    minor: f64,
}

/// The number of samples of a piece.
const SAMPLES: usize = 5;

fn torus(t: Torus) -> Evaluation {
    part(&format!(
        r#"{{"prim":"torus","R":{},"r":{}}}"#,
        t.major, t.minor
    ))
}

fn part(json: &str) -> Evaluation {
    let tree = read(
        "part",
        json.as_bytes(),
        Format::Json,
        &ReadOptions::default(),
    )
    .unwrap();
    evaluate(&tree.tree, &EvaluationOptions::default()).unwrap()
}

struct Random(Bits);

impl Random {
    fn unit(&mut self) -> f64 {
        self.0.uniform()
    }

    fn direction(&mut self) -> Vector3<f64> {
        let z = 2.0 * self.unit() - 1.0;
        let (sin, cos) = (TAU * self.unit()).sin_cos();
        let rho = (1.0 - z * z).sqrt();
        Vector3::new(rho * cos, rho * sin, z)
    }
}

impl Torus {
    fn value(&self, p: &Point3<f64>) -> f64 {
        (p.x.hypot(p.y) - self.major).hypot(p.z) - self.minor
    }

    fn normal(&self, p: &Point3<f64>) -> Vector3<f64> {
        let k = 1.0 - self.major / p.x.hypot(p.y);
        Vector3::new(k * p.x, k * p.y, p.z).normalize()
    }

    fn point(&self, theta: f64, phi: f64) -> Point3<f64> {
        let rho = self.major + self.minor * phi.cos();
        Point3::new(rho * theta.cos(), rho * theta.sin(), self.minor * phi.sin())
    }

    /// The intervals in which the line p + s v is in the torus, for s in `range`.
    fn inside(&self, p: &Point3<f64>, v: &Vector3<f64>, range: [f64; 2]) -> Vec<[f64; 2]> {
        // About the point closest to the centre, with lengths in units of the reach.
        let middle = -p.coords.dot(v);
        let unit = self.major + self.minor;
        let q = (p.coords + v * middle) / unit;
        let (major, minor) = (self.major / unit, self.minor / unit);
        let c = q.norm_squared() + major * major - minor * minor;
        let b = 2.0 * q.dot(v);
        let k = 4.0 * major * major;
        let quartic = [
            c * c - k * (q.x * q.x + q.y * q.y),
            2.0 * b * c - 2.0 * k * (q.x * v.x + q.y * v.y),
            b * b + 2.0 * c - k * (v.x * v.x + v.y * v.y),
            2.0 * b,
            1.0,
        ];
        let bounds = [-1.01, 1.01];
        let roots = real_roots(&quartic, bounds);
        let s = |u: f64| middle + u * unit;
        roots
            .chunks_exact(2)
            .map(|c| [s(c[0]), s(c[1])])
            .filter(|c| c[1] > range[0] && c[0] < range[1])
            .collect()
    }
}

/// The sign changes of a polynomial, between those of its derivative, by bisection alone.
fn real_roots(k: &[f64], [lo, hi]: [f64; 2]) -> Vec<f64> {
    if k.len() < 2 {
        return Vec::new();
    }
    let derivative: Vec<f64> = (1..k.len()).map(|i| k[i] * i as f64).collect();
    let mut stops = vec![lo];
    stops.extend(real_roots(&derivative, [lo, hi]));
    stops.push(hi);
    let value = |x: f64| k.iter().rev().fold(0.0, |v, c| v * x + c);
    let mut roots = Vec::new();
    for pair in stops.windows(2) {
        let [mut a, mut b] = [pair[0], pair[1]];
        if (value(a) < 0.0) == (value(b) < 0.0) {
            continue;
        }
        let low = value(a) < 0.0;
        for _ in 0..80 {
            let m = 0.5 * (a + b);
            if (value(m) < 0.0) == low {
                a = m;
            } else {
                b = m;
            }
        }
        roots.push(0.5 * (a + b));
    }
    roots
}

/// The number of intervals of the torus in front of a point of a limb; `None` if it changes close
/// to the point.
fn invisibility(t: &Torus, projection: &Projection, p: &Point3<f64>) -> Option<u32> {
    let lateral = 1e-7 * (t.major + t.minor);
    let depth = 4.0 * (lateral * (t.major + t.minor)).sqrt();
    let v = projection.towards_eye(p).direction;
    let n = t.normal(p);
    let across = n.cross(&v);
    let count = |offset: Vector3<f64>| {
        let q = p + offset * lateral;
        let eye = projection.towards_eye(&q);
        let within = t.inside(&q, &eye.direction, [depth, eye.distance]);
        within.iter().filter(|i| i[1] < eye.distance).count() as u32
    };
    let all: Vec<u32> = [n, n + across, n - across, -n, across - n, -n - across]
        .iter()
        .map(|o| count(*o))
        .collect();
    // The point's own fold adds nothing beyond the depth, unless it is concave.
    all.iter().all(|c| *c == all[0]).then_some(all[0])
}

/// The limb's points by the closed form: two angles about the tube for each angle about the axis.
fn limb_points(t: &Torus, sight: &ViewRay) -> Vec<Point3<f64>> {
    let mut found = Vec::new();
    for k in 0..360 {
        let theta = TAU * (f64::from(k) + 0.37) / 360.0;
        let (sin, cos) = theta.sin_cos();
        let (a, b, c) = match sight {
            ViewRay::Eye(e) => (t.major - e.x * cos - e.y * sin, -e.z, t.minor),
            ViewRay::Direction(d) => (-d.x * cos - d.y * sin, -d.z, 0.0),
        };
        let size = a.hypot(b);
        if c.abs() < size {
            let (middle, half) = (b.atan2(a), (-c / size).acos());
            found.push(t.point(theta, middle + half));
            found.push(t.point(theta, middle - half));
        }
    }
    found
}

#[derive(Debug, Default)]
struct Tally {
    agreed: usize,
    ambiguous: usize,
    cusps: usize,
    wrong: Vec<String>,
}

impl Tally {
    fn view(&mut self, name: &str, t: &Torus, part: &Evaluation, camera: &ViewCamera) {
        let size = 2.0 * (t.major + t.minor);
        let projection = Projection::new(camera, size);
        let seen = match contours(&part.brep, camera, part.resolution) {
            Ok(seen) => seen,
            Err(error) => return self.wrong.push(format!("{name}: {error}")),
        };
        let again = contours_with(&part.brep, camera, part.resolution, Method::Recounted).unwrap();
        for (a, b) in seen.contours.iter().zip(&again.contours) {
            let quantitative_invisibility = |c: &premio_visibility::contours::Contour| {
                c.pieces
                    .iter()
                    .map(|p| p.quantitative_invisibility)
                    .collect::<Vec<_>>()
            };
            if quantitative_invisibility(a) != quantitative_invisibility(b) {
                let text = format!(
                    "{name}: carried {:?}, counted {:?}",
                    quantitative_invisibility(a),
                    quantitative_invisibility(b)
                );
                self.wrong.push(text);
            }
        }
        let found = self.pieces(name, t, &projection, &seen);
        self.wrong.extend(found);
        for p in limb_points(t, &projection.sight) {
            let on = seen.contours.iter().any(|c| {
                let s = c.space_curve.parameter(&p);
                let near = (c.space_curve.point(s) - p).norm() < 1e-7 * size;
                let period = c.space_curve.period().unwrap_or(f64::INFINITY);
                near && c.pieces.iter().any(|piece| {
                    let s = piece.range[0] + (s - piece.range[0]).rem_euclid(period);
                    s <= piece.range[1] || s - period > piece.range[0] - 1e-6
                })
            });
            if !on {
                self.wrong.push(format!("{name}: no limb through {p}"));
            }
        }
    }

    fn pieces(
        &mut self,
        name: &str,
        t: &Torus,
        projection: &Projection,
        seen: &Contours,
    ) -> Vec<String> {
        let mut wrong = Vec::new();
        self.cusps += seen
            .junctions
            .iter()
            .filter(|j| j.kind == JunctionKind::Cusp)
            .count();
        for contour in &seen.contours {
            for piece in &contour.pieces {
                let [lo, hi] = piece.range;
                let at = |part: f64| contour.space_curve.point(lo + (hi - lo) * part);
                let mut bends = [false; 2];
                for k in 0..24 {
                    let p = at((f64::from(k) + 0.5) / 24.0);
                    let v = projection.towards_eye(&p).direction;
                    if t.value(&p).abs() > 1e-9 || t.normal(&p).dot(&v).abs() > 1e-7 {
                        wrong.push(format!("{name}: {p} is on no limb"));
                    }
                    // The side of the fold: how the torus leaves its tangent along the line of
                    // sight.
                    let (n, step) = (t.normal(&p), 1e-3 * t.minor);
                    let level = |s: f64| t.value(&(p + v * s));
                    let bend = level(step) + level(-step) - 2.0 * t.value(&p);
                    if bend.abs() > 1e-8 && n.norm() > 0.0 {
                        bends[usize::from(bend > 0.0)] = true;
                    }
                }
                if bends == [true; 2] {
                    wrong.push(format!("{name}: a cusp within {:?}", piece.range));
                }
                for k in 0..SAMPLES {
                    let p = at((k as f64 + 0.5) / SAMPLES as f64);
                    match invisibility(t, projection, &p) {
                        None => self.ambiguous += 1,
                        Some(quantitative_invisibility)
                            if quantitative_invisibility == piece.quantitative_invisibility =>
                        {
                            self.agreed += 1
                        }
                        Some(quantitative_invisibility) => wrong.push(format!(
                            "{name}: contour {} {:?}: {} for {quantitative_invisibility} at {p}",
                            contour.id, piece.range, piece.quantitative_invisibility
                        )),
                    }
                }
            }
        }
        wrong
    }
}

fn examine(t: Torus, seed: u64) {
    let part = torus(t);
    let mut random = Random(Bits::new(seed));
    let reach = t.major + t.minor;
    let mut tally = Tally::default();
    for k in 0..200 {
        let towards = random.direction();
        let eye = Point3::from(towards * (reach * (1.1 + 6.0 * random.unit())));
        let target = Point3::from(random.direction() * (0.3 * reach * random.unit()));
        let up = random.direction();
        let perspective = ViewCamera::perspective(eye, target, up, 1.0).unwrap();
        tally.view(
            &format!("perspective {k} from {eye}"),
            &t,
            &part,
            &perspective,
        );
        let orthographic = ViewCamera::orthographic(eye, Point3::origin(), up).unwrap();
        tally.view(
            &format!("orthographic {k} from {eye}"),
            &t,
            &part,
            &orthographic,
        );
    }
    println!(
        "{} agree, {} ambiguous, {} cusps, {} wrong",
        tally.agreed,
        tally.ambiguous,
        tally.cusps,
        tally.wrong.len()
    );
    let some = &tally.wrong[..tally.wrong.len().min(12)];
    assert!(
        some.is_empty(),
        "{} wrong:\n{}",
        tally.wrong.len(),
        some.join("\n")
    );
    assert!(tally.ambiguous * 20 < tally.agreed && tally.cusps > 100);
}

#[test]
fn a_thick_torus() {
    examine(
        Torus {
            major: 10.0,
            minor: 4.0,
        },
        1,
    );
}

#[test]
fn a_thin_torus() {
    examine(
        Torus {
            major: 10.0,
            minor: 2.0,
        },
        2,
    );
}

/// A torus of radii 1 and 1/2, seen perpendicular to its axis, minus a cylinder that reaches to 1 +
/// d along x. Of the tube's circle about (1, 0, 0) the arc beyond it remains, of pi - 2 asin(2 d).
/// The ends of this arc are close to its crossings with the torus's top and bottom circles, which
/// are limbs, too. For d below 1e-5 the product of the functions that vanish on the limbs is within
/// the resolution between them.
#[test]
fn limbs_are_cut_next_to_their_nodes() {
    let shifts = [1e-3, 1e-5, 1e-7, 1e-9];
    for d in shifts.into_iter().flat_map(|d: f64| [d, -d]) {
        let part = part(&format!(
            r#"{{"op":"difference","children":[{{"prim":"torus","R":1,"r":0.5}},
                {{"prim":"cylinder","r":0.4,"h":2,"transform":[{{"translate":[{},0,-1]}}]}}]}}"#,
            0.6 + d
        ));
        let eye = Point3::new(0.0, -10.0, 0.0);
        let camera = ViewCamera::orthographic(eye, Point3::origin(), Vector3::z()).unwrap();
        let seen = contours(&part.brep, &camera, part.resolution).unwrap();
        let of_tube = |c: &&premio_visibility::contours::Contour| {
            let [p, q] = [0.0, 1.0].map(|t| c.space_curve.point(t));
            c.kind == ContourKind::Limb
                && p.y.hypot(q.y) < 1e-12
                && p.x > 0.0
                && (p.x - q.x).abs() > 1e-6
        };
        let arcs = seen.contours.iter().filter(of_tube);
        let pieces: Vec<[f64; 2]> = arcs.flat_map(|c| &c.pieces).map(|p| p.range).collect();
        let length: f64 = pieces.iter().map(|t| t[1] - t[0]).sum();
        let expected = TAU / 2.0 - 2.0 * (2.0 * d).asin();
        assert!(
            (length - expected).abs() < 1e-8,
            "{d}: {length} for {expected}"
        );
    }
}

/// A ring of radii 3/4 and 1/4 about the x axis, and a block whose face x = 0 fills a quarter of
/// its hole. At (0, 1, 1)/√8 on the inner equator the curvatures along the tube and around the axis
/// are 4 and -2, so the line of sight (-1, 1, -1) is asymptotic there. The limb has a cusp exactly
/// where it ends on the edge, and no curvature determines which half of the edge is hidden.
#[test]
fn a_cusp_on_an_edge_is_no_fold() {
    let text = "PART = TOR(RMAJ=0.75, RMIN=0.25) AT (ROTY=90) UN BLO(X=0.5, Y=0.5, Z=0.5)";
    let tree = read(
        "part",
        text.as_bytes(),
        Format::Padl,
        &ReadOptions::default(),
    )
    .unwrap();
    let part = evaluate(&tree.tree, &EvaluationOptions::default()).unwrap();
    let centre = Point3::new(0.125, 0.0, 0.0);
    let eye = centre + Vector3::new(-1.0, 1.0, -1.0);
    let camera = ViewCamera::orthographic(eye, centre, Vector3::z()).unwrap();
    for method in [Method::Propagated, Method::Recounted] {
        let seen = contours_with(&part.brep, &camera, part.resolution, method).unwrap();
        // The edge on the equator, which the face and the tube bound. Both are visible at its half
        // towards (0, 0, 1/2), and nothing of the ring is on the line of sight.
        let on_equator = |p: &Point3<f64>| p.x.abs() < 1e-9 && (p.y.hypot(p.z) - 0.5).abs() < 1e-9;
        let mut pieces = seen.contours.iter().flat_map(|c| {
            let middle = |t: [f64; 2]| c.space_curve.point(0.5 * (t[0] + t[1]));
            c.pieces
                .iter()
                .map(move |p| (middle(p.range), p.quantitative_invisibility))
        });
        let upper = pieces.find(|(p, _)| on_equator(p) && p.z > p.y).unwrap();
        assert_eq!(upper.1, 0, "{method:?}: {upper:?}");
    }
}
