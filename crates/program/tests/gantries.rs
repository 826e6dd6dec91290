//! Machines whose letters have several motors: all motors of a letter make the pulses that one motor
//! would make, the checker notices a motor that does not, and machine files that cannot be so are
//! refused.

use crate::common::{check, planned, program_on, pulses};
use carrystep_check::{Pin, PinChange};
use carrystep_files::{InputError, Machine, MoveFile, SourceText};
use carrystep_job::{Overrides, Pace, Track};
use carrystep_program::Row;
use proptest::prelude::*;
use std::fmt::Write as _;

/// A motor of a letter: its name, its letter, and its limits of speed and acceleration.
fn motor(name: &str, letter: char, limits: (u32, u32)) -> String {
    let (speed, acceleration) = limits;
    format!(
        "[[machine.axis]]\nname = \"{name}\"\nletter = \"{letter}\"\nsteps_per_unit = 80\n\
         speed_limit = {speed}\naccel_limit = {acceleration}\ndriver = \"tmc2209\"\n"
    )
}

/// A machine of these motors. Its link is an SPI, so that the number of motors is no matter for it.
fn machine(motors: &str) -> String {
    format!("[machine]\ntick_ns = 1000\n[machine.link]\nspi = true\n{motors}")
}

/// The rows of a program on a machine with these motors.
fn rows(motors: &str, text: &str) -> Vec<Row> {
    let (_folder, file) = program_on(&machine(motors), text);
    let (survey, rows) = planned(&file);
    assert!(survey.landed());
    rows
}

/// A program of lines and half circles between places on a grid of 0.1 mm.
fn text(moves: &[(i32, i32, i32, bool)], feed: u32) -> String {
    let mut text = format!("G21 G90 G64 P0.02 F{feed}\n");
    let (mut x, mut y) = (0, 0);
    for &(to_x, to_y, z, is_arc) in moves {
        let mm = |tenths: i32| f64::from(tenths) / 10.0;
        let [i, j] = [to_x - x, to_y - y].map(|way| f64::from(way) / 20.0);
        let word = if is_arc && (to_x, to_y) != (x, y) {
            format!("G2 X{} Y{} Z{} I{i} J{j}", mm(to_x), mm(to_y), mm(z))
        } else {
            format!("G1 X{} Y{} Z{}", mm(to_x), mm(to_y), mm(z))
        };
        writeln!(text, "{word}").unwrap();
        (x, y) = (to_x, to_y);
    }
    text
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]
    #[test]
    fn motors_of_a_letter_make_the_steps_of_one_motor(
        moves in prop::collection::vec((-90..90, -90..90, -20..20, prop::bool::ANY), 1..6),
        feed in 300_u32..6000,
        letter in 0_usize..3,
        others in prop::collection::vec((30_u32..200, 300_u32..3000), 1..4),
        first in prop::bool::ANY,
    ) {
        let text = text(&moves, feed);
        prop_assume!(moves.iter().any(|&(x, y, z, _)| (x, y, z) != (0, 0, 0)));
        let limits = (120, 1500);
        let least = others.iter().fold(limits, |(speed, acceleration), other| {
            (speed.min(other.0), acceleration.min(other.1))
        });
        let (mut single, mut several) = (String::new(), String::new());
        // The motors behind the first one stand before or behind those of the other letters.
        let more: String = others.iter().enumerate().map(|(number, &limits)| {
            motor(&format!("m{number}"), ['x', 'y', 'z'][letter], limits)
        }).collect();
        for (number, name) in ['x', 'y', 'z'].into_iter().enumerate() {
            let own = if number == letter { least } else { limits };
            single += &motor(&name.to_string(), name, own);
            several += &motor(&name.to_string(), name, limits);
            if number == letter && first {
                several += &more;
            }
        }
        if !first {
            several += &more;
        }
        let (single, several) = (rows(&single, &text), rows(&several, &text));
        prop_assert_eq!(single.len(), several.len());
        // Where the first motors of the letters are, and those behind the first one.
        let count = others.len();
        let leads: Vec<usize> = (0..3)
            .map(|number| if first && number > letter { number + count } else { number })
            .collect();
        let follows = if first { letter + 1 } else { 3 };
        for (one, all) in single.iter().zip(&several) {
            for (number, &lead) in leads.iter().enumerate() {
                prop_assert_eq!(&one.segments[number], &all.segments[lead]);
            }
            for follower in follows..follows + count {
                prop_assert_eq!(&all.segments[follower], &one.segments[letter]);
            }
            prop_assert_eq!((one.ticks, one.line, &one.marks), (all.ticks, all.line, &all.marks));
        }
    }
}

/// The motors x and y, and with `gantry` a second motor of y.
fn frame(gantry: bool) -> String {
    let names = [('x', "x"), ('y', "y"), ('y', "y2")];
    let motors = names.iter().take(if gantry { 3 } else { 2 });
    motors.map(|(letter, name)| motor(name, *letter, (100, 1000))).collect()
}

