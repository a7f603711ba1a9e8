//! Pairs of solids that coincide in some way, or miss the coincidence by a gap.

use clap::ValueEnum;
use premio_csg::evaluate::{Evaluation, EvaluationOptions, evaluate};
use premio_csg::reader::{Format, ReadOptions, read};
use premio_csg::tree::Tree;
use premio_kernel::brep::topology::EntityCounts;
use premio_kernel::number::predicates::CoincidencePolicy;
use premio_verify::checks::Checker;

/// Two solids in PADL; `D` is the gap by which they miss the coincidence.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// What coincides.
    pub name: &'static str,
    /// The first.
    pub a: &'static str,
    /// The second.
    pub b: &'static str,
    /// The smallest power of two that is less than all other lengths of the pair.
    pub small: i32,
}

const fn pair(name: &'static str, a: &'static str, b: &'static str) -> Pair {
    Pair {
        name,
        a,
        b,
        small: 10,
    }
}

impl Pair {
    /// The same, for a pair with another length as small as a thousandth.
    const fn fine(self) -> Self {
        Self { small: 20, ..self }
    }
}

/// The table.
#[rustfmt::skip]
pub const PAIRS: &[Pair] = &[
    pair("ball on block", "BLO(X=4,Y=4,Z=2)", "SPH(R=1) AT (MOVX=2,MOVY=2,MOVZ=3+D)"),
    pair("block on block", "BLO(X=4,Y=4,Z=2)", "BLO(X=1,Y=1,Z=1) AT (MOVX=1,MOVY=1,MOVZ=2+D)"),
    pair("block beside block", "BLO(X=4,Y=4,Z=2)", "BLO(X=1,Y=1,Z=1) AT (MOVX=4+D,MOVY=1,MOVZ=1)"),
    pair("edge along edge", "BLO(X=4,Y=4,Z=2)", "BLO(X=1,Y=4,Z=1) AT (MOVX=4+D,MOVY=1,MOVZ=2)"),
    pair("vertex at vertex", "BLO(X=4,Y=4,Z=2)", "BLO(X=1,Y=4,Z=1) AT (MOVX=4+D,MOVY=4+D,MOVZ=2+D)"),
    pair("cylinder lying on block", "BLO(X=4,Y=4,Z=2)", "CYL(R=1,H=2) AT (ROTX=90,MOVX=2,MOVY=3,MOVZ=3+D)"),
    pair("cylinder standing on block", "BLO(X=4,Y=4,Z=2)", "CYL(R=1,H=2) AT (MOVX=2,MOVY=2,MOVZ=2+D)"),
    pair("balls", "SPH(R=1)", "SPH(R=2) AT (MOVX=3+D)"),
    pair("parallel cylinders", "CYL(R=1,H=4)", "CYL(R=1,H=4) AT (MOVX=2+D)"),
    pair("skew cylinders", "CYL(R=1,H=4)", "CYL(R=1,H=4) AT (ROTX=90,MOVX=2+D,MOVY=2,MOVZ=2)"),
    pair("apex on block", "BLO(X=4,Y=4,Z=2)", "CON(R=1,H=2) AT (ROTX=180,MOVX=2,MOVY=2,MOVZ=4+D)"),
    pair("apex on ball", "SPH(R=1)", "CON(R=1,H=2) AT (ROTX=180,MOVZ=3+D)"),
    pair("torus lying on block", "BLO(X=8,Y=8,Z=2) AT (MOVX=-4,MOVY=-4,MOVZ=-2)", "TOR(RMAJ=2,RMIN=1) AT (MOVZ=1+D)"),
    pair("torus standing on block", "BLO(X=8,Y=8,Z=2) AT (MOVX=-4,MOVY=-4,MOVZ=-2)", "TOR(RMAJ=2,RMIN=1) AT (ROTX=90,MOVZ=3+D)"),
    pair("tori side by side", "TOR(RMAJ=2,RMIN=1)", "TOR(RMAJ=2,RMIN=1) AT (MOVX=6+D)"),
    pair("edge on ball", "BLO(X=4,Y=2,Z=2) AT (MOVX=-2)", "SPH(R=1) AT (MOVY=-0.6-D*0.6,MOVZ=2.8+D*0.8)"),
    pair("vertex on face", "BLO(X=4,Y=4,Z=4) AT (MOVX=-2,MOVY=-2,MOVZ=-4)", "WED(X=1,Y=1,Z=1) AT (ROTY=-45,ROTX=35,MOVZ=D)"),
    pair("edge across edge", "WED(X=2,Y=4,Z=1)", "WED(X=2,Y=4,Z=1) AT (ROTX=180,ROTZ=90,MOVX=-2,MOVY=2,MOVZ=2+D)"),
    pair("ball in bore", "CYL(R=2,H=4)", "SPH(R=1) AT (MOVX=1-D,MOVZ=2)"),
    pair("void at wall", "BLO(X=4,Y=4,Z=4)", "SPH(R=1) AT (MOVX=2,MOVY=2,MOVZ=3-D)"),
    pair("vertex on cylinder", "CYL(R=1,H=4)", "WED(X=1,Y=1,Z=1) AT (ROTZ=30,ROTY=20,MOVX=1+D,MOVZ=2)"),
    pair("corner beside a torus's top", "TOR(RMAJ=1,RMIN=0.5)", "BLO(X=2,Y=2,Z=1) AT (MOVX=1+D,MOVY=-0.7,MOVZ=0.5)"),
    pair("wall beside a torus's bottom", "TOR(RMAJ=1,RMIN=0.5)", "BLO(X=2,Y=2,Z=1) AT (MOVX=1+D,MOVY=0.1,MOVZ=-0.5)"),
    pair("corner close beside a torus's bottom", "TOR(RMAJ=1,RMIN=0.5)", "BLO(X=2,Y=2,Z=1) AT (MOVX=1+D,MOVY=0.003,MOVZ=-0.5)").fine(),
    pair("rim beside a torus's top and bottom", "TOR(RMAJ=1,RMIN=0.5)", "CYL(R=0.4,H=1) AT (MOVX=0.6+D,MOVZ=-0.5)"),
    pair("cone's rim beside a torus's top", "TOR(RMAJ=1,RMIN=0.5)", "CON(R=0.4,H=1) AT (MOVX=0.6+D,MOVZ=0.5)"),
    pair("rim about a torus's top", "TOR(RMAJ=1,RMIN=0.5)", "CYL(R=1+D,H=1) AT (MOVZ=0.5)"),
    pair("tube about a torus's top", "TOR(RMAJ=1,RMIN=0.5)", "CYL(R=1+D,H=1) AT (MOVZ=-0.5)"),
    pair("torus on a torus, cut open", "TOR(RMAJ=1,RMIN=0.5)", "(TOR(RMAJ=1,RMIN=0.25) AT (MOVZ=0.25)) DIF (CYL(R=1+D,H=2) AT (MOVZ=-1))"),
    pair("torus in a bore, cut across", "CYL(R=1.5,H=1) AT (MOVZ=-0.5)", "TOR(RMAJ=1,RMIN=0.5) DIF (BLO(X=3,Y=3,Z=3) AT (MOVX=-1,MOVY=-1,MOVZ=D))"),
    pair("ball in a bore, cut across", "CYL(R=1,H=4) AT (MOVZ=-2)", "SPH(R=1) DIF (BLO(X=3,Y=3,Z=3) AT (MOVX=-1.5,MOVY=-1.5,MOVZ=D))"),
    pair("wedge's edge beside a cylinder", "CYL(R=1,H=2)", "WED(X=2,Y=2,Z=1) AT (MOVX=D,MOVY=1,MOVZ=0.5)"),
    pair("block's edge beside a cylinder's side", "CYL(R=1,H=2)", "BLO(X=1,Y=1,Z=1) AT (MOVX=D,MOVZ=0.5)"),
    pair("cylinders along a line, one cut", "CYL(R=1,H=2)", "(CYL(R=0.5,H=1) AT (MOVX=1.5,MOVZ=0.5)) DIF (BLO(X=2,Y=2,Z=2) AT (MOVX=0.5,MOVY=D,MOVZ=0.2))"),
    pair("cylinder in a cylinder, cut", "CYL(R=1,H=2)", "(CYL(R=0.5,H=1) AT (MOVX=0.5,MOVZ=0.5)) DIF (BLO(X=2,Y=2,Z=2) AT (MOVX=0.5,MOVY=D,MOVZ=0.2))"),
    pair("cylinders across, at an end", "CYL(R=1,H=2) AT (MOVZ=D)", "CYL(R=0.5,H=3) AT (ROTX=90,MOVX=1.5,MOVY=1)"),
    pair("face along a cone's ruling", "CON(R=1,H=1)", "BLO(X=2,Y=2,Z=2) AT (MOVX=D,MOVY=-1,ROTY=-45,MOVX=1)"),
    pair("edge beside a ball on a face", "SPH(R=1)", "BLO(X=2,Y=2,Z=1) AT (MOVX=D,MOVY=-1,MOVZ=-2)"),
    pair("corner beside a ball on a face", "SPH(R=1)", "BLO(X=2,Y=2,Z=1) AT (MOVX=D,MOVY=D/2,MOVZ=-2)"),
    pair("plate of 2e-6 along a cylinder's ruling", "CYL(R=1,H=2)", "BLO(X=0.000002,Y=1,Z=1) AT (MOVX=D-0.000001,MOVY=1,MOVZ=0.5)").fine(),
    pair("ball in a ball, cut", "SPH(R=1)", "(SPH(R=0.5) AT (MOVX=0.5)) DIF (BLO(X=2,Y=2,Z=2) AT (MOVX=-1,MOVY=D,MOVZ=-1))"),
    pair("ball on a ball, cut", "SPH(R=1)", "(SPH(R=0.5) AT (MOVX=1.5)) DIF (BLO(X=2,Y=2,Z=2) AT (MOVX=0,MOVY=D,MOVZ=D))"),
    pair("coaxial cylinders of equal radius", "CYL(R=1,H=2)", "CYL(R=1,H=2) AT (MOVX=D,MOVZ=1)"),
    pair("one cylinder's radius", "CYL(R=1,H=2)", "CYL(R=1+D,H=2) AT (MOVZ=1)"),
    pair("equal cylinders crossing", "CYL(R=1,H=4) AT (MOVZ=-2)", "CYL(R=1,H=4) AT (ROTX=90,MOVX=D,MOVY=2)"),
    pair("cylinders of nearly equal radius crossing", "CYL(R=1,H=4) AT (MOVZ=-2)", "CYL(R=1+D,H=4) AT (ROTX=90,MOVY=2)"),
    pair("ball in a cylinder of its radius", "CYL(R=1,H=4) AT (MOVZ=-2)", "SPH(R=1+D)"),
    pair("ball in a cylinder beside its axis", "CYL(R=1,H=4) AT (MOVZ=-2)", "SPH(R=1) AT (MOVX=D)"),
    pair("torus in a cylinder", "CYL(R=1.5+D,H=4) AT (MOVZ=-2)", "TOR(RMAJ=1,RMIN=0.5)"),
    pair("cylinder in a torus's hole", "CYL(R=0.5+D,H=4) AT (MOVZ=-2)", "TOR(RMAJ=1,RMIN=0.5)"),
    pair("four planes through a point", "BLO(X=2,Y=2,Z=2)", "WED(X=4,Y=2,Z=4) AT (MOVX=-1,MOVZ=-1+D)"),
    pair("four surfaces through a point", "(CYL(R=1,H=2)) INT (BLO(X=2,Y=2,Z=2))", "SPH(R=1) AT (MOVZ=2,MOVX=1,MOVY=0.5+D)"),
    pair("cone's apex on a face from within", "CON(R=1,H=1)", "BLO(X=2,Y=2,Z=2) AT (MOVX=-1,MOVY=-1,MOVZ=1-D)"),
    pair("ball in a cone", "CON(R=3,H=4)", "SPH(R=1) AT (MOVZ=1+D)"),
    pair("coplanar faces", "BLO(X=2,Y=2,Z=2)", "BLO(X=1,Y=1,Z=1) AT (MOVX=0.5,MOVY=0.5,MOVZ=1+D)"),
    pair("coplanar and flush", "BLO(X=2,Y=2,Z=2)", "BLO(X=2,Y=2,Z=2) AT (MOVX=D,MOVY=1)"),
    pair("through hole's end", "BLO(X=2,Y=2,Z=2)", "CYL(R=0.5,H=2+D) AT (MOVX=1,MOVY=1)"),
    pair("tori through one another's centre circles", "TOR(RMAJ=2,RMIN=1)", "TOR(RMAJ=2,RMIN=1) AT (MOVZ=D)"),
];

