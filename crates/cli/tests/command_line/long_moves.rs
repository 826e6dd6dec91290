//! Move files of any length are planned, simulated and checked in the same memory.

use crate::command::{Folder, GOOD};
use crate::peak;
use std::process::{Command, Stdio};

/// The greatest memory of a command, bytes. With 30 000 moves of one axis, the parsed file and the
/// plan would have taken 170 MB.
const MOST: u64 = 64 << 20;

/// The greatest memory that a command has used until it ended with status 0, bytes.
fn memory(folder: &Folder, arguments: &str) -> u64 {
    let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
    command.args(arguments.split(' ')).current_dir(folder.path("")).stdout(Stdio::null());
    let (status, most) = peak::memory(command.stderr(Stdio::null())).unwrap();
    assert_eq!(status.code(), Some(0), "{arguments}");
    most
}

/// So many moves of one step, there and back.
fn text(moves: usize) -> String {
    let machine = GOOD.split("[[move]]").next().unwrap();
    let to = |sign| format!("[[move]]\nprofile = \"ranade\"\nto = {{ x = {sign}0.2 }}\n");
    machine.to_owned() + &(to("") + &to("-")).repeat(moves / 2)
}

#[test]
fn memory_does_not_depend_on_the_number_of_moves() {
    let folder = Folder::with_move(text(30_000));
    for arguments in [
        "plan move.toml",
        "plan move.toml --json",
        "plan move.toml --json-lines",
        "simulate move.toml --csv out.csv --plot out.svg",
        "simulate move.toml --core parallel --vcd out.vcd",
        "simulate move.toml --core parallel --fst out.fst --from 10 --to 11",
        "check out.vcd move.toml",
    ] {
        let used = memory(&folder, arguments);
        assert!((1..MOST).contains(&used), "{arguments}: {used} bytes");
    }
}

/// The first file is parsed as a whole and its plan is kept, the other one is read move by move.
#[test]
fn a_long_file_is_checked_like_a_short_one() {
    let (few, many) = (Folder::with_move(text(100)), Folder::with_move(text(10_000)));
    let reports = [&few, &many].map(|folder| {
        let ran = folder.run("simulate move.toml --core parallel --json");
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        serde_json::from_str::<serde_json::Value>(&ran.stdout).unwrap()["check"]["axes"][0].clone()
    });
    let figure = |name: &str| reports.each_ref().map(|axis| axis[name].clone());
    let [short, long] = figure("pulses_found").map(|found| found.as_u64().unwrap());
    assert_eq!((short, long), (100, 10_000));
    for name in ["error_min_ns", "error_max_ns", "error_bound_ns", "dir_setup_min_ns"] {
        let [short, long] = figure(name);
        assert_eq!(short, long, "{name}");
    }
}

#[test]
fn a_mistake_in_a_long_file_is_shown_with_the_lines_around_it() {
    let text = text(10_000).replace("{ x = -0.2 }\n", "{ x = -0.2 } # back\n");
    let last = text.rfind("profile").unwrap();
    let wrong = format!("{}profil{}", &text[..last], &text[last + "profile".len()..]);
    let folder = Folder::with_move(&wrong);
    let line = wrong[..last].matches('\n').count() + 1;
    let ran = folder.run("simulate move.toml --vcd out.vcd");
    ran.refuses_at("move.toml", (line, 1), "unknown field `profil`");
    assert!(ran.stderr.contains("[[move]]") && ran.stderr.contains("# back"), "{}", ran.stderr);
    assert_eq!(folder.files(), ["move.toml"]);
}
