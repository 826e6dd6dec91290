//! The parameters of the exported Verilog. Builds that share one Verilog text differ only in the
//! values of these parameters.
//!
//! The number of axes, the number of phases and the kind of line to the host are not parameters:
//! for each of their values there is a Verilog text of its own.

use crate::primitives::formula::Given;

/// A parameter of the exported Verilog.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Described {
    /// Its name. A parameter of an axis is followed by the number of the axis, as in
    /// `STEP_HIGH_0`.
    pub name: &'static str,
    /// Whether each axis has its own value.
    pub per_axis: bool,
    /// Whether each latch has its own value. That of latch 0 has no number behind its name.
    pub per_latch: bool,
    /// The values that it may have. The Verilog prints them after `what`.
    pub range: &'static str,
    /// Its meaning and its unit. The Verilog prints this text, with a capital, above the parameter.
    pub what: &'static str,
}

impl Described {
    const fn new(name: &'static str, range: &'static str, what: &'static str) -> Self {
        Self { name, per_axis: false, per_latch: false, range, what }
    }

    const fn per_axis(name: &'static str, range: &'static str, what: &'static str) -> Self {
        Self { name, per_axis: true, per_latch: false, range, what }
    }

    const fn per_latch(name: &'static str, range: &'static str, what: &'static str) -> Self {
        Self { name, per_axis: false, per_latch: true, range, what }
    }

    /// This parameter with its value in a build. In a module that serves one axis, it is the
    /// parameter of that axis.
    pub fn of<const N: usize>(&self, value: impl Into<u64>) -> Given<N> {
        Given::new(self.name, value.into())
    }

    /// The parameter of one latch, with its value in a build, in a module that serves several
    /// latches.
    pub fn of_latch<const N: usize>(&self, latch: usize, value: impl Into<u64>) -> Given<N> {
        match latch {
            0 => self.of(value),
            _ => Given::new(format!("{}_{latch}", self.name), value.into()),
        }
    }

    /// The parameter of one axis, with its value in a build, in a module that serves several axes.
    pub fn of_axis<const N: usize>(&self, axis: usize, value: impl Into<u64>) -> Given<N> {
        Given::new(format!("{}_{axis}", self.name), value.into())
    }
}

/// The length of a tick. The lower bound is that of the engine; the parallel core accepts less.
pub const CLOCKS_PER_TICK: Described = Described::new(
    "CLOCKS_PER_TICK",
    "a multiple of the phases, from 13 x axes + 1 and 2 x phases to 65536",
    "clocks per tick",
);
/// The start value of P.
pub const START_HALF: Described =
    Described::new("START_HALF", "0 or 1", "start value of P: 1 half a step, 0 zero");
/// The least time of STEP high.
pub const STEP_HIGH: Described = Described::per_axis(
    "STEP_HIGH",
    "1 to 65536",
    "the minimum time in clocks for which STEP is high",
);
/// The least time of STEP low.
pub const STEP_LOW: Described = Described::per_axis(
    "STEP_LOW",
    "1 to 65536",
    "the minimum time in clocks for which STEP is low",
);
/// The set-up time of DIR before STEP.
pub const DIR_SETUP: Described = Described::per_axis(
    "DIR_SETUP",
    "1 to 65536",
    "the minimum time in clocks from a change of DIR to a rising edge of STEP",
);
/// The hold time of DIR after STEP.
pub const DIR_HOLD: Described = Described::per_axis(
    "DIR_HOLD",
    "1 to 65536",
    "the minimum time in clocks from a rising edge of STEP to a change of DIR",
);
/// The acceleration of the ramp in a controlled stop.
pub const STOP_ACCEL: Described = Described::per_axis(
    "STOP_ACCEL",
    "1 to 2^62",
    "acceleration of the ramp in a controlled stop, in 2^-64 step per tick^2",
);
/// The length of a round, which is the unit of the guard's times. Each switch is sampled once per
/// round.
pub const ROUND_TICKS: Described = Described::new(
    "ROUND_TICKS",
    "a power of two from 2 to 1024",
    "length of a round, the unit of the times below, in ticks",
);
/// The number of samples by which the switches are debounced.
pub const DEBOUNCE_SAMPLES: Described = Described::new(
    "DEBOUNCE_SAMPLES",
    "1 to 127",
    "equal consecutive samples, one per round, that change a switch's debounced state",
);
/// The timeout of the watchdog.
pub const WATCHDOG_ROUNDS: Described = Described::new(
    "WATCHDOG_ROUNDS",
    "0 to 4095",
    "rounds without a valid frame of the host after which all axes stop; 0: no watchdog",
);
/// The time that the drivers need after they have been powered.
pub const ENABLE_ROUNDS: Described = Described::new(
    "ENABLE_ROUNDS",
    "0 to 4095",
    "rounds from the rising edge of `enabled` until starts are accepted",
);
/// The wiring of the limit switches.
pub const LIMITS: Described = Described::new(
    "LIMITS",
    "0 to 3",
    "limit switches: 0 none, 1 two per axis, 2 one per axis, 3 one for all axes",
);
/// The active level of the limit switches.
pub const LIMITS_LOW: Described =
    Described::new("LIMITS_LOW", "0 or 1", "active level of the limit switches: 0 high, 1 low");
