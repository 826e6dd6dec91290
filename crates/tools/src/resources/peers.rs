//! Step generators of other projects, measured once with this flow: yosys 0.23, nextpnr 0.4, HX8K,
//! median of three seeds, the core alone.

/// A core of another project, for six axes.
pub(super) struct Peer {
    pub core: &'static str,
    /// What the hardware does without the host between two commands.
    pub ramp: &'static str,
    /// The driver timings that the core ensures.
    pub pins: &'static str,
    pub queue: &'static str,
    pub logic_cells: u32,
    pub mhz: u32,
}

const fn peer(
    core: &'static str,
    ramp: &'static str,
    pins: &'static str,
    queue: &'static str,
    logic_cells: u32,
    mhz: u32,
) -> Peer {
    Peer { core, ramp, pins, queue, logic_cells, mhz }
}

pub(super) const PEERS: [Peer; 10] = [
    peer("hexastorm, degree 2", "2nd order", "none", "outside", 724, 106),
    peer("LinuxCNC-RIO joint", "none", "none", "none", 1260, 85),
    peer("stpcntrl", "2nd order", "direction one clock early", "64 deep, outside", 1328, 88),
    peer("RAPcores DDA", "2nd order", "none", "2 deep", 1449, 61),
    peer("hexastorm, degree 3", "3rd order", "none", "outside", 1642, 87),
    peer("SSBCC stepper", "2nd order", "none", "16 deep, in 18 block RAMs", 1697, 116),
    peer("hostmot2 stepgen", "none", "all four, stalls", "none", 1897, 79),
    peer("riocore stepdir", "none", "width, direction delay", "none", 2409, 61),
    peer("valurap", "4th order", "drops the step, flags", "8192 deep", 4468, 41),
    peer("LiteX-CNC 1.3.4", "accel-limited velocity", "width, hold, set-up", "1", 5236, 57),
];
