//! The small design: its pins against a model, its delays against nextpnr's own analysis, and each
//! of its checks.

use crate::delays;
use carrystep_simulators::timed::TimedRun;
use carrystep_simulators::vectors::{Bits, Vectors};
use carrystep_tests::effort;
use carrystep_tools::ice40::{self, NextpnrPart, PlacedDesign};
use carrystep_tools::kept;

const VERILOG: &str = include_str!("small.v");
const TOP: &str = "small_design";
const PART: NextpnrPart<'_> = NextpnrPart { device: "hx1k", package: "tq144" };

/// The clock of the iCEstick.
const CLOCK_HZ: u64 = 48_000_000;
const HALF_PS: u64 = 10_416;

const CYCLES: u64 = 400;

/// The registers of `small.v`.
struct Model {
    first: u8,
    seen: u8,
    count: u16,
    sum: u16,
    word: u16,
    half: u8,
    quarter: u8,
    out: u8,
    words: Vec<u16>,
    halves: Vec<u8>,
    quarters: Vec<u8>,
}

impl Model {
    fn new() -> Self {
        Self {
            first: 0,
            seen: 0,
            count: 0,
            sum: 0,
            word: 0,
            half: 0,
            quarter: 0,
            out: 0,
            words: vec![0; 256],
            halves: vec![0; 512],
            quarters: vec![0; 2048],
        }
    }

    fn clock(&mut self, pins: u8) {
        let (sum, count) = (self.sum, self.count);
        let doubled = u16::from(self.half) << 8 | u16::from(self.half);
        let mixed = (count & 7) << 13 | u16::from(self.quarter) << 11 | count;
        self.out = (sum >> 8) as u8 ^ sum as u8;
        self.sum = if self.seen & 2 != 0 {
            0
        } else {
            sum.wrapping_add(self.word ^ doubled).wrapping_add(mixed)
        };
        self.word = self.words[usize::from(sum >> 2 & 255)];
        self.half = self.halves[usize::from(sum & 511)];
        self.quarter = self.quarters[usize::from(sum & 2047)];
        self.words[usize::from(count & 255)] = sum;
        self.halves[usize::from(count & 511)] = (sum >> 4) as u8;
        if self.seen & 1 != 0 {
            self.quarters[usize::from(count)] = (sum >> 7) as u8 & 3;
            self.count = (count + 37) & 2047;
        }
        (self.seen, self.first) = (self.first, pins);
    }
}

/// Recorded cycles of the model. The pins change at irregular times.
fn recorded(cycles: u64) -> Vectors {
    let mut vectors = Vectors::new([("pins", 2)].as_slice(), [("out", 8)].as_slice());
    vectors.clock = "oscillator";
    let (mut model, mut random) = (Model::new(), 1_u32);
    let mut pins = 0;
    for cycle in 0..cycles {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        // Mostly count; rarely clear the sum.
        pins = match random >> 24 {
            0..8 => 3,
            8..40 => 0,
            40..168 => 1,
            _ => pins,
        };
        let bits = |width, level: u8| Bits::default().and(width, u64::from(level));
        vectors.add(bits(2, pins), bits(8, model.out));
        // The gate of the clock opens in the first cycle.
        if cycle > 0 {
            model.clock(pins);
        }
    }
    vectors
}

struct Small {
    placed: PlacedDesign,
    vectors: Vectors,
}

impl Small {
    fn new() -> Self {
        let netlist = ice40::synthesise(VERILOG, TOP, PART.device).expect("a netlist");
        let placed = netlist.place(PART, CLOCK_HZ, 1).expect("a placed design");
        Self { placed, vectors: recorded(CYCLES) }
    }

    fn run(&self, sdf: &str, half_ps: u64) -> TimedRun {
        let verilog = self.placed.timed(sdf, TOP).expect("Verilog with delays");
        self.vectors.timed(TOP, &verilog, half_ps, CYCLES).expect("Icarus")
    }
}

/// Every how many-th cell or check a test run examines; a long run examines all.
fn stride(usual: usize) -> usize {
    if effort::is_every_board() { 1 } else { usual }
}

/// The flip-flop of the falling edge: its input comes from the rising edge, half a period before.
fn is_of_rising_edge(cell: &str) -> bool {
    !cell.starts_with("open_")
}

