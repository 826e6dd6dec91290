//! The commands with which yosys turns Verilog into cells of an iCE40.
//!
//! The scripts of the boards and the tools both have them from here, so what is proved and measured
//! is what a user builds.

/// Carry chains of at most so many bits are mapped to LUTs. nextpnr spends a cell on a first carry
/// that comes from logic, and another one on a last carry that logic reads.
const NARROW_BITS: u32 = 5;

/// Clock enables of fewer flip-flops than this become logic. The eight cells of a tile share one
/// enable.
const LEAST_ENABLED: u32 = 3;

/// Parts, as yosys calls them, and the delay of a wire in them, ps, that abc9 assumes: 1.8 times
/// yosys' own. With yosys' own the engine with everything reached 69 to 74 MHz in an HX8K, with these
/// it reaches 83 to 86 MHz.
const DEVICES: [(&str, u32); 3] = [("hx", 450), ("lp", 720), ("u", 1350)];

/// The commands with which yosys synthesises a module for an iCE40. It has read the Verilog.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Ice40Synthesis {
    /// Up to the flip-flops of the part. Logic is still made of gates, and all registers have the
    /// names of the Verilog.
    pub to_flip_flops: String,
    /// From there to the cells of the part. ` -json FILE` can follow.
    pub to_cells: String,
}

impl Ice40Synthesis {
    /// The commands for module `top` in the part of this name.
    ///
    /// abc9 knows the delays of the part. Its script `flow2` keeps the smallest of several
    /// mappings. nextpnr 0.4 does not know `$scopeinfo`, in which newer versions of yosys record
    /// modules that they have flattened.
    pub fn of(part: &str, top: &str) -> Self {
        let device = DEVICES.into_iter().find(|(device, _)| part.starts_with(device));
        let (device, wire_ps) = device.unwrap_or(DEVICES[0]);
        let synth = format!(
            "synth_ice40 -abc9 -device {device} -dffe_min_ce_use {LEAST_ENABLED} -top {top} -run"
        );
        let to_flip_flops = format!(
            "scratchpad -copy abc9.script.flow2 abc9.script; \
             scratchpad -set synth_ice40.abc9.W {wire_ps}; {synth} begin:map_gates; \
             techmap t:$alu r:Y_WIDTH<={NARROW_BITS} %i; opt -full; {synth} map_gates:map_luts; \
             delete t:$scopeinfo"
        );
        Self { to_flip_flops, to_cells: format!("{synth} map_luts:") }
    }

    /// All of the commands. ` -json FILE` can follow.
    pub fn commands(&self) -> String {
        format!("{}; {}", self.to_flip_flops, self.to_cells)
    }
}
