//! The proof of the switches' debouncer for each kind of wiring, with and without inputs.

use super::builds::{BuiltEngine, axes, engine_with_inputs, small_engine};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::engine::{EngineBuild, LimitWiring};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_10_hits_only_where_it_samples",
        text: "sampled = begins_round & is_row;",
        becomes: "sampled = is_row;",
    },
    Bug { breaks: "promise_10_stops_by_direction", text: "back ^ row[0]", becomes: "back" },
    Bug {
        breaks: "promise_10_inputs_are_no_limits",
        text: "state_now & !inputs &",
        becomes: "state_now &",
    },
    Bug {
        breaks: "promise_10_interlock",
        text: "inputs & row[0] & axis_one_hot[0]",
        becomes: "inputs & axis_one_hot[0]",
    },
    Bug {
        breaks: "promise_13_reset_forgets_inputs",
        text: "row_written = row | TO_INPUTS;",
        becomes: "row_written = row;",
    },
    Bug { breaks: "promise_15_levels", text: "earlier = word[7];", becomes: "earlier = now;" },
    Bug {
        breaks: "promise_10_stops_by_direction",
        text: "word[6:0] == LAST_SAMPLE",
        becomes: "word[6:0] != LAST_SAMPLE",
    },
    Bug {
        breaks: "promise_10_stops_by_direction",
        text: "if (differs & !flips & !resetting) begin",
        becomes: "if (!flips & !resetting) begin",
    },
    Bug {
        breaks: "promise_12_own_switch_only",
        text: "(sampled & time_slot_ends)",
        becomes: "((sampled | goes) & time_slot_ends)",
    },
    Bug {
        breaks: "promise_13_reset_forgets",
        text: "(word[7] ^ flips) & !resetting",
        becomes: "(word[7] ^ flips)",
    },
    Bug { breaks: "promise_13_inactive", text: "open = 1'b0;", becomes: "open = 1'b1;" },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let wirings = [LimitWiring::Pair, LimitWiring::None, LimitWiring::Each, LimitWiring::One]
        .map(|limits| small_engine(6, 80, 4, limits));
    let with_inputs = engine_with_inputs(6, 80, 4);
    let case = |(build, verilog): (EngineBuild, _)| {
        let guard = &build.guard;
        let wiring = match guard.limits {
            LimitWiring::None => 0,
            LimitWiring::Pair => 1,
            LimitWiring::Each => 2,
            LimitWiring::One => 3,
        };
        let [first, second] = guard.inputs;
        let number = |name, figure: u32| (name, figure.to_string());
        Case {
            name: format!("{:?}, {} samples, {first:?}", guard.limits, guard.debounce),
            dut: "carrystep_switches".into(),
            parameters: Vec::new(),
            verilog,
            numbers: vec![
                axes(&build),
                number("WIRING", wiring),
                number("LOW", guard.limits_low.into()),
                number("SAMPLES", guard.debounce),
                number("EXIST_0", first.exist.into()),
                number("EXIST_1", second.exist.into()),
                number("LOW_0", first.low.into()),
                number("LOW_1", second.low.into()),
            ],
        }
    };
    Proof {
        module: "switches",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/switches/promises.sv"),
        },
        cases: [with_inputs].into_iter().chain(wirings).chain([built.clone()]).map(case).collect(),
        depth: 1,
        reach: 24,
        bugs: BUGS,
    }
}
