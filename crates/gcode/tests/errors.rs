//! Each mistake is refused at its line and column, with a remedy.

use crate::support::{self, steps};
use carrystep_gcode::{Canon, ErrorKind, GcodeError, Interpreter, Options};
use std::io::Cursor;

/// Asserts that programs are refused at these places with messages that contain these words.
fn assert_refused(cases: &[(&str, &str, &str)]) {
    for (text, place, words) in cases {
        let error = match steps(text) {
            Err(error) => error,
            Ok(steps) => panic!("not refused: {text}\n{steps:?}"),
        };
        let shown = error.to_string();
        assert!(shown.starts_with(&format!("p.ngc:{place}: ")), "{place} {words}: {shown}\n{text}");
        assert!(shown.contains(words), "{words}: {shown}\n{text}");
        assert!(!error.kind.help().is_empty());
    }
}

#[test]
fn malformed_lines_are_refused_at_the_column_of_the_mistake() {
    assert_refused(&[
        ("G0 X1\nG0 X(a", "2:5", "comment is not closed"),
        ("G0 (a (b))", "1:7", "parenthesis inside a comment"),
        ("G0 X1 =", "1:7", "expected a word, as in X1.5, found `=`"),
        ("G0 X", "1:5", "expected a value, found the end of the line"),
        ("G0 X1.2.3", "1:5", "`1.2.3` is no number"),
        ("G0 X.", "1:5", "`.` is no number"),
        ("(ä) G0 X[1+", "1:12", "expected a value"),
        ("G0 X[1+2", "1:9", "an operator or `]`"),
        ("G0 X[1 foo 2]", "1:8", "an operator or `]`, found `foo2]`"),
        ("#1 5", "1:5", "`=` and a value"),
        ("G0 X#<a", "1:8", "`>` after a name"),
        ("G0 X atan[1]", "1:13", "`/` and the second value"),
        ("G0 X1 N5", "1:7", "line number at the beginning"),
        ("G0 X1 o1 if [1]", "1:7", "O-word at the beginning"),
        ("G0 X\u{0}1", "1:5", "byte 0x00 outside of a comment"),
        ("G0 ż", "1:4", "byte 0xc5 outside of a comment"),
    ]);
    let deep = format!("G0 X{}1{}", "[".repeat(1000), "]".repeat(1000));
    assert_refused(&[
        (&deep, "1:45", "nested more than 40 deep"),
        (&format!("G0 X{}1", "#".repeat(1000)), "1:45", "nested more than 40 deep"),
        (&format!("G0 X{}1", "-".repeat(1000)), "1:45", "nested more than 40 deep"),
        (&format!("G0 X{}", "9".repeat(400)), "1:5", "too great"),
    ]);
}

#[test]
fn a_sum_of_thousands_of_values_is_computed() {
    let text = format!("G0 X[0{}]", "+1".repeat(20_000));
    assert_eq!(support::xs(&text), [20_000.0]);
}

#[test]
fn files_that_are_no_programs_are_refused() {
    let long = "x".repeat(100_000);
    assert_refused(&[
        (&format!("G0 X1\n{long}\n"), "2", "longer than 65536 bytes"),
        ("\u{7f}ELF\u{2}\u{1}", "1:1", "byte 0x7f"),
        ("#!/bin/sh\necho", "1:2", "a value"),
        ("{\"a\": 1}", "1:1", "expected a word"),
    ]);
}

#[test]
fn o_words_without_beginning_or_end_are_refused_before_the_first_line_is_executed() {
    let opened = |text: &str| {
        Interpreter::new(Cursor::new(text.to_owned()), "p.ngc", &Options::default()).map(|_| ())
    };
    let cases = [
        ("G0 X1\no1 while [1]\nG0 X2", "2:1", "`o1 while` is never closed"),
        ("o<a> sub\nG0 X1", "1:1", "`o<a> sub` is never closed"),
        ("o1 if [1]\no2 endif", "2:4", "the innermost open block is `o1 if` in line 1"),
        ("o1 endwhile", "1:4", "no block is open"),
        ("o1 if [1]\no1 else\no1 elseif [1]\no1 endif", "3:4", "no beginning"),
        ("o1 if [1]\no1 endwhile", "2:4", "no beginning"),
        ("o1 break", "1:4", "no beginning"),
        ("o1 return", "1:4", "no beginning"),
        ("o1 repeat [3]\no2 continue\no1 endrepeat", "2:4", "no beginning"),
        ("o1 sub\no1 endsub\no1 sub\no1 endsub", "3:4", "already in line 1"),
        ("o1 sub\no2 sub\no2 endsub\no1 endsub", "2:4", "inside of `o1`"),
        ("o#1 if [1]\n", "1:5", "a computed label before `if`"),
        ("o1 foo", "1:4", "expected an O-word"),
        ("O7\nM2\nO07\nM99", "3:4", "subroutine `o7` is already in line 1"),
        ("o1 while [0]\nO7\no1 endwhile", "2:3", "inside of `o1`"),
        ("O#1\n", "1:4", "a computed label"),
        ("ox", "1:2", "a label after O"),
        ("o1 if", "1:6", "a value in brackets"),
        ("o1 if [1] G0", "1:11", "nothing more after an O-word"),
    ];
    for (text, ..) in cases {
        assert!(opened(text).is_err(), "{text}");
    }
    assert_refused(&cases);
}

