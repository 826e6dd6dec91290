//! Checks whether a board's part is fast enough for a clock before a placement of hours is started.

use super::{Board, BoardError, Clocking, Measured, Part, Placed};
use carrystep_core::build::Timebase;
use carrystep_core::engine::check_schedule;
use carrystep_core::tick::Ticks;
use carrystep_core::tick::mhz;

/// Margin, percent, by which the placement of another gateware or with another seed may exceed the
/// measured clock.
const MARGIN_PERCENT: u64 = 10;

impl Board {
    /// Checks whether a placement of an engine of `axes` axes on this part may reach a clock, Hz:
    /// up to 10 % above the clock that nextpnr was measured to reach. A part without a measurement
    /// passes.
    ///
    /// # Errors
    /// [`BoardError::Slow`] gives the measured clock, and the clocks and ticks that the board
    /// makes.
    pub fn may_reach(&self, part: &Part, clock_hz: u64, axes: usize) -> Result<(), BoardError> {
        let Some(Measured::Placed(Placed { nextpnr_mhz, .. })) = self.measured() else {
            return Ok(());
        };
        let measured_hz = (nextpnr_mhz * 1e6).round() as u64;
        let measured = self.parts.first() == Some(part);
        let proposed = self.clocks.iter().any(|clock| clock.clock_hz == clock_hz);
        if !measured || proposed || clock_hz <= measured_hz + measured_hz * MARGIN_PERCENT / 100 {
            return Ok(());
        }
        let board = self.name.clone();
        Err(BoardError::Slow {
            board,
            wanted_hz: clock_hz,
            measured_hz,
            proposed: self.proposed(Some(axes)),
        })
    }

    /// The clocks and ticks at which the board is proposed to run. If `axes` is given, each tick is
    /// long enough for the time slots of that many axes.
    pub fn proposed(&self, axes: Option<usize>) -> String {
        let clocks: Vec<String> = self.clocks.iter().map(|clock| said(clock, axes)).collect();
        clocks.join(" or ")
    }
}

/// One clock in words: `37.5 MHz (ticks of 2560 ns in 16 phases)`.
fn said(clock: &Clocking, axes: Option<usize>) -> String {
    let Clocking { clock_hz, tick_ns, phases, .. } = *clock;
    let fits = |axes| {
        Timebase::new(clock_hz, tick_ns, phases)
            .is_ok_and(|time| check_schedule(axes, &time).is_ok())
    };
    let longer = |axes| Ticks::for_engine(clock_hz, phases, axes).unwrap_or(tick_ns);
    let tick_ns = axes.filter(|&axes| !fits(axes)).map_or(tick_ns, longer);
    format!("{} MHz (ticks of {tick_ns} ns in {phases} phases)", mhz(clock_hz))
}
