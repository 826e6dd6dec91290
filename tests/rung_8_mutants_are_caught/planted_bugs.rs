//! Bugs planted in the gateware's Verilog, in the model's arithmetic and in the plan, each
//! of which a rung must catch. The test fails if a bug is not caught, and also if it can no longer
//! be planted because the text that it changes no longer exists.

use carrystep_core::{Command, Program, Segment, StartPhase};
use carrystep_files::PathKind;
use carrystep_plan::Plan;
use carrystep_simulators::{Job, Level, run_verilog};
use carrystep_tests::lockstep::{self, Record};
use carrystep_tests::moves;

/// A change of the exported Verilog: description, original text and replacement.
struct Bug {
    name: &'static str,
    text: &'static str,
    becomes: &'static str,
}

/// The bugs that rung 5 must catch, which is the lock-step of the exported Verilog with the model.
const GATEWARE: [Bug; 9] = [
    Bug {
        name: "a dropped carry: backward steps never come",
        text: "sum[64] ^ backward",
        becomes: "sum[64] & !backward",
    },
    Bug {
        name: "the new V is added to P instead of the old one",
        text: "{1'b0, position} + {1'b0, speed}",
        becomes: "{1'b0, position} + {1'b0, faster}",
    },
    Bug {
        name: "a segment is loaded one tick late",
        text: "active & (left == ONE)",
        becomes: "active & (left == 32'd0)",
    },
    Bug {
        name: "the gap is one clock short",
        text: "BUSY_LOAD = ",
        becomes: "BUSY_LOAD = ((STEP_HIGH + STEP_LOW) == 32'd5) ? 17'd3 : ",
    },
    Bug {
        name: "the hold is one clock short",
        text: "HOLD_LOAD = ",
        becomes: "HOLD_LOAD = (DIR_HOLD == 32'd40) ? 16'd38 : ",
    },
    Bug {
        name: "the set-up is one clock short",
        text: "SETUP_LOAD = ",
        becomes: "SETUP_LOAD = (DIR_SETUP == 32'd20) ? 16'd18 : ",
    },
    Bug {
        name: "the bisection halves without the sign",
        text: "(bisect_v >> BY_ONE) | (bisect_v & SIGN)",
        becomes: "bisect_v >> BY_ONE",
    },
    Bug {
        name: "A does not change within a segment",
        text: "accel <= accel + jerk;",
        becomes: "accel <= accel;",
    },
    Bug { name: "an overrun is not latched", text: "late <= 1'b1;", becomes: "late <= late;" },
];

/// A fixed program with a little of everything: reversals, jerk, one-tick segments, steps too fast
/// for the pins, a queue that runs dry, a clear.
fn program() -> Program {
    let segment = |axis: u8, ticks, v, a, j, last| Command::Segment {
        axis,
        segment: Segment { ticks, v, a, j, last },
    };
    let mut program = Program::new();
    // A reversal directly behind a step and directly before the next: the hold time delays DIR, and
    // the set-up time delays the step.
    for axis in [2, 3] {
        program.push(segment(axis, 2, 1 << 62, 0, 0, false));
    }
    program.push(Command::Start { mask: 0b1100 });
    for axis in [2, 3] {
        program.push(segment(axis, 60, -(1 << 60), 0, 0, true));
    }
    program.push(Command::Wait { clocks: 1200 });
    for axis in 0..6 {
        program.push(segment(axis, 150, 3 << 59, -(1 << 54), 0, false));
    }
    program.push(Command::Start { mask: 0x3f });
    for axis in 0..6 {
        program.push(segment(axis, 1, -(1 << 60), 0, 0, false));
    }
    for axis in 0..6 {
        program.push(segment(axis, 120, -(1 << 61), 1 << 56, -(1 << 49), true));
    }
    program.push(Command::Wait { clocks: 6000 });
    // This is faster than the pin timing of axis 3 allows: one step is held back, then an overrun
    // occurs.
    program.push(segment(2, 90, -(1 << 61), 1 << 40, 0, false));
    program.push(segment(3, 60, i64::MAX - 5, -(1 << 40), 0, false));
    program.push(Command::Start { mask: 0b1100 });
    program.push(Command::Wait { clocks: 3000 });
    program.push(Command::Clear);
    for axis in 0..6 {
        program.push(segment(axis, 40, 1 << 60, 1 << 50, 0, true));
    }
    program.push(Command::Start { mask: 0x3f });
    program
}

fn in_icarus(verilog: &str, job: &Job<'_>) -> Record {
    let mut changes = Vec::new();
    let outcome = run_verilog(Level::Icarus, verilog, job, &mut |cycle, outputs| {
        changes.push((cycle, *outputs));
    });
    Record { changes, outcome: outcome.ok() }
}

