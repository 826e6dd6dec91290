//! Model, Rust-HDL and exported Verilog are equal in every clock, for random boards and events.

use carrystep_core::SelfTest;
use carrystep_core::link::Uart;
use carrystep_core::self_test::{MAX_ROWS, Rows};
use carrystep_tests::effort;
use carrystep_tests::self_test_bench::{SelfTestBench, module_vectors, record};
use carrystep_tools::kept;
use carrystep_verilog::{SELF_TEST_NAME, self_test_verilog};
use proptest::prelude::*;
use std::ops::Range;

/// A UART with this number of clocks for a bit.
fn uart(bit_clocks: u64) -> Uart {
    Uart::new(bit_clocks * 100_000, 100_000).expect("a UART")
}

/// A self-test with short lines, so that much is said in a few clocks.
fn test(
    outputs: usize,
    inputs: usize,
    fixed: usize,
    half_clocks: u64,
    bit_clocks: u64,
) -> SelfTest {
    let texts = |letter: char, count| (0..count).map(|pin| format!("{letter}{pin}\u{1}")).collect();
    let rows = Rows {
        heading: "h".to_owned(),
        outputs: texts('o', outputs),
        inputs: texts('i', inputs),
        fixed: texts('f', fixed),
    };
    SelfTest::new(uart(bit_clocks), half_clocks, rows).expect("a self-test")
}

/// Clocks after the last event.
const REST: u64 = 20_000;

/// Clocks in which everything is sent that may wait: two lists, and a line of each input.
const SAID: u64 = 80_000;

/// What happens from outside, and the number of clocks before it.
#[derive(Debug, Clone)]
enum Event {
    Byte(u8),
    /// Inverts inputs, of which the mask takes those that exist.
    Invert(u64),
    None,
}

fn events(count: Range<usize>) -> impl Strategy<Value = Vec<(u64, Event)>> {
    let event = prop_oneof![
        2 => any::<u8>().prop_map(Event::Byte),
        3 => (0..64_u32, any::<u64>()).prop_map(|(row, more)| Event::Invert(1 << row | more & more >> 7)),
        1 => Just(Event::None),
    ];
    prop::collection::vec(((0..3000_u64), event), count)
}

fn happen(bench: &mut SelfTestBench, test: &SelfTest, event: &Event) {
    match event {
        Event::Byte(byte) => bench.send(&[*byte]),
        Event::Invert(mask) => bench.pins ^= mask & test.inputs(),
        Event::None => {}
    }
}

/// Runs events, and then `rest` clocks.
fn run(
    bench: &mut SelfTestBench,
    test: &SelfTest,
    events: &[(u64, Event)],
    rest: u64,
    mut seen: impl FnMut(&SelfTestBench),
) {
    for (clocks, event) in events {
        for _ in 0..*clocks {
            bench.clock();
            seen(bench);
        }
        happen(bench, test, event);
    }
    for _ in 0..rest {
        bench.clock();
        seen(bench);
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, ..ProptestConfig::default() })]

    /// Of every board: one output at a time, each for a whole period.
    #[test]
    fn rust_hdl_equals_the_model_and_one_output_at_a_time_is_active(
        outputs in 0..30_usize, inputs in 0..30_usize, fixed in 0..4_usize,
        half in 1..1500_u64, bit_clocks in 8..20_u64, events in events(1..12),
    ) {
        let test = test(outputs, inputs, fixed, half, bit_clocks);
        let mut bench = SelfTestBench::of_both(&test);
        let (mut active, mut since) = (1, 0);
        run(&mut bench, &test, &events, REST, |bench| {
            let now = bench.outputs.active;
            if now != active {
                let next = if active == 1 << outputs { 1 } else { active << 1 };
                assert_eq!(now, next, "after {active:x}");
                assert!(since >= 2 * half, "{active:x} for {since} clocks");
                (active, since) = (now, 0);
            }
            since += 1;
        });
    }

    /// The last line of each input gives its level.
    #[test]
    fn last_line_of_an_input_gives_its_level(
        outputs in 0..6_usize, inputs in 1..20_usize, events in events(1..20),
    ) {
        let test = test(outputs, inputs, 2, 40_000, 8);
        let mut bench = SelfTestBench::of_model(&test);
        run(&mut bench, &test, &events, SAID, |_| ());
        // A list would give all levels: what is sent before it must be enough.
        let text = String::from_utf8_lossy(&bench.text).into_owned();
        for row in test.first_input()..=test.last_input() {
            let level = bench.pins >> row & 1 == 1;
            let last = |level| text.rfind(&test.line(row, level));
            let was_told = last(level) > last(!level);
            let never_changed = level && last(!level).is_none();
            prop_assert!(was_told || never_changed, "row {row}:\n{text}");
        }
    }
}

/// One Verilog for each number of rows that changes the size of the memory, and the widest one.
#[test]
fn exported_verilog_equals_the_model_in_every_clock() {
    for (outputs, inputs, fixed) in [(0, 0, 0), (1, 0, 0), (0, 3, 1), (5, 9, 2), (30, 33, 0)] {
        assert!(outputs + inputs + fixed < MAX_ROWS);
        let test = test(outputs, inputs, fixed, 700, 9);
        let mut bench = SelfTestBench::of_both(&test);
        let mut vectors = module_vectors();
        let all = test.inputs();
        let events = [
            (2000, Event::Invert(all)),
            (9000, Event::Byte(b'?')),
            (40, Event::Invert(all & 0x5555_5555_5555_5555)),
            (3000, Event::Byte(0xc3)),
            (90, Event::Byte(b'\r')),
            (5000, Event::Invert(all)),
        ];
        run(&mut bench, &test, &events, REST, |bench| record(&mut vectors, bench));
        let verilog = self_test_verilog(&test, "a test").expect("its Verilog");
        let compare = |verilog: &str| vectors.difference(SELF_TEST_NAME, verilog).expect("Icarus");
        assert_eq!(compare(&verilog), None, "{outputs} outputs, {inputs} inputs");
        effort::say(&format!("{outputs} outputs, {inputs} inputs: {} clocks", vectors.cycles()));
        if (outputs, inputs) == (5, 9) {
            for (line, other) in [
                ("bits <= bits << BY_ONE", "bits <= bits"),
                ("reported <= reported ^ compared", "reported <= reported"),
                ("asked <= 1'b1", "asked <= 1'b0"),
            ] {
                let planted = verilog.replace(line, other);
                assert!(planted != verilog, "{line} is not there");
                assert!(compare(&planted).is_some(), "{other} is not seen");
            }
        }
    }
    kept::say();
}
