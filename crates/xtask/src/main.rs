//! The ladder, one command a rung.
fn main() {}
