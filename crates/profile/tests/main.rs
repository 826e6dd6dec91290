//! All integration tests of this crate, in one program. With a program for each file, what they
//! share would be compiled and linked again for each.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

#[path = "support/pages.rs"]
mod pages;

mod formulas_agree;
mod golden;
mod near_rest;
mod page;
mod properties;
mod requests;
