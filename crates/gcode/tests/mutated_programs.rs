//! No text whatever makes the interpreter panic or run without end.

use crate::support::{jobs, programs, tools};
use carrystep_gcode::{Canon, Interpreter, Options};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{Index, select};
use std::io::Cursor;
use std::sync::OnceLock;

/// Most lines of a program that are mutated: the long jobs repeat themselves.
const LINES: usize = 120;

/// Lines that may run again before a program counts as one without end.
const BLOCKS: u64 = 2_000;

/// Our jobs and the programs of the tests, cut to their first lines.
fn originals() -> &'static [String] {
    static ORIGINALS: OnceLock<Vec<String>> = OnceLock::new();
    ORIGINALS.get_or_init(|| {
        let paths = [jobs(), programs()].concat();
        assert!(paths.len() >= 10, "programs are missing: {paths:?}");
        let read = |path| std::fs::read_to_string(path).expect("a program");
        let cut = |text: String| text.lines().take(LINES).map(|l| l.to_owned() + "\n").collect();
        paths.into_iter().map(read).map(cut).collect()
    })
}

/// A change of a text.
#[derive(Debug, Clone)]
enum Mutation {
    Byte(Index, u8),
    CutOut(Index, usize),
    Insert(Index, &'static str),
    Number(Index, &'static str),
    SwapLines(Index, Index),
    RepeatLine(Index, usize),
    DropLine(Index),
    Join(Index),
}

const NUMBERS: [&str; 16] = [
    "0",
    "-0",
    "1e9",
    "-1",
    ".",
    "-.",
    "1.2.3",
    "99999999999999999999",
    "0.0000000001",
    "-5",
    "[0/0]",
    "#1",
    "##1",
    "#<x>",
    "+7",
    "1000000000",
];

const PIECES: [&str; 52] = [
    "(",
    ")",
    ";",
    "[",
    "]",
    "%\n",
    "/",
    "#",
    "#<",
    ">",
    "=",
    "o",
    "o1",
    "o100 sub\n",
    "o100 endsub\n",
    "o100 call [1]\n",
    "o1 while [1]\n",
    "o1 endwhile\n",
    "o1 do\n",
    "o1 repeat [1000000000]\n",
    "o1 endrepeat\n",
    "o1 if [1]\n",
    "o1 else\n",
    "o1 elseif [0]\n",
    "o1 endif\n",
    "o1 break\n",
    "o1 continue\n",
    "o1 return\n",
    "M2\n",
    "O7\n",
    "M98 P7 L3\n",
    "M98 P7 L1000000000\n",
    "M99\n",
    "G43 H1",
    "G43.2 H1",
    "G10 L10 P1",
    "T1 M6",
    "G83",
    "L1000000000",
    "P1000000000",
    "Q0.000000001",
    "G91",
    "G93",
    "G20",
    "G92",
    "G10 L20 P1 R1",
    "ATAN[",
    "]/[",
    "EXISTS[",
    "\u{0}",
    "\u{feff}",
    "ż",
];

fn mutation() -> impl Strategy<Value = Mutation> {
    let at = any::<Index>;
    prop_oneof![
        (at(), any::<u8>()).prop_map(|(at, byte)| Mutation::Byte(at, byte)),
        (at(), 1_usize..30).prop_map(|(at, length)| Mutation::CutOut(at, length)),
        (at(), select(&PIECES[..])).prop_map(|(at, piece)| Mutation::Insert(at, piece)),
        (at(), select(&NUMBERS[..])).prop_map(|(at, number)| Mutation::Number(at, number)),
        (at(), at()).prop_map(|(one, other)| Mutation::SwapLines(one, other)),
        (at(), 1_usize..4).prop_map(|(at, times)| Mutation::RepeatLine(at, times)),
        at().prop_map(Mutation::DropLine),
        at().prop_map(Mutation::Join),
    ]
}

impl Mutation {
    fn apply(&self, mut text: Vec<u8>) -> Vec<u8> {
        if text.is_empty() {
            return text;
        }
        let in_lines = |text: &[u8], change: &dyn Fn(&mut Vec<Vec<u8>>)| {
            let mut lines: Vec<Vec<u8>> =
                text.split_inclusive(|&byte| byte == b'\n').map(<[u8]>::to_vec).collect();
            change(&mut lines);
            lines.concat()
        };
        match self {
            Self::Byte(at, byte) => {
                let at = at.index(text.len());
                text[at] = *byte;
                text
            }
            Self::CutOut(at, length) => {
                let at = at.index(text.len());
                let end = (at + length).min(text.len());
                text.drain(at..end);
                text
            }
            Self::Insert(at, piece) => {
                let at = at.index(text.len());
                text.splice(at..at, piece.bytes());
                text
            }
            Self::Number(at, number) => {
                let is_number = |byte: &u8| byte.is_ascii_digit() || *byte == b'.';
                let from = at.index(text.len());
                let Some(start) = text[from..].iter().position(is_number) else { return text };
                let start = from + start;
                let length = text[start..].iter().take_while(|byte| is_number(byte)).count();
                text.splice(start..start + length, number.bytes());
                text
            }
            Self::SwapLines(one, other) => in_lines(&text, &|lines| {
                let (one, other) = (one.index(lines.len()), other.index(lines.len()));
                lines.swap(one, other);
            }),
            Self::RepeatLine(at, times) => in_lines(&text, &|lines| {
                let at = at.index(lines.len());
                let repeated = lines[at].repeat(*times);
                lines.insert(at, repeated);
            }),
            Self::DropLine(at) => in_lines(&text, &|lines| {
                lines.remove(at.index(lines.len()));
            }),
            Self::Join(at) => in_lines(&text, &|lines| {
                let at = at.index(lines.len());
                lines[at].retain(|&byte| byte != b'\n');
            }),
        }
    }
}

/// Reads a program to its end or its first error. The result is the number of steps.
fn read(text: Vec<u8>) -> Result<u64, TestCaseError> {
    let options = Options { blocks: BLOCKS, tools: Some(tools()), ..Options::default() };
    let lines = text.iter().filter(|&&byte| byte == b'\n').count() as u64 + 1;
    let program = match Interpreter::new(Cursor::new(text), "mutated.ngc", &options) {
        Ok(program) => program,
        Err(error) => return check(&error, lines).map(|()| 0),
    };
    let mut steps = 0;
    for step in program {
        match step {
            Ok(_) => steps += 1,
            Err(error) => check(&error, lines)?,
        }
        // A line gives few steps, or counts each of them as a block.
        prop_assert!(steps < 100 * (lines + BLOCKS));
    }
    Ok(steps)
}

/// An error has a place in the file and a remedy.
fn check(error: &carrystep_gcode::GcodeError, lines: u64) -> Result<(), TestCaseError> {
    prop_assert!((1..=lines).contains(&error.line), "{error}");
    prop_assert!(!error.kind.help().is_empty() && !error.kind.to_string().is_empty(), "{error}");
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(5_000))]

    #[test]
    fn mutated_program_is_read_or_refused_with_its_place(
        original: Index,
        mutations in vec(mutation(), 1..8),
    ) {
        let original = original.get(originals()).clone().into_bytes();
        read(mutations.iter().fold(original, |text, mutation| mutation.apply(text)))?;
    }

    #[test]
    fn pieces_of_the_language_in_any_order_are_read_or_refused(
        pieces in vec((select(&PIECES[..]), select(&NUMBERS[..])), 1..40),
    ) {
        let text = pieces.into_iter().map(|(piece, number)| format!("{piece}{number}"));
        read(text.collect::<String>().into_bytes())?;
    }

    #[test]
    fn any_bytes_are_read_or_refused(bytes in vec(any::<u8>(), 0..400)) {
        read(bytes)?;
    }
}

#[test]
fn original_programs_are_read_to_their_end() {
    for text in originals() {
        let options = Options { tools: Some(tools()), ..Options::default() };
        let program = Interpreter::new(Cursor::new(text), "original.ngc", &options);
        let steps: Vec<_> = program.unwrap().collect::<Result<_, _>>().unwrap();
        assert_eq!(steps.last().map(|step| &step.canon), Some(&Canon::End), "{text}");
    }
}