#[test]
fn structures_without_bound_are_refused() {
    let calls = "o1 sub\no1 endsub\n".to_owned() + &"o1 call\n".repeat(100_000);
    let names: String = (0..10_001).map(|n| format!("#<a{n}>=1\n")).collect();
    assert_refused(&[
        (&"o1 if [1]\n".repeat(101), "101:4", "blocks are nested more than 100 deep"),
        (&calls, "100001:4", "more than 100000 O-words"),
        (&names, "10001", "more than 10000 named parameters"),
    ]);
}

#[test]
fn numbers_that_would_overflow_are_refused() {
    let huge = "9".repeat(300);
    assert_refused(&[
        (&format!("F{huge}"), "1:1", "out of its range"),
        ("F0.0000000001", "1:1", "out of its range"),
        (&format!("G93 G1 X1 F0.{}1", "0".repeat(300)), "1:11", "out of its range"),
        (&format!("S{huge}"), "1:1", "out of its range"),
        (&format!("G64 P{huge}"), "1:5", "out of its range"),
        (&format!("F1\nG2 X1 I{huge}"), "2:4", "over 1000000000 from machine zero"),
        (&format!("F1\nG2 X1 R{huge}"), "2:4", "over 1000000000 from machine zero"),
        (&format!("G20\nF1\nG2 X1 R{huge}00000000"), "3:4", "over 1000000000 from machine zero"),
        (&format!("F1 G81 X1 Z-{huge} R1"), "1:11", "over 1000000000 from machine zero"),
        (&format!("#5221={huge}00000000 #5211={huge}00000000 #5210=1\nG54 G0 X1"), "2:8", "over"),
        (&format!("G10 L2 P1 X{huge}"), "1:11", "over 1000000000 from machine zero"),
        (&format!("G92 X-{huge}"), "1:5", "over 1000000000 from machine zero"),
        (&format!("G43.1 Z{huge}"), "1:7", "over 1000000000 from machine zero"),
    ]);
}

#[test]
fn values_that_are_not_defined_are_refused() {
    assert_refused(&[
        ("G0 X#<a>", "1:5", "#<a> has no value yet"),
        ("G0 X[1 / 0]", "1:8", "division by zero"),
        ("G0 X[1 mod 0]", "1:8", "division by zero"),
        ("G0 X sqrt[-1]", "1:6", "SQRT of -1 is not defined"),
        ("G0 X asin[2]", "1:6", "ASIN of 2"),
        ("G0 X ln[0]", "1:6", "LN of 0"),
        ("G0 X[-8 ** 0.5]", "1:9", "a broken power of -8"),
        ("G0 X[10 ** 400]", "1:9", "too great"),
        ("#0 = 1", "1:2", "no parameter #0"),
        ("#5603 = 1", "1:2", "no parameter #5603"),
        ("#1.5 = 1", "1:2", "no parameter #1.5"),
        ("#5420 = 1", "1:1", "can only be read"),
        ("#<_x> = 1", "1:1", "#<_x> can only be read"),
        ("o1 call", "1:4", "the file has no `o1 sub`"),
    ]);
}

