//! Runs the provers. Yosys makes a transition system of Verilog and promises. Yosys-smtbmc with z3
//! proves what holds for ever. Yosys-abc searches runs that reach something (covers, bugs) bit by
//! bit, which is a hundred times faster.

use super::modules::mentioned;
use super::{Case, Promises};
use carrystep_tools::kept;
use carrystep_tools::programs::{Tool, YOSYS, YOSYS_ABC, YOSYS_SMTBMC, Z3};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Output, Stdio};
use thiserror::Error;

/// Time limit for one question in seconds; the slowest takes a tenth of it on an idle machine.
pub(super) const LIMIT: &str = "300";

/// Declares `memory_probe`, which reads a word of a memory inside the exported module. It is used
/// as `memory_probe #("\\dut.words", ABITS, WIDTH) name (1'b0, 1'b1, address, word);`.
const MEMORY_PROBE: &str = r#"
(* blackbox *)
module memory_probe #(parameter MEMID = "", ABITS = 1, WIDTH = 1)
    (input wire CLK, input wire EN, input wire [ABITS-1:0] ADDR, output wire [WIDTH-1:0] DATA);
endmodule
"#;

/// After `flatten` the memory has its own name, and a `memory_probe` becomes one more read port of
/// it.
const PROBES_ARE_READ_PORTS: &str = "setparam -set CLK_ENABLE 0 -set CLK_POLARITY 0 -set TRANSPARENT 0 t:memory_probe\n\
     chtype -set $memrd t:memory_probe\n";

/// Conversion of the system to gates; flip-flops without a value at configuration may have any
/// value. `undriven` is what a wire without a driver is: `-anyseq` or `-zero`.
///
/// Yosys does not simplify the gates, because ABC does so while it unrolls them: for a bug of the
/// parallel core, the conversion took 10.7 s with simplification and takes 2.3 s without. It only drops
/// what selects between words of a memory by bits of an address that are constant, which is most of a
/// small engine.
pub(super) fn to_gates(undriven: &str) -> String {
    format!(
        "opt_clean -purge\nmemory_map\nopt_expr\nopt_clean -purge\nsimplemap\ntechmap\ndffunmap\n\
         setundef -undriven {undriven}\naigmap\nwrite_aiger -zinit promises.aig\n"
    )
}

