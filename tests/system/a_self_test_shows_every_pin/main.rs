//! The self-test of a board does what docs/self-test.md specifies: in the model, in Rust-HDL and in
//! the exported Verilog, and for each board from its own pins.
//!
//! A test run covers the iCEstick, also with its bitstream read back, and a board whose host is not
//! ready at once. `cargo xtask long self-test` covers all boards, and builds all that the open tools
//! can build.

mod boards;
mod modules;
