//! Reads a program line by line and gives its canonical moves one by one.

use crate::assign;
use crate::block::ExecutedBlock;
use crate::canon::{Canon, Point, Step};
use crate::comment;
use crate::error::{ErrorKind, Fault, GcodeError};
use crate::evaluate::{LAST_PARAMETER, Values as _};
use crate::execute;
use crate::files::{Files, Folder};
use crate::flow::Flow;
use crate::grammar::{self, LineKind};
use crate::kept::Offsets;
use crate::motion::record_probe;
use crate::options::Options;
use crate::outcome::Outcome;
use crate::request::Request;
use crate::seal::Seal;
use crate::squeeze::Squeezed;
use crate::state::{State, numbers};
use crate::switches;
use crate::syntax::Block;
use crate::tools::ToolTable;
use std::fs::File;
use std::io::{Read, Seek};
use std::path::Path;
use std::sync::Arc;

/// Lines after which the files are checked for changes.
const LINES_OF_A_CHECK: u32 = 1000;

/// A program that is being read: an iterator over its [`Step`]s.
///
/// The memory does not grow with the length of the program, but for a few words for each O-word.
/// After an error, or after [`Canon::End`], the iterator is over.
///
/// ```
/// use carrystep_gcode::{Canon, Interpreter, Options, Pace};
/// use std::io::Cursor;
///
/// let program = Cursor::new("G20 G0 X1\nF60\nG1 Y2\nM2\n");
/// let steps: Result<Vec<_>, _> =
///     Interpreter::new(program, "example.ngc", &Options::default())?.collect();
/// let steps = steps?;
/// assert_eq!(steps[0].canon, Canon::Traverse { to: [25.4, 0.0, 0.0, 0.0, 0.0, 0.0] });
/// let (to, pace) = ([25.4, 50.8, 0.0, 0.0, 0.0, 0.0], Pace::PerSecond(25.4));
/// assert_eq!(steps[1].canon, Canon::Feed { to, pace });
/// assert_eq!((steps[1].line, &steps[2].canon), (3, &Canon::End));
/// # Ok::<(), carrystep_gcode::GcodeError>(())
/// ```
#[derive(Debug)]
pub struct Interpreter<R> {
    files: Files<R>,
    flow: Flow,
    pub(crate) state: State,
    /// The file of the present line.
    file: Arc<str>,
    line: Squeezed,
    /// The line as it is in the file.
    text: Vec<u8>,
    words: Block,
    /// Steps of the present line that are not given yet.
    outcome: Outcome,
    block_delete: bool,
    /// Lines that may still run again.
    blocks_left: u64,
    blocks: u64,
    /// Number of the executed block, from 1; 0 before the first one.
    block: u64,
    /// Lines until the files are checked for changes again.
    until_check: u32,
    /// Bytes of the main program up to the furthest line that was executed outside of subroutines.
    furthest: u64,
    /// Lines with `%` so far.
    percents: u32,
    is_over: bool,
}

impl Interpreter<File> {
    /// Opens a file. Subroutines that are not in it are looked for in files of their names beside
    /// it: `o<name> call` in `name.ngc`.
    ///
    /// # Errors
    /// As [`Interpreter::new`], and if the file cannot be read. If one of the files changes before
    /// the last step has been given, the iterator ends with an error.
    pub fn open(path: &Path, options: &Options) -> Result<Self, GcodeError> {
        let name: Arc<str> = path.display().to_string().into();
        let fail = |kind| GcodeError { file: name.clone(), line: 0, column: 0, kind };
        let (file, seal) = Seal::open(path).map_err(fail)?;
        let folder = path.parent().unwrap_or(Path::new("")).to_owned();
        let folder = Folder { path: folder, open: Seal::open };
        let files = Files::new(file, name, Some(seal), Some(folder), options.block_delete)?;
        Ok(Self::with_files(files, options))
    }
}

impl<R: Read + Seek> Interpreter<R> {
    /// Reads a program from its beginning. `name` is the name of the file in errors.
    ///
    /// All O-words are read at once, so that a program with an open block is refused here.
    ///
    /// # Errors
    /// The program cannot be read, or an O-word is malformed or without its beginning or end.
    pub fn new(input: R, name: &str, options: &Options) -> Result<Self, GcodeError> {
        let files = Files::new(input, name.into(), None, None, options.block_delete)?;
        Ok(Self::with_files(files, options))
    }

    fn with_files(files: Files<R>, options: &Options) -> Self {
        let mut state = State::new(options.start, options.tools.clone());
        options.offsets.give(&mut state);
        for &(number, value) in &options.parameters {
            if (1..=LAST_PARAMETER).contains(&usize::from(number)) && value.is_finite() {
                state.memory.set(number.into(), value);
            }
        }
        state.refresh_frame();
        Self {
            file: files.name(0).clone(),
            files,
            flow: Flow::default(),
            state,
            line: Squeezed::default(),
            text: Vec::new(),
            words: Block::default(),
            outcome: Outcome::default(),
            block_delete: options.block_delete,
            blocks_left: options.blocks,
            blocks: options.blocks,
            block: 0,
            until_check: LINES_OF_A_CHECK,
            furthest: 0,
            percents: 0,
            is_over: false,
        }
    }

