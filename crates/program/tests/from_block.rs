//! Programs that are entered in their middle: the way there, what is restored, and what is refused.

use crate::common::{check, job, levels, planned, program_on, pulses};
use crate::repeats;
use carrystep_files::{InputError, Machine, SourceText};
use carrystep_gcode::{Interpreter, Options};
use carrystep_program::{
    Blocks, Entry, Event, Events, FromBlock, ProgramFile, ProgrammedMove, Settings, Switch, Turn,
};
use proptest::prelude::*;
use std::path::Path;

const AXES: [f64; 6] = [0.0; 6];

fn from(block: u64) -> FromBlock {
    FromBlock { block, began_at: [None; 6], safe_z: None, spindle_dwell: None }
}

/// The file of a program in a folder, entered at a block from a place of the machine.
fn entered(
    file: &ProgramFile,
    start: [f64; 6],
    from: FromBlock,
) -> Result<ProgramFile, InputError> {
    let settings = Settings { start, from: Some(from), ..file.settings().clone() };
    ProgramFile::open(file.path(), file.machine().clone(), Path::new("m.toml"), settings)
}

/// The moves of a program, with the number of their block.
fn moves(file: &ProgramFile) -> Vec<ProgrammedMove> {
    let events = Events::new(file).unwrap().map(Result::unwrap);
    let only = |event| match event {
        Event::Move(one) => Some(one),
        _ => None,
    };
    events.filter_map(only).collect()
}

/// Axes of these names, with 80 steps/mm, and three outputs: spindle, flood, and one of the program.
fn machine(names: &str) -> String {
    let mut text = "[machine]\ntick_ns = 1000\n[machine.outputs]\ncount = 3\nspindle = 0\n\
        flood = 1\nspindle_rpm = 24000\npwm_divider = 4\n"
        .to_owned();
    for name in names.chars() {
        text += &format!(
            "[[machine.axis]]\nname = \"{name}\"\nsteps_per_unit = 80\nspeed_limit = 100\n\
             accel_limit = 1000\ndriver = \"tmc2209\"\ntravel = [-50, 50]\n"
        );
    }
    text
}

fn entry(names: &str, text: &str, start: [f64; 6], from: FromBlock) -> Result<Entry, InputError> {
    let (_folder, file) = program_on(&machine(names), text);
    entered(&file, start, from).map(|file| file.entry().unwrap().clone())
}

fn refused(names: &str, text: &str, from: FromBlock) -> String {
    let error = entry(names, text, AXES, from).unwrap_err();
    format!("{} {}", error.message, error.help.unwrap_or_default())
}

const MILLED: &str = "G21 G90 G64 P0.02\nM3 S6000\nG4 P0.5\nM8\nG0 X5 Y5 Z4\nG1 Z-1 F600\n\
    o1 repeat [3]\nG91 G1 X2\nG3 X1 Y1 I0.5 J0.5\nG90\no1 endrepeat\nM64 P2\nG1 Y9\nM65 P2\nG0 Z4\nM2\n";

#[test]
fn way_in_goes_up_over_and_down() {
    let (_folder, file) = program_on(&machine("xyz"), MILLED);
    let file = entered(&file, [1.0, 2.0, -1.5, 0.0, 0.0, 0.0], from(12)).unwrap();
    let entry = file.entry().unwrap();
    // The second round of the loop.
    assert_eq!((entry.block.line, &*entry.block.text, entry.block.number), (8, "G91 G1 X2", 12));
    assert_eq!((entry.height, entry.dwell, entry.feed), (Some(4.0), 0.5, 10.0));
    let modes = &entry.modes;
    assert_eq!((modes.spindle, modes.rpm, modes.flood), (Turn::Clockwise, 6000.0, true));
    let way: Vec<_> = moves(&file).iter().take(4).map(|one| (one.to, one.feed)).collect();
    let to = |x, y, z| [x, y, z, 0.0, 0.0, 0.0];
    assert_eq!(
        way,
        [
            (to(1.0, 2.0, 4.0), None),
            (to(8.0, 6.0, 4.0), None),
            (to(8.0, 6.0, -1.0), Some(10.0)),
            (to(10.0, 6.0, -1.0), Some(10.0)),
        ]
    );
    // On the pins, too: spindle and coolant are on before the way down, and stay until the end.
    let (survey, rows) = planned(&file);
    let report = check(&file, &survey, &pulses(&rows), Some(&levels(&rows)));
    assert!(report.passed, "{report}");
    assert!(survey.landed());
    assert_eq!(levels(&rows).iter().map(|&(_, now)| now).collect::<Vec<_>>(), [3, 7, 3, 0]);
}

