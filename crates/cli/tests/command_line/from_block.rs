//! Programs that go on at one of their blocks, on virtual boards: after a hold, after the death of the
//! host, with and without somebody who confirms.
//!
//! `CARRYSTEP_KILLS` sets the number of hosts that die.

use crate::command::{Folder, Ran};
use crate::cut_captures::{Capture, MS, Pulse};
use crate::run_programs::{MACHINE, positions, status, waits};
use crate::schemas;
use crate::stops::{drives, moving};
use crate::terminal::Screen;
use crate::virtual_boards::{Board, document, passed};
use serde_json::Value;
use std::process::{Child, Command};
use std::time::Duration;

/// A path of some 20 seconds on which no two rounds are the same.
const JOB: &str = "G21 G90 G64 P0.02 F1800\nM3 S1000\nG4 P0.2\nG0 Z3\nG0 X1 Y0\nG1 Z-1\n\
    #1=0\no1 repeat [6]\n#1=[#1+1]\nG1 X[4+#1/8] Y4\nG3 X[4+#1/8] Y4 I-3 J1\n\
    G1 X-4 Z-[0.4+#1/16]\nG1 X0 Y[#1/4]\no1 endrepeat\nG0 Z3\nG0 X2.5 Y-1.25\nM2\n";
/// Where it ends, steps.
const END: [i64; 3] = [200, -100, 1200];
const PLACES: &str = "\nx at 200\ny at -100\nz at 1200\n";

fn folder() -> Folder {
    folder_with(4000)
}

/// The same with a watchdog of this time.
fn folder_with(watchdog_ms: u32) -> Folder {
    let folder = Folder::new();
    // Deep queues, because the computer that runs these tests may be busy.
    let machine = MACHINE.replace("tick_ns = 2000", "tick_ns = 2000\nqueue_depth = 31");
    let watchdog = format!("watchdog_ms = {watchdog_ms}");
    folder.write("machine.toml", machine.replace("watchdog_ms = 4000", &watchdog));
    folder.write("job.ngc", JOB);
    folder
}

fn run(folder: &Folder, board: &Board, options: &str) -> Ran {
    folder.run(&format!("run job.ngc --machine machine.toml --port {} {options}", board.port))
}

/// Waits until the program of a running command is in this block or behind it, and returns in which.
fn reaches(folder: &Folder, board: &Board, child: &mut Child, block: u64) -> u64 {
    loop {
        assert_eq!(child.try_wait().unwrap(), None, "it ended before block {block}");
        let now = status(folder, board)["block"]["number"].as_u64().unwrap_or(0);
        if now >= block {
            return now;
        }
        std::thread::sleep(Duration::from_millis(2));
    }
}

fn clear(folder: &Folder, board: &Board) {
    passed(&folder.run(&format!("stop --clear --port {} --machine machine.toml", board.port)));
}

/// Goes on at a block, to the end; returns the document of the first run, and what it said. If this
/// computer is so busy that the queues run dry, the next run goes on at the block that is named.
fn finishes(folder: &Folder, board: &Board, block: u64) -> (Value, String) {
    let (mut block, mut first) = (block, None);
    loop {
        let options = format!("--from-block {block} --began-at x=0,y=0,z=0 --yes --json");
        let ran = run(folder, board, &options);
        let told = schemas::check(&ran.stdout);
        let ended = told["ended"].clone();
        let next = told["program"]["block"]["number"].as_u64();
        let first = first.get_or_insert((told, ran.stderr)).clone();
        if ended == "done" {
            return first;
        }
        assert_eq!((ended, ran.status), ("fault".into(), 1), "{first:?}");
        block = next.unwrap();
        clear(folder, board);
    }
}

fn blocks(folder: &Folder) -> Vec<Value> {
    let ran = folder.run("plan job.ngc --machine machine.toml --list-blocks --json-lines");
    passed(&ran);
    ran.stdout.lines().map(schemas::check).collect()
}

/// The capture of the whole program as it is planned.
fn planned(folder: &Folder) -> Capture {
    passed(&folder.run("simulate job.ngc --machine machine.toml --vcd planned.vcd"));
    Capture::read(&std::fs::read_to_string(folder.path("planned.vcd")).unwrap())
}

