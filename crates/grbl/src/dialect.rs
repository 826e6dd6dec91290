//! What is answered to a sender: the lines that only ask or set something are answered here, and
//! the others are actions for whoever owns the machine.

use crate::code::{Alarm, ErrorCode};
use crate::input::RECEIVE_BUFFER;
use crate::parameters::{Parameters, ParserState};
use crate::report::{Reporter, Seen};
use crate::request::{Request, Restore};
use crate::settings::Settings;
use crate::state::State;

/// The line at the beginning and behind each reset.
pub const WELCOME: &str = "\r\nGrbl 1.1h ['$' for help]\r\n";

/// The answer to `$`.
pub const HELP: &str = "[HLP:$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H ~ ! ? ctrl-x]";

/// A message that is no answer: `[MSG:text]`.
pub fn message(text: &str) -> String {
    format!("[MSG:{text}]\r\n")
}

/// What `$RST=` restores beside the dialect's own settings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Restored {
    /// All offsets and stored places become 0.
    pub parameters: bool,
}

/// What is left to do for a line.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Action<'a> {
    /// Execute this G-code.
    Gcode(&'a str),
    /// Jog: the words.
    Jog(&'a str),
    /// Home all axes that can, or this one.
    Home(Option<char>),
    /// End the alarm, if there is one.
    Unlock,
    /// Begin or end the check of G-code without motion.
    Check,
    /// Take the power from the drivers.
    Sleep,
    /// Restore, and then reset.
    Restore(Restored),
}

/// What became of a line.
#[derive(Debug, Clone, PartialEq)]
pub enum Outcome<'a> {
    /// It is answered by this text, which ends with `ok` or `error:N`.
    Answered(String),
    /// It is answered when this is done.
    Do(Action<'a>),
}

/// The dialect of one machine.
#[derive(Debug, Clone)]
pub struct Dialect {
    /// The settings.
    pub settings: Settings,
    /// The reports.
    pub reporter: Reporter,
    /// Lines of the plan's queue, which `$I` names.
    blocks: usize,
}

impl Dialect {
    /// The dialect of a machine with these settings, and a queue of so many lines.
    pub fn new(settings: Settings, blocks: usize) -> Self {
        Self { settings, reporter: Reporter::default(), blocks }
    }

    /// `ok`.
    pub fn ok() -> String {
        "ok\r\n".to_owned()
    }

    /// `error:N`.
    pub fn error(code: ErrorCode) -> String {
        format!("error:{}\r\n", code.number())
    }

    /// `ALARM:N`.
    pub fn alarm(alarm: Alarm) -> String {
        format!("ALARM:{}\r\n", alarm.number())
    }

    /// A status report.
    pub fn report(&mut self, seen: &Seen) -> String {
        let mut text = self.reporter.report(seen, &self.settings);
        text.push_str("\r\n");
        text
    }

    /// What becomes of a line without blanks and comments, in capitals. `parameters` and `modes`
    /// are asked for only if the line shows them.
    pub fn line<'a>(
        &mut self,
        line: &'a str,
        state: State,
        parameters: impl FnOnce() -> Parameters,
        modes: impl FnOnce() -> ParserState,
    ) -> Outcome<'a> {
        let request = match Request::of(line) {
            Ok(request) => request,
            Err(code) => return Outcome::Answered(Self::error(code)),
        };
        if let Err(code) = request.is_allowed(state) {
            return Outcome::Answered(Self::error(code));
        }
        let shown = |text: String| Outcome::Answered(text + &Self::ok());
        let refused =
            |why: &str| Outcome::Answered(message(why) + &Self::error(ErrorCode::Unsupported));
        let inches = self.settings.inches;
        match request {
            Request::Empty => shown(String::new()),
            Request::Gcode(words) => Outcome::Do(Action::Gcode(words)),
            Request::Jog(words) => Outcome::Do(Action::Jog(words)),
            Request::Home(axis) => Outcome::Do(Action::Home(axis)),
            Request::Unlock => Outcome::Do(Action::Unlock),
            Request::Check => Outcome::Do(Action::Check),
            Request::Sleep => Outcome::Do(Action::Sleep),
            Request::Help => shown(format!("{HELP}\r\n")),
            Request::Settings => shown(self.settings.text()),
            Request::Parameters => shown(parameters().text(inches)),
            Request::ParserState => shown(modes().text(inches)),
            Request::Build => {
                let blocks = self.blocks;
                let version = env!("CARGO_PKG_VERSION");
                shown(format!(
                    "[VER:1.1h.20190830:carrystep {version}]\r\n[OPT:VNM,{blocks},{RECEIVE_BUFFER}]\r\n"
                ))
            }
            Request::Startup => shown("$N0=\r\n$N1=\r\n".to_owned()),
            Request::WriteStartup("") => shown(String::new()),
            Request::WriteStartup(_) => refused("startup lines are not kept"),
            Request::WriteBuild(_) => refused("the build info is fixed"),
            Request::Write { number, value } => match self.settings.write(number, value) {
                Ok(()) => shown(String::new()),
                Err(None) => Outcome::Answered(Self::error(ErrorCode::Unsupported)),
                Err(Some(key)) => refused(&format!("${number} is given by {key}")),
            },
            Request::Restore(what) => {
                if what != Restore::Parameters {
                    self.settings.restore();
                }
                let parameters = what != Restore::Settings;
                Outcome::Do(Action::Restore(Restored { parameters }))
            }
        }
    }
}
