//! All tests of this crate in one program: one for each file would be linked, and generic functions
//! compiled, many times.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod guard_keys;
mod home_keys;
mod input_keys;
mod kinematics_keys;
mod long_files;
mod machine_files;
mod machine_files_page;
mod move_files;
mod output_keys;
mod units;
