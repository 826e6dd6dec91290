//! Rung 1: the integers of a plan land exactly, keep the limits, and put every edge where the float
//! profile says, within the bound of the accuracy contract.
//!
//! Edges are read off the segments here by arithmetic of its own: sums in i128, and the edge phase bit
//! by bit as the arithmetic contract defines it.

#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_plan::{Plan, PlanError, plan};
use carrystep_profile::Profile;
use carrystep_spec::{BigDecimal, MoveFile, ProfileKind, Segment, Source, StartPhase};
use proptest::prelude::*;

const STEP: i128 = 1 << 64;
const CLOCK_HZ: u64 = 64_000_000;

fn file(text: &str) -> MoveFile {
    MoveFile::from_source(Source { path: "test.toml".into(), text: text.into() })
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
}

/// One rising edge: tick from 0 and phase.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Edge {
    tick: u64,
    phase: u32,
    backward: bool,
}

fn after(s: &Segment, n: i128) -> i128 {
    let (v, a, j) = (i128::from(s.v), i128::from(s.a), i128::from(s.j));
    n * v + n * (n - 1) / 2 * a + if j == 0 { 0 } else { n * (n - 1) * (n - 2) / 6 * j }
}

/// V in tick `k`, from 0.
fn speed_in(s: &Segment, k: i128) -> i128 {
    i128::from(s.v) + k * i128::from(s.a) + k * (k - 1) / 2 * i128::from(s.j)
}

/// The ticks in which V may be least or greatest: the ends, and where A changes sign.
fn extremes(s: &Segment) -> impl Iterator<Item = i128> {
    let last = i128::from(s.ticks) - 1;
    let turn = if s.j == 0 { 0 } else { -i128::from(s.a) / i128::from(s.j) };
    [0, last, turn - 1, turn, turn + 1, turn + 2].into_iter().filter(move |k| (0..=last).contains(k))
}

/// Every edge of a segment sequence that starts at `p`; speeds of one sign within a segment.
fn edges_of(segments: impl Iterator<Item = (u64, Segment)>, mut p: i128, bits: u32) -> (Vec<Edge>, i128) {
    let mut edges = Vec::new();
    for (first, s) in segments {
        let n = i128::from(s.ticks);
        let end = p + after(&s, n);
        let (from, to) = (p.div_euclid(STEP), end.div_euclid(STEP));
        for step in 0..(to - from).abs() {
            let backward = to < from;
            // The step is taken in the first tick that ends beyond this mark.
            let beyond = |n: i128| {
                let level = (p + after(&s, n)).div_euclid(STEP);
                if backward { level <= from - 1 - step } else { level >= from + 1 + step }
            };
            let (mut low, mut high) = (1, n);
            while low < high {
                let middle = (low + high) / 2;
                if beyond(middle) { high = middle } else { low = middle + 1 }
            }
            let old = p + after(&s, low - 1);
            let v = speed_in(&s, low - 1);
            let phase = bisect((old >> 32) as u32, (v >> 32) as i32, bits);
            edges.push(Edge { tick: first + (low as u64 - 1), phase, backward });
        }
        p = end;
    }
    (edges, p)
}

/// Design section 1, "edge phase", in 32-bit registers.
fn bisect(mut p: u32, v: i32, bits: u32) -> u32 {
    let mut q = 0;
    for k in 1..=bits {
        let (t, carry) = p.overflowing_add((v >> k) as u32);
        let crosses = if v < 0 { !carry } else { carry };
        if !crosses {
            p = t;
            q += 1 << (bits - k);
        }
    }
    q
}

