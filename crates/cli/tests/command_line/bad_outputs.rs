//! Outputs that cannot be written: the error comes before the run if possible, and no incomplete
//! file remains.

use crate::command::{Folder, GOOD, Ran};
use std::fs::File;
use std::process::{Command, Stdio};

const OPTIONS: [&str; 4] = ["--vcd", "--fst", "--csv", "--plot"];

#[test]
fn output_paths_that_no_file_can_have_are_refused() {
    let folder = Folder::with_move(GOOD);
    folder.write("out/kept", "");
    let before = folder.files();
    for option in OPTIONS {
        let refused = |path: &str, says: &str| {
            // The other output must not appear either.
            let other = if option == "--csv" { "--vcd" } else { "--csv" };
            folder
                .run(&format!("simulate move.toml {other} out/other {option} {path}"))
                .refuses(says);
            assert_eq!(folder.files(), before, "{option} {path}");
        };
        refused("out", "cannot write out: is a directory");
        refused("out/kept/a", "cannot write out/kept/a: Not a directory");
        refused("/proc/none/a", "cannot write /proc/none/a: ");
        refused("move.toml", "cannot write move.toml: it is the input move.toml");
    }
    folder
        .run("simulate move.toml --vcd out/a --csv ./out/a")
        .refuses("cannot write ./out/a: it is also the output out/a");
    folder.run("demo --out out/kept").refuses("cannot write out/kept/six-axis.toml: ");
    for (core, file) in [("engine", "carrystep_engine.v"), ("parallel", "carrystep_parallel_6.v")] {
        for out in ["out/kept", "/proc/none"] {
            let ran = folder.run(&format!("verilog --core {core} --out {out}"));
            ran.refuses(&format!("cannot write {out}/{file}: "));
        }
    }
    assert_eq!(folder.files(), before);
    assert_eq!(folder.run("simulate move.toml --save out/a.gtkw").status, 2);
    assert_eq!(std::fs::read_to_string(folder.path("move.toml")).unwrap(), GOOD);
}

/// A link to a device without space. If the command replaced the link instead of writing to the
/// device, the write would succeed.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_nothing() {
    let folder = Folder::with_move(GOOD);
    std::os::unix::fs::symlink("/dev/full", folder.path("full")).unwrap();
    let before = folder.files();
    for option in OPTIONS {
        let other = if option == "--csv" { "--vcd" } else { "--csv" };
        let ran = folder.run(&format!("simulate move.toml {other} whole {option} full"));
        ran.refuses("full: No space left on device");
        assert_eq!(folder.files(), before, "{option}");
    }
    let ran = folder.run("simulate move.toml --vcd a.vcd --save full");
    ran.refuses("cannot write full: No space left on device");
    assert_eq!(folder.files(), before);
    assert!(std::fs::symlink_metadata(folder.path("full")).unwrap().is_symlink());
}

/// Runs `carrystep` with its standard output on a device without space.
#[cfg(target_os = "linux")]
#[test]
fn full_standard_output_is_reported() {
    let folder = Folder::with_move(GOOD);
    let full = |arguments: &str| -> Ran {
        let out = File::options().write(true).open("/dev/full").unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
        let child = command
            .args(arguments.split(' '))
            .current_dir(folder.path(""))
            .stdout(Stdio::from(out));
        let output = child.stderr(Stdio::piped()).spawn().unwrap().wait_with_output().unwrap();
        let stderr = String::from_utf8(output.stderr).unwrap();
        Ran { status: output.status.code().unwrap(), stdout: String::new(), stderr }
    };
    for arguments in [
        "plan move.toml",
        "plan move.toml --json",
        "simulate move.toml",
        "simulate move.toml --json",
    ] {
        full(arguments).refuses("cannot write to standard output: No space left on device");
    }
}

/// A reader that closes the pipe early, as `head` does, is not a failure.
#[test]
fn reader_that_closes_the_pipe_is_no_failure() {
    let folder = Folder::with_move(GOOD);
    let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
    let command = command.args(["plan", "move.toml", "--json"]).current_dir(folder.path(""));
    let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr), (Some(0), Vec::new()));
}

#[test]
fn a_pipe_is_written_and_not_replaced() {
    let folder = Folder::with_move(GOOD);
    let ran = folder.run("simulate move.toml --csv /dev/stdout");
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    assert!(ran.stdout.starts_with("axis,pulse,time_s,"), "{}", ran.stdout);
    assert_eq!(folder.files(), ["move.toml"]);
}