const LINES: &str = "G64 P0.02 F1800\nG1 X15 Y18\nG1 X19 Y-12\nG0 X3\nG1 X0 Y0\n";

#[test]
fn overrides_change_the_speed_of_a_gantry_as_that_of_one_motor() {
    let [single, several] = [false, true].map(|gantry| {
        let (_folder, file) = program_on(&machine(&frame(gantry)), LINES);
        let (_, rows) = planned(&file);
        let start = file.start_steps();
        let mut pace = Pace::new(file.machine(), &start).unwrap();
        let mut track = Track::new(&start);
        let mut planned = rows.into_iter();
        pace.set(Overrides { feed: 0.5, rapid: 0.5 }, None);
        let mut paced = Vec::new();
        while let Some(next) = pace.next(&mut track, &mut || planned.next()) {
            paced.push(next.row);
        }
        paced
    });
    assert_eq!(single.len(), several.len());
    for (one, both) in single.iter().zip(&several) {
        assert_eq!(
            [&one.segments[0], &one.segments[1], &one.segments[1]],
            [0, 1, 2].map(|motor| &both.segments[motor])
        );
    }
}

#[test]
fn power_of_a_laser_follows_the_tool_and_not_the_number_of_motors() {
    let text = format!("{}M5 M2\n", LINES.replacen("G1", "M4 S700\nG1", 1));
    let [single, several] = [false, true].map(|gantry| {
        let outputs = "[machine.outputs]\npwm_divider = 4\nspindle_rpm = 1000\nlaser = true\n";
        let file = format!("{}{outputs}", machine(""));
        let (_folder, file) = program_on(&format!("{file}{}", frame(gantry)), &text);
        let (_, rows) = planned(&file);
        let mut outputs = file.row_outputs();
        rows.iter().map(|row| outputs.change(row).duty).collect::<Vec<_>>()
    });
    assert!(single.iter().flatten().count() > 20, "{single:?}");
    assert_eq!(single, several);
}

/// The failures of the check of a gantry's program with changed pulses.
fn failures(bug: impl Fn(&mut Vec<PinChange>)) -> Vec<String> {
    let motors = [('x', "x"), ('y', "y"), ('y', "y2")]
        .map(|(letter, name)| motor(name, letter, (100, 1000)));
    let text = "G64 P0.02 F1800\nG1 X5 Y8\nG1 X9 Y-2\nG1 X0 Y0\n";
    let (_folder, file) = program_on(&machine(&motors.concat()), text);
    let (survey, rows) = planned(&file);
    let mut changes = pulses(&rows);
    bug(&mut changes);
    check(&file, &survey, &changes, None).failures
}

#[test]
fn both_motors_of_a_gantry_pass_the_check() {
    assert_eq!(failures(|_| ()), Vec::<String>::new());
}

#[test]
fn motor_that_rests_or_is_late_alone_is_caught() {
    let says = |found: Vec<String>, what: &str| {
        assert!(found.iter().any(|one| one.contains(what)), "{found:?}");
    };
    let dead = failures(|changes| changes.retain(|change| change.axis != 2));
    says(dead, "the motors y and y2 move one letter and are 2 steps apart");
    // All of its pulses come, but each 50 ms late.
    let late = failures(|changes| {
        for change in changes.iter_mut().filter(|change| change.axis == 2) {
            change.ps += 50_000_000_000;
        }
        changes.sort_by_key(|change| change.ps);
    });
    says(late, "move one letter and are 2 steps apart");
    // One pulse is missing: no two steps apart, and yet not at the end.
    let short = failures(|changes| {
        let rises = |change: &PinChange| change.axis == 2 && change.pin == Pin::Step;
        let last = changes.iter().rposition(rises).unwrap();
        // Its fall and its rise.
        changes.remove(last);
        let rise = changes[..last].iter().rposition(rises).unwrap();
        changes.remove(rise);
    });
    says(short, "axis y2: the pulses end at");
}

fn read(text: &str) -> Result<Machine, InputError> {
    Machine::from_source(&SourceText { path: "m.toml".into(), text: text.into() })
}

