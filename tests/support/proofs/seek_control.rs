//! The proof of the seek: which axes wait for the source, and which have hit it.

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
        breaks: "promise_12_told_of_its_own_hit",
        text: "(axis == origin[2:0])",
        becomes: "(axis != origin[2:0])",
    },
    Bug {
        breaks: "promise_12_slows_after_its_hit",
        text: "(slowing & axis_one_hot_next)",
        becomes: "(slowing & axis_one_hot)",
    },
    Bug {
        breaks: "promise_19_a_hit_ramps_those_that_wait",
        text: "slowing <= slowing | waiting;",
        becomes: "slowing <= ~slowing;",
    },
    Bug {
        breaks: "promise_19_a_hit_stays_until_a_mask_and_rest",
        text: "mine_slows & !goes_on & released",
        becomes: "mine_slows & released",
    },
    Bug {
        breaks: "promise_12_forgives_the_limit_of_its_seek",
        text: "is_source & (mine | mine_slows)",
        becomes: "(mine | mine_slows)",
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
        dut: "carrystep_seek_control".into(),
        parameters: Vec::new(),
        verilog,
        numbers: vec![axes(&build)],
    };
    Proof {
        module: "seek_control",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/seek_control/promises.sv"),
        },
        cases: builds.map(case).into(),
        depth: 1,
        reach: 40,
        bugs: BUGS,
    }
}
