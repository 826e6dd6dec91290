//! Tests of the command from outside: its output, its exit status, and the files that it leaves.

#![allow(clippy::unwrap_used)] // Tests may panic.

mod bad_captures;
mod bad_curves;
mod bad_files;
mod bad_machines;
mod bad_moves;
mod bad_outputs;
#[cfg(unix)]
mod board_here;
mod boards;
#[cfg(unix)]
mod cache;
#[cfg(target_os = "linux")]
mod check_jobs;
mod check_outputs;
mod check_slices;
#[cfg(target_os = "linux")]
mod ci_action;
mod clocks;
mod command;
#[cfg(target_os = "linux")]
mod container;
mod corexy;
mod curves;
#[cfg(target_os = "linux")]
mod cut_captures;
#[path = "../../../link/tests/support/device.rs"]
#[allow(dead_code, reason = "the link's own tests use the rest")]
mod device;
mod documents;
mod empty_programs;
mod engine;
#[cfg(target_os = "linux")]
mod from_block;
mod gantries;
#[cfg(unix)]
mod homed_after_stops;
#[cfg(unix)]
mod homing;
#[cfg(unix)]
mod inputs;
#[cfg(target_os = "linux")]
mod interrupts;
mod json_lines;
mod json_names;
mod junit;
#[cfg(target_os = "linux")]
mod kept_shards;
mod lasers;
mod linuxcnc;
#[cfg(target_os = "linux")]
mod long_moves;
mod machine_new;
#[cfg(unix)]
mod outputs;
mod overrides;
#[cfg(unix)]
mod pauses;
#[cfg(target_os = "linux")]
#[path = "../support/peak.rs"]
mod peak;
mod plots;
#[cfg(unix)]
mod probes;
mod profile;
mod program_outputs;
mod programs;
#[cfg(unix)]
mod real_senders;
#[cfg(unix)]
mod recorded_runs;
#[cfg(unix)]
#[path = "../../../virtual-board/tests/support/recorder.rs"]
#[allow(dead_code, reason = "the tests of other crates use the rest")]
mod recorder;
#[path = "../../../../tests/support/repeats.rs"]
#[allow(dead_code, reason = "other tests use the rest")]
mod repeats;
#[cfg(target_os = "linux")]
mod reports;
#[cfg(unix)]
mod run_ends;
#[cfg(unix)]
mod run_programs;
mod schemas;
mod selftests;
#[cfg(unix)]
mod sender;
#[cfg(unix)]
mod serve_characters;
#[cfg(unix)]
mod serve_connections;
#[cfg(unix)]
mod serve_holds;
#[cfg(unix)]
mod serve_limits;
#[cfg(target_os = "linux")]
mod serve_outputs;
#[cfg(target_os = "linux")]
mod serve_probes;
#[cfg(target_os = "linux")]
mod serve_slow_readers;
mod serve_soak;
#[cfg(unix)]
mod serve_states;
#[cfg(unix)]
mod serve_streams;
mod shard_merges;
// Other targets and the profile `dev` have other sizes.
#[cfg(all(target_os = "linux", target_arch = "x86_64", target_env = "gnu", not(debug_assertions)))]
mod size;
#[cfg(unix)]
mod stop_on_the_wire;
#[cfg(unix)]
mod stops;
mod sweeps;
mod table;
#[cfg(unix)]
mod terminal;
#[cfg(unix)]
mod touch_off;
#[cfg(unix)]
mod touch_off_failures;
#[cfg(unix)]
mod virtual_boards;
#[cfg(unix)]
mod web_page;
#[cfg(unix)]
mod web_sockets;
mod windows;
#[cfg(unix)]
mod work_offsets;
