//! Rung 5: the exported Verilog, in Icarus and in Verilator, is the model: random programs, the
//! demo and every profile, every output in every clock; the golden vectors to the last edge and
//! phase.

mod adders;
mod engine;
mod parallel;
