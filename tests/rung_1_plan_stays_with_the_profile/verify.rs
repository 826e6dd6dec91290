//! Conditions that every plan must fulfil, computed by independent arithmetic: sums in i128, and
//! the edge phase bit by bit as the arithmetic contract defines it.

use carrystep_core::Segment;
use carrystep_files::{BigDecimal, MoveFile};
use carrystep_plan::Plan;
use carrystep_profile::Profile;

pub const STEP: i128 = 1 << 64;

/// One rising edge: its tick from 0 and its phase.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Edge {
    pub tick: u64,
    pub phase: u32,
    pub backward: bool,
}

fn after(s: &Segment, n: i128) -> i128 {
    let (v, a, j) = (i128::from(s.v), i128::from(s.a), i128::from(s.j));
    n * v + n * (n - 1) / 2 * a + if j == 0 { 0 } else { n * (n - 1) * (n - 2) / 6 * j }
}

/// V in tick `k` (from 0), in 2^-64 step per tick.
fn speed_in(s: &Segment, k: i128) -> i128 {
    i128::from(s.v) + k * i128::from(s.a) + k * (k - 1) / 2 * i128::from(s.j)
}

/// The ticks in which V can be least or greatest: the first, the last, and those where A changes
/// its sign.
fn extremes(s: &Segment) -> impl Iterator<Item = i128> {
    let last = i128::from(s.ticks) - 1;
    let turn = if s.j == 0 { 0 } else { -i128::from(s.a) / i128::from(s.j) };
    [0, last, turn - 1, turn, turn + 1, turn + 2]
        .into_iter()
        .filter(move |k| (0..=last).contains(k))
}

