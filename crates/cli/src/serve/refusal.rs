//! The number of Grbl's error for a line that is not executed.

use carrystep_gcode::ErrorKind;
use carrystep_grbl::ErrorCode;
use carrystep_program::LineFault;

/// The error for a line of G-code.
pub fn code(fault: &LineFault) -> ErrorCode {
    let LineFault::Gcode(error) = fault else {
        return if fault.is_travel() { ErrorCode::Travel } else { ErrorCode::UnknownCode };
    };
    match &error.kind {
        ErrorKind::Unexpected { expected, .. } if expected.contains("value") => {
            ErrorCode::BadNumber
        }
        ErrorKind::Unexpected { .. } | ErrorKind::NotText(_) => ErrorCode::ExpectedLetter,
        ErrorKind::BadNumber(_) => ErrorCode::BadNumber,
        ErrorKind::LineTooLong(_) => ErrorCode::Overflow,
        ErrorKind::LetterTwice(_) => ErrorCode::Repeated,
        ErrorKind::SameGroup { .. } => ErrorCode::SameGroup,
        ErrorKind::Unused('X' | 'Y' | 'Z' | 'A' | 'B' | 'C') | ErrorKind::NoMotion => {
            ErrorCode::UnusedAxes
        }
        ErrorKind::Unused(_) => ErrorCode::UnusedWords,
        ErrorKind::Missing { word, .. } if is_axis_word(word) => ErrorCode::NoAxes,
        ErrorKind::Missing { .. } => ErrorCode::MissingWord,
        ErrorKind::NotWhole { .. } => ErrorCode::NotWhole,
        ErrorKind::OutOfRange { letter: 'N', .. } => ErrorCode::LineNumber,
        ErrorKind::OutOfRange { letter: 'T', .. }
        | ErrorKind::NoToolTable(_)
        | ErrorKind::UnknownTool(_)
        | ErrorKind::ToolZero => ErrorCode::Tool,
        ErrorKind::OutOfRange { .. } => ErrorCode::BadNumber,
        ErrorKind::AxesTwice { .. } => ErrorCode::AxesTwice,
        ErrorKind::MissingFeed(_)
        | ErrorKind::ZeroFeed(_)
        | ErrorKind::MissingInverseFeed(_)
        | ErrorKind::FeedWithUnits => ErrorCode::NoFeed,
        ErrorKind::MachineMotion(_) | ErrorKind::MachineIncremental => ErrorCode::MachineMotion,
        ErrorKind::ArcTooSmall { .. } => ErrorCode::BadRadius,
        ErrorKind::ArcRadii { .. }
        | ErrorKind::ArcNoRadius
        | ErrorKind::ArcSamePoint
        | ErrorKind::ArcRotated
        | ErrorKind::ProbeNoLength
        | ErrorKind::TooFar { .. } => ErrorCode::BadTarget,
        _ => ErrorCode::UnknownCode,
    }
}

/// Whether a code lacks axis words.
fn is_axis_word(word: &str) -> bool {
    word.contains("axis") || word.contains('X') || word.contains('Y') || word.contains('Z')
}
