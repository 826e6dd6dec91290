//! Spindle and coolant beside the lines of the program: 0x9E, 0xA0, 0xA1, the safety door, and what
//! a reset leaves.
//!
//! ```text
//! in motion   0xA0, 0xA1       with the next segment that is not sent, or cut off
//! at rest     0xA0, 0xA1       with a segment of its own, in which nothing moves
//! in a hold   0x9E             spindle off; again: as it was before
//! door        spindle and coolant off; `~`: as before, and then the dwell
//! reset       spindle and coolant off
//! ```
//!
//! It decides, and moves nothing; `switching.rs` sends the segments.

use carrystep_core::OutputChange;
use carrystep_files::Machine;
use carrystep_files::machine::OutputUses;

/// Time from the start of a spindle to the motion that follows a hold, s.
const SPINDLE_DWELL: f64 = 3.0;

/// A coolant.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coolant {
    Flood,
    Mist,
}

/// What is to be switched at rest, and how long the machine then waits, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Due {
    pub change: OutputChange,
    pub dwell: f64,
    /// Whether it follows the safety door.
    pub door: bool,
}

/// Spindle and coolant of a machine.
#[derive(Debug, Clone, Default)]
pub struct Accessories {
    uses: OutputUses,
    /// The outputs as the board has got them.
    now: OutputChange,
    /// The same where the stretch that is executed began.
    before: OutputChange,
    /// What 0xA0 and 0xA1 change, and what is not sent yet.
    coolant: OutputChange,
    /// Whether 0x9E wants the other state of the spindle.
    wants_spindle: bool,
    /// Whether all is to be switched off.
    wants_off: bool,
    /// What a spindle that was stopped in a hold gets back.
    stopped: Option<OutputChange>,
    /// What spindle and coolant get back that the safety door has switched off.
    parked: Option<OutputChange>,
}

impl Accessories {
    /// Those of a machine, all off.
    pub fn new(machine: &Machine) -> Self {
        Self { uses: machine.output_uses, ..Self::default() }
    }

    /// The outputs of the spindle; a laser has none, because its duty follows the motion.
    fn spindle(&self) -> u8 {
        bit(self.uses.spindle) | bit(self.uses.spindle_reverse)
    }

    /// Whether outputs switch the spindle.
    pub fn has_spindle(&self) -> bool {
        self.uses.spindle.is_some() || self.sets_speed()
    }

    /// Whether the duty of the PWM is the speed of the spindle.
    fn sets_speed(&self) -> bool {
        self.uses.spindle_rpm.is_some() && !self.uses.laser
    }

    /// Whether the spindle turns; true in it: counterclockwise.
    pub fn turns(&self) -> Option<bool> {
        let is_on = |output: Option<u8>| self.now.levels & bit(output) != 0;
        let turns = match self.uses.spindle {
            Some(_) => is_on(self.uses.spindle),
            None => self.sets_speed() && self.now.duty.is_some_and(|duty| duty > 0),
        };
        turns.then(|| is_on(self.uses.spindle_reverse))
    }

    fn output(&self, coolant: Coolant) -> u8 {
        match coolant {
            Coolant::Flood => bit(self.uses.flood),
            Coolant::Mist => bit(self.uses.mist),
        }
    }

    /// Whether a coolant is on; `None` if the machine has no output for it.
    pub fn is_on(&self, coolant: Coolant) -> Option<bool> {
        let output = self.output(coolant);
        (output != 0).then(|| self.now.then(self.coolant).levels & output != 0)
    }

    /// The other state of a coolant is wanted.
    pub fn toggle(&mut self, coolant: Coolant) {
        let (mask, is_on) = (self.output(coolant), self.is_on(coolant) == Some(true));
        let levels = if is_on { 0 } else { mask };
        self.coolant = self.coolant.then(OutputChange { mask, levels, duty: None });
    }

    /// 0x9E in a hold.
    pub const fn toggle_spindle(&mut self) {
        self.wants_spindle = !self.wants_spindle;
    }

