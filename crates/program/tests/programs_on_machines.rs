//! What the planner gets of a program: rests, tolerances, feeds, axes; and what is refused.

use crate::repeats;
use carrystep_files::{InputError, Machine, SourceText};
use carrystep_program::{
    Event, Events, ProgramError, ProgramFile, ProgrammedMove, Rows, Settings, Survey,
};
use proptest::prelude::*;
use std::path::Path;

const AXIS: &str = "speed_limit = 100\naccel_limit = 1000\ndriver = \"tmc2209\"\n";

/// A machine with axes of these names; each has 80 steps a unit and a travel of -100 to 100.
fn machine(names: &str) -> Machine {
    let text = text_of_machine(names);
    Machine::from_source(&SourceText { path: "m.toml".into(), text: text.into() }).unwrap()
}

/// The file of this machine.
fn text_of_machine(names: &str) -> String {
    let mut text = "[machine]\n".to_owned();
    for name in names.chars() {
        let axis = format!("[[machine.axis]]\nname = \"{name}\"\nsteps_per_unit = 80\n{AXIS}");
        text += &format!("{axis}travel = [-100, 100]\n");
    }
    text
}

fn open(
    text: impl AsRef<[u8]>,
    names: &str,
    settings: Settings,
) -> (tempfile::TempDir, Result<ProgramFile, InputError>) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("job.ngc");
    std::fs::write(&path, text).unwrap();
    let file = ProgramFile::open(&path, machine(names), Path::new("m.toml"), settings);
    (folder, file)
}

fn survey(text: impl AsRef<[u8]>, names: &str, settings: Settings) -> Result<Survey, InputError> {
    let (_folder, file) = open(text, names, settings);
    Survey::new(&file?, |_| Ok::<(), ProgramError>(())).map_err(InputError::from)
}

fn moves(text: &str) -> Vec<ProgrammedMove> {
    let (_folder, file) = open(text, "xyza", Settings::default());
    let only = |event| match event {
        Ok(Event::Move(one)) => Some(one),
        _ => None,
    };
    Events::new(&file.unwrap()).unwrap().filter_map(only).collect()
}

#[test]
fn tolerance_is_that_of_the_option_or_of_g64_or_the_default() {
    let text = "F600\nG1 X1\nG64 P0.2\nX2\nG61\nX3\nG61.1\nX4\nG64 P0\nX5\n";
    let linear = |settings| {
        let (_folder, file) = open(text, "xyz", settings);
        let events: Vec<Event> = Events::new(&file.unwrap()).unwrap().map(Result::unwrap).collect();
        let tolerance = |event: &Event| match event {
            Event::Move(one) => Some(one.tolerance.linear),
            _ => None,
        };
        events.iter().filter_map(tolerance).collect::<Vec<_>>()
    };
    let step = 1.0 / 80.0;
    assert_eq!(linear(Settings::default()), [0.01, 0.2, step, 0.01, step]);
    let given = Settings { tolerance_mm: Some(0.5), ..Settings::default() };
    assert_eq!(linear(given), [0.5, 0.5, step, 0.5, 0.5]);
}

#[test]
fn inverse_time_gives_the_speed_of_the_path() {
    let found = moves("G93\nG1 X3 Y4 F2\nG1 A90 F60\nG2 X3 Y4 I1 F1\n");
    assert_eq!(found[0].feed, Some(5.0 / 30.0));
    assert_eq!(found[1].feed, Some(90.0));
    let whole_turn = found[2].feed.unwrap();
    assert!((whole_turn - std::f64::consts::TAU / 60.0).abs() < 1e-12, "{whole_turn}");
}

