//! LinuxCNC's own interpreter gives the same canonical moves.
//!
//! Its Python module `gcode` reads every program of the package `linuxcnc-uspace`, our jobs and the
//! programs in `programs/`, which use each part of the language. Every move of both interpreters
//! must agree: kind, line, end, centre and number of turns of arcs, feed and time. Programs that
//! one of them refuses, or that do not move, are listed with the reason.

use crate::random;
use crate::support::{files, jobs, main_of_subroutines, programs, tool_table, tools};
use carrystep_gcode::{Canon, Interpreter, Options, Pace, Plane, Point};
use proptest::strategy::{Strategy as _, ValueTree as _};
use proptest::test_runner::TestRunner;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Greatest difference of two places, in mm or degrees.
const SAME: f64 = 1e-9;

/// Greatest relative difference of two feeds.
const SAME_FEED: f64 = 1e-9;

/// Least number of the package's programs that have to be compared.
const LEAST: usize = 15;

/// Programs that cannot be compared. After M6 LinuxCNC asks for its place anew, and its preview
/// leaves the tool offset out, so that the tool seems to jump if an offset is in effect then.
const OFFSET_AT_TOOL_CHANGE: [&str; 1] = ["skeleton.ngc"];

/// Where the package keeps programs.
const PACKAGE: [&str; 3] =
    ["/usr/share/linuxcnc/ncfiles", "/usr/share/doc/linuxcnc/examples", "/usr/share/axis"];

/// A move, as both interpreters give it.
#[derive(Debug, Clone, PartialEq)]
struct Moved {
    kind: String,
    line: u64,
    /// The end of a move; the time of a dwell.
    numbers: Vec<f64>,
    /// Centre, turns and plane of an arc.
    arc: Vec<f64>,
    /// mm per minute; `None` for moves without X, Y and Z, and without feed.
    feed: Option<f64>,
}

/// A program's moves, or why it is refused.
type Outcome = Result<Vec<Moved>, String>;

/// Leaves out moves of no length, and gives feeds only to moves along X, Y or Z.
#[derive(Default)]
struct Moves {
    at: Vec<f64>,
    moves: Vec<Moved>,
}

impl Moves {
    fn add(&mut self, mut moved: Moved) {
        if moved.kind == "dwell" {
            self.moves.push(moved);
            return;
        }
        self.at.resize(6, 0.0);
        let length = |axes: std::ops::Range<usize>| {
            axes.map(|axis| (moved.numbers[axis] - self.at[axis]).powi(2)).sum::<f64>().sqrt()
        };
        let is_arc = moved.kind == "arc";
        if length(0..3) < SAME && !is_arc {
            moved.feed = None;
        }
        if is_arc || length(0..6) >= SAME {
            self.at.clone_from(&moved.numbers);
            self.moves.push(moved);
        }
    }
}

fn ours(path: &Path) -> Outcome {
    // A probe may trip late, and a program may wait for this in a loop.
    let options = Options { blocks: 200_000, tools: Some(tools()), ..Options::default() };
    let mut moves = Moves::default();
    let mut at = Point::default();
    for step in Interpreter::open(path, &options).map_err(|error| error.to_string())? {
        let step = step.map_err(|error| error.to_string())?;
        let speed = |pace, to: &Point| match pace {
            Pace::PerSecond(speed) => 60.0 * speed,
            Pace::Seconds(seconds) => {
                (0..3).map(|axis| (to[axis] - at[axis]).powi(2)).sum::<f64>().sqrt() / seconds
                    * 60.0
            }
        };
        let (kind, to, arc, feed) = match &step.canon {
            Canon::Traverse { to } => ("traverse", *to, vec![], None),
            Canon::Feed { to, pace } => ("feed", *to, vec![], Some(speed(*pace, to))),
            Canon::Probe { to, pace, .. } => ("probe", *to, vec![], Some(speed(*pace, to))),
            Canon::Arc(arc) => {
                let plane = match arc.plane {
                    Plane::Xy => 1.0,
                    Plane::Yz => 2.0,
                    Plane::Zx => 3.0,
                };
                let feed = match arc.pace {
                    Pace::PerSecond(speed) => Some(60.0 * speed),
                    Pace::Seconds(_) => None,
                };
                let [first, second] = arc.centre;
                ("arc", arc.to, vec![first, second, arc.turns.into(), plane], feed)
            }
            Canon::Dwell { seconds } => {
                let (kind, numbers) = ("dwell".to_owned(), vec![*seconds]);
                moves.add(Moved { kind, line: step.line, numbers, arc: vec![], feed: None });
                continue;
            }
            _ => continue,
        };
        at = to;
        let numbers = to.to_vec();
        moves.add(Moved { kind: kind.to_owned(), line: step.line, numbers, arc, feed });
    }
    Ok(moves.moves)
}