#[test]
fn words_that_are_unknown_useless_or_missing_are_refused() {
    assert_refused(&[
        ("G0 U1", "1:4", "U is no word"),
        ("G0 @1 ^45 X1", "1:4", "polar coordinates and X or Y"),
        ("G18 G0 ^45 @1", "1:12", "polar coordinates in G18"),
        ("G0 @1", "1:4", "without an angle to start from"),
        ("G91 G0 @1 ^45", "1:8", "without an angle to start from"),
        ("G92 @1", "1:1", "G92 needs the coordinate"),
        ("G53 G0 X1 @1", "1:11", "nothing in this line uses @"),
        ("G0 X1 X2", "1:7", "X occurs twice"),
        ("G12 X1", "1:1", "G12 is unknown"),
        ("G17.55", "1:1", "G17.55 is unknown"),
        ("M123456", "1:1", "M123456 is unknown"),
        ("G-1", "1:1", "G-1 is unknown"),
        ("G0 D1 X1", "1:4", "D is no word"),
        ("G41", "1:1", "G41: cutter compensation"),
        ("G33 Z1 K1", "1:1", "G33: motion in step with the spindle"),
        ("G76", "1:1", "G76: a threading cycle"),
        ("G95", "1:1", "G95: feed per turn"),
        ("G96", "1:1", "G96: constant surface speed"),
        ("G43 Z1", "1:1", "G43 without a tool table"),
        ("G0 G1 X1", "1:4", "G0 and G1 exclude each other"),
        ("M7 M8", "1:4", "M7 and M8 exclude each other"),
        ("M3 M5", "1:4", "M3 and M5 exclude each other"),
        ("G1 G92 X1", "1:1", "G92 and G1 both use the axis words"),
        ("G43.1 G0 Z1", "1:7", "G43.1 and G0 both use the axis words"),
        ("G0 X1 P2", "1:7", "nothing in this line uses P"),
        ("G17 R1", "1:5", "nothing in this line uses R"),
        ("X1", "1:1", "axis words without a G code"),
        ("G0 X1\nG80\nX2", "3:1", "axis words without a G code"),
        ("G4", "1:1", "G4 needs P"),
        ("G4 P-1", "1:4", "P is -1, out of its range"),
        ("G92", "1:1", "G92 needs the coordinate"),
        ("G10 P1 X1", "1:1", "G10 needs L1, L2, L10 or L20"),
        ("G10 L3 P1 X1", "1:5", "L is 3, out of its range"),
        ("G10 L2 P10 X1", "1:8", "P is 10, out of its range"),
        ("M62 P1.5", "1:5", "P is 1.5, which is not a whole number"),
        ("M66", "1:1", "M66 needs P or E"),
        ("M66 P1 E1", "1:5", "nothing in this line uses P"),
        ("M66 P256", "1:5", "P is 256"),
        ("M66 P1 L5", "1:8", "L is 5"),
        ("M66 P1 L3", "1:1", "M66 needs Q"),
        ("M66 P1 L3 Q0", "1:11", "Q is 0"),
        ("M66 E1 L3 Q1", "1:8", "waits for an analog input"),
        ("T-1", "1:1", "T is -1, out of its range"),
        ("S-1", "1:1", "S is -1"),
        ("G53 G2 X1 I1", "1:1", "G53 with G2"),
        ("G91 G53 G0 X1", "1:5", "G53 with incremental"),
        ("G0 X1000000001", "1:4", "over 1000000000 from machine zero"),
    ]);
}

#[test]
fn feed_moves_need_a_feed_above_zero() {
    assert_refused(&[
        ("G1 X1", "1:1", "G1 without a feed"),
        ("F0\nG1 X1", "2:1", "G1 with a feed of 0"),
        ("F-1", "1:1", "F is -1"),
        ("G2 X1 I0.5", "1:1", "G2 without a feed"),
        ("G38.2 X1", "1:1", "G38.2 without a feed"),
        ("G81 Z-1 R1", "1:1", "G81 without a feed"),
        ("G93 G1 X1", "1:5", "G1 in inverse time (G93) without F"),
        ("G93 G1 X1 F1\nX2", "2:1", "without F in its line"),
        ("F1 G93\nG1 X1 F1\nG94 G1 X2", "3:5", "G1 without a feed"),
        ("F1\nG93\nG1 X1 F1\nG94 G1 X2", "4:5", "G1 without a feed"),
        ("G93 F1 G81 X1 Z-1 R1", "1:8", "G81 in inverse time"),
        ("G93 F1 G38.2 X1", "1:8", "G38.2 in inverse time"),
        ("G20 F10", "1:5", "changes the units"),
    ]);
}

