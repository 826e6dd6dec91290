//! Whether axes are still homed behind a stop, on virtual boards. Behind a ramp they are: the next
//! program runs within its soft limits, from the true place. Behind a freeze they are not. No program
//! resumes behind a stop; `--from-block` goes on.

use crate::command::{Folder, Ran};
use crate::run_programs::{HOME, LONG, MACHINE, begins, folder, positions, resume, run, status};
use crate::stops::{drives, moving, signal};
use crate::virtual_boards::{Board, document, passed};
use std::process::Child;
use std::time::Duration;

/// A program that takes long. x moves between 1 and 9 mm, away from its switch at 0.
const TAKES_LONG: &str = "G21 G90 F500\no1 repeat [150]\nG1 X9 Y1\nG1 X1 Y0\no1 endrepeat\nM2\n";

/// Moves of few segments, which outlast any watchdog: one at full speed, and one of 5 um/s, which
/// stays within the travel.
const FAST: &str = "machine_file = \"machine.toml\"\n[[move]]\nprofile = \"trapezoid\"\n\
    to = { x = 900_000 }\n";
const SLOW: &str = "machine_file = \"machine.toml\"\n[[move]]\nprofile = \"trapezoid\"\n\
    time = 3000\nto = { x = 15 }\n";

/// The part of the machine file in which y has its acceleration.
const Y: &str = "name = \"y\"\nsteps_per_unit = 80\nspeed_limit = 50\naccel_limit = 1000\n";

/// A homed machine with switches, of which x = 0 is that at -400 steps.
struct Homed {
    folder: Folder,
    board: Board,
}

impl Homed {
    /// `limit_stop` is that of the guard.
    fn new(watchdog_ms: u32, limit_stop: &str) -> Self {
        Self::with(watchdog_ms, limit_stop, 1000)
    }

    /// The same, and the acceleration of y.
    fn with(watchdog_ms: u32, limit_stop: &str, y: u32) -> Self {
        let folder = folder(TAKES_LONG);
        let guard = format!(
            "watchdog_ms = {watchdog_ms}\nlimits = \"pair\"\nlimit_stop = \"{limit_stop}\""
        );
        let machine = MACHINE
            .replace("watchdog_ms = 4000", &guard)
            // A long watchdog makes the rounds long in which the switch is read.
            .replace("travel = [-9, 20]\n", &HOME.replace("slow_speed = 2", "slow_speed = 1"))
            .replace(Y, &Y.replace("1000", &y.to_string()))
            .replace("tick_ns = 2000", "tick_ns = 2000\nqueue_depth = 31");
        folder.write("machine.toml", machine);
        folder.write("fast.toml", FAST);
        folder.write("slow.toml", SLOW);
        let board = Board::new(&folder, "--fast --min x=-400");
        let homed = Self { folder, board };
        passed(&homed.runs("home"));
        passed(&homed.runs("offset --set G55 y=-3"));
        homed
    }

    fn runs(&self, line: &str) -> Ran {
        self.folder.run(&format!("{line} --machine machine.toml --port {}", self.board.port))
    }

    /// Starts a command, and waits until x has moved.
    fn moves(&self, line: &str) -> Child {
        let before = positions(&status(&self.folder, &self.board));
        let mut child = drives(&self.folder, line, &self.board.port);
        while moving(&self.folder, &mut child, &self.board.port)["axes"][0]["position"] == before[0]
        {
        }
        child
    }

    /// The long program, in motion.
    fn program(&self) -> Child {
        self.moves("run job.ngc --machine machine.toml")
    }

    /// A move file at full speed.
    fn fast(&self) -> Child {
        let child = self.moves("run fast.toml");
        // It has its full speed after 50 ms.
        std::thread::sleep(Duration::from_millis(100));
        child
    }

    /// Clears the stop of a fast move, and brings x back from wherever it is.
    fn comes_back(&self, clear: &str) {
        let found = status(&self.folder, &self.board);
        let out = positions(&found)[0];
        assert_eq!(found["axes"][0]["machine"].as_f64(), Some((out + 400) as f64 / 80.0));
        passed(&self.folder.run(&format!("{clear} --port {}", self.board.port)));
        if out > 20 * 80 {
            run(&self.folder, &self.board, "").refuses("beyond its travel of -9 to 20");
        }
        passed(&self.runs(&format!("jog x {}", -out as f64 / 80.0)));
    }

