//! Reads the STEP file of a part back with a reader of its own, and checks it by rules that need no
//! other kernel. Edges are longer than the resolution and lie on their surfaces within the stated
//! accuracy. Loops close in space and in the parameters of the surface. Every edge is used twice
//! with opposite senses. The volume by the file's own curves and surfaces is the boundary's.

mod curve;
pub(crate) mod foreign;
mod net_ellipse;
mod oval;
mod part21;
mod ruled;
mod rules;
mod shape;
mod spline_net;
mod surface;
mod walk;

use super::{Check, CheckSubject, Checker, Finding};
use premio_exchange::FaceColours;
use premio_exchange::step::{self, Protocol, StepOptions};
use premio_kernel::unit::Unit;
use rules::{Known, Measured};
use shape::{StepOrigin, StepShape};

/// The number of broken rules that are reported.
const REPORTED: usize = 3;

impl Checker<'_> {
    /// Writes the STEP file, reads it back and checks it.
    pub(crate) fn step(&self) -> Check {
        let subject = CheckSubject::Step;
        let check = |finding, detail| Check {
            subject,
            finding,
            detail,
        };
        let evaluation = self.evaluation;
        if evaluation.brep.topology.solids.is_empty() {
            return check(Finding::Passes, "nothing to write".to_owned());
        }
        let options = StepOptions {
            name: "part".to_owned(),
            protocol: Protocol::default(),
            unit: Unit::default(),
            accuracy: step::ACCURACY * self.bounds.diagonal(),
            resolution: evaluation.f64_resolution(),
            colours: FaceColours::default(),
        };
        let text = match step::write(&evaluation.brep, &options) {
            Ok(text) => text,
            Err(error) => return check(Finding::Passes, format!("refused: {error}")),
        };
        let shape =
            part21::read(&text).and_then(|instances| StepShape::new(&instances, StepOrigin::Ours));
        let shape = match shape {
            Ok(shape) => shape,
            Err(error) => return check(Finding::Fails, error.to_string()),
        };
        let mass = evaluation.mass();
        let measured = rules::measure(
            &shape,
            &Known {
                resolution: options.resolution,
                accuracy: options.accuracy,
                size: self.bounds.diagonal(),
                middle: self.bounds.centre(),
                volume: mass.volume,
            },
        );
        let solids = SolidCounts {
            read: shape.solids.len(),
            known: evaluation.brep.topology.solids.len(),
        };
        compared(&measured, solids, mass.volume)
    }
}

/// The number of solids of a file, and of its part.
#[derive(Clone, Copy)]
struct SolidCounts {
    read: usize,
    known: usize,
}

