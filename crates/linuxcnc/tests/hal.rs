//! The component as HAL loads it: its pins are those of the manual page, wrong parameters are refused
//! by name, and its two threads read and write nothing that they should not, with a board at a
//! terminal.
#![cfg(unix)]
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_core::engine::Outputs;
use carrystep_core::link::Uart;
use carrystep_linuxcnc::component;
use carrystep_virtual_board::{ModelBoard, Pace, RealTimeBoard, Terminal};
use rustix::fs::{FlockOperation, flock};
use std::collections::BTreeSet;
use std::fs::File;
use std::process::{Command, Output};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use support::loader::{Loader, SANITIZERS, said};
use support::world::{CLOCK_HZ, build};

const MANUAL: &str = include_str!("../c/carrystep.9");
const PAGE: &str = include_str!("../../../docs/linuxcnc.md");

/// A board with all outputs at a terminal, in real time, until `end` is set.
fn board(end: Arc<AtomicBool>) -> (String, JoinHandle<()>) {
    let mut build = build();
    build.outputs = Outputs { exist: 0xff, pwm_divider: 1, off_at_ramps: true };
    let terminal = Terminal::new().unwrap();
    let name = terminal.name().to_owned();
    let model = ModelBoard::new(&build, Uart::new(CLOCK_HZ, 921_600).unwrap());
    let mut board = RealTimeBoard::new(model, terminal, Pace::real(CLOCK_HZ), CLOCK_HZ);
    let thread = thread::spawn(move || {
        while !end.load(Ordering::Relaxed) {
            board.step(&mut ()).unwrap();
        }
    });
    (name, thread)
}

/// A name with letters in place of the numbers: `joint.3.error` becomes `joint.N.error`.
fn general(name: &str) -> String {
    let mut numbers = 0;
    let of_input = name.starts_with("carrystep.0.in-");
    let letter = |character: char| {
        let letter = if of_input && numbers == 1 { 'R' } else { 'N' };
        numbers += u32::from(character.is_ascii_digit());
        if character.is_ascii_digit() { letter } else { character }
    };
    let (head, rest) = name.split_at("carrystep.0.".len());
    head.to_owned() + &rest.chars().map(letter).collect::<String>()
}

/// Name, type and direction of each pin and parameter of the manual page.
fn documented() -> BTreeSet<String> {
    let plain = |line: &str| {
        ["\\fB", "\\fI", "\\fR"].iter().fold(line.to_owned(), |line, mark| line.replace(mark, ""))
    };
    MANUAL
        .lines()
        .filter(|line| line.starts_with("\\fBcarrystep.0.") && !line.contains("update"))
        .map(plain)
        .collect()
}

#[test]
fn manual_page_has_the_pins_that_are_exported() {
    let names = Loader::new(&[]).say(&["names"]);
    let exported: BTreeSet<String> = names
        .lines()
        .map(|line| {
            let words: Vec<&str> = line.split(' ').collect();
            format!("{} {} {}", general(words[2]), words[0], words[1].to_lowercase())
        })
        .collect();
    let documented = documented();
    let missing: Vec<_> = exported.difference(&documented).collect();
    let strange: Vec<_> = documented.difference(&exported).collect();
    assert!(missing.is_empty() && strange.is_empty(), "missing {missing:?}, not there {strange:?}");
    for entry in &exported {
        let name = entry.split(' ').next().unwrap().trim_start_matches("carrystep.0.");
        let last = name.trim_start_matches("joint.N.");
        assert!(PAGE.contains(&format!("{last}`")), "docs/linuxcnc.md lacks {name}");
    }
}

#[test]
fn manual_page_has_every_fault() {
    let servo = component().find(|(name, _)| *name == "carrystep_servo.c").unwrap().1;
    let (_, texts) = servo.split_once("OWN[] = {").unwrap();
    let (texts, _) = texts.split_once("const char *carrystep_fault_text").unwrap();
    let texts: Vec<&str> = texts.split('"').skip(1).step_by(2).collect();
    assert_eq!(texts.len(), 15 + 9);
    for (number, text) in texts.iter().enumerate().skip(1) {
        let number = if number < 15 { number } else { number + 5 };
        assert!(MANUAL.contains(&format!(".B {number}\n{text}\n")), "{number}: {text}");
    }
}