/// The pose of a pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum Pose {
    /// Unchanged.
    Straight,
    /// Rotated by right angles, so that each axis becomes another.
    Swapped,
    /// Rotated by 17 degrees about an odd axis, and moved.
    Turned,
    /// Rotated by a tiny angle, so that nothing is exactly along an axis.
    Tilted,
    /// Rotated, and moved to where coordinates have three digits less.
    Far,
}

impl Pose {
    /// All poses.
    pub const ALL: [Self; 5] = [
        Self::Straight,
        Self::Swapped,
        Self::Turned,
        Self::Tilted,
        Self::Far,
    ];

    /// Its motions in PADL.
    fn motions(self) -> &'static str {
        match self {
            Self::Straight => "MOVX=0",
            Self::Swapped => "ROTX=90,ROTZ=90",
            Self::Turned => "ROTX=17,ROTZ=31,MOVX=0.3,MOVY=0.7",
            Self::Tilted => "ROTX=0.0001,ROTY=-0.00001",
            Self::Far => "ROTZ=17,ROTY=-50,MOVX=1000,MOVY=-700,MOVZ=300",
        }
    }
}

/// A power of two in PADL, with as many decimals as it has bits.
pub fn gap(sign: &str, power: i32) -> String {
    let text = format!("{sign}{:.60}", 2f64.powi(-power));
    text.trim_end_matches('0').to_owned()
}

