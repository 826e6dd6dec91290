//! All integration tests of this crate, in one program. With a program for each file, what they
//! share would be compiled and linked again for each.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod adder_keys;
mod crossed_belts;
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
