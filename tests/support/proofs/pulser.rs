//! The proof of the engine's pulser for the pin timings of its builds, from the shortest to the
//! longest possible one.

use super::builds::{BuiltEngine, pin_cases, small_engine};
use super::{Bug, Promises, Proof};
use carrystep_core::engine::LimitWiring;

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_1_step_high",
        text: "since != STEP_HIGH_OVER",
        becomes: "since + SINCE_ONE != STEP_HIGH_OVER",
    },
    Bug {
        breaks: "promise_1_step_high",
        text: "(step_pin & (since",
        becomes: "(step_pin & !frozen & (since",
    },
    Bug {
        breaks: "promise_2_step_low",
        text: "!frozen & !busy &",
        becomes: "!frozen & (!busy | (since == STEP_LOW_OVER)) &",
    },
    Bug { breaks: "promise_3_dir_setup", text: "settled <= 1'b0;", becomes: "settled <= settled;" },
    Bug { breaks: "promise_3_dir_setup", text: "settled = 1'b0;", becomes: "settled = 1'b1;" },
    Bug { breaks: "promise_4_dir_hold", text: "held & (since != HOLD_OVER)", becomes: "1'b0" },
    Bug {
        breaks: "promise_5_no_new_edge",
        text: "rise = pending & !frozen",
        becomes: "rise = pending",
    },
    Bug {
        breaks: "promise_5_dir_stays",
        text: "dir_changes = !frozen & !held",
        becomes: "dir_changes = !held",
    },
    Bug {
        breaks: "promise_5_never_left_high",
        text: "(since != STEP_HIGH_OVER)",
        becomes: "((since != STEP_HIGH_OVER) | frozen)",
    },
    Bug {
        breaks: "promise_6_nothing_lost",
        text: "(frozen & pending) | late_now",
        becomes: "frozen & pending",
    },
    Bug { breaks: "promise_6_nothing_lost", text: "!frozen) | second;", becomes: "!frozen);" },
    Bug {
        breaks: "promise_6_second_is_overrun",
        text: "second & !rise & !frozen",
        becomes: "second & !frozen",
    },
    Bug {
        breaks: "promise_7_pulses_as_counted",
        text: "count <= count + change;",
        becomes: "count <= count + ONE;",
    },
    Bug { breaks: "promise_9_never_late", text: "aim = want;", becomes: "aim = dir_pin;" },
    Bug {
        breaks: "promise_9_no_overrun",
        text: "second = due & request;",
        becomes: "second = request;",
    },
    Bug {
        breaks: "promise_11_first_clock_allowed",
        text: "settled | (after == SETUP_OVER)",
        becomes: "settled | (after > SETUP_OVER)",
    },
    Bug {
        breaks: "promise_11_dir_follows",
        text: "want <= sign_back;",
        becomes: "want <= request_back;",
    },
    Bug { breaks: "promise_11_bound", text: "& (dir_pin == first_back)", becomes: "& !dir_pin" },
    Bug { breaks: "promise_13_inactive", text: "step_pin = 1'b0;", becomes: "step_pin = 1'b1;" },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let builds = [small_engine(6, 80, 16, LimitWiring::Pair), built.clone()]
        .map(|(build, verilog)| (build.pins, verilog));
    Proof {
        module: "pulser",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/pulser/promises.sv"),
        },
        cases: pin_cases("carrystep_pulser", &builds),
        depth: 1,
        reach: 20,
        bugs: BUGS,
    }
}
