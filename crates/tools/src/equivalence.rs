//! Proves by induction over one clock that a stage of synthesis is equivalent to the stage before
//! it.
//!
//! Both stages are cut at their block RAMs. The words that a memory reads become free inputs, equal
//! on both sides; the addresses, data and enables of a memory become outputs, which must be equal.
//! Both sides then have the same flip-flops, which [`Registers`] matches. The induction step is: if
//! all flip-flops and all words read are equal, then all outputs, all inputs of the memories and the
//! next values of the flip-flops are equal.
//!
//! The induction begins equal: all flip-flops of an iCE40 are 0 after configuration, and exactly the
//! registers that start at 1 must be stored inverted. A simulation from configuration confirms it.
//! [`memories`] compares the modes and the initial contents of the memories themselves.
//!
//! Three steps are not proved but only simulated: how yosys reads the Verilog, its word-level
//! optimisation, and its choice of block RAMs for memories (`synth_ice40` up to `map_ffram`). All
//! later steps (gates, flip-flops, LUTs, carry) are proved.

use crate::SynthesisError;
use crate::cells::{self, ICE40, pattern};
use crate::ice40::Netlist;
use crate::registers::{self, Registers, Words};
use crate::tool::{self, YOSYS_OF_PIP};
use std::collections::BTreeMap;

/// Result of a proof.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum EquivalenceVerdict {
    /// This number of pairs of wires is proved to be equal at all times.
    Proved(u32),
    /// The first number is how many pairs could not be proved to be equal; the second is the number
    /// of all pairs.
    Open(u32, u32),
}

/// Compares the Verilog, after `synth_ice40` has mapped its memories, with the netlist `verilog`
/// that was made from it.
///
/// # Errors
/// [`SynthesisError`] if yosys is missing, or if a name that the proof needs has been lost.
pub fn verilog_and_netlist(
    core: &str,
    netlist: &Netlist,
    verilog: &str,
) -> Result<EquivalenceVerdict, SynthesisError> {
    let top = netlist.top();
    let folder = tool::folder()?;
    tool::write(folder.path(), "core.v", core)?;
    let script = format!(
        "read_verilog core.v; {}; opt_expr -mux_undef; {CUT}; \
         simplemap t:* t:$dff t:$sdff t:$dffe t:$sdffe t:$sdffce %u %u %u %u %d; opt_expr; opt_merge; opt_expr; opt_clean; \
         splitnets -ports {top}; {}; select {top}; write_rtlil -selected words.il",
        to_words(top),
        registers::written(top, "words.json"),
    );
    tool::yosys_of_pip(folder.path(), &script)?;
    let [words, names] = ["words.il", "words.json"].map(|name| tool::read(folder.path(), name));
    let found = Registers::of(core, netlist)?;
    let gold = format!(
        "read_rtlil gold.txt; {}; select -set logic w:* x:* w:register.* %u %d; rename -hide @logic",
        found.renamed(top, &Words::read(&names?, top)?)?
    );
    prove(top, &gold, &words?, &found.added_to(verilog))
}

/// Compares the netlist with the bitstream that was read back.
///
/// # Errors
/// [`SynthesisError`] if yosys is missing, or if a name that the proof needs has been lost.
pub fn netlist_and_bitstream(
    netlist: &Netlist,
    read_back: &str,
) -> Result<EquivalenceVerdict, SynthesisError> {
    let top = netlist.top();
    prove(top, &cells_in("gold.txt", top), &netlist.verilog, read_back)
}

/// The block RAMs to which `synth_ice40` maps the memories of Verilog, as [`memories`].
///
/// # Errors
/// [`SynthesisError`] if yosys is missing or refuses the text.
pub fn memories_of_verilog(core: &str, top: &str) -> Result<Memories, SynthesisError> {
    let folder = tool::folder()?;
    tool::write(folder.path(), "core.v", core)?;
    let script = format!("read_verilog core.v; {}; write_verilog -noattr words.v", to_words(top));
    tool::yosys_of_pip(folder.path(), &script)?;
    Ok(memories(&tool::read(folder.path(), "words.v")?))
}

