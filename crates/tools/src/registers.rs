//! Finds the flip-flop in which a netlist stores each register of the Verilog.
//!
//! Mapping renames most wires. A register that starts at 1 is stored inverted, because the
//! flip-flops of an iCE40 start at 0, and then no wire has its name. So the synthesis is repeated
//! up to its flip-flops, where all names are still there, and once more with a number at each
//! flip-flop, which the mapping leaves at its cell.
//!
//! What is found is only a hint for the proof: with a wrong flip-flop the proof fails.

use crate::SynthesisError;
use crate::ice40::Netlist;
use crate::tool::{self, YOSYS_OF_PIP};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

/// The attribute of a flip-flop that holds the number of its register.
const NUMBER: &str = "register";

/// A register, which is a single bit.
struct Register {
    /// Its names in the Verilog.
    names: Vec<String>,
    /// Whether the flip-flop stores the opposite.
    is_inverted: bool,
    /// A name of the flip-flop's output in the netlist.
    wire: String,
}

/// All registers of a netlist. In a proof, the one at index N is called `register.N`.
pub(crate) struct Registers(Vec<Register>);

impl Registers {
    /// The registers of a netlist, which was made from the Verilog `core`.
    pub(crate) fn of(core: &str, netlist: &Netlist) -> Result<Self, SynthesisError> {
        let (top, synthesis) = (netlist.top(), netlist.synthesis());
        let synthesised = |then: &str| -> Result<_, SynthesisError> {
            let folder = tool::folder()?;
            tool::write(folder.path(), "core.v", core)?;
            let script = format!("read_verilog core.v; {}; {then}", synthesis.to_flip_flops);
            tool::yosys_of_pip(folder.path(), &script)?;
            Ok(folder)
        };
        let folder = synthesised(&written(top, "flip-flops.json"))?;
        let found = flip_flops(&tool::read(folder.path(), "flip-flops.json")?, top)?;

        let numbers: String = (found.keys().enumerate())
            .map(|(number, cell)| format!("setattr -set {NUMBER} {number} c:{cell}; "))
            .collect();
        let cells = &synthesis.to_cells;
        let folder = synthesised(&format!(
            "{numbers}{cells} -json core.json; write_verilog -noattr netlist.v"
        ))?;
        if tool::read(folder.path(), "netlist.v")? != netlist.verilog {
            return Err(unread("a netlist of this Verilog"));
        }
        let mapped = flip_flops(&tool::read(folder.path(), "core.json")?, top)?;
        let mapped: BTreeMap<_, _> = mapped.values().map(|one| (one.number, &one.wires)).collect();
        let registers = found.values().enumerate().map(|(number, found)| {
            let wire = mapped.get(&Some(number)).and_then(|wires| wires.first());
            let names = if found.wires.is_empty() { &found.inverses } else { &found.wires };
            Some(Register {
                names: names.clone(),
                is_inverted: found.wires.is_empty(),
                wire: wire?.clone(),
            })
        });
        registers.collect::<Option<_>>().map(Self).ok_or_else(|| unread("all registers"))
    }

    /// Commands that rename the registers of module `top` in its Verilog.
    ///
    /// # Errors
    /// [`SynthesisError`] if the Verilog lacks a register, or if a register is stored inverted and
    /// does not start at 1, or the reverse: then it would not start at its first value, because all
    /// flip-flops start at 0.
    pub(crate) fn renamed(&self, top: &str, words: &Words) -> Result<String, SynthesisError> {
        let mut commands = format!("select -module {top}");
        for (number, Register { names, is_inverted, .. }) in self.0.iter().enumerate() {
            let found = names.iter().find_map(|name| Some((name, words.wires.get(name)?)));
            let lost = || unread(&format!("register {}", names.join(", ")));
            let (name, bit) = found.ok_or_else(lost)?;
            if words.ones.contains(bit) != *is_inverted {
                return Err(unread(&format!("the first value of {name}")));
            }
            // Writing to a string cannot fail.
            let _ = write!(commands, "; rename {name} register.{number}");
        }
        Ok(commands + "; select -clear")
    }

    /// Verilog of the netlist, or of its planted faults, with a wire for each register.
    pub(crate) fn added_to(&self, verilog: &str) -> String {
        let wire = |(number, register): (usize, &Register)| {
            let inverted = if register.is_inverted { "~" } else { "" };
            format!(
                "  (* keep *) wire \\register.{number} = {inverted}{};\n",
                escaped(&register.wire)
            )
        };
        let wires: String = self.0.iter().enumerate().map(wire).collect();
        verilog.replacen("endmodule", &format!("{wires}endmodule"), 1)
    }
}

/// The wires of the Verilog, each of one bit.
pub(crate) struct Words {
    /// Those that are not ports, and their bits.
    wires: BTreeMap<String, Option<u64>>,
    /// The bits that start at 1.
    ones: BTreeSet<Option<u64>>,
}

