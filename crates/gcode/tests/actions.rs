//! Codes that do not move: each gives exactly its canonical actions.

use crate::support::canons;
use carrystep_gcode::{Canon, PathMode, Turn};

/// The actions of a program, without the end.
fn actions(text: &str) -> Vec<Canon> {
    let mut found = canons(text);
    assert_eq!(found.pop(), Some(Canon::End));
    found
}

#[test]
fn outputs_change_at_once_or_with_the_next_move() {
    let digital = |on, with_motion| Canon::DigitalOutput { index: 3, on, with_motion };
    let analog = |with_motion| Canon::AnalogOutput { index: 2, value: -0.5, with_motion };
    assert_eq!(
        actions("M62 P3\nM63 P3\nM64 P3\nM65 P3\nM67 E2 Q-0.5\nM68 E2 Q-0.5"),
        [
            digital(true, true),
            digital(false, true),
            digital(true, false),
            digital(false, false),
            analog(true),
            analog(false),
        ]
    );
}

#[test]
fn path_modes_have_their_tolerances_in_mm() {
    let blend =
        |tolerance_mm, joining_mm| Canon::Path(PathMode::Blend { tolerance_mm, joining_mm });
    assert_eq!(
        actions("G61\nG61.1\nG64\nG64 P0.5 Q0.25\nG20\nG64 P1 Q2"),
        [
            Canon::Path(PathMode::Exact),
            Canon::Path(PathMode::ExactStop),
            blend(None, None),
            blend(Some(0.5), Some(0.25)),
            blend(Some(25.4), Some(50.8)),
        ]
    );
}

#[test]
fn the_spindle_turns_as_asked_and_stops_for_a_tool_change() {
    let spindle = |turn, rpm| Canon::Spindle { turn, rpm };
    assert_eq!(
        actions("S500\nM3\nS600\nM4 S700\nT3\nM6\nS800\nM5"),
        [
            spindle(Turn::Clockwise, 500.0),
            spindle(Turn::Clockwise, 600.0),
            spindle(Turn::Counterclockwise, 700.0),
            Canon::SelectTool { tool: 3 },
            spindle(Turn::Off, 700.0),
            Canon::ChangeTool { tool: 3 },
            spindle(Turn::Off, 800.0),
        ]
    );
}

#[test]
fn overrides_and_stops_are_given_in_order() {
    let pause = |optional| Canon::Pause { optional };
    let found = actions("M49\nM48\nM0\nM1\nM60\nG4 P2.5 M0");
    let (off, on) = (Canon::Overrides { enabled: false }, Canon::Overrides { enabled: true });
    let dwell = Canon::Dwell { seconds: 2.5 };
    assert_eq!(found, [off, on, pause(false), pause(true), pause(false), dwell, pause(false)]);
    let stops: Vec<bool> = found.iter().map(Canon::is_sync_point).collect();
    assert_eq!(stops, [false, false, true, true, true, false, true]);
}