#[test]
fn a_small_design_is_in_time_exactly_as_long_as_its_slowest_path() {
    let small = Small::new();
    let sdf = &small.placed.sdf;
    let run = small.run(sdf, HALF_PS);
    assert_eq!((&run.difference, &run.first_violation), (&None, &None));
    assert_eq!(run.cycles, CYCLES);

    // nextpnr's figure holds for every path, also for one that the recording never uses.
    let needs = run.needs_ps.iter().filter(|(cell, _)| is_of_rising_edge(cell));
    let (slowest, &need) = needs.max_by_key(|(_, need)| **need).expect("registers");
    let limit = 1e6 / small.placed.mhz;
    assert!(need as f64 <= limit + 1.0, "{slowest} needs {need} ps, nextpnr says {limit}");
    assert_eq!(small.run(sdf, need.div_ceil(2)).violations, 0, "{slowest} needs {need} ps");
    let fast = small.run(sdf, (need - 1) / 2);
    assert!(fast.violations > 0, "{slowest} needs {need} ps");
    effort::say(&format!("{slowest} needs {need} ps, at most {limit:.0} ps by nextpnr"));

    // The wires to every cell too long by 1 ps. Those to a carry make others late as well.
    let cells = run.needs_ps.iter().filter(|(cell, _)| is_of_rising_edge(cell));
    let cells: Vec<_> = cells.step_by(stride(20)).collect();
    for (cell, need) in &cells {
        let longer = delays::with_longer_wires(sdf, cell, 2 * HALF_PS + 1 - *need);
        let late = small.run(&longer, HALF_PS);
        assert!(late.violations > 0, "{cell} needs {need} ps, and a longer wire is not seen");
    }

    // Every check, as its set-up time becomes so long that any change of its input violates it.
    let checks: Vec<_> = delays::checks(sdf).into_iter().step_by(stride(50)).collect();
    let silent = checks.iter().filter(|check| {
        let strict = delays::with_check(sdf, check, Some((4 * HALF_PS, 0)));
        let first = small.run(&strict, HALF_PS).first_violation;
        !first.is_some_and(|first| first.ends_with(&check.0))
    });
    let silent: Vec<_> = silent.collect();
    assert!(silent.is_empty(), "checks that do not see it: {silent:?}");
    let hold = delays::with_check(sdf, &checks[0], Some((0, HALF_PS)));
    let early = small.run(&hold, HALF_PS).first_violation.expect("a violation");
    assert!(early.starts_with("VIOLATION hold"), "{early}");
    kept::say();
    if effort::is_every_board() {
        effort::figures(&format!(
            "{} cells with longer wires and {} checks of a small design, all seen; it needs {need} ps, at most {limit:.0} ps by nextpnr",
            cells.len(),
            checks.len()
        ));
    }
}

#[test]
fn delays_that_do_not_fit_the_placement_are_refused() {
    let small = Small::new();
    let sdf = &small.placed.sdf;
    let refused =
        |sdf: &str| small.placed.timed(sdf, TOP).map(|_| ()).expect_err("no refusal").to_string();
    let check = delays::checks(sdf).swap_remove(0);
    let dropped = refused(&delays::with_check(sdf, &check, None));
    assert!(dropped.contains(&format!("no check of {}/{}", check.0, check.1)), "{dropped}");
    for (line, why) in [("(IOPATH", "no delay of"), ("(INTERCONNECT", "no delay of the wire")] {
        let less = refused(&delays::without_first(sdf, line));
        assert!(less.contains(why), "{less}");
    }
    let last = sdf.rfind(')').expect("an end");
    for (entry, why) in [
        ("TIMINGCHECK (SETUPHOLD (posedge I0) (posedge CLK) (1:1:1) (0:0:0))", "a check of"),
        ("DELAY (ABSOLUTE (IOPATH I0 O (1:1:1) (1:1:1)))", "a delay of"),
    ] {
        let cell = format!("(CELL (CELLTYPE \"ICESTORM_LC\") (INSTANCE stranger) ({entry}))");
        let more = refused(&format!("{}{cell})", &sdf[..last]));
        assert!(more.contains(&format!("{why} stranger")), "{more}");
    }
}
