//! Lets the linker keep one copy of functions that are the same instruction by instruction.
//!
//! Rust-HDL makes such functions for every number of axes; without this, they are a fifth of the
//! command. Rust links for this target by LLD, which knows the option; GNU ld does not, so a
//! configuration that names a linker is left alone.

use std::env::var;

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    let is = |key: &str, value: &str| var(key).is_ok_and(|found| found == value);
    let is_linked_by_lld = is("CARGO_CFG_TARGET_OS", "linux")
        && is("CARGO_CFG_TARGET_ARCH", "x86_64")
        && is("CARGO_CFG_TARGET_ENV", "gnu");
    let names_a_linker = var("CARGO_ENCODED_RUSTFLAGS").is_ok_and(|flags| flags.contains("link"))
        || var("RUSTC_LINKER").is_ok();
    if is_linked_by_lld && !names_a_linker {
        println!("cargo::rustc-link-arg-bins=-Wl,--icf=all");
    }
}
