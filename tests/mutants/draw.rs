//! Mutants of Verilog, by yosys' `mutate`: named by what is wrong and the line where, drawn evenly over the lines,
//! and all put into one text with an input that chooses.

use carrystep_spec::tool::YOSYS;
use carrystep_synthesis::kept;
use sha2::{Digest, Sha256};
use std::collections::HashMap;
use std::fmt::Write as _;
use std::path::Path;

/// Which mutants are drawn, and on which other bit a conditional one depends.
const SEED: u32 = 2009;

/// To what mutants are made of: no constants, no gates that do nothing, memories as they are.
const PREPARE: &str = "proc; opt -full; memory -nomap; opt -full; wreduce; opt -full";

/// Away with names that no gate needs: mutants are drawn without them, promises look at some.
const PURGE: &str = "opt_clean -purge";

/// Wires that are not logic.
const CLOCKS: [&str; 4] = ["clock", "CLK", "RD_CLK", "WR_CLK"];

/// One change of the netlist.
pub struct Mutant {
    /// What is wrong, and the line of Verilog.
    pub name: String,
    /// Where it is, without `carrystep_`.
    pub module: String,
    /// What yosys is told to make it.
    pub(super) command: String,
}

/// A sample, and the Verilog of them all: `+mutant=N` chooses one by its place, from 1; without it there is none.
pub struct Sample {
    /// The mutants, those first that a shorter sample has too.
    pub mutants: Vec<Mutant>,
    /// The text.
    pub verilog: String,
    /// The engine without a mutant, as yosys keeps it (RTLIL): what a mutant is made of, and compared with.
    pub(super) netlist: String,
}

/// Draws so many mutants.
///
/// Every line of the source has its turn before a line has its second; which comes first is a hash of its name. So a
/// change of one line leaves nearly all other mutants in the sample.
///
/// # Panics
/// Where yosys is missing or fails.
pub fn sample(verilog: &str, top: &str, count: usize) -> Sample {
    let folder = tempfile::tempdir().expect("a folder");
    let read = |name: &str| std::fs::read_to_string(folder.path().join(name)).expect("what yosys has written");
    std::fs::write(folder.path().join("core.v"), verilog).expect("a file");
    // More than there are: all.
    let list = format!("mutate -list 1000000 -seed {SEED} -o list");
    yosys(
        folder.path(),
        &format!("read_verilog core.v; hierarchy -check -top {top}; {PREPARE}; write_rtlil core.il; {PURGE}; {list}"),
    );
    let mutants = draw(candidates(&read("list"), verilog), count);
    let width = usize::BITS - count.leading_zeros();
    let mut script = format!("read_rtlil core.il\n{PURGE}\n");
    for (number, mutant) in (1..).zip(&mutants) {
        // Writing to a string cannot fail.
        let _ = writeln!(script, "mutate -ctrl mutant {width} {number} {}", mutant.command);
    }
    let _ = write!(script, "delete -port {top}/w:mutant\nwrite_verilog -noattr mutants.v\n");
    std::fs::write(folder.path().join("apply.ys"), script).expect("a file");
    yosys(folder.path(), "script apply.ys");
    Sample { mutants, verilog: with_choice(&read("mutants.v"), top, width), netlist: read("core.il") }
}

impl Sample {
    /// The Verilog of one mutant by itself; without one, of the engine as it was taken apart.
    ///
    /// # Panics
    /// Where yosys is missing or fails.
    pub fn alone(&self, mutant: Option<&Mutant>) -> String {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("core.il"), &self.netlist).expect("a file");
        let change = mutant.map(|mutant| format!("mutate {}\n", mutant.command)).unwrap_or_default();
        let script = format!("read_rtlil core.il\n{change}write_verilog -noattr alone.v\n");
        std::fs::write(folder.path().join("alone.ys"), script).expect("a file");
        yosys(folder.path(), "script alone.ys");
        std::fs::read_to_string(folder.path().join("alone.v")).expect("what yosys has written")
    }
}

