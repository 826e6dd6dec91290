//! Restores the names of registers that start at 1. The flip-flops of the netlist start at 0, so
//! such registers are stored inverted and may lose their names.
//!
//! A name is only a hint for the proof: with a wrong name the proof fails.

use crate::cells::pattern;
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};

/// A bit of a wire: name of the wire, index of the bit, and width of the wire.
type Named = (String, usize, usize);

/// Names inverted flip-flops after their registers: those called `NAME_$_NOT__Y_A`, and the one
/// without a meaningful name, if there is exactly one.
///
/// `words` is the design before mapping to gates, and `netlist` the design after it, both as yosys'
/// JSON. `verilog` is the netlist, or what was made from it.
pub(crate) fn with_inverses(verilog: &str, words: &str, netlist: &str) -> String {
    let inverse = pattern(r"(?m)^  wire \\?((\w+(?:\.\w+)*)_\$_NOT__Y_A) ?;$");
    let names =
        inverse.captures_iter(verilog).map(|found| (found[1].to_owned(), found[2].to_owned()));
    let missing = names.filter(|(_, name)| {
        !verilog.contains(&format!(" {name};")) && !verilog.contains(&format!("\\{name} ;"))
    });
    let mut wires: String = missing
        .map(|(inverse, name)| format!("  (* keep *) wire \\{name} = ~\\{inverse} ;\n"))
        .collect();
    if let Some((register, inverse)) = nameless(words, netlist) {
        wires += &format!(
            "  (* keep *) wire nameless = ~{};\n  assign {} = nameless;\n",
            bit(&inverse),
            bit(&register)
        );
    }
    verilog.replacen("endmodule", &format!("{wires}endmodule"), 1)
}

/// The register that starts at 1 and has no flip-flop of its name, and the flip-flop without a
/// meaningful name, if there is exactly one of each.
fn nameless(words: &str, netlist: &str) -> Option<(Named, Named)> {
    let (words, netlist) = (Design::of(words)?, Design::of(netlist)?);
    let driven = |(name, place, _): &Named| {
        let inverse = format!("{name}_$_NOT__Y_A");
        netlist
            .wires
            .get(name)
            .and_then(|bits| bits.get(*place))
            .is_some_and(|bit| netlist.driven.contains(bit))
            || netlist.wires.contains_key(&inverse)
    };
    let registers = words.ones.iter().map(|bit| words.names(*bit));
    let lost: Vec<_> =
        registers.filter(|names| !names.is_empty() && !names.iter().any(driven)).collect();
    let made_up = |(name, ..): &Named| name.contains("_$_") || name.contains("_SB_");
    let is_inverse = |(name, ..): &Named| name.ends_with("_$_NOT__Y_A");
    let flip_flops = netlist.registers.iter().map(|bit| netlist.names(*bit));
    let orphans: Vec<_> = flip_flops
        .filter(|names| names.iter().all(made_up) && !names.iter().any(is_inverse))
        .collect();
    match (&lost[..], &orphans[..]) {
        ([register], [flip_flop]) => {
            // The netlist may use a shorter one of the register's names.
            let known = register.iter().find(|(name, ..)| netlist.wires.contains_key(name))?;
            let alias = netlist.wires[&known.0]
                .get(known.1)
                .and_then(|bit| netlist.names(*bit).into_iter().next())?;
            Some((alias, flip_flop.first()?.clone()))
        }
        _ => None,
    }
}

fn bit((name, place, width): &Named) -> String {
    if *width == 1 { format!("\\{name} ") } else { format!("\\{name} [{place}]") }
}

/// A module of yosys' JSON, in which bits are numbers.
struct Design {
    wires: BTreeMap<String, Vec<u64>>,
    driven: BTreeSet<u64>,
    /// The bits that flip-flops hold.
    registers: BTreeSet<u64>,
    /// The bits whose initial value is 1.
    ones: BTreeSet<u64>,
}

impl Design {
    /// Reads the only module that contains cells.
    fn of(json: &str) -> Option<Self> {
        let json: Value = serde_json::from_str(json).ok()?;
        let modules = json["modules"].as_object()?;
        let top = modules.values().find(|module| module["attributes"].get("top").is_some())?;
        let bits = |bits: &Value| -> Vec<u64> {
            bits.as_array()
                .into_iter()
                .flatten()
                .map(|bit| bit.as_u64().unwrap_or(u64::MAX))
                .collect()
        };
        let wires = top["netnames"].as_object()?;
        let mut ones = BTreeSet::new();
        for wire in wires.values() {
            // The attribute lists the highest bit first.
            let first = wire["attributes"]["init"].as_str().unwrap_or("");
            let first_bits = bits(&wire["bits"]).into_iter().zip(first.chars().rev());
            ones.extend(first_bits.filter_map(|(bit, first)| (first == '1').then_some(bit)));
        }
        let wires = wires.iter().filter(|(name, _)| !name.starts_with('$'));
        let wires = wires.map(|(name, wire)| (name.clone(), bits(&wire["bits"]))).collect();
        let (mut driven, mut registers) = (BTreeSet::new(), BTreeSet::new());
        for port in top["ports"].as_object()?.values().filter(|port| port["direction"] == "input") {
            driven.extend(bits(&port["bits"]));
        }
        for cell in top["cells"].as_object()?.values() {
            for (port, _) in
                cell["port_directions"].as_object()?.iter().filter(|(_, way)| *way == "output")
            {
                driven.extend(bits(&cell["connections"][port]));
            }
            if cell["type"].as_str()?.to_lowercase().contains("dff") {
                registers.extend(bits(&cell["connections"]["Q"]));
            }
        }
        registers.remove(&u64::MAX);
        Some(Self { wires, driven, registers, ones })
    }

    /// All names of a bit.
    fn names(&self, bit: u64) -> Vec<Named> {
        let places = |(name, bits): (&String, &Vec<u64>)| {
            let place = bits.iter().position(|other| *other == bit)?;
            Some((name.clone(), place, bits.len()))
        };
        self.wires.iter().filter_map(places).collect()
    }
}
