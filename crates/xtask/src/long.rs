//! The longer runs: what a test run does in part is done whole, and what came of it is written into
//! `docs/long-runs.md`.
//!
//! A run is a command; it says what it came to in lines that begin with `FIGURES`. Its row of the
//! page is replaced as soon as it is over, passed or failed, and the page is whole at any time. A
//! row is of the commit that it was run on, so nothing is run on files that are not committed.

mod inputs;
mod runs;

use crate::shell::{self, TaskResult};
use crate::tools;
use runs::{RUNS, Run};
use std::fmt::Write as _;
use std::fs;
use std::io::{BufRead as _, BufReader};
use std::process::Stdio;
use std::time::{Duration, Instant};

const PAGE: &str = "docs/long-runs.md";
const BEGIN: &str = "<!-- `cargo xtask long` writes from here ... -->";
const END: &str = "<!-- ... to here -->";
const HEAD: &str = "| run | what | came to | result | took | date | commit | gateware |\n|---|---|---|---|---|---|---|---|\n";
const FIGURES: &str = "FIGURES ";

/// What stands for a run that has not been made.
const NOT_YET: &str = "| not run yet | | | | |";

/// Makes the runs that a change since a commit can break, and writes the page.
pub fn run_since(base: &str) -> TaskResult {
    let names = inputs::touched(base)?;
    if names.is_empty() {
        shell::say(&format!("no long run depends on what has changed since {base}"));
        return Ok(());
    }
    shell::say(&format!("changed since {base}: what {} depend on", names.join(", ")));
    run(&names)
}

/// Makes the runs of these names, or all, and writes the page.
pub fn run(names: &[String]) -> TaskResult {
    if let Some(stranger) = names.iter().find(|name| RUNS.iter().all(|run| run.name != **name)) {
        let known: Vec<&str> = RUNS.iter().map(|run| run.name).collect();
        return Err(format!("no long run is called {stranger}; there are {}", known.join(", ")));
    }
    tools::install()?;
    let is_asked = |name: &str| names.is_empty() || names.iter().any(|asked| asked == name);
    if is_asked("senders") {
        tools::install_for_senders()?;
    }
    if is_asked("container") {
        tools::install_for_container()?;
    }
    committed()?;
    let commit = shell::read("git", &["rev-parse", "--short=10", "HEAD"])?;
    let gateware = shell::read("git", &["rev-parse", "--short=10", "HEAD:hdl-out/core"])?;
    let mut failed = Vec::new();
    for run in RUNS.iter().filter(|run| is_asked(run.name)) {
        shell::say(&format!("== {}: {}", run.name, run.what));
        let begun = Instant::now();
        let (passed, figures) = run.make()?;
        // A run that leaves other files behind than were committed has not shown that these are
        // right.
        let passed = passed && committed().is_ok();
        if !passed {
            failed.push(run.name);
        }
        let result = if passed { "passed" } else { "FAILED" };
        let date = shell::read("date", &["-u", "+%F"])?;
        let took = minutes(begun.elapsed());
        let row = format!(
            "{figures} | {result} | {took} | {} | `{}` | `{}` |",
            date.trim(),
            commit.trim(),
            gateware.trim()
        );
        write(run, &row)?;
        shell::say(&format!("== {}: {result} in {took}: {figures}", run.name));
    }
    if failed.is_empty() {
        Ok(())
    } else {
        Err(format!("long runs that failed: {}", failed.join(", ")))
    }
}

impl Run {
    /// Whether it passed, and what it came to; all that it says goes to the terminal.
    fn make(&self) -> Result<(bool, String), String> {
        let is_test = self.cargo.contains(&"--test");
        // With `--workspace`, tests have the features, and so the binaries, of a test run.
        let first: &[&str] =
            if is_test { &["test", "--release", "--workspace"] } else { &["run", "--release"] };
        let last: &[&str] = match (is_test, self.cargo.contains(&"--")) {
            (true, false) => &["--", "--nocapture"],
            (true, true) => &["--nocapture"],
            (false, _) => &[],
        };
        let mut command = shell::command("cargo", &[first, self.cargo, last].concat());
        command.envs(self.asks.iter().copied()).env("CARRYSTEP_FRESH", "1").stderr(Stdio::piped());
        let mut running =
            command.spawn().map_err(|error| format!("cannot start cargo: {error}"))?;
        let mut figures = Vec::new();
        for line in running
            .stderr
            .take()
            .into_iter()
            .flat_map(|said| BufReader::new(said).lines())
            .map_while(Result::ok)
        {
            shell::say(&line);
            figures.extend(line.strip_prefix(FIGURES).map(str::to_owned));
        }
        let status = running.wait().map_err(|error| error.to_string())?;
        // A test whose name has changed would pass by doing nothing.
        Ok((status.success() && !figures.is_empty(), figures.join("; ")))
    }
}

/// Fails where a file but the page is not as it was committed.
fn committed() -> TaskResult {
    let changed = shell::read("git", &["status", "--porcelain", "--", ".", &format!(":!{PAGE}")])?;
    if changed.is_empty() {
        Ok(())
    } else {
        Err(format!("not committed, so no commit to name:\n{changed}"))
    }
}

fn minutes(took: Duration) -> String {
    format!("{} min {} s", took.as_secs() / 60, took.as_secs() % 60)
}

/// Replaces the row of one run; the page appears whole or not at all.
fn write(run: &Run, row: &str) -> TaskResult {
    let path = shell::root().join(PAGE);
    let page = fs::read_to_string(&path).map_err(|error| format!("{PAGE}: {error}"))?;
    let lost = || format!("{PAGE} has lost a mark of its table");
    let (before, rest) = page.split_once(BEGIN).ok_or_else(lost)?;
    let (table, after) = rest.split_once(END).ok_or_else(lost)?;
    let text = format!("{before}{BEGIN}\n\n{}\n{END}{after}", with_row(table, run.name, row));
    let next = path.with_extension("md.new");
    fs::write(&next, text)
        .and_then(|()| fs::rename(&next, &path))
        .map_err(|error| format!("{PAGE}: {error}"))
}

/// The table with one row replaced; the others as they were.
fn with_row(table: &str, name: &str, row: &str) -> String {
    let mut text = HEAD.to_owned();
    for run in RUNS {
        let begin = format!("| {} | {} | ", run.name, run.what);
        let old = table.lines().find_map(|line| line.strip_prefix(&begin)).unwrap_or(NOT_YET);
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{begin}{}", if run.name == name { row } else { old });
    }
    text
}

#[cfg(test)]
mod tests {
    use super::{NOT_YET, with_row};

    #[test]
    fn a_row_is_replaced_alone() {
        let empty = with_row("", "", "");
        assert_eq!(empty.matches(NOT_YET).count(), super::RUNS.len());
        let first = with_row(&empty, "mutants", "1 | passed |");
        let second = with_row(&first, "proofs", "2 | passed |");
        assert_eq!(second.matches(NOT_YET).count(), super::RUNS.len() - 2);
        assert!(second.contains("1 | passed |") && second.contains("2 | passed |"));
        assert!(!with_row(&second, "mutants", "3 |").contains("1 | passed |"));
    }
}
