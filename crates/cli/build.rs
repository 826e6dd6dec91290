//! Options of the linker that make the command smaller.
//!
//! It keeps one copy of functions that are the same instruction by instruction, as Rust-HDL makes
//! them for every number of axes. And it packs the addresses that the loader relocates, which have
//! 0.9 MB otherwise; the command then starts only where the loader can unpack them. Rust links for
//! this target by LLD, which knows both options; GNU ld does not, so a configuration that names a
//! linker is left alone.

use std::env::var;
use std::process::Command;

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
        if var("TARGET") == var("HOST") && loader_unpacks() {
            println!("cargo::rustc-link-arg-bins=-Wl,-z,pack-relative-relocs");
        }
    }
}

/// Whether the loader of this computer reads packed addresses: that of glibc does from 2.36 on.
fn loader_unpacks() -> bool {
    let Ok(asked) = Command::new("getconf").arg("GNU_LIBC_VERSION").output() else { return false };
    let told = String::from_utf8_lossy(&asked.stdout);
    let numbers = told.trim().strip_prefix("glibc ").and_then(|version| version.split_once('.'));
    let parsed =
        numbers.and_then(|(major, minor)| Some((major.parse().ok()?, minor.parse().ok()?)));
    parsed.is_some_and(|version: (u32, u32)| version >= (2, 36))
}