/// The allowed rounding error of volumes. What coincides by the resolution moves by the distance
/// that it had.
const OFF: f64 = 1e-9;

/// The number of rays that measure each volume.
const RAYS: usize = 1000;

/// The faults of a pair that misses its coincidence by `gap`: refusals, defects, volumes that
/// disagree with ray casting, and volumes of A, B, A ∪ B, A ∩ B, A \ B and B \ A that do not add
/// up.
pub fn faults(pair: &Pair, gap: &str, pose: Pose) -> Vec<String> {
    let mut faults = Vec::new();
    let mut slack = OFF;
    let mut volume = |solid: String| {
        let part = evaluated(&solid, gap, pose, CoincidencePolicy::ByResolution);
        let known = part.and_then(|(tree, part)| {
            let report = Checker::new(&tree, &part).solid(RAYS);
            match report.failures().next() {
                Some(fault) => Err(fault.to_string()),
                None => {
                    let mass = part.mass();
                    slack += part.greatest_coincidence() * mass.area;
                    Ok(mass.volume)
                }
            }
        });
        known.unwrap_or_else(|fault| {
            faults.push(format!("{solid}: {fault}"));
            f64::NAN
        })
    };
    let [of_a, of_b] = [pair.a, pair.b].map(|one| volume(format!("({one})")));
    let [union, both, rest, other] = pair.operations().map(volume);
    let off = [
        union + both - of_a - of_b,
        rest + both - of_a,
        other + both - of_b,
    ];
    if !off.iter().all(|v| v.abs() <= slack) {
        faults.push(format!("volumes off by {off:?}"));
    }
    faults
}

