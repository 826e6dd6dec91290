//! Generates the module that makes a board's clock: a PLL, a DCM, an MMCM, or a wire.

use crate::ExportError;
use carrystep_boards::clock::{ClockManager, Dcm, Ice40Pll, Mmcm};
use carrystep_boards::{Board, Family, PllInput};
use carrystep_core::tick::mhz;
use minijinja::{Value, context};

/// Width of the counter that enables the clock 2^10 clocks after the lock: after 12 us at 84 MHz.
/// The block RAMs of an iCE40 read zeros for some microseconds after configuration
/// (YosysHQ/icestorm issue 76: 36 clocks are too few at 25 MHz).
const WAIT_BITS: u32 = 10;

const TEMPLATE: &str = include_str!("../../templates/board/clock.v");

pub(super) fn verilog(board: &Board, clock_hz: u64) -> Result<String, ExportError> {
    let made_by = board.clock(clock_hz)?;
    let none = Value::from(());
    let (cell, settings) = match made_by {
        ClockManager::Oscillator => ("", none),
        ClockManager::Ice40Pll(Ice40Pll { divr, divf, divq, filter_range }) => {
            let cell = if board.pll == Some(PllInput::Pad) { "SB_PLL40_PAD" } else { "SB_PLL40_CORE" };
            (cell, context! { divr, divf, divq, filter_range })
        }
        ClockManager::Dcm(Dcm { multiply, divide }) => {
            (if board.family == Family::Spartan3 { "DCM" } else { "DCM_SP" }, context! { multiply, divide })
        }
        ClockManager::Mmcm(Mmcm { multiply, divide, out_divide }) => {
            ("MMCME2_BASE", context! { multiply, divide, out_divide })
        }
    };
    let values = context! {
        ice40 => board.family == Family::Ice40,
        bits => WAIT_BITS,
        wait => 1_u32 << WAIT_BITS,
        title => &board.title,
        from => mhz(board.oscillator.hz),
        to => mhz(clock_hz),
        period_ns => super::period_ns(board.oscillator.hz),
        cell,
        settings,
    };
    super::rendered(TEMPLATE, values)
}
