//! The proof of the shaper for eleven pin timings, from the shortest to the longest possible one.

use super::builds::{pin_cases, shipped, small};
use super::{Bug, Promises, Proof};

const BUGS: &[Bug] = &[
    Bug {
        breaks: "promise_1_step_high",
        text: "busy != STEP_FALLS_AT)",
        becomes: "busy != STEP_FALLS_AT + BUSY_ONE)",
    },
    Bug {
        breaks: "promise_1_step_high",
        text: "(step_pin & (busy",
        becomes: "(step_pin & !frozen & (busy",
    },
    Bug {
        breaks: "promise_2_step_low",
        text: "& (busy == 17'd0) &",
        becomes: "& (busy <= BUSY_ONE) &",
    },
    Bug {
        breaks: "promise_3_dir_setup",
        text: "setup <= SETUP_LOAD;",
        becomes: "setup <= SETUP_LOAD - TIMER_ONE;",
    },
    Bug {
        breaks: "promise_3_dir_setup",
        text: "setup = DIR_SETUP[15:0] - 16'd1;",
        becomes: "setup = 16'd0;",
    },
    Bug {
        breaks: "promise_4_dir_hold",
        text: "hold <= HOLD_LOAD;",
        becomes: "hold <= HOLD_LOAD - TIMER_ONE;",
    },
    Bug {
        breaks: "promise_5_no_new_edge",
        text: "rise = pending & !frozen",
        becomes: "rise = pending",
    },
    Bug {
        breaks: "promise_5_never_left_high",
        text: "(busy != STEP_FALLS_AT)",
        becomes: "((busy != STEP_FALLS_AT) | frozen)",
    },
    Bug {
        breaks: "promise_6_nothing_lost",
        text: "lost <= lost + TWO;",
        becomes: "lost <= lost + ONE;",
    },
    Bug { breaks: "promise_6_nothing_lost", text: "due <= second;", becomes: "due <= 1'b0;" },
    Bug { breaks: "promise_6_second_is_overrun", text: "late <= 1'b1;", becomes: "late <= late;" },
    Bug {
        breaks: "promise_7_position",
        text: "steps <= steps - ONE;",
        becomes: "steps <= steps + ONE;",
    },
    Bug { breaks: "promise_9_never_late", text: "aim = want_now;", becomes: "aim = dir_pin;" },
    Bug {
        breaks: "promise_9_no_overrun",
        text: "second = due & request;",
        becomes: "second = request;",
    },
    Bug {
        breaks: "promise_11_first_clock_allowed",
        text: "busy <= BUSY_LOAD;",
        becomes: "busy <= BUSY_LOAD + BUSY_ONE;",
    },
    Bug {
        breaks: "promise_11_dir_follows",
        text: "want <= want_now;",
        becomes: "want <= want_back;",
    },
    Bug { breaks: "promise_11_bound", text: "& (dir_pin == first_back)", becomes: "& !dir_pin" },
    Bug { breaks: "promise_13_inactive", text: "step_pin = 1'b0;", becomes: "step_pin = 1'b1;" },
];

pub(super) fn proof() -> Proof {
    let builds = [small(16), shipped()].map(|(build, verilog)| (build.pins.to_vec(), verilog));
    Proof {
        module: "shaper",
        promises: Promises {
            text: include_str!("../../../crates/hdl/src/parts/shaper/promises.sv"),
        },
        cases: pin_cases("carrystep_shaper", &builds),
        depth: 1,
        reach: 20,
        bugs: BUGS,
    }
}
