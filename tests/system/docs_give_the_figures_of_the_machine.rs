//! Figures of the documentation that follow from the shipped machine and its demo, and from other
//! texts on the pages.

use carrystep_core::AXES;
use carrystep_core::engine::TIME_SLOT_CLOCKS;
use carrystep_core::fixed::{FRACTION_BITS, ONE_STEP};
use carrystep_tests::moves;
use carrystep_tests::pages::{self, grouped, says, word};
use std::fmt::Display;

#[test]
fn readme_says_where_the_errors_of_its_table_lie() {
    let readme = pages::file("README.md");
    let (_, rest) =
        readme.split_once("axis     pulses  position  e min  e max").expect("the table of errors");
    let rows = rest.lines().skip(1).take_while(|line| line.ends_with("  ok"));
    let errors: Vec<[f64; 2]> = rows
        .map(|row| {
            let cells: Vec<&str> = row.split_whitespace().collect();
            [cells[3], cells[4]].map(|cell| cell.parse().expect("an error in ns"))
        })
        .collect();
    assert_eq!(errors.len(), AXES);
    let least = errors.iter().map(|[least, _]| *least).fold(0.0, f64::min);
    let most = errors.iter().map(|[_, most]| *most).fold(f64::NEG_INFINITY, f64::max);
    let time = moves::demo().build.timebase;
    let phase = time.tick_ns() as f64 / f64::from(time.phases());
    // The bisection loses a unit for P, one for V, and one for each halving of V except the first.
    let lost = f64::from(time.phase_bits() + 1) * 2_f64.powi(-32) * 1e9;
    says(
        "README.md",
        &[
            format!("Edges lie on a grid of {phase} ns"),
            format!("errors in this table lie between {least} and {most} ns"),
            format!("can be late by up to {lost:.1} ns / v"),
            format!("it is {:.0} ns at 0.1 steps/s", lost / 0.1),
        ],
    );
    assert_eq!((least, most), (-phase, 0.0), "a phase before the exact time, and not after it");
}

/// An exact decimal of a file as a float.
fn number(decimal: &impl Display) -> f64 {
    decimal.to_string().parse().expect("a number")
}