#[test]
fn outputs_of_the_program_are_restored_at_the_place() {
    let (_folder, file) = program_on(&machine("xyz"), MILLED);
    let blocks: Vec<_> = Blocks::new(&file).unwrap().map(Result::unwrap).collect();
    let line_13 = blocks.iter().find(|timed| timed.block.line == 13).unwrap();
    let file = entered(&file, AXES, from(line_13.block.number)).unwrap();
    let mut down = false;
    for event in Events::new(&file).unwrap().map(Result::unwrap) {
        match event {
            Event::Move(ref one) => down |= one.to[2] == -1.0,
            Event::Outputs { change, .. } => assert_eq!(change.mask & 4 != 0, down),
            _ => {}
        }
        if down && matches!(event, Event::Outputs { .. }) {
            return;
        }
    }
    panic!("output 2 is not restored");
}

#[test]
fn programs_of_the_tree_end_where_they_end_whole() {
    let text = job("machine.toml");
    let mut programs = Vec::new();
    for name in ["square_and_arc", "trochoid", "chords_and_star", "outputs", "relief"] {
        let machine = if name == "outputs" { job("outputs.toml") } else { text.clone() };
        let (folder, whole) = program_on(&machine, &job(&format!("{name}.ngc")));
        let count = Blocks::new(&whole).unwrap().count() as u64;
        let (as_a_whole, _) = planned(&whole);
        programs.push((folder, whole, count, as_a_whole));
    }
    let mut runner = proptest::test_runner::TestRunner::new(ProptestConfig {
        cases: repeats::part(24, 2),
        failure_persistence: None,
        ..ProptestConfig::default()
    });
    let place = -20.0..60.0_f64;
    let strategy = (0..programs.len(), 0.0..1.0_f64, [place.clone(), place.clone(), -2.0..9.0]);
    runner
        .run(&strategy, |(number, part, [x, y, z])| {
            let (_folder, whole, count, as_a_whole) = &programs[number];
            let block = 2 + (part * (count - 1) as f64) as u64;
            let steps = |at: f64, steps: f64| (at * steps).round() / steps;
            let start = [steps(x, 80.0), steps(y, 80.0), steps(z, 400.0), 0.0, 0.0, 0.0];
            // Before an axis has moved, its place depends on where the program began.
            let known = FromBlock { began_at: [Some(0.0); 6], ..from(block) };
            let file = entered(whole, start, known).unwrap();
            let entry = file.entry().unwrap();
            let behind = |file: &ProgramFile| {
                let mut moves = moves(file);
                moves.retain(|one| one.block >= block);
                moves
            };
            let (all, entered) = (behind(whole), behind(&file));
            let way = entered.len() - all.len();
            prop_assert!(way <= 3);
            // Exactly the same path, with the same feeds and tolerances.
            prop_assert_eq!(&entered[way..], &all[..]);
            let above = entered[..way].iter().all(|one| {
                let moves_over = one.from[0] != one.to[0] || one.from[1] != one.to[1];
                !moves_over
                    || (Some(one.from[2]) == entry.height && Some(one.to[2]) == entry.height)
            });
            prop_assert!(above, "the way over the work is not at its height");
            let (survey, rows) = planned(&file);
            prop_assert!(survey.landed());
            for (one, other) in survey.axes.iter().zip(&as_a_whole.axes) {
                prop_assert_eq!(one.end_steps, other.end_steps);
            }
            if rows.len() < 3000 {
                let levels = (file.machine().outputs.exist != 0).then(|| levels(&rows));
                let report = check(&file, &survey, &pulses(&rows), levels.as_deref());
                prop_assert!(report.passed, "{}", report);
            }
            // The modes are those of the interpreter that has been there with motion.
            let options = Options::default();
            let mut there = Interpreter::open(whole.path(), &options).unwrap();
            let moved = std::iter::from_fn(|| there.step_before(block)).filter(Result::is_ok);
            prop_assert!(moved.count() > 0 || block < 6);
            prop_assert_eq!(&there.modes(), &entry.modes);
            prop_assert_eq!(there.place(), entry.place);
            Ok(())
        })
        .unwrap();
}

#[test]
fn block_zero_and_blocks_beyond_the_end_are_refused() {
    let text = "G21 F100\nG1 X1\nM2\n";
    assert!(refused("xyz", text, from(0)).contains("no block 0: the program has 3"));
    assert!(refused("xyz", text, from(4)).contains("no block 4: the program has 3"));
    // The end of the file ends a program, too.
    assert!(refused("xyz", "G21 F100\nG1 X1\n", from(3)).contains("no block 3: the program has 2"));
    assert!(refused("xyz", "", from(1)).contains("no block 1: the program has 0"));
    assert!(entry("xyz", text, AXES, from(3)).is_ok());
}