/// The commands of synthesis up to words and block RAMs; gates and LUTs follow after them. A block
/// RAM of which every bit is masked with a constant 0 is removed, as the commands after these do.
fn to_words(top: &str) -> String {
    format!("synth_ice40 -top {top} -run begin:map_ffram; opt_expr -fine; opt_clean")
}

/// Parameters of block RAMs, by name.
pub type Memories = BTreeMap<String, BTreeMap<String, String>>;

/// Modes and initial contents of a design's block RAMs, by name. Contents that are never read (`x`)
/// are 0 in a bitstream. Contents are hexadecimal; yosys writes them in binary if only some bits of
/// a digit are never read.
pub fn memories(verilog: &str) -> Memories {
    let memory = pattern(r"(?s)SB_RAM40_4K #\((.*?)\n\s*\) *\\?(\S+) *\(");
    let parameter = pattern(r"\.(\w+)\((?:\d+'([hdb]))?(\w+)\)");
    let all = memory.captures_iter(verilog).map(|found| {
        let all = parameter.captures_iter(&found[1]);
        (
            found[2].to_owned(),
            all.map(|one| {
                let digits = one[3].replace('x', "0");
                let is_binary = one.get(2).is_some_and(|base| base.as_str() == "b");
                (one[1].to_owned(), if is_binary { hexadecimal(&digits) } else { digits })
            })
            .collect(),
        )
    });
    all.collect()
}

/// Binary digits, a multiple of four of them, as hexadecimal ones.
fn hexadecimal(binary: &str) -> String {
    let digit = |four: &[u8]| four.iter().fold(0, |value, bit| value << 1 | u32::from(bit & 1));
    binary.as_bytes().chunks(4).filter_map(|four| char::from_digit(digit(four), 16)).collect()
}

/// Commands that cut a design at its memories: their inputs become outputs of the design, and their
/// outputs become inputs.
const CUT: &str = "setundef -undriven -zero; expose -evert t:SB_RAM40_4K";

/// Commands that read a design of cells and cut it. A wire of one bit gets the same name whether it
/// was declared with a range (`[0:0]`) or without one.
fn cells_in(file: &str, top: &str) -> String {
    format!(
        "read_verilog cells.v {file}; blackbox SB_RAM40_4K; hierarchy -top {top}; proc; flatten; \
         setattr -unset single_bit_vector w:*; {CUT}; opt_clean; splitnets -ports"
    )
}

/// Proves that two designs are equivalent. `gold` are commands that read one of them from
/// `gold.txt`.
fn prove(
    top: &str,
    gold: &str,
    gold_text: &str,
    gate_text: &str,
) -> Result<EquivalenceVerdict, SynthesisError> {
    let folder = tool::folder()?;
    let both = format!("{gold_text}{gate_text} SB_RAM40_4K");
    for (name, text) in [
        ("gold.txt", gold_text),
        ("gate.v", gate_text),
        ("cells.v", &cells::models(&ICE40, &both)?),
    ] {
        tool::write(folder.path(), name, text)?;
    }
    let gate = cells_in("gate.v", top);
    let script = format!(
        "{gold}; rename {top} gold; design -stash gold; {gate}; rename {top} gate; design -stash gate; \
         design -copy-from gold -as gold gold; design -copy-from gate -as gate gate; equiv_make gold gate equiv; delete gold gate; \
         hierarchy -top equiv; select -assert-none t:SB_*; check -assert; equiv_induct -seq 1; tee -o status.txt equiv_status"
    );
    tool::yosys_of_pip(folder.path(), &script)?;
    let status = tool::read(folder.path(), "status.txt")?;
    let counts = pattern(r"(\d+) are proven and (\d+) are unproven")
        .captures(&status)
        .and_then(|found| Some((found[1].parse().ok()?, found[2].parse().ok()?)));
    match counts {
        Some((proved, 0)) if proved > 0 => Ok(EquivalenceVerdict::Proved(proved)),
        Some((proved, open)) if open > 0 => Ok(EquivalenceVerdict::Open(open, proved + open)),
        _ => {
            Err(SynthesisError::Unread { tool: YOSYS_OF_PIP.name, what: "the verdict".to_owned() })
        }
    }
}
