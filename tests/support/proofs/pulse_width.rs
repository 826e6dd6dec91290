//! The proof of the PWM, with several dividers and for a build without it.

use super::builds::{BuiltEngine, engine_with_inputs, engine_with_outputs};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::engine::EngineBuild;

const BUGS: &[Bug] = &[
    Bug { breaks: "promise_17_pin_for_the_duty", text: "count < width", becomes: "count <= width" },
    Bug {
        breaks: "promise_17_pin_for_the_duty",
        text: "divided == LAST",
        becomes: "divided == ONE_CLOCK",
    },
    Bug { breaks: "promise_17_off", text: "& !off;", becomes: ";" },
    Bug { breaks: "promise_13_inactive", text: "high = 1'b0;", becomes: "high = 1'b1;" },
];

pub(super) fn proof(_: &BuiltEngine) -> Proof {
    let builds = [
        engine_with_outputs(0x35, 3),
        engine_with_outputs(0, 1),
        engine_with_outputs(0xff, 256),
        engine_with_inputs(6, 80, 4),
    ];
    let case = |(build, verilog): (EngineBuild, _)| Case {
        name: format!("{} clocks a step", build.outputs.pwm_divider),
        dut: "carrystep_pulse_width".into(),
        parameters: Vec::new(),
        verilog,
        numbers: vec![("DIVIDER", build.outputs.pwm_divider.to_string())],
    };
    Proof {
        module: "pulse_width",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/pulse_width/promises.sv"),
        },
        cases: builds.map(case).into(),
        depth: 1,
        reach: 30,
        bugs: BUGS,
    }
}
