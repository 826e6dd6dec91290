//! Rung 2: the model equals the closed form of the arithmetic contract exactly in every tick, and
//! reproduces the golden vectors to the last edge and phase.

use carrystep_core::Segment;
use carrystep_model::parallel::axis::{AxisRegisters, tick};
use carrystep_tests::closed_form;
use carrystep_tests::golden::{Edge, engine_vectors};
use carrystep_tests::programs;
use num_bigint::BigInt;
use proptest::prelude::*;

/// Runs segments back to back from a start value; returns every edge and the final P.
fn edges(p0: u64, segments: &[Segment]) -> (Vec<Edge>, u64) {
    let mut edges = Vec::new();
    let mut queue = segments.iter().copied();
    let mut state = AxisRegisters { waiting: queue.next(), ..AxisRegisters::at_rest(p0) };
    (state, _) = tick(state, true, 4);
    let mut n = 0;
    while state.running {
        state.waiting = state.waiting.or_else(|| queue.next());
        n += 1;
        let (next, output) = tick(state, false, 4);
        edges.extend(output.step.map(|step| (n, step.phase, if step.backward { -1 } else { 1 })));
        state = next;
    }
    (edges, state.p)
}

#[test]
fn golden_vectors_to_the_last_edge_and_phase() {
    for case in engine_vectors() {
        let (edges, p) = edges(case.p0(), &case.segments());
        case.assert_edges(&edges);
        assert_eq!(p, case.p_end(), "{}: P at the end", case.name);
        assert_eq!(
            case.segments().iter().map(|s| u64::from(s.ticks)).sum::<u64>(),
            case.total_ticks
        );
    }
}

/// A program in G-code: P before every tick, all its steps, and P at the end.
#[test]
fn job_equals_the_closed_form_and_ends_where_it_began() {
    let job = carrystep_tests::gcode_job::short();
    let half = 1_u64 << 63;
    let mut steps = 0;
    for axis in 0..job.machine.axes.len() {
        let segments = job.segments(axis);
        let (edges, p) = edges(half, &segments);
        assert_eq!(p, half, "axis {axis}: P at the end");
        let signed: i64 = edges.iter().map(|&(.., step)| i64::from(step)).sum();
        assert_eq!(signed, job.survey.axes[axis].steps(), "axis {axis}");
        steps += edges.len() as u64;
        // The whole part of P changes exactly in the ticks that have an edge.
        let (mut at, mut next) = (BigInt::from(half), edges.iter());
        let mut tick = 0_u64;
        for s in &segments {
            for n in 0..s.ticks {
                tick += 1;
                let whole = |n| {
                    num_integer::Integer::div_floor(
                        &(&at + closed_form::distance(s, n)),
                        &(BigInt::from(1) << 64),
                    )
                };
                let changed = whole(n + 1) - whole(n);
                if changed != BigInt::from(0) {
                    let &(found, _, step) = next.next().expect("an edge");
                    assert_eq!((found, BigInt::from(step)), (tick, changed), "axis {axis}");
                }
            }
            at += closed_form::distance(s, s.ticks);
        }
        assert!(next.next().is_none(), "axis {axis} has too many edges");
    }
    assert_eq!(steps, job.steps());
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// P and V before every tick equal the closed form, and a step occurs where the whole part
    /// changes.
    #[test]
    fn every_tick_equals_the_closed_form(p0 in any::<u64>(), segment in programs::segment()) {
        let mut state = AxisRegisters { waiting: Some(Segment { last: true, ..segment }), ..AxisRegisters::at_rest(p0) };
        (state, _) = tick(state, true, 4);
        let unit = BigInt::from(1) << 64;
        for n in 0..segment.ticks {
            let exact = closed_form::speed(&segment, n);
            if exact.magnitude() >= BigInt::from(i64::MAX).magnitude() {
                break; // The formula holds until an overspeed; rungs 4 and 5 compare what follows.
            }
            prop_assert_eq!(BigInt::from(state.v), exact);
            let before = BigInt::from(p0) + closed_form::distance(&segment, n);
            let after = BigInt::from(p0) + closed_form::distance(&segment, n + 1);
            let whole = |x: &BigInt| num_integer::Integer::div_floor(x, &unit);
            let (next, output) = tick(state, false, 4);
            let stepped = output.step.map_or(0, |step| if step.backward { -1 } else { 1 });
            prop_assert_eq!(whole(&after) - whole(&before), BigInt::from(stepped));
            prop_assert_eq!(BigInt::from(next.p), num_integer::Integer::mod_floor(&after, &unit));
            state = next;
        }
    }

    /// The phase differs by less than one phase from the exact crossing of the straight line
    /// through the tick.
    #[test]
    fn the_phase_is_the_last_one_before_the_crossing(p in any::<u64>(), v in 1_i64..i64::MAX, q_bits in prop::sample::select(vec![0_u32, 2, 4])) {
        for v in [v, -v] {
            if carrystep_model::parts::phase::crosses(p, v) {
                let phase = carrystep_model::parts::phase::bisect(p, v, q_bits);
                let at = |q: u32| i128::from(p) + (i128::from(v) >> q_bits) * i128::from(q);
                // The bisection uses 32 of 64 bits and loses one unit by rounding in each halving.
                let slack = 5 << 32;
                let crossed = |x: i128| if v > 0 { x - slack >= 1 << 64 } else { x + slack < 0 };
                let not_yet = |x: i128| if v > 0 { x + slack < 1 << 64 } else { x - slack >= 0 };
                prop_assert!(!crossed(at(phase)), "phase {} is after the crossing", phase);
                prop_assert!(!not_yet(at(phase + 1)), "phase {} is not the last before the crossing", phase);
            }
        }
    }
}
