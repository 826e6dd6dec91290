//! Proves in one miter (`crates/hdl/src/engine/equals_axes.sv`) that the exported engine equals the
//! exported parallel axes: the same pins from the first word to the last step of a move, for any
//! numbers in its segments.
//!
//! The proof is bounded to a fixed number of ticks. The move is unrolled completely from
//! configuration on, and sweeping (`&fraig` of ABC) merges what both sides share: their sums are
//! the same sums, and so are those of the two bisections, complemented or not. The cores are equal
//! if nothing is left of the miter. A planted bug is treated in the same way.

use super::builds::{small, small_engine};
use super::solver::{LIMIT, ProofError, reached, run, run_until, to_gates};
use super::{Bug, Case, Promises};
use carrystep_core::engine::LimitWiring;
use carrystep_core::{AXES, Build, PinTiming};
use carrystep_tools::programs::{YOSYS, YOSYS_ABC};
use carrystep_verilog::{parallel_name, parallel_verilog};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::sync::Arc;

/// The assertions about both cores, and the covers.
pub const EQUAL: Promises =
    Promises { text: include_str!("../../../crates/hdl/src/engine/equals_axes.sv") };

/// A move of two segments on engine and parallel axes.
pub struct Move {
    /// The engine, and the parameters of the miter.
    pub engine: Case,
    /// The Verilog of the parallel axes.
    pub axes: Arc<str>,
    /// Clocks from configuration until the pins have done everything.
    pub clocks: u32,
}