#[test]
fn rung_5_catches_each_bug_in_the_gateware() {
    let build = lockstep::tight_build(16, StartPhase::Half);
    let program = program();
    let job = lockstep::job(&build, &program);
    let expected = lockstep::record(Level::Model, &job).expect("the model");
    let verilog = carrystep_verilog::parallel_verilog(&build, 6, "a test").expect("the core");
    assert_eq!(
        lockstep::difference(&expected, &in_icarus(&verilog, &job)),
        None,
        "without a bug nothing may differ"
    );
    for Bug { name, text, becomes } in GATEWARE {
        assert!(verilog.contains(text), "'{name}' cannot be planted: no '{text}' in the Verilog");
        let found = in_icarus(&verilog.replace(text, becomes), &job);
        assert!(
            lockstep::difference(&expected, &found).is_some(),
            "rung 5 does not catch '{name}'"
        );
    }
}

/// A planner that ignores the path: the axes arrive together but do not move along the line.
#[test]
fn checker_rejects_axes_that_leave_the_straight_line() {
    let (file, straight) = moves::shipped("curves");
    let mut free = file.clone();
    free.moves.iter_mut().for_each(|moved| moved.path = PathKind::Free);
    for (file, is_straight) in [(file, true), (free, false)] {
        let plan = carrystep_plan::plan::<f64>(&file).expect("a plan");
        let report = moves::check(&file, &plan, &straight.courses(), &plan.program(), &plan.build);
        let off = report.failures().any(|failure| failure.contains("off its line"));
        assert_eq!((report.passed(), off), (is_straight, !is_straight), "{report}");
    }
}

/// The plan's program with every segment changed.
fn changed(plan: &Plan, mut change: impl FnMut(&mut Segment)) -> Program {
    let mut program = plan.program();
    for command in &mut program {
        if let Command::Segment { segment, .. } = command {
            change(segment);
        }
    }
    program
}

/// Rung 1 is represented by the checker that compares pulses with the float profile.
#[test]
fn rung_1_catches_each_bug_in_the_plan() {
    let (file, plan) = moves::shipped("demo");
    let good = moves::check(&file, &plan, &[], &plan.program(), &plan.build);
    assert!(good.passed(), "without a bug all must hold:\n{good}");

    let half_terms = changed(&plan, |segment| segment.v -= segment.a / 2);
    let longer = changed(&plan, |segment| segment.ticks += u32::from(segment.ticks > 10_000));
    let rounded = changed(&plan, |segment| segment.a = segment.a >> 22 << 22);
    for (name, program) in [
        ("a missing half-term: V is loaded without a/2", half_terms),
        ("long segments one tick too long", longer),
        ("registers of 42 fraction bits", rounded),
    ] {
        assert!(
            !moves::check(&file, &plan, &[], &program, &plan.build).passed(),
            "rung 1 does not catch '{name}'"
        );
    }

    let mut early = plan.build.clone();
    early.pins[3].step_high -= 1;
    early.pins[3].step_low += 1;
    let report = moves::check(&file, &plan, &[], &plan.program(), &early);
    assert!(!report.axes[3].passed, "rung 1 does not catch 'a pulse one clock short'");
}

/// Rung 2 is represented by the closed form, compared with the model's arithmetic with a bug.
#[test]
fn rung_2_catches_each_bug_in_the_arithmetic() {
    use carrystep_tests::closed_form;
    let segment = Segment { ticks: 50, v: 1 << 58, a: 1 << 51, j: -(1 << 46), last: true };
    let run = |order: fn(&mut [i64; 3])| {
        let mut p = 0_i128;
        let mut registers = [segment.v, segment.a, segment.j];
        for _ in 0..segment.ticks {
            p += i128::from(registers[0]);
            order(&mut registers);
        }
        p
    };
    let right = |r: &mut [i64; 3]| (r[0], r[1]) = (r[0] + r[1], r[1] + r[2]);
    let new_a = |r: &mut [i64; 3]| {
        r[1] += r[2];
        r[0] += r[1];
    };
    let no_jerk = |r: &mut [i64; 3]| r[0] += r[1];
    let exact = closed_form::distance(&segment, segment.ticks);
    assert_eq!(num_bigint::BigInt::from(run(right)), exact);
    assert_ne!(
        num_bigint::BigInt::from(run(new_a)),
        exact,
        "rung 2 does not catch 'the new A is added to V'"
    );
    assert_ne!(
        num_bigint::BigInt::from(run(no_jerk)),
        exact,
        "rung 2 does not catch 'J is not added'"
    );
}