#[test]
fn first_block_begins_where_the_machine_is() {
    let (_folder, file) = program_on(&machine("xyz"), "G91 F600\nG1 X1\nM2\n");
    let start = [3.0, 4.0, 5.0, 0.0, 0.0, 0.0];
    let found = moves(&entered(&file, start, from(1)).unwrap());
    assert_eq!((found.len(), found[0].from, found[0].to[0]), (1, start, 4.0));
}

#[test]
fn cycles_and_arcs_are_entered_as_whole_blocks() {
    let text = "G90 G99 F300\nG0 X2 Y0 Z5\nG81 X2 Z-1 R1 L1\nG91 X3 L3\nG90 G80\nG2 X14 I1.5\nM2\n";
    let (_folder, file) = program_on(&machine("xyz"), text);
    let count = |from| moves(&entered(&file, AXES, from).unwrap()).len();
    // Three holes of a block, and the arc. With G91, R is 1 above the level of the first cycle:
    // up to it, then 3 times over, down, up.
    let whole = moves(&file);
    let of_block = |block| whole.iter().filter(|one| one.block == block).count();
    assert_eq!(of_block(4), 10);
    assert_eq!(count(from(4)), 3 + 10 + 1);
    // The place is at the height of the way already.
    assert_eq!(count(from(6)), 2 + 1);
    let at = |block| entered(&file, AXES, from(block)).unwrap().entry().unwrap().place;
    assert_eq!((at(4)[0], at(6)[0], at(6)[2]), (2.0, 11.0, 6.0));
}

#[test]
fn place_that_depends_on_the_beginning_has_to_be_given() {
    for text in [
        "G21 F600 G91\nG1 X1 Y1\nG1 X1\nM2\n",
        "G21 F600 G92 X0 Y0\nG1 X1 Y1\nG1 X2\nM2\n",
        "G21 F600 G10 L20 P1 X0 Y0\nG1 X1 Y1\nG1 X2\nM2\n",
        "G21 F600\n#1=#5420 #2=#5421\nG1 X[#1+1] Y[#2+1]\nG1 X[#1+2]\nM2\n",
    ] {
        let block = 3 + u64::from(text.contains('#'));
        let said = refused("xyz", text, from(block));
        assert!(said.contains("x depends on where the program began"), "{text}: {said}");
        assert!(said.contains("--began-at x="), "{text}: {said}");
        let mut known = from(block);
        (known.began_at[0], known.began_at[1]) = (Some(7.0), Some(8.0));
        let entry = entry("xyz", text, AXES, known).unwrap();
        assert_eq!(entry.place[..3], [8.0, 9.0, 0.0], "{text}");
    }
    // Only z has not moved before, and nothing moves it later: it stays where it is.
    let text = "G21 F600\nG1 X1 Y1\nG1 X2\nM2\n";
    let high = [0.0, 0.0, 6.0, 0.0, 0.0, 0.0];
    let found = entry("xyz", text, high, from(3)).unwrap();
    assert_eq!((found.place[2], found.height), (6.0, Some(6.0)));
    // It moves later: the first line that moves it is named when the program is planned.
    let (_folder, file) = program_on(&machine("xyz"), "G21 F600\nG1 X1 Y1\nG1 X2\nG1 Z-1\nM2\n");
    let file = entered(&file, AXES, from(3)).unwrap();
    let error = Events::new(&file).unwrap().find_map(Result::err).unwrap();
    assert_eq!((error.line, error.to_string().contains("z depends")), (4, true));
    // An offset of x alone leaves y what it is.
    let text = "G21 F600 G92 X0\nG1 X1 Y1 Z1\nG53 G0 X3\nG1 Y2\nM2\n";
    let mut known = from(4);
    assert!(refused("xyz", text, known.clone()).contains(" x depends"));
    known.began_at[0] = Some(1.0);
    assert_eq!(entry("xyz", text, AXES, known).unwrap().place[..3], [3.0, 1.0, 1.0]);
}

