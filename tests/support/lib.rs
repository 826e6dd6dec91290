//! The parts that the rungs share: golden vectors, an independent closed form, random programs,
//! benches, mutants and proofs.

pub mod axis_bench;
pub mod board_clock;
pub mod board_session;
pub mod closed_form;
pub mod dense;
pub mod effort;
pub mod engine_builds;
pub mod engine_programs;
pub mod engine_twins;
pub mod gcode_job;
pub mod golden;
pub mod jobs;
pub mod link_bench;
pub mod lockstep;
pub mod moves;
pub mod mutants;
pub mod pages;
pub mod planted;
pub mod programs;
pub mod proofs;
pub mod random_moves;
pub mod repeats;
pub mod self_test_bench;
pub mod self_test_board;
pub mod sources;
pub mod twins;
