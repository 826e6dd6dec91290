//! Rung 7: the promises of docs/promises.md hold in the exported Verilog for any inputs and for
//! ever. The situations that they describe do occur, and each promise detects the bug that is
//! planted for it.

use carrystep_core::AXES;
use carrystep_tests::proofs::equivalence::{self, Asked, BUGS, EQUAL, Move, compare};
use carrystep_tests::proofs::{self, Proof, Question, ask, independence};
use carrystep_tests::{effort, moves, pages, repeats};
use carrystep_tools::kept;
use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

type Answer = Result<(), proofs::ProofError>;

/// A question and its origin.
struct Job<'a> {
    name: String,
    proof: &'a Proof,
    case: proofs::Case,
    question: Question,
}

fn jobs(proof: &Proof) -> Vec<Job<'_>> {
    let job = |case: &proofs::Case, question| {
        let name = format!("{} ({}): {question:?}", proof.module, case.name);
        Job { name, proof, case: case.clone(), question }
    };
    let first = &proof.cases[0];
    let mut jobs = vec![job(first, Question::Covers(proof.reach))];
    for case in &proof.cases {
        jobs.push(job(case, Question::Induction(proof.depth)));
        jobs.push(job(case, Question::Base(proof.depth + 1)));
    }
    // A bug in the wiring of several adders takes the solver long to reach.
    let is_planted = proof.module != "wide" || repeats::in_full();
    jobs.extend(
        proof
            .bugs
            .iter()
            .filter(|_| is_planted)
            .map(|bug| job(&first.with(bug), Question::Fails(bug.breaks, proof.reach))),
    );
    jobs
}

/// Executes all jobs on all processor cores; returns the answers that are not the expected ones.
fn do_all<T: Sync>(
    jobs: &[T],
    name: impl Fn(&T) -> String + Sync,
    ask: impl Fn(&T) -> Answer + Sync,
) -> String {
    let next = AtomicUsize::new(0);
    let failures = Mutex::new(String::new());
    let workers = thread::available_parallelism().map_or(2, usize::from);
    thread::scope(|scope| {
        for _ in 0..workers {
            scope.spawn(|| {
                while let Some(job) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if let Err(error) = ask(job) {
                        let mut failures = failures.lock().expect("no worker panics");
                        writeln!(failures, "{}: {error}", name(job)).expect("a string takes it");
                    }
                }
            });
        }
    });
    failures.into_inner().expect("no worker panics")
}

#[test]
fn every_promise_is_proved_and_every_planted_bug_is_caught() {
    proofs::tools().unwrap_or_else(|error| panic!("{error}, or `cargo xtask tools`"));
    let proofs = proofs::all();
    let jobs: Vec<Job<'_>> = proofs.iter().flat_map(jobs).collect();
    let failures = do_all(
        &jobs,
        |job| job.name.clone(),
        |job| ask(&job.proof.promises, &job.case, job.question),
    );
    kept::say();
    assert!(failures.is_empty(), "{failures}");
    println!("\n{}", proofs::table());
    let bugs: usize = proofs.iter().map(|proof| proof.bugs.len()).sum();
    effort::figures(&format!(
        "{} questions to the solver, all answered as they must be; {bugs} planted bugs caught",
        jobs.len()
    ));
}

/// The proof is bounded in time, and covers any numbers in the segments of a move.
#[test]
fn engine_is_proved_equal_to_the_parallel_axes() {
    proofs::tools().unwrap_or_else(|error| panic!("{error}, or `cargo xtask tools`"));
    let bugged = equivalence::move_with_bugs();
    let mut jobs: Vec<(Move, Asked)> =
        equivalence::moves().into_iter().map(|pair| (pair, Asked::Equal)).collect();
    jobs.extend(
        BUGS.iter().map(|(module, bug)| (bugged.with(module, bug), Asked::Differ(bug.breaks))),
    );
    jobs.extend(equivalence::moves().pop().map(|pair| (pair, Asked::Covers)));
    let name = |(pair, asked): &(Move, Asked)| format!("{}: {asked:?}", pair.engine.name);
    let failures = do_all(&jobs, name, |(pair, asked)| compare(pair, *asked));
    kept::say();
    assert!(failures.is_empty(), "{failures}");
    for label in EQUAL.labels() {
        assert!(BUGS.iter().any(|(_, bug)| bug.breaks == label), "no bug for {label}");
    }
}

