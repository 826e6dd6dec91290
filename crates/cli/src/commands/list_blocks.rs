//! `carrystep plan --list-blocks`: the executed blocks of a program.

use crate::arguments::PlanArguments;
use crate::entry::shown;
use crate::failure::Failure;
use crate::spool::Spool;
use crate::{interrupt, output, program};
use carrystep_program::{AXIS_LETTERS, Blocks, ProgramFile, TimedBlock};
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::BTreeMap;
use std::fmt::Write as _;

/// An executed block of a program. `--json-lines` prints one in a line.
#[derive(JsonSchema, Serialize)]
pub struct ListedBlock<'a> {
    /// Its number, from 1, as `--from-block` takes it.
    number: u64,
    /// The file of the line.
    file: &'a str,
    /// The line in the file, from 1.
    line: u64,
    /// The time at which its motion begins, s, to the beginning of a row; null if it has none.
    begins_s: Option<f64>,
    /// The machine place where it begins, mm and degrees, for each axis.
    at: BTreeMap<String, f64>,
    /// The line as it is in the file.
    text: &'a str,
}

/// Lists the blocks. The program is planned meanwhile, so that a mistake ends the list.
pub fn run(arguments: &PlanArguments) -> Result<(), Failure> {
    let file = program::load(&arguments.file, &arguments.program)?;
    let mut text = Spool::new();
    if !arguments.json_lines {
        text.add(|text| {
            let _ = writeln!(text, "{:>8}  {:>8}  {:>12}  text", "block", "line", "begins [s]");
        })?;
    }
    for block in Blocks::new(&file)? {
        interrupt::check()?;
        let block = block?;
        if arguments.json_lines {
            print_line(&file, &block)?;
        } else {
            text.add(|text| add(text, &file, &block))?;
        }
    }
    file.same()?;
    text.print()
}

fn print_line(
    file: &ProgramFile,
    TimedBlock { block, begins_s, at }: &TimedBlock,
) -> Result<(), Failure> {
    let letters = file.letters().all().iter();
    let at = letters.map(|&letter| (AXIS_LETTERS[letter].to_string(), at[letter])).collect();
    output::print_json_line(&ListedBlock {
        number: block.number,
        file: &block.file,
        line: block.line,
        begins_s: *begins_s,
        at,
        text: &block.text,
    })
}

/// Adds a line of the list. A line of another file has its name before the text.
fn add(text: &mut String, file: &ProgramFile, TimedBlock { block, begins_s, .. }: &TimedBlock) {
    let begins = begins_s.map_or_else(|| "-".to_owned(), |seconds| format!("{seconds:.3}"));
    let other = Some(&*block.file).filter(|name| *name != file.path().display().to_string());
    let other = other.map(|name| format!("{name}: ")).unwrap_or_default();
    let (number, line) = (block.number, block.line);
    // Writing to a string cannot fail.
    let _ = writeln!(text, "{number:>8}  {line:>8}  {begins:>12}  {other}{}", shown(&block.text));
}