    /// The machine place after the last line that was executed.
    pub fn place(&self) -> Point {
        self.state.machine
    }

    /// The value of a numbered parameter, such as offsets that the machine keeps; 0 for numbers
    /// without a parameter.
    pub fn parameter(&self, number: u16) -> f64 {
        self.state.numbered(number.into())
    }

    /// The offsets that the machine keeps, as the program has changed them.
    pub fn offsets(&self) -> Offsets {
        Offsets::of(&self.state)
    }

    /// Replaces these offsets, after a stop ([`Canon::Pause`] or [`Canon::ChangeTool`]) and before
    /// the next step is asked for. The values must be finite.
    pub fn set_offsets(&mut self, offsets: &Offsets) {
        offsets.give(&mut self.state);
    }

    /// Whether the line of the last step has further steps: these were computed with the place and
    /// the offsets that were in force at its beginning.
    pub fn is_amid_line(&self) -> bool {
        let is_more = |canon: &Canon| !matches!(canon, Canon::Comment(_) | Canon::Message(_));
        let Outcome { before, cycle, after, .. } = &self.outcome;
        cycle.is_some() || before.iter().chain(after).any(is_more)
    }

    /// The tool table as the program has changed it by G10, if there is one.
    pub fn tools(&self) -> Option<&ToolTable> {
        self.state.tools.as_ref()
    }

    /// Reports the real machine place after a stop ([`Canon::Pause`] or [`Canon::ChangeTool`]),
    /// before the next step is asked for. The coordinates must be finite.
    pub fn set_place(&mut self, at: Point) {
        self.state.set_place(at);
    }

    /// Reports the machine place at which the last [`Canon::Probe`] ended and whether the probe
    /// tripped, before the next step is asked for. The coordinates must be finite.
    pub fn probed(&mut self, at: Point, tripped: bool) {
        self.set_place(at);
        record_probe(&mut self.state, tripped);
    }

    /// Reports the value at which the last [`Canon::ReadInput`] ended, before the next step is
    /// asked for: 0 or 1 for digital inputs, any finite value for analog ones, `None` if the input
    /// did not become what was wanted in time. A program sees it as `#5399`, and `None` as -1.
    pub fn input_read(&mut self, value: Option<f64>) {
        self.state.memory.set(numbers::INPUT, value.unwrap_or(-1.0));
    }

    /// The next step of the blocks before this one. `None` if the next line would be executed as
    /// this block: then nothing of it has been done, and any call goes on with it. `None` as well
    /// after the last step; [`is_over`](Self::is_over) tells which.
    ///
    /// # Errors
    /// As the iterator.
    pub fn step_before(&mut self, block: u64) -> Option<Result<Step, GcodeError>> {
        if self.is_over {
            return None;
        }
        let step = self.next_step(block);
        self.ended(step)
    }

    /// Executes what is left of the present block, and then the next one, without giving their
    /// steps. `None` at the end of the program.
    ///
    /// # Errors
    /// As the iterator.
    pub fn next_block(&mut self) -> Option<Result<ExecutedBlock, GcodeError>> {
        let wanted = self.block + 1;
        let mut moves = false;
        while let Some(step) = self.step_before(wanted + 1) {
            match step {
                Ok(step) => moves |= step.block == wanted && step.canon.is_motion(),
                Err(error) => return Some(Err(error)),
            }
        }
        if self.block < wanted {
            return None;
        }
        let text = String::from_utf8_lossy(&self.text);
        Some(Ok(ExecutedBlock {
            number: self.block,
            file: self.file.clone(),
            line: self.state.line,
            text: text.trim_end_matches(['\r', '\n']).to_owned(),
            moves,
        }))
    }

    /// Which file and line is next, and how deep the calls are.
    pub(crate) fn next_line_place(&self) -> (String, u64, usize) {
        let next = self.files.next();
        (self.files.name(next.file).to_string(), next.place.lines, self.state.call_level)
    }

    /// The number of the block that was executed last, from 1; 0 before the first one.
    pub const fn block(&self) -> u64 {
        self.block
    }

    /// Whether the program has ended, or an error was given.
    pub const fn is_over(&self) -> bool {
        self.is_over
    }

    /// The next step of the present line.
    fn pending(&mut self) -> Result<Option<Canon>, ErrorKind> {
        if let Some(canon) = self.outcome.before.pop_front() {
            return Ok(Some(canon));
        }
        while let Some(stage) = self.outcome.cycle.as_mut().and_then(|cycle| cycle.next()) {
            self.count_block()?;
            if stage.is_some() {
                return Ok(stage);
            }
        }
        self.outcome.cycle = None;
        Ok(self.outcome.after.pop_front())
    }

