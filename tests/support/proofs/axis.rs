//! The proof of the axis, with sequencer and edge inside it.

use super::builds::{shipped, small_from};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::{Build, StartPhase};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_5_frozen_adds_nothing",
        text: "tick = strobe & !frozen;",
        becomes: "tick = strobe;",
    },
    Bug {
        breaks: "promise_6_every_carry_is_a_step",
        text: "{1'b0, position} + {1'b0, speed}",
        becomes: "{1'b0, position} + {1'b0, faster}",
    },
    Bug {
        breaks: "promise_6_every_carry_is_a_step",
        text: "sum[64] ^ backward",
        becomes: "sum[64] & !backward",
    },
    Bug {
        breaks: "promise_6_registers_of_old_values",
        text: "accel <= accel + jerk;",
        becomes: "accel <= accel;",
    },
    Bug { breaks: "promise_6_speed_in_range", text: "(next_speed == LEAST) | ", becomes: "" },
    Bug {
        breaks: "promise_6_overspeed_is_told",
        text: "too_fast | off_limits;",
        becomes: "too_fast;",
    },
    Bug {
        breaks: "promise_6_overspeed_is_off_limits",
        text: "(backward == accel[63]) & ",
        becomes: "",
    },
    Bug { breaks: "promise_8_drained", text: "!(sequencer_running | ", becomes: "!(" },
    Bug {
        breaks: "promise_8_rest_is_rest",
        text: "next_speed = ZERO;",
        becomes: "next_speed = speed;",
    },
    Bug { breaks: "promise_13_inactive", text: "speed = 64'h0;", becomes: "speed = 64'h1;" },
];

pub(super) fn proof() -> Proof {
    let builds = [shipped(), small_from(16, StartPhase::Zero)];
    let case = |(build, verilog): (Build, _)| Case {
        name: format!("{:?}", build.phase),
        dut: "carrystep_axis".into(),
        parameters: Vec::new(),
        verilog,
        numbers: vec![("START", format!("64'h{:x}", build.phase.start_value()))],
    };
    Proof {
        module: "axis",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/parallel/axis/promises.sv"),
        },
        cases: builds.into_iter().map(case).collect(),
        depth: 1,
        reach: 10,
        bugs: BUGS,
    }
}