#[test]
fn safe_height_is_above_the_place_and_within_travel() {
    let with = |safe| FromBlock { safe_z: Some(safe), ..from(7) };
    assert_eq!(entry("xyz", MILLED, AXES, with(9.0)).unwrap().height, Some(9.0));
    let said = refused("xyz", MILLED, with(-2.0));
    assert!(said.contains("z = -2 mm is below -1 mm"), "{said}");
    let (_folder, file) = program_on(&machine("xyz"), MILLED);
    let file = entered(&file, AXES, with(51.0)).unwrap();
    let error = carrystep_program::Rows::new(&file).unwrap().find_map(Result::err).unwrap();
    assert!(error.to_string().contains("z would go to 51 mm, beyond its travel"), "{error}");
    // The way of G0 X1 was at the height where the program began, whatever that was.
    let text = "F60\nG0 X1 Y1\nG1 Z-1\nG1 X2\nM2\n";
    let said = refused("xyz", text, from(4));
    assert!(
        said.contains("the highest z before this block") && said.contains("--safe-z"),
        "{said}"
    );
    assert_eq!(
        entry("xyz", text, AXES, FromBlock { safe_z: Some(3.0), ..from(4) }).unwrap().height,
        Some(3.0)
    );
    let mut known = from(4);
    known.began_at[2] = Some(2.0);
    assert_eq!(entry("xyz", text, AXES, known).unwrap().height, Some(2.0));
    // A tool that is higher does not go down first.
    let high = [0.0, 0.0, 20.0, 0.0, 0.0, 0.0];
    assert_eq!(entry("xyz", MILLED, high, from(7)).unwrap().height, Some(20.0));
    // The top of an arc is higher than its ends.
    let arc = "G18 F600\nG0 X0 Y0 Z0\nG3 X4 Z0 I2\nG1 X5\nM2\n";
    assert_eq!(entry("xyz", arc, AXES, from(4)).unwrap().height, Some(2.0));
}

#[test]
fn machine_without_z_goes_straight_there() {
    let text = "G21 F600\nG1 X1 Y1\nG1 X2\nM2\n";
    let (_folder, file) = program_on(&machine("xy"), text);
    let found = moves(&entered(&file, AXES, from(3)).unwrap());
    assert_eq!(found.iter().map(|one| one.to[0]).collect::<Vec<_>>(), [1.0, 2.0]);
    let safe = FromBlock { safe_z: Some(3.0), ..from(3) };
    assert!(refused("xy", text, safe).contains("no axis z"));
}

#[test]
fn spindle_dwells_as_the_program_says_or_a_default() {
    let dwell = |text: &str, from| entry("xyz", text, AXES, from).unwrap().dwell;
    let known = |block| FromBlock { began_at: [Some(0.0); 6], ..from(block) };
    // Another speed alone does not need it.
    assert_eq!(dwell("F60\nM3 S100\nG4 P0.5\nG4 P1\nG1 X1\nS200\nG1 X2\nM2\n", known(7)), 1.5);
    assert_eq!(dwell("F60\nM3 S100\nG1 X1\nG4 P9\nG1 X2\nM2\n", known(5)), 3.0);
    assert_eq!(dwell("F60\nM3 S100\nG4 P1\nM5\nG1 X2\nM2\n", known(5)), 0.0);
    assert_eq!(dwell("F60\nM3 S100\nG4 P1\nM5\nM3\nG1 X2\nM2\n", known(6)), 3.0);
    let given = FromBlock { spindle_dwell: Some(0.25), ..known(4) };
    assert_eq!(dwell("F60\nM3 S100\nG4 P1\nG1 X2\nM2\n", given), 0.25);
}

#[test]
fn what_is_assumed_is_named() {
    let text = "F60 G0 X1 Y1 Z1\nG38.2 Z-1\nM66 P0 L3 Q1\nM6 T3\nM0\nG0 Z2\nG1 X2\nM2\n";
    let entry = entry("xyz", text, AXES, from(7)).unwrap();
    let passed: Vec<_> = entry.passed.iter().map(|one| (one.switch, one.line)).collect();
    let all = [(Switch::Probe, 2), (Switch::Input, 3), (Switch::ToolChange, 4), (Switch::Pause, 5)];
    assert_eq!((&passed[..], entry.modes.tool), (&all[..], 3));
}

#[test]
fn list_has_each_block_with_the_time_of_its_motion() {
    let (_folder, file) = program_on(&machine("xyz"), MILLED);
    let blocks: Vec<_> = Blocks::new(&file).unwrap().map(Result::unwrap).collect();
    let numbers: Vec<_> = blocks.iter().map(|timed| timed.block.number).collect();
    assert_eq!(numbers, (1..=blocks.len() as u64).collect::<Vec<_>>());
    let lines: Vec<_> = blocks.iter().map(|timed| timed.block.line).collect();
    let rounds = [8, 9, 10, 11].repeat(3);
    assert_eq!(lines, [&[1, 2, 3, 4, 5, 6, 7], &rounds[..], &[12, 13, 14, 15, 16]].concat());
    let times: Vec<f64> = blocks.iter().filter_map(|timed| timed.begins_s).collect();
    assert_eq!(times.len(), 2 + 6 + 2);
    assert!(times.is_sorted(), "{times:?}");
    // Behind the dwell.
    assert!((0.5..0.54).contains(&times[0]), "{times:?}");
    let machine =
        Machine::from_source(&SourceText { path: "m".into(), text: machine("xyz").into() });
    let (survey, _) = planned(&file);
    let total = survey.ticks as f64 * machine.unwrap().timebase.tick_seconds();
    assert!(times.last().unwrap() < &total);
}
