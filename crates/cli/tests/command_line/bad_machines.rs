//! Every way in which a machine can be wrong is refused, and the error points at the wrong value.

use crate::command::{Folder, GOOD, all_refused, edit};

const AXIS: &str = "steps_per_unit = 1\nspeed_limit = 9\naccel_limit = 9\ndriver = \"a4988\"\n";

#[test]
fn unknown_and_missing_keys_are_refused() {
    all_refused(&[
        (
            "[machine]\n",
            "^colour = 3\n[machine]\n",
            "unknown field `colour`, expected one of `machine_file`, `machine`",
        ),
        (
            "phases = 16",
            "^colour = 3",
            "unknown field `colour`, expected one of `clock_hz`, `tick_ns`",
        ),
        (
            "start_speed = 200",
            "^colour = 3",
            "unknown field `colour`, expected one of `name`, `letter`, `steps_per_unit`",
        ),
        ("start_speed = 200", "start_speed = 200\n^start_speed = 1", "duplicate key"),
        ("[[machine.axis]]\nname = \"x\"\n", "^[[machine.axis]]\n", "missing field `name`"),
        (
            "[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 5\n",
            "^[[machine.axis]]\nname = \"x\"\n",
            "missing field `steps_per_unit`",
        ),
    ]);
    for key in ["speed_limit = 1000\n", "accel_limit = 5000\n"] {
        let (without, name) = (GOOD.replace(key, ""), key.split(' ').next().unwrap());
        let ran = Folder::with_move(without).run("plan move.toml");
        ran.refuses_at("move.toml", (7, 1), &format!("missing field `{name}`"));
    }
}

#[test]
fn values_of_the_wrong_type_are_refused() {
    all_refused(&[
        ("speed_limit = 1000", "speed_limit = ^\"fast\"", "string \"fast\", expected a number"),
        ("speed_limit = 1000", "speed_limit = ^[1]", "sequence, expected a number"),
        ("name = \"x\"", "name = ^3", "integer `3`, expected a string"),
        ("driver = \"a4988\"", "driver = ^true", "boolean `true`, expected a string"),
        (
            "clock_hz = 48_000_000",
            "clock_hz = ^4.8e7",
            "floating point `48000000.0`, expected a whole number, zero or more",
        ),
        (
            "clock_hz = 48_000_000",
            "clock_hz = ^-48",
            "integer `-48`, expected a whole number, zero or more",
        ),
        ("phases = 16", "phases = ^99999999999", "expected a whole number, zero or more"),
        (
            "phase = \"half\"",
            "phase = ^\"quarter\"",
            "unknown variant `quarter`, expected `half` or `zero`",
        ),
        ("[[machine.axis]]", "^[machine.axis]", "map, expected tables in double brackets"),
        ("steps_per_unit = 5", "steps_per_unit = ^= 5", "extra `=`"),
    ]);
}

#[test]
fn numbers_that_are_not_finite_or_of_the_wrong_sign_are_refused() {
    let long = "3".repeat(70);
    let finite = "not a usable number";
    let rows = [
        ("nan", finite),
        ("inf", finite),
        ("-inf", finite),
        ("1e-999999999", finite),
        (&format!("0.{long}"), finite),
        ("1e31", finite),
        ("1e999999999", "the number is too great"),
        (&long, "a number of too many digits"),
        ("-5", "must be "),
        ("-1e-9", "must be "),
        ("0", "must be over zero"),
        ("-0.0", "must be over zero"),
    ];
    for field in
        ["steps_per_unit = 5", "start_speed = 200", "speed_limit = 1000", "accel_limit = 5000"]
    {
        let key = field.split(' ').next().unwrap();
        let may_be_zero = key == "start_speed";
        for (value, says) in
            rows.iter().filter(|(_, says)| !(may_be_zero && says.ends_with("over zero")))
        {
            all_refused(&[(field, &format!("{key} = ^{value}"), says)]);
        }
    }
    all_refused(&[
        ("driver", "jerk_limit = ^0\ndriver", "jerk_limit = 0: must be over zero"),
        (
            "speed_limit = 1000",
            "speed_limit = ^1e-4",
            "speed_limit is 0.0001 units/s (0.0005 steps/s): under 0.001 steps/s",
        ),
        (
            "accel_limit = 5000",
            "accel_limit = ^1e-4",
            "accel_limit is 0.0001 units/s^2 (0.0005 steps/s^2): under 0.001 steps/s^2",
        ),
    ]);
}

