//! Draws mutants of Verilog with yosys' `mutate`. Each is named after its change and its source
//! line. They are drawn evenly over the lines, and all of them are put into one Verilog text with
//! an input that selects one.

use crate::proofs::builds::BuiltEngine;
use carrystep_tools::kept;
use carrystep_tools::programs::YOSYS;
use sha2::{Digest, Sha256};
use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;
use std::path::Path;

/// The seed for the drawing, and for the other bit on which a conditional mutant depends.
const SEED: u32 = 2009;

/// The yosys commands before mutation. They remove constants and gates without effect, so that no
/// mutant changes only those, and keep memories whole.
const PREPARE: &str = "proc; opt -full; memory -nomap; opt -full; wreduce; opt -full";

/// Removes names that no gate needs. Mutants are drawn without them, but promises look at some of
/// them.
const PURGE: &str = "opt_clean -purge";

/// The top module.
pub(super) const TOP: &str = "carrystep_engine";

/// Wires that are clocks and therefore not mutated.
const CLOCKS: [&str; 4] = ["clock", "CLK", "RD_CLK", "WR_CLK"];

/// One change of the netlist.
pub struct Mutant {
    /// The change, and the line of Verilog.
    pub name: String,
    /// Its module, without the prefix `carrystep_`.
    pub module: String,
    /// The yosys command that makes the mutant.
    pub(super) command: String,
}

/// A sample of mutants, and one Verilog text with all of them: `+mutant=N` selects one by its
/// number from 1; without it, none is active.
pub struct Sample {
    /// The mutants. Those that a shorter sample also contains come first.
    pub mutants: Vec<Mutant>,
    /// The Verilog text.
    pub verilog: String,
    /// The engine of which they are mutants.
    pub(super) built: BuiltEngine,
    /// The engine without a mutant in yosys' format (RTLIL). Mutants are made from it and compared
    /// with it.
    pub(super) netlist: String,
}

/// Draws `count` mutants of the places (a module, a colon and a line) for which `is_wanted` holds.
///
/// Every source line is used once before any line is used a second time. A hash of the mutant's
/// name determines the order, so a change of one source line leaves nearly all other mutants in the
/// sample.
///
/// # Panics If yosys is missing or fails.
pub fn sample(built: &BuiltEngine, count: usize, is_wanted: impl Fn(&str) -> bool) -> Sample {
    let folder = tempfile::tempdir().expect("a folder");
    let (netlist, mut candidates) = prepared(&built.1, folder.path());
    candidates.retain(|(_, place)| is_wanted(place));
    let mutants = draw(candidates, count);
    let width = usize::BITS - count.leading_zeros();
    let mut script = format!("read_rtlil core.il\n{PURGE}\n");
    for (number, mutant) in (1..).zip(&mutants) {
        // Writing to a string cannot fail.
        let _ = writeln!(script, "mutate -ctrl mutant {width} {number} {}", mutant.command);
    }
    let _ = write!(script, "delete -port {TOP}/w:mutant\nwrite_verilog -noattr mutants.v\n");
    std::fs::write(folder.path().join("apply.ys"), script).expect("a file");
    yosys(folder.path(), "script apply.ys");
    let verilog = with_choice(&read(folder.path(), "mutants.v"), width);
    Sample { mutants, verilog, built: built.clone(), netlist }
}

/// All places (a module, a colon and a line) where yosys can make a mutant of an engine.
///
/// # Panics If yosys is missing or fails.
pub fn places(built: &BuiltEngine) -> HashSet<String> {
    let folder = tempfile::tempdir().expect("a folder");
    prepared(&built.1, folder.path()).1.into_iter().map(|(_, place)| place).collect()
}

/// The netlist of an engine, also as `core.il` in the folder, and all its mutants.
fn prepared(verilog: &str, folder: &Path) -> (String, Vec<Candidate>) {
    std::fs::write(folder.join("core.v"), verilog).expect("a file");
    // The number is greater than that of all mutants, so yosys lists all of them.
    let list = format!("mutate -list 1000000 -seed {SEED} -o list");
    yosys(
        folder,
        &format!(
            "read_verilog core.v; hierarchy -check -top {TOP}; {PREPARE}; write_rtlil core.il"
        ),
    );
    let netlist = named_by_instance(&read(folder, "core.il"));
    std::fs::write(folder.join("core.il"), &netlist).expect("a file");
    yosys(folder, &format!("read_rtlil core.il; {PURGE}; {list}"));
    let candidates = candidates(&read(folder, "list"), verilog);
    (netlist, candidates)
}