/// The powers of two at which the exact boundary of a pair has another number of entities than at
/// the first of them. On one side of a coincidence all boundaries are alike.
pub fn changes(pair: &Pair, sign: &str, powers: &[i32], pose: Pose) -> Vec<String> {
    let mut changes = Vec::new();
    for solid in pair.operations() {
        let mut first: Option<EntityCounts> = None;
        for &power in powers {
            let power = power.max(pair.small);
            match evaluated(&solid, &gap(sign, power), pose, CoincidencePolicy::Exact) {
                Err(fault) => changes.push(format!("{solid} at {sign}2^-{power}: {fault}")),
                Ok((_, part)) => {
                    let found = part.brep.topology.census();
                    let known = first.get_or_insert_with(|| found.clone());
                    if *known != found {
                        changes.push(format!(
                            "{solid} at {sign}2^-{power}: {found:?} for {known:?}"
                        ));
                    }
                }
            }
        }
    }
    changes
}

impl Pair {
    /// A or B, A and B, A less B, B less A.
    fn operations(&self) -> [String; 4] {
        let Self { a, b, .. } = self;
        [
            format!("({a}) UN ({b})"),
            format!("({a}) INT ({b})"),
            format!("({a}) DIF ({b})"),
            format!("({b}) DIF ({a})"),
        ]
    }
}

fn evaluated(
    solid: &str,
    gap: &str,
    pose: Pose,
    zeros: CoincidencePolicy,
) -> Result<(Tree, Evaluation), String> {
    let motions = pose.motions();
    let text = format!("D = {gap}\nP = ({solid}) AT ({motions})\n");
    let tree = read(
        "part",
        text.as_bytes(),
        Format::Padl,
        &ReadOptions::default(),
    );
    let tree = tree.map_err(|error| error.to_string())?.tree;
    let options = EvaluationOptions {
        zeros,
        ..EvaluationOptions::default()
    };
    let part = evaluate(&tree, &options).map_err(|error| error.to_string())?;
    Ok((tree, part))
}