/// The input that chooses is a variable that is set once: as a port, Verilator would look at it in every clock.
fn with_choice(verilog: &str, top: &str, width: u32) -> String {
    let (wire, top) = (format!("wire [{}:0] mutant;", width - 1), format!("module {top}("));
    let (before, top_module) = verilog.split_at(verilog.find(&top).expect("the top module"));
    assert!(top_module.contains(&wire), "nothing chooses a mutant");
    let choice = format!(
        "reg [{}:0] mutant = 0;\n  integer chosen;\n  initial if ($value$plusargs(\"mutant=%d\", chosen)) mutant = chosen;",
        width - 1
    );
    before.to_owned() + &top_module.replacen(&wire, &choice, 1)
}

pub(super) fn yosys(folder: &Path, script: &str) {
    let output = kept::output(&YOSYS, folder, &["-q", "-p", script], |_| true);
    let output = output.expect("yosys is not installed: `cargo xtask tools` installs it");
    assert!(output.status.success(), "yosys: {}", String::from_utf8_lossy(&output.stderr));
}

/// A mutant and the place that it stands in: module and line.
type Candidate = (Mutant, String);

/// Every mutant that yosys knows.
fn candidates(list: &str, verilog: &str) -> Vec<Candidate> {
    let lines: Vec<&str> = verilog.lines().collect();
    let mut seen: HashMap<String, u32> = HashMap::new();
    let mutants = list.lines().filter_map(|line| {
        let command = line.strip_prefix("mutate ")?;
        let option = |name: &str| command.split(&format!("-{name} ")).nth(1).and_then(|rest| rest.split(' ').next());
        let (module, port) = (option("module")?.trim_start_matches("carrystep_"), option("port")?);
        if CLOCKS.contains(&port) {
            return None;
        }
        let bit = |name: &str| option(name).unwrap_or("0");
        let what = match option("mode")? {
            "inv" => "inverted".to_owned(),
            "const0" => "always 0".to_owned(),
            "const1" => "always 1".to_owned(),
            "cnot0" => format!("inverted where bit {} is 0", bit("ctrlbit")),
            _ => format!("inverted where bit {} is 1", bit("ctrlbit")),
        };
        let wire = option("wire").map(|wire| format!(" ({wire}[{}])", bit("wirebit"))).unwrap_or_default();
        let source = command.rsplit("-src ").next().and_then(|place| place.split(':').nth(1)?.split('.').next());
        let source = source.and_then(|number| lines.get(number.parse::<usize>().ok()?.checked_sub(1)?));
        let source = source.map_or("", |text| text.trim());
        let cell = option("cell").map(kind)?;
        let mut name = format!("{module}: {cell} {port}[{}]{wire} {what}: {source}", bit("portbit"));
        let twins = seen.entry(name.clone()).or_default();
        *twins += 1;
        if *twins > 1 {
            let _ = write!(name, " #{twins}");
        }
        Some((Mutant { name, module: module.to_owned(), command: command.to_owned() }, format!("{module}: {source}")))
    });
    mutants.collect()
}

/// What a cell is: of its name, the part that does not count cells or lines.
fn kind(cell: &str) -> &str {
    cell.strip_prefix('$').and_then(|name| name.split('$').next()).unwrap_or(cell)
}

/// The first of each place, then the second of each, ...
fn draw(candidates: Vec<Candidate>, count: usize) -> Vec<Mutant> {
    let mut ranked: Vec<_> =
        candidates.into_iter().map(|(mutant, place)| (hash(&mutant.name), mutant, place)).collect();
    ranked.sort_by_key(|(hash, ..)| *hash);
    let mut turns: HashMap<String, u32> = HashMap::new();
    let mut ranked: Vec<_> = ranked
        .into_iter()
        .map(|(hash, mutant, place)| {
            let turn = turns.entry(place).or_default();
            *turn += 1;
            (*turn, hash, mutant)
        })
        .collect();
    ranked.sort_by_key(|(turn, hash, _)| (*turn, *hash));
    ranked.into_iter().take(count).map(|(.., mutant)| mutant).collect()
}

fn hash(name: &str) -> [u8; 32] {
    Sha256::digest(format!("{SEED} {name}")).into()
}
