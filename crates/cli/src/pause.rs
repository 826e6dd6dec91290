//! What other commands ask of a program that waits: to jog, to probe, to show work offsets, to set
//! them. The command that drives the board does it.

use crate::connection;
use crate::control::{self, ANSWER, BUSY, Holder, NOTHING_WAITS, Reply, SocketRequest};
use crate::failure::Failure;
use crate::interrupt;
use crate::jog::JogWish;
use crate::json;
use crate::output;
use crate::probe::ProbeWish;
use crate::work::{NamedOffset, OffsetWish};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt;
use std::time::Duration;

/// Time between two questions for the result.
const LOOK: Duration = Duration::from_millis(10);

/// What is asked.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum PauseWish {
    /// A jog, and what is set behind it.
    Jog(JogWish, Option<OffsetWish>),
    /// A move that the probe ends.
    Probe(ProbeWish),
    /// The machine place gets these coordinates.
    Set(OffsetWish),
    /// All offsets are zero.
    Clear,
    /// The offsets as they are.
    Show,
}

/// How it has ended; `--json` prints it as it is.
#[derive(Debug, Clone, Default, JsonSchema, Serialize, Deserialize)]
pub struct PauseResult {
    /// It was done.
    pub passed: bool,
    /// Why it was not, if it was not.
    pub error: Option<String>,
    /// The axes moved, and were stopped on request.
    pub stopped: bool,
    /// The axes moved, and the probe has not ended their move.
    #[serde(default)]
    pub missed: bool,
    /// The work offsets cannot be written, and are as before. The document of such an end is that of
    /// a failure, so its schema does not have this.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    #[schemars(skip)]
    pub unkept: bool,
    /// Machine place at which the probe has ended a move, by letters as in `place`: that of the
    /// tick in which the gateware accepted its level.
    #[serde(default)]
    pub touched: Option<BTreeMap<char, f64>>,
    /// What the program waits for.
    pub waits: String,
    /// Machine coordinates of the axes in mm and degrees, by their letters.
    pub place: BTreeMap<char, f64>,
    /// The work offsets that are not zero.
    pub offsets: Vec<NamedOffset>,
}

impl fmt::Display for PauseResult {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "the program waits: {}", self.waits)?;
        if let Some(touched) = &self.touched {
            writeln!(f, "the probe has ended the move at machine{}", Coordinates(touched))?;
        }
        writeln!(f, "machine place:{}", Coordinates(&self.place))?;
        if self.offsets.is_empty() {
            return f.write_str("no work offsets\n");
        }
        self.offsets.iter().try_for_each(|offset| writeln!(f, "{offset}"))
    }
}

/// Coordinates with their letters.
pub struct Coordinates<'a>(pub &'a BTreeMap<char, f64>);

impl fmt::Display for Coordinates<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|(letter, at)| write!(f, " {letter} {at:.4}"))
    }
}

/// Asks the command that drives the board at this port, and prints the result. Returns false if no
/// program waits there. Ctrl-C stops what moves, and with it the program.
pub fn ask(port: &str, wish: &PauseWish, json: bool) -> Result<bool, Failure> {
    let Some(mut caller) = control::call(port) else { return Ok(false) };
    let moves = matches!(wish, PauseWish::Jog(..) | PauseWish::Probe(_));
    if moves {
        // From here on Ctrl-C requests a stop and does not end the process.
        interrupt::watch();
    }
    let text = json::line(wish).map_err(|error| Failure::Run(error.to_string()))?;
    let hangs = |holder: &Holder| {
        Failure::Run(connection::hangs(port, holder, SocketRequest::Pause, "answer"))
    };
    match caller.ask_with(SocketRequest::Pause, &text, ANSWER) {
        Reply::Line(line) if line == NOTHING_WAITS || line.is_empty() => return Ok(false),
        Reply::Line(line) if line == BUSY => {
            let message = "another jog, probe or offset is not done yet: wait for its end";
            return Err(Failure::input(message));
        }
        Reply::Line(_) => {}
        Reply::Ended => return Ok(false),
        Reply::Silent => return Err(hangs(&caller.holder)),
    }
    let mut stops = false;
    let line = loop {
        if moves && interrupt::is_asked() && !std::mem::replace(&mut stops, true) {
            // The answer to this only says that it was heard.
            let _ = caller.ask(SocketRequest::Stop, ANSWER);
        }
        match caller.ask(SocketRequest::Result, ANSWER) {
            Reply::Line(line) if line.is_empty() => std::thread::sleep(LOOK),
            Reply::Line(line) => break line,
            Reply::Silent => return Err(hangs(&caller.holder)),
            Reply::Ended => {
                let message = format!("{} has ended before it was done", caller.holder);
                return Err(Failure::Run(message));
            }
        }
    };
    let result: PauseResult = serde_json::from_str(&line).map_err(|error| {
        Failure::Run(format!("{} answers with {line:?}: {error}", caller.holder))
    })?;
    match &result.error {
        Some(error) if result.stopped || result.missed || result.unkept => {
            return Err(Failure::Run(error.clone()));
        }
        Some(error) => return Err(Failure::input(error.clone())),
        None if json => output::print_json(&result)?,
        None => output::print(&result.to_string())?,
    }
    Ok(true)
}
