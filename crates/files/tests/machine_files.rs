//! Tests of valid machine files.

use carrystep_core::{AXES, PinTimes, PinTiming, StartPhase};
use carrystep_files::{BigDecimal, Machine, SourceText};

const AXIS: &str =
    "[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 5\nspeed_limit = 1000\naccel_limit = 5000\n";

/// A clock at which the drivers' times are no whole clocks; one axis has ticks of 1 us there.
const AT_48: &str = "[machine]\nclock_hz = 48_000_000\n";

fn machine(text: &str) -> Machine {
    Machine::from_source(&SourceText { path: "machine.toml".into(), text: text.into() }).unwrap()
}

fn number(text: &str) -> BigDecimal {
    text.parse().unwrap()
}

#[test]
fn missing_keys_have_their_defaults() {
    let machine = machine(&format!("[machine]\n{AXIS}driver = \"a4988\"\n"));
    let timebase = machine.timebase;
    assert_eq!(
        (timebase.clock_hz(), timebase.tick_ns(), timebase.phases()),
        (80_000_000, 1000, 16)
    );
    assert_eq!((timebase.clocks_per_tick(), timebase.clocks_per_phase()), (80, 5));
    assert_eq!(machine.phase, StartPhase::Half);
    let axis = &machine.axes[0];
    assert_eq!(axis.start_speed.steps, number("0"));
    assert_eq!(axis.jerk_limit, None);
}

#[test]
fn given_values_replace_the_defaults() {
    let head = "[machine]\nclock_hz = 16_000_000\ntick_ns = 2000\nphases = 4\nphase = \"zero\"\n";
    let machine =
        machine(&format!("{head}{AXIS}start_speed = 0.5\njerk_limit = 1e6\ndriver = \"a4988\"\n"));
    let timebase = machine.timebase;
    assert_eq!((timebase.clock_hz(), timebase.tick_ns(), timebase.phases()), (16_000_000, 2000, 4));
    assert_eq!(machine.phase, StartPhase::Zero);
    assert_eq!(machine.axes[0].start_speed.steps, number("2.5"));
    assert_eq!(machine.axes[0].jerk_limit.as_ref().unwrap().steps, number("5e6"));
}

#[test]
fn limits_are_exact_products() {
    let text = "[machine]\n[[machine.axis]]\nname = \"a\"\nsteps_per_unit = 8.888888888888889\nspeed_limit = 0.1\n\
        accel_limit = 1_000.3\ndriver = \"a4988\"\n";
    let axis = &machine(text).axes[0];
    assert_eq!(axis.speed_limit.steps, number("0.8888888888888889"));
    assert_eq!(axis.accel_limit.steps, number("8891.5555555555556667"));
}

#[test]
fn pin_times_by_their_names_of_the_first_edition_are_read() {
    let times = |text: &str| machine(&format!("{AT_48}{AXIS}{text}")).axes.remove(0).pins_ns;
    let now = "step_high_ns = 900\nstep_low_ns = 800\ndir_setup_ns = 70\ndir_hold_ns = 60\n";
    let then = "step_ns = 900\ngap_ns = 800\nsetup_ns = 70\nhold_ns = 60\n";
    assert_eq!(times(then), times(now));
}

#[test]
fn single_pin_times_override_the_driver_preset() {
    let pins = |lines: &str| machine(&format!("[machine]\n{AXIS}{lines}")).axes[0].pins_ns;
    let a4988 = PinTimes { step_high: 1000, step_low: 1000, dir_setup: 200, dir_hold: 200 };
    assert_eq!(pins("driver = \"a4988\"\n"), a4988);
    assert_eq!(
        pins("driver = \"a4988\"\ndir_hold_ns = 500\n"),
        PinTimes { dir_hold: 500, ..a4988 }
    );
    assert_eq!(
        pins("step_high_ns = 1\nstep_low_ns = 2\ndir_setup_ns = 3\ndir_hold_ns = 4\n"),
        PinTimes { step_high: 1, step_low: 2, dir_setup: 3, dir_hold: 4 }
    );
}

#[test]
fn pin_timings_are_rounded_up_to_clocks_and_never_none() {
    let axis =
        machine(&format!("{AT_48}{AXIS}driver = \"drv8825\"\ndir_hold_ns = 0\n")).axes.remove(0);
    // 1900 ns are 91.2 clocks of 48 MHz, 650 ns are 31.2
    assert_eq!(axis.pins, PinTiming { step_high: 92, step_low: 92, dir_setup: 32, dir_hold: 1 });
}

#[test]
fn build_of_the_core_always_has_six_pin_timings() {
    let two = format!(
        "[machine]\n{AXIS}driver = \"a4988\"\n{}driver = \"tmc2209\"\n",
        AXIS.replace("\"x\"", "\"y\"")
    );
    let machine = machine(&two);
    assert_eq!((machine.axis_index("y"), machine.axis_index("q")), (Some(1), None));
    assert_eq!(machine.axis_names(), "x, y");
    let build = machine.build().unwrap();
    assert_eq!(build.pins[0].step_high, 80);
    assert_eq!(build.pins[1].step_high, 8);
    assert_eq!(build.pins[2..], [PinTiming::SHORTEST; AXES - 2]);
}

#[test]
fn the_fastest_speed_that_the_driver_allows_is_allowed() {
    // 48 + 48 clocks and a phase of 3: 48 MHz / 99
    let axis = |speed: &str| format!("{AT_48}{AXIS}driver = \"a4988\"\n").replace("1000", speed);
    let refused = |text: String| {
        Machine::from_source(&SourceText { path: "m".into(), text: text.into() }).is_err()
    };
    assert!(!refused(axis("96969.69")));
    assert!(refused(axis("96969.70")));
}
