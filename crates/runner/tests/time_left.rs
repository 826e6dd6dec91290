//! The time left that the progress line of a run shows, beside what really remains in the time of a
//! board of models. It is looked at after every exchange with the board, from the first one of the
//! motion on, without overrides.
//!
//! "Right within 2 %" is read in the stricter way: 2 % of what is left, not of the whole. Near the end,
//! 2 % are a few milliseconds. The host cannot know the time as well as that, because it first fills
//! the queues of the board, and only then reads whether the axes move. So [`UNSEEN`] is added, which is
//! far less than the half second to which the display is rounded.

use crate::support::wire::Faults;
use crate::support::{CLOCK_HZ, End, MS, SESSION, TICK};
use crate::three_axes::machine;
use carrystep_core::link::Uart;
use carrystep_core::{OutputChange, Segment};
use carrystep_job::{Hold, Pace};
use carrystep_link::{Ended, Patience, Progress, SegmentSource, Wish};
use carrystep_program::{ProgramFile, Row, Rows, Settings, Survey};
use carrystep_runner::{MotionPace, OverrideSetting, Stretches, TimeLeft};
use carrystep_virtual_board::ModelBoard;
use std::cell::{Cell, RefCell};
use std::path::{Path, PathBuf};
use std::time::Duration;

const TABLES: &str = "[machine]\nclock_hz = 48_000_000\ntick_ns = 2000\nqueue_depth = 31\n\
    [machine.link]\nbaud = 3_000_000\n\
    [machine.outputs]\ncount = 2\nspindle = 0";

/// What the host cannot know, s.
const UNSEEN: f64 = 0.012;

/// The segments of a stretch, whose ticks are counted.
struct Counted<'a, I: Iterator<Item = Row>> {
    stretches: &'a RefCell<Stretches<I>>,
    ticks: &'a Cell<u64>,
}

impl<I: Iterator<Item = Row>> SegmentSource for Counted<'_, I> {
    fn segment(&mut self, axis: u8) -> Option<Segment> {
        let segment = self.stretches.borrow_mut().segment(axis);
        let ticks = segment.as_ref().filter(|_| axis == 0).map_or(0, |segment| segment.ticks);
        self.ticks.set(self.ticks.get() + u64::from(ticks));
        segment
    }

    fn outputs(&mut self) -> OutputChange {
        self.stretches.borrow_mut().outputs()
    }

    fn start(&mut self) -> Option<u8> {
        self.stretches.borrow_mut().start()
    }
}

/// The greatest error of a program, s, and as a part of what is left where more than 0.5 s are.
#[derive(Debug)]
struct Errors {
    seconds: f64,
    part: f64,
    looks: usize,
}