/// Everything that rung 1 claims about one plan. `slack` is what edges may be off beyond the theory, s.
fn verify(file: &MoveFile, plan: &Plan, slack: Option<f64>) {
    let timebase = file.machine.timebase;
    let timelines = plan.timelines();
    for (index, axis) in file.machine.axes.iter().enumerate() {
        lands(file, plan, index);
        limits_hold(plan, index, axis, timebase.tick_ns(), slack.is_some());
        let start = i128::from(file.machine.phase.start_value());
        let (edges, _) = edges_of(plan.axis_segments(index), start, timebase.phase_bits());
        let crossings: Vec<_> = timelines[index].crossings(file.machine.phase).collect();
        assert_eq!(edges.len(), crossings.len(), "{}: pulses", axis.name);
        pins_are_free(plan, index, &edges);
        let Some(slack) = slack else { continue };
        let h = timebase.tick_seconds();
        for (k, (edge, due)) in edges.iter().zip(&crossings).enumerate() {
            assert_eq!(edge.backward, due.backward);
            let ticks = (edge.tick - due.start_tick) as f64 + f64::from(edge.phase) / f64::from(timebase.phases());
            let error = ticks * h - due.seconds;
            let leg = timelines[index].legs.iter().rfind(|leg| leg.start_tick <= edge.tick).unwrap();
            let a = steepest(&*leg.profile, due.seconds - h, due.seconds + h);
            // At phase zero the last pulse is due at rest; it cannot be later than its tick.
            let v = due.speed.max(h * a / 8.0);
            let within = h * h * a / (8.0 * v) + slack * (1.0 / v).max(1.0) + leg.fit_seconds;
            let phase = h / f64::from(timebase.phases());
            assert!(
                -phase - within <= error && error <= within,
                "{} pulse {k}: error {error:e} s, allowed -{phase:e} +- {within:e}, due {due:?}, {:?}",
                axis.name,
                leg.profile
            );
        }
    }
}

/// Greatest acceleration between two times: where formulas change inside a tick, all of them count.
fn steepest(profile: &dyn Profile<f64>, from: f64, to: f64) -> f64 {
    let mut left = 0.0;
    let mut steepest = 0.0_f64;
    for &right in profile.breakpoints().iter().chain([&profile.duration()]) {
        if left <= to && right >= from && left < right {
            steepest = steepest.max(profile.acceleration((left + right) / 2.0).abs());
        }
        left = right;
    }
    steepest
}

/// Exactly N steps, P as before, the same ticks on every axis, `last` on the last segment alone.
fn lands(file: &MoveFile, plan: &Plan, axis: usize) {
    let mut end = 0;
    for (moved, planned) in file.moves.iter().zip(&plan.moves) {
        let segments = &planned.axes[axis].segments;
        let travelled: i128 = segments.iter().map(|s| after(s, s.ticks.into())).sum();
        assert_eq!(travelled, i128::from(moved.steps[axis]) * STEP, "lands exactly");
        let ticks: u64 = segments.iter().map(|s| u64::from(s.ticks)).sum();
        assert_eq!(ticks, planned.rest_ticks + planned.ticks, "axes stay together");
        assert_eq!(planned.start_tick - planned.rest_ticks, end, "back to back");
        end += ticks;
        let marks: Vec<usize> = (0..segments.len()).filter(|&i| segments[i].last).collect();
        assert_eq!(marks, [segments.len() - 1]);
        if let Some(time) = &moved.time {
            let ns = time * BigDecimal::from(1_000_000_000_u64);
            let tick = BigDecimal::from(file.machine.timebase.tick_ns());
            let most = &tick * BigDecimal::from(planned.ticks);
            assert!(ns <= most && ns > most - tick, "ceil(T / h)");
        }
    }
    assert_eq!(plan.total_ticks(), end);
}