/// Promise 16, with planted bugs; and that the host does read what it asks for.
#[test]
fn neither_snapshot_nor_latch_changes_an_edge() {
    let cases = independence::cases();
    let bugs = independence::BUGS.iter().map(|(case, bug)| (cases[*case].with(bug), false));
    let jobs: Vec<(proofs::Case, bool)> =
        cases.iter().map(|case| (case.clone(), true)).chain(bugs).collect();
    let asked = |(case, holds): &(proofs::Case, bool)| {
        let paths = independence::paths(case)?;
        let reads = ["snapshot", "latch", "latch_arm"];
        let read = |name: &&str| paths.read.iter().any(|path| path.ends_with(&format!("/{name}")));
        if paths.harmful.is_empty() == *holds && reads.iter().all(read) {
            return Ok(());
        }
        Err(proofs::ProofError::Refuted(format!("{paths:?}")))
    };
    let failures = do_all(&jobs, |(case, holds)| format!("{}: {holds}", case.name), asked);
    kept::say();
    assert!(failures.is_empty(), "{failures}");
    effort::figures(&format!(
        "{} engines without a path from snapshots and latches to other outputs, and {} with bugs with one",
        cases.len(),
        independence::BUGS.len()
    ));
}

/// The column "proved in" of the page lists exactly what is proved.
#[test]
fn promises_page_lists_exactly_what_is_proved() {
    let page = std::fs::read_to_string(moves::root().join("docs/promises.md")).expect("the page");
    let proofs = proofs::all();
    for promise in 1..=19 {
        let row = page
            .lines()
            .find(|line| line.starts_with(&format!("| {promise} |")))
            .expect("a row a promise");
        let told: BTreeSet<&str> = row
            .split('|')
            .nth(3)
            .into_iter()
            .flat_map(|cell| cell.split('`'))
            .map(str::trim)
            .collect();
        let told: BTreeSet<&str> = told.into_iter().filter(|module| !module.is_empty()).collect();
        let proved = proofs.iter().filter(|proof| proof.promises.numbers().contains(&promise));
        let of_paths = (promise == independence::PROMISE).then_some("engine");
        let proved = proved.map(|proof| proof.module).chain(of_paths);
        assert_eq!(told, proved.collect(), "promise {promise}");
    }
}

/// A promise that no bug can break would be meaningless.
#[test]
fn every_promise_has_a_planted_bug_that_breaks_it() {
    for proof in proofs::all() {
        let labels = proof.promises.labels();
        let broken: BTreeSet<&str> = proof.bugs.iter().map(|bug| bug.breaks).collect();
        for label in &broken {
            assert!(
                labels.contains(label),
                "{}: a bug breaks {label}, which is not there",
                proof.module
            );
        }
        for number in proof.promises.numbers() {
            let own = format!("promise_{number}_");
            assert!(
                broken.iter().any(|label| label.starts_with(&own)),
                "{}: no bug for promise {number}",
                proof.module
            );
        }
        assert!(!proof.promises.covers().is_empty(), "{}: no covers", proof.module);
    }
}

/// The table of the page has the sizes of each move, its open bits and its clocks.
#[test]
fn page_lists_the_moves_that_are_compared() {
    let page = std::fs::read_to_string(moves::root().join("docs/promises.md")).expect("the page");
    let (_, rest) = page.split_once("| axes | tick | ticks of the segments |").expect("a table");
    let mut shown: Vec<&str> =
        rest.lines().skip(2).take_while(|line| line.starts_with("| ")).collect();
    let mut wanted: Vec<String> = equivalence::moves().iter().map(row_of).collect();
    shown.sort_unstable();
    wanted.sort_unstable();
    assert_eq!(shown, wanted);
}

