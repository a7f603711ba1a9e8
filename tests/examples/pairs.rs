//! Misses coincidences of pairs of solids by powers of two, and prints the resulting faults.
//!
//! `cargo run --release -p premio-tests --example pairs -- --from 10 --to 60`

use clap::Parser;
use premio_tests::pairs::{PAIRS, Pose, changes, faults, gap};
use std::io::{self, Write};
use std::process::ExitCode;

/// Misses coincidences by powers of two.
#[derive(Debug, Parser)]
struct Arguments {
    /// The least power.
    #[arg(long, default_value_t = 10)]
    from: i32,
    /// The greatest power.
    #[arg(long, default_value_t = 60)]
    to: i32,
    /// How the pairs are put.
    #[arg(long, value_enum, default_value = "straight")]
    pose: Pose,
    /// Only pairs with this in their names.
    #[arg(long, default_value = "")]
    pair: String,
    /// Compare the exact boundaries on each side of a coincidence instead.
    #[arg(long)]
    exact: bool,
}

fn main() -> io::Result<ExitCode> {
    let arguments = Arguments::parse();
    let pose = arguments.pose;
    let (mut wrong, mut all) = (0, 0);
    let mut out = io::stdout().lock();
    let pairs = || PAIRS.iter().filter(|p| p.name.contains(&arguments.pair));
    if arguments.exact {
        let powers: Vec<i32> = (arguments.from..=arguments.to).step_by(10).collect();
        for (pair, sign) in pairs().flat_map(|pair| [(pair, ""), (pair, "-")]) {
            let found = changes(pair, sign, &powers, pose);
            for change in &found {
                writeln!(out, "{}: {change}", pair.name)?;
            }
            all += 1;
            wrong += usize::from(!found.is_empty());
        }
        writeln!(out, "{wrong} of {all} sides")?;
        return Ok(ExitCode::from(u8::from(wrong > 0)));
    }
    for pair in pairs() {
        for power in arguments.from..=arguments.to {
            for sign in ["", "-"] {
                let found = faults(pair, &gap(sign, power), pose);
                for fault in &found {
                    writeln!(out, "{} by {sign}2^-{power}: {fault}", pair.name)?;
                }
                all += 1;
                wrong += usize::from(!found.is_empty());
            }
        }
    }
    writeln!(out, "{wrong} of {all} pairs")?;
    Ok(ExitCode::from(u8::from(wrong > 0)))
}
