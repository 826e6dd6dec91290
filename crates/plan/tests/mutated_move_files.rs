//! Whatever the text of a move file is, reading and planning it neither panics nor hangs, and a
//! refusal has a message.

use carrystep_files::{MoveFile, SourceText};
use carrystep_plan::plan;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use std::time::{Duration, Instant};

/// Every key of the guard.
const GUARD: &str = "[machine.guard]\nwatchdog_ms = 100\nenable_ms = 1\ndebounce_us = 500\nestop = \"low\"\nlimits = \"each\"\n\
                     limit_level = \"low\"\nlimit_stop = \"freeze\"\n";

/// The shipped machine with a guard, and the demo's moves, in one file without comments.
fn good() -> String {
    let moves =
        include_str!("../../../sim/demo.toml").replace("machine_file = \"six-axis.toml\"", "");
    let machine = include_str!("../../../sim/six-axis.toml").replacen(
        "[[machine.axis]]",
        &format!("{GUARD}[[machine.axis]]\nstop_accel = 5e3"),
        1,
    );
    // One axis is described by its mechanics.
    let screw = "lead = 8\nsteps_per_rev = 200\nmicrosteps = 16\nstart_speed_per_min = 0";
    let machine = machine.replacen("steps_per_unit = 400", screw, 1);
    let machine = machine.replacen("speed_limit = 30\n", "speed_limit_per_min = 1_800\n", 1);
    assert!(machine.contains("lead = ") && machine.contains("speed_limit_per_min"));
    let lines = machine.lines().chain(moves.lines());
    lines.map(|line| line.split('#').next().unwrap_or("")).collect::<Vec<_>>().join("\n")
}

