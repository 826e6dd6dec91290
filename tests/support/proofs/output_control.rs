//! The proof of the outputs: which commit changes which of them, and when.

use super::builds::{BuiltEngine, engine_with_inputs, engine_with_outputs};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::engine::EngineBuild;

const BUGS: &[Bug] = &[
    Bug { breaks: "promise_17_only_where_named", text: "levels & ~mask", becomes: "levels & mask" },
    Bug {
        breaks: "promise_17_levels_of_the_commit",
        text: "begun <= starts | follower;",
        becomes: "begun <= starts;",
    },
    Bug { breaks: "promise_17_off", text: "if (off) begin", becomes: "if (off & !applies) begin" },
    Bug {
        breaks: "promise_17_duty_of_the_commit",
        text: "due <= begun;",
        becomes: "due <= follower;",
    },
    Bug {
        breaks: "promise_17_others_are_refused",
        text: "!first & (of_others != 32'd0)",
        becomes: "!first & (never != 32'd0)",
    },
    Bug {
        breaks: "promise_17_what_the_build_has",
        text: "output_words_read_data[7:0] & EXIST",
        becomes: "output_words_read_data[7:0]",
    },
    Bug { breaks: "promise_13_inactive", text: "levels = 8'd0;", becomes: "levels = 8'd1;" },
];

pub(super) fn proof(_: &BuiltEngine) -> Proof {
    let builds = [
        engine_with_outputs(0x35, 3),
        engine_with_outputs(0xff, 0),
        engine_with_outputs(0, 1),
        engine_with_inputs(6, 80, 4),
    ];
    let case = |(build, verilog): (EngineBuild, _)| {
        let outputs = build.outputs;
        let pwm = u8::from(outputs.pwm_divider > 0);
        Case {
            name: format!("outputs {:#04x}, {pwm} PWM", outputs.exist),
            dut: "carrystep_output_control".into(),
            parameters: Vec::new(),
            verilog,
            numbers: vec![("EXIST", outputs.exist.to_string()), ("HAS_PWM", pwm.to_string())],
        }
    };
    Proof {
        module: "output_control",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/output_control/promises.sv"),
        },
        cases: builds.map(case).into(),
        depth: 1,
        reach: 80,
        bugs: BUGS,
    }
}
