//! What a board is to whoever drives it: bytes in and out, switches, and the time that passes.

use crate::board::{Board, Switches};
use carrystep_core::engine::Cause;
use carrystep_model::fast::Edges;
use carrystep_simulators::LevelError;

/// A board that waits for its host keeps so many segments waiting for each axis in the middle of a move.
pub const KEPT: usize = 3;

/// Clocks for which a board that waits for its host goes on at once while bytes are on the line.
const TALK: u64 = 1000;

/// A board, of models or of Verilog.
pub trait Gateware {
    /// The cycle it is in.
    fn cycle(&self) -> u64;

    /// No axis moves.
    fn rests(&self) -> bool;

    /// The stop that holds it, and the axes that called it.
    fn fault(&self) -> Option<(Cause, u8)>;

    /// Pulses forward less pulses back.
    fn position(&self, axis: usize) -> i32;

    /// The STEP pins, a bit each axis.
    fn step(&self) -> u8;

    /// Steps that were discarded, where that can be told.
    fn discarded(&self, axis: usize) -> Option<u32>;

    /// Clocks for which it may go on without its host, so that no queue becomes shorter than [`KEPT`]; `None` where no axis
    /// needs its host, or where that cannot be told.
    fn alone(&self) -> Option<u64>;

    /// The cycles in which starts have loaded their first segments.
    fn loads(&self) -> &[u64];

    /// The stops that were called: the first cycle with the fault, and why.
    fn stops(&self) -> &[(u64, Cause)];

    /// Says a byte to it, at the line's pace.
    fn say(&mut self, byte: u8);

    /// Bytes that have not yet gone to it.
    fn unsaid(&self) -> usize;

    /// The next byte from it.
    fn next_byte(&mut self) -> Option<u8>;

    /// Sets the switches from this cycle on.
    fn press(&mut self, switches: Switches);

    /// Goes on to this cycle; `to` hears of the pins. It stops once on its way, where the first start has loaded: until then
    /// nothing was to be heard.
    ///
    /// # Errors
    /// [`LevelError`]: what simulates it is gone.
    fn run(&mut self, end: u64, to: &mut impl Edges) -> Result<(), LevelError>;
}

impl Gateware for Board {
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

    fn next_byte(&mut self) -> Option<u8> {
        self.next_byte()
    }

    fn press(&mut self, switches: Switches) {
        self.press(switches);
    }

    fn run(&mut self, end: u64, to: &mut impl Edges) -> Result<(), LevelError> {
        self.run(end, to);
        Ok(())
    }
}
