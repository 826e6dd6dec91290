//! Programs that a user ends, waits of other kinds, overrides of rapid moves, and boards that a
//! program does not fit.

use crate::command::Folder;
use crate::pauses::pulses;
use crate::run_programs::{
    LONG, MACHINE, PAUSES, begins, done, folder, hold, positions, resume, run, status, waits,
};
use crate::stops::{moving, signal};
use crate::virtual_boards::{Board, document, passed};
use std::time::Duration;

/// The levels of an output in the capture of a board that has ended.
fn levels(folder: &Folder, output: &str) -> String {
    let vcd = std::fs::read_to_string(folder.path("a.vcd")).unwrap();
    let declared = vcd.lines().find(|line| line.contains(&format!(" {output} "))).unwrap();
    let code = declared.split_whitespace().nth(3).unwrap();
    vcd.lines().filter(|line| line.get(1..) == Some(code)).map(|line| &line[..1]).collect()
}

#[test]
fn second_signal_while_the_hold_slows_down_ends_the_program_on_its_path() {
    let folder = folder("G21 G90 F3000\nM3 S1000\nM8\nG1 X4 Y4000\nM2\n");
    // y takes 4 s to come to rest, of which a fast board needs a part. A ramp would stop x at once,
    // and leave both outputs as they are.
    let y = "name = \"y\"\nsteps_per_unit = 80\nspeed_limit = 50\naccel_limit = 1000\n";
    let machine = MACHINE
        .replace(y, &y.replace("1000", "12"))
        .replace("spindle = 0", "spindle = 0\nflood = 1\nat_ramps = \"stay\"");
    folder.write("machine.toml", machine);
    let board = Board::new(&folder, "--fast --vcd a.vcd");
    let mut child = begins(&folder, &board);
    while positions(&moving(&folder, &mut child, &board.port))[1] < 12_000 {}
    signal(&child, "-INT");
    std::thread::sleep(Duration::from_millis(20));
    signal(&child, "-INT");
    let now = status(&folder, &board);
    assert_eq!((&now["idle"], now["waits"].is_null()), (&false.into(), true), "{now}");
    let told = document(child);
    assert_eq!((&told["ended"], &told["stopped_by"]), (&"stopped".into(), &"interrupt".into()));
    let found = status(&folder, &board);
    let rest = positions(&found);
    assert!(rest[1] > positions(&now)[1], "it has slowed down since");
    assert!((rest[0] * 1000 - rest[1]).abs() <= 2000, "it left its path: {rest:?}");
    assert_eq!((&found["fault"], &found["idle"]), (&false.into(), &true.into()));
    board.end();
    assert_eq!(
        (levels(&folder, "output_0"), levels(&folder, "output_1")),
        ("010".into(), "010".into())
    );
}

/// The least time between two pulses of x at G0 and at G1, 50 and 25 mm/s, and how long each of both
/// moves takes; in us.
fn rapid(options: &str) -> [f64; 4] {
    let folder = folder("G21 G90 F1500\nG1 X0.5\nM0\nG0 X18.5\nG4 P0.2\nG1 X0.5\nM2\n");
    let board = Board::new(&folder, "--fast --vcd a.vcd");
    let mut child = begins(&folder, &board);
    waits(&folder, &board, &mut child);
    passed(&folder.run(&format!("override --feed 100 {options} --port {}", board.port)));
    passed(&resume(&folder, &board));
    done(child);
    board.end();
    passed(&folder.run("check a.vcd job.ngc --machine machine.toml --path-only"));
    let times: Vec<f64> = pulses(&folder, "a.vcd").iter().map(|(at, _)| *at as f64 / 1e6).collect();
    assert_eq!(times.len(), 40 + 2 * 1440);
    let least = |times: &[f64]| {
        times.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min)
    };
    let (rapid, feed) = times[40..].split_at(1440);
    let lasts = |times: &[f64]| times[1439] - times[0];
    [least(rapid), least(feed), lasts(rapid), lasts(feed)]
}

#[test]
fn override_of_rapid_moves_leaves_the_feed_as_it_is() {
    let [rapid_100, feed_100, lasts_100, fed_100] = rapid("--rapid 100");
    let [rapid_50, feed_50, lasts_50, fed_50] = rapid("--rapid 50");
    // 4000 and 2000 steps/s, with phases of 0.125 us.
    for (found, wanted) in
        [(rapid_100, 250.0), (rapid_50, 500.0), (feed_100, 500.0), (feed_50, 500.0)]
    {
        assert!((found / wanted - 1.0).abs() < 0.01, "{found} us and not {wanted}");
    }
    // All of a rapid move goes at half its planned speed.
    assert!((lasts_50 / lasts_100 - 2.0).abs() < 0.02, "{lasts_50} {lasts_100}");
    assert!((fed_50 / fed_100 - 1.0).abs() < 0.01, "{fed_50} {fed_100}");
}

#[test]
fn program_waits_at_m1_and_m60_and_goes_on() {
    let folder = folder("G21 G90 F1500\nG1 X4\nM1\nG1 Y3\nM60\nG1 Z-1\nM2\n");
    let board = Board::new(&folder, "--fast");
    let mut child = begins(&folder, &board);
    let first = waits(&folder, &board, &mut child);
    assert_eq!(first, "pause in line 3 (M0, M1 or M60)");
    assert_eq!(positions(&status(&folder, &board)), [320, 0, 0]);
    passed(&resume(&folder, &board));
    let second = loop {
        let now = waits(&folder, &board, &mut child);
        if now != first {
            break now;
        }
    };
    assert_eq!(second, "pause in line 5 (M0, M1 or M60)");
    assert_eq!(positions(&status(&folder, &board)), [320, 240, 0]);
    passed(&resume(&folder, &board));
    assert_eq!(done(child)["program"]["waits"], 2);
    assert!(board.end().contains("\nx at 320\ny at 240\nz at -400\n"));
}

