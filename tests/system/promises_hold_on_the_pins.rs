//! Checks promises 1 to 8 (docs/promises.md) from outside, on the outputs of the clock-by-clock
//! model and of the fast model alone, with random programs, correct and faulty ones, faults and
//! clears.

use carrystep_core::ports::Outputs;
use carrystep_core::{AXES, Build, Command, Faults, Program, StartPhase};
use carrystep_model::parts::shaper;
use carrystep_simulators::{Level, run};
use carrystep_tests::{closed_form, lockstep, programs};
use num_bigint::BigInt;
use num_integer::Integer;
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::TestRunner;

/// The observed history of one axis.
#[derive(Clone, Copy, Default)]
struct Watch {
    step: bool,
    dir: bool,
    rose: Option<u64>,
    fell: Option<u64>,
    turned: u64,
    position: i32,
}

/// Checks one change of the outputs against the promises.
fn watch(
    axes: &mut [Watch; AXES],
    build: &Build,
    cycle: u64,
    outputs: &Outputs,
    frozen_before: bool,
) {
    for (i, axis) in axes.iter_mut().enumerate() {
        let pins = build.pins[i];
        let step = outputs.step >> i & 1 == 1;
        let dir = outputs.dir >> i & 1 == 1;
        let since = |then: u64| cycle - then;
        if dir != axis.dir {
            assert!(
                axis.rose.is_none_or(|rose| since(rose) >= u64::from(pins.dir_hold)),
                "promise 4: dir_hold, axis {i}, cycle {cycle}"
            );
            axis.turned = cycle;
            axis.dir = dir;
        }
        if step && !axis.step {
            assert!(!frozen_before, "promise 5: an edge after a freeze, axis {i}, cycle {cycle}");
            assert!(
                axis.fell.is_none_or(|fell| since(fell) >= u64::from(pins.step_low)),
                "promise 2: step_low, axis {i}, cycle {cycle}"
            );
            assert!(
                since(axis.turned) >= u64::from(pins.dir_setup),
                "promise 3: dir_setup, axis {i}, cycle {cycle}"
            );
            axis.position = axis.position.wrapping_add(if dir { -1 } else { 1 });
            axis.rose = Some(cycle);
        }
        if !step && axis.step {
            let high = axis.rose.map_or(0, since);
            assert!(
                high >= u64::from(pins.step_high),
                "promise 1: step_high, axis {i}, cycle {cycle}"
            );
            axis.fell = Some(cycle);
        }
        axis.step = step;
        assert_eq!(
            outputs.position[i], axis.position,
            "promise 7: position, axis {i}, cycle {cycle}"
        );
        assert!(!outputs.idle || !step, "promise 8: done with STEP high, axis {i}, cycle {cycle}");
    }
}

/// Runs a program and returns the observations, the outputs at the end if the run ended (a host can
/// block itself), and whether a fault occurred.
fn run_and_watch(
    level: Level,
    build: &Build,
    program: &Program,
) -> ([Watch; AXES], Option<Outputs>, bool) {
    let job = lockstep::job(build, program);
    let mut axes = [Watch::default(); AXES];
    let mut frozen = false;
    let mut faulted = false;
    let outcome = run(level, &job, &mut |cycle, outputs| {
        // A rising edge in the first frozen cycle was decided in the cycle before.
        watch(&mut axes, build, cycle, outputs, frozen && outputs.faults.any());
        frozen = outputs.faults.any();
        faulted |= frozen;
    });
    (axes, outcome.ok().map(|outcome| outcome.last), faulted)
}

/// The position of an axis according to its accumulator after a program that ran to its end.
fn whole_steps(program: &Program, axis: u8, phase: StartPhase) -> BigInt {
    let distance = |command: &Command| match command {
        Command::Segment { axis: a, segment } if *a == axis => {
            closed_form::distance(segment, segment.ticks)
        }
        _ => BigInt::from(0),
    };
    let sum: BigInt = program.iter().map(distance).sum();
    (sum + phase.start_value()).div_floor(&(BigInt::from(1) << 64))
}