/// Limits, from V, A and J at the ends and extremes of each segment, in exact decimals.
fn limits_hold(plan: &Plan, index: usize, axis: &carrystep_spec::Axis, tick_ns: u64, f64_used: bool) {
    let one = BigDecimal::from(STEP);
    let tick = BigDecimal::new(tick_ns.into(), 9);
    let speed = &axis.speed_limit * &one * &tick;
    let relative = if f64_used { BigDecimal::new(1.into(), 9) } else { BigDecimal::new(1.into(), 5) };
    let tolerance = &speed * relative + BigDecimal::from(1);
    let acceleration = &axis.accel_limit * &one * &tick * &tick;
    for planned in &plan.moves {
        let moved = &planned.axes[index];
        let mut rest = planned.rest_ticks;
        let mut first = true;
        for s in &moved.segments {
            if rest > 0 {
                rest -= u64::from(s.ticks);
                continue;
            }
            for v in extremes(s).map(|k| speed_in(s, k)) {
                assert!(v * i128::from(moved.steps.signum()) >= 0, "the speed never changes sign: {s:?}");
                assert!(&speed + &tolerance >= v.abs(), "speed: {s:?}");
                assert!(v.unsigned_abs() as u64 <= moved.peaks.speed, "peaks");
            }
            let j = i128::from(s.j);
            for a in [0, i128::from(s.ticks) - 1].map(|k| (i128::from(s.a) + k * j).abs()) {
                assert!(a == 0 || acceleration >= a - 1, "acceleration: {s:?}");
            }
            if let Some(jerk) = &axis.jerk_limit {
                assert!(jerk * &one * &tick * &tick * &tick >= j.abs() - 1, "jerk: {s:?}");
            }
            if std::mem::take(&mut first) {
                // 6 v = 6 V - 3 A + 2 J; a first tick of its own may contain the ramp.
                let sign = i128::from(moved.steps.signum());
                let slope = if s.ticks == 1 { acceleration.clone() } else { BigDecimal::from(sign * i128::from(s.a)) };
                let sixfold = BigDecimal::from(sign * (6 * i128::from(s.v) + 2 * j)) - slope * BigDecimal::from(3);
                // A logistic curve is never at rest: without a start speed, its own jump counts.
                let own = BigDecimal::try_from(moved.profile.speed(0.0)).unwrap();
                let logistic = moved.shape == "logistic" && axis.start_speed == 0;
                let start = if logistic { &own } else { &axis.start_speed } * &one * &tick;
                assert!(sixfold <= (start + &tolerance) * BigDecimal::from(6), "start speed: {s:?}");
            }
        }
    }
}

/// No edge waits for width, gap, set-up or hold (docs/clock-by-clock.md, "Latency").
fn pins_are_free(plan: &Plan, axis: usize, edges: &[Edge]) {
    let (timebase, pins) = (plan.build.timebase, plan.build.pins[axis]);
    let clocks = i128::from(timebase.clocks_per_tick());
    let clock = |edge: &Edge| i128::from(edge.tick) * clocks + i128::from(edge.phase * timebase.clocks_per_phase());
    let [width, gap, setup, hold] = [pins.width, pins.gap, pins.setup, pins.hold].map(i128::from);
    let mut signs = plan.axis_segments(axis).filter_map(|(first, s)| {
        let begins = [s.v, s.a, s.j].iter().position(|&r| r != 0)? as u32;
        let sign = [s.v, s.a, s.j][begins as usize];
        (begins < s.ticks).then_some((i128::from(first + u64::from(begins)) * clocks, sign < 0))
    });
    let mut next = signs.next();
    let (mut dir, mut turned, mut last): (bool, i128, Option<i128>) =
        (false, -i128::from(timebase.latency_clocks()) - clocks, None);
    for edge in edges {
        let now = clock(edge);
        while let Some((at, backward)) = next.filter(|&(at, _)| at <= now) {
            if backward != dir {
                dir = backward;
                turned = last.map_or(at, |last| at.max(last + hold));
            }
            next = signs.next();
        }
        assert_eq!(dir, edge.backward, "DIR at {edge:?}");
        assert!(now >= turned + setup, "set-up before {edge:?}: {turned} {setup}");
        assert!(last.is_none_or(|last| now >= last + width + gap), "width and gap before {edge:?}: {last:?}");
        last = Some(now);
    }
}

#[derive(Debug, Clone)]
struct AxisCase {
    speed: f64,
    start: f64,
    accel: f64,
    /// The jerk limit is this many times the acceleration limit, 1/s.
    jerk: f64,
    per_unit: f64,
    pins: [u64; 4],
}

#[derive(Debug, Clone)]
struct Case {
    tick_ns: u64,
    phases: u32,
    zero: bool,
    axes: Vec<AxisCase>,
    moves: Vec<MoveCase>,
}

#[derive(Debug, Clone)]
struct MoveCase {
    profile: ProfileKind,
    /// About so many, for each axis.
    steps: Vec<i32>,
    /// How much more than the least time, if any.
    stretch: Option<f64>,
    /// Tolerance of a fit.
    fit_ns: Option<u64>,
}

