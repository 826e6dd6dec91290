//! The proof of the limit switches' debouncer for each kind of wiring.

use super::builds::{BuiltEngine, axes, small_engine};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::engine::{EngineBuild, LimitWiring};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_10_hits_only_where_it_samples",
        text: "time_slot_ends & (tick_0 | max)",
        becomes: "time_slot_ends",
    },
    Bug { breaks: "promise_10_stops_by_direction", text: "back ^ max", becomes: "back" },
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
        text: "(samples & (EXIST",
        becomes: "((samples | goes) & (EXIST",
    },
    Bug {
        breaks: "promise_13_reset_forgets",
        text: "(word[7] ^ flips) & !resetting",
        becomes: "(word[7] ^ flips)",
    },
    Bug { breaks: "promise_13_inactive", text: "hit = samples &", becomes: "hit = 1'b1 |" },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let wirings = [LimitWiring::Pair, LimitWiring::None, LimitWiring::Each, LimitWiring::One]
        .map(|limits| small_engine(6, 80, 4, limits));
    let case = |(build, verilog): (EngineBuild, _)| {
        let guard = &build.guard;
        let wiring = match guard.limits {
            LimitWiring::None => 0,
            LimitWiring::Pair => 1,
            LimitWiring::Each => 2,
            LimitWiring::One => 3,
        };
        Case {
            name: format!("{:?}, {} samples", guard.limits, guard.debounce),
            dut: "carrystep_limits".into(),
            parameters: Vec::new(),
            verilog,
            numbers: vec![
                axes(&build),
                ("WIRING", wiring.to_string()),
                ("LOW", u8::from(guard.limits_low).to_string()),
                ("SAMPLES", guard.debounce.to_string()),
            ],
        }
    };
    Proof {
        module: "limits",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/limits/promises.sv"),
        },
        cases: wirings.into_iter().chain([built.clone()]).map(case).collect(),
        depth: 1,
        reach: 16,
        bugs: BUGS,
    }
}
