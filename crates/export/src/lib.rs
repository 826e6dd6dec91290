//! Rust-HDL modules as readable Verilog.
