//! Lines that come one after the other, as senders send them: each is executed whole, or not at
//! all.
//!
//! Every line is a program of its own, which begins with the state behind the line before it. There
//! are no O-words, because a block that is opened in a line would have to be closed in it.

use crate::canon::{Canon, Point, Step};
use crate::error::GcodeError;
use crate::evaluate::Values as _;
use crate::interpreter::Interpreter;
use crate::kept::Offsets;
use crate::modes::Modes;
use crate::motion::record_probe;
use crate::options::Options;
use crate::state::{Motion, State};
use std::io::Cursor;

/// Executes lines one by one.
///
/// ```
/// use carrystep_gcode::{Canon, LineInterpreter, Options};
///
/// let mut lines = LineInterpreter::new("sender", &Options::default());
/// let to = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
/// assert_eq!(lines.execute("G91 G0 X1")?[0].canon, Canon::Traverse { to });
/// // A mistake changes nothing.
/// assert!(lines.execute("G20 X1 X2").is_err());
/// assert_eq!((lines.place(), lines.modes().inches), (to, false));
/// # Ok::<(), carrystep_gcode::GcodeError>(())
/// ```
#[derive(Debug)]
pub struct LineInterpreter {
    name: String,
    options: Options,
    state: State,
    /// The state before the last line that was executed.
    before: Option<State>,
    lines: u64,
}

impl LineInterpreter {
    /// Begins at the place and with the offsets of the options. `name` is the name of the lines in
    /// errors.
    pub fn new(name: &str, options: &Options) -> Self {
        let options = options.clone();
        // Without a line, nothing can be refused.
        let state = Interpreter::new(Cursor::new(""), name, &options)
            .map_or_else(|_| State::new(options.start, None), |begun| begun.state);
        Self { name: name.to_owned(), options, state, before: None, lines: 0 }
    }

    /// Executes a line. Its steps have the number of the line, from 1, also as that of their block.
    ///
    /// # Errors
    /// The line is a mistake. Then it has changed nothing, but it is counted.
    pub fn execute(&mut self, text: &str) -> Result<Vec<Step>, GcodeError> {
        let (steps, state) = self.executed(text)?;
        self.before = Some(std::mem::replace(&mut self.state, state));
        Ok(steps)
    }

    /// Brings back the state before the last line that was executed, if whoever executes its steps
    /// cannot.
    pub fn undo(&mut self) {
        if let Some(before) = self.before.take() {
            self.state = before;
        }
    }

    /// Executes a line for its motion alone: all modes, offsets and parameters are those of before.
    ///
    /// # Errors
    /// As [`LineInterpreter::execute`].
    pub fn execute_aside(&mut self, text: &str) -> Result<Vec<Step>, GcodeError> {
        let (steps, state) = self.executed(text)?;
        self.before = Some(self.state.clone());
        self.set_place(state.machine);
        Ok(steps)
    }

    fn executed(&mut self, text: &str) -> Result<(Vec<Step>, State), GcodeError> {
        self.lines += 1;
        let number = self.lines;
        let placed = |error| GcodeError { line: number, ..error };
        let line = Cursor::new(text.to_owned());
        let mut one = Interpreter::new(line, &self.name, &self.options).map_err(placed)?;
        one.state = self.state.clone();
        let mut steps = Vec::new();
        // The end of the text is not that of the program.
        while let Some(step) = one.step_before(2) {
            let step = step.map_err(placed)?;
            if !matches!(step.canon, Canon::Comment(_)) {
                steps.push(Step { line: number, block: number, ..step });
            }
        }
        Ok((steps, one.state))
    }

    /// Number of lines that were executed or refused.
    pub const fn lines(&self) -> u64 {
        self.lines
    }

    /// The machine place behind the last line.
    pub const fn place(&self) -> Point {
        self.state.machine
    }

    /// Reports the real machine place. The coordinates must be finite.
    pub fn set_place(&mut self, at: Point) {
        self.state.set_place(at);
    }

    /// Reports the machine place at which the last [`Canon::Probe`] ended, whether the probe has
    /// tripped, and where the machine rests now. The coordinates must be finite.
    pub fn probed(&mut self, at: Point, tripped: bool, rests: Point) {
        self.set_place(at);
        record_probe(&mut self.state, tripped);
        self.set_place(rests);
    }

    /// The offsets that the machine keeps.
    pub fn offsets(&self) -> Offsets {
        Offsets::of(&self.state)
    }

    /// Begins anew at this place, with these offsets and the modes of the beginning.
    pub fn restart(&mut self, start: Point, offsets: Offsets) {
        let options = Options { start, offsets, ..self.options.clone() };
        *self = Self { lines: self.lines, ..Self::new(&self.name, &options) };
    }

    /// The value of a numbered parameter; 0 for numbers without one.
    pub fn parameter(&self, number: u16) -> f64 {
        self.state.numbered(number.into())
    }

    /// The modes behind the last line.
    pub fn modes(&self) -> Modes {
        Modes::of(&self.state)
    }

    /// The motion mode behind the last line, such as `G1` or `G38.2`; `G80` for none.
    pub fn motion(&self) -> String {
        match self.state.modal.motion {
            Motion::None => "G80".to_owned(),
            Motion::Traverse => "G0".to_owned(),
            Motion::Feed => "G1".to_owned(),
            Motion::Arc { clockwise: true } => "G2".to_owned(),
            Motion::Arc { clockwise: false } => "G3".to_owned(),
            Motion::Probe(tenths) => format!("G{}.{}", tenths / 10, tenths % 10),
            Motion::Cycle(code) => format!("G{code}"),
        }
    }
}