fn read(folder: &Path, name: &str) -> String {
    std::fs::read_to_string(folder.join(name)).expect("what yosys has written")
}

impl Sample {
    /// The Verilog with a single mutant, or of the engine without a mutant.
    ///
    /// # Panics If yosys is missing or fails.
    pub fn alone(&self, mutant: Option<&Mutant>) -> String {
        let folder = tempfile::tempdir().expect("a folder");
        std::fs::write(folder.path().join("core.il"), &self.netlist).expect("a file");
        let change =
            mutant.map(|mutant| format!("mutate {}\n", mutant.command)).unwrap_or_default();
        let script = format!("read_rtlil core.il\n{change}write_verilog -noattr alone.v\n");
        std::fs::write(folder.path().join("alone.ys"), script).expect("a file");
        yosys(folder.path(), "script alone.ys");
        read(folder.path(), "alone.v")
    }
}

/// The netlist (RTLIL) in which a module that yosys has made of one with parameters is named after
/// its kind or, in an array of instances, after the first of its instances: `carrystep_pulser_2` in
/// place of `$paramod$1f2e\carrystep_pulser`.
fn named_by_instance(netlist: &str) -> String {
    let mut names: HashMap<&str, String> = HashMap::new();
    for line in netlist.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        let ["cell", part, instance] = words[..] else { continue };
        let Some((_, kind)) =
            part.strip_prefix("$paramod").and_then(|rest| rest.split_once("\\carrystep_"))
        else {
            continue;
        };
        let kind = kind.split('\\').next().unwrap_or(kind);
        let instance = instance.trim_start_matches('\\');
        let index = instance
            .strip_prefix(kind)
            .filter(|rest| rest.strip_prefix('_').is_some_and(is_number));
        names
            .entry(part)
            .or_insert_with(|| format!("\\carrystep_{kind}{}", index.unwrap_or_default()));
    }
    let word = |word: &str| names.get(word).map_or(word, String::as_str).to_owned();
    let line = |line: &str| line.split(' ').map(word).collect::<Vec<_>>().join(" ") + "\n";
    netlist.lines().map(line).collect()
}

fn is_number(text: &str) -> bool {
    !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit())
}

/// The selecting input is replaced by a variable that is set once. As a port, Verilator would
/// evaluate it in every clock.
fn with_choice(verilog: &str, width: u32) -> String {
    let (wire, top) = (format!("wire [{}:0] mutant;", width - 1), format!("module {TOP}("));
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

/// A mutant and its place, which is a module and a line.
type Candidate = (Mutant, String);

/// All mutants that yosys can make.
fn candidates(list: &str, verilog: &str) -> Vec<Candidate> {
    let lines: Vec<&str> = verilog.lines().collect();
    let mut seen: HashMap<String, u32> = HashMap::new();
    let mutants = list.lines().filter_map(|line| {
        let command = line.strip_prefix("mutate ")?;
        let option = |name: &str| {
            command.split(&format!("-{name} ")).nth(1).and_then(|rest| rest.split(' ').next())
        };
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
        let wire =
            option("wire").map(|wire| format!(" ({wire}[{}])", bit("wirebit"))).unwrap_or_default();
        let source = command
            .rsplit("-src ")
            .next()
            .and_then(|place| place.split(':').nth(1)?.split('.').next());
        let source =
            source.and_then(|number| lines.get(number.parse::<usize>().ok()?.checked_sub(1)?));
        let source = source.map_or("", |text| text.trim());
        let cell = option("cell").map(kind)?;
        let mut name =
            format!("{module}: {cell} {port}[{}]{wire} {what}: {source}", bit("portbit"));
        let twins = seen.entry(name.clone()).or_default();
        *twins += 1;
        if *twins > 1 {
            let _ = write!(name, " #{twins}");
        }
        Some((
            Mutant { name, module: module.to_owned(), command: command.to_owned() },
            format!("{module}: {source}"),
        ))
    });
    mutants.collect()
}

/// The type of a cell, taken from its name without the number and the line.
fn kind(cell: &str) -> &str {
    cell.strip_prefix('$').and_then(|name| name.split('$').next()).unwrap_or(cell)
}

/// Draws the first mutant of each place, then the second of each, and so on.
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
