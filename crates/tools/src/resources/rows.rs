//! The rows and their budgets. A new part, tick or number of axes needs a new row.

use crate::ice40::{NextpnrPart, Size};
use carrystep_boards::Mapped;
use carrystep_core::engine::{QUEUE_DEPTHS, clocks_of_time_slots};

/// Seeds of placement; the best result counts.
pub const SEEDS: [u32; 3] = [1, 2, 3];

/// Phases of a tick in `sim/six-axis.toml`.
const PHASES: u32 = 16;

/// An engine on an iCE40.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EngineRow {
    /// The part.
    pub part: NextpnrPart<'static>,
    /// Axes of the engine; `sim/six-axis.toml` says what they are.
    pub axes: usize,
    /// Tick, ns.
    pub tick_ns: u64,
    /// Clock, Hz.
    pub clock_hz: u64,
    /// Number of segments that the queue of an axis holds.
    pub queue: usize,
    /// Whether the engine has everything that can be left out: limits at both ends, inputs, latch,
    /// outputs, PWM and cuts.
    pub all: bool,
    /// Budget of the engine.
    pub budget: Size,
    /// Whether the clock is reached. A row with `false` stands in the table as not reached.
    pub met: bool,
    /// Whether every test run places this row, and not only `cargo xtask resources`.
    pub always: bool,
}

impl EngineRow {
    /// Number of clocks per tick.
    pub const fn clocks_per_tick(&self) -> u64 {
        self.clock_hz * self.tick_ns / 1_000_000_000
    }

    /// The slowest clock, Hz, whose tick holds the time slots of all axes and divides into phases.
    pub const fn clock_needed_hz(&self) -> u64 {
        (self.clocks_needed().next_multiple_of(PHASES) as u64 * 1_000_000_000)
            .div_ceil(self.tick_ns)
    }

    /// Number of clocks of a tick that the time slots of all axes need.
    pub const fn clocks_needed(&self) -> u32 {
        clocks_of_time_slots(self.axes)
    }
}

const HX1K: NextpnrPart<'_> = NextpnrPart { device: "hx1k", package: "tq144" };
const HX8K: NextpnrPart<'_> = NextpnrPart { device: "hx8k", package: "ct256" };
const LP8K: NextpnrPart<'_> = NextpnrPart { device: "lp8k", package: "cm81" };
const UP5K: NextpnrPart<'_> = NextpnrPart { device: "up5k", package: "sg48" };

/// A tick of 2 us at 48 MHz.
const TWO: EngineRow = EngineRow {
    part: HX8K,
    axes: 6,
    tick_ns: 2000,
    clock_hz: 48_000_000,
    queue: QUEUE_DEPTHS[0],
    all: false,
    budget: Size { logic_cells: 930, block_rams: 9 },
    met: true,
    always: true,
};

/// A tick of 1 us at 80 MHz.
const ONE: EngineRow = EngineRow {
    tick_ns: 1000,
    clock_hz: 80_000_000,
    budget: Size { logic_cells: 940, block_rams: 9 },
    ..TWO
};

/// Six axes to be compared with eight: a tick of 2 us at the slowest clock that eight axes need.
const SIX: EngineRow = EngineRow { clock_hz: 56_000_000, always: false, ..TWO };
const EIGHT: EngineRow =
    EngineRow { axes: 8, budget: Size { logic_cells: 1050, block_rams: 13 }, ..SIX };

/// Eight axes, six axes, and the greatest ratio of their logic cells.
pub const EIGHT_TO_SIX: (EngineRow, EngineRow, f64) = (EIGHT, SIX, 1.15);

/// Everything built in, and the queues of seven segments.
const ALL_TWO: EngineRow = EngineRow {
    all: true,
    budget: Size { logic_cells: 1060, block_rams: 11 },
    always: false,
    ..TWO
};

/// Everything built in, with a tick of 1 us at 80 MHz.
const ALL_ONE: EngineRow = EngineRow {
    all: true,
    budget: Size { logic_cells: 1060, block_rams: 11 },
    always: false,
    ..ONE
};

/// All rows for iCE40.
pub const ROWS: [EngineRow; 13] = [
    TWO,
    ONE,
    EngineRow { part: HX1K, ..TWO },
    EngineRow { part: HX1K, always: false, ..ONE },
    EngineRow { part: LP8K, always: false, ..TWO },
    EngineRow { part: LP8K, always: false, met: false, ..ONE },
    // 40 MHz is the slowest clock for a tick of 2 us.
    EngineRow {
        part: UP5K,
        clock_hz: 40_000_000,
        budget: Size { logic_cells: 930, block_rams: 9 },
        ..TWO
    },
    SIX,
    EIGHT,
    ALL_TWO,
    ALL_ONE,
    EngineRow {
        queue: QUEUE_DEPTHS[1],
        budget: Size { logic_cells: 1085, block_rams: 15 },
        ..ALL_TWO
    },
    EngineRow {
        queue: QUEUE_DEPTHS[2],
        budget: Size { logic_cells: 1115, block_rams: 23 },
        ..ALL_TWO
    },
];

/// The rows that stand beside cores of other projects, synthesised as they were.
pub const BESIDE_OTHERS: [EngineRow; 2] = [TWO, ONE];

/// An engine in the cells of a Xilinx family.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FamilyRow {
    /// Name of the family in yosys.
    pub name: &'static str,
    /// The engine.
    pub of: EngineRow,
    /// Budget of the engine.
    pub budget: Mapped,
}

/// All rows for Xilinx; each has the engine of the first row.
pub const FAMILIES: [FamilyRow; 3] = [
    FamilyRow {
        name: "xc3s",
        of: TWO,
        budget: Mapped { luts: 815, flip_flops: 430, carries: 375, block_rams: 16 },
    },
    FamilyRow {
        name: "xc6s",
        of: TWO,
        budget: Mapped { luts: 760, flip_flops: 430, carries: 60, block_rams: 8 },
    },
    FamilyRow {
        name: "xc7",
        of: TWO,
        budget: Mapped { luts: 720, flip_flops: 430, carries: 60, block_rams: 6 },
    },
];

/// Engine, link and UART with everything that can be left out and the deepest queues, in the cells
/// of an ECP5. A LUT is one as nextpnr counts them, with those of carry chains.
pub const ECP5: FamilyRow = FamilyRow {
    name: "ecp5",
    of: EngineRow { queue: QUEUE_DEPTHS[2], ..ALL_ONE },
    budget: Mapped { luts: 1850, flip_flops: 630, carries: 140, block_rams: 17 },
};

/// The same in the cells of a Gowin part, with a tick of 2 us at 48 MHz. Its budget of LUTs is that
/// of a GW1NR-9.
pub const GOWIN: FamilyRow = FamilyRow {
    name: "gowin",
    of: EngineRow { queue: QUEUE_DEPTHS[2], ..ALL_TWO },
    budget: Mapped { luts: 1950, flip_flops: 630, carries: 400, block_rams: 17 },
};
