//! `docs/gcode.md` lists exactly the codes that are done, and those that are refused with a reason.

use crate::support::steps;
use carrystep_gcode::{DEFAULT_BLOCKS, ErrorKind};
use std::collections::BTreeSet;

/// What the interpreter makes of a code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Fate {
    Done,
    Refused,
    Unknown,
}

fn fate(code: &str) -> Fate {
    match steps(code) {
        Err(error) => match error.kind {
            ErrorKind::UnknownCode(_) => Fate::Unknown,
            ErrorKind::NotDone { .. } => Fate::Refused,
            // The code is known, and needs words that are not here.
            _ => Fate::Done,
        },
        Ok(_) => Fate::Done,
    }
}

/// All codes of this fate, as `G38.2`.
fn codes(wanted: Fate) -> BTreeSet<String> {
    let tenths = |letter: char| {
        (0..10_000).map(move |tenths: u32| match (tenths / 10, tenths % 10) {
            (whole, 0) => format!("{letter}{whole}"),
            (whole, tenth) => format!("{letter}{whole}.{tenth}"),
        })
    };
    tenths('G').chain(tenths('M')).filter(|code| fate(code) == wanted).collect()
}

/// The codes in backticks in the tables of a section, `M100` to `M199` one by one.
fn section(title: &str) -> BTreeSet<String> {
    let page = include_str!("../../../docs/gcode.md");
    let (_, rest) = page.split_once(&format!("\n## {title}\n")).expect("a section");
    let section = rest.split("\n## ").next().unwrap_or(rest);
    let mut found = BTreeSet::new();
    for row in section.lines().filter(|line| line.starts_with("| ")) {
        let cell = row.split('|').nth(1).unwrap_or_default();
        let names: Vec<&str> = row.split('`').skip(1).step_by(2).collect();
        let is_code = |name: &&&str| {
            let number = name.strip_prefix(['G', 'M']);
            number.is_some_and(|number| number.parse::<f64>().is_ok())
        };
        let codes: Vec<&str> = names.iter().filter(is_code).copied().collect();
        if let ([first, last], true) = (&codes[..], cell.contains("` to `")) {
            let number = |code: &str| code[1..].parse::<u32>().expect("a whole number");
            found.extend((number(first)..=number(last)).map(|n| format!("{}{n}", &first[..1])));
        } else {
            found.extend(codes.into_iter().map(str::to_owned));
        }
    }
    found
}

#[test]
fn the_page_lists_the_codes_that_are_done() {
    assert_eq!(section("Codes that are done"), codes(Fate::Done));
}

#[test]
fn the_page_lists_the_codes_that_are_refused_with_a_reason() {
    assert_eq!(section("What is refused"), codes(Fate::Refused));
}

#[test]
fn the_example_of_an_error_is_that_of_the_interpreter() {
    let page = include_str!("../../../docs/gcode.md");
    let error = steps(&("\n".repeat(11) + "F1 G2 X10 I4.9")).expect_err("an arc").to_string();
    let example = error.replace("p.ngc:12:4", "job.ngc:12:1");
    assert!(page.contains(&example), "{example}");
}

#[test]
fn the_page_gives_the_limits_of_the_code() {
    let page = include_str!("../../../docs/gcode.md");
    let limit = |text: &str| match steps(text).map_err(|error| error.kind) {
        Err(ErrorKind::LineTooLong(most)) => most as u64,
        Err(ErrorKind::TooManyCalls(most)) => most as u64,
        other => panic!("{other:?}"),
    };
    let bytes = limit(&"x".repeat(1_000_000));
    let grouped = format!("{} {:03}", bytes / 1000, bytes % 1000);
    let calls = limit("o1 sub\no1 call\no1 endsub\no1 call");
    for said in [
        format!("A line has at most {grouped} bytes."),
        format!("Calls may be {calls} deep."),
        format!("subroutines may run {} million lines again", DEFAULT_BLOCKS / 1_000_000),
    ] {
        assert!(page.replace('\n', " ").contains(&said), "{said}");
    }
}
