//! A tool that counts how often it is run stands in for yosys, and a function for a simulation.

use super::known::difference_in;
use super::{Question, UNUSED, files, remove_unused};
use crate::programs::Tool;
use std::fs;
use std::path::Path;
use std::process::Output;
use std::time::SystemTime;

/// Any program that takes a script as an argument, and has no version.
const SH: Tool = Tool { name: "sh", version: None, purpose: "tests", install: &[] };

/// Answers, and a place outside of the question in which each run leaves a mark.
struct Bench {
    answers: tempfile::TempDir,
    runs: tempfile::NamedTempFile,
}

impl Bench {
    fn new() -> Self {
        Self {
            answers: tempfile::tempdir().unwrap(),
            runs: tempfile::NamedTempFile::new().unwrap(),
        }
    }

    fn runs(&self) -> usize {
        fs::read(self.runs.path()).unwrap().len()
    }

    /// Asks for `out`, which is made of `in`; the answer and `out`.
    fn ask(
        &self,
        content: &str,
        script: &str,
        is_fresh: bool,
        is_complete: bool,
    ) -> (Output, String) {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("in"), content).unwrap();
        let script = format!("printf x >> {}; {script}", self.runs.path().display());
        let arguments = ["-c", &script];
        let answers = Some(self.answers.path().to_owned());
        let question =
            Question { tool: &SH, folder: folder.path(), arguments: &arguments, is_fresh, answers };
        let output = question.ask(|_| is_complete).unwrap();
        (output, fs::read_to_string(folder.path().join("out")).unwrap_or_default())
    }

    fn kept(&self) -> Vec<std::path::PathBuf> {
        fs::read_dir(self.answers.path()).unwrap().map(|file| file.unwrap().path()).collect()
    }
}

/// Writes a file, and says something.
const WORK: &str = "tr a-z A-Z < in > out; echo said; echo warned >&2";

#[test]
fn the_same_question_is_asked_once() {
    let bench = Bench::new();
    let (first, out) = bench.ask("abc", WORK, false, true);
    let (second, again) = bench.ask("abc", WORK, false, true);
    assert_eq!((bench.runs(), out.as_str(), again.as_str()), (1, "ABC", "ABC"));
    assert_eq!((first.stdout, first.stderr), (second.stdout, second.stderr));
    assert!(second.status.success());
}

#[test]
fn a_changed_input_is_asked_anew() {
    let bench = Bench::new();
    bench.ask("abc", WORK, false, true);
    let (_, out) = bench.ask("abd", WORK, false, true);
    assert_eq!((bench.runs(), out.as_str()), (2, "ABD"));
    bench.ask("abc", &format!("{WORK} "), false, true);
    assert_eq!(bench.runs(), 3, "arguments are a part of the question");
}

#[test]
fn a_damaged_answer_is_asked_for_anew() {
    let bench = Bench::new();
    bench.ask("abc", WORK, false, true);
    let file = &bench.kept()[0];
    let mut bytes = fs::read(file).unwrap();
    let last = bytes.len() - 1;
    bytes[last] ^= 1;
    for damaged in [&bytes, &bytes[..last].to_vec(), &Vec::new()] {
        fs::write(file, damaged).unwrap();
        let before = bench.runs();
        assert_eq!(bench.ask("abc", WORK, false, true).1, "ABC");
        assert_eq!(bench.runs(), before + 1);
    }
    assert_eq!(bench.ask("abc", WORK, false, true).1, "ABC");
    assert_eq!(bench.runs(), 4, "the new answer is kept");
}

#[cfg(unix)]
#[test]
fn an_answer_that_others_can_write_is_not_used() {
    use std::os::unix::fs::PermissionsExt as _;
    let bench = Bench::new();
    bench.ask("abc", WORK, false, true);
    fs::set_permissions(&bench.kept()[0], fs::Permissions::from_mode(0o622)).unwrap();
    bench.ask("abc", WORK, false, true);
    assert_eq!(bench.runs(), 2);
}

#[test]
fn failures_and_incomplete_answers_are_not_kept() {
    let bench = Bench::new();
    for _ in 0..2 {
        assert_eq!(bench.ask("abc", "exit 3", false, true).0.status.code(), Some(3));
        bench.ask("abc", WORK, false, false);
        // What is in a folder of the folder would be lost.
        bench.ask("abc", "mkdir more", false, true);
    }
    assert_eq!((bench.runs(), bench.kept().len()), (6, 0));
}

