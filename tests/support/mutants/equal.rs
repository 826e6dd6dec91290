//! Proves by yosys and yosys-abc that a mutant equals the engine: from configuration on, for any
//! inputs, without bound.
//!
//! The mutant and the original stand side by side with the same inputs, and all outputs are
//! compared. `scorr` merges by induction what is equal. `pdr` finds an invariant that keeps the
//! rest equal, or a run that shows a difference.
//!
//! Memories are cut out: a word that is read is arbitrary but the same on both sides, and
//! addresses, data and enables are compared. Only if that is not enough, small memories are
//! converted to flip-flops, whose outputs then begin at 0 on both sides.

use super::draw::{Mutant, Sample, TOP, yosys};
use carrystep_tools::kept;
use carrystep_tools::programs::YOSYS_ABC;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::process::Output;

/// The part of the engine around the mutant that a proof includes. A proof in a smaller scope also
/// holds in a greater one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scope {
    /// Its module alone, with the memories in it cut out.
    Module,
    /// Its module with the memories in it.
    Memories,
    /// The whole engine, with the memories cut out.
    Engine,
}

/// Time limit of one question in seconds, four times what the slowest question takes. A mutant for
/// which this is not enough counts as not proved. In the scope of the whole engine only `scorr` has
/// ever proved a mutant, almost at once, so the limit is lower.
const LIMIT: u32 = 100;
const LIMIT_OF_ENGINE: u32 = 15;

/// The greatest number of memory bits that are converted to flip-flops.
const MOST_BITS: usize = 1024;

/// The smallest scope in which a mutant is proved equal to the original.
///
/// # Panics If a tool is missing or fails.
pub fn proved(sample: &Sample, mutant: &Mutant) -> Option<Scope> {
    [Scope::Module, Scope::Memories, Scope::Engine]
        .into_iter()
        .find(|scope| is_proved(sample, mutant, *scope))
}

/// True if a mutant is proved equal to the original in this scope; false if the scope does not
/// apply.
///
/// # Panics If a tool is missing or fails.
pub fn is_proved(sample: &Sample, mutant: &Mutant, scope: Scope) -> bool {
    let modules = Modules::of(&sample.netlist);
    let own = format!("carrystep_{}", mutant.module);
    let Some((top, cut)) = modules.around(&own, scope) else { return false };
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("core.il"), &sample.netlist).expect("a file");
    let mut script = String::new();
    for (side, change) in [("gold", ""), ("gate", &made(&mutant.command))] {
        // Writing to a string cannot fail.
        let _ = write!(script, "read_rtlil core.il\n{change}hierarchy -check -top {top}\n");
        let _ = cut.iter().try_for_each(|memory| writeln!(script, "blackbox {memory}"));
        script.push_str("flatten\n");
        let _ = cut.iter().try_for_each(|memory| writeln!(script, "expose -evert t:{memory}"));
        let _ = write!(script, "opt_clean\nrename {top} {side}\ndesign -stash {side}\n");
    }
    script.push_str(SIDE_BY_SIDE);
    std::fs::write(folder.path().join("equal.ys"), script).expect("a file");
    yosys(folder.path(), "script equal.ys");
    holds(folder.path(), if top == TOP { LIMIT_OF_ENGINE } else { LIMIT })
}

/// The commands that make a mutant. A register whose output becomes a constant loses its value at
/// configuration, because yosys refuses a constant with another one.
fn made(command: &str) -> String {
    let option = |name: &str| {
        let words: Vec<&str> = command.split(' ').collect();
        words.windows(2).find(|pair| pair[0] == name).map_or("", |pair| pair[1])
    };
    let (module, wire) = (option("-module"), option("-wire"));
    let is_constant = option("-mode").starts_with("const") && option("-port") == "Q";
    let unset = if is_constant && !wire.is_empty() {
        format!("setattr -unset init {module}/w:{wire}\n")
    } else {
        String::new()
    };
    format!("mutate {command}\n{unset}")
}

