//! Numbers in the docs are those that the product gives.

use carrystep_levels::{Job, Level, run};
use carrystep_tests::{effort, moves};
use std::fs;
use std::process::Command;

fn page(name: &str) -> String {
    fs::read_to_string(moves::root().join("docs").join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// Whole numbers as the page writes them, in groups of three.
fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let groups = digits.as_bytes().rchunks(3).rev().map(|group| String::from_utf8_lossy(group).into_owned());
    groups.collect::<Vec<_>>().join(" ")
}

#[test]
fn the_flow_of_a_move_has_the_real_numbers() {
    let text = page("flow-of-a-move.md");
    let plan = moves::demo();
    let x = &plan.moves[0].axes[0];
    for segment in &x.segments {
        let wanted = [segment.ticks.to_string(), segment.v.to_string(), segment.a.to_string()];
        let there = text.lines().any(|line| line.split_whitespace().take(3).eq(wanted.iter()));
        assert!(there, "no line '{}'", wanted.join("  "));
    }
    assert!(text.contains(&format!("60.795 ms, {} ticks", plan.moves[0].ticks)));
    assert!(text.contains(&grouped(x.segments[0].a.unsigned_abs())));
    assert!(text.contains(&grouped(x.segments[0].v.unsigned_abs())));

    let program = plan.program();
    let mut first = None;
    let job = Job::new(&plan.build, &program, plan.total_ticks());
    run(Level::Model, &job, &mut |cycle, outputs| {
        if outputs.step & 1 == 1 && first.is_none() {
            first = Some(cycle);
        }
    })
    .expect("the model");
    let first = first.expect("a pulse on x");
    assert!(text.contains(&grouped(first)), "the first edge is in cycle {first}");
    assert!(text.contains(&grouped(plan.build.timebase.clock_to_ps(first))));
    let pulses: u64 = plan.moves.iter().flat_map(|m| &m.axes).map(|a| a.steps.unsigned_abs()).sum();
    assert!(text.contains(&format!("{pulses} edges")));
}

/// The first line that git says, where there is a repository that git can read.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).current_dir(moves::root()).output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

#[test]
fn the_long_runs_have_passed_on_this_gateware() {
    let text = page("long-runs.md");
    let (_, rest) = text.split_once("writes from here ... -->").expect("the table");
    let (table, _) = rest.split_once("<!-- ... to here -->").expect("the table's end");
    let rows: Vec<Vec<&str>> = table
        .lines()
        .filter(|line| line.starts_with("| "))
        .skip(1)
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    let names: Vec<&str> = rows.iter().map(|row| row[0]).collect();
    assert_eq!(
        names,
        [
            "lockstep",
            "rust-hdl",
            "proofs",
            "mutants",
            "bad-line",
            "garbage",
            "dead-host",
            "verilog-board",
            "resources",
            "boards",
            "equivalence"
        ]
    );
    for row in rows {
        let [name, _, figures, result, took, date, commit, gateware] = row[..] else { panic!("a row of {row:?}") };
        if figures == "not run yet" {
            effort::say(&format!("{name} has not been run yet: `cargo xtask long {name}`"));
            continue;
        }
        assert_eq!(result, "passed", "{name}: {figures}");
        assert!(figures.starts_with(|first: char| first.is_ascii_digit()) && took.ends_with(" s"), "{name}: {row:?}");
        assert!(date.len() == 10 && date.starts_with("20") && date.matches('-').count() == 2, "{name}: {date}");
        let [commit, gateware] = [commit, gateware].map(|hash| hash.trim_matches('`'));
        assert!([commit, gateware].iter().all(|hash| hash.len() >= 10), "{name}: {commit} {gateware}");
        // In a tree without git nothing more is known; in one without its past, not whether the commit is there.
        let Some(now) = git(&["rev-parse", "HEAD:hdl-out/core"]) else { continue };
        assert!(now.starts_with(gateware), "{name} was run on other gateware: run `cargo xtask long {name}` again");
        if git(&["rev-parse", "--is-shallow-repository"]).as_deref() == Some("false") {
            let ancestor = git(&["merge-base", "--is-ancestor", commit, "HEAD"]);
            assert!(ancestor.is_some(), "{name}: the commit {commit} is not in this history");
        }
    }
}
