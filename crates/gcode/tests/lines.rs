//! Lines one by one give what the same lines give as a program, and a mistake changes nothing.

use carrystep_gcode::{Canon, ErrorKind, Interpreter, LineInterpreter, Options};
use proptest::prelude::*;
use std::io::Cursor;
use std::path::Path;

type Steps = Vec<(u64, Canon)>;

fn plain(canon: &Canon) -> bool {
    !matches!(canon, Canon::Comment(_))
}

/// The steps of a program, without those that its end gives.
fn whole(text: &str) -> Steps {
    let lines = text.lines().count() as u64;
    let mut program = Interpreter::new(Cursor::new(text), "whole", &Options::default()).unwrap();
    let steps = std::iter::from_fn(|| program.step_before(lines + 1));
    let steps = steps.map(Result::unwrap).map(|step| (step.line, step.canon));
    steps.filter(|(_, canon)| plain(canon)).collect()
}

fn one_by_one(text: &str) -> Steps {
    let mut lines = LineInterpreter::new("lines", &Options::default());
    let steps = text.lines().flat_map(|line| lines.execute(line).unwrap());
    steps.map(|step| (step.line, step.canon)).collect()
}

#[test]
fn lines_of_programs_give_what_the_programs_give() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/jobs");
    let mut tried = 0;
    for file in std::fs::read_dir(folder).unwrap().flatten() {
        if file.path().extension().is_some_and(|ending| ending == "ngc") {
            let text = std::fs::read_to_string(file.path()).unwrap();
            let has_o = |line: &str| line.trim_start().to_lowercase().starts_with('o');
            if !text.lines().any(has_o) {
                // Behind the end, lines of a sender go on, and those of a program do not.
                assert_eq!(one_by_one(&text), whole(&text), "{:?}", file.path());
                tried += 1;
            }
        }
    }
    assert!(tried >= 2);
}

/// A word, a line of words, and mistakes.
fn line() -> impl Strategy<Value = String> {
    let words = prop::sample::select(
        &[
            "G0",
            "G1",
            "G90",
            "G91",
            "G20",
            "G21",
            "X1",
            "Y-2.5",
            "Z0.1",
            "F100",
            "F0",
            "M3 S100",
            "M5",
            "G92 X0",
            "G54",
            "G55",
            "G10 L2 P1 X1",
            "#1=2",
            "X#1",
            "G2 X1 Y1 R5",
            "G81 Z-1 R1",
            "G80",
            "G4 P0.1",
            "G43.1 Z1",
            "o1 sub",
            "G38.2 Z-1",
            "X",
            "G",
            "(",
            "G0 G1",
            "M2",
            "N5",
            "G93",
            "T1 M6",
        ][..],
    );
    prop::collection::vec(words, 0..4).prop_map(|words| words.join(" "))
}

proptest! {
    #[test]
    fn mistake_changes_nothing(lines in prop::collection::vec(line(), 1..20)) {
        let mut one = LineInterpreter::new("lines", &Options::default());
        // The same without the lines that are refused.
        let mut other = LineInterpreter::new("lines", &Options::default());
        for line in lines {
            let Ok(steps) = one.execute(&line) else { continue };
            let canons = |steps: Vec<carrystep_gcode::Step>| -> Vec<Canon> {
                steps.into_iter().map(|step| step.canon).collect()
            };
            prop_assert_eq!(canons(steps), canons(other.execute(&line).unwrap()));
            prop_assert_eq!(one.place(), other.place());
            prop_assert_eq!(one.modes(), other.modes());
            prop_assert_eq!(one.offsets(), other.offsets());
            // Executed and undone, or aside, it changes no mode.
            let (modes, offsets) = (one.modes(), one.offsets());
            if one.execute("G20 G91 G55 F7 G92 X3").is_ok() {
                one.undo();
            }
            let place = one.place();
            if one.execute_aside("G20 G91 F7 G1 X0").is_ok() {
                one.undo();
            }
            prop_assert_eq!((one.modes(), one.offsets(), one.place()), (modes, offsets, place));
        }
    }

    #[test]
    fn no_line_makes_it_panic(text in "\\PC{0,60}") {
        let mut lines = LineInterpreter::new("lines", &Options::default());
        let _ = lines.execute(&text);
        prop_assert!(lines.execute("G0 X1").is_ok());
    }
}

#[test]
fn o_word_is_refused_with_its_line() {
    let mut lines = LineInterpreter::new("lines", &Options::default());
    lines.execute("G0 X1").unwrap();
    for text in ["o1 sub", "o1 call", "o1 if [1]", "M98 P1", "M99", "o1 while [1]"] {
        let before = lines.lines();
        let error = lines.execute(text).unwrap_err();
        assert_eq!(error.line, before + 1, "{text}: {error}");
    }
    let error = lines.execute(&format!("({})", "x".repeat(100_000))).unwrap_err();
    assert!(matches!(error.kind, ErrorKind::LineTooLong(_)), "{error}");
}
