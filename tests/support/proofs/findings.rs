//! The proof of what the axes of a time slot find: no cause is lost, the lowest axis is told.

use super::builds::{axes, engines_on_adders, lanes};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::engine::EngineBuild;

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_12_told_in_two_clocks",
        text: "tells = ended | again",
        becomes: "tells = ended",
    },
    Bug {
        breaks: "promise_12_no_cause_is_lost",
        text: "all = fast | limits | dries",
        becomes: "all = fast | limits",
    },
    Bug {
        breaks: "promise_12_nothing_is_told_between",
        text: "is_dry = ended & (",
        becomes: "is_dry = (",
    },
    Bug {
        breaks: "promise_12_cause_of_the_lowest_axis",
        text: "ended & ((limits & lowest) != 2'd0)",
        becomes: "ended & (limits != 2'd0)",
    },
    Bug {
        breaks: "promise_12_culprit_is_the_lowest_axis",
        text: "all & (NO_LANES - all)",
        becomes: "all",
    },
    Bug {
        breaks: "promise_12_culprit_is_the_lowest_axis",
        text: "slot << BY_LANE_1",
        becomes: "slot << BY_LANE_0",
    },
    Bug {
        breaks: "promise_12_told_whether_an_axis_runs",
        text: "ran <= runs",
        becomes: "ran <= runs & (too_fast == 2'd0)",
    },
    Bug {
        breaks: "promise_5_freezing_cause_of_any_axis",
        text: "again & (limits != 2'd0)",
        becomes: "again & ((limits & lowest) != 2'd0)",
    },
    Bug { breaks: "promise_13_inactive", text: "again = 1'b0", becomes: "again = 1'b1" },
];

pub(super) fn proof() -> Proof {
    let case = |(build, verilog): (EngineBuild, _)| Case {
        name: format!("{} axes on {}", build.axes(), build.adders),
        dut: "carrystep_findings".into(),
        parameters: Vec::new(),
        verilog,
        numbers: vec![axes(&build), lanes(&build)],
    };
    Proof {
        module: "findings",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/wide/findings/promises.sv"),
        },
        cases: engines_on_adders().into_iter().map(case).collect(),
        depth: 1,
        reach: 12,
        bugs: BUGS,
    }
}
