//! `carrystep plan` for a G-code program: its figures, the limits reached, and on request the
//! segments.

use crate::arguments::PlanArguments;
use crate::commands::list_blocks;
use crate::document::Named;
use crate::failure::Failure;
use crate::output::OutputFile;
use crate::program_table::ProgramFigures;
use crate::segments::{SegmentJson, add_segment, segments};
use crate::spool::Spool;
use crate::{output, program, recorded};
use carrystep_core::engine::PWM_STEPS;
use carrystep_core::{OutputChange, Segment};
use carrystep_program::{ProgramFile, Row};
use schemars::JsonSchema;
use serde::Serialize;
use std::fmt::Write as _;

/// What `--json` prints, and `--json-lines` at the end.
#[derive(JsonSchema, Serialize)]
pub struct PlannedProgram {
    passed: bool,
    #[serde(flatten)]
    figures: ProgramFigures,
}

/// What `--json-lines` prints for each row: segments of all axes for the same ticks.
#[derive(JsonSchema, Serialize)]
pub struct PlannedRow<'a> {
    /// The number of the row, counted from 1.
    number: u64,
    /// The line of the program that the path has reached at the end of the row.
    line: u64,
    /// A segment for each axis, in the order of the machine file.
    #[serde(serialize_with = "segments")]
    #[schemars(with = "Vec<SegmentJson>")]
    segments: &'a [Segment],
    /// The outputs that change where the row begins, if any do.
    #[serde(skip_serializing_if = "Option::is_none")]
    outputs: Option<ChangedOutputs>,
}

/// A change of outputs, one bit each.
#[derive(JsonSchema, Serialize)]
struct ChangedOutputs {
    /// The outputs that get a new level.
    mask: u8,
    /// Their levels; 1 is active.
    levels: u8,
    /// The new duty of the PWM, 0 to 4095 of 4096; null if it stays.
    duty: Option<u16>,
}

/// What changes at the outputs where a row begins, if anything does.
fn changed(change: OutputChange) -> Option<ChangedOutputs> {
    let OutputChange { mask, levels, duty } = Some(change).filter(|change| !change.is_none())?;
    Some(ChangedOutputs { mask, levels, duty })
}

/// Plans a program and shows the plan.
pub fn run(arguments: &PlanArguments) -> Result<(), Failure> {
    program::refuse(&[("--fit-ns", arguments.fit_ns.is_some())])?;
    if arguments.list_blocks {
        return list_blocks::run(arguments);
    }
    let file = program::load(&arguments.file, &arguments.program)?;
    let report = arguments.report.as_deref().map(OutputFile::create).transpose()?;
    let (mut text, mut number, mut outputs) = (Spool::new(), 0, file.row_outputs());
    let detail = recorded::detail(report.is_some());
    let (survey, recorded) = program::survey(&file, detail, |row| {
        number += 1;
        let outputs = changed(outputs.change(row));
        if arguments.json_lines {
            let Row { line, segments, .. } = row;
            return output::print_json_line(&PlannedRow { number, line: *line, segments, outputs });
        }
        if arguments.segments {
            text.add(|text| add_row(text, &file, row, outputs.as_ref()))
        } else {
            Ok(())
        }
    })?;
    let figures = ProgramFigures::new(&file, &survey, &recorded.time_use);
    let planned = PlannedProgram { passed: true, figures };
    if let Some(mut out) = report {
        let source = recorded::source(&file, survey.one_file, &recorded.time_use)?;
        let title = file.path().display().to_string();
        recorded::write(&mut out, &title, &Named::new(&planned), &recorded, &source)?;
        out.keep()?;
    }
    if arguments.json || arguments.json_lines {
        return output::print_json(&planned);
    }
    text.print()?;
    output::print(&planned.figures.to_string())
}

/// Adds the segments of a row.
fn add_row(text: &mut String, file: &ProgramFile, row: &Row, outputs: Option<&ChangedOutputs>) {
    // Writing to a string cannot fail.
    let _ = writeln!(text, "line {}", row.line);
    if let Some(&ChangedOutputs { mask, levels, duty }) = outputs {
        let number = |output: &u8| mask >> output & 1 == 1;
        for output in (0..8).filter(number) {
            let level = if levels >> output & 1 == 1 { "on" } else { "off" };
            let _ = writeln!(text, "output {output} {level}");
        }
        if let Some(duty) = duty {
            let _ = writeln!(text, "duty {duty}/{PWM_STEPS}");
        }
    }
    for (axis, segment) in file.machine().axes.iter().zip(&row.segments) {
        add_segment(text, &axis.name, segment);
    }
}
