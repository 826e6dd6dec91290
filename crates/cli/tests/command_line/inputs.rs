//! Inputs that are no files, are too long, or contain a misspelled name.

use crate::command::{Folder, GOOD, Ran, edit};
use std::fs::File;
use std::os::unix::fs::symlink;
use std::os::unix::net::UnixListener;
use std::process::{Command, Stdio};
use std::sync::mpsc;
use std::time::Duration;

/// Runs a command that must end by itself.
fn ends(folder: &Folder, arguments: &str) -> Ran {
    let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
    command.args(arguments.split(' ')).current_dir(folder.path("")).stdin(Stdio::null());
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    let (number, (sender, receiver)) = (child.id().to_string(), mpsc::channel());
    let waits = std::thread::spawn(move || sender.send(child.wait_with_output().unwrap()));
    let output = receiver.recv_timeout(Duration::from_secs(120)).unwrap_or_else(|_| {
        Command::new("kill").args(["-KILL", &number]).status().unwrap();
        panic!("{arguments} does not end")
    });
    waits.join().unwrap().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Ran {
        status: output.status.code().unwrap(),
        stdout: text(output.stdout),
        stderr: text(output.stderr),
    }
}

/// Every command line that reads a file; `FILE` stands for the file.
const READERS: [&str; 14] = [
    "plan FILE",
    "simulate FILE",
    "check FILE move.toml",
    "check own.vcd FILE",
    "verilog --machine FILE --out out",
    "verilog --board FILE --out out",
    "build --board icebreaker --machine FILE --out out",
    "selftest --board FILE --out out",
    "boards FILE",
    "sweep FILE",
    "sweep --merge FILE",
    "run FILE --port /dev/null",
    "jog x 1 --machine FILE --port /dev/null",
    "virtual-board --machine FILE",
];

#[test]
fn devices_pipes_sockets_and_folders_are_refused() {
    let folder = Folder::with_move(GOOD);
    assert_eq!(folder.run("simulate move.toml --vcd own.vcd").status, 0);
    symlink("/dev/zero", folder.path("zero.toml")).unwrap();
    assert!(Command::new("mkfifo").arg(folder.path("fifo.toml")).status().unwrap().success());
    let _socket = UnixListener::bind(folder.path("socket.toml")).unwrap();
    std::fs::create_dir(folder.path("folder.toml")).unwrap();
    let before = folder.files();
    for (name, kind) in [
        ("zero.toml", "device"),
        ("fifo.toml", "pipe (FIFO)"),
        ("socket.toml", "socket"),
        ("folder.toml", "folder"),
    ] {
        let says =
            format!("cannot read {name}: it is a {kind}, and an input must be a regular file");
        for reader in READERS {
            ends(&folder, &reader.replace("FILE", name)).refuses(&says);
        }
        folder.write(
            "by-name.toml",
            format!(
                "machine_file = \"{name}\"\n[[move]]\nprofile = \"ranade\"\nto = {{ x = 2 }}\n"
            ),
        );
        ends(&folder, "plan by-name.toml").refuses_at("by-name.toml", (1, 16), &says);
        std::fs::remove_file(folder.path("by-name.toml")).unwrap();
    }
    assert_eq!(folder.files(), before);
}

#[test]
fn too_long_input_is_refused_with_the_limit() {
    let folder = Folder::with_move(GOOD);
    // The file is sparse and takes no space on the disk.
    File::create(folder.path("big.toml")).unwrap().set_len(1 << 40).unwrap();
    for reader in READERS.iter().filter(|reader| !reader.starts_with("check FILE")) {
        let ran = ends(&folder, &reader.replace("FILE", "big.toml"));
        // A move file may be of any length, but not its lines.
        let moves = ["plan FILE", "simulate FILE", "check own.vcd FILE", "run FILE"];
        if moves.iter().any(|command| reader.starts_with(command)) {
            ran.refuses("big.toml:1: the line has over 4194304 bytes (4 MiB)");
        } else {
            ran.refuses("cannot read big.toml: it has 1099511627776 bytes, and an input may have at most 4194304 (4 MiB)");
        }
    }
}

