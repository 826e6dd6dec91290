//! The proof of homing: which axes wait for a limit, and which slow down.

use super::builds::{BuiltEngine, axes, small_engine};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::engine::{EngineBuild, LimitWiring};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_12_waits_as_asked",
        text: "waiting <= waiting & ~axis_one_hot;",
        becomes: "waiting <= waiting;",
    },
    Bug {
        breaks: "promise_12_waits_as_asked",
        text: "if (resetting) begin",
        becomes: "if (resetting & set) begin",
    },
    Bug {
        breaks: "promise_12_waits_in_its_time_slot",
        text: "mine = (waiting & axis_one_hot)",
        becomes: "mine = (waiting)",
    },
    Bug {
        breaks: "promise_12_slows_after_its_own_hit",
        text: "found = hit & mine;",
        becomes: "found = hit;",
    },
    Bug {
        breaks: "promise_12_slows_after_its_own_hit",
        text: "if (!goes_on) begin",
        becomes: "if (goes_on) begin",
    },
    Bug {
        breaks: "promise_12_slows_after_its_own_hit",
        text: "(slowing & axis_one_hot_next)",
        becomes: "(slowing & axis_one_hot)",
    },
    Bug {
        breaks: "promise_12_told_of_its_own_hit",
        text: "caught = found;",
        becomes: "caught = hit;",
    },
    Bug {
        breaks: "promise_13_inactive",
        text: "mine_slows = 1'b0;",
        becomes: "mine_slows = 1'b1;",
    },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let builds = [
        small_engine(6, 80, 4, LimitWiring::Pair),
        small_engine(1, 16, 4, LimitWiring::Pair),
        built.clone(),
    ];
    let case = |(build, verilog): (EngineBuild, _)| Case {
        name: format!("{} axes at {} Hz", build.axes(), build.timebase.clock_hz()),
        dut: "carrystep_homing_control".into(),
        parameters: Vec::new(),
        verilog,
        numbers: vec![axes(&build)],
    };
    Proof {
        module: "homing_control",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/homing_control/promises.sv"),
        },
        cases: builds.map(case).into(),
        depth: 1,
        reach: 40,
        bugs: BUGS,
    }
}
