//! The entry of a program in its middle: what takes the place of the blocks before the one with
//! which it begins.
//!
//! ```text
//!  z    .----- X, Y and rotary axes at rapid -----.      height: the highest z so far, or --safe-z
//!       |                                         |      spindle and coolant on, dwell
//!       up at rapid                               down at feed
//!       |                                         |      other outputs
//!   the machine                                   the place where the block begins
//! ```
//!
//! The blocks before are executed without motion. Where the program goes may depend on where it
//! began: with G91 or G92, or as long as an axis has not moved. This is found by executing these
//! blocks a second time from another place.

use crate::counts::SwitchCount;
use crate::error::{Fault, ProgramError};
use crate::events::{Event, Events};
use crate::file::ProgramFile;
use crate::letter::LINEAR;
use crate::outputs::ProgramOutputs;
use crate::switch::Switch;
use carrystep_core::OutputChange;
use carrystep_gcode::{AXES, AXIS_LETTERS, Arc, Canon, ExecutedBlock, Modes, Point, Turn};

/// The dwell behind the start of the spindle if the program has none, s.
pub const DEFAULT_SPINDLE_DWELL: f64 = 3.0;

/// The feed of the way down if no F is in force, mm/s: 120 mm/min.
pub const ENTRY_FEED: f64 = 2.0;

/// By how much the second beginning differs from the first, mm and degrees. It is far above, so
/// that the highest z differs if the beginning is one of those that it may be.
const ELSEWHERE: Point = [1.37, 2.61, 10_003.19, 4.43, 5.87, 7.01];

/// The index of z.
const Z: usize = LINEAR - 1;

/// Parts of a turn at which the height of an arc is looked at, and the most of them for an arc.
const PARTS: f64 = 64.0;
const MOST_PARTS: f64 = 4096.0;

/// Where a program begins instead of its first block.
#[derive(Debug, Clone, PartialEq)]
pub struct FromBlock {
    /// The executed block, from 1.
    pub block: u64,
    /// The machine place where the program began, as far as it is known, mm and degrees.
    pub began_at: [Option<f64>; AXES],
    /// The machine height for the way of X and Y, mm, instead of the highest so far.
    pub safe_z: Option<f64>,
    /// The dwell behind the start of the spindle, s, instead of the program's.
    pub spindle_dwell: Option<f64>,
}

/// How a program is entered.
#[derive(Debug, Clone)]
pub struct Entry {
    /// The block with which the program goes on.
    pub block: ExecutedBlock,
    /// The machine place where it begins, mm and degrees.
    pub place: Point,
    /// The modes in which it begins.
    pub modes: Modes,
    /// The machine height of the way of X and Y, mm; `None` if the machine has no axis z.
    pub height: Option<f64>,
    /// The feed of the way down, mm/s.
    pub feed: f64,
    /// The dwell behind the start of spindle and coolant, s.
    pub dwell: f64,
    /// Outputs of `M62` to `M68` as the blocks before leave them.
    pub outputs: OutputChange,
    /// What the blocks before have asked for and the entry does not: probes and inputs, of which
    /// the result is assumed, pauses and tool changes.
    pub passed: Vec<SwitchCount>,
    /// The machine place at which the program is taken to have begun.
    program_start: Point,
    /// The axes of which it is not known where they began. They have not moved.
    pub(crate) unknown: [bool; AXES],
}

impl Entry {
    /// The machine place at which the program is taken to have begun, mm and degrees.
    pub const fn program_start(&self) -> Point {
        self.program_start
    }

    /// Executes the blocks before the one with which a program begins.
    ///
    /// # Errors
    /// A mistake in these blocks, no such block, a place that depends on an unknown beginning, or a
    /// safe height that is none.
    pub(crate) fn find(file: &ProgramFile, from: &FromBlock) -> Result<Self, ProgramError> {
        let (machine, number) = (file.settings().start, from.block);
        let program_start: Point =
            std::array::from_fn(|axis| from.began_at[axis].unwrap_or(machine[axis]));
        let mut events = Events::begin(file, program_start)?;
        let skipped = events.pass_over(number)?;
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
        let switches = spins
            && ProgramOutputs::new(file.machine())
                .spindle(modes.spindle, modes.rpm)
                .is_ok_and(|effect| effect.is_all);
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
    let Ok(skipped) = other.pass_over(block) else {
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
pub(crate) struct Skipped {
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
    pub(crate) fn step(&mut self, canon: &Canon, outputs: &ProgramOutputs) {
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
    pub(crate) fn event(&mut self, event: &Event) {
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
