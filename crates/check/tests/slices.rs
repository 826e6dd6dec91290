//! The slices of a capture in a file give the report of the whole capture.

use crate::common::*;
use carrystep_check::*;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// A capture as a logic analyser writes it: all pins are bits of one vector, in ns, and every line
/// gives all of them.
fn vector(machine: &Machine, train: &[PinChange]) -> String {
    let pins = 2 * machine.timelines.len();
    let mut text =
        format!("$timescale 1 ns $end\n$var wire {pins} ! p $end\n$enddefinitions $end\n");
    let mut levels = vec![false; pins];
    let line = |levels: &[bool]| -> String {
        levels.iter().rev().map(|&level| if level { '1' } else { '0' }).collect()
    };
    let _ = writeln!(text, "#0\nb{} !", line(&levels));
    for change in train {
        let pin = 2 * usize::from(change.axis) + usize::from(change.pin == Pin::Dir);
        levels[pin] = change.level;
        let _ = writeln!(text, "#{}\nb{} !", change.ps / 1000, line(&levels));
    }
    text
}

fn map(machine: &Machine) -> SignalMap {
    let names = machine.names().iter().enumerate();
    let pins = names.flat_map(|(axis, name)| {
        [format!("{name}.step=p[{}]", 2 * axis), format!("{name}.dir=p[{}]", 2 * axis + 1)]
    });
    SignalMap::parse(pins.collect::<Vec<_>>()).unwrap()
}

struct Written {
    _folder: tempfile::TempDir,
    path: PathBuf,
}

fn written(bytes: impl AsRef<[u8]>) -> Written {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("c.vcd");
    std::fs::write(&path, bytes).unwrap();
    Written { _folder: folder, path }
}

fn whole(path: &Path, machine: &Machine, map: &SignalMap, setup: Setup<'_>) -> CheckReport {
    let reader = Capture::new(path, machine.names(), map).unwrap().open().unwrap();
    let mut checker = Checker::new(setup);
    reader.play(&mut checker).unwrap();
    checker.finish()
}

/// Checks a capture in so many slices, and returns the slices that were checked again.
fn check(
    path: &Path,
    machine: &Machine,
    map: &SignalMap,
    setup: &Setup<'_>,
    count: u64,
) -> Vec<u64> {
    let capture = Capture::new(path, machine.names(), map).unwrap();
    let slice = |number| capture.check_slice(|| setup.clone(), number, count).unwrap();
    let slices: Vec<Slice> = (1..=count).map(slice).collect();
    let merged = capture.merge(setup.clone(), &slices).unwrap();
    assert_eq!(merged.report, whole(path, machine, map, setup.clone()), "{count} slices");
    merged.again
}

fn without_pulses(train: &[PinChange], lost: std::ops::Range<usize>) -> Vec<PinChange> {
    let mut train = train.to_vec();
    for _ in lost.clone() {
        let at = rise(&train, 0, lost.start);
        let (ps, axis) = (train[at].ps + HIGH_PS, train[at].axis);
        train.remove(at);
        train.retain(|change| (change.ps, change.axis, change.level) != (ps, axis, false));
    }
    train
}

#[test]
fn slices_of_a_good_capture_are_all_appended() {
    let machine = Machine::there_and_back(3);
    let train = machine.train();
    let analyser = Setup { slack_ps: 1000, ..machine.setup(Origin::Midpoint) };
    for (capture, map, setup) in [
        (machine.vcd(&train), SignalMap::default(), machine.setup(KNOWN)),
        (vector(&machine, &train).into_bytes(), map(&machine), analyser),
    ] {
        let capture = written(capture);
        for count in [1, 2, 3, 5, 8, 40] {
            let again = check(&capture.path, &machine, &map, &setup, count);
            assert_eq!(again, [0_u64; 0], "{count} slices");
        }
    }
}

#[test]
fn a_lost_pulse_is_found_in_its_slice_alone() {
    let machine = Machine::there_and_back(2);
    let train = without_pulses(&machine.train(), 300..301);
    let own = written(machine.vcd(&train));
    let setup = machine.setup(KNOWN);
    let report = whole(&own.path, &machine, &SignalMap::default(), setup.clone());
    assert!(!report.passed);
    let again = check(&own.path, &machine, &SignalMap::default(), &setup, 10);
    assert!(again.len() <= 1, "{again:?}");
}

#[test]
fn a_slice_that_begins_in_a_gap_is_checked_again() {
    // Axis x is silent for half of the move, so that the slices in the gap do not know it.
    let machine = Machine::there_and_back(1);
    let train = without_pulses(&machine.train(), 200..800);
    let own = written(machine.vcd(&train));
    let setup = machine.setup(KNOWN);
    let again = [2, 3, 10, 40]
        .map(|count| check(&own.path, &machine, &SignalMap::default(), &setup, count).len());
    assert!(again.iter().all(|&again| again <= 2) && again[3] > 0, "{again:?}");
}