/// Makes one system in gates whose single output signals a difference. Undriven wires become
/// arbitrary values before any simplification.
const SIDE_BY_SIDE: &str = "design -copy-from gold -as gold gold\ndesign -copy-from gate -as gate gate\n\
     miter -equiv -flatten gold gate miter\nhierarchy -check -top miter\nselect -assert-count 1 o:*\n\
     setundef -undriven -anyseq\nopt -full\nmemory_map\nsetundef -init -zero\nopt -full\ntechmap\nopt -full\ndffunmap\nabc -g AND -fast\nopt_clean\n\
     write_aiger -zinit equal.aig\n";

fn holds(folder: &Path, limit: u32) -> bool {
    let ask = format!("read_aiger equal.aig; fold; strash; scorr; pdr -T {limit}");
    let verdicts = |output: &Output| {
        let said = String::from_utf8_lossy(&output.stdout);
        ["Property proved.", "was asserted in frame", "UNDECIDED"]
            .map(|verdict| said.contains(verdict))
    };
    // What was not decided in time may be decided in another run.
    let output = kept::output(&YOSYS_ABC, folder, &["-c", &ask], |output| !verdicts(output)[2]);
    let output = output.expect("yosys-abc is not installed: `cargo xtask tools` installs it");
    let said = String::from_utf8_lossy(&output.stdout);
    let verdicts = verdicts(&output);
    assert!(
        output.status.success() && verdicts.iter().filter(|said| **said).count() == 1,
        "yosys-abc: {said}"
    );
    verdicts[0]
}

/// The module hierarchy of a netlist (RTLIL).
struct Modules<'a>(BTreeMap<&'a str, Module<'a>>);

#[derive(Default)]
struct Module<'a> {
    /// Number of memory bits in the module itself.
    bits: usize,
    /// The modules of which it has instances.
    parts: Vec<&'a str>,
}

impl<'a> Modules<'a> {
    fn of(netlist: &'a str) -> Self {
        let mut all: BTreeMap<&str, Module<'_>> = BTreeMap::new();
        let (mut name, mut size) = ("", None);
        for words in netlist.lines().map(|line| line.split_whitespace().collect::<Vec<_>>()) {
            match words[..] {
                ["module", module] => name = module.trim_start_matches('\\'),
                ["cell", part, _] => {
                    all.entry(name).or_default().parts.extend(part.strip_prefix('\\'));
                    size = None;
                }
                ["parameter", "\\SIZE", words] => size = words.parse::<usize>().ok(),
                // Only a memory has both parameters.
                ["parameter", "\\WIDTH", width] => {
                    let bits = width
                        .parse::<usize>()
                        .ok()
                        .zip(size)
                        .map_or(0, |(width, size)| width * size);
                    all.entry(name).or_default().bits += bits;
                }
                _ => {}
            }
        }
        Self(all)
    }

    /// The module that is compared as a whole, and the memories that are cut out of it. The
    /// mutant's own module is never cut out, because the mutant would be removed with it.
    fn around(&self, own: &'a str, scope: Scope) -> Option<(&'a str, Vec<&'a str>)> {
        let has_memory = |name: &&str| self.0.get(*name).is_some_and(|module| module.bits > 0);
        let top = if scope == Scope::Engine { TOP } else { own };
        let inside: Vec<&str> = self.inside(top).into_iter().filter(has_memory).collect();
        let bits = |names: &[&str]| {
            names
                .iter()
                .filter_map(|name| self.0.get(name))
                .map(|module| module.bits)
                .sum::<usize>()
        };
        match scope {
            Scope::Module => (bits(&[own]) <= MOST_BITS).then_some((top, inside)),
            Scope::Memories => {
                (!inside.is_empty() && bits(&inside) <= MOST_BITS).then_some((top, Vec::new()))
            }
            Scope::Engine => (top != own && !has_memory(&own)).then_some((top, inside)),
        }
    }

    /// All modules inside a module, at any depth.
    fn inside(&self, name: &str) -> Vec<&'a str> {
        let parts = self.0.get(name).map(|module| module.parts.clone()).unwrap_or_default();
        let mut all: Vec<&str> =
            parts.iter().flat_map(|part| self.inside(part)).chain(parts.clone()).collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}