#[test]
fn arcs_that_do_not_meet_are_refused_with_the_distance() {
    assert_refused(&[
        ("F1\nG2 X10 I4.9", "2:1", "4.900000 mm at its start and 5.100000 mm at its end, 0.200000"),
        ("G20\nF1\nG2 X1 I0.4", "3:1", "10.160000 mm at its start and 15.240000 mm"),
        ("F1 G2 X10 R4.9", "1:4", "its diameter is 9.800000 mm, its ends are 10.000000 mm apart"),
        ("F1 G2 X0 Y0 R5", "1:4", "ends where it starts"),
        ("F1 G2 I0 J0", "1:4", "radius of 0"),
        ("F1 G2 X1", "1:4", "G2 needs the centre"),
        ("F1 G2 X1 K1", "1:4", "G2 needs the centre"),
        ("F1 G90.1 G2 X1 I1", "1:10", "both coordinates"),
        ("F1 G2 I1 P0", "1:10", "P is 0"),
        ("F1 G2 I1 K1", "1:10", "uses K"),
        ("G10 L2 P1 R30\nF1 G18 G2 X1 I0.5", "2:8", "rotated"),
        ("F1 G81 X1 Z3 R2", "1:4", "1.000000 mm above R"),
        ("F1 G81 X1 Z3", "1:4", "G81 needs R"),
        ("F1 G83 X1 Z-3 R1 Q0", "1:18", "Q is 0"),
        ("F1 G81 X1 Z-3 R1 L0", "1:18", "L is 0"),
        ("F1 G38.2 X0", "1:4", "no length"),
    ]);
}

/// Reads a program with a limit of 10 000 lines that run again.
fn with_limit(text: &str) -> GcodeError {
    let options = Options { blocks: 10_000, ..Options::default() };
    let program = Interpreter::new(Cursor::new(text.to_owned()), "p.ngc", &options);
    match program.map(Iterator::last) {
        Ok(Some(Err(error))) => error,
        other => panic!("{other:?}"),
    }
}

#[test]
fn programs_without_end_are_refused() {
    let texts = [
        "o1 while [1]\no1 endwhile",
        "o1 do\no1 while [1]",
        "o1 repeat [1000000000]\nG4 P0\no1 endrepeat",
        "F1 G91 G81 X0 Z-1 R1 L1000000000",
        "F1 G83 X0 Z-1000000 R1 Q0.0000001",
        "F1 G83 X0 Z-1 R1 Q0.00000000000000000000000000000001",
    ];
    for text in texts {
        let error = with_limit(text);
        assert_eq!(error.kind, ErrorKind::TooManyBlocks(10_000), "{text}");
    }
    let error = with_limit("o1 sub\no1 call\no1 endsub\no1 call");
    assert_eq!((error.line, error.kind), (2, ErrorKind::TooManyCalls(100)));
}

#[test]
fn the_limit_does_not_count_lines_that_run_once() {
    let options = Options { blocks: 10, ..Options::default() };
    let text = "G4 P1\n".repeat(1000) + "o1 repeat [3]\nG4 P1\no1 endrepeat";
    let program = Interpreter::new(Cursor::new(text), "p.ngc", &options).unwrap();
    assert_eq!(program.filter(Result::is_ok).count(), 1004);
}

#[test]
fn a_file_that_changes_while_it_is_read_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("job.ngc");
    std::fs::write(&path, "G0 X1\nX2\nX3\n").unwrap();
    let mut program = Interpreter::open(&path, &Options::default()).unwrap();
    assert!(matches!(program.next(), Some(Ok(step)) if step.line == 1));
    std::fs::write(&path, "G0 X1\nX2\nX3\nX4\n").unwrap();
    let rest: Vec<_> = program.collect();
    let last = rest.last().unwrap().as_ref().unwrap_err();
    assert_eq!(last.kind, ErrorKind::Changed);
    assert!(rest.iter().flatten().all(|step| step.canon != Canon::End));
}

#[test]
fn a_change_of_the_file_is_noticed_after_a_thousand_lines_or_at_the_next_stop() {
    let text = |begin: &str| begin.to_owned() + &"G4 P1\n".repeat(5_000);
    for (begin, most) in [("G4 P1\n", 1_001), ("G4 P1\nM0\n", 1)] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("job.ngc");
        std::fs::write(&path, text(begin)).unwrap();
        let mut program = Interpreter::open(&path, &Options::default()).unwrap();
        assert!(program.next().unwrap().is_ok());
        std::fs::write(&path, text(begin) + "G4 P2\n").unwrap();
        let steps = program.by_ref().take_while(Result::is_ok).count();
        assert!(steps <= most, "{steps}");
        assert!(program.next().is_none());
    }
}

#[test]
fn files_that_cannot_be_read_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for path in [folder.path().join("none.ngc"), folder.path().to_owned(), "/dev/zero".into()] {
        let error = Interpreter::open(&path, &Options::default()).unwrap_err();
        assert!(matches!(error.kind, ErrorKind::Unreadable(_)), "{error}");
        assert!(error.to_string().starts_with(&format!("{}: cannot read", path.display())));
    }
}
