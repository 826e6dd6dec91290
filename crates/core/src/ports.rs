//! The ports of the gateware's modules: one table for each. Benches, exported Verilog and the
//! documentation are made from these tables or compared with them; docs/clock-by-clock.md says what
//! each port means in every clock.
//!
//! The tables of the engine, of the link and of the lines are [`crate::engine::ENGINE_PORTS`],
//! [`crate::link::link_ports`] and [`crate::link::line_ports`].

use crate::build::AXES;
use crate::fault::Faults;
use crate::segment::Segment;

/// Direction of a port, seen from its module.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Direction {
    /// Into the module.
    Input,
    /// Out of the module.
    Output,
}

/// Width of a port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Width {
    /// This number of bits.
    Bits(u32),
    /// One bit for each axis of the build; bit i is axis i.
    Axes,
    /// 32 bits for each axis of the build; axis 0 is in the lowest bits.
    WordPerAxis,
    /// This number of bits for each adder of the engine; those of adder 0 are the lowest.
    PerAdder(u32),
}

impl Width {
    /// Number of bits in a build with this number of axes and one adder.
    pub const fn of(self, axes: usize) -> u32 {
        self.with_adders(axes, 1)
    }

    /// Number of bits in a build with these numbers of axes and of adders.
    pub const fn with_adders(self, axes: usize, adders: usize) -> u32 {
        match self {
            Self::PerAdder(bits) => bits * adders as u32,
            Self::Bits(bits) => bits,
            Self::Axes => axes as u32,
            Self::WordPerAxis => 32 * axes as u32,
        }
    }
}

/// What a port is connected to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Peer {
    /// The clock of all modules.
    Clock,
    /// The host's side. On a board that is the link for the engine, and the line for the link.
    Host,
    /// Pins of the FPGA.
    Pins,
    /// Nothing on a board: an input is tied to 0, an output is observed by simulations only.
    Nobody,
}

/// A port of a module.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Port {
    /// The port's name, the same in every simulation level.
    pub name: &'static str,
    /// Its direction.
    pub direction: Direction,
    /// Its width.
    pub width: Width,
    /// What it is connected to.
    pub peer: Peer,
    /// Name of the port that is 1 in the clocks in which this output is valid; `None` if the output
    /// is always valid.
    pub valid_with: Option<&'static str>,
    /// Meaning of the port.
    pub what: &'static str,
}

impl Port {
    /// The port of another module to which this one is connected: the other direction.
    #[must_use]
    pub const fn turned(self) -> Self {
        let direction = match self.direction {
            Direction::Input => Direction::Output,
            Direction::Output => Direction::Input,
        };
        Self { direction, ..self }
    }

    /// The same output, valid only while that port is 1.
    pub(crate) const fn valid_with(self, name: &'static str) -> Self {
        Self { valid_with: Some(name), ..self }
    }
}

pub(crate) const CLOCK: Port = input("clock", Width::Bits(1), Peer::Clock, "the clock");

pub(crate) const fn input(
    name: &'static str,
    width: Width,
    peer: Peer,
    what: &'static str,
) -> Port {
    Port { name, direction: Direction::Input, width, peer, valid_with: None, what }
}

pub(crate) const fn output(
    name: &'static str,
    width: Width,
    peer: Peer,
    what: &'static str,
) -> Port {
    Port { name, direction: Direction::Output, width, peer, valid_with: None, what }
}

const BIT: Width = Width::Bits(1);
const MASK: Width = Width::Axes;
const WORDS: Width = Width::WordPerAxis;

/// The ports of the parallel core, `carrystep_parallel_N` for N axes, in order.
pub const PARALLEL_PORTS: [Port; 24] = [
    CLOCK,
    input("seg_valid", BIT, Peer::Host, "the host offers a segment"),
    input("seg_axis", Width::Bits(3), Peer::Host, "the axis of that segment"),
    input("seg_ticks", Width::Bits(32), Peer::Host, "its length, ticks"),
    input("seg_v", Width::Bits(64), Peer::Host, "its V, 2^-64 step per tick"),
    input("seg_a", Width::Bits(64), Peer::Host, "its A, 2^-64 step per tick^2"),
    input("seg_j", Width::Bits(64), Peer::Host, "its J, 2^-64 step per tick^3"),
    input("seg_last", BIT, Peer::Host, "it is the last of its move"),
    output("seg_ready", BIT, Peer::Host, "the core accepts an offered segment in this clock"),
    input("start_valid", BIT, Peer::Host, "the host offers a start"),
    input("start_mask", MASK, Peer::Host, "the axes to start on one tick"),
    output("start_ready", BIT, Peer::Host, "the core accepts an offered start in this clock"),
    input("clear", BIT, Peer::Host, "resume after a fault"),
    output("step", MASK, Peer::Pins, "the STEP pins"),
    output("dir", MASK, Peer::Pins, "the DIR pins; 1 is backward"),
    output("position", WORDS, Peer::Host, "steps of each axis, 32 bits each, axis 0 lowest"),
    output("discarded", WORDS, Peer::Host, "steps that freezes have discarded, likewise"),
    output("idle", BIT, Peer::Host, "all axes are at rest and no start is armed"),
    output("fault", BIT, Peer::Host, "the core is frozen"),
    output("overrun", MASK, Peer::Host, "axes with a second step while one was held back"),
    output("overspeed", MASK, Peer::Host, "axes whose V would have left its range"),
    output("underrun", MASK, Peer::Host, "axes without a segment in the middle of a move"),
    output("protocol", BIT, Peer::Host, "the host has broken the segment protocol"),
    output("started", BIT, Peer::Nobody, "axes start at the end of this clock"),
];

/// Input values of the core in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Inputs {
    /// The axis, 0 to 7, and the segment that the host offers, if any. In a core of N axes, the
    /// axes from N on do not exist.
    pub segment: Option<(u8, Segment)>,
    /// Mask of the axes whose start the host offers, if any. The port of a core of N axes has the
    /// lowest N bits of it.
    pub start: Option<u8>,
    /// Resume after a fault.
    pub clear: bool,
}

/// Output values of the core in one clock cycle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Outputs {
    /// The core accepts the offered segment in this cycle.
    pub seg_ready: bool,
    /// The core accepts the offered start in this cycle.
    pub start_ready: bool,
    /// Levels of the STEP pins; bit i is axis i.
    pub step: u8,
    /// Levels of the DIR pins; bit i is axis i, 1 is backward.
    pub dir: u8,
    /// Position registers, in steps; 0 for axes that the core does not have.
    pub position: [i32; AXES],
    /// Number of steps per axis that a freeze discarded; 0 for axes that the core does not have.
    pub discarded: [u32; AXES],
    /// All axes have finished and no start is armed.
    pub idle: bool,
    /// Latched faults.
    pub faults: Faults,
    /// Axes start at the end of this cycle.
    pub started: bool,
}
