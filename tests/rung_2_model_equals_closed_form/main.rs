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