/// The generator must produce every fault, because a test without them would prove nothing.
#[test]
fn random_programs_meet_every_fault() {
    let mut runner = TestRunner::deterministic();
    let build = lockstep::tight_build(16, StartPhase::Half);
    let (mut pulses, mut dir_changes, mut cleared, mut ended) = (0, 0, 0, 0);
    let mut faults = Faults::default();
    for _ in 0..200 {
        let program = programs::program().new_tree(&mut runner).expect("a program").current();
        let mut before = Outputs::default();
        let outcome = run(Level::Model, &lockstep::job(&build, &program), &mut |_, now| {
            pulses += (now.step & !before.step).count_ones();
            dir_changes += (now.dir ^ before.dir).count_ones();
            cleared += u32::from(before.faults.any() && !now.faults.any());
            faults.overrun |= now.faults.overrun;
            faults.overspeed |= now.faults.overspeed;
            faults.underrun |= now.faults.underrun;
            faults.protocol |= now.faults.protocol;
            before = *now;
        });
        ended += u32::from(outcome.is_ok());
    }
    assert!(
        pulses > 5000 && dir_changes > 1000 && cleared > 30,
        "{pulses} pulses, {dir_changes} changes of DIR, {cleared} clears"
    );
    assert!(ended > 150, "only {ended} of 200 programs come to an end");
    assert!(
        faults.overrun.count_ones() >= 1
            && faults.overspeed.count_ones() >= 3
            && faults.underrun == 0x3f
            && faults.protocol,
        "{faults}"
    );
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn promises_hold_whatever_the_host_does(program in programs::program(), zero in any::<bool>(), fast in any::<bool>()) {
        let phase = if zero { StartPhase::Zero } else { StartPhase::Half };
        let build = lockstep::tight_build(16, phase);
        let level = if fast { Level::Fast } else { Level::Model };
        let (axes, last, faulted) = run_and_watch(level, &build, &program);
        prop_assert!(last.is_none_or(|last| last.step == 0), "promise 5: an output is left high");
        if let Some(last) = last.filter(|_| !faulted) {
            prop_assert_eq!(last.discarded, [0; AXES], "promise 6: only a freeze discards");
            for (i, axis) in (0..).zip(&axes) {
                prop_assert_eq!(BigInt::from(axis.position), whole_steps(&program, i, phase), "promise 6: axis {}", i);
            }
        }
    }

    /// Promise 6 at the shaper itself: edges + held-back steps + discarded steps == requested
    /// steps, in every clock.
    #[test]
    fn every_requested_step_is_accounted_for(
        asks in prop::collection::vec((prop::option::weighted(0.2, any::<bool>()), -1_i8..2, prop::bool::weighted(0.05)), 1..400),
        axis in 0..AXES,
    ) {
        let pins = lockstep::tight_build(16, StartPhase::Half).pins[axis];
        let mut state = shaper::ShaperState::at_configuration(pins);
        let (mut asked, mut edges) = (0_u32, 0);
        for (request, sign, frozen) in asks {
            // As on the pins, an overrun freezes.
            let input = shaper::ShaperInput { request, sign, frozen: frozen || state.overrun };
            let next = shaper::clock(state, input, pins);
            asked += u32::from(request.is_some());
            edges += u32::from(next.step && !state.step);
            prop_assert_eq!(edges + u32::from(next.held_back.is_some()) + next.discarded, asked);
            state = next;
        }
    }

    /// Promise 9: at a rate below 1 / (STEP_HIGH + STEP_LOW), with time for DIR_SETUP and DIR_HOLD
    /// at reversals, a second step never arrives while one is held back.
    #[test]
    fn a_rate_that_fits_never_overruns(axis in 0..AXES, runs in prop::collection::vec((1_u32..20, 0_u32..30), 1..10)) {
        let pins = lockstep::tight_build(16, StartPhase::Half).pins[axis];
        let mut state = shaper::ShaperState::at_configuration(pins);
        let mut backward = false;
        for (steps, slack) in runs {
            let quiet = |state: &mut shaper::ShaperState, clocks: u32, backward: bool| {
                for _ in 0..clocks {
                    *state = shaper::clock(*state, shaper::ShaperInput { sign: if backward { -1 } else { 1 }, ..Default::default() }, pins);
                }
            };
            quiet(&mut state, pins.dir_setup + pins.dir_hold, backward);
            for _ in 0..steps {
                let input = shaper::ShaperInput { request: Some(backward), sign: if backward { -1 } else { 1 }, frozen: false };
                state = shaper::clock(state, input, pins);
                prop_assert!(state.step && state.held_back.is_none(), "a step that fits is late");
                quiet(&mut state, pins.step_high + pins.step_low - 1 + slack, backward);
            }
            backward = !backward;
        }
        prop_assert!(!state.overrun && state.discarded == 0);
    }
}