    /// Ends the host, and waits until the axes have come to rest; returns the cause.
    fn dies(&mut self, mut host: Child, then: &[&str]) -> String {
        host.kill().unwrap();
        host.wait().unwrap();
        then.iter().for_each(|line| self.board.press(line));
        self.rests()
    }

    /// Waits until the board has stopped by itself, and returns the cause.
    fn rests(&self) -> String {
        loop {
            let found = status(&self.folder, &self.board);
            if found["halted"] == true {
                return found["cause"].as_str().unwrap().to_owned();
            }
            std::thread::sleep(Duration::from_millis(10));
        }
    }

    fn nothing_resumes(&self) {
        resume(&self.folder, &self.board).refuses("--from-block");
    }

    /// Behind a ramp: x stands where the board says, counted from the same machine zero, and the
    /// next program runs to its true place within the soft limits.
    fn stands(mut self, clear: &[&str]) {
        self.nothing_resumes();
        let shown = |homed: &Self| {
            let found = status(&homed.folder, &homed.board);
            (positions(&found)[0], found["axes"][0]["machine"].as_f64())
        };
        let (steps, machine) = shown(&self);
        assert_eq!(machine, Some((steps + 400) as f64 / 80.0));
        for line in clear {
            match line.strip_prefix("press ") {
                Some(line) => {
                    self.board.press(line);
                    std::thread::sleep(Duration::from_millis(100));
                }
                None => passed(&self.folder.run(&format!("{line} --port {}", self.board.port))),
            }
        }
        assert_eq!(shown(&self), (steps, machine));
        assert!(self.runs("offset").stdout.ends_with("\nG55 y 3\n"));
        // A program from far out comes back; one that leaves the travel is refused.
        self.folder.write("job.ngc", "G21 G90 F1500\nG1 X21\nM2\n");
        run(&self.folder, &self.board, "").refuses("x would go to 21 mm, beyond its travel");
        self.folder.write("job.ngc", "G21 G90 F1500\nG1 X3\nM2\n");
        let ran = run(&self.folder, &self.board, "");
        passed(&ran);
        assert!(ran.stdout.contains("soft limits of x"), "{}", ran.stdout);
        self.nothing_resumes();
        let end = self.board.end();
        assert!(end.contains("\nx at -160\n"), "{end}");
    }

    /// Behind a freeze: nothing runs before the machine is homed again; the work offsets stay.
    fn forgets(mut self, release: &str) {
        self.nothing_resumes();
        let machine =
            |homed: &Self| status(&homed.folder, &homed.board)["axes"][0]["machine"].as_f64();
        assert_eq!(machine(&self), None);
        self.board.press(release);
        std::thread::sleep(Duration::from_millis(100));
        passed(&self.runs("stop --clear"));
        assert_eq!(machine(&self), None);
        self.folder.write("job.ngc", "G21 G90 F1500\nG1 X3\nM2\n");
        let before = positions(&status(&self.folder, &self.board));
        let ran = run(&self.folder, &self.board, "");
        ran.refuses("x is not homed");
        assert!(ran.stderr.contains("`carrystep home`"), "{}", ran.stderr);
        assert_eq!(positions(&status(&self.folder, &self.board)), before);
        passed(&self.runs("home"));
        assert!(self.runs("offset").stdout.ends_with("\nG55 y 3\n"));
        passed(&run(&self.folder, &self.board, ""));
        // A freeze discards a step whose pulse has not begun. The board then says so behind the place.
        let end = self.board.end();
        let is_there = |line: &str| line == "x at -160" || line == "x at -160, 1 discarded";
        assert!(end.lines().any(is_there), "{end}");
    }
}

/// `stop --clear` with and without the machine file.
const CLEAR: &str = "stop --clear --machine machine.toml";
const CLEAR_ANY: &str = "stop --clear --baud 1500000";

#[test]
fn axes_stay_homed_behind_the_ramp_of_the_watchdog() {
    // A move file in full motion, whose segments outlast the watchdog.
    let mut homed = Homed::new(400, "ramp");
    let host = homed.fast();
    assert_eq!(homed.dies(host, &[]), "watchdog");
    homed.comes_back(CLEAR);
    homed.stands(&[]);
    // A program: its queues hold 124 ms of motion, and the watchdog is faster.
    let mut homed = Homed::new(10, "ramp");
    let host = homed.program();
    assert_eq!(homed.dies(host, &[]), "watchdog");
    homed.stands(&[CLEAR]);
}

