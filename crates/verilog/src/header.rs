//! The header of an exported file: its module, the numbers of its build, and what holds for all
//! ports.

use carrystep_core::{PinTiming, StartPhase, Timebase};

/// The version that the workspace pins.
const RUST_HDL: &str = "0.46.0";

/// The notes of a core that moves motors.
pub(crate) const MOTION: &str = "\
// Ports: inputs are sampled at the rising edge of `clock`, and outputs change after it; an output
// can also depend on inputs of the same clock. Signals are active high. The comment of a port says
// if it is otherwise; an asynchronous input may come directly from a pin. P is in 2^-64 step, V in
// 2^-64 step per tick, A in 2^-64 step per tick^2, and J in 2^-64 step per tick^3.
//
// The numbers of a build are parameters of the modules. If you override one, override BUILD_ID of
// the host link too: by this id the host knows the parameters for which it plans moves. With the id
// of other parameters it plans wrong moves, which is unsafe. The defaults of the parameters:
";

/// The notes of the self-test.
pub(crate) const SELF_TEST: &str = "\
// Ports: inputs are sampled at the rising edge of `clock`, and outputs change after it. Signals are
// active high. An asynchronous input may come directly from a pin.
";

/// Contents of the header.
pub(crate) struct Facts {
    /// The module in a few words.
    pub(crate) title: String,
    /// Comment lines about all ports and parameters.
    pub(crate) notes: &'static str,
    /// Comment lines about the build.
    pub(crate) lines: String,
}

impl Facts {
    /// The facts of a core that drives axes with these pin timings. `guard` is more lines.
    pub(crate) fn of_axes<'a>(
        time: &Timebase,
        phase: StartPhase,
        pins: impl ExactSizeIterator<Item = &'a PinTiming>,
        guard: &str,
    ) -> Self {
        let start = match phase {
            StartPhase::Half => "half a step",
            StartPhase::Zero => "0",
        };
        let mut lines = format!(
            "\
// Clock        {clock} Hz
// Tick         {tick} ns, {clocks} clocks in {phases} phases
// Latency      {latency} clocks from the load of a move to the edge of its tick 1, phase 0
// P starts at  {start}
// Pins         in clocks: STEP high, STEP low, DIR before STEP, DIR after STEP
",
            clock = time.clock_hz(),
            tick = time.tick_ns(),
            clocks = time.clocks_per_tick(),
            phases = time.phases(),
            latency = time.latency_clocks(),
        );
        let axes = match pins.len() {
            1 => "one axis".to_owned(),
            count => {
                let numbers = ["two", "three", "four", "five", "six", "seven", "eight"];
                let number = count.checked_sub(2).and_then(|place| numbers.get(place));
                format!("{} axes", number.unwrap_or(&"many"))
            }
        };
        for (axis, PinTiming { step_high, step_low, dir_setup, dir_hold }) in pins.enumerate() {
            lines.push_str(&format!(
                "//   axis {axis}     STEP_HIGH {step_high}, STEP_LOW {step_low}, \
                 DIR_SETUP {dir_setup}, DIR_HOLD {dir_hold}\n"
            ));
        }
        let title = format!("step and direction for {axes}");
        Self { title, notes: MOTION, lines: lines + guard }
    }
}

/// The header of the file of this top module.
pub(crate) fn header(name: &str, facts: &Facts, description: &str) -> String {
    let description = description.replace(['\n', '\r'], " ");
    let Facts { title, notes, lines } = facts;
    format!(
        "\
// SPDX-License-Identifier: MIT OR Apache-2.0
//
// {name}: {title}.
// This file is generated: change the generator instead.
//
// Made from    {description}
// Made by      carrystep {version}, with Rust-HDL {RUST_HDL}
//
{notes}//
{lines}
`default_nettype none
",
        version = env!("CARGO_PKG_VERSION"),
    )
}
