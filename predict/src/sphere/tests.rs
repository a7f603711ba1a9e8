use super::*;
use std::f64::consts::PI;

fn cone(axis: [f64; 3], half_angle: f64) -> ViewCone {
    ViewCone { axis, half_angle }
}

fn fibonacci(n: usize, cones: &[ViewCone]) -> Vec<Vector3<f64>> {
    points(Lattice::Fibonacci, SphereSampling::Count(n), cones).unwrap()
}

fn icosahedral(sampling: SphereSampling, cones: &[ViewCone]) -> Vec<Vector3<f64>> {
    points(Lattice::Icosahedral, sampling, cones).unwrap()
}

/// The angle from each point to the nearest other one.
fn nearest(all: &[Vector3<f64>]) -> Vec<f64> {
    let to = |i: usize| {
        let others = all.iter().enumerate().filter(move |&(j, _)| j != i);
        others.map(move |(_, q)| 2.0 * (0.5 * (all[i] - q).norm()).asin())
    };
    (0..all.len())
        .map(|i| to(i).fold(f64::INFINITY, f64::min))
        .collect()
}

fn inside(p: &Vector3<f64>, cone: &ViewCone) -> bool {
    p.angle(&Vector3::from(cone.axis)) <= cone.half_angle.to_radians() + 1e-7
}

#[test]
fn fibonacci_lattices_have_the_count_and_are_even() {
    for n in [1, 2, 3, 17, 200, 1000] {
        let all = fibonacci(n, &[]);
        assert_eq!(all.len(), n);
        assert_eq!(all, fibonacci(n, &[]));
        assert!(all.iter().all(|p| (p.norm() - 1.0).abs() < 1e-15));
    }
    let all = fibonacci(1000, &[]);
    // The octants of a rotated frame: the points are far more even than by chance, where χ² of 7
    // degrees of freedom is 7.
    let axes = [
        Vector3::new(1.0, 2.0, 2.0),
        Vector3::new(2.0, 1.0, -2.0),
        Vector3::new(2.0, -2.0, 1.0),
    ];
    let mut counts = [0_usize; 8];
    for p in &all {
        let octant: usize = (0..3)
            .map(|i| usize::from(p.dot(&axes[i]) > 0.0) << i)
            .sum();
        counts[octant] += 1;
    }
    let chi2: f64 = counts
        .iter()
        .map(|&c| (c as f64 - 125.0).powi(2) / 125.0)
        .sum();
    assert!(chi2 < 1.0, "{counts:?}");
    // A point's area is 4π/n; the centres of hexagons of this area are 1.07 times its root apart.
    let side = (4.0 * PI / 1000.0).sqrt();
    for spacing in nearest(&all) {
        assert!(
            (0.8..1.07).contains(&(spacing / side)),
            "{}",
            spacing / side
        );
    }
}

#[test]
fn fibonacci_caps_are_even_too() {
    for half_angle in [0.001, 1.0, 30.0, 90.0, 150.0, 180.0] {
        let one = cone([1.0, -2.0, 0.5], half_angle);
        let all = fibonacci(300, &[one]);
        assert_eq!(all.len(), 300);
        assert!(all.iter().all(|p| inside(p, &one)));
        let area = 4.0 * PI * (half_angle.to_radians() / 2.0).sin().powi(2);
        let side = (area / 300.0).sqrt();
        for spacing in nearest(&all) {
            let of = spacing / side;
            assert!((0.6..1.2).contains(&of), "{half_angle}: {of}");
        }
    }
}

#[test]
fn unions_of_cones_have_the_count() {
    let cones = [
        cone([0.0, 0.0, 1.0], 40.0),
        cone([0.5, 0.0, 1.0], 50.0),
        cone([0.0, -1.0, 0.0], 10.0),
        cone([0.0, 0.0, 1.0], 40.0),
    ];
    for n in [1, 2, 10, 333, 1000] {
        let all = fibonacci(n, &cones);
        assert_eq!(all.len(), n);
        assert!(all.iter().all(|p| cones.iter().any(|c| inside(p, c))));
        if n > 300 {
            assert!(cones.iter().all(|c| all.iter().any(|p| inside(p, c))));
        }
    }
    let twice = fibonacci(100, &[cones[0], cones[0]]);
    assert_eq!(twice, fibonacci(100, &[cones[0]]));
}