const GANTRY: &str = "[machine]
home_order = [[\"y\"]]
[machine.guard]
limits = \"pair\"
[[machine.axis]]
name = \"y\"
steps_per_unit = 80
start_speed = 2
speed_limit = 100
accel_limit = 1000
stop_accel = 2000
driver = \"tmc2209\"
travel = [0, 300]
home = { toward = \"min\", seek_speed = 20, slow_speed = 1, move_off = 5, pull_off = 2, position = 0 }
[[machine.axis]]
name = \"y2\"
letter = \"y\"
steps_per_unit = 80
speed_limit = 90
accel_limit = 1200
jerk_limit = 50_000
stop_accel = 1500
driver = \"a4988\"
home = { toward = \"min\", seek_speed = 20, slow_speed = 1, move_off = 5, pull_off = 1.7, position = 0.3, most_apart = 3 }
";

#[test]
fn motors_of_a_letter_have_the_least_limits_and_the_longest_times() {
    let machine = read(GANTRY).unwrap();
    let [first, second] = &machine.axes[..] else { panic!("two motors") };
    for axis in [first, second] {
        assert_eq!(axis.letter, "y");
        assert_eq!((&axis.start_speed.steps, &axis.speed_limit.steps), (&0.into(), &7200.into()));
        assert_eq!(
            (&axis.accel_limit.steps, axis.jerk_limit.as_ref().map(|limit| &limit.steps)),
            (&80_000.into(), Some(&4_000_000.into()))
        );
        assert_eq!((axis.pins_ns.step_high, axis.travel), (1000, Some([0, 24_000])));
        let home = axis.home.unwrap();
        assert_eq!((home.rests(), home.most_apart), (160, 240));
    }
    assert_eq!((first.stop, first.pins), (second.stop, second.pins));
    assert_eq!(machine.home_order, [[0, 1]]);
    assert_eq!((machine.leader(1), machine.with_its_letter(0)), (0, 3));
    assert_eq!((machine.leaders(), machine.letter_numbers()), (vec![0], vec![0, 0]));
}

/// What is changed in the file, the line and column of the mistake, and a part of the message.
const REFUSED: [(&str, &str, (usize, usize), &str); 12] = [
    ("letter = \"y\"", "letter = \"q\"", (17, 10), "there is no such letter"),
    ("letter = \"y\"", "letter = \"\"", (17, 10), "there is no such letter"),
    ("name = \"y2\"", "name = \"x\"", (17, 10), "the axis 'x' has the letter y"),
    (
        "steps_per_unit = 80\nspeed_limit = 90",
        "steps_per_unit = 81\nspeed_limit = 90",
        (16, 8),
        "have 80 and 81 steps per unit",
    ),
    (
        "driver = \"a4988\"\n",
        "driver = \"a4988\"\nunit = \"deg\"\n",
        (16, 8),
        "are in units and deg",
    ),
    (
        "driver = \"a4988\"\n",
        "driver = \"a4988\"\ntravel = [0, 299]\n",
        (24, 10),
        "have different travels",
    ),
    ("limits = \"pair\"", "limits = \"one\"", (24, 8), "share one wire for their switches"),
    ("pull_off = 1.7", "pull_off = 2", (24, 8), "would rest 0.3 units (24 steps) apart"),
    (
        "seek_speed = 20, slow_speed = 1, move_off = 5, pull_off = 1.7",
        "seek_speed = 19, slow_speed = 1, move_off = 5, pull_off = 1.7",
        (24, 8),
        "home in different ways",
    ),
    (
        "home_order = [[\"y\"]]",
        "home_order = [[\"y2\"]]",
        (2, 16),
        "home_order names 'y2', which is no axis",
    ),
    (
        "letter = \"y\"\n",
        "letter = \"z\"\ntravel = [0, 99]\n",
        (25, 118),
        "most_apart: the letter z has one motor",
    ),
    ("speed_limit = 90", "speed_limit = 90\nletter = 3", (20, 1), "duplicate"),
];

#[test]
fn motors_that_cannot_stay_together_are_refused_with_their_place() {
    for (from, to, place, says) in REFUSED {
        let text = GANTRY.replacen(from, to, 1);
        assert_ne!(text, GANTRY, "{from}");
        let error = read(&text).err().unwrap_or_else(|| panic!("not refused: {to}"));
        let (source, span) = error.place.as_ref().unwrap();
        let before = &source.text[..span.start];
        let line = before.matches('\n').count() + 1;
        let column = before.len() - before.rfind('\n').map_or(0, |at| at + 1) + 1;
        assert!(error.message.contains(says), "{to}: {}", error.message);
        assert_eq!((line, column), place, "{to}: {}", error.message);
        assert!(error.help.is_some() || says == "duplicate", "{to}: {}", error.message);
    }
    let alone = GANTRY
        .lines()
        .filter(|line| !line.contains("position = 0.3"))
        .collect::<Vec<_>>()
        .join("\n");
    let error = read(&alone).unwrap_err();
    assert!(
        error.message.contains("'y' and 'y2' of the letter y, one has a home table"),
        "{error}"
    );
}

#[test]
fn moves_name_letters_and_move_all_of_their_motors() {
    let moves = |to: &str| {
        let text = format!("[[move]]\nprofile = \"ranade\"\nto = {{ {to} }}\n");
        MoveFile::of_moves(
            read(GANTRY).unwrap(),
            SourceText { path: "move".into(), text: text.into() },
        )
    };
    assert_eq!(moves("y = 2.5").unwrap().moves[0].steps, [200, 200]);
    let error = moves("y2 = 2.5").unwrap_err();
    assert!(error.message.contains("'y2' is a motor of the letter y: name y"), "{error}");
    assert!(moves("x = 1").unwrap_err().message.contains("no axis \"x\""));
}