/// Judges the part from the pulses alone: up to the ramp, they are those of the plan, and they reach
/// the place where this block begins; from the rest behind the ramp on, the tool enters at the block
/// and follows the programmed path to its end. `rest` is where the board says that it rested.
fn part_is_whole(folder: &Folder, planned: &Capture, block: &Value, rest: &[i64]) {
    let ran = Capture::read(&std::fs::read_to_string(folder.path("a.vcd")).unwrap());
    // The ramp switches the spindle off. At rest, the time goes on in the test's sleep.
    let count = ran.rests_behind(ran.goes_off("output_0"));
    let (rested, at) = ran.pulses[count - 1];
    assert_eq!(at, rest, "the ramp has not ended where the pulses lead");
    let [first, wanted] = [&ran.pulses, &planned.pulses].map(|pulses| pulses[0].0);
    let is_same = |(ran, planned): &(&Pulse, &Pulse)| {
        ran.1 == planned.1 && (ran.0 - first).abs_diff(planned.0 - wanted) <= 2
    };
    let pairs = ran.pulses[..count].iter().zip(&planned.pulses);
    let cut = pairs.take_while(is_same).map(|(pulse, _)| pulse.1);
    // 0.02 mm of tolerance, as much again at the tip of an acute corner, and a step of each axis.
    let near = |at: [i64; 3]| {
        let places = ["x", "y", "z"].map(|letter| block["at"][letter].as_f64().unwrap());
        let off = |axis: usize, steps: f64| (at[axis] as f64 / steps - places[axis]).abs();
        off(0, 80.0) <= 0.0525 && off(1, 80.0) <= 0.0525 && off(2, 400.0) <= 0.0425
    };
    assert!(cut.into_iter().any(near), "the tool was not where block {block} begins");
    folder.write("behind.vcd", ran.from(rested + 50 * MS));
    let place = [("x", 80.0), ("y", 80.0), ("z", 400.0)].iter().zip(rest);
    let place = place.map(|((letter, steps), at)| format!("{letter}={}", *at as f64 / steps));
    let (number, place) = (&block["number"], place.collect::<Vec<_>>().join(","));
    passed(&folder.run(&format!(
        "check behind.vcd job.ngc --machine machine.toml --path-only --from-block {number} \
         --began-at x=0,y=0,z=0 --at {place}"
    )));
}

#[test]
fn host_that_is_killed_is_followed_by_another_one() {
    let kills = std::env::var("CARRYSTEP_KILLS").ok().and_then(|text| text.parse().ok());
    let kills: u64 = kills.unwrap_or(2);
    let whole = folder();
    let (blocks, planned) = (blocks(&whole), planned(&whole));
    let moves: Vec<&Value> = blocks.iter().filter(|block| !block["begins_s"].is_null()).collect();
    // How many boards the watchdog has stopped, and how many a queue that has run dry.
    let mut stops = [0, 0];
    let mut judged = 0;
    for kill in 0..kills {
        // A fast board keeps three segments, 12 ms. Whichever is shorter stops it, in full motion.
        let (watchdog_ms, wanted) = [(4000, "underrun"), (10, "watchdog")][(kill % 2) as usize];
        let folder = folder_with(watchdog_ms);
        let board = Board::new(&folder, "--fast --vcd a.vcd");
        let mut child = drives(&folder, "run job.ngc --machine machine.toml", &board.port);
        moving(&folder, &mut child, &board.port);
        // Blocks of the loop, none twice before all of them.
        let aim = &moves[3 + (kill * 7 % 20) as usize];
        let block = reaches(&folder, &board, &mut child, aim["number"].as_u64().unwrap());
        std::thread::sleep(Duration::from_micros(kill * 3919 % 20_000));
        child.kill().unwrap();
        child.wait().unwrap();
        let found = loop {
            let found = status(&folder, &board);
            if found["halted"] == true {
                break found;
            }
            assert_ne!(positions(&found), END, "it was too late for kill {kill}");
        };
        assert_eq!(found["cause"], wanted, "kill {kill}");
        stops[(kill % 2) as usize] += 1;
        // Without a host, the board's time goes on.
        std::thread::sleep(Duration::from_millis(250));
        clear(&folder, &board);
        let listed = &blocks[block as usize - 1];
        let (told, said) = finishes(&folder, &board, block);
        // It has begun where the ramp has ended, without a step lost.
        let begun: Vec<_> = told["axes"]
            .as_array()
            .unwrap()
            .iter()
            .map(|axis| axis["before"].as_i64().unwrap())
            .collect();
        assert_eq!(begun, positions(&found), "kill {kill}");
        assert!(
            said.contains(&format!("entry at block {block}, job.ngc:{}", listed["line"])),
            "{}",
            said
        );
        assert!(board.end().contains(PLACES), "kill {kill}, block {block}");
        if told["ended"] == "done" {
            part_is_whole(&folder, &planned, listed, &positions(&found));
            judged += 1;
        }
    }
    let [dry, watchdog] = stops;
    eprintln!(
        "FIGURES {kills} commands killed in motion, {watchdog} boards stopped by the watchdog and {dry} \
         by a dry queue, positions true, each job ended at its place, {judged} with the first entry, \
         and their parts whole"
    );
    // A busy computer may be late for a queue, and then there are several entries.
    assert!(2 * judged >= kills, "{judged} of {kills}");
}

