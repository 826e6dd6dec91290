//! The parts of a capture, each checked without knowledge of what was before, give the report of
//! the whole capture, whatever is wrong with its pulses.

use crate::common::*;
use carrystep_check::*;
use carrystep_profile::Course;
use proptest::prelude::*;
use std::ops::Range;

/// Where the capture is cut, and what is known there.
#[derive(Debug, Clone)]
struct Cut {
    ps: u64,
    /// Whether the levels of STEP are known; otherwise they are assumed to be low.
    step: bool,
    /// Whether the levels of DIR are known.
    dir: bool,
}

/// The levels of STEP and DIR after these changes.
fn levels(train: &[PinChange], axes: usize) -> Vec<[bool; 2]> {
    let mut levels = vec![[false; 2]; axes];
    for change in train {
        levels[usize::from(change.axis)][usize::from(change.pin == Pin::Dir)] = change.level;
    }
    levels
}

/// Checks a capture in parts, appends them in order, and checks those again that cannot be
/// appended. Returns the report, the number of parts that were appended, and that of all.
fn in_parts(
    machine: &Machine,
    setup: &Setup<'_>,
    train: &[PinChange],
    cuts: &[Cut],
) -> (CheckReport, usize, usize) {
    let mut origin = Checker::new(setup.clone());
    // A foreign capture has the origin that its first pulse gives.
    let mut changes = train.iter();
    while origin.origin_ps().is_none()
        && let Some(change) = changes.next()
    {
        origin.change(*change).unwrap();
    }
    let place = |cut: &Cut| train.partition_point(|change| change.ps < cut.ps);
    let mut places: Vec<usize> = cuts.iter().map(place).collect();
    places.push(train.len());
    let mut ranges: Vec<(Option<&Cut>, Range<usize>)> = vec![(None, 0..places[0])];
    for (number, cut) in cuts.iter().enumerate() {
        ranges.push((Some(cut), places[number]..places[number + 1]));
    }
    let parts = ranges.iter().map(|(cut, range)| {
        let mut checker = Checker::new(setup.clone());
        if let Some(cut) = cut {
            let levels = levels(&train[..range.start], machine.timelines.len());
            let known = |[step, dir]: [bool; 2]| (cut.step && step, cut.dir.then_some(dir));
            let levels: Vec<_> = levels.into_iter().map(known).collect();
            checker.begin_at(cut.ps, origin.origin_ps(), &levels);
        }
        let (sent, part) = beside(checker, &train[range.clone()]);
        sent.unwrap();
        let text = serde_json::to_string(&part).unwrap();
        assert_eq!(serde_json::from_str::<Part>(&text).unwrap(), part);
        part
    });
    let parts: Vec<Part> = parts.collect();
    let mut whole = Checker::new(setup.clone());
    let mut appended = 0;
    for (part, (_, range)) in parts.iter().zip(&ranges) {
        if whole.append(part) {
            appended += 1;
        } else {
            whole.changes(&train[range.clone()]).unwrap();
        }
    }
    (whole.finish(), appended, parts.len())
}

fn beside(mut checker: Checker<'_>, train: &[PinChange]) -> (Result<(), TraceError>, Part) {
    (checker.changes(train), checker.into_part())
}

/// A change of a capture that an axis of a good machine does not make.
#[derive(Debug, Clone)]
enum Fault {
    Drop,
    Late(u64),
    Invert,
    Again,
}

fn faults() -> impl Strategy<Value = Vec<(prop::sample::Index, Fault)>> {
    let fault = prop_oneof![
        Just(Fault::Drop),
        (0_u64..400_000_000).prop_map(Fault::Late),
        Just(Fault::Invert),
        Just(Fault::Again),
    ];
    prop::collection::vec((any::<prop::sample::Index>(), fault), 0..6)
}

fn spoiled(mut train: Vec<PinChange>, faults: &[(prop::sample::Index, Fault)]) -> Vec<PinChange> {
    for (place, fault) in faults {
        let place = place.index(train.len());
        match fault {
            Fault::Drop => drop(train.remove(place)),
            Fault::Late(ps) => train[place].ps += ps,
            Fault::Invert => train[place].level ^= true,
            Fault::Again => {
                let mut change = train[place];
                for (ps, level) in [(3_000_000, true), (1_500_000, false)] {
                    change.ps += ps;
                    change.level = level;
                    train.push(change);
                }
            }
        }
    }
    train.sort_by_key(|change| change.ps);
    train
}

fn setup(machine: &Machine, known: bool, on_a_line: bool) -> Setup<'_> {
    let origin = if known { KNOWN } else { Origin::Midpoint };
    let steps: Vec<i64> =
        machine.timelines.iter().map(|line| line.legs().next().unwrap().forward()).collect();
    let back = steps.iter().map(|steps| -steps).collect();
    let course = |steps| Course { steps, line_speed: Some(8.0) };
    let courses = on_a_line.then(|| vec![course(steps), course(back)].into());
    Setup { courses, ..machine.setup(origin) }
}