/// A change of a file as made by a user, a bad disk or a faulty program.
#[derive(Debug, Clone)]
enum Mutation {
    Byte(Index, u8),
    CutOut(Index, usize),
    Insert(Index, &'static str),
    Number(Index, String),
    SwapTokens(Index, Index),
    RepeatLine(Index, usize),
    DropLine(Index),
}

/// Replaces a number by any kind of number that a file can hold.
fn number() -> impl Strategy<Value = Mutation> {
    const EXTREMES: [&str; 18] = [
        "nan",
        "-inf",
        "0",
        "-0.0",
        "-1",
        "1",
        "0.5",
        "1e-300",
        "1e9",
        "1e15",
        "1e29",
        "1e31",
        "1e300",
        "1e999999999",
        "1e-999999999",
        "2147483647.5",
        "0x7fffffffffffffff",
        "123456789012345678901234567890.123456789012345678901234567890",
    ];
    let number = prop_oneof![
        1 => select(&EXTREMES[..]).prop_map(str::to_owned),
        1 => any::<i64>().prop_map(|x| x.to_string()),
        8 => (1_i64..100_000, -12_i32..4).prop_map(|(digits, power)| format!("{digits}e{power}")),
        2 => (-100_000_i64..100_000, 0_usize..3).prop_map(|(x, zeros)| format!("{x}.{}5", "0".repeat(zeros))),
    ];
    (any::<Index>(), number).prop_map(|(at, number)| Mutation::Number(at, number))
}

fn mutation() -> impl Strategy<Value = Mutation> {
    const PIECES: [&str; 16] = [
        "\n",
        " = ",
        "[",
        "]]",
        "{",
        "}",
        ",",
        "\"",
        "#",
        ".",
        "\u{0}",
        "\u{feff}",
        "\u{17c}",
        "[[move]]\n",
        "[[machine.axis]]\n",
        "machine_file = \".\"\n",
    ];
    let at = any::<Index>;
    prop_oneof![
        3 => number(),
        1 => (at(), any::<u8>()).prop_map(|(at, byte)| Mutation::Byte(at, byte)),
        1 => (at(), 1_usize..40).prop_map(|(at, length)| Mutation::CutOut(at, length)),
        1 => (at(), select(&PIECES[..])).prop_map(|(at, piece)| Mutation::Insert(at, piece)),
        1 => (at(), at()).prop_map(|(one, other)| Mutation::SwapTokens(one, other)),
        1 => (at(), 1_usize..4).prop_map(|(at, times)| Mutation::RepeatLine(at, times)),
        1 => at().prop_map(Mutation::DropLine),
    ]
}

/// The ranges of a text that consist only of such characters.
fn pieces(text: &str, of: impl Fn(char) -> bool) -> Vec<(usize, usize)> {
    let mut found = Vec::new();
    let mut from = None;
    for (at, c) in text.char_indices().chain([(text.len(), '\0')]) {
        match (from, at < text.len() && of(c)) {
            (None, true) => from = Some(at),
            (Some(start), false) => {
                found.push((start, at));
                from = None;
            }
            _ => {}
        }
    }
    found
}

impl Mutation {
    fn apply(self, text: &str) -> String {
        let numbers = || {
            let mut found = pieces(text, |c| c.is_ascii_alphanumeric() || "+-._".contains(c));
            found.retain(|&(from, to)| {
                text[from..to].starts_with(|c: char| c.is_ascii_digit() || c == '-')
            });
            found
        };
        let lines = || pieces(text, |c| c != '\n');
        let replaced = |(from, to): (usize, usize), new: &str| {
            format!("{}{new}{}", &text[..from], &text[to..])
        };
        match self {
            Self::Byte(at, byte) => {
                let mut bytes = text.as_bytes().to_vec();
                if !bytes.is_empty() {
                    let at = at.index(bytes.len());
                    bytes[at] = byte;
                }
                String::from_utf8_lossy(&bytes).into_owned()
            }
            Self::CutOut(at, length) => {
                let at = at.index(text.len() + 1);
                let rest = &text.as_bytes()[(at + length).min(text.len())..];
                String::from_utf8_lossy(&[&text.as_bytes()[..at], rest].concat()).into_owned()
            }
            Self::Insert(at, piece) => {
                let at = at.index(text.len() + 1);
                let (before, after) = text.as_bytes().split_at(at);
                String::from_utf8_lossy(&[before, piece.as_bytes(), after].concat()).into_owned()
            }
            Self::Number(at, number) if !numbers().is_empty() => {
                replaced(*at.get(&numbers()), &number)
            }
            Self::SwapTokens(one, other) => {
                let tokens = pieces(text, |c| !c.is_whitespace());
                if tokens.is_empty() {
                    return text.to_owned();
                }
                let (one, other) = (*one.get(&tokens), *other.get(&tokens));
                let (first, second) = (one.min(other), one.max(other));
                let swapped = replaced(second, &text[first.0..first.1]);
                format!(
                    "{}{}{}",
                    &swapped[..first.0],
                    &text[second.0..second.1],
                    &swapped[first.1..]
                )
            }
            Self::RepeatLine(at, times) if !lines().is_empty() => {
                let (from, to) = *at.get(&lines());
                replaced((to, to), &format!("\n{}", &text[from..to]).repeat(times))
            }
            Self::DropLine(at) if !lines().is_empty() => replaced(*at.get(&lines()), ""),
            _ => text.to_owned(),
        }
    }
}

/// Reads and plans a text within a second; returns the result as a message.
fn read_and_plan(text: &str) -> Result<String, TestCaseError> {
    let started = Instant::now();
    let source = SourceText { path: "mutated.toml".into(), text: text.into() };
    let said = match MoveFile::from_source(source) {
        Err(error) => {
            if let Some((_, span)) = &error.place {
                prop_assert!(text.get(span.clone()).is_some(), "{span:?} is no part of\n{text}");
            }
            error.to_string()
        }
        Ok(file) => match plan::<f64>(&file) {
            Err(error) => error.to_string(),
            Ok(plan) => format!("{} ticks", plan.total_ticks()),
        },
    };
    let took = started.elapsed();
    prop_assert!(took < Duration::from_secs(1), "{took:?} for\n{text}");
    Ok(said)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5_000))]

    #[test]
    fn mutated_move_file_is_planned_or_refused_with_a_message(mutations in vec(mutation(), 1..6)) {
        let text = mutations.into_iter().fold(good(), |text, mutation| mutation.apply(&text));
        prop_assert!(!read_and_plan(&text)?.is_empty());
    }

    #[test]
    fn any_numbers_are_planned_or_refused_by_a_limit(mutations in vec(number(), 1..4)) {
        let text = mutations.into_iter().fold(good(), |text, mutation| mutation.apply(&text));
        let said = read_and_plan(&text)?;
        prop_assert!(!said.contains("please report"), "{said}\n{text}");
    }
}
