//! Finds how a program is entered: executes the blocks before without motion, and notes what they do.

use crate::entry::{DEFAULT_SPINDLE_DWELL, ENTRY_FEED, Entry, FromBlock};
use crate::error::{Fault, ProgramError};
use crate::event::Event;
use crate::events::Events;
use crate::file::{ProgramFile, Settings};
use crate::letter::LINEAR;
use crate::outputs::ProgramOutputs;
use crate::switch::{Switch, SwitchCount};
use carrystep_core::OutputChange;
use carrystep_files::{InputError, Machine};
use carrystep_gcode::{AXES, AXIS_LETTERS, Arc, Canon, Point, Turn};
use std::path::Path;

/// The distance, in mm and degrees, of the two places from which the blocks before an entry are
/// executed, one after the other. If they lead to different places of entry, the entry depends on
/// where the program began. Z differs by 10 m, so that the highest z that the program uses differs
/// as well if it depends on that.
const ELSEWHERE: Point = [1.37, 2.61, 10_003.19, 4.43, 5.87, 7.01];

/// The index of z.
const Z: usize = LINEAR - 1;

/// Parts of a turn at which the height of an arc is looked at, and the most of them for an arc.
const PARTS: f64 = 64.0;
const MOST_PARTS: f64 = 4096.0;

impl Entry {
    /// Executes the blocks before the one with which a program begins.
    ///
    /// # Errors
    /// A mistake in these blocks, no such block, a place that depends on an unknown beginning, or a
    /// safe height that is none.
    fn find(file: &ProgramFile, from: &FromBlock) -> Result<Self, ProgramError> {
        let (machine, number) = (file.settings().start, from.block);
        let program_start: Point =
            std::array::from_fn(|axis| from.began_at[axis].unwrap_or(machine[axis]));
        let mut events = Events::begin(file, program_start)?;
        let skipped = pass_over(&mut events, number)?;
        let (place, modes) = (*events.at(), events.steps().modes());
        let mut unknown = from.began_at.map(|known| known.is_none());
        let mut is_height_known = true;
        if number <= 1 {
            // The program begins where the machine is.
            unknown = [false; AXES];
        } else if unknown.contains(&true) {
            let (differs, top) = differing(file, number, &program_start, &mut events, unknown)?;
            is_height_known = top == skipped.highest;
            unknown = std::array::from_fn(|axis| unknown[axis] && differs[axis]);
        }
        let last = events.steps().block();
        let block = match events.steps().next_block() {
            Some(block) if number > 0 => {
                block.map_err(|error| ProgramError::of_gcode(file.path(), error))?
            }
            _ => {
                let last = last_block(events.steps()).unwrap_or(last);
                let fault = Fault::NoBlock { block: number, last };
                return Err(ProgramError::new(file.path(), 0, fault));
            }
        };
        let error = |fault| ProgramError::new(file.path(), block.line, fault);
        if let Some(axis) = (0..AXES).find(|&axis| unknown[axis] && skipped.moved[axis]) {
            return Err(error(Fault::Began(AXIS_LETTERS[axis])));
        }
        // Without a move of z, before and behind, the tool stays at its height.
        let has_z = file.letters().axis(Z).is_some();
        if has_z && !is_height_known && skipped.moved[Z] && from.safe_z.is_none() {
            return Err(error(Fault::Height));
        }
        let height = height(file, from.safe_z, &skipped, &place).map_err(error)?;
        let spins = modes.spindle != Turn::Off;
        let outputs = ProgramOutputs::new(file.machine());
        // A laser needs no time.
        let switches = spins
            && !outputs.has_laser()
            && outputs.spindle(modes.spindle, modes.rpm).is_ok_and(|effect| effect.is_all);
        let of_program = skipped.spindle_dwell;
        let default = if switches { DEFAULT_SPINDLE_DWELL } else { 0.0 };
        let dwell = from.spindle_dwell.or(of_program).unwrap_or(default);
        Ok(Self {
            place,
            height,
            feed: modes.feed.map_or(ENTRY_FEED, |feed| feed / 60.0),
            dwell: if spins { dwell } else { 0.0 },
            modes,
            outputs: skipped.outputs,
            passed: skipped.passed,
            program_start,
            unknown,
            block,
        })
    }
}

/// Executes the blocks before this one, and notes what they do.
fn pass_over(events: &mut Events, block: u64) -> Result<Skipped, ProgramError> {
    let mut skipped = Skipped::default();
    events.pass_over(block, |canon, outputs, events| {
        skipped.step(canon, outputs);
        events.iter().for_each(|event| skipped.event(event));
    })?;
    Ok(skipped)
}

/// Executes what is left, and returns the number of the last block, if there is one more.
fn last_block<R: std::io::Read + std::io::Seek>(
    steps: &mut carrystep_gcode::Interpreter<R>,
) -> Option<u64> {
    let mut last = None;
    while let Some(Ok(block)) = steps.next_block() {
        last = Some(block.number);
    }
    last
}