/// All programs in one run of Python, in the same order.
fn linuxcncs(paths: &[PathBuf]) -> Vec<Outcome> {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/linuxcnc/canon.py");
    // The module belongs to Debian's Python, which need not be the first one on the path.
    let folder = tempfile::tempdir().expect("a folder");
    let table = folder.path().join("tools.tbl");
    std::fs::write(&table, tool_table()).expect("a file");
    let output = Command::new("/usr/bin/python3").arg(script).arg(&table).args(paths).output();
    let output = output.expect("python3 is missing: sudo apt-get install python3");
    let text = String::from_utf8_lossy(&output.stdout);
    let mut outcomes = Vec::new();
    let mut moves = Moves::default();
    let mut rate = 0.0;
    for line in text.lines().filter_map(|line| line.strip_prefix('@')) {
        let (kind, rest) = line.split_once(' ').unwrap_or((line, ""));
        match kind {
            "program" => (moves, rate) = (Moves::default(), 0.0),
            "end" => outcomes.push(Ok(std::mem::take(&mut moves.moves))),
            "refused" => outcomes.push(Err(rest.to_owned())),
            "traverse" | "feed" | "probe" | "arc" | "dwell" | "rate" => {
                let mut words = rest.split(' ');
                let line = words.next().and_then(|line| line.parse().ok()).unwrap_or(0);
                let mut numbers: Vec<f64> =
                    words.map(|word| word.parse().expect("a number")).collect();
                if kind == "rate" {
                    rate = numbers[0];
                    continue;
                }
                let arc = if kind == "arc" { numbers.split_off(6) } else { vec![] };
                let feed = matches!(kind, "feed" | "probe" | "arc").then_some(rate);
                moves.add(Moved { kind: kind.to_owned(), line, numbers, arc, feed });
            }
            _ => panic!("{line}"),
        }
    }
    assert_eq!(outcomes.len(), paths.len(), "{}", String::from_utf8_lossy(&output.stderr));
    outcomes
}

/// The first difference.
fn difference(ours: &[Moved], theirs: &[Moved]) -> Option<String> {
    let far = |a: &[f64], b: &[f64]| {
        a.len() != b.len() || a.iter().zip(b).any(|(a, b)| (a - b).abs() > SAME)
    };
    for (ours, theirs) in ours.iter().zip(theirs) {
        let other_feed = match (ours.feed, theirs.feed) {
            (Some(a), Some(b)) => (a - b).abs() > SAME_FEED * a.abs(),
            _ => false,
        };
        let other = ours.kind != theirs.kind || ours.line != theirs.line;
        if other || other_feed || far(&ours.numbers, &theirs.numbers) || far(&ours.arc, &theirs.arc)
        {
            return Some(format!("\n  ours   {ours:?}\n  theirs {theirs:?}"));
        }
    }
    (ours.len() != theirs.len()).then(|| format!("{} moves, not {}", ours.len(), theirs.len()))
}

fn assert_installed() {
    assert!(
        Path::new("/usr/bin/rs274").exists(),
        "LinuxCNC is missing: sudo apt-get install --no-install-recommends linuxcnc-uspace"
    );
}

#[test]
fn all_programs_have_the_canonical_moves_of_linuxcnc() {
    assert_installed();
    // Some folders of the package are links to others.
    let package = PACKAGE.iter().flat_map(|folder| files(Path::new(folder)));
    let package: BTreeSet<PathBuf> = package.filter_map(|path| path.canonicalize().ok()).collect();
    let is_compared =
        |path: &PathBuf| !OFFSET_AT_TOOL_CHANGE.iter().any(|name| path.ends_with(name));
    let package: Vec<PathBuf> = package.into_iter().filter(is_compared).collect();
    let own: Vec<PathBuf> = [jobs(), programs(), vec![main_of_subroutines()]].concat();
    let paths = [package, own.clone()].concat();
    let (mut compared, mut compared_own, mut moves) = (0, 0, 0);
    let mut wrong = Vec::new();
    for (path, theirs) in paths.iter().zip(linuxcncs(&paths)) {
        let shown = path.display();
        match (ours(path), theirs) {
            (Err(reason), Err(_)) => println!("excluded, both refuse it: {reason}"),
            (Err(reason), _) => println!("excluded, carrystep refuses it: {reason}"),
            (_, Err(reason)) => println!("excluded, LinuxCNC refuses {shown}: {reason}"),
            (Ok(ours), Ok(theirs)) if ours.is_empty() && theirs.is_empty() => {
                println!("excluded, no motion: {shown}");
            }
            (Ok(ours), Ok(theirs)) => {
                match difference(&ours, &theirs) {
                    Some(what) => wrong.push(format!("{shown}: {what}")),
                    None => println!("equal, {} moves: {shown}", ours.len()),
                }
                compared += 1;
                compared_own += usize::from(own.contains(path));
                moves += ours.len();
            }
        }
    }
    println!("{compared} programs with {moves} moves compared, {compared_own} of them our own");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert_eq!(compared_own, own.len(), "one of our own programs was not compared");
    assert!(compared - compared_own >= LEAST, "only {compared} programs were compared");
}

/// Number of random programs: one run of Python reads all of them.
const RANDOM: usize = 60;

#[test]
fn random_programs_have_the_canonical_moves_of_linuxcnc() {
    assert_installed();
    let folder = tempfile::tempdir().expect("a folder");
    let mut runner = TestRunner::default();
    let make = |number: usize| {
        let path = folder.path().join(format!("{number}.ngc"));
        let program = random::program().new_tree(&mut runner).expect("a program").current();
        std::fs::write(&path, program).expect("a file");
        path
    };
    let paths: Vec<PathBuf> = (0..RANDOM).map(make).collect();
    for (path, theirs) in paths.iter().zip(linuxcncs(&paths)) {
        let shown = || std::fs::read_to_string(path).unwrap_or_default();
        let ours = ours(path).unwrap_or_else(|error| panic!("{error}\n{}", shown()));
        let theirs = theirs.unwrap_or_else(|error| panic!("{error}\n{}", shown()));
        if let Some(what) = difference(&ours, &theirs) {
            panic!("{what}\n{}", shown());
        }
    }
}
