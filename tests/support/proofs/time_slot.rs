//! The proof of the schedule of time slots.

use super::builds::{BuiltEngine, axes, small_engine};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::engine::{EngineBuild, LimitWiring};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_11_every_axis_once_a_tick",
        text: "strobe | (beats[12]",
        becomes: "strobe | (beats[11]",
    },
    Bug {
        breaks: "promise_11_tail",
        text: "beats <= shifted;",
        becomes: "beats <= shifted & 17'h1ffff >> 1;",
    },
    Bug {
        breaks: "promise_12_whose_time_slot",
        text: "number + ONE_AXIS",
        becomes: "number + ONE_AXIS + ONE_AXIS",
    },
    Bug {
        breaks: "promise_12_one_hot_is_the_axis",
        text: "(one_hot << BY_ONE) | (one_hot >> TO_TOP)",
        becomes: "one_hot",
    },
    Bug {
        breaks: "promise_12_one_after_the_other",
        text: "axis_next = axis_to_come;",
        becomes: "axis_next = number;",
    },
    Bug {
        breaks: "promise_15_last",
        text: "is_last = ends;",
        becomes: "is_last = axis_one_hot[0];",
    },
    Bug {
        breaks: "promise_15_two_clocks_to_count_the_tick",
        text: "beats[12] & !ends",
        becomes: "beats[13] & !ends",
    },
    Bug { breaks: "promise_13_inactive", text: "beats = 17'd0;", becomes: "beats = 17'd1;" },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let case = |(build, verilog): (EngineBuild, _)| Case {
        name: format!("{} clocks", build.timebase.clocks_per_tick()),
        dut: "carrystep_time_slot".into(),
        parameters: Vec::new(),
        verilog,
        numbers: vec![axes(&build), ("CLOCKS", build.timebase.clocks_per_tick().to_string())],
    };
    Proof {
        module: "time_slot",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/time_slot/promises.sv"),
        },
        cases: [small_engine(6, 96, 16, LimitWiring::Pair), built.clone()]
            .into_iter()
            .map(case)
            .collect(),
        depth: 1,
        reach: 24,
        bugs: BUGS,
    }
}
