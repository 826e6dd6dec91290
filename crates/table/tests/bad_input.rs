//! Tests that an impossible request is refused with the nearest possible value, and that nothing
//! panics or is clipped.

use crate::support::source;
use carrystep_table::{
    Arithmetic, Kind, Motor, Options, Pulses, Speed, Table, TableError, TableRequest, Timer,
    TimerMode, Width,
};
use proptest::prelude::*;

fn refusal(change: impl FnOnce(&mut TableRequest)) -> String {
    let mut request = source(TimerMode::Ctc, 1000, Pulses::One);
    change(&mut request);
    Table::new(request).expect_err("a refusal").to_string()
}

#[test]
fn every_refusal_names_a_value_that_works() {
    let logistic = |entries, steepness, centre| Kind::Logistic { entries, steepness, centre };
    let said = [
        (
            refusal(|r| r.kind = logistic(0, 6.0, None)),
            "entries is 0: 1 to 65535 is needed; the nearest is 1",
        ),
        (
            refusal(|r| r.kind = logistic(70_000, 6.0, None)),
            "entries is 70000: 1 to 65535 is needed; the nearest is 65535",
        ),
        (
            refusal(|r| r.kind = logistic(9, 0.0, None)),
            "steepness is 0: over 0 and at most 1000 is needed",
        ),
        (
            refusal(|r| r.kind = logistic(9, f64::NAN, None)),
            "steepness is NaN: over 0 and at most 1000 is needed",
        ),
        (
            refusal(|r| r.kind = logistic(9, 6.0, Some(9.5))),
            "centre is 9.5: over 0 and at most 9 is needed",
        ),
        (
            refusal(|r| r.kind = Kind::Avr446 { ramp_steps: 0, arithmetic: Arithmetic::Float }),
            "ramp_steps is 0: 1 to 1000000 is needed; the nearest is 1",
        ),
        (
            refusal(|r| r.kind = Kind::Sine { ramp_steps: 9, inverse: Some(1) }),
            "intervals of the inverse table is 1: 2 to 4096 is needed; the nearest is 2",
        ),
        (
            refusal(|r| r.kind = Kind::Sine { ramp_steps: 9, inverse: Some(64) }),
            "the inverse table is for ramps from rest: start_frequency is 500, 0 or no inverse table would do",
        ),
        (
            refusal(|r| r.top_speed = Speed::Rpm(15.0)),
            "a top speed of 400 steps/s is not over the start frequency of 500 steps/s: a top speed over 500 steps/s \
             (18.75 rpm) or a start frequency under 400 steps/s would do",
        ),
        (
            refusal(|r| r.top_speed = Speed::Rpm(0.0)),
            "top speed, steps/s, is 0: 0.001 to 1e9 is needed",
        ),
        (refusal(|r| r.start_frequency = -1.0), "start_frequency is -1: 0 or more is needed"),
        (
            refusal(|r| r.motor.microsteps = 0),
            "microsteps is 0: 1 to 65536 is needed; the nearest is 1",
        ),
        (
            refusal(|r| r.motor.step_angle_deg = 0.0),
            "step_angle_deg is 0: over 0 and at most 180 is needed",
        ),
        (refusal(|r| r.timer.clock_hz = 0), "clock_hz is 0: 1 to 1e10 is needed"),
        (
            refusal(|r| r.timer.prescaler = 32),
            "the timer has no prescaler 32: it has 1, 8, 64, 256, 1024",
        ),
        (
            refusal(|r| r.pulses = Pulses::ByGroup(vec![])),
            "groups is 0: 1 to 65535 is needed; the nearest is 1",
        ),
        (
            refusal(|r| r.pulses = Pulses::ByGroup(vec![1, 0])),
            "pulses per entry is 0: 1 to 65535 is needed; the nearest is 1",
        ),
        (
            refusal(|r| r.pulses = Pulses::ByGroup(vec![1, 2, 3])),
            "1000 entries do not divide into groups of 3: 999 or 1002 would do",
        ),
        (
            refusal(|r| r.pulses = Pulses::ByTime(0.0)),
            "pulses by time is 0: over 0 and at most 1000 is needed",
        ),
        (
            refusal(|r| r.pulses = Pulses::ByTime(10.0)),
            "an entry would last 65790 pulses, at most 65535 can be: a time of at most 4.915125 s would do",
        ),
        (
            refusal(|r| {
                r.kind = Kind::Avr446 { ramp_steps: 70_000, arithmetic: Arithmetic::Float }
            }),
            "the table would have 70000 entries, at most 65535 can be: more pulses per entry would do",
        ),
        (
            Options::new("2fast").unwrap_err().to_string(),
            "\"2fast\" is no name for a table: a letter, then up to 47 letters, digits or underscores",
        ),
    ];
    for (text, expected) in said {
        assert_eq!(text, expected);
    }
    for name in ["", "_x", "a b", "a*/", "ä", &"x".repeat(49)] {
        assert!(Options::new(name).is_err(), "{name}");
    }
}

