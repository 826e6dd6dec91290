//! The proof of the stops: which cause stops the axes, and how.

use super::builds::{BuiltEngine, axes, causes, small_engine};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::engine::{EngineBuild, LimitWiring};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_5_freezing_call_freezes",
        text: "urgent | (strobe & found_freezing)",
        becomes: "urgent",
    },
    Bug {
        breaks: "promise_5_frozen_until_clear",
        text: "if (wiping | completes) begin",
        becomes: "if (clear) begin",
    },
    Bug {
        breaks: "promise_5_frozen_is_fault",
        text: "calls = urgent |",
        becomes: "calls = (urgent & !pressed) |",
    },
    Bug {
        breaks: "promise_10_silence_stops",
        text: "(strobe & (missed | interlock))",
        becomes: "(strobe & interlock)",
    },
    Bug {
        breaks: "promise_10_first_cause_stays",
        text: "if (calls & !called) begin",
        becomes: "if (calls) begin",
    },
    Bug {
        breaks: "promise_10_first_cause",
        text: "kind <= LIMITED;",
        becomes: "kind <= UNDERRUN;",
    },
    Bug { breaks: "promise_10_first_cause", text: "urgent | (by_host & !ripe)", becomes: "urgent" },
    Bug {
        breaks: "promise_10_ramp_from_the_next_strobe",
        text: "called | found;",
        becomes: "called;",
    },
    Bug { breaks: "promise_10_halts_when_nothing_ran", text: "(slow & !ran)", becomes: "slow" },
    Bug { breaks: "promise_10_clear_is_asked_for", text: "!pins_busy &", becomes: "" },
    Bug { breaks: "promise_10_clear_is_asked_for", text: "!interlock &", becomes: "" },
    Bug {
        breaks: "promise_10_first_cause",
        text: "if (strobe & interlock) begin",
        becomes: "if (strobe & asked) begin",
    },
    Bug {
        breaks: "promise_10_clear_after_a_tick_at_rest",
        text: "clear & settled",
        becomes: "clear & still",
    },
    Bug {
        breaks: "promise_12_any_call_stops_all",
        text: "urgent | ripe | by_host",
        becomes: "urgent | by_host",
    },
    Bug { breaks: "promise_12_clear_is_whole", text: "settled & !wiping &", becomes: "settled &" },
    Bug {
        breaks: "promise_13_reset_clears_too",
        text: "clearing = wiping | stage_2",
        becomes: "clearing = wiping",
    },
    Bug { breaks: "promise_13_inactive", text: "freeze = 1'b0;", becomes: "freeze = 1'b1;" },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let case = |(build, verilog): (EngineBuild, _)| Case {
        name: format!("{:?}", build.guard.limits),
        dut: "carrystep_stops".into(),
        parameters: Vec::new(),
        verilog,
        numbers: vec![
            axes(&build),
            causes(),
            ("LIMIT_FREEZES", u8::from(build.guard.limit_freezes).to_string()),
        ],
    };
    Proof {
        module: "stops",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/stops/promises.sv"),
        },
        cases: [small_engine(6, 80, 16, LimitWiring::Each), built.clone()]
            .into_iter()
            .map(case)
            .collect(),
        depth: 1,
        reach: 20,
        bugs: BUGS,
    }
}