impl Case {
    fn text(&self, times: &[Option<String>]) -> String {
        use std::fmt::Write as _;
        let phase = if self.zero { "zero" } else { "half" };
        let mut text = format!(
            "[machine]\nclock_hz = {CLOCK_HZ}\ntick_ns = {}\nphases = {}\nphase = \"{phase}\"\n",
            self.tick_ns, self.phases
        );
        for (i, axis) in self.axes.iter().enumerate() {
            let [step, gap, setup, hold] = axis.pins;
            // Fastest that tick, phase, width and gap allow; the units make it fractional.
            let clocks = |ns: u64| ((ns * CLOCK_HZ).div_ceil(1_000_000_000)).max(1) as f64;
            let phase = (self.tick_ns * CLOCK_HZ / 1_000_000_000) as f64 / f64::from(self.phases);
            let period = (clocks(step) + clocks(gap) + phase) / CLOCK_HZ as f64;
            let most = (1.0 / period).min(0.4999e9 / self.tick_ns as f64);
            let speed = axis.speed.min(most * 0.999999);
            let accel = axis.accel.min(0.49e18 / (self.tick_ns * self.tick_ns) as f64);
            let u = axis.per_unit;
            write!(
                text,
                "[[machine.axis]]\nname = \"a{i}\"\nsteps_per_unit = {u:?}\nspeed_limit = {:?}\nstart_speed = {:?}\n\
                 accel_limit = {:?}\njerk_limit = {:?}\nstep_ns = {step}\ngap_ns = {gap}\nsetup_ns = {setup}\n\
                 hold_ns = {hold}\n",
                speed / u,
                speed * axis.start / u * 0.9999999,
                accel / u,
                accel / u * axis.jerk
            )
            .unwrap();
        }
        let constant = self.axes.iter().all(|axis| axis.start > 0.0);
        for (i, MoveCase { profile, steps, fit_ns, .. }) in self.moves.iter().enumerate() {
            let profile = if *profile == ProfileKind::Constant && !constant { ProfileKind::Ranade } else { *profile };
            let to: Vec<String> = (steps.iter().zip(&self.axes).enumerate())
                .map(|(i, (&n, axis))| format!("a{i} = {:?}", f64::from(n) / axis.per_unit))
                .collect();
            let time = times.get(i).cloned().flatten().map_or(String::new(), |t| format!("time = {t}\n"));
            let fit = fit_ns.map_or(String::new(), |ns| format!("fit_ns = {ns}\n"));
            write!(text, "[[move]]\nprofile = \"{profile}\"\n{time}{fit}to = {{ {} }}\n", to.join(", ")).unwrap();
        }
        text
    }

    /// The file with no times, and the same with the stretched ones.
    fn files(&self) -> Vec<MoveFile> {
        let fast = file(&self.text(&[]));
        let planned = plan::<f64>(&fast).unwrap_or_else(|error| panic!("{error}\n{}", self.text(&[])));
        let times: Vec<Option<String>> = (self.moves.iter().zip(&planned.moves))
            .map(|(MoveCase { stretch, .. }, planned)| {
                // A file gives 10^6 s at most.
                if planned.seconds > 0.9e6 {
                    return None;
                }
                let ns = (planned.seconds * 1e9 * (*stretch)?).min(1e15);
                let ticks = (ns / self.tick_ns as f64).ceil() * self.tick_ns as f64;
                Some(if self.zero { format!("{:.9}", ticks / 1e9) } else { format!("{:.12}", ns / 1e9) })
            })
            .collect();
        vec![fast, file(&self.text(&times))]
    }
}

