//! The proof of e-stop, watchdog and ENABLE.

use super::builds::{BuiltEngine, small_engine};
use super::{Bug, Case, Promises, Proof};
use carrystep_core::engine::{EngineBuild, LimitWiring};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_5_pressed_for_a_whole_tick",
        text: "now & (held | strobe)",
        becomes: "now & (held | now)",
    },
    Bug {
        breaks: "promise_5_pressed_for_a_whole_tick",
        text: "PRESSED_LOW != 1'b0",
        becomes: "PRESSED_LOW == 1'b0",
    },
    Bug {
        breaks: "promise_10_not_before_its_time",
        text: "silence <= NO_ROUND;",
        becomes: "silence <= ONE_ROUND;",
    },
    Bug {
        breaks: "promise_10_missed_in_time",
        text: "round_over & !silent",
        becomes: "round_over & !silent & idle",
    },
    Bug {
        breaks: "promise_12_one_round_for_all",
        text: "(round + ONE_TICK) & ROUND_BITS",
        becomes: "round ^ ROUND_BITS & {10{idle}}",
    },
    Bug {
        breaks: "promise_13_no_power_in_a_reset",
        text: "(power & !idle)) & !resetting",
        becomes: "(power & !idle))",
    },
    Bug {
        breaks: "promise_12_one_round_for_all",
        text: "if (restarts_round) begin",
        becomes: "if (ending) begin",
    },
    Bug { breaks: "promise_13_inactive", text: "power = 1'b0;", becomes: "power = 1'b1;" },
    Bug {
        breaks: "promise_14_not_before_the_host",
        text: "enable | (power",
        becomes: "kick | enable | (power",
    },
    Bug { breaks: "promise_14_powered_until_idle", text: "power & !idle", becomes: "power & idle" },
    Bug {
        breaks: "promise_14_warm_not_before_its_time",
        text: "if (!power | ending) begin",
        becomes: "if ((!power & idle) | ending) begin",
    },
    Bug { breaks: "promise_14_warm_is_powered", text: "is_warm & power;", becomes: "is_warm;" },
];

pub(super) fn proof(built: &BuiltEngine) -> Proof {
    let case = |(build, verilog): (EngineBuild, _)| {
        let guard = &build.guard;
        let number = |name, figure: u32| (name, figure.to_string());
        Case {
            name: format!("rounds of {} ticks", guard.round),
            dut: "carrystep_supervisor".into(),
            parameters: Vec::new(),
            verilog,
            numbers: vec![
                number("ESTOP_LOW", guard.estop_low.into()),
                number("ROUND", guard.round),
                number("WATCHDOG", guard.watchdog),
                number("WARM", guard.enable),
            ],
        }
    };
    Proof {
        module: "supervisor",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/engine/supervisor/promises.sv"),
        },
        cases: [small_engine(6, 80, 16, LimitWiring::Pair), built.clone()]
            .into_iter()
            .map(case)
            .collect(),
        depth: 1,
        reach: 20,
        bugs: BUGS,
    }
}
