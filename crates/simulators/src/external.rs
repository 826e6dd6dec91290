//! The text formats that the two Verilog benches share: the program as a text file, and their
//! report as records.
//!
//! A program has one command per line, with numbers in hexadecimal: `kind a ticks v a j last`. The
//! kind is 0 segment (a: axis), 1 start (a: mask), 2 wait (ticks: clocks) or 3 clear. A report has
//! one record per line: `O` and all outputs if any changed, `E` and the outputs of the last cycle,
//! `X` if the run did not end.

use crate::tool;
use crate::{Job, LevelError, Observer, Outcome, halted};
use carrystep_core::ports::Outputs;
use carrystep_core::{AXES, Command, Faults};
use carrystep_tools::programs::Tool;
use std::fmt::Write as _;
use std::io::{BufRead, BufReader};
use std::process::Stdio;

/// The program in the format of the benches.
pub(crate) fn program_text(job: &Job<'_>) -> String {
    let mut text = String::new();
    for command in job.program.commands() {
        let (kind, who, ticks, [v, a, j], last) = match command {
            Command::Segment { axis, segment: s } => (0, axis, s.ticks, [s.v, s.a, s.j], s.last),
            Command::Outputs(_) => continue, // the parallel core has none
            Command::Start { mask } => (1, mask, 0, [0; 3], false),
            Command::Wait { clocks } => (2, 0, clocks, [0; 3], false),
            Command::Clear => (3, 0, 0, [0; 3], false),
        };
        // Writing to a string cannot fail.
        let _ = writeln!(text, "{kind} {who:x} {ticks:x} {v:x} {a:x} {j:x} {}", u8::from(last));
    }
    text
}

/// Runs a compiled bench, and passes its records to the observer.
pub(crate) fn observe(
    tool: &Tool,
    command: &mut std::process::Command,
    job: &Job<'_>,
    observer: &mut Observer<'_>,
) -> Result<Outcome, LevelError> {
    let mut child = command
        .stdout(Stdio::piped())
        .stderr(Stdio::null())
        .spawn()
        .map_err(tool::io(format!("cannot start the {} simulation", tool.name)))?;
    let mut origin = None;
    let mut end = None;
    let mut odd = None;
    for line in child.stdout.take().map(BufReader::new).into_iter().flat_map(BufRead::lines) {
        let line = line.map_err(tool::io(format!("reading from the {} simulation", tool.name)))?;
        if halted(job.halt) {
            // The process may have ended already.
            let _ = child.kill();
            child.wait().map_err(tool::io(format!("ending the {} simulation", tool.name)))?;
            return Err(LevelError::Halted);
        }
        match record(&line) {
            Some(('O', cycle, outputs)) => {
                observer(cycle, &outputs);
                if outputs.started && origin.is_none() {
                    origin = Some(cycle + 1);
                }
            }
            Some(('E', cycle, last)) => end = Some(Outcome { clocks: cycle + 1, origin, last }),
            _ if line.starts_with('X') => return Err(LevelError::Endless(job.max_clocks)),
            _ => odd = odd.or(Some(line)),
        }
    }
    let status =
        child.wait().map_err(tool::io(format!("waiting for the {} simulation", tool.name)))?;
    let failed = || LevelError::Tool {
        tool: tool.name,
        message: match &odd {
            Some(line) => format!("cannot read what the simulation reports: {line}"),
            None => format!("the simulation stopped without a report ({status})"),
        },
    };
    end.filter(|_| odd.is_none()).ok_or_else(failed)
}

/// Parses a line: letter, cycle, seg_ready start_ready step dir idle started overrun overspeed
/// underrun protocol, position, discarded. All numbers except the cycle are hexadecimal.
fn record(line: &str) -> Option<(char, u64, Outputs)> {
    let mut fields = line.split_ascii_whitespace();
    let letter = fields.next()?.chars().next()?;
    let cycle = fields.next()?.parse().ok()?;
    let mut small = || u8::from_str_radix(fields.next()?, 16).ok();
    let seg_ready = small()? == 1;
    let start_ready = small()? == 1;
    let (step, dir) = (small()?, small()?);
    let idle = small()? == 1;
    let started = small()? == 1;
    let faults = Faults {
        overrun: small()?,
        overspeed: small()?,
        underrun: small()?,
        protocol: small()? == 1,
    };
    let position = words(fields.next()?)?.map(u32::cast_signed);
    let discarded = words(fields.next()?)?;
    Some((
        letter,
        cycle,
        Outputs { seg_ready, start_ready, step, dir, position, discarded, idle, faults, started },
    ))
}

/// Parses 192 bits in hexadecimal as six words; axis 0 is the lowest.
fn words(hex: &str) -> Option<[u32; AXES]> {
    let mut words = [0; AXES];
    for (axis, word) in words.iter_mut().enumerate() {
        let end = hex.len().checked_sub(8 * axis)?;
        *word = u32::from_str_radix(hex.get(end.checked_sub(8)?..end)?, 16).ok()?;
    }
    Some(words)
}