/// The row of the page for a move.
fn row_of(pair: &Move) -> String {
    let number = |wanted: &str| {
        let found = pair.engine.numbers.iter().find(|(name, _)| *name == wanted);
        &*found.expect("a number of the miter").1
    };
    let free = number("FREE").strip_prefix("64'h").expect("a mask");
    let free = u64::from_str_radix(free, 16).expect("a mask in hex");
    format!(
        "| {} | {} clocks, {} phases | {} and {} | {} | {} |",
        number("AXES"),
        number("CLOCKS"),
        number("PHASES"),
        number("TICKS_1"),
        number("TICKS_2"),
        open_bits(free),
        pair.clocks
    )
}

/// The set bits of a mask in words, from the highest down.
fn open_bits(mask: u64) -> String {
    if mask == u64::MAX {
        return format!("all {} bits", u64::BITS);
    }
    let is_set = |bit: u32| mask >> bit & 1 == 1;
    let ends = |beside: fn(u32) -> Option<u32>| {
        (0..u64::BITS)
            .rev()
            .filter(|&bit| is_set(bit) && !beside(bit).is_some_and(is_set))
            .collect::<Vec<_>>()
    };
    let tops = ends(|bit| Some(bit + 1).filter(|&bit| bit < u64::BITS));
    let bottoms = ends(|bit| bit.checked_sub(1));
    let runs = tops.iter().zip(&bottoms).map(|(top, bottom)| format!("{top} to {bottom}"));
    format!("bits {}", runs.collect::<Vec<_>>().join(" and "))
}

#[test]
fn page_gives_the_ticks_of_the_proofs() {
    let proofs = proofs::all();
    // The numbers of axes, clocks and phases of each proof of a module; a module of the parallel
    // core has no number of axes.
    let cases = |module: &str| -> BTreeSet<[u32; 3]> {
        let proof = proofs.iter().find(|proof| proof.module == module).expect("a module");
        let number = |case: &proofs::Case, wanted: &str| -> u32 {
            let found = case.numbers.iter().find(|(name, _)| *name == wanted);
            found.map_or(0, |(_, number)| number.parse().expect("a number"))
        };
        let cases = proof.cases.iter();
        cases.map(|case| ["AXES", "CLOCKS", "PHASES"].map(|name| number(case, name))).collect()
    };
    let clocks = |module: &str, is_wanted: &dyn Fn(&[u32; 3]) -> bool| {
        let cases = cases(module);
        let clocks: BTreeSet<u32> =
            cases.iter().filter(|case| is_wanted(case)).map(|case| case[1]).collect();
        clocks.iter().map(u32::to_string).collect::<Vec<_>>().join(" and ")
    };
    let [many, few, one] = [16, 4, 1].map(|phases| clocks("tick", &|case| case[2] == phases));
    assert_eq!(few, one, "one sentence gives the clocks of both");
    let [single, six] = [1, 6].map(|axes| clocks("engine", &|case| case[0] == axes));
    let six = six.replace(" and ", " (as shipped) and in ");
    for module in ["time_slot", "stops", "switches"] {
        assert!(cases(module).iter().all(|case| case[0] as usize == AXES), "{module}");
    }
    let pair = clocks("event_wheel", &|case| case[0] == 2);
    // The cases of the core give their tick in their names.
    let core = proofs.iter().find(|proof| proof.module == "core").expect("the core");
    let [small] = &core.cases.iter().filter(|case| case.axes() < 6).collect::<Vec<_>>()[..] else {
        panic!("one case with fewer axes")
    };
    pages::says(
        "docs/promises.md",
        &[
            format!("Ticks: {many} clocks in 16 phases, {few} clocks in 4 phases and in 1."),
            format!("with one axis in ticks of {single} clocks, and with six in {six}."),
            format!("proved with {} axes only.", pages::word(AXES as u64)),
            format!("`core`: {} axes, and in ticks of", pages::word(AXES as u64)),
            format!("`event_wheel` is also proved with two axes in {pair},"),
            format!(
                "and in ticks of {} also {} axes.",
                small.name.split_once(", ").expect("axes, and a tick").1,
                pages::word(small.axes() as u64)
            ),
        ],
    );
}
