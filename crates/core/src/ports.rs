//! The ports of the six-axis core, once: benches, drivers of simulations and documentation come from
//! this table (meaning of each port: docs/clock-by-clock.md).

use crate::build::AXES;
use crate::fault::Faults;
use crate::segment::Segment;

/// Whether a port goes into or out of the core.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Into the core.
    Input,
    /// Out of the core.
    Output,
}

/// One port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Port {
    /// Its name in every level.
    pub name: &'static str,
    /// Which way it goes.
    pub direction: Direction,
    /// Bits.
    pub width: u32,
}

const fn input(name: &'static str, width: u32) -> Port {
    Port { name, direction: Direction::Input, width }
}

const fn output(name: &'static str, width: u32) -> Port {
    Port { name, direction: Direction::Output, width }
}

/// The ports of `carrystep_six_axis`, in order.
pub const SIX_AXIS_PORTS: [Port; 24] = [
    input("clock", 1),
    input("seg_valid", 1),
    input("seg_axis", 3),
    input("seg_ticks", 32),
    input("seg_v", 64),
    input("seg_a", 64),
    input("seg_j", 64),
    input("seg_last", 1),
    output("seg_ready", 1),
    input("start_valid", 1),
    input("start_mask", 6),
    output("start_ready", 1),
    input("clear", 1),
    output("step", 6),
    output("dir", 6),
    output("position", 192),
    output("discarded", 192),
    output("idle", 1),
    output("fault", 1),
    output("overrun", 6),
    output("overspeed", 6),
    output("underrun", 6),
    output("protocol", 1),
    output("started", 1),
];

/// What a host drives in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Inputs {
    /// A segment is offered to this axis (0 to 7; 6 and 7 do not exist).
    pub segment: Option<(u8, Segment)>,
    /// A start of these axes is offered.
    pub start: Option<u8>,
    /// Resume after a fault.
    pub clear: bool,
}

/// What the core shows in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Outputs {
    /// The offered segment is taken in this cycle.
    pub seg_ready: bool,
    /// The offered start is taken in this cycle.
    pub start_ready: bool,
    /// STEP pins, bit i is axis i.
    pub step: u8,
    /// DIR pins, 1 is backward.
    pub dir: u8,
    /// Position registers, steps.
    pub position: [i32; AXES],
    /// Steps that a freeze discarded.
    pub discarded: [u32; AXES],
    /// All axes are done and no start is armed.
    pub idle: bool,
    /// What is latched.
    pub faults: Faults,
    /// Axes start at the end of this cycle.
    pub started: bool,
}