    fn count_block(&mut self) -> Result<(), ErrorKind> {
        let left = self.blocks_left.checked_sub(1);
        self.blocks_left = left.ok_or(ErrorKind::TooManyBlocks(self.blocks))?;
        Ok(())
    }

    /// Reads and executes lines until there is a step; `None` after the last one.
    /// Stops before block `before`.
    fn next_step(&mut self, before: u64) -> Result<Option<Step>, Fault> {
        loop {
            if let Some(canon) = self.pending().map_err(whole_line)? {
                if canon.is_sync_point() {
                    self.until_check = 0;
                }
                let (file, line, block) = (self.file.clone(), self.state.line, self.block);
                return Ok(Some(Step { file, line, block, canon }));
            }
            if self.outcome.ends {
                return Ok(None);
            }
            if self.block.saturating_add(1) >= before {
                return Ok(None);
            }
            if self.until_check == 0 {
                self.files.check()?;
                self.until_check = LINES_OF_A_CHECK;
            }
            self.until_check -= 1;
            self.next_line()?;
        }
    }

    /// Reads and executes a line.
    fn next_line(&mut self) -> Result<(), Fault> {
        let at = self.files.next();
        self.state.line = at.place.lines + 1;
        self.file.clone_from(self.files.name(at.file));
        if !self.files.advance().map_err(whole_line)? {
            // The end is at the last line, not behind it.
            self.state.line = at.place.lines.max(1);
            return self.end_of_file();
        }
        self.block += 1;
        self.text.clear();
        self.text.extend_from_slice(self.files.line());
        if self.flow.is_in_call() || at.place.offset < self.furthest {
            self.count_block().map_err(whole_line)?;
        } else {
            self.furthest = self.files.next().place.offset;
        }
        self.line.read(self.files.line())?;
        match grammar::kind(&self.line) {
            LineKind::Deletable if self.block_delete => return Ok(()),
            LineKind::Percent => {
                self.percents += 1;
                return if self.percents == 2 { self.end_of_file() } else { Ok(()) };
            }
            LineKind::Deletable | LineKind::Block => {}
        }
        grammar::read(&self.line, &mut self.words)?;
        for text in &self.line.comments {
            self.outcome.before.push_back(comment::canon(text, &self.state));
        }
        let next = if let Some(control) = &self.words.control {
            self.flow.execute(&mut self.files, at, control, &mut self.state)?
        } else {
            self.execute()?;
            let following = self.files.next();
            match self.outcome.jump.take() {
                None => None,
                Some(jump) => self.flow.jump(&mut self.files, following, jump, &mut self.state)?,
            }
        };
        next.map_or(Ok(()), |next| self.files.jump(next).map_err(whole_line))
    }

    /// The end of the file, or the second `%`.
    fn end_of_file(&mut self) -> Result<(), Fault> {
        if self.flow.is_in_call() {
            return Err(Fault::new(0, ErrorKind::NoReturn));
        }
        switches::end(&mut self.state, &mut self.outcome.after);
        self.outcome.ends = true;
        Ok(())
    }

    /// Executes a line without O-word. Assignments take effect after all values are computed.
    fn execute(&mut self) -> Result<(), Fault> {
        if self.words.words.is_empty() && self.words.assignments.is_empty() {
            return Ok(());
        }
        let mut request = Request::new(&self.words, &self.state)?;
        assign::assign(&mut self.state, &self.words.assignments)?;
        execute::execute(&mut self.state, &mut request, &mut self.outcome)
    }
}

impl<R: Read + Seek> Iterator for Interpreter<R> {
    type Item = Result<Step, GcodeError>;

    fn next(&mut self) -> Option<Self::Item> {
        self.step_before(u64::MAX)
    }
}

impl<R: Read + Seek> Interpreter<R> {
    /// What the iterator gives for a step; notes the end of the program.
    fn ended(&mut self, mut step: Result<Option<Step>, Fault>) -> Option<Result<Step, GcodeError>> {
        self.is_over = match &step {
            Ok(Some(step)) => step.canon == Canon::End,
            Ok(None) => self.outcome.ends,
            Err(_) => true,
        };
        // A mistake in a file that has changed is none of the program's.
        if self.is_over
            && let Err(changed) = self.files.check()
        {
            step = Err(changed);
        }
        match step {
            Ok(step) => step.map(Ok),
            Err(Fault { column, kind, elsewhere }) => {
                let here = || (self.file.clone(), self.state.line);
                let (file, line) = elsewhere.map_or_else(here, |place| *place);
                Some(Err(GcodeError { file, line, column, kind }))
            }
        }
    }
}

/// A mistake that belongs to a whole line.
fn whole_line(kind: ErrorKind) -> Fault {
    Fault::new(0, kind)
}
