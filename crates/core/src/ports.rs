//! The ports of the six-axis core. Benches, simulation drivers and the documentation are made from
//! this table; docs/clock-by-clock.md says what each port means.

use crate::build::AXES;
use crate::fault::Faults;
use crate::segment::Segment;

/// Direction of a port, seen from the core.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Into the core.
    Input,
    /// Out of the core.
    Output,
}

/// A port of the core.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Port {
    /// The port's name, the same in every simulation level.
    pub name: &'static str,
    /// Its direction.
    pub direction: Direction,
    /// Width in bits.
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

/// Input values of the core in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Inputs {
    /// The axis (0 to 7; 6 and 7 do not exist) and the segment that the host offers, if any.
    pub segment: Option<(u8, Segment)>,
    /// Mask of the axes whose start the host offers, if any.
    pub start: Option<u8>,
    /// Resume after a fault.
    pub clear: bool,
}

/// Output values of the core in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Outputs {
    /// The core accepts the offered segment in this cycle.
    pub seg_ready: bool,
    /// The core accepts the offered start in this cycle.
    pub start_ready: bool,
    /// Levels of the STEP pins; bit i is axis i.
    pub step: u8,
    /// Levels of the DIR pins; bit i is axis i, 1 is backward.
    pub dir: u8,
    /// Position registers, in steps.
    pub position: [i32; AXES],
    /// Number of steps per axis that a freeze discarded.
    pub discarded: [u32; AXES],
    /// All axes have finished and no start is armed.
    pub idle: bool,
    /// Latched faults.
    pub faults: Faults,
    /// Axes start at the end of this cycle.
    pub started: bool,
}
