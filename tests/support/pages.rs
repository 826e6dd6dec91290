//! Pages of the documentation as text, and numbers as the pages write them.

use crate::moves;
use std::fs;

/// The text of a file of this repository, `docs/engine.md` for example.
///
/// # Panics
/// If the file cannot be read.
pub fn file(name: &str) -> String {
    fs::read_to_string(moves::root().join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// A page in one line, so that a sentence is found wherever its lines break.
pub fn joined(name: &str) -> String {
    file(name).split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Asserts that a page says each of these texts, wherever its lines break.
///
/// # Panics
/// If it does not.
#[track_caller]
pub fn says(name: &str, texts: &[String]) {
    let page = joined(name);
    for text in texts {
        assert!(page.contains(text.as_str()), "{name} does not say: {text}");
    }
}

/// A whole number in groups of three digits.
pub fn grouped(number: u64) -> String {
    let digits = number.to_string();
    let groups =
        digits.as_bytes().rchunks(3).rev().map(|group| String::from_utf8_lossy(group).into_owned());
    groups.collect::<Vec<_>>().join(" ")
}

/// A whole number in words.
///
/// # Panics
/// If the pages write it in digits.
pub fn word(number: u64) -> &'static str {
    const WORDS: [&str; 21] = [
        "none",
        "one",
        "two",
        "three",
        "four",
        "five",
        "six",
        "seven",
        "eight",
        "nine",
        "ten",
        "eleven",
        "twelve",
        "thirteen",
        "fourteen",
        "fifteen",
        "sixteen",
        "seventeen",
        "eighteen",
        "nineteen",
        "twenty",
    ];
    match number {
        0..=20 => WORDS[number as usize],
        32 => "thirty-two",
        _ => panic!("{number} has no word"),
    }
}

/// One of so many equal parts, in words.
///
/// # Panics
/// If the pages do not write it so.
pub fn part(number: u64) -> &'static str {
    match number {
        2 => "half",
        3 => "third",
        4 => "quarter",
        5 => "fifth",
        _ => panic!("one of {number} parts has no word"),
    }
}