/// The reason why there is no answer, or not the expected one.
#[derive(Debug, Error)]
pub enum ProofError {
    /// A tool is not installed.
    #[error("{} is not installed: {} installs it", .0.name, .0.ways())]
    Missing(Tool),
    /// A tool failed.
    #[error("{tool} failed: {said}")]
    Tool {
        /// The name of the tool.
        tool: &'static str,
        /// The output of the tool.
        said: String,
    },
    /// An assertion of the file is missing in the input of the solver.
    #[error("{0} was lost on the way to the solver")]
    Lost(&'static str),
    /// The solver gave another answer than the expected one.
    #[error("the solver does not agree:\n{0}")]
    Refuted(String),
    /// Reading or writing a file failed.
    #[error(transparent)]
    Io(#[from] std::io::Error),
}

/// A question to a solver.
#[derive(Debug, Clone, Copy)]
pub enum Question {
    /// Everything holds in the first clocks (their number).
    Base(u32),
    /// If everything held for k clocks, it holds in the next one.
    Induction(u32),
    /// Every cover is reached within this number of clocks.
    Covers(u32),
    /// This single promise fails within this number of clocks.
    Fails(&'static str, u32),
    /// Any of the promises fails within this number of clocks.
    Broken(u32),
}

/// Fails if a tool is missing.
pub fn tools() -> Result<(), ProofError> {
    for tool in [YOSYS, YOSYS_SMTBMC, YOSYS_ABC, Z3] {
        let started = Command::new(tool.name)
            .arg("--help")
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        started.map_err(|_| ProofError::Missing(tool))?;
    }
    Ok(())
}

/// Asks one question about one case. `Ok` is the expected answer.
pub fn ask(promises: &Promises, case: &Case, question: Question) -> Result<(), ProofError> {
    let dir = tempfile::tempdir()?;
    let text = match question {
        Question::Covers(_) => promises.covers_as_assertions(),
        _ => promises.text.to_owned(),
    };
    let verilog = mentioned(&case.verilog, &format!("{} {text}", case.dut));
    fs::write(dir.path().join("exported.v"), verilog)?;
    fs::write(dir.path().join("promises.sv"), text)?;
    fs::write(dir.path().join("memory_probe.sv"), MEMORY_PROBE)?;
    fs::write(dir.path().join("prove.ys"), script(promises, case, question))?;
    let (fine, said) = run(dir.path(), YOSYS, &["-q", "prove.ys"])?;
    if !fine {
        return Err(ProofError::Tool { tool: "yosys", said });
    }
    let (wanted, said) = match question {
        Question::Base(clocks) => holds(promises, dir.path(), &["-t", &clocks.to_string()])?,
        Question::Induction(depth) => {
            holds(promises, dir.path(), &["-i", "-t", &depth.to_string()])?
        }
        Question::Covers(clocks) => reached(dir.path(), clocks, promises.covers().len())?,
        Question::Fails(_, clocks) => reached(dir.path(), clocks, 1)?,
        Question::Broken(clocks) => any_reached(dir.path(), clocks)?,
    };
    if wanted { Ok(()) } else { Err(ProofError::Refuted(said)) }
}

/// Returns whether z3 proves all assertions, and its output.
fn holds(promises: &Promises, dir: &Path, question: &[&str]) -> Result<(bool, String), ProofError> {
    nothing_lost(promises, &fs::read_to_string(dir.join("promises.smt2"))?)?;
    // With one equation per clock instead of the solver's functions over states, minutes become
    // seconds.
    let mut arguments = vec!["-s", "z3", "--unroll", "--noprogress", "--timeout", LIMIT];
    arguments.extend(question);
    arguments.push("promises.smt2");
    let passed = |said: &str| {
        let trouble = ["ERROR", "UNKNOWN", "unknown"].into_iter().any(|what| said.contains(what));
        said.contains("Status: PASSED") && !trouble
    };
    let (fine, said) = run_until(dir, YOSYS_SMTBMC, &arguments, passed)?;
    Ok((fine && passed(&said), said))
}

/// Returns whether all `count` assertions fail within this number of clocks, and the output of the
/// tool.
pub(super) fn reached(dir: &Path, clocks: u32, count: usize) -> Result<(bool, String), ProofError> {
    // They are asked one after the other: asked for all at once, bmc3 of ABC 1.01 may crash.
    let ask = |output| {
        format!("read_aiger promises.aig; fold; cone -s -O {output}; bmc3 -F {clocks} -T {LIMIT}")
    };
    let commands: Vec<String> = (0..count).map(ask).collect();
    let all = |said: &str| count > 0 && said.matches("was asserted in frame").count() == count;
    let (fine, said) = run_until(dir, YOSYS_ABC, &["-c", &commands.join("; ")], all)?;
    Ok((fine && all(&said), said))
}

/// Returns whether any assertion fails within this number of clocks, and the output of the tool.
fn any_reached(dir: &Path, clocks: u32) -> Result<(bool, String), ProofError> {
    let ask = format!("read_aiger promises.aig; fold; orpos; bmc3 -F {clocks} -T {LIMIT}");
    let is_reached = |said: &str| said.contains("was asserted in frame");
    let (fine, said) = run_until(dir, YOSYS_ABC, &["-c", &ask], is_reached)?;
    Ok((fine && is_reached(&said), said))
}

/// The commands of yosys: they read the unchanged exported text and the promises, and name the
/// internal signals that the promises refer to.
fn script(promises: &Promises, case: &Case, question: Question) -> String {
    let mut text = "read_verilog -sv exported.v memory_probe.sv\n".to_owned();
    for (name, value) in &case.parameters {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "chparam -set {name} {value} {}", case.dut);
    }
    let _ = write!(text, "read_verilog -formal -sv -D DUT={}", case.dut);
    for (name, number) in &case.numbers {
        // Writing to a string cannot fail.
        let _ = write!(text, " -D {name}={number}");
    }
    if matches!(question, Question::Base(_) | Question::Induction(_)) {
        text.push_str(" -D INVARIANTS");
    }
    text.push_str(" promises.sv\nhierarchy -check -top promises\nproc\nflatten\n");
    for (name, signal) in promises.inside(case.axes(), case.lanes()) {
        let _ = writeln!(text, "connect -set {name} {signal}");
    }
    text.push_str(PROBES_ARE_READ_PORTS);
    for signal in promises.free(case.lanes()) {
        let _ = writeln!(text, "cutpoint w:{signal}");
    }
    // Two assertions that have become identical would be merged, and one label would be lost.
    text.push_str("setattr -set keep 1 t:$assert t:$cover\n");
    // No wire may be undriven: it would be arbitrary, and a proof about it would mean nothing. The
    // register behind a memory must stay a register: a synchronous read port would be arbitrary
    // while it reads a word that is being written.
    text.push_str("check -assert\nprep -nordff -top promises\n");
    // Everything that is not asked is deleted, together with the part of the module that only it
    // uses.
    text.push_str(&match question {
        Question::Covers(_) => "delete t:$assert c:cover_* %d\n".to_owned(),
        Question::Fails(label, _) => format!("delete t:$cover\ndelete t:$assert c:{label} %d\n"),
        Question::Base(_) | Question::Induction(_) | Question::Broken(_) => {
            "delete t:$cover\n".to_owned()
        }
    });
    text.push_str(&match question {
        Question::Base(_) | Question::Induction(_) => {
            "opt_clean -purge\nwrite_smt2 promises.smt2\n".to_owned()
        }
        Question::Covers(_) | Question::Fails(..) | Question::Broken(_) => to_gates("-anyseq"),
    });
    text
}

/// Checks that every label of the file is in the transition system.
fn nothing_lost(promises: &Promises, system: &str) -> Result<(), ProofError> {
    let there = |label: &&str| {
        system.lines().any(|line| {
            line.starts_with("; yosys-smt2-assert ") && line.ends_with(&format!(" {label}"))
        })
    };
    match promises.labels().into_iter().find(|label| !there(label)) {
        Some(label) => Err(ProofError::Lost(label)),
        None => Ok(()),
    }
}

/// Runs a tool; returns whether it succeeded, and its output.
pub(super) fn run(
    dir: &Path,
    tool: Tool,
    arguments: &[&str],
) -> Result<(bool, String), ProofError> {
    run_until(dir, tool, arguments, |_| true)
}

/// The same for a tool whose answer is kept only where it is a complete one: a solver may run out
/// of time.
pub(super) fn run_until(
    dir: &Path,
    tool: Tool,
    arguments: &[&str],
    is_complete: impl Fn(&str) -> bool,
) -> Result<(bool, String), ProofError> {
    let said = |output: &Output| {
        let said = [&output.stdout[..], &output.stderr].concat();
        String::from_utf8_lossy(&said).into_owned()
    };
    let output = kept::output(&tool, dir, arguments, |output| is_complete(&said(output)));
    let output = output.map_err(|_| ProofError::Missing(tool))?;
    Ok((output.status.success(), said(&output)))
}
