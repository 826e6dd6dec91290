//! Tests of `[machine.guard]` and `stop_accel`: the values in the gateware, and every kind of
//! mistake.

use carrystep_core::engine::{Between, Guard, LimitWiring, MAX_DEBOUNCE_SAMPLES, MAX_ROUNDS};
use carrystep_files::{InputError, Machine, SourceText};

const AXIS: &str = "[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 5\nspeed_limit = 1000\naccel_limit = 5000\n\
                    driver = \"a4988\"\n";

fn read(text: &str) -> Result<Machine, InputError> {
    Machine::from_source(&SourceText { path: "machine.toml".into(), text: text.into() })
}

fn guard(keys: &str) -> Guard {
    with_tick(1000, keys)
}

fn with_tick(tick_ns: u64, keys: &str) -> Guard {
    read(&format!("[machine]\ntick_ns = {tick_ns}\n[machine.guard]\n{keys}\n{AXIS}")).unwrap().guard
}

#[test]
fn missing_keys_have_their_defaults() {
    // 100 ms are 3125 rounds of 32 ticks, and 500 us are 15.6 rounds. With 16 ticks there would be
    // more than 4095 rounds.
    let expected = Guard {
        round: 32,
        watchdog: 3126,
        enable: 33,
        debounce: 17,
        limits: LimitWiring::Pair,
        ..Guard::minimal(vec![461_168_601_842])
    };
    let absent = read(&format!("[machine]\n{AXIS}")).unwrap().guard;
    // 25000 steps/s^2 x (10^-6 s)^2 x 2^64 = 461168601842.7...
    assert_eq!(absent, expected);
    assert_eq!(guard(""), expected);
}

#[test]
fn given_times_are_counted_in_rounds() {
    let keys = "watchdog_ms = 8\nenable_ms = 0.25\ndebounce_us = 100\nestop = \"low\"\nlimits = \"each\"\n\
        limit_level = \"low\"\nlimit_stop = \"freeze\"";
    let found = guard(keys);
    // 8 ms are 4000 rounds of 2 ticks, and 100 us are 50 rounds.
    assert_eq!((found.round, found.watchdog, found.enable, found.debounce), (2, 4001, 126, 51));
    assert_eq!(
        (found.estop_low, found.limits, found.limits_low, found.limit_freezes),
        (true, LimitWiring::Each, true, true)
    );
    assert_eq!(guard("limits = \"none\"").limits, LimitWiring::None);
    assert_eq!(guard("limits = \"one\"").limits, LimitWiring::One);
    let other =
        guard("estop = \"high\"\nlimits = \"pair\"\nlimit_level = \"high\"\nlimit_stop = \"ramp\"");
    assert_eq!(other, guard(""), "these are the defaults");
}

#[test]
fn zero_times_turn_the_functions_off() {
    let found = guard("watchdog_ms = 0\nenable_ms = 0.0\ndebounce_us = 0");
    assert_eq!((found.round, found.watchdog, found.enable, found.debounce), (2, 0, 0, 1));
}

#[test]
fn times_are_rounded_up_and_the_shortest_round_is_chosen() {
    let times = [
        "0.001",
        "0.0010001",
        "1",
        "7.77",
        "8.188",
        "8.1880001",
        "1e2",
        "333.333",
        "1000",
        "4192.256",
    ];
    for (tick_ns, tick) in [(1000, 1e-3), (2000, 2e-3), (62_000, 62e-3)] {
        for ms in times {
            let found = with_tick(tick_ns, &format!("watchdog_ms = {ms}"));
            let (asked, round) = (ms.parse::<f64>().unwrap(), tick * f64::from(found.round));
            let whole = f64::from(found.watchdog - 1);
            // Only exact products at the very boundary may differ from a float.
            assert!(whole * round >= asked * (1.0 - 1e-12), "{ms} ms of {tick_ns} ns: {found:?}");
            assert!(
                (whole - 1.0) * round < asked * (1.0 - 1e-12),
                "{ms} ms of {tick_ns} ns: {found:?}"
            );
            assert!(found.watchdog <= MAX_ROUNDS && found.debounce <= MAX_DEBOUNCE_SAMPLES);
            let shorter = round / 2.0;
            let fits =
                |ms: f64, most: u32| (ms / shorter * (1.0 - 1e-12)).ceil() + 1.0 <= f64::from(most);
            let all =
                fits(asked, MAX_ROUNDS) && fits(1.0, MAX_ROUNDS) && fits(0.5, MAX_DEBOUNCE_SAMPLES);
            assert!(
                found.round == 2 || !all,
                "{ms} ms of {tick_ns} ns: a shorter round would do: {found:?}"
            );
        }
    }
    // Decimals are exact: this time exceeds whole rounds in its last digit, which a float would
    // lose.
    let exact = |ms: &str| guard(&format!("debounce_us = 0\nwatchdog_ms = {ms}"));
    assert_eq!((exact("8.188").round, exact("8.188").watchdog), (2, 4095));
    assert_eq!(exact("8.1880000000000000000000000000001").round, 4);
}

