//! How the command ends when it fails: the message on standard error, the exit status, and the
//! document that `--json` prints.

use crate::colour;
use crate::excerpt::Excerpt;
use crate::failure::Failure;
use crate::output;
use carrystep_files::InputError;
use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic, Report};
use schemars::JsonSchema;
use serde::Serialize;
use std::io::{IsTerminal as _, Write as _};
use std::path::PathBuf;
use std::process::ExitCode;

/// Prints the failure to standard error and returns the exit status. If `--json` is wanted and
/// no report was printed, it prints the failure as the document.
pub fn tell(failure: Failure) -> ExitCode {
    if let (true, Some(document)) = (output::lacks_json(), FailedRun::of(&failure)) {
        // If printing fails, standard error still reports the failure.
        let _ = output::print_json(&document);
    }
    let (status, text) = match failure {
        Failure::ReaderGone => return ExitCode::SUCCESS,
        Failure::Check => return ExitCode::from(1),
        Failure::NothingTried => return ExitCode::from(4),
        Failure::Run(message) => (1, format!("error: {}", harmless(&message))),
        Failure::Input(error) => (2, render(&error, std::io::stderr().is_terminal())),
        Failure::Tool(message) => (3, format!("error: {message}")),
    };
    // If this write fails, there is no channel left to report it.
    let _ = writeln!(std::io::stderr(), "{}", text.trim_end());
    ExitCode::from(status)
}

/// What `--json` prints of a failure.
#[derive(Debug, JsonSchema, Serialize)]
pub struct FailedRun {
    /// Always false.
    passed: bool,
    error: ErrorJson,
}

#[derive(Debug, JsonSchema, Serialize)]
struct ErrorJson {
    kind: Kind,
    /// What is wrong.
    message: String,
    /// The input file that is wrong.
    file: Option<PathBuf>,
    /// Line in that file, from 1.
    line: Option<usize>,
    /// Column in that line, in characters from 1.
    column: Option<usize>,
    /// What to do.
    help: Option<String>,
}

/// What failed; each kind has its exit status.
#[derive(Debug, Clone, Copy, JsonSchema, Serialize)]
#[serde(rename_all = "lowercase")]
enum Kind {
    /// Exit status 1: the check or the run.
    Run,
    /// Exit status 2: the input, an impossible move included.
    Input,
    /// Exit status 2: the arguments.
    Usage,
    /// Exit status 3: a program is missing.
    Tool,
}

impl FailedRun {
    fn new(kind: Kind, message: impl Into<String>) -> Self {
        let error = ErrorJson {
            kind,
            message: message.into(),
            file: None,
            line: None,
            column: None,
            help: None,
        };
        Self { passed: false, error }
    }

    /// The document of a failure; `None` if none must be printed.
    fn of(failure: &Failure) -> Option<Self> {
        Some(match failure {
            // For `NothingTried`, the sweep has printed its report already; for `ReaderGone`,
            // nobody reads it.
            Failure::ReaderGone | Failure::NothingTried => return None,
            Failure::Check => Self::new(Kind::Run, failure.message()),
            Failure::Run(message) => Self::new(Kind::Run, message),
            Failure::Tool(message) => Self::new(Kind::Tool, message),
            Failure::Input(error) => {
                let (line, column) = error.line_column().unzip();
                let mut document = Self::new(Kind::Input, &error.message);
                document.error.file = error.place.as_ref().map(|(source, _)| source.path.clone());
                (document.error.line, document.error.column) = (line, column);
                document.error.help.clone_from(&error.help);
                document
            }
        })
    }
}

/// Reports wrong arguments, or prints the requested help, and returns the exit status.
pub fn usage(error: &clap::Error) -> ExitCode {
    if error.use_stderr() && output::lacks_json() {
        let text = error.render().to_string();
        let (message, help) = text.trim().split_once("\n\n").unwrap_or((text.trim(), ""));
        let mut document = FailedRun::new(Kind::Usage, message.trim_start_matches("error: "));
        document.error.help = Some(help.trim().to_owned()).filter(|help| !help.is_empty());
        // If printing fails, standard error still reports the failure.
        let _ = output::print_json(&document);
    }
    // If this write fails, there is no channel left to report it.
    let _ = error.print();
    u8::try_from(error.exit_code()).map_or(ExitCode::FAILURE, ExitCode::from)
}

/// Formats an input error: the message, then file, line and column, then the line with the wrong
/// part marked.
fn render(error: &InputError, terminal: bool) -> String {
    let Some((source, span)) = error.place.as_ref().filter(|(source, _)| !source.text.is_empty())
    else {
        return format!("error: {}", harmless(&error.to_string()));
    };
    let mut diagnostic = MietteDiagnostic::new(harmless(&error.message));
    diagnostic.help = error.help.as_deref().map(harmless);
    let name = source.path.display().to_string();
    let code = Excerpt::new(name, &harmless(&source.text), span).after(error.lines_before);
    drawn(diagnostic.with_label(LabeledSpan::underline(code.span())), code, terminal)
}

/// Draws the diagnostic with colours and line drawing on a terminal, and in plain ASCII without
/// line wrapping elsewhere.
fn drawn(diagnostic: MietteDiagnostic, code: Excerpt, terminal: bool) -> String {
    let report = Report::new(diagnostic).with_source_code(code);
    let mut theme = match (terminal, colour::wanted(&std::io::stderr())) {
        (true, true) => GraphicalTheme::unicode(),
        (true, false) => GraphicalTheme::unicode_nocolor(),
        (false, _) => GraphicalTheme::none(),
    };
    // The word replaces the theme's cross, which can be read as a letter.
    theme.characters.error = "error:".to_owned();
    let handler = GraphicalReportHandler::new_themed(theme).with_wrap_lines(terminal);
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = handler.render_report(&mut text, report.as_ref());
    text.trim_start().to_owned()
}

/// Replaces control characters, so that a file's content cannot control the terminal. Each byte
/// keeps its place.
fn harmless(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' | '\r' | '\t' => safe.push(c),
            c if c.is_control() => safe.extend(std::iter::repeat_n('?', c.len_utf8())),
            c => safe.push(c),
        }
    }
    safe
}

#[cfg(test)]
mod tests {
    use super::*;
    use carrystep_files::SourceText;

    #[test]
    fn control_characters_are_replaced_in_messages() {
        assert_eq!(harmless("a\u{1b}[31m\tb\u{0}\u{9b}\r\n\u{e9}"), "a?[31m\tb???\r\n\u{e9}");
    }

    #[test]
    fn error_over_several_lines_shows_only_the_first() {
        let source = SourceText { path: "m.toml".into(), text: "[[move]]\nto = {}\n".into() };
        let shown = render(&InputError::at(&source, 0..17, "too far").help("go less far"), false);
        let lines = [
            "error: too far",
            "   ,-[m.toml:1:1]",
            " 1 | [[move]]",
            "   : ^^^^^^^^",
            " 2 | to = {}",
            "   `----",
            "  help: go less far",
        ];
        assert_eq!(shown.lines().map(str::trim_end).collect::<Vec<_>>(), lines);
    }
}
