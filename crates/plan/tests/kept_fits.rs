//! Tests moves whose ramps are scaled from kept fits: every edge is as close to the profile as the
//! tolerance says, and a plan does not depend on what was planned before, or in which process.

use carrystep_core::Segment;
use carrystep_files::{MoveFile, SourceText};
use carrystep_plan::{PlannedAxis, plan};
use proptest::prelude::*;
use proptest::sample::select;
use std::fmt::Write as _;
use std::hash::{DefaultHasher, Hash as _, Hasher as _};
use std::process::Command;

/// A move of one axis in ticks of 1 us.
#[derive(Debug, Clone)]
struct Case {
    profile: &'static str,
    phase: &'static str,
    /// Speed limit in steps/s, and acceleration limit in steps/s^2.
    speed: f64,
    acceleration: f64,
    start_speed: f64,
    steps: i64,
    fit_ns: u32,
}

impl Case {
    fn file(&self) -> MoveFile {
        let Self { profile, phase, speed, acceleration, start_speed, steps, fit_ns } = self;
        let mut text = format!("[machine]\nphase = \"{phase}\"\n[[machine.axis]]\nname = \"x\"\n");
        write!(
            text,
            "steps_per_unit = 1\nspeed_limit = {speed}\naccel_limit = {acceleration}\n\
             start_speed = {start_speed}\nstep_high_ns = 100\nstep_low_ns = 100\n\
             dir_setup_ns = 100\ndir_hold_ns = 100\n\
             [[move]]\nprofile = \"{profile}\"\nfit_ns = {fit_ns}\nto = {{ x = {steps} }}\n"
        )
        .unwrap();
        MoveFile::from_source(SourceText { path: "kept.toml".into(), text: text.into() }).unwrap()
    }

    /// The only axis of the move, and the ticks of rest before its motion, in which DIR turns.
    fn planned(&self) -> (PlannedAxis, u64) {
        let mut planned = plan::<f64>(&self.file()).unwrap().moves.remove(0);
        (planned.axes.remove(0), planned.rest_ticks)
    }
}

/// Moves with more than a few steps, from slow to fast axes.
fn cases() -> impl Strategy<Value = Case> {
    let decades = |low: f64, high: f64| (low.log10()..high.log10()).prop_map(|x| 10_f64.powf(x));
    (
        select(vec!["logistic", "sine"]),
        select(vec!["half", "zero"]),
        decades(1e3, 4e5),
        decades(3e-3, 0.3),
        prop_oneof![Just(0.0), decades(1.0, 1e4)],
        decades(100.0, 30_000.0),
        decades(1.0, 5000.0),
        any::<bool>(),
    )
        .prop_map(|(profile, phase, speed, ramp, start_speed, steps, fit_ns, backward)| Case {
            profile,
            phase,
            speed: speed.round(),
            acceleration: (speed / ramp).round(),
            start_speed: start_speed.round().min(speed.round()),
            steps: if backward { -(steps as i64) } else { steps as i64 },
            fit_ns: fit_ns as u32,
        })
}

