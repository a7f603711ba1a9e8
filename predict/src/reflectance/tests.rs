use super::microfacet::distribution;
use super::optics::Reflectivity;
use super::surface::Reflectance;
use super::*;
use crate::statistics::Random;
use nalgebra::{Complex, Vector3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Fresnel's equations in complex numbers: |r∥|² and |r⊥|².
fn by_complex_numbers(optics: Optics, theta: f64) -> Reflectivity {
    let (sin, cos) = theta.sin_cos();
    let n2 = Complex::new(optics.n, -optics.k).powi(2);
    let u = (n2 - sin * sin).sqrt();
    Reflectivity {
        parallel: ((n2 * cos - u) / (n2 * cos + u)).norm_sqr(),
        perpendicular: ((cos - u) / (cos + u)).norm_sqr(),
    }
}

fn direction(theta: f64, phi: f64) -> Vector3<f64> {
    Vector3::new(
        theta.sin() * phi.cos(),
        theta.sin() * phi.sin(),
        theta.cos(),
    )
}

fn constants() -> Constants {
    Constants {
        ambient: 0.5,
        diffuse: None,
        s: 1.0,
        d: 0.0,
        m: 0.3,
        n: 1.5,
        k: 0.0,
        form: SpecularForm::Normalised,
    }
}

#[test]
fn fresnel_agrees_with_complex_numbers() {
    let mut random = Random::new(1);
    for i in 0..20_000 {
        let n = 0.1 + 5.0 * random.uniform();
        let k = if i % 5 == 0 {
            0.0
        } else {
            8.0 * random.uniform()
        };
        let theta = FRAC_PI_2 * random.uniform();
        let optics = Optics { n, k };
        let (found, expected) = (
            optics.fresnel(theta.cos()),
            by_complex_numbers(optics, theta),
        );
        let off = (found.parallel - expected.parallel)
            .abs()
            .max((found.perpendicular - expected.perpendicular).abs());
        assert!(off < 2e-14, "n {n} k {k} theta {theta}: {off:e}");
    }
}

#[test]
fn fresnel_at_its_ends() {
    for (n, k) in [(1.5, 0.0), (1.0, 6.6), (0.2, 3.4), (0.5, 0.0), (0.001, 0.0)] {
        let optics = Optics { n, k };
        let (normal, grazing) = (optics.fresnel(1.0), optics.fresnel(0.0));
        assert_eq!(normal.parallel, normal.perpendicular);
        let expected = ((n - 1.0).powi(2) + k * k) / ((n + 1.0).powi(2) + k * k);
        assert!((normal.parallel - expected).abs() < 1e-15);
        assert_eq!((grazing.parallel, grazing.perpendicular), (1.0, 1.0));
    }
    // Total reflection beyond the critical angle; nothing where there is no boundary.
    let total = Optics { n: 0.5, k: 0.0 }.fresnel(1.0_f64.cos());
    assert_eq!((total.parallel, total.perpendicular), (1.0, 1.0));
    let none = Optics { n: 1.0, k: 0.0 }.fresnel(0.3);
    assert!(none.parallel < 1e-30 && none.perpendicular < 1e-30);
}

#[test]
fn brewsters_angle_reflects_no_parallel_light() {
    for n in [0.6_f64, 1.1, 1.33, 1.5, 2.4, 4.0] {
        let found = Optics { n, k: 0.0 }.fresnel(n.atan().cos());
        assert!(found.parallel < 1e-30, "{n}: {:e}", found.parallel);
        let expected = ((n * n - 1.0) / (n * n + 1.0)).powi(2);
        assert!((found.perpendicular - expected).abs() < 1e-14);
    }
}

#[test]
fn polarisations_weigh_the_components() {
    let of = Reflectivity {
        parallel: 0.2,
        perpendicular: 0.6,
    };
    let weighed = |parallel, perpendicular| Polarisation::new(parallel, perpendicular).unwrap();
    assert!((of.reflectivity(Polarisation::UNPOLARISED) - 0.4).abs() < 1e-15);
    assert!((of.reflectivity(weighed(3.0, 0.0)) - 0.2).abs() < 1e-15);
    assert!((of.reflectivity(weighed(0.0, 2.0)) - 0.6).abs() < 1e-15);
    assert!((of.reflectivity(weighed(1.0, 3.0)) - (0.2 + 3.0 * 0.6) / 4.0).abs() < 1e-15);
    for (parallel, perpendicular) in [
        (0.0, 0.0),
        (-1.0, 2.0),
        (f64::NAN, 1.0),
        (f64::MAX, f64::MAX),
    ] {
        assert_eq!(Polarisation::new(parallel, perpendicular), None);
    }
}

/// Reflectivities along the normal by the published constants, ((n−1)² + k²)/((n+1)² + k²).
#[test]
fn known_materials_reflect_as_published() {
    for (name, wavelength, normal) in [
        ("aluminium", 516.6, 0.9177),
        ("aluminium", 815.69, 0.8656),
        ("steel", 549.0, 0.5121),
        ("copper", 450.9, 0.5392),
        ("copper", 548.6, 0.6194),
        ("copper", 659.5, 0.9433),
        // By Sultanova, Kasarova and Nikolov n is 1.491 at 587.6 nm, the line d of helium.
        ("plastic", 587.6, 0.0388),
        ("paper", 589.0, 0.0439),
    ] {
        let known = Named::known(name).unwrap();
        let found = known.material(wavelength).unwrap();
        let reflected = found.optics().normal();
        assert!((reflected - normal).abs() < 1e-4, "{name}: {reflected}");
        assert_eq!(Material::new(*found.constants()), Ok(found), "{name}");
        let white = found.diffuse() * PI;
        assert!((0.0..=1.0).contains(&white));
    }
    assert_eq!(Named::known("unobtainium"), None);
    let aluminium = Named::Aluminium.material(GREEN).unwrap();
    assert!((aluminium.diffuse() - aluminium.optics().normal() / PI).abs() < 1e-16);
}

#[test]
fn constants_are_between_what_is_measured_and_nowhere_else() {
    for known in Named::ALL {
        let range = known.wavelengths();
        assert!(range.contains(&GREEN), "{known:?}");
        for end in [*range.start(), *range.end()] {
            assert!(known.material(end).is_some(), "{known:?}");
        }
        assert_eq!(known.material(range.start() - 1.0), None);
        assert_eq!(known.material(range.end() + 1.0), None);
        assert_eq!(known.material(f64::NAN), None);
    }
    // Half-way between 582.1 nm (0.70, 2.704) and 616.8 nm (0.30, 3.205).
    let copper = Named::Copper.material(599.45).unwrap().optics();
    assert!((copper.n - 0.5).abs() < 1e-12 && (copper.k - 2.9545).abs() < 1e-12);
}

#[test]
fn beckmanns_distribution_integrates_to_pi() {
    for m in [0.0001, 0.01, 0.1, 0.3, 0.6, 1.0] {
        // The integral over the hemisphere of D cos α, by t = tan α/m.
        let steps = 20_000;
        let width = 8.0 / steps as f64;
        let sum: f64 = (0..steps)
            .map(|i| {
                let slope = m * (i as f64 + 0.5) * width;
                let alpha = slope.atan();
                let per_step = m / (1.0 + slope * slope) * width;
                distribution(m, alpha.cos()) * alpha.cos() * alpha.sin() * per_step
            })
            .sum();
        // The cosine of an angle of 0.0001 has but eight digits of it.
        let digits = if m < 0.001 { 1e-5 } else { 1e-6 };
        assert!((2.0 * PI * sum - PI).abs() < digits, "{m}: {}", 2.0 * sum);
    }
    for cos in [0.0, -0.5, -1.0, f64::MIN_POSITIVE, f64::NAN] {
        assert_eq!(distribution(0.3, cos), 0.0);
    }
}

/// The geometric attenuation G = min{1, 2(N·H)(N·V)/(V·H), 2(N·H)(N·L)/(V·H)}: the share of a facet
/// that its neighbours neither shade nor hide, for V-shaped grooves (Torrance and Sparrow, 1967; Cook
/// and Torrance, 1982).
fn attenuation(n_h: f64, n_v: f64, n_l: f64, v_h: f64) -> f64 {
    if n_h > 0.0 && n_v > 0.0 && n_l > 0.0 && v_h > 0.0 {
        (2.0 * n_h * n_v.min(n_l) / v_h).min(1.0)
    } else {
        0.0
    }
}

#[test]
fn the_surface_is_the_product_of_its_terms_and_reciprocal() {
    let mut random = Random::new(3);
    let light_of = Polarisation::new(1.0, 2.0).unwrap();
    let n = Vector3::z();
    for _ in 0..20_000 {
        let mut any = |most: f64| most * random.uniform();
        let (l, v) = (
            direction(any(1.5), any(2.0 * PI)),
            direction(any(1.5), any(2.0 * PI)),
        );
        let with = Constants {
            d: 0.25,
            s: 0.75,
            m: 0.05 + any(0.95),
            n: 0.2 + any(3.0),
            k: any(7.0),
            ..constants()
        };
        let material = Material::new(with).unwrap();
        let found = SurfaceFinish::new(&material).reflectance(&n, &l, &v, light_of);
        let h = (l + v).normalize();
        let f = material.optics().fresnel(h.dot(&l)).reflectivity(light_of);
        let g = attenuation(h.z, v.z, l.z, h.dot(&v));
        let expected = 0.75 * f * distribution(with.m, h.z) * g / (4.0 * PI * l.z * v.z);
        assert!((found.specular - expected).abs() <= 1e-11 * expected.max(1e-12));
        let diffuse = found.total - found.specular;
        assert!((diffuse - 0.25 * material.diffuse()).abs() < 1e-12 * found.total.max(1.0));
        let swapped = SurfaceFinish::new(&material).reflectance(&n, &v, &l, light_of);
        assert!((found.total - swapped.total).abs() <= 1e-14 * found.total);
    }
}

/// The share of all light that goes into a direction, if it comes evenly from everywhere: the
/// integral of R (N·L) over the lights, by facets of equal shares of the cosine-weighted
/// distribution.
fn albedo(surface: &SurfaceFinish, theta: f64, m: f64) -> f64 {
    let (slopes, turns) = (400, 200);
    let n = Vector3::z();
    let v = direction(theta, 0.0);
    let mut sum = 0.0;
    for i in 0..slopes {
        // Beyond the slope m t there is the share exp(−t²) of it.
        let share = (i as f64 + 0.5) / slopes as f64;
        let alpha = (m * (-share.ln()).sqrt()).atan();
        let weight = PI / (distribution(m, alpha.cos()) * alpha.cos());
        for j in 0..turns {
            let h = direction(alpha, 2.0 * PI * (j as f64 + 0.5) / turns as f64);
            let v_h = v.dot(&h);
            if v_h <= 0.0 {
                continue;
            }
            let l = 2.0 * v_h * h - v;
            let found = surface.reflectance(&n, &l, &v, Polarisation::UNPOLARISED);
            sum += found.specular * l.z.max(0.0) * 4.0 * v_h * weight;
        }
    }
    sum / f64::from(slopes * turns)
}

#[test]
fn no_more_light_is_reflected_than_comes() {
    let mirror = |m, form| {
        let with = Constants {
            m,
            n: 1.0,
            k: 1000.0,
            form,
            ..constants()
        };
        SurfaceFinish::new(&Material::new(with).unwrap())
    };
    for m in [0.001, 0.02, 0.1, 0.2, 0.35, 0.5, 0.75, 1.0] {
        for theta in [0.0, 0.3, 0.7, 1.0, 1.2, 1.4, 1.5, 1.56] {
            let found = albedo(&mirror(m, SpecularForm::Normalised), theta, m);
            assert!(found <= 1.0, "m {m}, angle {theta}: {found}");
        }
    }
    // Smooth facets return all light; the form of 1982, four times as much.
    let smooth = |form| albedo(&mirror(0.02, form), 0.3, 0.02);
    assert!((smooth(SpecularForm::Normalised) - 1.0).abs() < 1e-3);
    assert!((smooth(SpecularForm::Printed) - 4.0).abs() < 4e-3);
}

#[test]
fn nothing_comes_from_behind_and_nothing_is_infinite() {
    let surface = SurfaceFinish::new(&Named::Steel.material(GREEN).unwrap());
    let n = Vector3::z();
    let ask = |l: Vector3<f64>, v: Vector3<f64>| {
        surface.reflectance(&n, &l, &v, Polarisation::UNPOLARISED)
    };
    assert_eq!(ask(-n, n), Reflectance::default());
    assert_eq!(ask(n, -n), Reflectance::default());
    assert_eq!(ask(Vector3::x(), n), Reflectance::default());
    assert!(ask(n, n).specular > 0.0);
    for theta in [1.57, FRAC_PI_2 - 1e-9, FRAC_PI_2 - 1e-15] {
        for phi in [0.0, 1.0, PI] {
            let found = ask(direction(theta, 0.0), direction(theta, phi));
            assert!(found.total.is_finite() && found.total >= 0.0);
        }
    }
    let nan = Vector3::repeat(f64::NAN);
    let _ = ask(nan, n);
}

#[test]
fn constants_are_read_and_held_to_their_ranges() {
    let text = "ambient = 0.6\ns = 0.6\nd = 0.4\nm = 0.2\nn = 1.49\nk = 0.0\n";
    let read: Material = toml::from_str(text).unwrap();
    assert_eq!(read.constants().form, SpecularForm::Normalised);
    let json = serde_json::to_string(&read).unwrap();
    assert_eq!(serde_json::from_str::<Material>(&json).unwrap(), read);
    let printed: Material = toml::from_str(&format!("{text}form = \"printed\"")).unwrap();
    assert_eq!(printed.constants().form, SpecularForm::Printed);
    for (wrong, said) in [
        ("shine = 1.0", "shine"),
        (
            "diffuse = 0.5",
            "`diffuse` is 0.5, and must be from 0 to 0.318",
        ),
    ] {
        let error = toml::from_str::<Material>(&format!("{text}{wrong}")).unwrap_err();
        assert!(error.to_string().contains(said), "{error}");
    }
    let of = |change: fn(&mut Constants)| {
        let mut c = constants();
        change(&mut c);
        Material::new(c).map_err(|e| e.to_string())
    };
    let said = |found: Result<Material, String>, part: &str| {
        let text = found.unwrap_err();
        assert!(text.contains(part), "{text}");
    };
    said(of(|c| c.m = 0.0), "`m` is 0, and must be from 0.0001 to 1");
    said(of(|c| c.n = 0.0), "`n`");
    said(of(|c| c.k = -1.0), "`k` is -1");
    said(of(|c| c.ambient = f64::NAN), "`ambient` is NaN");
    said(of(|c| c.s = 1.5), "`s` is 1.5");
    said(
        of(|c| c.d = 0.5),
        "`s` + `d` is 1 + 0.5, and must be at most 1",
    );
    for hundredths in 0..=100 {
        let mut c = constants();
        (c.s, c.d) = (
            f64::from(hundredths) / 100.0,
            f64::from(100 - hundredths) / 100.0,
        );
        assert!(Material::new(c).is_ok());
    }
}