/// The inputs of row 2 that exist.
pub const INPUTS_0: Described = Described::new(
    "INPUTS_0",
    "a mask with one bit per axis",
    "the inputs at `inputs_0` that exist; bit 0 is the probe",
);
/// The active level of the inputs of row 2.
pub const INPUTS_0_LOW: Described =
    Described::new("INPUTS_0_LOW", "a part of INPUTS_0", "those of them that are active low");
/// The inputs of row 3 that exist.
pub const INPUTS_1: Described = Described::new(
    "INPUTS_1",
    "a mask with one bit per axis",
    "the inputs at `inputs_1` that exist; bit 0 is the interlock",
);
/// The active level of the inputs of row 3.
pub const INPUTS_1_LOW: Described =
    Described::new("INPUTS_1_LOW", "a part of INPUTS_1", "those of them that are active low");
/// The number of strobes that must find the latch's pin active.
pub const LATCH_LOOKS: Described = Described::per_latch(
    "LATCH_LOOKS",
    "0 to 16",
    "consecutive ticks that must find the latch active for an edge; 0: no latch",
);
/// The active level of the latch.
pub const LATCH_LOW: Described =
    Described::per_latch("LATCH_LOW", "0 or 1", "active level of the latch: 0 high, 1 low");
/// The kind of stop that a limit triggers.
pub const LIMIT_FREEZES: Described = Described::new(
    "LIMIT_FREEZES",
    "0 or 1",
    "effect of a limit: 0 all axes ramp down, 1 all axes freeze",
);
/// The active level of the e-stop.
pub const ESTOP_LOW: Described =
    Described::new("ESTOP_LOW", "0 or 1", "active level of the e-stop: 0 high, 1 low");
/// The outputs that exist.
pub const OUTPUTS: Described =
    Described::new("OUTPUTS", "a mask of 8 bits", "the outputs at `outputs` that exist");
/// Whether ramps turn the outputs off.
pub const OUTPUTS_OFF_AT_RAMPS: Described = Described::new(
    "OUTPUTS_OFF_AT_RAMPS",
    "0 or 1",
    "effect of a stop by ramps on outputs and PWM: 0 none, 1 all off; a freeze turns them off",
);
/// The length of a step of the PWM.
pub const PWM_DIVIDER: Described = Described::new(
    "PWM_DIVIDER",
    "0 to 256",
    "length of each of the 4096 steps of a period of the PWM, in clocks; 0: no PWM",
);
/// Whether cuts exist.
pub const CUTS: Described =
    Described::new("CUTS", "0 or 1", "cuts: 0 each is refused, 1 they exist");
/// The kind of memory in which the event wheel keeps its events. The wheel writes single bits of a
/// word, for which a block RAM needs a write mask.
pub const EVENT_MEMORY: Described = Described::new(
    "EVENT_MEMORY",
    "\"block\" or \"distributed\"",
    "event memory: block RAM, or LUTs if block RAM has no write mask",
);
/// The build id, which the host compares before it uses the gateware.
pub const BUILD_ID: Described = Described::new(
    "BUILD_ID",
    "unique per set of parameters",
    "build id: override it whenever you override another parameter",
);
/// The frequency of the clock.
pub const CLOCK_HZ: Described =
    Described::new("CLOCK_HZ", "1 to 10^9", "frequency of the clock in Hz, reported to the host");
/// The length of a tick as the host reads it.
pub const TICK_NS: Described =
    Described::new("TICK_NS", "1 to 2^32 - 1", "length of a tick in ns, reported to the host");
/// The length of a bit of the UART.
pub const BIT_CLOCKS: Described = Described::new(
    "BIT_CLOCKS",
    "8 to 40000",
    "length of a UART bit in clocks: clock frequency / baud rate",
);
/// Half a period of the self-test.
pub const HALF_CLOCKS: Described = Described::new(
    "HALF_CLOCKS",
    "1 to 2^30",
    "length of half a period in clocks; an output is active for one period, a second",
);

/// All parameters, in the order in which a module lists them.
pub const PARAMETERS: [Described; 31] = [
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
    DEBOUNCE_SAMPLES,
    LIMITS,
    LIMITS_LOW,
    LIMIT_FREEZES,
    INPUTS_0,
    INPUTS_0_LOW,
    INPUTS_1,
    INPUTS_1_LOW,
    LATCH_LOOKS,
    LATCH_LOW,
    ESTOP_LOW,
    OUTPUTS,
    OUTPUTS_OFF_AT_RAMPS,
    PWM_DIVIDER,
    CUTS,
    EVENT_MEMORY,
    HALF_CLOCKS,
];

/// The parameter with this name, and the number of its axis or latch if the name ends with one.
pub fn described(name: &str) -> Option<(&'static Described, Option<usize>)> {
    let find = |name: &str| PARAMETERS.iter().find(|known| known.name == name);
    if let Some(known) = find(name) {
        return Some((known, None));
    }
    let (base, axis) = name.rsplit_once('_')?;
    Some((find(base).filter(|known| known.per_axis || known.per_latch)?, Some(axis.parse().ok()?)))
}