#[test]
fn a_fresh_run_uses_no_kept_answer() {
    let bench = Bench::new();
    for is_fresh in [false, true, true] {
        bench.ask("abc", WORK, is_fresh, true);
    }
    assert_eq!(bench.runs(), 3);
}

#[test]
fn a_tool_that_is_not_there_is_an_error() {
    let answers = tempfile::tempdir().unwrap();
    let folder = tempfile::tempdir().unwrap();
    let none = Tool { name: "carrystep-no-such-tool", ..SH };
    let answers = Some(answers.path().to_owned());
    let question =
        Question { tool: &none, folder: folder.path(), arguments: &[], is_fresh: false, answers };
    assert_eq!(question.ask(|_| true).unwrap_err().kind(), std::io::ErrorKind::NotFound);
}

#[test]
fn answers_that_nothing_uses_are_removed() {
    let bench = Bench::new();
    bench.ask("abc", WORK, false, true);
    let now = SystemTime::now();
    remove_unused(bench.answers.path(), now);
    assert_eq!(bench.kept().len(), 1);
    remove_unused(bench.answers.path(), now + 2 * UNUSED);
    assert!(bench.kept().is_empty());
    remove_unused(Path::new("/no/such/folder"), now);
    assert!(files(Path::new("/no/such/folder")).is_err());
}

/// A simulation that counts how often it is run, and says what it is told to.
struct Simulation {
    bench: Bench,
    runs: std::cell::Cell<usize>,
}

impl Simulation {
    fn new() -> Self {
        Self { bench: Bench::new(), runs: std::cell::Cell::new(0) }
    }

    /// Compares its output with the expected one; the difference, and how often it has run.
    fn ask(&self, question: &str, expected: &[u8], output: &[u8]) -> (Option<String>, usize) {
        self.ask_anew(false, question, expected, output)
    }

    fn ask_anew(
        &self,
        is_fresh: bool,
        question: &str,
        expected: &[u8],
        output: &[u8],
    ) -> (Option<String>, usize) {
        let answers = Some(self.bench.answers.path());
        let run = || {
            self.runs.set(self.runs.get() + 1);
            Ok::<_, ()>((output != expected).then(|| format!("{output:?}")))
        };
        let found = difference_in(answers, is_fresh, &SH, question, expected, run);
        (found.unwrap(), self.runs.get())
    }
}

#[test]
fn simulation_with_known_output_is_not_repeated() {
    let simulation = Simulation::new();
    assert_eq!(simulation.ask("a", b"12", b"12"), (None, 1));
    assert_eq!(simulation.ask("a", b"12", b"12"), (None, 1));
    assert_eq!(simulation.ask_anew(true, "a", b"12", b"12"), (None, 2), "a fresh run");
    assert_eq!(simulation.ask("b", b"12", b"12"), (None, 3), "another question");
}

#[test]
fn simulation_is_repeated_if_another_output_is_expected() {
    let simulation = Simulation::new();
    simulation.ask("a", b"12", b"12");
    assert_eq!(simulation.ask("a", b"13", b"12"), (Some("[49, 50]".to_owned()), 2));
    assert_eq!(simulation.ask("a", b"12", b"12"), (None, 2), "it is still known");
    assert_eq!(simulation.ask("a", b"123", b"12").1, 3);
}

#[test]
fn difference_is_looked_for_each_time() {
    let simulation = Simulation::new();
    for run in 1..=2 {
        assert_eq!(simulation.ask("a", b"1", b"2"), (Some("[50]".to_owned()), run));
    }
    assert!(simulation.bench.kept().is_empty());
}

#[test]
fn damaged_hash_of_an_output_is_not_used() {
    let simulation = Simulation::new();
    simulation.ask("a", b"1", b"1");
    fs::write(&simulation.bench.kept()[0], "b").unwrap();
    assert_eq!(simulation.ask("a", b"1", b"1"), (None, 2));
    assert_eq!(simulation.ask("a", b"1", b"1"), (None, 2));
}