#[test]
fn program_that_was_ended_names_its_block_and_goes_on_there() {
    let folder = folder();
    let board = Board::new(&folder, "--fast");
    let mut child = drives(&folder, "run job.ngc --machine machine.toml", &board.port);
    reaches(&folder, &board, &mut child, 12);
    passed(&folder.run(&format!("hold --port {}", board.port)));
    waits(&folder, &board, &mut child);
    let held = status(&folder, &board);
    passed(&folder.run(&format!("stop --port {} --machine machine.toml", board.port)));
    let told = document(child);
    let block = &told["program"]["block"];
    assert_eq!((block, &told["ended"]), (&held["block"], &"stopped".into()));
    let (number, began_at) = (block["number"].as_u64().unwrap(), &told["program"]["began_at"]);
    assert_eq!(began_at, "x=0,y=0,z=0");
    // The tool is between the places where this block and the next one that moves begin.
    let blocks = blocks(&folder);
    let begins = &blocks[number as usize - 1];
    assert_eq!((&begins["line"], begins["begins_s"].is_null()), (&block["line"], false));
    let (told, _) = finishes(&folder, &board, number);
    assert!(told["ended"].is_string());
    assert!(board.end().contains(PLACES));
}

#[test]
fn entry_reaches_the_pins_as_it_was_planned() {
    let folder = folder();
    let board = Board::new(&folder, "--vcd a.vcd --fast");
    passed(&run(&folder, &board, "--from-block 19 --yes"));
    assert!(board.end().contains(PLACES));
    passed(&folder.run("check a.vcd job.ngc --machine machine.toml --from-block 19"));
    assert_eq!(folder.run("check a.vcd job.ngc --machine machine.toml").status, 1);
    let ran = folder
        .run("simulate job.ngc --machine machine.toml --from-block 19 --at x=3,y=-1,z=0.5 --json");
    passed(&ran);
    let told = schemas::check(&ran.stdout);
    let entry = &told["plan"]["entry"];
    assert_eq!(
        (&entry["block"], &entry["spindle"], &entry["dwell_s"]),
        (&19.into(), &"M3".into(), &0.2.into())
    );
    assert_eq!((&entry["height_mm"], &entry["from"][1]["at"]), (&3.0.into(), &(-1.0).into()));
}

#[test]
fn nobody_confirms_without_a_terminal() {
    let folder = folder();
    let board = Board::new(&folder, "--fast");
    let ran = run(&folder, &board, "--from-block 19");
    assert_eq!(ran.status, 2);
    let shown = "entry at block 19, job.ngc:13: G1 X0 Y[#1/4]\n";
    assert!(ran.stderr.contains(shown) && ran.stderr.contains("add --yes"), "{}", ran.stderr);
    for (options, why) in [
        ("--from-block 0 --yes", "0 is not in 1.."),
        ("--from-block 99 --yes", "no block 99: the program has 47"),
        ("--from-block 19 --yes --safe-z -9", "z = -9 mm is below"),
        ("--from-block 3 --yes", "depends on where the program began"),
        ("--yes", "--from-block"),
        ("--safe-z 3", "--from-block"),
    ] {
        let ran = run(&folder, &board, options);
        assert_eq!(ran.status, 2, "{options}");
        assert!(ran.stderr.contains(why), "{options}: {}", ran.stderr);
    }
    assert!(board.end().contains("\nx at 0\ny at 0\nz at 0\n"));
    for refused in ["plan job.ngc --list-blocks --from-block 2", "plan machine.toml --list-blocks"]
    {
        assert_eq!(folder.run(&format!("{refused} --machine machine.toml")).status, 2, "{refused}");
    }
}

#[test]
fn somebody_confirms_in_a_terminal() {
    let folder = folder();
    let board = Board::new(&folder, "--fast");
    for (answer, begins) in [("\n", false), ("no\n", false), ("y\n", true)] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
        command.args(["run", "job.ngc", "--machine", "machine.toml", "--from-block", "19"]);
        command.args(["--port", &board.port]).current_dir(folder.path(""));
        let mut screen = Screen::start(&mut command);
        screen.waits_for("entry at block 19");
        screen.waits_for("is this right?");
        // Other commands get an answer meanwhile.
        assert_eq!(status(&folder, &board)["moving"], false);
        screen.types(answer);
        screen.waits_for(if begins { "DONE" } else { "not confirmed" });
    }
    assert!(board.end().contains(PLACES));
}

#[test]
fn blocks_are_listed_with_their_lines_and_times() {
    let folder = folder();
    let ran = folder.run("plan job.ngc --machine machine.toml --list-blocks");
    passed(&ran);
    assert!(
        ran.stdout.starts_with(
            "   block      line    begins [s]  text\n       1         1             -  G21"
        ),
        "{}",
        ran.stdout
    );
    assert_eq!(ran.stdout.lines().count(), 1 + blocks(&folder).len());
    // A mistake ends the list, and nothing of it is printed.
    folder.write("job.ngc", JOB.replace("G0 X2.5", "G0 Q2.5"));
    let ran = folder.run("plan job.ngc --machine machine.toml --list-blocks");
    assert_eq!((ran.status, &*ran.stdout), (2, ""));
}
