//! The proof of the schedule of time slots of several adders.

use super::builds::{axes, engines_on_adders, lanes};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::engine::EngineBuild;

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_11_every_axis_once_a_tick",
        text: "(beats[12] & !ends)",
        becomes: "beats[12]",
    },
    Bug {
        breaks: "promise_11_beats_of_a_time_slot",
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
        text: "axis_to_come = number + LANES;",
        becomes: "axis_to_come = number + 3'd1;",
    },
    Bug {
        breaks: "promise_12_one_hot_is_the_axis",
        text: "(one_hot << BY_LANES) | (one_hot >> TO_TOP)",
        becomes: "(one_hot << BY_LANES)",
    },
    Bug {
        breaks: "promise_12_every_lane_has_an_axis",
        text: "axis_to_come = FIRST_AXIS;",
        becomes: "axis_to_come = number + LANES;",
    },
    Bug {
        breaks: "promise_12_one_after_the_other",
        text: "axis_next = axis_to_come;",
        becomes: "axis_next = number;",
    },
    Bug {
        breaks: "promise_12_findings_are_told_before_the_strobe",
        text: "(beats[12] & !ends)",
        becomes: "(beats[13] & !one_hot[0])",
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

pub(super) fn proof() -> Proof {
    let case = |(build, verilog): (EngineBuild, _)| {
        let clocks = build.timebase.clocks_per_tick();
        Case {
            name: format!("{} axes on {} in {clocks} clocks", build.axes(), build.adders),
            dut: "carrystep_lane_slots".into(),
            parameters: Vec::new(),
            verilog,
            numbers: vec![axes(&build), lanes(&build), ("CLOCKS", clocks.to_string())],
        }
    };
    Proof {
        module: "lane_slots",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/wide/lane_slots/promises.sv"),
        },
        cases: engines_on_adders().into_iter().map(case).collect(),
        depth: 1,
        reach: 48,
        bugs: BUGS,
    }
}