    /// A reset: nothing of before is wanted any more, and all goes off.
    pub fn reset(&mut self) {
        self.forget();
        self.wants_off = true;
    }

    /// Whether all is to be switched off, whatever else is the case.
    pub const fn is_to_be_off(&self) -> bool {
        self.wants_off
    }

    /// Nothing that was stopped comes back.
    pub fn forget(&mut self) {
        *self = Self { uses: self.uses, now: self.now, before: self.before, ..Self::default() };
    }

    /// The board has switched all outputs off by itself.
    pub fn safe(&mut self) {
        self.forget();
        self.sent(OutputChange { mask: u8::MAX, levels: 0, duty: Some(0) });
    }

    /// Whether the safety door has switched off what it does.
    pub const fn is_parked(&self) -> bool {
        self.parked.is_some()
    }

    /// What is to be switched in the motion that is executed.
    pub const fn take_coolant(&mut self) -> OutputChange {
        std::mem::replace(&mut self.coolant, OutputChange::NONE)
    }

    /// This was not sent.
    pub const fn give_back(&mut self, change: OutputChange) {
        self.coolant = change.then(self.coolant);
    }

    /// A stretch begins.
    pub const fn begins(&mut self) {
        self.before = self.now;
    }

    /// The stretch has changed this so far.
    pub const fn of_stretch(&mut self, change: OutputChange) {
        self.now = self.before.then(change);
    }

    /// This was sent at rest.
    pub const fn sent(&mut self, change: OutputChange) {
        self.now = self.now.then(change);
    }

    /// The present state of these outputs, and of the speed of the spindle.
    fn present(&self, mask: u8) -> OutputChange {
        let duty = self.now.duty.filter(|_| self.sets_speed());
        OutputChange { mask, levels: self.now.levels & mask, duty }
    }

    fn off(&self, mask: u8) -> OutputChange {
        OutputChange { mask, levels: 0, duty: self.sets_speed().then_some(0) }
    }

    /// What is to be switched at rest: `holds` and `door` say whether a hold is in force, and whether
    /// the safety door is its reason.
    pub fn due(&mut self, holds: bool, door: bool) -> Option<Due> {
        let all = self.spindle() | bit(self.uses.flood) | bit(self.uses.mist);
        if std::mem::replace(&mut self.wants_off, false) {
            return Some(Due { change: self.off(all), dwell: 0.0, door });
        }
        if door && self.parked.is_none() {
            let spindle = self.stopped.take().unwrap_or(OutputChange::NONE);
            self.parked = Some(self.present(all).then(spindle));
            return Some(Due { change: self.off(all), dwell: 0.0, door });
        }
        let wants = std::mem::replace(&mut self.wants_spindle, false);
        if !holds {
            let was_parked = self.parked.is_some();
            let back = self.parked.take().or_else(|| self.stopped.take());
            if let Some(change) = back {
                return Some(Due { door: was_parked, ..self.restores(change, SPINDLE_DWELL) });
            }
        } else if wants && !door {
            if let Some(change) = self.stopped.take() {
                return Some(self.restores(change, 0.0));
            }
            if self.turns().is_some() {
                self.stopped = Some(self.present(self.spindle()));
                return Some(Due { change: self.off(self.spindle()), dwell: 0.0, door });
            }
        }
        let change = self.take_coolant();
        (!change.is_none()).then_some(Due { change, dwell: 0.0, door })
    }

    /// Switches on again what was on; waits only if a spindle starts.
    fn restores(&self, change: OutputChange, dwell: f64) -> Due {
        let after = Self { now: self.now.then(change), ..self.clone() };
        let starts = self.turns().is_none() && after.turns().is_some();
        Due { change, dwell: if starts { dwell } else { 0.0 }, door: false }
    }
}

/// The bit of an output.
fn bit(output: Option<u8>) -> u8 {
    output.map_or(0, |number| 1_u8.checked_shl(number.into()).unwrap_or(0))
}

#[cfg(test)]
mod tests;
