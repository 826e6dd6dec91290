//! The events of a program file, from its beginning or from its entry, with what was changed where
//! the program has waited.

use crate::error::{Fault, ProgramError};
use crate::event::Event;
use crate::file::{Found, ProgramFile, Resumed};
use crate::outputs::ProgramOutputs;
use crate::translate::Translator;
use carrystep_gcode::{Canon, Interpreter, Offsets, Options, Point, Step};
use std::collections::VecDeque;
use std::fs::File;
use std::path::PathBuf;

/// The events of a program, from its beginning.
#[derive(Debug)]
pub struct Events {
    steps: Interpreter<File>,
    path: PathBuf,
    /// Whether all lines so far were of the program itself, and not of files beside it.
    one_file: bool,
    name: String,
    translator: Translator,
    /// Number of places to wait at or to read something so far, and what was changed at some of them.
    waits: u64,
    resumed: Vec<Resumed>,
}

impl Events {
    /// Reads a program from its beginning, or from its entry.
    ///
    /// # Errors
    /// The file cannot be read, is not the one that was opened, or its O-words are wrong.
    pub fn new(file: &ProgramFile) -> Result<Self, ProgramError> {
        file.same()?;
        let Some(entry) = file.entry() else { return Self::begin(file, file.settings().start) };
        let mut events = Self::begin(file, entry.program_start())?;
        events.pass_over(entry.block.number, |_, _, _| ())?;
        let machine = file.settings().start;
        let error = |fault| ProgramError::new(file.path(), entry.block.line, fault);
        events.translator.enter(entry, machine).map_err(error)?;
        Ok(events)
    }

    /// Reads a program that begins at this place from its beginning.
    pub(crate) fn begin(file: &ProgramFile, start: Point) -> Result<Self, ProgramError> {
        let settings = file.settings();
        let offsets = settings.offsets.clone();
        let options = Options { start, blocks: settings.blocks, offsets, ..Options::default() };
        let steps = Interpreter::open(file.path(), &options)
            .map_err(|error| ProgramError::of_gcode(file.path(), error))?;
        Ok(Self {
            steps,
            path: file.path().to_owned(),
            one_file: true,
            name: file.path().display().to_string(),
            translator: Translator::new(
                file.machine(),
                file.letters(),
                start,
                settings.tolerance_mm,
            ),
            waits: 0,
            resumed: settings.resumed.clone(),
        })
    }

    /// Whether all lines so far were of the program itself, and not of files beside it.
    pub fn one_file(&self) -> bool {
        self.one_file
    }

    /// The offsets that the machine keeps, behind the last line that was read.
    pub fn offsets(&self) -> Offsets {
        self.steps.offsets()
    }

    /// Executes the blocks before this one without their motion. `watch` sees each step and what it
    /// would give.
    pub(crate) fn pass_over(
        &mut self,
        block: u64,
        mut watch: impl FnMut(&Canon, &ProgramOutputs, &VecDeque<Event>),
    ) -> Result<(), ProgramError> {
        // Places to wait at are counted from the block on.
        let resumed = std::mem::take(&mut self.resumed);
        while let Some(step) = self.steps.step_before(block) {
            let step = step.map_err(|error| ProgramError::of_gcode(&self.path, error))?;
            let (line, canon) = (step.line, step.canon.clone());
            self.one_file &= *step.file == *self.name;
            self.add(step).map_err(|fault| ProgramError::new(&self.path, line, fault))?;
            watch(&canon, &self.translator.outputs, &self.translator.waiting);
            self.translator.waiting.clear();
        }
        (self.waits, self.resumed) = (0, resumed);
        Ok(())
    }

    /// The interpreter.
    pub(crate) const fn steps(&mut self) -> &mut Interpreter<File> {
        &mut self.steps
    }

    /// The place up to which the events have been read.
    pub(crate) const fn at(&self) -> &Point {
        &self.translator.at
    }

    fn add(&mut self, step: Step) -> Result<(), Fault> {
        let waits = matches!(step.canon, Canon::ChangeTool { .. } | Canon::Pause { .. });
        let reads = matches!(step.canon, Canon::Probe { .. } | Canon::ReadInput { .. });
        self.translator.add(step)?;
        if waits || reads {
            self.waits += 1;
            // What follows may be planned without what is before.
            self.translator.power = None;
            // What was changed and found is in force for the next line. Behind something that is
            // read, only steps are left of the line that have no place, or that were computed before.
            if waits && self.changed().is_some() && self.steps.is_amid_line() {
                return Err(Fault::ResumedAmidLine);
            }
            self.resume();
        }
        Ok(())
    }

    /// What was changed at the place that was reached last.
    fn changed(&self) -> Option<&Resumed> {
        self.resumed.iter().find(|resumed| resumed.number == self.waits)
    }

    /// Goes on with what was changed and found at the place that was reached last.
    fn resume(&mut self) {
        let Some(Resumed { at, offsets, found, .. }) = self.changed().cloned() else { return };
        match found {
            Found::Nothing => {}
            Found::Probe { at, tripped } => self.steps.probed(at, tripped),
            Found::Input(value) => self.steps.input_read(value),
        }
        offsets.iter().for_each(|offsets| self.steps.set_offsets(offsets));
        if at != self.translator.at || !matches!(found, Found::Input(_)) {
            self.steps.set_place(at);
            self.translator.at = at;
        }
    }
}

impl Iterator for Events {
    type Item = Result<Event, ProgramError>;

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            if let Some(event) = self.translator.waiting.pop_front() {
                return Some(Ok(event));
            }
            let step = match self.steps.next()? {
                Ok(step) => step,
                Err(error) => return Some(Err(ProgramError::of_gcode(&self.path, error))),
            };
            let line = step.line;
            self.one_file &= *step.file == *self.name;
            if let Err(fault) = self.add(step) {
                return Some(Err(ProgramError::new(&self.path, line, fault)));
            }
        }
    }
}