/// By how many seconds the worst edge is off, beyond what the chord of a tick explains. The first
/// and the last pulse of a move at phase zero may be at rest and have no time.
fn worst(case: &Case, (axis, rest): &(PlannedAxis, u64)) -> f64 {
    const ONE: i128 = 1 << 64;
    let backward = case.steps < 0;
    let pulses = case.steps.unsigned_abs();
    let due = |k: u64| match (case.phase, backward) {
        ("half", _) => i128::from(2 * k - 1) * (ONE / 2) + i128::from(backward),
        (_, false) => i128::from(k) * ONE,
        (_, true) => i128::from(k - 1) * ONE + 1,
    };
    let travel = |s: &Segment, n: u64| {
        let n = i128::from(n);
        let sum = n * i128::from(s.v)
            + n * (n - 1) / 2 * i128::from(s.a)
            + n * (n - 1) * (n - 2) / 6 * i128::from(s.j);
        if backward { -sum } else { sum }
    };
    let (mut at, mut tick, mut pulse, mut worst) = (0_i128, 0_u64, 1, 0.0_f64);
    for segment in &axis.segments {
        let ticks = u64::from(segment.ticks);
        let end = at + travel(segment, ticks);
        while pulse <= pulses && due(pulse) <= end {
            let (mut low, mut high) = (0, ticks);
            while high - low > 1 {
                let middle = low.midpoint(high);
                *(if at + travel(segment, middle) >= due(pulse) { &mut high } else { &mut low }) =
                    middle;
            }
            let [from, to] = [low, low + 1].map(|n| at + travel(segment, n));
            let part = (due(pulse) - from) as f64 / (to - from) as f64;
            let time = ((tick + low) as f64 - *rest as f64 + part) * 1e-6;
            let ideal = axis.profile.crossing(due(pulse) as f64 / ONE as f64);
            let chord =
                axis.profile.acceleration(ideal).abs() / axis.profile.speed(ideal) * 1e-12 / 8.0;
            if case.phase == "half" || (pulse > 1 && pulse < pulses) {
                worst = worst.max((time - ideal).abs() - chord);
            }
            pulse += 1;
        }
        (at, tick) = (end, tick + ticks);
    }
    assert_eq!(pulse, pulses + 1, "a pulse is missing");
    worst
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn every_edge_is_within_the_tolerance(case in cases()) {
        let worst = worst(&case, &case.planned());
        // Half a nanosecond is what exact segments may be off, too.
        let most = f64::from(case.fit_ns) * 1e-9 + 0.5e-9;
        prop_assert!(worst <= most, "{worst} s");
    }
}

/// Moves of ordinary sizes, each unlike the others.
fn many(count: i64) -> impl Iterator<Item = Case> {
    (0..count).map(|k| Case {
        profile: ["sine", "logistic"][usize::from(k % 2 == 1)],
        phase: "half",
        speed: 1e5,
        acceleration: 3e5,
        start_speed: 0.0,
        steps: 400 + 37 * k,
        fit_ns: 100 + 13 * u32::try_from(k).unwrap(),
    })
}

fn digest(cases: impl Iterator<Item = Case>) -> u64 {
    let mut hasher = DefaultHasher::new();
    for case in cases {
        for s in case.planned().0.segments {
            (s.ticks, s.v, s.a, s.j).hash(&mut hasher);
        }
    }
    hasher.finish()
}

#[test]
fn a_plan_does_not_depend_on_the_moves_planned_before() {
    let first: Vec<u64> = many(12).map(|case| digest([case].into_iter())).collect();
    // So many other moves also fill the store of fits and empty it again.
    let other = |k: i64| Case {
        profile: ["logistic", "sine"][usize::from(k % 2 == 1)],
        phase: "zero",
        speed: 2e5,
        acceleration: 1e5 + 1e3 * k as f64,
        start_speed: 0.0,
        steps: 3000 + 11 * k,
        fit_ns: 50 + 7 * u32::try_from(k).unwrap(),
    };
    digest((0..1200).map(other));
    let again: Vec<u64> = many(12).map(|case| digest([case].into_iter())).collect();
    assert_eq!(first, again);
    let mut backward: Vec<Case> = many(12).collect();
    backward.reverse();
    let reversed: Vec<u64> =
        backward.into_iter().map(|case| digest([case].into_iter())).rev().collect();
    assert_eq!(first, reversed);
}

/// Tells the test below, in a process of its own, to print its digest.
const CHILD: &str = "CARRYSTEP_DIGEST_OF_KEPT_FITS";

#[test]
fn a_plan_is_the_same_in_another_process() {
    let own = digest(many(40));
    if std::env::var_os(CHILD).is_some() {
        println!("digest {own:016x}");
        return;
    }
    let child = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "kept_fits::a_plan_is_the_same_in_another_process", "--nocapture"])
        .env(CHILD, "1")
        .output()
        .unwrap();
    let printed = String::from_utf8(child.stdout).unwrap();
    assert!(printed.contains(&format!("digest {own:016x}")), "{printed}");
}