#[test]
fn flow_of_a_move_page_has_the_numbers_of_machine_and_guard() {
    let (file, plan) = moves::shipped("demo");
    let (axis, engine) = (&file.machine.axes[0], file.machine.engine());
    let unit = number(&axis.steps_per_unit);
    let (v, a) = (axis.start_speed.float, axis.accel_limit.float);
    let (start, speed) = (v / unit, axis.speed_limit.float / unit);
    let accel = grouped((a / unit) as u64);
    let time = plan.build.timebase;
    let moved = &plan.moves[0];
    let (pins, steps) = (axis.pins, moved.axes[0].steps);
    // The first segment ends where the remainder of the half is used up.
    let (middle, cut) = (moved.ticks as f64 / 2.0, moved.axes[0].segments[0].ticks);
    let middle = format!("{}{}", grouped(middle as u64), &format!("{:.1}", middle.fract())[1..]);
    // The least time of the axis alone: a triangle from the start speed at the greatest
    // acceleration.
    let alone = 2.0 * ((v * v + a * steps as f64).sqrt() - v) / a;
    let ms = (moved.ticks * time.tick_ns()) as f64 / 1e6;
    // The triangle that takes the whole ticks of the move.
    let seconds = ms / 1e3;
    let top = 2.0 * steps as f64 / seconds - v;
    let slope = grouped((2.0 * (top - v) / seconds).round() as u64);
    let (top, from) = (grouped(top.round() as u64), steps as f64 / unit);
    let segments = word(moved.axes[0].segments.len() as u64);
    let mhz = time.clock_hz() / 1_000_000;
    let (round, rounds) = (engine.guard.round, engine.guard.enable);
    let powered = round * rounds;
    says(
        "docs/flow-of-a-move.md",
        &[
            format!("x has {unit} steps per unit"),
            format!("start speed of {start} units/s, a speed limit of {speed} units/s"),
            format!("an acceleration limit of {accel} units/s^2"),
            format!("at {mhz} MHz with ticks of {} us.", time.tick_ns() / 1000),
            format!("asks for `to = {{ x = {from} }}`."),
            format!("the target is {from} x {unit} = {steps} steps and the axis begins at 0"),
            format!("so N = {steps}."),
            format!("It starts at v_s = {v} steps/s, rises to"),
            format!("The acceleration is 2 ({top} - {v}) / T = {slope} steps/s^2"),
            format!("A = a h^2 = {slope} x 10^-12 x 2^{FRACTION_BITS} ="),
            format!(
                "V = v_s h + A/2 = {} x 2^{FRACTION_BITS} + A/2 =",
                v * time.tick_ns() as f64 / 1e9
            ),
            format!("over all {segments} segments is exactly {steps} x 2^{FRACTION_BITS}."),
            format!("Alone, x would need {:.4} ms.", alone * 1e3),
            format!("just under the limit of {} steps/s^2.", grouped(a as u64)),
            format!("The middle of the move is at {middle} ticks"),
            format!("The cut after {cut} ticks distributes"),
            format!("in the first {cut} of these ticks"),
            format!("x has a time slot of {TIME_SLOT_CLOCKS} clocks on the one adder"),
            format!("T = {ms:.3} ms, {} ticks", moved.ticks),
            format!("has {segments} segments:"),
            format!("in rounds of {round} ticks"),
            format!("to {rounds} rounds, {powered} ticks."),
            format!("accepted at the end of tick {}.", powered + 1),
            format!("L = {} clocks", time.latency_clocks()),
            format!("for {} clocks ({} ns,", pins.step_high, axis.pins_ns.step_high),
        ],
    );
}

#[test]
fn flow_of_a_move_page_finds_the_first_step_as_addition_does() {
    const STEP: f64 = ONE_STEP as f64;
    let plan = moves::demo();
    let time = plan.build.timebase;
    let first = plan.moves[0].axes[0].segments[0];
    let (mut p, mut v, mut ticks) = (plan.build.phase.start_value(), first.v, 0_u64);
    let phase = loop {
        ticks += 1;
        assert!(ticks <= u64::from(first.ticks), "no step in the first segment");
        let (next, carry) = p.overflowing_add(v.unsigned_abs());
        if carry {
            let left = u128::from(p).abs_diff(ONE_STEP.unsigned_abs());
            break left * u128::from(time.phases()) / u128::from(v.unsigned_abs());
        }
        p = next;
        v += first.a;
    };
    let (whole, clocks, of_phase) = (ticks - 1, time.clocks_per_tick(), time.clocks_per_phase());
    let sum = format!("{whole} x {clocks} + {phase} x {of_phase} + {}", time.latency_clocks());
    let us = whole * time.tick_ns() / 1000;
    // The profile passes half a step at the constant acceleration of the first segment.
    let (v, a) = (first.v as f64 / STEP, first.a as f64 / STEP);
    let v = v - 0.5 * a;
    let due = ((v * v + a).sqrt() - v) / a * time.tick_ns() as f64;
    let early = due - (whole * time.tick_ns()) as f64;
    let of_phase_ns = time.tick_ns() as f64 / f64::from(time.phases());
    let on_the_pin =
        whole * u64::from(clocks) + u64::from(phase as u32 * of_phase) + time.latency_clocks();
    // The start is accepted in the tick after those in which the drivers have power, and the axes
    // begin at the end of the tick after that one.
    let guard = moves::shipped("demo").0.machine.engine().guard;
    let begins = u64::from(guard.round * guard.enable + 2) * u64::from(clocks);
    let ps = grouped(time.clock_to_ps(begins + on_the_pin));
    says(
        "docs/flow-of-a-move.md",
        &[
            format!("The profile passes this step at {:.3} us, so", due / 1e3),
            format!("the measured time is m_1 = {:.3} us", (due - early) / 1e3),
            format!("the error e_1 = {:.1} ns", -early),
            format!("the time of the profile t_1 = {:.3} us", due / 1e3),
            format!("the edge is {early:.0} ns early, less than one phase of {of_phase_ns} ns."),
            format!("{clocks} + {sum} = {}.", grouped(u64::from(clocks) + on_the_pin)),
            format!("So the edge of tick {ticks} with q = {phase} is on the pin in cycle"),
            format!(
                "{} + {sum} = {} which is {ps} ps after configuration.",
                grouped(begins),
                grouped(begins + on_the_pin)
            ),
            format!("`STEP` rises at {ps} ps."),
            format!("In tick {ticks} after the start the sum P + V carries"),
            format!("So q = {phase}:"),
            format!("{us} us after the start."),
            sum,
        ],
    );
}