/// Compares a file that was read with its part.
fn compared(measured: &Measured, solids: SolidCounts, volume: f64) -> Check {
    let mut wrong: Vec<String> = measured.broken.iter().map(ToString::to_string).collect();
    let SolidCounts { read, known } = solids;
    if read != known {
        wrong.insert(0, format!("{read} solids, not {known}"));
    }
    let more = wrong.len().saturating_sub(REPORTED);
    wrong.truncate(REPORTED);
    if more > 0 {
        wrong.push(format!("{more} more"));
    }
    let Measured {
        edges, faces, off, ..
    } = measured;
    let figures = format!("{faces} faces, {edges} edges, curves within {off:.1e} of surfaces");
    let (finding, detail) = match (wrong.is_empty(), measured.volume) {
        (true, Some(_)) => (
            Finding::Passes,
            format!("{figures}, the volume is {volume}"),
        ),
        (true, None) => (
            Finding::Passes,
            format!("{figures}; the volume is undetermined, as an edge passes through a pole"),
        ),
        (false, _) => (Finding::Fails, wrong.join("; ")),
    };
    Check {
        subject: CheckSubject::Step,
        finding,
        detail,
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test fails by it")]
mod tests {
    use super::*;
    use nalgebra::Point3;
    use premio_csg::evaluate::{EvaluationOptions, evaluate};
    use premio_csg::reader::{Format, ReadOptions as Reading, read};
    use rules::StepRule;

    const ACCURACY: f64 = 1e-4;

    /// The text of a part's STEP file, and what is known of the part.
    fn written(text: &str) -> (String, Known) {
        let part = read("part", text.as_bytes(), Format::Padl, &Reading::default()).unwrap();
        let evaluation = evaluate(&part.tree, &EvaluationOptions::default()).unwrap();
        let options = StepOptions {
            name: "part".to_owned(),
            protocol: Protocol::default(),
            unit: Unit::default(),
            accuracy: ACCURACY,
            resolution: evaluation.resolution,
            colours: FaceColours::default(),
        };
        let mass = evaluation.mass();
        let known = Known {
            resolution: evaluation.resolution,
            accuracy: ACCURACY,
            size: evaluation.bounds.diagonal(),
            middle: Point3::new(1.0, 2.0, 3.0),
            volume: mass.volume,
        };
        (step::write(&evaluation.brep, &options).unwrap(), known)
    }

    fn measured(text: &str, known: &Known) -> Measured {
        let shape = StepShape::new(&part21::read(text).unwrap(), StepOrigin::Ours).unwrap();
        rules::measure(&shape, known)
    }

    const PARTS: [&str; 18] = [
        "A = BLO(X=3, Y=4, Z=5)",
        "A = SPH(R=2) AT (ROTX=17, MOVX=9)",
        "A = TOR(RMAJ=3, RMIN=1) AT (ROTX=17, MOVZ=-4)",
        "A = CON(R=3, H=4) AT (ROTY=40)",
        "A = (SPH(R=3) INT BLO(X=5, Y=5, Z=5)) AT (ROTY=40)",
        "A = (CON(R=3, H=4) INT BLO(X=5, Y=5, Z=5)) AT (ROTX=40)",
        "A = (TOR(RMAJ=3, RMIN=1) INT BLO(X=5, Y=5, Z=5)) AT (ROTX=40)",
        "A = (SPH(R=4) DIF SPH(R=3) DIF CYL(R=1, H=9)) AT (ROTX=40)",
        "A = BLO(X=9, Y=9, Z=9) DIF SPH(R=2) AT (MOVX=4, MOVY=4, MOVZ=4)",
        "A = (CYL(R=2, H=9) UN CYL(R=1, H=9) AT (ROTX=80, MOVZ=4)) AT (ROTX=40)",
        // A face of the ball surrounds a pole close to an edge along a meridian.
        "A = ((CYL(R=0.5, H=3) AT (ROTX=-180, MOVY=1.5, MOVZ=-0.5)
            DIF CON(R=1.5, H=1.5, R2=2)
            DIF CYL(R=2, H=1.5) AT (ROTY=17, MOVX=2, MOVY=-1, MOVZ=1))
          UN BLO(X=2.5, Y=1.5, Z=4)
          UN (SPH(R=1.5) DIF BLO(X=3.5, Y=3, Z=3) AT (MOVX=1, MOVY=-2, MOVZ=-1)))",
        // A circle runs from a vertex to another one at the same point.
        "A = ((WED(X=1.5, Y=2.5, Z=2) AT (ROTX=30, MOVZ=-0.5)
              UN CYL(R=2, H=1) AT (MOVX=1, MOVY=-2, MOVZ=-1)
              UN CON(R=1, H=1, R2=2) AT (MOVX=-1, MOVY=-0.5, MOVZ=-0.5)
              UN CYL(R=0.5, H=0.5) AT (MOVX=0.5, MOVY=-1.5, MOVZ=-2))
            DIF CYL(R=0.5, H=1) AT (ROTZ=180, MOVX=-2, MOVY=-1.5)
            DIF CYL(R=2, H=1)) AT (ROTX=-90, MOVX=2, MOVY=1.5, MOVZ=2)",
        // The face of the cone surrounds its apex, which is a vertex of a notch.
        "A = (WED(X=0.5, Y=3.5, Z=0.5)
            UN CON(R=1.5, H=1) AT (ROTY=-17, MOVX=1.5, MOVZ=-0.5)
            UN BLO(X=2.5, Y=2, Z=1.5) AT (ROTX=180, MOVX=-1.5, MOVY=2, MOVZ=-1)
            UN WED(X=3.5, Y=4, Z=3.5)
            UN TOR(RMAJ=2.5, RMIN=1) AT (ROTX=-45, MOVY=-2)
            UN CYL(R=0.5, H=0.5)) AT (ROTZ=180, MOVX=1, MOVY=-0.5, MOVZ=-1)",
        // A ball touches a ring's tube from inside, so its seam ends twice at the same point.
        "A = (TOR(RMAJ=1, RMIN=0.5) AT (MOVX=-0.75, MOVZ=-0.4330127018922193, ROTY=30)
            DIF SPH(R=0.5) AT (MOVZ=-0.5)) AT (ROTZ=45)",
        // A parabola on a cone.
        "A = CON(R=2, H=2) DIF WED(X=5, Y=5, Z=5) AT (MOVX=-4, MOVY=-2)",
        // Planes that nearly pass through an apex.
        "A = CON(R=1, H=1.5) AT (MOVX=0.0000019, MOVY=0.0000019) INT BLO(X=4, Y=4, Z=4)",
        // A loop passes through the pole of a horn torus, whose axis its edges touch.
        "A = ((TOR(RMAJ=2, RMIN=2) UN BLO(X=1, Y=2.5, Z=2.5) AT (ROTZ=30, MOVY=-2))
            INT CON(R=1.5, H=2.5, R2=0.5))",
        // Two edges on a face of a horn torus that contains both its poles, and no edge at its pole.
        "A = ((((TOR(RMAJ=1, RMIN=1.5) UN TOR(RMAJ=1, RMIN=0.5) AT (ROTX=45, MOVZ=1.118033988749895))
              INT TOR(RMAJ=1.5, RMIN=1) AT (ROTY=90, MOVX=-0.5, MOVY=-0.5, MOVZ=2))
            INT TOR(RMAJ=0.5, RMIN=0.5) AT (ROTY=180, MOVY=1, MOVZ=1.5))
          UN SPH(R=1) AT (MOVZ=0.118033988749895))",
    ];

    /// The volume by the file's own curves is that of the boundary, whatever the surfaces.
    #[test]
    fn files_keep_all_rules() {
        for text in PARTS {
            let (file, known) = written(text);
            let measured = measured(&file, &known);
            assert_eq!(measured.broken, [], "{text}");
            let off = (measured.volume.unwrap() - known.volume).abs();
            // Splines are closer than required.
            assert!(
                off < 1e-3 * ACCURACY * known.size.powi(2),
                "{text}: {off:e}"
            );
        }
    }

    #[test]
    fn a_radius_that_is_another_is_found() {
        let (file, known) = written("A = CYL(R=2, H=5)");
        let line = file.lines().find(|l| l.contains("=CYLINDRICAL_SURFACE"));
        let line = line.unwrap();
        let wide = file.replace(line, &line.replace(",2.)", ",2.01)"));
        let broken = measured(&wide, &known).broken;
        let off = |b: &rules::Broken| matches!(b.rule, StepRule::EdgeOnSurface(off) if (off - 0.01).abs() < 1e-9);
        assert!(broken.iter().any(off), "{broken:?}");
        assert!(broken.iter().any(|b| matches!(b.rule, StepRule::Volume(_))));
    }

    #[test]
    fn an_edge_that_is_turned_is_found() {
        let (file, known) = written("A = BLO(X=3, Y=4, Z=5)");
        let line = file.lines().find(|l| l.contains("=ORIENTED_EDGE")).unwrap();
        let turned = match line.contains(".T.") {
            true => line.replace(".T.", ".F."),
            false => line.replace(".F.", ".T."),
        };
        let broken = measured(&file.replace(line, &turned), &known).broken;
        assert!(
            broken.iter().any(|b| b.rule == StepRule::Chain),
            "{broken:?}"
        );
        let uses = |b: &rules::Broken| {
            matches!(
                b.rule,
                StepRule::TwoUses {
                    uses: 2,
                    sum: 2 | -2
                }
            )
        };
        assert!(broken.iter().any(uses), "{broken:?}");
    }

    #[test]
    fn a_shell_inside_out_is_found() {
        let (file, known) = written("A = SPH(R=2)");
        let other = match file.contains(",.T.);\n") {
            true => file.replace("=ADVANCED_FACE('',(", "=ADVANCED_FACE('turned',("),
            false => file.clone(),
        };
        let line = other
            .lines()
            .find(|l| l.contains("=ADVANCED_FACE"))
            .unwrap();
        let turned = other.replace(line, &line.replace(".T.", ".F."));
        let broken = measured(&turned, &known).broken;
        let inside_out = |b: &rules::Broken| matches!(b.rule, StepRule::Orientation(v) if v < 0.0);
        assert!(broken.iter().any(inside_out), "{broken:?}");
    }

    #[test]
    fn what_is_no_file_is_told_with_its_line() {
        let (file, _) = written("A = SPH(R=2)");
        let error = part21::read(&file.replacen("=(", "=", 1)).unwrap_err();
        assert!(
            matches!(error, part21::StepReadError::Grammar { .. }),
            "{error}"
        );
    }
}
