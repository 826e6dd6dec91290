//! The parameters of the exported Verilog: the numbers that differ between builds of the same text.
//!
//! The number of axes, the number of phases and the kind of line are not among them: each has a text of its own.

use crate::primitives::formula::Given;

/// A parameter.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Described {
    /// Its name; one of an axis has the axis' number behind it, such as `STEP_HIGH_0`.
    pub name: &'static str,
    /// There is one for each axis.
    pub per_axis: bool,
    /// Its range.
    pub range: &'static str,
    /// What it is, with its unit.
    pub what: &'static str,
}

impl Described {
    const fn new(name: &'static str, range: &'static str, what: &'static str) -> Self {
        Self { name, per_axis: false, range, what }
    }

    const fn per_axis(name: &'static str, range: &'static str, what: &'static str) -> Self {
        Self { name, per_axis: true, range, what }
    }

    /// This parameter with the value that it has in a build. In a module that serves one axis, it is that axis'.
    pub fn of<const N: usize>(&self, value: impl Into<u64>) -> Given<N> {
        Given::new(self.name, value.into())
    }

    /// This parameter of one of the axes that a module serves.
    pub fn of_axis<const N: usize>(&self, axis: usize, value: impl Into<u64>) -> Given<N> {
        Given::new(format!("{}_{axis}", self.name), value.into())
    }
}

/// Clocks in a tick.
pub const CLOCKS_PER_TICK: Described = Described::new(
    "CLOCKS_PER_TICK",
    "13 for each axis and 1, and 2 for each phase, to 65536; a multiple of the phases",
    "length of a tick in clocks",
);
/// Where P starts.
pub const START_HALF: Described =
    Described::new("START_HALF", "0 or 1", "1: P starts at half a step; 0: P starts at zero");
/// W.
pub const STEP_HIGH: Described = Described::per_axis(
    "STEP_HIGH",
    "1 to 65536",
    "W, least time in clocks for which STEP is high",
);
/// S.
pub const STEP_LOW: Described =
    Described::per_axis("STEP_LOW", "1 to 65536", "S, least time in clocks for which STEP is low");
/// D.
pub const DIR_SETUP: Described = Described::per_axis(
    "DIR_SETUP",
    "1 to 65536",
    "D, least time in clocks from a change of DIR to a rise of STEP",
);
/// H.
pub const DIR_HOLD: Described = Described::per_axis(
    "DIR_HOLD",
    "1 to 65536",
    "H, least time in clocks from a rise of STEP to a change of DIR",
);
/// The ramp of a controlled stop.
pub const STOP_ACCEL: Described = Described::per_axis(
    "STOP_ACCEL",
    "1 to 2^62",
    "acceleration of the ramp of a controlled stop, in units of 2^-64 step per tick^2",
);
/// The unit of the guard's times.
pub const ROUND_TICKS: Described = Described::new(
    "ROUND_TICKS",
    "a power of two from 2 to 1024",
    "length of a round in ticks: the unit of the times below, and the time between two samples of a limit",
);
/// Debounce of the limits.
pub const DEBOUNCE_LOOKS: Described = Described::new(
    "DEBOUNCE_LOOKS",
    "1 to 127",
    "number of successive samples of the same level after which a limit's level is accepted",
);
/// The watchdog.
pub const WATCHDOG_ROUNDS: Described = Described::new(
    "WATCHDOG_ROUNDS",
    "0 to 4095",
    "time in rounds without a valid request after which all axes stop; 0: there is no watchdog",
);
/// The drivers' time to wake up.
pub const ENABLE_ROUNDS: Described = Described::new(
    "ENABLE_ROUNDS",
    "0 to 4095",
    "time in rounds from the rise of `enabled` to the first start",
);
/// Wiring of the limits.
pub const LIMITS: Described = Described::new(
    "LIMITS",
    "0 to 3",
    "limit switches: 0 none, 1 two an axis, 2 one an axis, 3 one for all axes",
);
/// Level of the limits.
pub const LIMITS_LOW: Described =
    Described::new("LIMITS_LOW", "0 or 1", "level at which a limit is reached: 0 high, 1 low");
/// What a limit does.
pub const LIMIT_FREEZES: Described = Described::new(
    "LIMIT_FREEZES",
    "0 or 1",
    "what a limit does: 0 all axes ramp down, 1 all axes freeze",
);
/// Level of the e-stop.
pub const ESTOP_LOW: Described =
    Described::new("ESTOP_LOW", "0 or 1", "level at which the e-stop is pressed: 0 high, 1 low");
/// Where the wheel of events lies.
pub const EVENT_MEMORY: Described = Described::new(
    "EVENT_MEMORY",
    "\"block\" or \"distributed\"",
    "where the memory of events lies: in block RAM, or in LUTs for parts whose block RAMs write whole words only",
);
/// The build id.
pub const BUILD_ID: Described = Described::new(
    "BUILD_ID",
    "any, but for each set of parameters another one",
    "build id, which the host compares before it uses the gateware: whoever overrides any other parameter must \
     override it too",
);
/// The clock.
pub const CLOCK_HZ: Described =
    Described::new("CLOCK_HZ", "1 to 10^9", "frequency of the clock in Hz, told to the host");
/// The tick.
pub const TICK_NS: Described =
    Described::new("TICK_NS", "1 to 2^32 - 1", "length of a tick in ns, told to the host");
/// The UART's bit.
pub const BIT_CLOCKS: Described = Described::new(
    "BIT_CLOCKS",
    "8 to 40000",
    "length of a bit of the UART in clocks: clock / baud rate",
);

/// All of them, in the order in which a module lists them.
pub const PARAMETERS: [Described; 20] = [
    BUILD_ID,
    CLOCK_HZ,
    TICK_NS,
    BIT_CLOCKS,
    CLOCKS_PER_TICK,
    START_HALF,
    STEP_HIGH,
    STEP_LOW,
    DIR_SETUP,
    DIR_HOLD,
    STOP_ACCEL,
    ROUND_TICKS,
    WATCHDOG_ROUNDS,
    ENABLE_ROUNDS,
    DEBOUNCE_LOOKS,
    LIMITS,
    LIMITS_LOW,
    LIMIT_FREEZES,
    ESTOP_LOW,
    EVENT_MEMORY,
];

/// The parameter of this name, and the axis whose it is.
pub fn described(name: &str) -> Option<(&'static Described, Option<usize>)> {
    let find = |name: &str| PARAMETERS.iter().find(|known| known.name == name);
    if let Some(known) = find(name) {
        return Some((known, None));
    }
    let (base, axis) = name.rsplit_once('_')?;
    Some((find(base).filter(|known| known.per_axis)?, Some(axis.parse().ok()?)))
}