#[test]
fn machine_file_page_gives_the_times_of_a_default_guard() {
    let (engine, _) = moves::on_the_engine("demo");
    let figures = engine.guard_figures();
    let watchdog = figures.watchdog_ms.expect("a watchdog");
    let debounce = figures.debounce_us.expect("limits");
    let (round, tick_ns) = (u64::from(engine.guard.round), engine.timebase.tick_ns());
    let in_ticks = watchdog.least * 1e6 / tick_ns as f64;
    let (fits, shorter) = (in_ticks / round as f64, in_ticks / (round / 2) as f64);
    // A step in the time between two samples and two ticks.
    let us = (round + 2) * tick_ns / 1000;
    says(
        "docs/machine-files.md",
        &[
            format!("With ticks of {tick_ns} ns and the default times this is {round} ticks"),
            format!("{} ms are {fits} such rounds", watchdog.least),
            format!("would be {shorter} rounds of {} ticks", round / 2),
            format!("with ticks of {tick_ns} ns and the default times, the watchdog stops"),
            format!("after {} to {} ms of silence", watchdog.least, watchdog.most),
            format!("accepted after {} to {} us", debounce.least, debounce.most),
            format!("the default times a round has {round} ticks"),
            format!("one step in {us} us, {} steps/s", grouped(1_000_000 / us)),
        ],
    );
}

#[test]
fn accuracy_page_compares_the_segments_of_its_own_table() {
    let page = pages::file("docs/accuracy.md");
    let segments = |profile: &str| {
        let row = page.lines().find(|line| line.starts_with(&format!("| {profile} | 16 |")));
        let row = row.unwrap_or_else(|| panic!("no row of {profile}"));
        row.split(" | ").nth(2).expect("the segments").to_owned()
    };
    let [sine, logistic] = ["sine", "logistic"].map(segments);
    says(
        "docs/accuracy.md",
        &[format!("cubic segments, added up (this project) | {sine} to {logistic} |")],
    );
}

/// The page gives the command that writes the hour's move file: a number of times there and back.
#[test]
fn the_hour_of_the_performance_page_is_what_its_command_writes() {
    let page = pages::joined("docs/performance.md");
    let behind = |text: &str| {
        let (_, rest) = page.split_once(text).unwrap_or_else(|| panic!("no `{text}`"));
        let number = rest.split(|c: char| !c.is_ascii_digit() && c != '.').next();
        number.and_then(|number| number.parse::<f64>().ok()).expect("a number")
    };
    let moved = 2.0 * behind("| head -");
    let (steps, seconds) = (behind("$(yes '"), behind("\\ntime = "));
    assert_eq!(moved * seconds, 3600.0, "an hour");
    let [moves, steps] = [moved, steps].map(|number| number as u64);
    let pulses = moves * steps * AXES as u64;
    assert_eq!(pulses % 1_000_000, 0);
    says(
        "docs/performance.md",
        &[format!(
            "({} moves of {} steps on each axis, {} million pulses)",
            grouped(moves),
            grouped(steps),
            pulses / 1_000_000
        )],
    );
}