#[test]
fn axes_stay_homed_behind_the_ramp_of_a_dry_queue() {
    let mut homed = Homed::new(4000, "ramp");
    let host = homed.program();
    assert_eq!(homed.dies(host, &[]), "underrun");
    homed.stands(&[CLEAR_ANY]);
}

#[test]
fn axes_stay_homed_behind_the_ramp_of_a_limit() {
    // The host is there.
    let mut homed = Homed::new(4000, "ramp");
    let host = homed.program();
    homed.board.press("max x 1");
    assert_eq!(document(host)["cause"], "limit");
    homed.stands(&["press max x 0", CLEAR]);
    // The host has died before: the board alone knows the cause.
    for clear in [CLEAR, CLEAR_ANY] {
        let mut homed = Homed::new(8000, "ramp");
        let host = homed.fast();
        assert_eq!(homed.dies(host, &["max x 1"]), "limit");
        homed.board.press("max x 0");
        std::thread::sleep(Duration::from_millis(100));
        homed.comes_back(clear);
        homed.stands(&[]);
    }
}

#[test]
fn axes_stay_homed_behind_the_ramp_of_a_third_signal() {
    // y takes 2.5 s to come to rest, so that all signals come while it slows down.
    let homed = Homed::with(4000, "ramp", 20);
    homed.folder.write("job.ngc", "G21 G90 F3000\nG1 X9 Y4000\nM2\n");
    let mut host = homed.program();
    while positions(&moving(&homed.folder, &mut host, &homed.board.port))[1] < 8000 {}
    for _ in 0..3 {
        signal(&host, "-INT");
        // Signals that come together are one.
        std::thread::sleep(Duration::from_millis(20));
    }
    let told = document(host);
    let ended = (&told["stopped_by"], &told["program"]["waits"]);
    assert_eq!(ended, (&"interrupt".into(), &0.into()), "{told}");
    homed.stands(&[]);
}

#[test]
fn freezes_take_the_machine_zero() {
    // The e-stop, with a host, without one, and between two commands.
    let mut homed = Homed::new(4000, "ramp");
    let host = homed.program();
    homed.board.press("estop 1");
    assert_eq!(document(host)["cause"], "e-stop");
    homed.forgets("estop 0");
    let mut homed = Homed::new(8000, "ramp");
    let host = homed.moves("run slow.toml");
    assert_eq!(homed.dies(host, &["estop 1"]), "e-stop");
    homed.forgets("estop 0");
    let mut homed = Homed::new(4000, "ramp");
    homed.board.press("estop 1");
    assert_eq!(homed.rests(), "e-stop");
    homed.forgets("estop 0");
}

#[test]
fn e_stop_that_is_found_at_the_clear_takes_the_machine_zero() {
    let mut homed = Homed::new(4000, "ramp");
    let host = homed.program();
    // The board keeps its first cause.
    assert_eq!(homed.dies(host, &[]), "underrun");
    homed.board.press("estop 1");
    std::thread::sleep(Duration::from_millis(100));
    let ran = homed.runs("stop --clear");
    assert_eq!(ran.status, 1);
    assert!(ran.stderr.contains("the e-stop is still pressed"), "{}", ran.stderr);
    homed.forgets("estop 0");
}

#[test]
fn limit_that_freezes_takes_the_machine_zero() {
    let mut homed = Homed::new(4000, "freeze");
    let host = homed.program();
    homed.board.press("max x 1");
    assert_eq!(document(host)["cause"], "limit");
    homed.forgets("max x 0");
    let mut homed = Homed::new(8000, "freeze");
    let host = homed.moves("run slow.toml");
    assert_eq!(homed.dies(host, &["max x 1"]), "limit");
    homed.forgets("max x 0");
}

#[test]
fn report_of_a_ramp_names_the_block_at_which_the_program_goes_on() {
    let homed = Homed::new(4000, "ramp");
    // It goes to x = -4 mm, beyond the switch.
    homed.folder.write("job.ngc", LONG);
    let told = document(begins(&homed.folder, &homed.board));
    assert_eq!(told["cause"], "limit");
    assert!(told["program"]["block"]["number"].is_u64(), "{told}");
    homed.nothing_resumes();
}