#[test]
fn value_that_does_not_fit_names_a_prescaler_that_works() {
    assert_eq!(
        refusal(|r| {
            r.timer.prescaler = 1;
            r.start_frequency = 100.0;
        }),
        "the slowest entry waits 120554 counts, the 16-bit timer at most 65536: prescaler 8 would do"
    );
    assert_eq!(
        refusal(|r| {
            r.timer.prescaler = 1024;
            r.top_speed = Speed::StepsPerSecond(50_000.0);
        }),
        "the top speed waits 0.31 counts, at least 1 are needed: prescaler 1 would do"
    );
}

#[test]
fn start_frequency_is_named_where_no_prescaler_works() {
    let mut request = source(TimerMode::Ctc, 1000, Pulses::One);
    request.timer.width = Width::Bits8;
    request.start_frequency = 2.0;
    request.kind = Kind::Logistic { entries: 1000, steepness: 14.0, centre: None };
    let Err(TableError::TooSlow { prescaler: None, start: Some(start), .. }) =
        Table::new(request.clone())
    else {
        panic!("{:?}", Table::new(request));
    };
    request.start_frequency = start;
    let Err(TableError::TooSlow { prescaler: Some(prescaler), .. }) = Table::new(request.clone())
    else {
        panic!("{:?}", Table::new(request));
    };
    request.timer.prescaler = prescaler;
    Table::new(request).unwrap();
}

#[test]
fn top_speed_too_fast_for_the_interrupt_is_refused() {
    let mut request = source(TimerMode::Ctc, 1000, Pulses::One);
    request.timer.interrupt_clocks = 1500; // 24 counts; the top speed needs 18.75
    let Err(TableError::TooFast { prescaler: None, least: 24, speed, .. }) =
        Table::new(request.clone())
    else {
        panic!("{:?}", Table::new(request));
    };
    request.top_speed = Speed::StepsPerSecond(speed);
    request.timer.prescaler = 1; // "with the smallest prescaler"
    let table = Table::new(request).unwrap();
    assert_eq!(table.cruise(), 1499);
}

fn any_request() -> impl Strategy<Value = TableRequest> {
    let float = || prop_oneof![1 => prop::num::f64::ANY, 9 => 1e-3..1e4, 1 => Just(0.0), 1 => Just(f64::INFINITY)];
    let steps =
        || prop_oneof![1 => any::<u32>(), 9 => 0_u32..2000, 1 => Just(65_535), 1 => Just(65_536)];
    let kind = prop_oneof![
        (steps(), float(), prop::option::of(float()))
            .prop_map(|(entries, steepness, centre)| Kind::Logistic { entries, steepness, centre }),
        (steps(), any::<bool>()).prop_map(|(ramp_steps, float)| Kind::Avr446 {
            ramp_steps,
            arithmetic: if float { Arithmetic::Float } else { Arithmetic::Integer },
        }),
        (steps(), prop::option::of(0_u32..5000))
            .prop_map(|(ramp_steps, inverse)| Kind::Sine { ramp_steps, inverse }),
    ];
    let pulses = prop_oneof![
        Just(Pulses::One),
        prop::collection::vec(prop_oneof![1 => any::<u32>(), 9 => 1_u32..3], 0..4)
            .prop_map(Pulses::ByGroup),
        float().prop_map(Pulses::ByTime),
    ];
    let timer = (
        prop_oneof![1 => any::<u64>(), 9 => 1_u64..20_000_000],
        prop::collection::vec(0_u32..2000, 0..5),
        any::<u32>(),
        any::<[bool; 3]>(),
    );
    let motor = (float(), any::<u32>());
    (timer, motor, float(), float(), kind, pulses).prop_map(
        |(
            (clock_hz, mut prescalers, interrupt, [ctc, small, slow]),
            (angle, microsteps),
            start,
            top,
            kind,
            pulses,
        )| {
            prescalers.push(64);
            let timer = Timer {
                clock_hz,
                prescaler: prescalers[0],
                prescalers,
                width: if small { Width::Bits8 } else { Width::Bits16 },
                mode: if ctc { TimerMode::Ctc } else { TimerMode::FreeRunning },
                interrupt_clocks: if slow { interrupt } else { 0 },
            };
            let motor = if slow {
                Motor { step_angle_deg: angle, microsteps }
            } else {
                Motor { step_angle_deg: 1.8, microsteps: 8 }
            };
            let top_speed = if small { Speed::Rpm(top) } else { Speed::StepsPerSecond(top) };
            TableRequest { timer, motor, start_frequency: start, top_speed, kind, pulses }
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn no_request_panics(request in any_request(), steps in 0_u32..500) {
        match Table::new(request) {
            Ok(table) => {
                let header = table.header(&Options::new("t").unwrap());
                prop_assert!(header.contains("t_compare["));
                prop_assert!(serde_json::to_string(&table).is_ok());
                prop_assert_eq!(table.delays(steps).count(), steps as usize);
            }
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }
}