impl Words {
    /// The wires of a module, from yosys' JSON.
    pub(crate) fn read(json: &str, top: &str) -> Result<Self, SynthesisError> {
        let module = module(json, top)?;
        let parts = |part: &str| module[part].as_object().cloned().unwrap_or_default();
        let (ports, wires) = (parts("ports"), parts("netnames"));
        let bit = |wire: &Value| wire["bits"][0].as_u64();
        let is_one = |wire: &Value| wire["attributes"]["init"].as_str() == Some("1");
        Ok(Self {
            ones: wires.values().filter(|wire| is_one(wire)).map(bit).collect(),
            wires: (wires.iter().filter(|(name, _)| !ports.contains_key(*name)))
                .map(|(name, wire)| (name.clone(), bit(wire)))
                .collect(),
        })
    }
}

/// A command that writes a module as JSON, without the modules of the part's cells.
pub(crate) fn written(top: &str, file: &str) -> String {
    format!("select {top}; write_json -selected {file}; select -clear")
}

/// A name of one bit, such as `sub` or `sub[2]`, as Verilog has it.
fn escaped(name: &str) -> String {
    match name.split_once('[') {
        Some((name, place)) => format!("\\{name} [{place}"),
        None => format!("\\{name} "),
    }
}

fn unread(what: &str) -> SynthesisError {
    SynthesisError::Unread { tool: YOSYS_OF_PIP.name, what: what.to_owned() }
}

/// A flip-flop of the part.
struct FlipFlop {
    /// The number that it was given.
    number: Option<usize>,
    /// Names of its output.
    wires: Vec<String>,
    /// Names of what inverters make of its output.
    inverses: Vec<String>,
}

/// The flip-flops of a module, from yosys' JSON, by the names of their cells.
fn flip_flops(json: &str, top: &str) -> Result<BTreeMap<String, FlipFlop>, SynthesisError> {
    let module = module(json, top)?;
    let parts = |part: &str| module[part].as_object().cloned().unwrap_or_default();
    let (mut names, mut inverses) =
        (BTreeMap::<_, Vec<String>>::new(), BTreeMap::<_, Vec<_>>::new());
    for (name, wire) in parts("netnames").iter().filter(|(name, _)| !name.starts_with('$')) {
        let bits = wire["bits"].as_array().map_or(&[][..], Vec::as_slice);
        let first = wire["offset"].as_u64().unwrap_or(0);
        for (place, bit) in (first..).zip(bits) {
            let name = if bits.len() == 1 { name.clone() } else { format!("{name}[{place}]") };
            names.entry(bit.as_u64()).or_default().push(name);
        }
    }
    let cells = parts("cells");
    let bit = |cell: &Value, port: &str| cell["connections"][port][0].as_u64();
    for cell in cells.values().filter(|cell| cell["type"] == "$_NOT_") {
        inverses.entry(bit(cell, "A")).or_default().push(bit(cell, "Y"));
    }
    let named = |bit: &Option<u64>| names.get(bit).cloned().unwrap_or_default();
    let flip_flop = |cell: &Value| {
        let output = bit(cell, "Q");
        let number = cell["attributes"][NUMBER].as_str();
        FlipFlop {
            number: number.and_then(|digits| usize::from_str_radix(digits, 2).ok()),
            wires: named(&output),
            inverses: inverses.get(&output).into_iter().flatten().flat_map(named).collect(),
        }
    };
    let is_flip_flop =
        |cell: &Value| cell["type"].as_str().is_some_and(|name| name.starts_with("SB_DFF"));
    let flip_flops = cells.iter().filter(|(_, cell)| is_flip_flop(cell));
    Ok(flip_flops.map(|(name, cell)| (name.clone(), flip_flop(cell))).collect())
}

/// A module of yosys' JSON, in which bits are numbers.
fn module(json: &str, top: &str) -> Result<Value, SynthesisError> {
    let json: Value =
        serde_json::from_str(json).map_err(|error| unread(&format!("JSON: {error}")))?;
    Ok(json["modules"][top].clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Module `m` with the wires `zero`, `one` and port `out`.
    const WORDS: &str = r#"{"modules": {"m": {
        "ports": {"out": {"bits": [4]}},
        "netnames": {
            "zero": {"bits": [2], "attributes": {"init": "0"}},
            "one": {"bits": [3], "attributes": {"init": "1"}},
            "alias": {"bits": [3], "attributes": {}},
            "out": {"bits": [4], "attributes": {}}
        }
    }}}"#;

    fn renamed(name: &str, is_inverted: bool) -> Result<String, SynthesisError> {
        let wire = "wire".to_owned();
        let register = Register { names: vec![name.to_owned()], is_inverted, wire };
        Registers(vec![register]).renamed("m", &Words::read(WORDS, "m")?)
    }

    #[test]
    fn exactly_registers_that_start_at_1_may_be_stored_inverted() {
        let named = |name| format!("select -module m; rename {name} register.0; select -clear");
        assert_eq!(renamed("zero", false).ok(), Some(named("zero")));
        assert_eq!(renamed("one", true).ok(), Some(named("one")));
        assert_eq!(renamed("alias", true).ok(), Some(named("alias")));
        for (name, is_inverted) in [("zero", true), ("one", false), ("alias", false)] {
            let error = renamed(name, is_inverted).expect_err("another first value");
            assert!(error.to_string().contains(&format!("the first value of {name}")), "{error}");
        }
        assert!(renamed("out", false).is_err(), "a port");
        assert!(renamed("lost", false).is_err());
    }
}