/// The axes of which the place or the offsets depend on where the program began, and the highest z
/// of the program that begins elsewhere.
fn differing(
    file: &ProgramFile,
    block: u64,
    start: &Point,
    events: &mut Events,
    unknown: [bool; AXES],
) -> Result<([bool; AXES], Option<f64>), ProgramError> {
    let shift = |axis: usize| if unknown[axis] { ELSEWHERE[axis] } else { 0.0 };
    let mut other = Events::begin(file, std::array::from_fn(|axis| start[axis] + shift(axis)))?;
    let Ok(skipped) = pass_over(&mut other, block) else {
        // From there, the program would be a mistake.
        return Ok(([true; AXES], None));
    };
    Ok((events.steps().differs(other.steps()), skipped.highest))
}

/// The height of the way of X and Y.
fn height(
    file: &ProgramFile,
    safe: Option<f64>,
    skipped: &Skipped,
    place: &Point,
) -> Result<Option<f64>, Fault> {
    if file.letters().axis(Z).is_none() {
        return if safe.is_some() { Err(Fault::NoHeight) } else { Ok(None) };
    }
    let highest = match safe {
        Some(safe) if safe < place[Z] => {
            return Err(Fault::SafeHeight { safe, place: place[Z] });
        }
        Some(safe) => safe,
        None => skipped.highest.map_or(place[Z], |highest| highest.max(place[Z])),
    };
    // A tool that is higher stays there.
    Ok(Some(highest.max(file.settings().start[Z])))
}

/// What the blocks before have done.
#[derive(Debug, Default)]
struct Skipped {
    /// The highest machine z, mm.
    highest: Option<f64>,
    /// The axes that have moved.
    moved: [bool; AXES],
    /// The dwell behind the last start of the spindle.
    spindle_dwell: Option<f64>,
    /// Whether nothing has moved since.
    starts: bool,
    turn: Option<Turn>,
    outputs: OutputChange,
    passed: Vec<SwitchCount>,
}

impl Skipped {
    /// Notes a step, before its events.
    fn step(&mut self, canon: &Canon, outputs: &ProgramOutputs) {
        let effect = match *canon {
            Canon::Spindle { turn, .. } => {
                // Another speed alone needs no dwell of its own.
                if self.turn.replace(turn) != Some(turn) {
                    (self.spindle_dwell, self.starts) = (None, turn != Turn::Off);
                }
                return;
            }
            Canon::DigitalOutput { index, on, .. } => outputs.digital(index, on),
            Canon::AnalogOutput { index, value, .. } => outputs.analog(index, value),
            _ => return,
        };
        // A mistake is reported with its events.
        if let Ok(effect) = effect {
            self.outputs = self.outputs.then(effect.change);
        }
    }

    /// Notes what a step gives.
    fn event(&mut self, event: &Event) {
        match event {
            Event::Move(one) => {
                self.starts = false;
                let mut top = one.to[Z];
                if let Some(arc) = &one.arc {
                    top = top.max(highest(arc, &one.from));
                    arc.plane.axes()[..2].iter().for_each(|&axis| self.moved[axis] = true);
                }
                self.highest = Some(self.highest.map_or(top, |known| known.max(top)));
                for axis in 0..AXES {
                    self.moved[axis] |= one.from[axis] != one.to[axis];
                }
            }
            Event::Rest { seconds, .. } if self.starts && *seconds > 0.0 => {
                self.spindle_dwell = Some(self.spindle_dwell.unwrap_or(0.0) + seconds);
            }
            &Event::Switch { switch, line } => {
                let waits = [Switch::Probe, Switch::Input, Switch::Pause, Switch::ToolChange];
                if !waits.contains(&switch) {
                    return;
                }
                match self.passed.iter_mut().find(|known| known.switch == switch) {
                    Some(known) => known.count += 1,
                    None => self.passed.push(SwitchCount { switch, count: 1, line }),
                }
            }
            _ => {}
        }
    }
}

/// The highest z of an arc that begins at `from`.
fn highest(arc: &Arc, from: &Point) -> f64 {
    if !arc.plane.axes()[..2].contains(&Z) {
        return from[Z].max(arc.to[Z]);
    }
    let parts = (PARTS * arc.revolutions().ceil().max(1.0)).min(MOST_PARTS);
    (0..=parts as u32).map(|part| arc.at(from, f64::from(part) / parts)[Z]).fold(from[Z], f64::max)
}

impl ProgramFile {
    /// Opens a program for a machine, and registers it as an input, so that no later output of this
    /// process replaces it. `machine_path` is the machine's file, for errors.
    ///
    /// # Errors
    /// The file cannot be read, the machine cannot run jobs, its line is too slow for them, or it
    /// cannot start at that place, or the program cannot be entered at the block.
    pub fn open(
        path: &Path,
        machine: Machine,
        machine_path: &Path,
        settings: Settings,
    ) -> Result<Self, InputError> {
        let file = Self::whole(path, machine, machine_path, settings)?;
        let Some(from) = &file.settings().from else { return Ok(file) };
        let entry = Entry::find(&file, from)?;
        Ok(file.entered(entry))
    }
}
