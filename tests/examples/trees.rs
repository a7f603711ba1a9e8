//! Examines the random trees of `premio fuzz` including the slower checks: recounting all pieces,
//! and casting rays on meshes. Prints the failing ones with their trees, and a summary.
//!
//! `cargo run --release -p premio-tests --example trees -- --from 0 --count 10000 --views`

use clap::Parser;
use premio_tests::examine::{Depth, VIEWS, examine};
use premio_tests::random::text;
use premio_verify::generator::model::PartModel;
use premio_verify::generator::profile::Profile;
use premio_verify::generator::shrink::shrink;
use std::collections::BTreeMap;
use std::io::{self, Read, Write};
use std::process::{Command, ExitCode, Stdio};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

/// Examines random trees.
#[derive(Debug, Parser)]
struct Arguments {
    /// The kind of trees.
    #[arg(long, default_value_t = Profile::Grid)]
    profile: Profile,
    /// The first seed.
    #[arg(long, default_value_t = 0)]
    from: u64,
    /// How many seeds.
    #[arg(long, default_value_t = 1000)]
    count: u64,
    /// Count the pieces of five views again, and look for missing contours.
    #[arg(long)]
    views: bool,
    /// How many rays measure each volume.
    #[arg(long, default_value_t = 20_000)]
    rays: usize,
    /// How many threads.
    #[arg(long, default_value_t = 1)]
    threads: usize,
    /// After how many seconds a tree is given up.
    #[arg(long, default_value_t = 20)]
    limit: u64,
    /// Make each failing tree as small as it fails in the same way.
    #[arg(long)]
    shrink: bool,
    /// Examine the tree on standard input alone, in this process.
    #[arg(long)]
    one: bool,
}

/// Trees that take longer are named in the summary.
const SLOW: Duration = Duration::from_secs(5);

#[derive(Debug, Default)]
struct Summary {
    failures: BTreeMap<String, Vec<u64>>,
    slow: Vec<(u64, Duration)>,
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    // Panics are caught and counted.
    std::panic::set_hook(Box::new(|_| {}));
    if arguments.one {
        return one(&arguments);
    }
    let started = Instant::now();
    let next = AtomicU64::new(arguments.from);
    let summary = Mutex::new(Summary::default());
    std::thread::scope(|scope| {
        for _ in 0..arguments.threads.max(1) {
            scope.spawn(|| work(&arguments, &next, &summary));
        }
    });
    let Ok(summary) = summary.into_inner() else {
        return ExitCode::FAILURE;
    };
    say(&format!(
        "{} trees in {:.1} s",
        arguments.count,
        started.elapsed().as_secs_f64()
    ));
    for (kind, seeds) in &summary.failures {
        let some = &seeds[..seeds.len().min(20)];
        say(&format!("{}: {} ({some:?})", kind, seeds.len()));
    }
    for (seed, time) in &summary.slow {
        say(&format!("slow: {seed} {:.1} s", time.as_secs_f64()));
    }
    if summary.failures.is_empty() {
        ExitCode::SUCCESS
    } else {
        ExitCode::FAILURE
    }
}

fn work(arguments: &Arguments, next: &AtomicU64, summary: &Mutex<Summary>) {
    loop {
        let seed = next.fetch_add(1, Ordering::Relaxed);
        if seed - arguments.from >= arguments.count {
            return;
        }
        let started = Instant::now();
        let mut model = arguments.profile.model(seed);
        let mut wrong = in_a_process(&model, arguments);
        let time = started.elapsed();
        if arguments.shrink && !wrong.is_empty() {
            model = shrunk(&model, &wrong, arguments);
            wrong = in_a_process(&model, arguments);
        }
        let Ok(mut summary) = summary.lock() else {
            return;
        };
        if time > SLOW {
            summary.slow.push((seed, time));
        }
        if !wrong.is_empty() {
            let json = text(&model);
            say(&format!("seed {seed}\n  {}\n  {json}", wrong.join("\n  ")));
        }
        for text in wrong {
            let kind = kind(&text).to_owned();
            summary.failures.entry(kind).or_default().push(seed);
        }
    }
}

/// The text before the first colon.
fn kind(text: &str) -> &str {
    text.split(':').next().unwrap_or_default()
}

/// A smaller tree with the same first fault.
fn shrunk(model: &PartModel, wrong: &[String], arguments: &Arguments) -> PartModel {
    let first = wrong.first().map(|text| kind(text));
    shrink(model, TRIES, |smaller| {
        let found = in_a_process(smaller, arguments);
        found.iter().any(|text| Some(kind(text)) == first)
    })
}

/// The number of smaller trees that are tried.
const TRIES: usize = 1000;

/// Examines one tree in its own process, which may hang, overflow its stack or exhaust memory.
fn in_a_process(model: &PartModel, arguments: &Arguments) -> Vec<String> {
    let mut command = Command::new(std::env::current_exe().unwrap_or_default());
    command.args(["--one", "--rays", &arguments.rays.to_string()]);
    if arguments.views {
        command.arg("--views");
    }
    command.stdin(Stdio::piped()).stdout(Stdio::piped());
    command.stderr(Stdio::null());
    match run(command, &text(model), Duration::from_secs(arguments.limit)) {
        Ok(lines) => lines,
        Err(error) => vec![format!("process: {error}")],
    }
}

fn run(mut command: Command, tree: &str, limit: Duration) -> io::Result<Vec<String>> {
    let started = Instant::now();
    let mut child = command.spawn()?;
    if let Some(mut input) = child.stdin.take() {
        input.write_all(tree.as_bytes())?;
    }
    let status = loop {
        if let Some(status) = child.try_wait()? {
            break status;
        }
        if started.elapsed() > limit {
            child.kill()?;
            child.wait()?;
            return Ok(vec![format!("time: more than {limit:?}")]);
        }
        std::thread::sleep(Duration::from_millis(2));
    };
    let mut text = String::new();
    if let Some(mut out) = child.stdout.take() {
        out.read_to_string(&mut text)?;
    }
    if status.code().is_none() {
        return Ok(vec![format!("crash: {status}")]);
    }
    Ok(text.lines().map(str::to_owned).collect())
}

/// The work of the child process.
fn one(arguments: &Arguments) -> ExitCode {
    let mut tree = String::new();
    if io::stdin().read_to_string(&mut tree).is_err() {
        return ExitCode::FAILURE;
    }
    let depth = Depth {
        rays: arguments.rays,
        views: if arguments.views { &VIEWS } else { &[] },
    };
    for text in examine(&tree, depth) {
        // One line for each; a pipe can buffer that much.
        say(&text
            .replace('\n', " ")
            .chars()
            .take(2000)
            .collect::<String>());
    }
    ExitCode::SUCCESS
}

fn say(text: &str) {
    // The reader may have gone.
    let _ = writeln!(io::stdout().lock(), "{text}");
}
