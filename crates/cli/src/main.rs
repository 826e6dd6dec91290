//! The carrystep command.
fn main() {}
