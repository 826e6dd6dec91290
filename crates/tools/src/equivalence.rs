//! Proofs that a stage of synthesis is the stage before it, for ever, by induction over one clock.
//!
//! Both stages are cut at their block RAMs: what a memory reads is any word, the same on both sides; what it is asked
//! and told must be equal. So both sides have the same flip-flops, matched by name, and the induction says: where
//! all of them and all words read are equal, all outputs, all that the memories are told and the next flip-flops are equal.
//! They start equal: a flip-flop of iCE40 is 0 after configuration, which a simulation from configuration shows too (the induction
//! knows nothing of beginnings). That the memories themselves are the same ones, in mode and first contents, is [`memories`].
//!
//! What is left to simulation: how yosys reads the Verilog, its word-level optimisation, and its choice of block RAMs for
//! memories (`synth_ice40` up to `map_ffram`). All that is after it (gates, flip-flops, LUTs, carry) is proved.

use crate::SynthesisError;
use crate::cells::{self, ICE40, pattern};
use crate::ice40::Netlist;
use crate::inverses::with_inverses;
use crate::tool::{self, YOSYS};
use std::collections::BTreeMap;

/// What a proof came to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Verdict {
    /// So many pairs of wires are equal for ever.
    Proved(u32),
    /// So many of so many pairs are not shown to be equal.
    Open(u32, u32),
}

/// The Verilog, after `synth_ice40` has found its memories, against the netlist `verilog` that has come of it.
///
/// # Errors
/// [`SynthesisError`]: yosys is missing, or a name has been lost that the proof needs.
pub fn verilog_and_netlist(core: &str, netlist: &Netlist, verilog: &str) -> Result<Verdict, SynthesisError> {
    let top = netlist.top();
    let gold = format!(
        "read_verilog core.v; {}; opt_expr -mux_undef; {CUT}; \
         simplemap t:* t:$dff t:$sdff t:$dffe t:$sdffe t:$sdffce %u %u %u %u %d; opt_expr; opt_merge; opt_expr; opt_clean; \
         splitnets -ports {top}; select -set kept t:*dff* %co1:+[Q] x:* %u; select -set logic w:* @kept %d; rename -hide @logic",
        to_words(top)
    );
    let folder = tool::folder()?;
    tool::write(folder.path(), "core.v", core)?;
    tool::yosys(folder.path(), &format!("read_verilog core.v; {}; write_json words.json", to_words(top)))?;
    let words = tool::read(folder.path(), "words.json")?;
    prove(top, &gold, core, &with_inverses(verilog, &words, netlist.json()))
}

/// The netlist against the bitstream that has been read back.
///
/// # Errors
/// [`SynthesisError`]: yosys is missing, or a name has been lost that the proof needs.
pub fn netlist_and_bitstream(netlist: &Netlist, read_back: &str) -> Result<Verdict, SynthesisError> {
    let top = netlist.top();
    prove(top, &cells_in("core.v", top), &netlist.verilog, read_back)
}

/// The block RAMs that `synth_ice40` finds for the memories of Verilog, as [`memories`].
///
/// # Errors
/// [`SynthesisError`]: yosys is missing or refuses the text.
pub fn memories_of_verilog(core: &str, top: &str) -> Result<Memories, SynthesisError> {
    let folder = tool::folder()?;
    tool::write(folder.path(), "core.v", core)?;
    let script = format!("read_verilog core.v; {}; write_verilog -noattr words.v", to_words(top));
    tool::yosys(folder.path(), &script)?;
    Ok(memories(&tool::read(folder.path(), "words.v")?))
}

/// As far as words and block RAMs; gates and LUTs come after it.
fn to_words(top: &str) -> String {
    format!("synth_ice40 -top {top} -run begin:map_ffram")
}

/// Parameters of block RAMs, by name.
pub type Memories = BTreeMap<String, BTreeMap<String, String>>;

/// Modes and first contents of a design's block RAMs, by name. What is never read (`x`) is 0 in a bitstream.
pub fn memories(verilog: &str) -> Memories {
    let memory = pattern(r"(?s)SB_RAM40_4K #\((.*?)\n\s*\) *\\?(\S+) *\(");
    let parameter = pattern(r"\.(\w+)\((?:\d+'[hd])?(\w+)\)");
    let all = memory.captures_iter(verilog).map(|found| {
        let all = parameter.captures_iter(&found[1]);
        (found[2].to_owned(), all.map(|one| (one[1].to_owned(), one[2].replace('x', "0"))).collect())
    });
    all.collect()
}

/// Makes what a memory is told an output, and what it reads an input.
const CUT: &str = "setundef -undriven -zero; expose -evert t:SB_RAM40_4K";

/// Reads a design of cells, and cuts it.
fn cells_in(file: &str, top: &str) -> String {
    format!(
        "read_verilog cells.v {file}; blackbox SB_RAM40_4K; hierarchy -top {top}; proc; flatten; {CUT}; opt_clean; \
         splitnets -ports"
    )
}

/// Proves that two designs are one.
fn prove(top: &str, gold: &str, gold_text: &str, gate_text: &str) -> Result<Verdict, SynthesisError> {
    let folder = tool::folder()?;
    let both = format!("{gold_text}{gate_text} SB_RAM40_4K");
    for (name, text) in [("core.v", gold_text), ("gate.v", gate_text), ("cells.v", &cells::models(&ICE40, &both)?)] {
        tool::write(folder.path(), name, text)?;
    }
    let gate = cells_in("gate.v", top);
    let script = format!(
        "{gold}; rename {top} gold; design -stash gold; {gate}; rename {top} gate; design -stash gate; \
         design -copy-from gold -as gold gold; design -copy-from gate -as gate gate; equiv_make gold gate equiv; delete gold gate; \
         hierarchy -top equiv; select -assert-none t:SB_*; check -assert; equiv_induct -seq 1; tee -o status.txt equiv_status"
    );
    tool::yosys(folder.path(), &script)?;
    let status = tool::read(folder.path(), "status.txt")?;
    let counts = pattern(r"(\d+) are proven and (\d+) are unproven")
        .captures(&status)
        .and_then(|found| Some((found[1].parse().ok()?, found[2].parse().ok()?)));
    match counts {
        Some((proved, 0)) if proved > 0 => Ok(Verdict::Proved(proved)),
        Some((proved, open)) if open > 0 => Ok(Verdict::Open(open, proved + open)),
        _ => Err(SynthesisError::Unread { tool: YOSYS.name, what: "the verdict".to_owned() }),
    }
}
