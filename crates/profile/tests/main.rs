//! All tests of this crate in one program: one for each file would be linked, and generic functions
//! compiled, many times.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

#[path = "support/pages.rs"]
mod pages;

mod formulas_agree;
mod golden;
mod near_rest;
mod page;
mod properties;
mod requests;