#[test]
fn figures_are_the_counted_times() {
    let machine =
        read(&format!("[machine]\n[machine.guard]\nwatchdog_ms = 99.99\nenable_ms = 0\n{AXIS}"))
            .unwrap();
    let figures = machine.engine().guard_figures();
    assert!((figures.round_us - 32.0).abs() < 1e-9);
    assert_eq!(figures.watchdog_ms, Some(Between { least: 100.0, most: 100.033 }));
    assert_eq!(figures.enable_ms, None);
    assert_eq!(figures.debounce_us, Some(Between { least: 512.0, most: 545.0 }));
    assert!((figures.stop_accel_steps_per_s2[0] - 25_000.0).abs() < 0.1);
}

/// As docs/homing.md says of the time until the guard accepts a switch.
#[test]
fn longest_debounce_exceeds_its_key_by_less_than_two_rounds_and_a_tick() {
    for tick_ns in [1000, 2000] {
        for given in [0.0, 0.5, 1.0, 33.3, 100.0, 500.0, 4096.0, 100_000.0] {
            let machine =
                format!("[machine]\ntick_ns = {tick_ns}\n[machine.guard]\ndebounce_us = {given:?}");
            let figures = read(&format!("{machine}\n{AXIS}")).unwrap().engine().guard_figures();
            let longer = figures.debounce_us.unwrap().most - given;
            let bound = 2.0 * figures.round_us + tick_ns as f64 / 1e3;
            assert!(longer > 0.0 && longer < bound, "{given} us: {longer} us longer, not {bound}");
        }
    }
}

#[test]
fn stop_accel_sets_the_ramp() {
    let stop = |line: &str| {
        read(&format!("[machine]\n{AXIS}{line}\n")).map(|machine| machine.axes[0].stop)
    };
    assert_eq!(stop("stop_accel = 10_000").unwrap(), 922_337_203_685);
    // A quarter of a step per tick^2 is 5e10 units/s^2 in this machine.
    assert_eq!(stop("stop_accel = 5e10").unwrap(), 1 << 62);
    let refused = |line: &str| stop(line).unwrap_err();
    let error = refused("stop_accel = 5.0000001e10");
    assert!(
        error.message.contains("stop_accel is 50000001000 units/s^2 (250000005000 steps/s^2)"),
        "{error}"
    );
    assert_eq!(error.line_column(), Some((8, 14)));
    assert!(
        error
            .help
            .unwrap()
            .ends_with("to 50000000000 units/s^2 (250000000000 steps/s^2) can be counted")
    );
    assert!(refused("stop_accel = 1e-9").message.contains("not from 2^-64"));
    for (value, says) in
        [("0", "must be over zero"), ("-3", "must be over zero"), ("nan", "not a usable number")]
    {
        assert!(refused(&format!("stop_accel = {value}")).message.contains(says), "{value}");
    }
    // An acceleration limit of up to half a step is valid for planning; a ramp uses a quarter at
    // most.
    let limit = AXIS.replace("5000", "9e10");
    assert_eq!(read(&format!("[machine]\n{limit}")).unwrap().guard.stop, [1 << 62]);
}

