//! The rows, and what each may cost. A new part, tick or number of axes is a new row.

use crate::ice40::{Part, Size};
use carrystep_spec::board::Mapped;
use carrystep_spec::engine::clocks_of_turns;

/// Placements are tried with these; the best counts.
pub const SEEDS: [u32; 3] = [1, 2, 3];

/// Phases of a tick in `sim/six-axis.toml`.
const PHASES: u32 = 16;

/// An engine on an iCE40.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Row {
    /// Where it is placed.
    pub part: Part<'static>,
    /// Axes of the engine; `sim/six-axis.toml` says what they are.
    pub axes: usize,
    /// Tick in ns.
    pub tick_ns: u64,
    /// Clock in Hz.
    pub clock_hz: u64,
    /// What it may take.
    pub budget: Size,
    /// Whether the clock is reached: a row that says no stands in the table as what is missing.
    pub met: bool,
    /// Placed in every test run, not only by `cargo xtask resources`.
    pub always: bool,
}

impl Row {
    /// Clocks in a tick.
    pub const fn clocks_per_tick(&self) -> u64 {
        self.clock_hz * self.tick_ns / 1_000_000_000
    }

    /// The least clock in Hz whose tick holds the turns of its axes and divides into phases.
    pub const fn clock_needed_hz(&self) -> u64 {
        (self.clocks_needed().next_multiple_of(PHASES) as u64 * 1_000_000_000).div_ceil(self.tick_ns)
    }

    /// Clocks of a tick that the turns of its axes take.
    pub const fn clocks_needed(&self) -> u32 {
        clocks_of_turns(self.axes)
    }
}

const HX1K: Part<'_> = Part { device: "hx1k", package: "tq144" };
const HX8K: Part<'_> = Part { device: "hx8k", package: "ct256" };
const LP8K: Part<'_> = Part { device: "lp8k", package: "cm81" };
const UP5K: Part<'_> = Part { device: "up5k", package: "sg48" };

/// 2 us at 48 MHz.
const TWO: Row = Row {
    part: HX8K,
    axes: 6,
    tick_ns: 2000,
    clock_hz: 48_000_000,
    budget: Size { logic_cells: 895, block_rams: 8 },
    met: true,
    always: true,
};

/// 1 us at 80 MHz.
const ONE: Row = Row { tick_ns: 1000, clock_hz: 80_000_000, budget: Size { logic_cells: 910, block_rams: 8 }, ..TWO };

/// Six and eight axes beside each other: 2 us at the least clock that eight need.
const SIX: Row = Row { clock_hz: 56_000_000, always: false, ..TWO };
const EIGHT: Row = Row { axes: 8, budget: Size { logic_cells: 1020, block_rams: 8 }, ..SIX };

/// What eight axes may cost, in cells of six.
pub const EIGHT_TO_SIX: (Row, Row, f64) = (EIGHT, SIX, 1.15);

/// All rows for iCE40.
pub const ROWS: [Row; 9] = [
    TWO,
    ONE,
    Row { part: HX1K, ..TWO },
    Row { part: HX1K, always: false, ..ONE },
    Row { part: LP8K, always: false, ..TWO },
    Row { part: LP8K, always: false, met: false, ..ONE },
    // 40 MHz is the least that 2 us need.
    Row { part: UP5K, clock_hz: 40_000_000, ..TWO },
    SIX,
    EIGHT,
];

/// An engine in the cells of a Xilinx family.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Family {
    /// As yosys calls it.
    pub name: &'static str,
    /// The engine.
    pub of: Row,
    /// What it may take.
    pub budget: Mapped,
}

/// All rows for Xilinx: the engine of the first row.
pub const FAMILIES: [Family; 3] = [
    Family { name: "xc3s", of: TWO, budget: Mapped { luts: 700, flip_flops: 400, carries: 360, block_rams: 16 } },
    Family { name: "xc6s", of: TWO, budget: Mapped { luts: 690, flip_flops: 410, carries: 60, block_rams: 8 } },
    Family { name: "xc7", of: TWO, budget: Mapped { luts: 650, flip_flops: 410, carries: 60, block_rams: 6 } },
];