#[test]
fn parameters_and_ports_that_are_wrong_are_named() {
    let loader = Loader::new(&["-fsanitize=address,undefined", "-fno-sanitize-recover=all"]);
    for (word, names) in [
        ("port=", "the parameter port is missing"),
        ("baud=3", "the parameter baud"),
        ("speed=0", "the parameter speed"),
        ("joints=9", "the parameter joints"),
        ("joints=0", "the parameter joints"),
        ("periods=65", "the parameter periods"),
        ("horizon=0", "the parameter horizon"),
        ("build=xyz", "the parameter build"),
        ("outputs=9", "the parameter outputs"),
        ("probe_latch=4", "the parameters probe_latch"),
    ] {
        let said = loader.say(&["load", word]);
        assert!(said.contains(names) && said.contains("refused -22"), "{word}: {said}");
    }
    let said = loader.say(&["load", "probe_latch=1", "index_latch=1"]);
    assert!(said.contains("the same latch"), "{said}");
    // A port that is not there; and a second instance is refused while the first goes on.
    let said = loader.say(&["load", "port=/dev/carrystep-none"]);
    assert!(said.contains("fault 1: the port cannot be opened"), "{said}");
    assert!(said.contains("again -22"), "{said}");
    // A port that another program has.
    let terminal = Terminal::new().unwrap();
    let holder = File::options().read(true).write(true).open(terminal.name()).unwrap();
    flock(&holder, FlockOperation::NonBlockingLockExclusive).unwrap();
    let said = loader.say(&["load", &format!("port={}", terminal.name())]);
    assert!(said.contains("fault 2: another program has the port"), "{said}");
}

/// Runs a checker over the component with a board.
fn checked(run: impl FnOnce(&str) -> Output) {
    let end = Arc::new(AtomicBool::new(false));
    let (port, thread) = board(Arc::clone(&end));
    let output = run(&port);
    end.store(true, Ordering::Relaxed);
    thread.join().unwrap();
    let said = said(&output);
    assert!(said.contains("connected 1"), "{said}");
}

#[test]
fn sanitizers_find_nothing_in_both_threads() {
    for flag in SANITIZERS {
        let loader = Loader::new(&[flag, "-fno-sanitize-recover=all"]);
        checked(|port| Command::new(&loader.program).args(["run", port, "500"]).output().unwrap());
    }
}

#[test]
fn valgrind_finds_nothing() {
    let loader = Loader::new(&[]);
    checked(|port| {
        Command::new("valgrind")
            .args(["--error-exitcode=9", "--leak-check=full", "--quiet"])
            .arg(&loader.program)
            .args(["run", port, "300"])
            .output()
            .unwrap_or_else(|error| panic!("valgrind (apt-get install valgrind): {error}"))
    });
}

/// The cable is pulled in motion: a named fault, and the component can be removed.
#[test]
fn port_that_goes_away_in_motion_is_named() {
    let loader = Loader::new(&["-fsanitize=address,undefined", "-fno-sanitize-recover=all"]);
    let end = Arc::new(AtomicBool::new(false));
    let (port, thread) = board(Arc::clone(&end));
    let running = Command::new(&loader.program)
        .args(["run", &port, "3000"])
        .stdout(std::process::Stdio::piped())
        .stderr(std::process::Stdio::piped())
        .spawn()
        .unwrap();
    thread::sleep(std::time::Duration::from_millis(1500));
    end.store(true, Ordering::Relaxed);
    thread.join().unwrap();
    let said = said(&running.wait_with_output().unwrap());
    assert!(said.contains("fault 1: ") || said.contains("fault 3: "), "{said}");
    assert!(said.contains("connected 0"), "{said}");
}
