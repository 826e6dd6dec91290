//! The proof of the edge module, with the tick module that drives it.

use super::builds::{beat, beat_name, shipped, small};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::Build;

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_6_nothing_lost",
        text: "emit <= tick_crossed;",
        becomes: "emit <= tick_crossed & !frozen;",
    },
    Bug { breaks: "promise_6_in_flight", text: "tick_crossed | emit;", becomes: "tick_crossed;" },
    Bug {
        breaks: "promise_11_at_its_phase",
        text: "(phase == emit_q)",
        becomes: "(phase == bisect_q)",
    },
    Bug {
        breaks: "promise_11_direction",
        text: "request_back = emit_back;",
        becomes: "request_back = tick_back;",
    },
    Bug {
        breaks: "promise_11_phase_as_defined",
        text: "(bisect_v >> BY_ONE) | (bisect_v & SIGN)",
        becomes: "bisect_v >> BY_ONE",
    },
    Bug { breaks: "promise_13_inactive", text: "emit = 1'b0;", becomes: "emit = 1'b1;" },
];

pub(super) fn proof() -> Proof {
    let builds = [small(4), small(16), small(1), shipped()];
    let case = |(build, verilog): (Build, _)| Case {
        name: beat_name(&build.timebase),
        dut: "carrystep_step_edge".into(),
        parameters: Vec::new(),
        verilog,
        numbers: beat(&build.timebase),
    };
    Proof {
        module: "edge",
        promises: Promises { text: include_str!("../../../crates/hdl/src/parts/edge/promises.sv") },
        cases: builds.into_iter().map(case).collect(),
        depth: 1,
        reach: 50,
        bugs: BUGS,
    }
}
