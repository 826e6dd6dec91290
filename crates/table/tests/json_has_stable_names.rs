//! Tests the names and values of `--json`, which scripts of users read.

use crate::support::source;
use carrystep_table::{Pulses, Table, TimerMode};
use serde_json::{Value, json};

#[test]
fn json_of_the_source_table_has_stable_names() {
    let table = Table::new(source(TimerMode::Ctc, 4, Pulses::ByGroup(vec![1, 3]))).unwrap();
    let mut value: Value = serde_json::to_value(&table).unwrap();
    let figures = value.as_object_mut().unwrap().remove("figures").unwrap();
    assert_eq!(
        value,
        json!({
            "request": {
                "timer": {
                    "clock_hz": 16_000_000, "prescaler": 64, "prescalers": [1, 8, 64, 256, 1024],
                    "width": "bits16", "mode": "ctc", "interrupt_clocks": 0,
                },
                "motor": {"step_angle_deg": 1.8, "microsteps": 8},
                "start_frequency": 500.0,
                "top_speed": {"rpm": 500.0},
                "kind": "logistic", "entries": 4, "steepness": 6.0, "centre": null,
                "pulses": {"by_group": [1, 3]},
            },
            "compare": [469, 225, 35, 19],
            "cruise": 18,
            "groups": [{"end": 2, "pulses": 1}, {"end": 4, "pulses": 3}],
        })
    );
    let names: Vec<&str> = figures.as_object().unwrap().keys().map(String::as_str).collect();
    let expected = [
        "bytes",
        "entries",
        "first_speed",
        "peak_acceleration",
        "ramp_pulses",
        "ramp_seconds",
        "ramp_seconds_ideal",
        "timer_hz",
        "top_rpm",
        "top_speed",
        "top_speed_asked",
        "worst_speed_error",
    ];
    assert_eq!(names, expected);
}