#[test]
fn program_for_another_machine_file_moves_nothing() {
    let folder = folder(PAUSES);
    let board = Board::new(&folder, "--fast");
    folder.write("other.toml", MACHINE.replace("debounce_us = 100", "debounce_us = 20_000"));
    folder.write(
        "moves.toml",
        "machine_file = \"other.toml\"\n[[move]]\nprofile = \"ranade\"\nto = { x = 1 }\n",
    );
    for line in [
        "run job.ngc --machine other.toml",
        "run moves.toml",
        "jog x 1 --machine other.toml",
        "offset --set G54 x=1 --machine other.toml",
    ] {
        let ran = folder.run(&format!("{line} --port {}", board.port));
        ran.refuses("this machine needs build");
        assert!(ran.stderr.contains("the gateware is build"), "{}", ran.stderr);
    }
    assert_eq!(positions(&status(&folder, &board)), [0, 0, 0]);
    assert_eq!(std::fs::read_dir(folder.state()).unwrap().count(), 0);
    // The board is free for its own machine.
    folder.write("job.ngc", "G21 G90 F1500\nG1 X4\nM2\n");
    passed(&run(&folder, &board, ""));
    assert!(board.end().contains("\nx at 320\n"));
}

#[test]
fn second_program_is_refused_while_one_runs_waits_or_is_held() {
    let folder = folder(&format!("G21 G90 F1500\nG1 X4\nM0\n{LONG}"));
    folder.write("other.ngc", "G21 G90 F1500\nG1 X1\nM2\n");
    let board = Board::new(&folder, "--fast");
    let second = || {
        let ran =
            folder.run(&format!("run other.ngc --machine machine.toml --port {}", board.port));
        ran.refuses("is in use by `carrystep run`");
    };
    // Nothing waits before, while it moves, and behind its end.
    let nothing = || resume(&folder, &board).refuses("no program waits at");
    nothing();
    let mut child = begins(&folder, &board);
    waits(&folder, &board, &mut child);
    second();
    passed(&resume(&folder, &board));
    while status(&folder, &board)["idle"] == true {}
    second();
    nothing();
    passed(&hold(&folder, &board));
    waits(&folder, &board, &mut child);
    second();
    passed(&resume(&folder, &board));
    assert_eq!(done(child)["program"]["waits"], 2);
    nothing();
    assert!(board.end().contains("\nx at 0\ny at 0\nz at 0\n"));
}

/// Nothing is changed: the program ends where it would have ended.
#[test]
fn hold_and_resume_without_anything_to_hold_or_resume_are_refused() {
    let folder = folder(&LONG.replace("[6]", "[2]"));
    let board = Board::new(&folder, "--fast");
    resume(&folder, &board).refuses("no program waits at");
    hold(&folder, &board).refuses("no program moves at");
    let mut child = begins(&folder, &board);
    moving(&folder, &mut child, &board.port);
    resume(&folder, &board).refuses("no program waits at");
    assert_eq!(done(child)["passed"], true);
    assert_eq!(positions(&status(&folder, &board)), [0, 0, 0]);
    resume(&folder, &board).refuses("no program waits at");
}

/// Seven segments of 4 ms are 28 ms, 31 of them 124 ms.
#[test]
fn horizon_under_100_ms_is_warned_of() {
    let folder = folder("G21 G90 F3000\nG1 X1\nM2\n");
    let board = Board::new(&folder, "--fast");
    let ran = run(&folder, &board, "");
    passed(&ran);
    let warning = "the queues of the board hold 28 ms of motion";
    assert!(ran.stderr.contains(warning), "{}", ran.stderr);
    board.end();
    folder
        .write("machine.toml", MACHINE.replacen("[machine]\n", "[machine]\nqueue_depth = 31\n", 1));
    let board = Board::new(&folder, "--fast");
    let ran = run(&folder, &board, "");
    passed(&ran);
    assert!(!ran.stderr.contains("the queues of the board hold"), "{}", ran.stderr);
}

/// With the tick of 90 us, queues did run dry when this was not checked; with 80 us they did not.
#[test]
fn program_that_the_gateware_cannot_take_in_time_moves_nothing() {
    for (tick_ns, fits) in [(70_000, true), (90_000, false)] {
        let folder = folder("G21 G90 F600\nG1 X5 Y3 Z-1\nG1 X0 Y0 Z0\nM2\n");
        let machine = MACHINE
            .replace("tick_ns = 2000", &format!("tick_ns = {tick_ns}"))
            .replace("speed_limit = 50", "speed_limit = 5")
            .replace("speed_limit = 20", "speed_limit = 1");
        folder.write("machine.toml", machine);
        let board = Board::new(&folder, "--fast");
        let ran = run(&folder, &board, "");
        if fits {
            passed(&ran);
            continue;
        }
        ran.refuses("a tick of 90000 ns is too slow for this program: axis 0 would run dry");
        assert!(ran.stderr.contains("; give the machine file a shorter tick"), "{}", ran.stderr);
        assert_eq!(positions(&status(&folder, &board)), [0, 0, 0]);
    }
}
