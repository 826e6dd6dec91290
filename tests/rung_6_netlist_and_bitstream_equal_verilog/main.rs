//! Rung 6: the engine's Verilog, its iCE40 netlist, and the bitstream read back are one.
//!
//! Twice over: by proof, flip-flop by flip-flop (what is left out stands in `carrystep_tools::equivalence`), and on the same
//! bench as rung 5, from configuration on: the same outputs in every clock, the same words in memory at the end.

mod bench;
mod faults;
mod proofs;
mod stages;