#[test]
fn fibonacci_angles_are_the_distance_to_neighbours() {
    for degrees in [2.0, 5.0, 10.0_f64] {
        let all = points(Lattice::Fibonacci, SphereSampling::Angle(degrees), &[]).unwrap();
        let spacings = nearest(&all);
        let mean = spacings.iter().sum::<f64>() / spacings.len() as f64;
        assert!(
            (0.8..1.0).contains(&(mean.to_degrees() / degrees)),
            "{mean}"
        );
    }
    let narrow = [cone([0.0, 1.0, 0.0], 0.1)];
    let one = points(Lattice::Fibonacci, SphereSampling::Angle(90.0), &narrow).unwrap();
    assert_eq!(one.len(), 1);
}

#[test]
fn icosahedral_lattices_are_the_smallest() {
    for (wished, found) in [
        (1, 12),
        (12, 12),
        (13, 42),
        (162, 162),
        (163, 252),
        (1000, 1002),
    ] {
        assert_eq!(icosahedral(SphereSampling::Count(wished), &[]).len(), found);
    }
    for degrees in [63.44, 40.0, 10.0, 4.0] {
        let all = icosahedral(SphereSampling::Angle(degrees), &[]);
        let f = (((all.len() - 2) / 10) as f64).sqrt().round();
        assert!(nearest(&all).iter().all(|a| a.to_degrees() <= degrees));
        let finer = icosahedral(SphereSampling::Angle(degrees * 0.99 * f / (f + 1.0)), &[]);
        assert!(finer.len() > all.len());
    }
    assert_eq!(icosahedral(SphereSampling::Angle(180.0), &[]).len(), 12);
}

#[test]
fn icosahedral_lattices_keep_to_cones() {
    let cones = [cone([1.0, 0.0, 0.0], 25.0), cone([0.3, 1.0, -1.0], 12.0)];
    let by_trying = |count: usize| {
        (1..200)
            .map(|f| icosahedral(SphereSampling::Count(10 * f * f + 2), &[]))
            .map(|all| {
                all.into_iter()
                    .filter(|p| cones.iter().any(|c| inside(p, c)))
                    .collect::<Vec<_>>()
            })
            .find(|all| all.len() >= count)
            .unwrap()
    };
    for count in [1, 5, 40, 300] {
        let all = icosahedral(SphereSampling::Count(count), &cones);
        assert!(all.len() >= count);
        assert_eq!(all, by_trying(count), "{count}");
    }
}

#[test]
fn invalid_requests_are_reported() {
    let ask = |lattice, sampling, cones: &[ViewCone]| points(lattice, sampling, cones).unwrap_err();
    for lattice in [Lattice::Fibonacci, Lattice::Icosahedral] {
        assert_eq!(
            ask(lattice, SphereSampling::Count(0), &[]),
            SphereError::NoCount
        );
        assert_eq!(
            ask(lattice, SphereSampling::Count(usize::MAX), &[]),
            SphereError::TooMany
        );
        assert_eq!(
            ask(lattice, SphereSampling::Angle(1e-300), &[]),
            SphereError::TooMany
        );
        for angle in [0.0, -1.0, 180.5, f64::NAN] {
            assert!(matches!(
                ask(lattice, SphereSampling::Angle(angle), &[]),
                SphereError::Angle(_)
            ));
            let wrong = [cone([1.0; 3], 20.0), cone([1.0; 3], angle)];
            let error = ask(lattice, SphereSampling::Count(5), &wrong);
            assert!(matches!(error, SphereError::HalfAngle { cone: 1, .. }));
        }
        for axis in [[0.0; 3], [f64::NAN, 0.0, 1.0], [f64::INFINITY, 0.0, 0.0]] {
            let error = ask(lattice, SphereSampling::Count(5), &[cone(axis, 20.0)]);
            assert_eq!(error, SphereError::Axis(0));
        }
        for axis in [[1e-300, 0.0, 0.0], [1e300, 1e300, 0.0], [5e-324, 0.0, 0.0]] {
            assert!(points(lattice, SphereSampling::Count(5), &[cone(axis, 20.0)]).is_ok());
        }
    }
    let between = [cone([1.0, 1.0, 1.0], 0.01)];
    let coarse = ask(Lattice::Icosahedral, SphereSampling::Angle(60.0), &between);
    assert_eq!(coarse, SphereError::Empty);
}

#[test]
fn wishes_are_read() {
    let read = |text: &str| serde_json::from_str::<SphereSampling>(text).unwrap();
    assert_eq!(read(r#"{"count": 12}"#), SphereSampling::Count(12));
    assert_eq!(read(r#"{"angle": 7.5}"#), SphereSampling::Angle(7.5));
    let lattice: Lattice = serde_json::from_str("\"icosahedral\"").unwrap();
    assert_eq!(lattice, Lattice::Icosahedral);
    let wrong = r#"{"axis": [0, 0, 1], "half_angle": 3, "colour": 1}"#;
    assert!(serde_json::from_str::<ViewCone>(wrong).is_err());
}
