//! The interface of a board, whether of models or of Verilog: bytes in and out, switches, and
//! simulated time.

use crate::board::{ModelBoard, Switches};
use crate::pin_levels::PinLevels;
use carrystep_core::engine::Cause;
use carrystep_model::fast::Edges;
use carrystep_simulators::LevelError;

/// Number of segments per axis that must remain queued in the middle of a move when a board waits
/// for its host.
pub const KEPT: usize = 3;

/// Number of clocks for which a board that waits for its host continues while bytes are being
/// transmitted.
const TALK: u64 = 1000;

/// A board, of models or of Verilog.
pub trait SimulatedBoard {
    /// Number of the current clock cycle.
    fn cycle(&self) -> u64;

    /// Whether no axis moves.
    fn rests(&self) -> bool;

    /// The stop in force: its cause, and the mask of the axes that caused it.
    fn fault(&self) -> Option<(Cause, u8)>;

    /// Position of an axis: pulses forward minus pulses backward.
    fn position(&self, axis: usize) -> i32;

    /// Levels of the STEP pins, a bit for each axis.
    fn step(&self) -> u8;

    /// Number of steps of an axis that were discarded; `None` if this board cannot report it.
    fn discarded(&self, axis: usize) -> Option<u32>;

    /// Number of clocks for which the board may run without its host so that no queue becomes
    /// shorter than [`KEPT`]. `None` if no axis needs its host, or if this board cannot report it.
    fn alone(&self) -> Option<u64>;

    /// The cycles in which starts loaded their first segments.
    fn loads(&self) -> &[u64];

    /// The stops so far: the first cycle with the fault, and the cause.
    fn stops(&self) -> &[(u64, Cause)];

    /// Queues a byte for transmission to the board, at the line's rate.
    fn say(&mut self, byte: u8);

    /// Number of bytes that were not transmitted completely.
    fn unsaid(&self) -> usize;

    /// Whether bytes are being transmitted in either direction, or an answer is being assembled, as
    /// far as this board can report it.
    fn talks(&self) -> bool;

    /// Whether the board is within a byte to the host.
    fn is_answering(&self) -> bool;

    /// The next byte received from the board.
    fn next_byte(&mut self) -> Option<u8>;

    /// Sets the switches from this cycle on.
    fn press(&mut self, switches: Switches);

    /// Runs the board up to cycle `end`; `to` receives the edges of the pins. The run ends early,
    /// once, when the first start has loaded its segments; up to then there are no edges.
    ///
    /// # Errors
    /// [`LevelError`] if the simulation has failed.
    fn run(&mut self, end: u64, to: &mut dyn Edges) -> Result<(), LevelError>;

    /// Runs the board up to cycle `end`; `seen` receives the levels of all pins in each cycle in
    /// which one of them has changed. A board of models skips no clock here.
    ///
    /// # Errors
    /// [`LevelError`] if the simulation has failed.
    fn watch(&mut self, end: u64, seen: &mut dyn FnMut(u64, PinLevels)) -> Result<(), LevelError>;
}

impl SimulatedBoard for ModelBoard {
    fn cycle(&self) -> u64 {
        self.cycle()
    }

    fn rests(&self) -> bool {
        let says = self.outputs();
        says.idle || says.halted
    }

    fn fault(&self) -> Option<(Cause, u8)> {
        self.outputs().fault
    }

    fn position(&self, axis: usize) -> i32 {
        self.engine().core().shaper(axis).position
    }

    fn step(&self) -> u8 {
        self.outputs().step
    }

    fn discarded(&self, axis: usize) -> Option<u32> {
        Some(self.engine().core().shaper(axis).discarded)
    }

    fn alone(&self) -> Option<u64> {
        let core = self.engine().core();
        let per_tick = u64::from(core.build().timebase.clocks_per_tick());
        let clocks = core.ticks_without_host(KEPT)?.saturating_mul(per_tick);
        Some(if self.talks() { clocks.max(TALK) } else { clocks })
    }

    fn loads(&self) -> &[u64] {
        self.loads()
    }

    fn stops(&self) -> &[(u64, Cause)] {
        self.stops()
    }

    fn say(&mut self, byte: u8) {
        self.say(byte);
    }

    fn unsaid(&self) -> usize {
        self.unsaid()
    }

    fn talks(&self) -> bool {
        self.talks()
    }

    fn is_answering(&self) -> bool {
        self.is_answering()
    }

    fn next_byte(&mut self) -> Option<u8> {
        self.next_byte()
    }

    fn press(&mut self, switches: Switches) {
        self.press(switches);
    }

    fn run(&mut self, end: u64, to: &mut dyn Edges) -> Result<(), LevelError> {
        self.run(end, to);
        Ok(())
    }

    fn watch(&mut self, end: u64, seen: &mut dyn FnMut(u64, PinLevels)) -> Result<(), LevelError> {
        self.watch(end, seen);
        Ok(())
    }
}
