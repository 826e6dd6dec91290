//! Writes a placed and routed iCE40 design as Verilog with the delays that nextpnr computed, from
//! the placement (`--write`) and the delays (`--sdf`), for simulation in Icarus.
//!
//! The Verilog consists of the models in `timed/cells.v`. Every wire to an input of a cell has its
//! own delay, and so has every path through a LUT, a carry, a global buffer, a flip-flop and a block
//! RAM. All delays are transport delays: a pulse shorter than a delay passes. Flip-flops and block
//! RAMs print a line that begins with [`VIOLATION`] where an input changes within its set-up or hold
//! time. All registers start at 0 and block RAMs with their INIT values, as after configuration;
//! they ignore clock edges in the first microsecond.
//!
//! Three things have no delay: the pads, because nextpnr gives none; the PLL, which passes its
//! reference on, so that the simulated oscillator has the frequency of the PLL's output; and its
//! LOCK, which is 1 from the start.
//!
//! Where the file of delays lacks a delay or a check that the placement needs, or has one that
//! nothing uses, the conversion fails: a check cannot get lost.

mod cells;
mod netlist;
mod sdf;
mod verilog;

use crate::SynthesisError;
use crate::ice40::PlacedDesign;
use crate::tool::NEXTPNR;

/// The first word of each line that the models print for an input that changes within its set-up or
/// hold time. The words after it are `set-up` or `hold`, the time in ps, and the cell.
pub const VIOLATION: &str = "VIOLATION";

/// The first word of each line that the models print for an input that changes later after a clock
/// edge than any input of that cell before. The words after it are the time to the change with the
/// input's set-up time, in ps, and the cell.
pub const LATEST: &str = "LATEST";

/// The models of the cells.
const CELLS: &str = include_str!("timed/cells.v");

impl PlacedDesign {
    /// The design as Verilog with delays, together with the models of its cells. `sdf` is
    /// [`PlacedDesign::sdf`], possibly with a delay changed.
    ///
    /// # Errors
    /// [`SynthesisError::Unread`] if the delays do not fit the placement, or if the design has a
    /// cell, or a setting of a cell, that has no model with delays.
    pub fn timed(&self, sdf: &str, top: &str) -> Result<String, SynthesisError> {
        let netlist = netlist::Netlist::of(self.placement())?;
        let delays = sdf::Delays::of(sdf)?;
        Ok(format!("{CELLS}{}", verilog::written(&netlist, delays, top)?))
    }
}

fn unread(what: impl Into<String>) -> SynthesisError {
    SynthesisError::Unread { tool: NEXTPNR.name, what: what.into() }
}
