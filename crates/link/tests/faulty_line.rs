//! Soak tests on a faulty line, which flips, drops, repeats, cuts off and delays bytes in both
//! directions. No damaged frame is accepted, no segment is lost or executed twice, and the order is
//! kept. Clients in Rust and in C talk to a gateware in miniature.

use crate::repeats;
use crate::support::c_library::CClient;
use crate::support::client::{Client, RustClient};
use crate::support::device::Bugs;
use crate::support::random::{Random, program};
use crate::support::soak::{Outcome, Soak, TICKS, soak};
use crate::support::wire::Faults;
use proptest::prelude::*;

const AXES: u8 = 6;

/// Runs a program whose segments are so long that the queues do not run empty while the line
/// repeats frames.
fn run(client: &mut dyn Client, segments: usize, seed: u64, faults: Faults) -> Outcome {
    let commands = program(&mut Random::new(seed), AXES, segments, 20 * TICKS);
    let outcome = soak(client, &commands, Soak { faults, seed, axes: AXES, bugs: Bugs::default() });
    outcome.unwrap_or_else(|words| panic!("seed {seed}: {words}"))
}

#[test]
fn rust_client_survives_many_frames() {
    let segments = repeats::part(100_000, 4);
    let outcome = run(&mut RustClient::default(), segments, 1, Faults::BAD);
    println!("{outcome:?}");
    assert_eq!(outcome.fault, None);
    let frames = segments as u64;
    assert!(
        outcome.frames >= frames
            && outcome.damaged > frames / 34
            && outcome.repeated > frames / 100,
        "{outcome:?}"
    );
}

#[test]
fn c_client_survives_ten_thousand_frames() {
    let outcome = run(&mut CClient::shared(), 10_000, 2, Faults::BAD);
    println!("{outcome:?}");
    assert_eq!(outcome.fault, None);
    assert!(
        outcome.frames >= 10_000 && outcome.damaged > 300 && outcome.repeated > 100,
        "{outcome:?}"
    );
}

#[test]
fn clean_line_repeats_nothing_and_keeps_the_queues_full() {
    for client in [&mut RustClient::default() as &mut dyn Client, &mut CClient::shared()] {
        let outcome = run(client, 2000, 3, Faults::default());
        assert_eq!(
            (outcome.fault, outcome.damaged, outcome.repeated, outcome.out_of_turn),
            (None, 0, 0, 0)
        );
    }
}

fn faults() -> impl Strategy<Value = Faults> {
    (0..8000_u32, 0..8000_u32, 0..8000_u32, 0..60_000_u32, 0..60_000_u32, 0..200_000_u32).prop_map(
        |(flip, drop, double, again, cut, delay)| Faults { flip, drop, double, again, cut, delay },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, ..ProptestConfig::default() })]

    /// On any line, either everything is executed once and in order, or the motion stopped because
    /// a queue ran empty and a prefix of the program was executed. Both clients send the same
    /// bytes.
    #[test]
    fn any_line_executes_a_prefix_of_the_program_once_and_in_order(faults in faults(), seed: u64, axes in 1..=8_u8, segments in 1..120_usize) {
        let commands = program(&mut Random::new(seed), axes, segments, 20 * TICKS);
        let how = Soak { faults, seed, axes, bugs: Bugs::default() };
        let rust = soak(&mut RustClient::default(), &commands, how).map_err(TestCaseError::fail)?;
        prop_assert!(matches!(rust.fault, None | Some(6)), "{rust:?}");
        let c = soak(&mut CClient::shared(), &commands, how).map_err(TestCaseError::fail)?;
        prop_assert_eq!((rust.milliseconds, rust.frames, rust.harmed), (c.milliseconds, c.frames, c.harmed));
    }
}
