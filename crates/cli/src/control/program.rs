//! What the user wants of a program that a command runs: to hold it, to let it go on, to end it, to
//! go faster or slower.

use super::{NO_SPINDLE, NOTHING_RUNS};
use crate::found::BlockFound;
use crate::interrupt;
use carrystep_runner::OverrideSetting;
use serde::{Deserialize, Serialize};

/// Signals that ramp the axes down while a program moves.
const STOP: u32 = 3;
/// Signals that end a program as soon as it rests.
const END: u32 = 2;

/// The overrides that a user changes, percent; the others stay as they are.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
pub struct OverrideWish {
    /// Of the feed, 10 to 200.
    pub feed: Option<u8>,
    /// Of rapid moves, 10 to 100.
    pub rapid: Option<u8>,
    /// Of the spindle, 10 to 200.
    pub spindle: Option<u8>,
}

/// The requests for a program.
#[derive(Debug, Default)]
pub struct ProgramControl {
    /// What the program waits for.
    pub(super) waits: Option<String>,
    /// The block in which the tool was last seen before anything stopped it.
    pub block: Option<BlockFound>,
    /// What is to be done while it waits, and how the last of it has ended.
    wish: Option<String>,
    result: Option<String>,
    /// Whether the command that wants the result has not fetched it yet.
    unfetched: bool,
    overrides: OverrideSetting,
    /// Whether an output sets the speed of a spindle.
    spindle: bool,
    holds: bool,
    resumed: bool,
    /// Whether it waits for an input, and not for somebody.
    pub(super) reads: bool,
    /// The number of signals before the present motion.
    before: u32,
    /// The number of signals when the present rest began.
    rested: u32,
}

impl ProgramControl {
    /// No requests yet. `spindle` says whether an output sets the speed of a spindle.
    pub fn new(spindle: bool) -> Self {
        Self { spindle, ..Self::default() }
    }

    /// The overrides that are wanted.
    pub const fn overrides(&self) -> OverrideSetting {
        self.overrides
    }

    /// Sets the overrides, percent.
    pub const fn set_overrides(&mut self, overrides: OverrideSetting) {
        self.overrides = overrides;
    }

    /// Notes a wish for other overrides. Returns the answer: all overrides, or the reason why they
    /// are as before.
    pub(super) fn overrides_as(&mut self, text: &str) -> String {
        let Ok(OverrideWish { feed, rapid, spindle }) = serde_json::from_str(text) else {
            return NOTHING_RUNS.to_owned();
        };
        if spindle.is_some() && !self.spindle {
            return NO_SPINDLE.to_owned();
        }
        let old = self.overrides;
        self.overrides = OverrideSetting {
            feed: feed.unwrap_or(old.feed).clamp(10, 200),
            rapid: rapid.unwrap_or(old.rapid).clamp(10, 100),
            spindle: spindle.unwrap_or(old.spindle).clamp(10, 200),
        };
        self.overrides.to_string()
    }

    /// The program rests from now on, and waits for this.
    pub fn rests(&mut self, waits: String) {
        (self.waits, self.resumed, self.rested) = (Some(waits), false, interrupt::count());
        self.reads = false;
    }

    /// Whether the program rests, and waits for somebody.
    pub const fn is_waiting(&self) -> bool {
        self.waits.is_some()
    }

    /// The program rests from now on, and waits for an input. Nobody else can let it go on.
    pub fn reads(&mut self, waits: String) {
        self.rests(waits);
        self.reads = true;
    }

    /// The program moves on.
    pub fn moves(&mut self) {
        // A command may still ask for the result of what it wanted.
        let (block, overrides, spindle) = (self.block, self.overrides, self.spindle);
        let (result, before) = (self.result.take(), interrupt::count());
        let unfetched = self.unfetched;
        *self = Self { before, result, unfetched, block, overrides, spindle, ..Self::default() };
    }

    /// Notes a request for a hold; false if the program rests.
    pub(super) fn hold(&mut self) -> bool {
        self.holds |= self.waits.is_none();
        self.waits.is_none()
    }

    /// Notes what another command wants done while the program waits. `None` if the program moves, is
    /// about to, or waits for an input; false if what was wanted before is not done yet.
    pub(super) fn pauses(&mut self, text: &str) -> Option<bool> {
        self.waits.as_ref().filter(|_| !self.reads && !self.resumed)?;
        let is_free = self.wish.is_none();
        if is_free {
            (self.wish, self.result) = (Some(text.to_owned()), None);
        }
        Some(is_free)
    }

    /// What is to be done while it waits, until [`ProgramControl::did`].
    pub fn wish(&self) -> Option<&str> {
        self.wish.as_deref()
    }

    /// It was done, with this result.
    pub fn did(&mut self, result: String) {
        (self.wish, self.result, self.unfetched) = (None, Some(result), true);
    }

    /// The result of what was done last, for the command that wanted it; empty while it goes on.
    pub(super) fn fetch(&mut self) -> String {
        self.unfetched &= self.result.is_none();
        self.result.clone().unwrap_or_default()
    }

    /// Whether the command that wants the result of what was done has not fetched it yet.
    pub const fn is_unfetched(&self) -> bool {
        self.unfetched
    }

    /// Nothing is held or overridden any more.
    pub fn restart(&mut self) {
        *self = Self { before: interrupt::count(), ..Self::new(self.spindle) };
    }

    /// The program cannot go on for this reason: it waits again.
    pub fn stays(&mut self, waits: String) {
        (self.waits, self.resumed) = (Some(waits), false);
    }

    /// Notes that the program may go on. `None` if it moves, or waits for an input; false if what
    /// somebody wants in the pause is not done yet, so that the machine may move.
    pub(super) fn resume(&mut self) -> Option<bool> {
        self.waits.as_ref().filter(|_| !self.reads)?;
        let is_free = self.wish.is_none();
        self.resumed |= is_free;
        Some(is_free)
    }

    /// Whether the moving program is to come to rest.
    pub fn holds(&self) -> bool {
        self.holds || self.signals() > 0
    }

    /// Whether the resting program is to go on.
    pub const fn resumed(&self) -> bool {
        self.resumed
    }

    /// Whether the resting program is to end.
    pub fn ends(&self) -> bool {
        self.signals() >= END || interrupt::count() > self.rested
    }

    /// Whether the axes are to ramp down at once.
    pub(super) fn stops(&self) -> bool {
        self.signals() >= STOP
    }

    fn signals(&self) -> u32 {
        interrupt::count().saturating_sub(self.before)
    }
}
