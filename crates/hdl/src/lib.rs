//! The gateware as Rust-HDL modules.