/// The question about a move.
#[derive(Debug, Clone, Copy)]
pub enum Asked {
    /// The cores are equal for any numbers.
    Equal,
    /// Every cover is reached.
    Covers,
    /// The cores differ, and this assertion fails.
    Differ(&'static str),
}

/// Mask of the bits of V, A and J that are arbitrary: all.
const ALL: u64 = u64::MAX;
/// The top bits, and those around the boundary of the halves.
const SEAM: u64 = 0xff00_000f_c000_0000;

/// Every move that is compared: the shortest ticks for one and two axes, and for 16 phases.
pub fn moves() -> Vec<Move> {
    vec![
        new_move(2, 32, 16, [2, 2], SEAM),
        new_move(1, 32, 16, [2, 3], SEAM),
        new_move(1, 16, 4, [2, 2], ALL),
    ]
}

/// The move in which bugs are searched, which uses all four bits of the phase count. The last of
/// [`moves`] has the covers.
pub fn move_with_bugs() -> Move {
    new_move(1, 32, 16, [2, 2], SEAM)
}

/// The bugs that must be detected, with their modules.
pub const BUGS: &[(&str, Bug)] = &[
    (
        "adder",
        Bug { breaks: "equal_step", text: "beat[10]) & carry_2)", becomes: "beat[10]) & carry_1)" },
    ),
    (
        "adder",
        Bug { breaks: "equal_step", text: "if (!crosses_now) begin", becomes: "if (!top) begin" },
    ),
    (
        "store",
        Bug { breaks: "equal_step", text: "read_word = A_HIGH;", becomes: "read_word = A_LOW;" },
    ),
    (
        "event_wheel",
        Bug {
            breaks: "equal_step",
            text: "now = when + ONE_TICK;",
            becomes: "now = when + ONE_TICK + ONE_TICK;",
        },
    ),
    (
        "event_wheel",
        Bug { breaks: "equal_dir", text: "SIGN_KIND | LAST_PHASE;", becomes: "SIGN_KIND;" },
    ),
    (
        "queue",
        Bug {
            breaks: "equal_faults",
            text: "lasts_write_data = SET;",
            becomes: "lasts_write_data = UNSET;",
        },
    ),
    ("queue", Bug { breaks: "equal_stops", text: "(word[11] | least)", becomes: "word[11]" }),
    (
        "engine",
        Bug {
            breaks: "equal_start",
            text: "decides & !unfed",
            becomes: "decides & supervisor_tick_0 & !unfed",
        },
    ),
];

fn new_move(axes: usize, clocks: u32, phases: u32, ticks: [u32; 2], free: u64) -> Move {
    let (build, engine) = small_engine(axes, clocks, phases, LimitWiring::Pair);
    let mut pins = [PinTiming::SHORTEST; AXES];
    pins[..axes].copy_from_slice(&build.pins);
    let parallel = Build { timebase: build.timebase, pins, ..small(phases).0 };
    let numbers = [
        ("AXES", axes.to_string()),
        ("PARALLEL", parallel_name(axes)),
        ("CLOCKS", clocks.to_string()),
        ("PHASES", phases.to_string()),
        ("TICKS_1", ticks[0].to_string()),
        ("TICKS_2", ticks[1].to_string()),
        ("FREE", format!("64'h{free:x}")),
    ];
    Move {
        engine: Case {
            name: format!(
                "{axes} axes, {clocks} clocks, {phases} phases, {ticks:?} ticks, bits {free:x}"
            ),
            dut: "carrystep_engine".into(),
            parameters: Vec::new(),
            verilog: engine,
            numbers: numbers.into(),
        },
        axes: parallel_verilog(&parallel, axes, "a proof").expect("the axes").into(),
        // One tick without time slots, 16 ticks for the words, 2 until the start, 2 until the pins,
        // and one for the delay of the pins.
        clocks: clocks * (1 + 16 + 2 + ticks[0] + ticks[1] + 3),
    }
}

impl Move {
    /// The same move with a bug planted in a module of the engine.
    pub fn with(&self, module: &str, bug: &Bug) -> Self {
        let module = Case { dut: format!("carrystep_{module}"), ..self.engine.clone() };
        Self {
            engine: Case { dut: self.engine.dut.clone(), ..module.with(bug) },
            axes: self.axes.clone(),
            ..*self
        }
    }
}

/// Asks one question about one move. `Ok` is the expected answer.
pub fn compare(pair: &Move, asked: Asked) -> Result<(), ProofError> {
    let dir = tempfile::tempdir()?;
    let text = match asked {
        Asked::Covers => EQUAL.covers_as_assertions(),
        _ => EQUAL.text.to_owned(),
    };
    let files =
        [("engine.v", &*pair.engine.verilog), ("axes.v", &*pair.axes), ("promises.sv", &*text)];
    for (name, text) in files {
        fs::write(dir.path().join(name), text)?;
    }
    fs::write(dir.path().join("miter.ys"), script(pair, asked))?;
    let (fine, said) = run(dir.path(), YOSYS, &["-q", "miter.ys"])?;
    if !fine {
        return Err(ProofError::Tool { tool: "yosys", said });
    }
    let (wanted, said) = match asked {
        Asked::Equal => swept(dir.path(), pair.clocks, EQUAL.labels().len(), true)?,
        Asked::Covers => reached(dir.path(), pair.clocks, EQUAL.covers().len())?,
        Asked::Differ(_) => swept(dir.path(), pair.clocks, 1, false)?,
    };
    if wanted { Ok(()) } else { Err(ProofError::Refuted(said)) }
}

/// Unrolls and sweeps the miter. Returns whether nothing is left of it (or, if `equal` is false,
/// whether a run fails an assertion), and the output of the tool.
fn swept(
    dir: &Path,
    clocks: u32,
    assertions: usize,
    equal: bool,
) -> Result<(bool, String), ProofError> {
    // The header counts: format, variables, inputs, latches, outputs, gates, assertions.
    let file = fs::read(dir.join("promises.aig"))?;
    let head =
        String::from_utf8_lossy(file.split(|byte| *byte == b'\n').next().unwrap_or_default())
            .into_owned();
    if head.split(' ').nth(6) != Some(&*assertions.to_string()) {
        return Ok((false, format!("not {assertions} assertions: {head}")));
    }
    let unrolled =
        format!("read_aiger promises.aig; scleanup; frames -i -F {clocks}; orpos; cleanup");
    let sweep = format!("{unrolled}; &get; &fraig -y; &put; dprove -T {LIMIT}");
    let is_equal = |said: &str| {
        said.lines().find(|line| line.contains("SATISFIABLE")).map(|line| line.starts_with("UN"))
    };
    let (fine, said) = run_until(dir, YOSYS_ABC, &["-c", &sweep], |said| is_equal(said).is_some())?;
    Ok((fine && is_equal(&said) == Some(equal), said))
}

/// The commands of yosys. Each core is flattened separately, because both have modules of the same
/// name; then the miter combines them.
fn script(pair: &Move, asked: Asked) -> String {
    let axes = parallel_name(pair.engine.axes());
    let cores = [("engine.v", &*pair.engine.dut), ("axes.v", &*axes)];
    let mut text = String::new();
    for (file, core) in cores {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "read_verilog -sv {file}\nhierarchy -check -top {core}\nproc\nflatten\ndesign -stash {core}"
        );
    }
    for (_, core) in cores {
        let _ = writeln!(text, "design -copy-from {core} -as {core} {core}");
    }
    text.push_str("read_verilog -formal -sv");
    for (name, number) in &pair.engine.numbers {
        let _ = write!(text, " -D {name}={number}");
    }
    let keep = match asked {
        Asked::Equal => "c:equal_*",
        Asked::Covers => "c:cover_*",
        Asked::Differ(label) => &format!("c:{label}"),
    };
    let _ = writeln!(
        text,
        " promises.sv\nhierarchy -check -top promises\nproc\nflatten\nsetattr -set keep 1 t:$assert t:$cover\n\
         prep -nordff -top promises\ndelete t:$cover\ndelete t:$assert {keep} %d"
    );
    // A port that the miter does not name is 0.
    text + &to_gates("-zero")
}
