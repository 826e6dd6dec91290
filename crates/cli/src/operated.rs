//! A virtual board together with its operator's switches, the main loop of
//! `carrystep virtual-board`, and how far a fast board may run ahead.

use crate::failure::Failure;
use crate::interrupt;
use crate::switches::{KNOWN, SwitchPanel};
use carrystep_core::EngineBuild;
use carrystep_virtual_board::{Edges, RealTimeBoard, RealTimeError, SimulatedBoard};
use std::io::Write as _;
use std::sync::atomic::Ordering;

/// A fast board runs ahead of its host by at most a second divided by this: further than its host
/// asks it, and not so far that it takes the processor's time from others while it rests.
const PART_OF_SECOND: u64 = 40;
/// It runs ahead by at most the watchdog's time divided by this.
const PART_OF_WATCHDOG: u64 = 4;

/// How far a fast board may run ahead of its host, in clocks.
pub fn ahead(build: &EngineBuild) -> u64 {
    let (guard, time) = (&build.guard, &build.timebase);
    let most = time.clock_hz() / PART_OF_SECOND;
    match u64::from(guard.watchdog) * u64::from(guard.round) * u64::from(time.clocks_per_tick()) {
        0 => most,
        watchdog => most.min(watchdog / PART_OF_WATCHDOG),
    }
}

/// The board at its pseudo-terminal, and its switches.
pub struct OperatedBoard<B> {
    pub real_time: RealTimeBoard<B>,
    pub panel: SwitchPanel,
}

impl<B: SimulatedBoard> OperatedBoard<B> {
    /// Runs until the first start. Returns false if the board is to end before it.
    pub fn until_start(&mut self) -> Result<bool, Failure> {
        while self.real_time.board.loads().is_empty() {
            if !self.step(&mut ())? {
                return Ok(false);
            }
        }
        Ok(true)
    }

    /// Runs for a short time. Returns false if the board is to end.
    pub fn step(&mut self, to: &mut dyn Edges) -> Result<bool, Failure> {
        let look = self.panel.look(|axis| self.real_time.board.position(axis));
        for line in look.unknown {
            // If this write fails, there is no channel left to report it.
            let _ = writeln!(std::io::stderr(), "not understood: {line:?}; known are: {KNOWN}");
        }
        if look.ends || interrupt::watch().load(Ordering::Relaxed) {
            return Ok(false);
        }
        self.real_time.board.press(look.switches);
        self.real_time.step(to).map_err(|error| match error {
            RealTimeError::Level(error) => error.into(),
            RealTimeError::Terminal(_) => Failure::Run(error.to_string()),
        })?;
        Ok(true)
    }
}