/// Every edge of a sequence of segments that starts at `p`. The speed must have one sign within
/// each segment.
pub fn edges_of(
    segments: impl Iterator<Item = (u64, Segment)>,
    mut p: i128,
    bits: u32,
) -> (Vec<Edge>, i128) {
    let mut edges = Vec::new();
    for (first, s) in segments {
        let n = i128::from(s.ticks);
        let end = p + after(&s, n);
        let (from, to) = (p.div_euclid(STEP), end.div_euclid(STEP));
        for step in 0..(to - from).abs() {
            let backward = to < from;
            // A step occurs in the first tick that ends beyond this level.
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

/// The edge phase as section 1 of the design defines it, in 32-bit registers.
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

/// Checks every claim of rung 1 for one plan. `slack` is the deviation of edges beyond the theory
/// that is allowed, in seconds.
pub fn verify(file: &MoveFile, plan: &Plan, slack: Option<f64>) {
    let timebase = file.machine.timebase;
    let timelines = plan.timelines();
    for (index, axis) in file.machine.axes.iter().enumerate() {
        lands(file, plan, index);
        limits_hold(plan, index, axis, timebase.tick_ns(), slack.is_some());
        let start = i128::from(file.machine.phase.start_value());
        let (edges, _) = edges_of(plan.axis_segments(index), start, timebase.phase_bits());
        let legs: Vec<_> = timelines[index].legs().collect();
        let crossings: Vec<_> = timelines[index].crossings(file.machine.phase).collect();
        assert_eq!(edges.len(), crossings.len(), "{}: pulses", axis.name);
        pins_are_free(plan, index, &edges);
        let Some(slack) = slack else { continue };
        let h = timebase.tick_seconds();
        for (k, (edge, due)) in edges.iter().zip(&crossings).enumerate() {
            assert_eq!(edge.backward, due.backward);
            let ticks = (edge.tick - due.start_tick) as f64
                + f64::from(edge.phase) / f64::from(timebase.phases());
            let error = ticks * h - due.seconds;
            let leg = legs.iter().rfind(|leg| leg.start_tick <= edge.tick).unwrap();
            let a = steepest(&*leg.profile, due.seconds - h, due.seconds + h);
            // At phase zero the last pulse is due at rest; it cannot be later than its tick.
            let v = due.speed.max(h * a / 8.0);
            // Where a ramp is shorter than a tick, no acceleration is seen around it.
            let bent = if v > 0.0 { h * h * a / (8.0 * v) } else { h };
            let within = bent + leg.fit_seconds + slack;
            let phase = h / f64::from(timebase.phases());
            // The bisection loses up to five units of 2^-32 step, which take longer at lower
            // speeds.
            let late = (slack * (1.0 / v - 1.0).max(0.0)).min(phase);
            // Backward from phase zero the first pulse is due at rest; P borrows when one unit has
            // been travelled.
            let at_rest = due.backward && due.seconds == 0.0;
            let late = if at_rest { late + leg.profile.crossing(2_f64.powi(-64)) } else { late };
            assert!(
                -phase - within <= error && error <= within + late,
                "{} pulse {k}: error {error:e} s, allowed -{phase:e} - {within:e} to {:e}, due {due:?}, {:?}",
                axis.name,
                within + late,
                leg.profile
            );
        }
    }
}

/// The greatest acceleration between two times. If formulas change within a tick, all of them
/// count.
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

/// Checks that an axis makes exactly N steps, that P returns to its start value, that every axis
/// has the same ticks, and that only the last segment is marked `last`.
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

/// Checks the limits in exact decimals, from V, A and J at the ends and extremes of each segment.
fn limits_hold(
    plan: &Plan,
    index: usize,
    axis: &carrystep_files::Axis,
    tick_ns: u64,
    f64_used: bool,
) {
    let one = BigDecimal::from(STEP);
    let tick = BigDecimal::new(tick_ns.into(), 9);
    let speed = &axis.speed_limit.steps * &one * &tick;
    let relative =
        if f64_used { BigDecimal::new(1.into(), 9) } else { BigDecimal::new(1.into(), 5) };
    let tolerance = &speed * relative + BigDecimal::from(1);
    let acceleration = &axis.accel_limit.steps * &one * &tick * &tick;
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
                assert!(
                    v * i128::from(moved.steps.signum()) >= 0,
                    "the speed never changes sign: {s:?}"
                );
                assert!(&speed + &tolerance >= v.abs(), "speed: {s:?}");
                assert!(v.unsigned_abs() as u64 <= moved.peaks.speed, "peaks");
            }
            let j = i128::from(s.j);
            for a in [0, i128::from(s.ticks) - 1].map(|k| (i128::from(s.a) + k * j).abs()) {
                assert!(a == 0 || acceleration >= a - 1, "acceleration: {s:?}");
            }
            if let Some(jerk) = &axis.jerk_limit {
                assert!(&jerk.steps * &one * &tick * &tick * &tick >= j.abs() - 1, "jerk: {s:?}");
            }
            if std::mem::take(&mut first) {
                // 6 v = 6 V - 3 A + 2 J. A separate first tick may contain the ramp.
                let sign = i128::from(moved.steps.signum());
                let slope = if s.ticks == 1 {
                    acceleration.clone()
                } else {
                    BigDecimal::from(sign * i128::from(s.a))
                };
                let sixfold = BigDecimal::from(sign * (6 * i128::from(s.v) + 2 * j))
                    - slope * BigDecimal::from(3);
                // A logistic curve is never at rest: without a start speed, its own initial jump
                // counts.
                let own = BigDecimal::try_from(moved.profile.speed(0.0)).unwrap();
                let logistic = moved.shape == "logistic" && axis.start_speed.steps == 0;
                let start = if logistic { &own } else { &axis.start_speed.steps } * &one * &tick;
                assert!(
                    sixfold <= (start + &tolerance) * BigDecimal::from(6),
                    "start speed: {s:?}"
                );
            }
        }
    }
}

/// Checks that no edge waits for width, gap, set-up or hold (docs/clock-by-clock.md, "Latency").
fn pins_are_free(plan: &Plan, axis: usize, edges: &[Edge]) {
    let (timebase, pins) = (plan.build.timebase, plan.build.pins[axis]);
    let clocks = i128::from(timebase.clocks_per_tick());
    let clock = |edge: &Edge| {
        i128::from(edge.tick) * clocks + i128::from(edge.phase * timebase.clocks_per_phase())
    };
    let [step_high, step_low, dir_setup, dir_hold] =
        [pins.step_high, pins.step_low, pins.dir_setup, pins.dir_hold].map(i128::from);
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
                turned = last.map_or(at, |last| at.max(last + dir_hold));
            }
            next = signs.next();
        }
        assert_eq!(dir, edge.backward, "DIR at {edge:?}");
        assert!(now >= turned + dir_setup, "set-up before {edge:?}: {turned} {dir_setup}");
        assert!(
            last.is_none_or(|last| now >= last + step_high + step_low),
            "step_high and step_low before {edge:?}: {last:?}"
        );
        last = Some(now);
    }
}
