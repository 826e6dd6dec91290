//! The proof of the seek of several adders: which axes wait for the source, and which have hit it.

use super::builds::{axes, engines_on_adders, lanes};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::engine::EngineBuild;

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_12_waits_as_asked",
        text: "waiting <= waiting & ~found_now;",
        becomes: "waiting <= waiting & ~found_bit_0;",
    },
    Bug {
        breaks: "promise_12_told_of_its_own_hit",
        text: "(number_1 == origin[2:0])",
        becomes: "(number_0 == origin[2:0])",
    },
    Bug {
        breaks: "promise_12_told_of_its_own_hit",
        text: "hits_now = hits_now | hit_1;",
        becomes: "hits_now = hits_now;",
    },
    Bug {
        breaks: "promise_12_slows_after_its_hit",
        text: "slowing & next_one_hot_1",
        becomes: "slowing & one_hot_1",
    },
    Bug {
        breaks: "promise_12_slows_after_its_hit",
        text: "(waiting & FIRST_AXIS_1)",
        becomes: "(waiting & FIRST_AXIS_0)",
    },
    Bug {
        breaks: "promise_12_forgives_the_limit_of_its_seek",
        text: "is_source_1 & (mine_1 | lanes_slow[1])",
        becomes: "is_source_1 & (mine_1 | lanes_slow[0])",
    },
    Bug {
        breaks: "promise_19_a_hit_ramps_those_that_wait",
        text: "slowing <= slowing | waiting;",
        becomes: "slowing <= ~slowing;",
    },
    Bug {
        breaks: "promise_19_all_that_wait_ramp_at_one_strobe",
        text: "slowing <= slowing | waiting;",
        becomes: "slowing <= slowing;",
    },
    Bug {
        breaks: "promise_19_a_hit_stays_until_a_mask_and_rest",
        text: "lanes_slow[1] & !goes_on[1] & released",
        becomes: "lanes_slow[1] & released",
    },
    Bug {
        breaks: "promise_13_inactive",
        text: "lanes_slow = 2'd0;",
        becomes: "lanes_slow = 2'd1;",
    },
    Bug {
        breaks: "promise_13_reset_forgets",
        text: "if (strobe | resetting) begin",
        becomes: "if (strobe) begin",
    },
];

pub(super) fn proof() -> Proof {
    let case = |(build, verilog): (EngineBuild, _)| Case {
        name: format!("{} axes on {}", build.axes(), build.adders),
        dut: "carrystep_lane_seek".into(),
        parameters: Vec::new(),
        verilog,
        numbers: vec![axes(&build), lanes(&build)],
    };
    Proof {
        module: "lane_seek",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/wide/lane_seek/promises.sv"),
        },
        cases: engines_on_adders().into_iter().map(case).collect(),
        depth: 1,
        reach: 40,
        bugs: BUGS,
    }
}