/// Runs a program, which rests for `pause` ms wherever somebody has to let it go on; with a hold this
/// many ms after its beginning, if one is wanted. Checks every time left.
fn follow(path: &Path, pause: u64, hold_at: Option<u64>) -> Errors {
    let name = path.display();
    let (machine, text) = machine(TABLES);
    let (engine, uart) = (machine.engine(), Uart::new(CLOCK_HZ, 3_000_000).unwrap());
    let file = ProgramFile::open(path, machine.clone(), &text.path, Settings::default()).unwrap();
    // As the command knows it before anything moves.
    let survey = Survey::new(&file, |_| Ok::<_, carrystep_program::ProgramError>(())).unwrap();
    let tick = machine.timebase.tick_seconds();
    let seconds = survey.ticks as f64 * tick;
    let rows = Rows::new(&file).unwrap().map(Result::unwrap);
    let hold = Hold::new(&machine).unwrap();
    let start = file.start_steps();
    let pace = Pace::new(&machine, &start).unwrap();
    let stretches = Stretches::new(rows, &start, hold, pace, machine.queue);
    let stretches = RefCell::new(stretches);
    let end = End::of(ModelBoard::new(&engine, uart), uart, Faults::default(), 1);
    let mut host = end.connect_to(uart.build_id(&engine), Patience::default()).unwrap();
    host.open(SESSION).unwrap();
    host.enable().unwrap();
    let mut time = TimeLeft::new(seconds);
    // The motion of the stretches before, in cycles, and what was said to be left after how much.
    let (mut moved, mut said) = (0, Vec::new());
    while let Some(waits) = { stretches.borrow_mut().begin() } {
        time.rests(Some(stretches.borrow().gone() * tick));
        if !waits.is_empty() {
            end.wait(pause);
        }
        let stretch = end.0.borrow().board.loads().len();
        let ticks = Cell::new(0);
        let source = Counted { stretches: &stretches, ticks: &ticks };
        let ended = host.stream(source, |progress: &Progress<'_>| {
            let (now, load) = {
                let world = end.0.borrow();
                (world.board.cycle(), world.board.loads().get(stretch).copied())
            };
            let clock = Duration::from_nanos(now * 1000 / (CLOCK_HZ / 1_000_000));
            let pace = {
                let stretches = stretches.borrow();
                let (rate, added) = (stretches.rate(), stretches.added() * tick);
                MotionPace { overrides: OverrideSetting::NONE, rate, added }
            };
            if time.see(clock, !progress.status.answer.idle, pace) {
                // Between the start and its first load, the board is not idle any more.
                let since = load.map_or(0, |load| now - load);
                said.push((moved + since, pace.added, time.left().as_secs_f64()));
            }
            let holds = hold_at
                .is_some_and(|at| moved == 0 && load.is_some_and(|load| now > load + at * MS));
            if !holds || stretches.borrow().is_held() {
                return Wish::GoOn;
            }
            stretches.borrow_mut().hold();
            Wish::GoOn
        });
        assert_eq!(ended, Ok(Ended::Done), "{name}");
        // The board needs no tick more than its segments have.
        moved += ticks.get() * TICK;
    }
    let whole = moved;
    let mut errors = Errors { seconds: 0.0, part: 0.0, looks: said.len() };
    // Nobody knows of a hold before it is asked for.
    let added = stretches.borrow().added() * tick;
    assert_eq!(added > 0.0, hold_at.is_some(), "{name}");
    for (at, known, left) in said {
        let really = whole.saturating_sub(at) as f64 / CLOCK_HZ as f64 - (added - known);
        let error = (left - really).abs();
        assert!(
            error <= 0.02 * really + UNSEEN,
            "{name}: {left} s left, and really {really} s of {seconds} s"
        );
        errors.seconds = errors.seconds.max(error);
        if really > 0.5 {
            errors.part = errors.part.max(error / really);
        }
    }
    errors
}

fn job(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../sim/jobs").join(name)
}

#[test]
fn time_left_is_right_from_the_first_look_on() {
    let folder = tempfile::tempdir().unwrap();
    let mut paths: Vec<PathBuf> = ["square_and_arc.ngc", "chords_and_star.ngc"].map(job).to_vec();
    let zigzag: String =
        (1..200).map(|n| format!("G1 X{} Y{}\n", f64::from(n) * 0.05, n % 2)).collect();
    for (name, text) in [
        ("dwells", "G21 G90 F1500\nG4 P1.5\nG1 X4\nG4 P0.7\nG1 Y3\nG4 P2\nM2\n".to_owned()),
        ("rapids", "G21 G90 F300\nG0 X40\nG0 Y30 Z5\nG1 Z4\nG0 X0 Y0 Z0\nG1 X1\nM2\n".to_owned()),
        ("segments", format!("G21 G90 F3000\n{zigzag}M2\n")),
        ("pauses", format!("G21 G90 F1500 M3 S1000\n{}M2\n", "G1 X2\nM0\nG1 X0\nM0\n".repeat(20))),
        ("short", "G21 G90 F1500\nG1 X0.1\nM2\n".to_owned()),
    ] {
        let path = folder.path().join(format!("{name}.ngc"));
        std::fs::write(&path, text).unwrap();
        paths.push(path);
    }
    for path in paths {
        let errors = follow(&path, 0, None);
        eprintln!("{}: {errors:?}", path.display());
        assert!(errors.looks > 20);
    }
}

#[test]
fn pauses_and_holds_do_not_count() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ngc");
    std::fs::write(&path, "G21 G90 F1500\nG1 X9\nM0\nG1 Y9\nM6 T2\nG1 X0 Z1\nM2\n").unwrap();
    for hold_at in [None, Some(150)] {
        eprintln!("{:?}", follow(&path, 3000, hold_at));
    }
}
