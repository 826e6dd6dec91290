//! The proof of the step counts: pulses and discarded steps in memory, and steps on their way.

use super::builds::BuiltEngine;
use super::{Bug, Case, Promises, Proof};

const BUGS: &[Bug] = &[
    Bug { breaks: "promise_6_discarded_are_written_off", text: "& !running;", becomes: ";" },
    Bug {
        breaks: "promise_6_none_written_off_twice",
        text: "next_lost = counts[2:0] + ONE",
        becomes: "next_lost = counts[2:0]",
    },
    Bug { breaks: "promise_7_told_as_pulsed", text: "less = missing[2];", becomes: "less = 1'b0;" },
    Bug {
        breaks: "promise_7_never_far_behind",
        text: "(missing != 3'd0) & !missing[2];",
        becomes: "1'b0;",
    },
    Bug { breaks: "promise_13_inactive", text: "gone = 1'b0;", becomes: "gone = 1'b1;" },
    Bug { breaks: "promise_15_on_way", text: "gain = TWO_LESS;", becomes: "gain = ONE_LESS;" },
    Bug {
        breaks: "promise_15_on_way",
        text: "behind = moves & crosses & back;",
        becomes: "behind = moves & back;",
    },
    Bug {
        breaks: "promise_15_on_way",
        text: "next_on_way = NONE_ON_WAY;",
        becomes: "next_on_way = ONE_MORE;",
    },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let case = Case {
        name: "any".into(),
        dut: "carrystep_step_counts".into(),
        parameters: Vec::new(),
        verilog: built.1.clone(),
        numbers: Vec::new(),
    };
    Proof {
        module: "step_counts",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/step_counts/promises.sv"),
        },
        cases: vec![case],
        depth: 1,
        reach: 260,
        bugs: BUGS,
    }
}