#[test]
fn a_long_text_is_read_in_time() {
    let folder = Folder::new();
    let moves = "[[move]]\nprofile = \"constant\"\nto = { x = 1e-9 }\n";
    let text = format!("{GOOD}{}", moves.repeat(((4 << 20) - GOOD.len()) / moves.len()));
    folder.write("move.toml", &text);
    let ran = ends(&folder, "plan move.toml");
    assert!(ran.status == 0 || ran.status == 2, "{}", ran.stderr);
}

#[test]
fn an_excerpt_of_a_long_line_is_short() {
    let folder = Folder::new();
    let long = "1".repeat(2_000_000);
    let name = "n".repeat(1_000_000);
    for (old, new, says) in [
        ("speed_limit = 1000", format!("speed_limit = ^{long}"), "a number of too many digits"),
        (
            "speed_limit = 1000",
            format!("speed_limit = ^0.{long}"),
            "needs more than 60 digits before or behind its point",
        ),
        ("speed_limit = 1000", format!("speed_limit = 1000\n^{name} = 1"), "unknown field `nnn"),
        ("driver = \"a4988\"", format!("driver = ^\"{name}\""), "no driver is called 'nnn"),
        ("name = \"x\"", format!("name = ^\"{name}\""), "cannot name an axis"),
        ("to = { x = 2 }", format!("to = {{ ^{name} = 2 }}"), "the machine has no axis \"nnn"),
        ("phases = 16", format!("phases = 16 {name} ^"), ""),
    ] {
        let (text, (line, _)) = edit(GOOD, old, &new);
        folder.write("move.toml", text);
        let ran = ends(&folder, "plan move.toml");
        ran.refuses(says);
        assert!(ran.stderr.contains(&format!("move.toml:{line}:")), "{}", ran.stderr);
        let longest = ran
            .stderr
            .lines()
            .filter(|line| line.contains(" | "))
            .map(|line| line.chars().count())
            .max();
        assert!(longest.is_some_and(|chars| chars <= 210), "{longest:?}: {}", ran.stderr);
        assert!(ran.stderr.len() < 4000, "{}", ran.stderr);
    }
}

#[test]
fn bad_numbers_are_refused_with_the_reason() {
    for (number, says) in [
        ("1e308", "speed_limit = 1e308: not a usable number: it is too great"),
        ("1e30", "speed_limit = 1e30: not a usable number: it is too great"),
        ("1e999", "the number is too great: it must be under 10^30"),
        ("nan", "speed_limit = nan: not a usable number: it is not finite"),
        ("-inf", "speed_limit = -inf: not a usable number: it is not finite"),
        (
            "1e-300",
            "speed_limit = 1e-300: not a usable number: it needs more than 60 digits before or behind its point",
        ),
    ] {
        let (text, place) = edit(GOOD, "speed_limit = 1000", &format!("speed_limit = ^{number}"));
        Folder::with_move(text).run("plan move.toml").refuses_at("move.toml", place, says);
    }
}

#[test]
fn misspelled_names_are_answered_with_a_suggestion() {
    for (old, new, says) in [
        ("clock_hz = 48_000_000", "^clok_hz = 48_000_000", "did you mean `clock_hz`?"),
        ("speed_limit = 1000", "^sped_limit = 1000", "did you mean `speed_limit`?"),
        ("profile = \"ranade\"", "profile = ^\"ranad\"", "did you mean `ranade`?"),
        ("driver = \"a4988\"", "driver = ^\"A4998\"", "did you mean 'a4988'?"),
        ("name = \"x\"", "name = \"x1\"", "did you mean 'x1'?"),
    ] {
        let text = GOOD.replace(old, &new.replace('^', ""));
        Folder::with_move(text).run("plan move.toml").refuses(says);
    }
    let folder = Folder::with_move(GOOD);
    folder.run("boards icebraker").refuses("did you mean 'icebreaker'?");
    folder.run("build --board iCEBreaker --part x").refuses("did you mean 'icebreaker'?");
    folder.run("profile ranad --steps 1 --time 1").refuses("'ranade'");
    folder.run("simulat move.toml").refuses("'simulate'");
    folder.write("sweep.toml", "move_fil = \"\"\n[vary]\na = [1]\n");
    folder.run("sweep sweep.toml").refuses_at("sweep.toml", (1, 1), "did you mean `move_file`?");
}