#[test]
fn runs_dwells_and_switches_are_counted() {
    let text = "G0 X1\nG4 P0.5\nM3 S1000\nG1 X2 F600\nM8\nX3\nX4\nM0\nX5\nM2\n";
    let survey = survey(text, "xyz", Settings::default()).unwrap();
    let counts = &survey.counts;
    assert_eq!((counts.lines, counts.moves, counts.runs, counts.dwell_s), (10, 5, 4, 0.5));
    assert_eq!((counts.distance_mm, counts.rapid_mm), (5.0, 1.0));
    let named: Vec<_> =
        counts.switches.iter().map(|one| (one.switch.name(), one.count, one.line)).collect();
    // M2 switches spindle and coolant off.
    assert_eq!(named, [("pause", 1, 8), ("spindle", 2, 3), ("coolant", 2, 5)]);
    assert!(survey.landed());
}

#[test]
fn dwell_takes_exactly_its_time_and_exact_stop_rests() {
    let ticks = |text: &str| survey(text, "xyz", Settings::default()).unwrap().ticks;
    let (without, with) = (ticks("G1 X1 F600\nX2\n"), ticks("G1 X1 F600\nG4 P0.25\nX2\n"));
    let stopped = ticks("G61.1 G1 X1 F600\nX2\n");
    assert_eq!(with - stopped, 250_000);
    assert!(stopped > without);
}

#[test]
fn start_moves_the_job_and_not_its_shape() {
    let settings = |x| Settings { start: [x, 0.0, 0.0, 0.0, 0.0, 0.0], ..Settings::default() };
    let there = survey("G91 G1 X10 F600\n", "xyz", settings(-50.0)).unwrap();
    assert_eq!((there.axes[0].start_steps, there.axes[0].end_steps), (-4000, -3200));
    let here = survey("G91 G1 X10 F600\n", "xyz", settings(0.0)).unwrap();
    assert_eq!(here.axes[0].steps(), 800);
    // Another place can round to one knot of 4 ms more.
    assert!(here.ticks.abs_diff(there.ticks) <= 4000, "{} {}", here.ticks, there.ticks);
    let outside = survey("G91 G1 X10 F600\n", "xyz", settings(101.0)).unwrap_err();
    assert!(outside.to_string().contains("starts at x = 101, beyond the travel"), "{outside}");
}

/// A program, the axes of its machine, the place of the mistake, and a part of the message.
const REFUSED: [(&str, &str, (usize, usize), &str); 10] = [
    ("G0 X1\nG1 X2\n", "xyz", (2, 1), "G1 without a feed"),
    (
        "G1 X1 F600\nX101\n",
        "xyz",
        (2, 1),
        "x would go to 101 mm, beyond its travel of -100 to 100 mm",
    ),
    ("G1 X90 F600\nG2 X90 Y1 J0 I5\n", "xyz", (2, 1), "the arc does not meet"),
    ("G0 X90\nG2 X90 I10.5 F600\n", "xyz", (2, 1), "x would go to 111"),
    ("G0 X1\nG0 A5\n", "xyz", (2, 1), "a moves, and the machine has no axis a"),
    ("G2 I1 F600\n", "xz", (1, 1), "y moves, and the machine has no axis y"),
    ("G0 X1\n  G41 X2\n", "xyz", (2, 3), "G41"),
    ("G0 X[1/0]\n", "xyz", (1, 7), "division by zero"),
    ("o1 while [1]\nG0 X1\n", "xyz", (1, 1), "never closed"),
    ("o1 while [1]\no1 endwhile\n", "xyz", (0, 0), "have run more than 1000 lines"),
];

#[test]
fn mistakes_are_refused_with_their_place() {
    for (text, names, place, says) in REFUSED {
        let settings = Settings { blocks: 1000, ..Settings::default() };
        let error = survey(text, names, settings).unwrap_err();
        assert!(error.message.contains(says), "{text}: {error}");
        assert!(error.help.is_some() || says.contains("arc"), "{error:?}");
        if place != (0, 0) {
            assert_eq!(error.line_column(), Some(place), "{error}");
        }
    }
}