#[test]
fn captures_without_a_pulse_or_with_one_time_can_be_sliced() {
    let machine = Machine::there_and_back(1);
    let setup = machine.setup(Origin::Midpoint);
    let head = "$timescale 1 ns $end\n$var wire 1 ! x.step $end\n\
                $var wire 1 # x.dir $end\n$enddefinitions $end\n";
    for body in [
        "",
        "#0\n1!\n1#\n",
        "#0\n0!\n#5\n",
        "#0 1!\n0#\n#7 0!\n#9 1!\n#11 0!\n#12",
        "#3\n#3\n#3\n1!\n",
    ] {
        let capture = written(format!("{head}{body}"));
        for count in [1, 2, 3, 9] {
            check(&capture.path, &machine, &SignalMap::default(), &setup, count);
        }
    }
}

#[test]
fn mistakes_are_told_with_the_lines_of_the_capture() {
    let machine = Machine::there_and_back(1);
    let mut text = String::from_utf8(machine.vcd(&machine.train())).unwrap();
    let place = text.len() * 3 / 4;
    let place = place + text[place..].find("\n#").unwrap() + 1;
    text.insert_str(place, "?broken\n");
    let line = text[..place].matches('\n').count() + 1;
    let (own, none) = (written(&text), SignalMap::default());
    let capture = Capture::new(&own.path, machine.names(), &none).unwrap();
    let setup = machine.setup(KNOWN);
    let slice = |number| capture.check_slice(|| setup.clone(), number, 3);
    assert!(slice(1).is_ok() && slice(2).is_ok());
    let error = slice(3).unwrap_err().to_string();
    assert!(error.starts_with(&format!("line {line} of the capture")), "{error}, line {line}");

    // A capture that was cut off has no last line.
    let own = written(&text[..place]);
    let capture = Capture::new(&own.path, machine.names(), &none).unwrap();
    let slice = |number| capture.check_slice(|| setup.clone(), number, 3);
    assert!(slice(1).is_ok() && slice(2).is_ok());
    let error = slice(3).unwrap_err().to_string();
    assert!(error.contains("the last line of a carrystep capture is missing"), "{error}");
}

#[test]
fn a_time_that_goes_back_between_two_slices_is_told() {
    let machine = Machine::there_and_back(1);
    let text = vector(&machine, &machine.train());
    let (head, values) = text.split_at(text.find("#0").unwrap());
    let (map, setup) = (map(&machine), machine.setup(KNOWN));
    let (mut in_a_slice, mut between) = (0, 0);
    // The second half comes first, so that time goes back in the middle, where the cut is.
    let lines = values.match_indices("\n#").map(|(place, _)| place + 1);
    let middle = lines.skip_while(|place| place + 200 < values.len() / 2).take(40);
    for half in middle {
        let own = written(format!("{head}{}{}", &values[half..], &values[..half]));
        let capture = Capture::new(&own.path, machine.names(), &map).unwrap();
        let slice = |number| capture.check_slice(|| setup.clone(), number, 2);
        let told = match (1..=2).map(slice).collect::<Result<Vec<_>, _>>() {
            Err(error) => (&mut in_a_slice, error),
            Ok(slices) => (&mut between, capture.merge(setup.clone(), &slices).unwrap_err()),
        };
        *told.0 += 1;
        assert!(told.1.to_string().contains("time goes back from "), "{}", told.1);
    }
    assert!(in_a_slice > 0 && between > 0, "{in_a_slice} {between}");
}

#[test]
fn slices_of_other_captures_and_gaps_are_refused() {
    let machine = Machine::there_and_back(1);
    let train = machine.train();
    let one = written(machine.vcd(&train));
    let other = written(machine.vcd(&without_pulses(&train, 300..301)));
    let none = SignalMap::default();
    let [one, other] =
        [&one, &other].map(|file| Capture::new(&file.path, machine.names(), &none).unwrap());
    let setup = machine.setup(KNOWN);
    let slices = |capture: &Capture<'_>, count| -> Vec<Slice> {
        let slice = |number| capture.check_slice(|| setup.clone(), number, count).unwrap();
        (1..=count).map(slice).collect()
    };
    let mut mixed = slices(&one, 3);
    mixed[1] = slices(&other, 3)[1].clone();
    let error = one.merge(setup.clone(), &mixed).unwrap_err().to_string();
    assert!(error.starts_with("slice 2 is of another capture"), "{error}");
    let mut gap = slices(&one, 3);
    gap[1] = slices(&one, 4)[1].clone();
    let error = one.merge(setup.clone(), &gap).unwrap_err().to_string();
    assert!(error.starts_with("slice 2 does not begin where"), "{error}");
    gap.truncate(1);
    assert!(one.merge(setup.clone(), &gap).is_err());
}