fn cut(longest_ps: u64) -> impl Strategy<Value = Cut> {
    (0..longest_ps, any::<bool>(), any::<bool>()).prop_map(|(ps, step, dir)| Cut { ps, step, dir })
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 1000,
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn parts_give_the_report_of_the_whole(
        axes in 1_usize..4,
        known in any::<bool>(),
        on_a_line in any::<bool>(),
        faults in faults(),
        mut cuts in prop::collection::vec(cut(600_000_000_000), 1..6),
    ) {
        let machine = Machine::there_and_back(axes);
        let setup = setup(&machine, known, on_a_line);
        let train = spoiled(machine.train(), &faults);
        cuts.sort_by_key(|cut| cut.ps);
        let mut whole = Checker::new(setup.clone());
        whole.changes(&train).unwrap();
        let (found, _, _) = in_parts(&machine, &setup, &train, &cuts);
        prop_assert_eq!(found, whole.finish());
    }
}

/// Cuts in the middle between two crossings are right in a capture without a fault, and behind one.
#[test]
fn parts_of_a_good_capture_are_appended() {
    let machine = Machine::there_and_back(2);
    for (known, faults) in [(true, 0), (false, 0), (true, 1)] {
        let setup = setup(&machine, known, true);
        let mut train = machine.train();
        if faults > 0 {
            // One pulse is too late, and after it all is well.
            let at = train.iter().position(|change| change.pin == Pin::Step).unwrap();
            train[at].ps += 100_000;
        }
        let mut cuts = Checker::new(setup.clone());
        cuts.set_origin_ps(Some(ORIGIN_PS));
        let all = (1..50).map(|part| part * 10_000_000_000 + 12_345);
        let clear: Vec<Cut> = all
            .filter(|&ps| !cuts.is_near(ps))
            .map(|ps| Cut { ps, step: true, dir: false })
            .collect();
        assert!(clear.len() > 30, "{}", clear.len());
        let mut whole = Checker::new(setup.clone());
        whole.changes(&train).unwrap();
        let whole = whole.finish();
        assert_eq!(whole.passed, faults == 0);
        let (found, appended, parts) = in_parts(&machine, &setup, &train, &clear);
        assert_eq!(found, whole);
        assert_eq!((appended, parts), (clear.len() + 1, clear.len() + 1), "known {known}");
    }
}

/// A part that begins with the wrong crossing, with a wrong level, or elsewhere is not appended.
#[test]
fn parts_that_do_not_follow_are_refused() {
    let machine = Machine::there_and_back(1);
    let setup = setup(&machine, true, false);
    let train = machine.train();
    let is_high = |place: &usize| train[place - 1].pin == Pin::Step && train[place - 1].level;
    let place = (train.len() / 2..).find(is_high).unwrap();
    // The crossing is at most a phase after the pulse.
    let ps = train[place - 1].ps + 100_000;
    let part = |from: usize, levels: (bool, Option<bool>)| {
        let mut checker = Checker::new(setup.clone());
        checker.begin_at(ps, Some(ORIGIN_PS), &[levels]);
        checker.changes(&train[from..]).unwrap();
        checker.into_part()
    };
    let [step, dir] = levels(&train[..place], 1)[0];
    let good = part(place, (step, Some(dir)));
    let begun = |until: usize| {
        let mut checker = Checker::new(setup.clone());
        checker.changes(&train[..until]).unwrap();
        checker
    };
    assert!(begun(place).append(&good));
    assert!(begun(place).append(&part(place, (step, None))));
    assert!(!begun(place).append(&part(place, (!step, None))), "STEP");
    assert!(!begun(place).append(&part(place, (step, Some(!dir)))), "DIR");
    assert!(step, "the part begins while STEP is high");
    // Two pulses are missing.
    assert!(!begun(place - 4).append(&good), "another crossing");
    // A pulse too many is the first of the part.
    let mut train = train.clone();
    let mut extra = train[place - 1];
    extra.ps += 2 * HIGH_PS;
    let fall = PinChange { ps: extra.ps + HIGH_PS, level: false, ..extra };
    train.extend([extra, fall]);
    train.sort_by_key(|change| change.ps);
    let mut checker = Checker::new(setup.clone());
    checker.begin_at(extra.ps, Some(ORIGIN_PS), &[(false, Some(dir))]);
    checker.changes(&train[place + 1..]).unwrap();
    assert_eq!(train[place + 1], extra);
    assert!(!begun(place + 1).append(&checker.into_part()), "a pulse too many");
    let mut other = Checker::new(setup.clone());
    other.begin_at(ps, Some(ORIGIN_PS + 1), &[(step, None)]);
    other.changes(&train[place..]).unwrap();
    assert!(!begun(place).append(&other.into_part()), "another origin");
}