#[test]
fn machines_that_cannot_run_jobs_are_refused() {
    for (names, says) in [
        ("xw", "the axis 'w' has no letter"),
        ("xaz", "the axis 'z' comes after an axis in degrees"),
    ] {
        let error = survey("G0 X1\n", names, Settings::default()).unwrap_err();
        assert!(error.message.contains(says), "{error}");
    }
}

#[test]
fn line_that_is_too_slow_for_the_axes_is_refused() {
    let open = |names: &str, link: &str| {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("job.ngc");
        std::fs::write(&path, "G0 X1\n").unwrap();
        let text = format!("[machine.link]\n{link}\n{}", text_of_machine(names));
        let source = SourceText { path: "m.toml".into(), text: text.into() };
        let machine = Machine::from_source(&source).unwrap();
        ProgramFile::open(&path, machine, Path::new("m.toml"), Settings::default()).map(drop)
    };
    let error = open("xyzabc", "baud = 115_200").unwrap_err();
    let says = "m.toml: a line of 115200 baud is too slow for jobs of 6 axes: each needs a segment \
                every 16 ms at least, and they take 210000 baud";
    assert_eq!(error.message, says);
    assert!(error.help.is_some_and(|help| help.contains("raise baud")));
    for (names, link) in
        [("xyz", "baud = 115_200"), ("xyzabc", "baud = 210_000"), ("xyzabc", "spi = true")]
    {
        assert!(open(names, link).is_ok(), "{names}, {link}");
    }
}

#[test]
fn file_that_changes_between_two_passes_is_refused() {
    let (folder, file) = open("G0 X1\n", "xyz", Settings::default());
    let file = file.unwrap();
    assert!(Rows::new(&file).is_ok());
    std::fs::write(folder.path().join("job.ngc"), "G0 X1 Y1\n").unwrap();
    let error = InputError::from(Rows::new(&file).unwrap_err());
    assert!(error.message.contains("has changed"), "{error}");
}

const PROGRAM: &str = "G21 G90 G64 P0.02 F1200\nG0 X1 Y1\no1 repeat [2]\nG91 G2 X2 Y0 I1 J0\nG90 G1 X[#1+1] Y-1 Z.5\no1 endrepeat\nG4 P.01\nM3 S100\nG61.1\nG3 X0 Y0 R9\nM2\n";

/// A mutated feed can make a job last for years.
const MOST_ROWS: u32 = 500;

enum Ended {
    Refused(InputError),
    Enough,
}

impl From<ProgramError> for Ended {
    fn from(error: ProgramError) -> Self {
        Self::Refused(error.into())
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: repeats::part(5000, 4), ..ProptestConfig::default() })]

    /// No text makes reading or planning panic or run without end: a program is refused with its
    /// place, or its job lands.
    #[test]
    fn mutated_programs_are_planned_or_refused(
        edits in prop::collection::vec((0..PROGRAM.len(), any::<u8>(), 0..3_u8), 1..6),
    ) {
        let mut text = PROGRAM.as_bytes().to_vec();
        for (at, byte, kind) in edits {
            let at = at % text.len();
            // Most edits use the characters of programs.
            let known = b"GMXYZIJRFPO0123456789.-[]# \n"[usize::from(byte) % 28];
            match kind {
                0 => text[at] = known,
                1 => text.insert(at, if byte < 16 { byte } else { known }),
                _ => drop(text.remove(at)),
            }
        }
        let settings = Settings { blocks: 1000, ..Settings::default() };
        let (_folder, file) = open(&text, "xyz", settings);
        let mut rows = 0;
        let survey = Survey::new(&file.unwrap(), |_| {
            rows += 1;
            if rows < MOST_ROWS { Ok(()) } else { Err(Ended::Enough) }
        });
        match survey {
            Ok(survey) => prop_assert!(survey.landed()),
            Err(Ended::Refused(error)) => prop_assert!(!error.message.is_empty()),
            Err(Ended::Enough) => {}
        }
    }
}
