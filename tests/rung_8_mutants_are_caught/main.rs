//! Rung 8: every bug is caught: mutants of the exported engine, and bugs that are planted by hand
//! in the gateware, in the model's arithmetic and in the plan.

mod engine_bugs;
mod mutants;
mod planted_bugs;
mod planted_in_the_engine;
