//! Rung 6: the engine's Verilog, its iCE40 netlist and the bitstream read back are equal.
//!
//! This is shown in two ways. A proof compares every flip-flop (`carrystep_tools::equivalence`
//! lists what it leaves out). The bench of rung 5 compares all outputs in every clock from
//! configuration on, and the words in memory at the end.

mod bench;
mod faults;
mod proofs;
mod stages;
