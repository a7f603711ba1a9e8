//! dbg
use nalgebra::{Point3, Vector3};
use premio_kernel::geometry::frame::Frame;
use premio_kernel::geometry::intersect::{Extent, meet};
use premio_kernel::geometry::surface::{Surface, Torus};
use premio_kernel::number::sign::Judge;
#[test]
fn dbg() {
    let t = |o: Point3<f64>, x, y, z, a, b| {
        Surface::Torus(Torus {
            frame: Frame { origin: o, x, y, z },
            major: a,
            minor: b,
        })
    };
    let (x, y, z) = (Vector3::x(), Vector3::y(), Vector3::z());
    for (n, a, b, r) in [
        (
            "10603",
            t(Point3::origin(), x, y, z, 100.0, 20.0),
            t(Point3::origin(), x, z, -y, 100.0, 20.0),
            200.0,
        ),
        (
            "29910",
            t(Point3::origin(), x, y, z, 100.0, 10.0),
            t(Point3::new(100.0, 0.0, 0.0), x, y, z, 100.0, 10.0),
            200.0,
        ),
        (
            "cross",
            t(Point3::origin(), x, y, z, 3.0, 1.0),
            t(Point3::new(1e-7, 0.0, 0.0), x, z, -y, 3.0, 1.0),
            8.0,
        ),
        (
            "copl",
            t(Point3::origin(), x, y, z, 3.0, 1.0),
            t(Point3::new(7.99999, 0.0, 0.0), x, y, z, 3.0, 1.0),
            8.0,
        ),
    ] {
        let t0 = std::time::Instant::now();
        let m = meet(
            &a,
            &b,
            &Extent {
                centre: Point3::origin(),
                radius: r,
            },
            &Judge::new(1e-11 * r),
        );
        match m {
            Ok(m) => println!(
                "{n}: {} branches {:?} nodes {:?} {:?}",
                m.branches.len(),
                m.branches.iter().map(|b| b.range[1]).collect::<Vec<_>>(),
                m.nodes.len(),
                t0.elapsed()
            ),
            Err(e) => println!("{n}: {e} {:?}", t0.elapsed()),
        }
    }
}