#[test]
fn mistake_in_the_guard_is_refused_at_its_place() {
    let rows = [
        (
            "watchdog_ms = 4192.2561",
            15,
            "watchdog_ms = 4192.2561: with ticks of 1000 ns at most 4192.256 can be counted",
        ),
        (
            "enable_ms = 5000",
            13,
            "enable_ms = 5000: with ticks of 1000 ns at most 4192.256 can be counted",
        ),
        (
            "debounce_us = 129_025",
            15,
            "debounce_us = 129025: with ticks of 1000 ns at most 129024 can be counted",
        ),
        ("watchdog_ms = 1e29", 15, "at most 4192.256 can be counted"),
        ("watchdog_ms = -1", 15, "must be zero or more"),
        ("enable_ms = -0.001", 13, "must be zero or more"),
        ("debounce_us = -1e9", 15, "must be zero or more"),
        ("watchdog_ms = nan", 15, "not a usable number"),
        ("watchdog_ms = -nan", 15, "not a usable number"),
        ("enable_ms = inf", 13, "not a usable number"),
        ("debounce_us = 1e31", 15, "not a usable number"),
        ("watchdog_ms = 1e999999", 15, "the number is too great"),
        ("watchdog_ms = \"100\"", 15, "expected a number"),
        ("watchdog_ms = \"NaN\"", 15, "expected a number"),
        ("enable_ms = true", 13, "expected a number"),
        ("debounce_us = [1]", 15, "expected a number"),
        ("estop = \"none\"", 9, "unknown variant `none`, expected `high` or `low`"),
        ("estop = 1", 9, "expected a word in quotes"),
        (
            "limits = \"both\"",
            10,
            "unknown variant `both`, expected one of `none`, `pair`, `each`, `one`",
        ),
        ("limit_level = \"High\"", 15, "unknown variant `High`, expected `high` or `low`"),
        ("limit_stop = \"stop\"", 14, "unknown variant `stop`, expected `ramp` or `freeze`"),
        ("round = 64", 1, "unknown field `round`, expected one of `watchdog_ms`, `enable_ms`"),
        ("estop = \"low\"\nestop = \"low\"", 1, "duplicate key"),
    ];
    for (line, column, says) in rows {
        let error = read(&format!("[machine]\n[machine.guard]\n{line}\n{AXIS}")).unwrap_err();
        assert!(error.message.contains(says), "wanted {says}, found {error}");
        let row = 2 + line.lines().count();
        assert_eq!(error.line_column(), Some((row, column)), "{line}: {error}");
    }
    let error = read(&format!("[machine]\nguard = 3\n{AXIS}")).unwrap_err();
    assert!(error.message.contains("expected a [machine.guard] table"), "{error}");
}

#[test]
fn default_that_cannot_be_counted_is_shortened() {
    let text = format!("[machine]\nclock_hz = 1_000_000_000\ntick_ns = 16\n{AXIS}");
    let machine = read(&text).unwrap();
    let figures = machine.engine().guard_figures();
    // 4094 rounds of 1024 ticks.
    assert!((figures.watchdog_ms.unwrap().least - 67.076_096).abs() < 1e-9);
    assert_eq!(machine.guard.round, 1024);
}

#[test]
fn machine_has_at_most_eight_axes() {
    let axes = |count: usize| {
        (0..count).map(|i| AXIS.replace("\"x\"", &format!("\"x{i}\""))).collect::<String>()
    };
    for count in 1..=8 {
        let machine = read(&format!("[machine]\n{}", axes(count))).unwrap();
        assert_eq!(machine.build().is_ok(), count <= 6, "{count}");
        let engine = machine.engine();
        assert_eq!((engine.pins.len(), engine.guard.stop.len()), (count, count));
        assert_eq!(engine.pins[count - 1], machine.axes[0].pins);
    }
    let error = read(&format!("[machine]\n{}", axes(9))).unwrap_err();
    assert_eq!(error.message, "9 axes: an engine drives at most 8");
    assert_eq!(error.line_column(), Some((2 + 8 * 6, 1)));
    let refused = read(&format!("[machine]\n{}", axes(7))).unwrap().build().unwrap_err();
    assert_eq!(
        refused.to_string(),
        "7 axes: the parallel gateware drives at most 6; an engine may have up to 8"
    );
}