fn decades(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

fn axis() -> impl Strategy<Value = AxisCase> {
    let start = prop_oneof![2 => Just(0.0), 2 => 0.001..0.9, 1 => Just(1.0)];
    let pins = [1_u64..3000, 1_u64..3000, 1_u64..40_000, 1_u64..40_000];
    let unit = prop_oneof![Just(1.0), Just(80.0), decades(0.01, 1000.0)];
    (decades(1.0, 1e6), start, decades(1.0, 1e8), decades(0.1, 1e5), unit, pins)
        .prop_map(|(speed, start, accel, jerk, per_unit, pins)| AxisCase { speed, start, accel, jerk, per_unit, pins })
}

/// Moves of these kinds, for machines of one to three axes.
fn case(kinds: &'static [ProfileKind]) -> impl Strategy<Value = Case> {
    let tick = prop_oneof![Just(500_u64), Just(1000), Just(2000), Just(10_000)];
    let phases = prop_oneof![Just(1_u32), Just(4), Just(16)];
    (tick, phases, any::<bool>(), proptest::collection::vec(axis(), 1..4)).prop_flat_map(
        move |(tick_ns, phases, zero, axes)| {
            let steps = prop_oneof![1 => Just(0), 2 => -3..4, 3 => -40..40, 3 => -3000..3000];
            let steps = proptest::collection::vec(steps, axes.len());
            let stretch = proptest::option::of(prop_oneof![Just(1.0000001), 1.0001..1.5, 1.0001..20.0]);
            let fit_ns = proptest::option::of(decades(1.0, 1e5).prop_map(|ns| ns as u64));
            let moved = (prop::sample::select(kinds), steps, stretch, fit_ns)
                .prop_map(|(profile, steps, stretch, fit_ns)| MoveCase { profile, steps, stretch, fit_ns });
            let moves = proptest::collection::vec(moved, 1..5);
            moves.prop_map(move |moves| Case { tick_ns, phases, zero, axes: axes.clone(), moves })
        },
    )
}

/// The profiles whose segments are straight in A, and those that need a J.
const LINEAR: [ProfileKind; 3] = [ProfileKind::Ranade, ProfileKind::Trapezoid, ProfileKind::Constant];

fn verified(case: &Case) {
    for file in case.files() {
        let plan = plan::<f64>(&file).unwrap_or_else(|error| panic!("{error}"));
        verify(&file, &plan, Some(2e-9));
    }
}

#[test]
fn every_profile_free_and_straight() {
    let (file, plan) = carrystep_tests::moves::shipped("curves");
    verify(&file, &plan, Some(2e-9));
    for kind in ProfileKind::ALL {
        assert!(file.moves.iter().any(|moved| moved.profile == kind), "{kind}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 600, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn linear_plans_land_keep_their_limits_and_their_edges(case in case(&LINEAR)) {
        verified(&case);
    }

    #[test]
    fn scurves_land_keep_their_limits_and_their_edges(case in case(&[ProfileKind::Scurve])) {
        verified(&case);
    }

    #[test]
    fn sines_land_keep_their_limits_and_their_edges(case in case(&[ProfileKind::Sine])) {
        verified(&case);
    }

    #[test]
    fn logistics_land_keep_their_limits_and_their_edges(case in case(&[ProfileKind::Logistic])) {
        verified(&case);
    }

    #[test]
    fn mixed_moves_land_keep_their_limits_and_their_edges(case in case(&ProfileKind::ALL)) {
        verified(&case);
    }

    #[test]
    fn f32_lands_exactly_too(case in case(&ProfileKind::ALL)) {
        for file in case.files() {
            match plan::<f32>(&file) {
                Ok(plan) => verify(&file, &plan, None),
                // A time that is just enough may round to one that is not.
                Err(PlanError::Refused { .. }) => {}
                Err(error) => {
                    // Times that f32 cannot tell apart: then no plan is given, never a wrong one.
                    let long = plan::<f64>(&file).unwrap().moves[error.move_index().unwrap()].ticks > 1 << 24;
                    assert!(long && matches!(error, PlanError::Broken { .. }), "{error}");
                }
            }
        }
    }
}

/// A machine of one axis, x, at 1 us ticks.
fn machine(start: &str, speed: &str, accel: &str, phase: &str) -> String {
    format!("[machine]\nphase = \"{phase}\"\n") + &axis_table("x", start, speed, accel)
}

fn axis_table(name: &str, start: &str, speed: &str, accel: &str) -> String {
    format!(
        "[[machine.axis]]\nname = \"{name}\"\nsteps_per_unit = 1.0\nstart_speed = {start}\nspeed_limit = {speed}\n\
         accel_limit = {accel}\nstep_ns = 100\ngap_ns = 100\nsetup_ns = 200\nhold_ns = 200\n"
    )
}

fn moving(profile: &str, time: Option<&str>, steps: i64) -> String {
    let time = time.map_or(String::new(), |t| format!("time = {t}\n"));
    format!("[[move]]\nprofile = \"{profile}\"\n{time}to = {{ x = {steps} }}\n")
}

fn planned(text: &str) -> (MoveFile, Plan) {
    let file = file(text);
    let plan = plan::<f64>(&file).unwrap_or_else(|error| panic!("{error}"));
    verify(&file, &plan, Some(2e-9));
    (file, plan)
}

#[test]
fn an_hour_long_triangle_stays_within_nanoseconds() {
    let text = machine("0.0", "1000.0", "1000.0", "half") + &moving("ranade", Some("3600.0"), 1_000_000);
    let (_, plan) = planned(&text);
    let segments = plan.moves[0].axes[0].segments.len();
    println!("{segments} segments");
    assert!((300..3000).contains(&segments), "{segments}");
}

#[test]
fn one_step_either_way() {
    for phase in ["half", "zero"] {
        for profile in ["ranade", "trapezoid"] {
            let text =
                machine("0.0", "5000.0", "25000.0", phase) + &moving(profile, None, 1) + &moving(profile, None, -1);
            planned(&text);
        }
    }
}

#[test]
fn the_articles_failing_case_lands() {
    let text = machine("100.0", "20000.0", "25000.0", "half") + &moving("ranade", Some("2.0"), 6000);
    let (file, plan) = planned(&text);
    assert_eq!(plan.moves[0].axes[0].shape, "triangle");
    assert_eq!(plan.moves[0].axes[0].segments.iter().map(|s| s.ticks).sum::<u32>(), 2_000_000);
    let (edges, p) = edges_of(plan.axis_segments(0), 1 << 63, 4);
    assert_eq!((edges.len(), p), (6000, (1 << 63) + 6000 * STEP));
    let last = edges.windows(2).map(|e| e[1].tick - e[0].tick).next_back().unwrap();
    assert!(last > 5000, "the last pulses come as slowly as the first: {last} ticks, not one");
    drop(file);
}

#[test]
fn table_1_of_the_article() {
    let golden: serde_json::Value = serde_json::from_str(include_str!("golden/ranade.json")).unwrap();
    let expected: Vec<u64> = serde_json::from_value(golden["table1"]["pulses_article"].clone()).unwrap();
    // 0.2 steps per tick of 1 us: 5 steps in 25 us.
    let text = machine("200000.0", "200000.0", "1.0e9", "zero") + &moving("constant", Some("25.0e-6"), 5);
    let (_, plan) = planned(&text);
    let (edges, _) = edges_of(plan.axis_segments(0), 0, 4);
    let ticks: Vec<u64> = edges.iter().map(|edge| edge.tick + 1).collect();
    assert_eq!(ticks, expected);
}

#[test]
fn phase_zero_wants_whole_ticks() {
    let text = machine("0.0", "5000.0", "25000.0", "zero") + &moving("ranade", Some("0.5000005"), 100);
    let error = plan::<f64>(&file(&text)).unwrap_err();
    assert!(matches!(error, PlanError::NotWholeTicks { .. }));
    assert!(error.to_string().contains("0.500001 s"), "{error}");
}

#[test]
fn refusals_say_what_would_do_and_it_does() {
    fn text(profile: &str, start: &str, time: Option<&str>) -> String {
        machine(start, "5000.0", "25000.0", "half") + &moving(profile, time, 1000)
    }
    for (profile, start, time, limit) in [
        ("ranade", "1000.0", "0.32", "accel_limit"),
        ("ranade", "1000.0", "0.1", "speed_limit"),
        ("trapezoid", "1000.0", "0.39", "accel_limit"),
        ("trapezoid", "0.0", "0.2", "accel_limit"),
        ("constant", "1000.0", "0.999", "start_speed"),
    ] {
        let error = plan::<f64>(&file(&text(profile, start, Some(time)))).unwrap_err();
        let PlanError::Refused { least_time: Some(least), refusal, .. } = &error else { panic!("{error}") };
        assert_eq!(refusal.limit.to_string(), limit, "{error}");
        println!("{error}");
        planned(&text(profile, start, Some(&format!("{least:?}"))));
        let less = format!("{:.9}", least - 2e-6);
        assert!(plan::<f64>(&file(&text(profile, start, Some(&less)))).is_err());
    }
    let error = plan::<f64>(&file(&text("constant", "0.0", None))).unwrap_err();
    assert!(matches!(error, PlanError::Refused { least_time: None, .. }));
    assert!(error.to_string().starts_with("move 1, axis x: needs a start_speed over 0"), "{error}");
}

#[test]
fn reversals_rest_only_where_pins_need_it() {
    let slow = machine("0.0", "5000.0", "25000.0", "half");
    let back_and_forth = moving("ranade", None, 10) + &moving("ranade", None, -10) + &moving("ranade", None, 10);
    let (_, plan) = planned(&(slow + &back_and_forth));
    assert!(plan.moves.iter().all(|m| m.rest_ticks == 0), "milliseconds from rest are set-up enough");

    for phase in ["half", "zero"] {
        let abrupt = machine("200000.0", "200000.0", "1.0e9", phase).replace("setup_ns = 200\n", "setup_ns = 20000\n");
        let moves = ["constant", "constant", "constant", "constant"].iter().zip([-5, 5, 5, -5]);
        let moves: String = moves.map(|(profile, steps)| moving(profile, None, steps)).collect();
        let (_, plan) = planned(&(abrupt + &moves));
        let rests: Vec<u64> = plan.moves.iter().map(|m| m.rest_ticks).collect();
        assert!(rests[0] > 15 && rests[1] > 15 && rests[2] == 0 && rests[3] > 15, "{phase}: {rests:?}");
    }
}

#[test]
fn programs_are_in_the_order_of_need() {
    use carrystep_spec::Command;
    let moves =
        "[[move]]\nprofile = \"ranade\"\nto = { x = 300, y = -7 }\n[[move]]\nprofile = \"ranade\"\nto = { y = 30 }\n";
    let text = machine("0.0", "5000.0", "25000.0", "half") + &axis_table("y", "10.0", "700.0", "900.0") + moves;
    let file = file(&text);
    let plan = plan::<f64>(&file).unwrap();
    verify(&file, &plan, Some(2e-9));
    let (mut ticks, mut starts) = ([0_u64; 2], 0);
    let mut reached = 0;
    for command in plan.program() {
        match command {
            Command::Segment { axis, segment } => {
                let need = &mut ticks[usize::from(axis)];
                assert!(*need >= reached, "sent after it is needed");
                reached = *need;
                *need += u64::from(segment.ticks);
            }
            Command::Start { mask } => {
                starts += 1;
                assert_eq!(mask, 0b11);
                assert!(ticks.iter().all(|&t| t > reached), "all masked axes have a segment");
            }
            Command::Wait { .. } | Command::Clear => panic!("{command:?}"),
        }
    }
    assert_eq!((starts, ticks), (2, [plan.total_ticks(); 2]));
}

#[test]
fn planning_six_axes_is_quick() {
    let mut text = machine("0.0", "5000.0", "25000.0", "half");
    for name in ["y", "z", "a", "b", "c"] {
        text += &format!(
            "[[machine.axis]]\nname = \"{name}\"\nsteps_per_unit = 80.0\nspeed_limit = 300.0\naccel_limit = 3000.0\ndriver = \"a4988\"\n"
        );
    }
    text += "[[move]]\nprofile = \"ranade\"\nto = { x = 10000, y = 100, z = 20, a = 30, b = -50, c = 70 }\n";
    let file = file(&text);
    let began = std::time::Instant::now();
    for _ in 0..1000 {
        assert!(plan::<f64>(&file).is_ok());
    }
    let each = began.elapsed() / 1000;
    println!("{each:?} each");
    assert!(each.as_micros() < 1000, "{each:?}");
    assert_eq!(file.machine.phase, StartPhase::Half);
}
