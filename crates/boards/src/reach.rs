//! Whether a board's part is fast enough for a clock, before hours of placement show it.

use super::{Board, BoardError, Clocking, Measured, Part, Placed};
use carrystep_core::build::Timebase;
use carrystep_core::engine::check_schedule;
use carrystep_core::tick::Ticks;
use carrystep_core::tick::mhz;

/// How far over the clock that was measured a placement of another gateware or by another seed may come, percent.
const MARGIN_PERCENT: u64 = 10;

impl Board {
    /// Whether a clock, Hz, is one that placement of an engine of so many axes on this part may reach: up to 10 %
    /// over what nextpnr was measured to reach on it. Of a part that nobody measured nothing is known.
    ///
    /// # Errors
    /// [`BoardError::Slow`] names what was measured, and the clocks and ticks that the board makes.
    pub fn may_reach(&self, part: &Part, clock_hz: u64, axes: usize) -> Result<(), BoardError> {
        let Some(Measured::Placed(Placed { nextpnr_mhz, .. })) = self.measured() else { return Ok(()) };
        let measured_hz = (nextpnr_mhz * 1e6).round() as u64;
        let measured = self.parts.first() == Some(part);
        let proposed = self.clocks.iter().any(|clock| clock.clock_hz == clock_hz);
        if !measured || proposed || clock_hz <= measured_hz + measured_hz * MARGIN_PERCENT / 100 {
            return Ok(());
        }
        let board = self.name.clone();
        Err(BoardError::Slow { board, wanted_hz: clock_hz, measured_hz, proposed: self.proposed(Some(axes)) })
    }

    /// The clocks and ticks that it is proposed to run at; with so many axes, where ticks are to hold their turns.
    pub fn proposed(&self, axes: Option<usize>) -> String {
        let clocks: Vec<String> = self.clocks.iter().map(|clock| said(clock, axes)).collect();
        clocks.join(" or ")
    }
}

/// `37.5 MHz (ticks of 2560 ns in 16 phases)`.
fn said(clock: &Clocking, axes: Option<usize>) -> String {
    let Clocking { clock_hz, tick_ns, phases, .. } = *clock;
    let fits = |axes| Timebase::new(clock_hz, tick_ns, phases).is_ok_and(|time| check_schedule(axes, &time).is_ok());
    let longer = |axes| Ticks::for_engine(clock_hz, phases, axes).unwrap_or(tick_ns);
    let tick_ns = axes.filter(|&axes| !fits(axes)).map_or(tick_ns, longer);
    format!("{} MHz (ticks of {tick_ns} ns in {phases} phases)", mhz(clock_hz))
}

#[cfg(test)]
mod tests {
    use crate::{board, boards};

    #[test]
    fn every_board_may_reach_its_own_clocks() {
        for board in boards() {
            for clock in &board.clocks {
                board.may_reach(&board.parts[0], clock.clock_hz, 6).unwrap();
            }
        }
    }

    #[test]
    fn a_clock_that_is_far_too_fast_is_refused_with_those_that_the_board_makes() {
        let icebreaker = board("icebreaker").unwrap();
        let refused = |axes| icebreaker.may_reach(&icebreaker.parts[0], 48_000_000, axes).unwrap_err().to_string();
        let said = refused(6);
        assert!(
            said.ends_with("37.5 MHz (ticks of 2560 ns in 16 phases) or 30 MHz (ticks of 3200 ns in 16 phases)"),
            "{said}"
        );
        // The turns of eight axes need 105 clocks.
        assert!(refused(8).contains("37.5 MHz (ticks of 3840 ns"), "{}", refused(8));
    }
}
