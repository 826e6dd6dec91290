//! Generates the module that makes a board's clock: a PLL, a DCM, an MMCM, or a wire.

use crate::ExportError;
use carrystep_boards::{Board, Part};
use carrystep_core::tick::mhz;
use minijinja::value::Serde;
use minijinja::{Value, context};

/// Width of the counter that enables the clock 2^10 clocks after the lock: after 12 us at 84 MHz.
/// The block RAMs of an iCE40 read zeros for some microseconds after configuration
/// (YosysHQ/icestorm issue 76: 36 clocks are too few at 25 MHz).
const WAIT_BITS: u32 = 10;

pub(super) fn verilog(
    board: &Board,
    part: &Part,
    clock_hz: u64,
    name: &str,
) -> Result<String, ExportError> {
    let family = board.family.facts();
    let values = context! {
        name,
        bits => WAIT_BITS,
        wait => 1_u32 << WAIT_BITS,
        title => &board.title,
        from => mhz(board.oscillator.hz),
        to => mhz(clock_hz),
        part => part.name.to_uppercase(),
        period_ns => super::period_ns(board.oscillator.hz),
        cell => family.clock_cell(board.pll),
        // "oscillator", or the settings under the name of the clock manager.
        made_by => Value::from(Serde(board.clock(clock_hz)?)),
    };
    super::rendered(family.clock_template(), values)
}