#[test]
fn clocks_ticks_and_phases_that_do_not_divide_are_refused() {
    all_refused(&[
        ("phases = 16", "phases = ^3", "3 phases: a tick has 1, 4 or 16 phases"),
        ("clock_hz = 48_000_000", "clock_hz = ^0", "a clock of 0 Hz"),
        ("clock_hz = 48_000_000", "clock_hz = ^1_000_000_016", "a clock of 1000000016 Hz"),
        ("tick_ns = 1000", "tick_ns = ^0", "0 clocks per tick: between 16 and 65536 are needed"),
        (
            "tick_ns = 1000",
            "tick_ns = ^1_000_000_000",
            "48000000 clocks per tick: between 16 and 65536 are needed",
        ),
        (
            "tick_ns = 1000",
            "tick_ns = ^333",
            "a tick of 333 ns is not a whole number of clocks at 48000000 Hz",
        ),
        ("48_000_000\ntick_ns = 1000", "^48_000_001", "a clock of 48000001 Hz has no tick"),
        (
            "tick_ns = 1000\nphases = 16",
            "tick_ns = 500\nphases = ^16",
            "24 clocks per tick do not divide into 16 equal phases",
        ),
        (
            "tick_ns = 1000\nphases = 16",
            "tick_ns = ^500",
            "24 clocks per tick do not divide into 16 equal phases",
        ),
    ]);
}

#[test]
fn speeds_too_high_for_gateware_or_driver_are_refused() {
    all_refused(&[
        (
            "speed_limit = 1000",
            "speed_limit = ^100_000",
            "speed_limit is 100000 units/s (500000 steps/s): half a step per tick or more",
        ),
        (
            "speed_limit = 1000",
            "speed_limit = ^96_970",
            "over what the driver's step_high and step_low allow",
        ),
        (
            "speed_limit = 1000",
            "speed_limit = ^96_970",
            "a pulse takes 48 + 48 clocks and one phase of 3: at most 96969.6 units/s (484848 steps/s)",
        ),
        ("accel_limit = 5000", "accel_limit = ^1e11", "half a step per tick^2 or more"),
        ("start_speed = 200", "start_speed = ^1000.5", "start_speed is over speed_limit"),
    ]);
    let (fits, _) = edit(GOOD, "speed_limit = 1000", "speed_limit = ^96_969");
    assert_eq!(Folder::with_move(fits).run("plan move.toml").status, 0);
}

#[test]
fn unknown_drivers_and_bad_pin_timings_are_refused() {
    let known = "known: a4988, dm542, drv8825, tb6600, tmc2130, tmc2208, tmc2209, tmc5160; or give step_high_ns";
    all_refused(&[
        ("\"a4988\"", "^\"a4989\"", "no driver is called 'a4989'"),
        ("\"a4988\"", "^\"a4989\"", known),
        (
            "\"x\"\nsteps_per_unit = 5\nstart_speed = 200\nspeed_limit = 1000\naccel_limit = 5000\ndriver = \"a4988\"",
            "^\"x\"\nsteps_per_unit = 5\nspeed_limit = 1000\naccel_limit = 5000\nstep_high_ns = 100",
            "axis 'x' has no driver and no step_low_ns",
        ),
        (
            "driver = \"a4988\"",
            "driver = \"a4988\"\ndir_hold_ns = ^9_000_000_000",
            "the timers count to 65535",
        ),
        (
            "driver = \"a4988\"",
            "driver = \"a4988\"\ndir_hold_ns = ^-1",
            "expected a whole number, zero or more",
        ),
    ]);
}

#[test]
fn badly_named_duplicate_and_surplus_axes_are_refused() {
    for name in ["", "1x", "x y", "x-1", "x.step", "\u{e9}", &"x".repeat(33)] {
        let says = format!("{name:?} cannot name an axis");
        all_refused(&[("\"x\"", &format!("^\"{name}\""), &says)]);
    }
    let axes: String =
        (0..5).map(|i| format!("[[machine.axis]]\nname = \"x{i}\"\n{AXIS}\n")).collect();
    let and = |more: &str| format!("driver = \"a4988\"\n\n{axes}{more}");
    all_refused(&[
        (
            "driver = \"a4988\"\n",
            &and(&format!("^[[machine.axis]]\nname = \"x6\"\n{AXIS}\n")),
            "7 axes: moves are planned for at most 6",
        ),
        (
            "driver = \"a4988\"\n",
            &format!("driver = \"a4988\"\n[[machine.axis]]\nname = ^\"x\"\n{AXIS}"),
            "two axes are called 'x'",
        ),
    ]);
    let (head, rest) = GOOD.split_at(GOOD.find("[[machine.axis]]").unwrap());
    let moves = &rest[rest.find("[[move]]").unwrap()..];
    let without = Folder::with_move(format!("{head}{moves}")).run("plan move.toml");
    without.refuses_at("move.toml", (1, 1), "missing field `axis`");
    let empty = Folder::with_move(format!("{head}axis = []\n{moves}")).run("plan move.toml");
    empty.refuses_at("move.toml", (7, 8), "a machine without axes");
}
