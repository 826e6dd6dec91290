//! How the command fails: what is told, and the exit status that goes with it.

use carrystep_levels::LevelError;
use carrystep_plan::PlanError;
use carrystep_spec::{InputError, MoveFile};
use miette::{LabeledSpan, MietteDiagnostic, NamedSource, Report};
use std::io::Write as _;
use std::process::ExitCode;

/// Why the command did not do what was asked.
#[derive(Debug)]
pub enum Failure {
    /// Status 1: the check failed. It has been reported already.
    Check,
    /// Status 1: the run itself failed.
    Run(String),
    /// Status 2: bad input, an impossible move included.
    Input(InputError),
    /// Status 3: a tool is missing.
    Tool(String),
    /// Status 0: whoever read our output has gone.
    ReaderGone,
}

impl Failure {
    /// Tells the user, and gives the exit status.
    pub fn tell(self) -> ExitCode {
        let (status, text) = match self {
            Self::ReaderGone => return ExitCode::SUCCESS,
            Self::Check => return ExitCode::from(1),
            Self::Run(message) => (1, format!("error: {message}")),
            Self::Input(error) => (2, render(&error)),
            Self::Tool(message) => (3, format!("error: {message}")),
        };
        // Nobody is left to tell if this fails.
        let _ = writeln!(std::io::stderr(), "{}", text.trim_end());
        ExitCode::from(status)
    }
}

/// What is wrong, then file, line and column, and the line itself with what is wrong in it.
fn render(error: &InputError) -> String {
    let mut diagnostic = MietteDiagnostic::new(error.message.clone());
    if let Some(help) = &error.help {
        diagnostic = diagnostic.with_help(help.clone());
    }
    match &error.place {
        Some((source, span)) if !source.text.is_empty() => {
            let label = LabeledSpan::underline(shorten(&source.text, span.clone()));
            let code = NamedSource::new(source.path.display().to_string(), source.text.to_string());
            format!("error:\n{:?}", Report::new(diagnostic.with_label(label)).with_source_code(code))
        }
        _ => format!("error: {error}"),
    }
}

/// Only the first line of a long span: a whole [[move]] table underlined says nothing.
fn shorten(text: &str, span: std::ops::Range<usize>) -> std::ops::Range<usize> {
    let end = text.get(span.clone()).and_then(|s| s.find('\n')).map_or(span.end, |newline| span.start + newline);
    span.start..end
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        Self::Input(error)
    }
}

impl From<LevelError> for Failure {
    fn from(error: LevelError) -> Self {
        match error {
            LevelError::Missing { .. } => Self::Tool(error.to_string()),
            _ => Self::Run(error.to_string()),
        }
    }
}

/// A refused move, with its place in the file.
pub fn refused(file: &MoveFile, error: &PlanError) -> Failure {
    let message = error.to_string();
    Failure::Input(match error.move_index() {
        Some(index) => file.move_error(index, message),
        None => InputError::new(message),
    })
}
