//! What the tests of jobs share.
#![allow(dead_code, reason = "each test uses a part")]

pub mod follow;
pub mod free_space;
pub mod measure;
pub mod reader;
pub mod reference;
pub mod replay;

use carrystep_files::{Machine, SourceText};

/// A machine from the text of its file.
pub fn machine(text: &str) -> Machine {
    Machine::from_source(&SourceText { path: "machine.toml".into(), text: text.into() }).unwrap()
}
