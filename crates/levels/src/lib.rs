//! One program at any level: model, Rust-HDL, Icarus, Verilator.
