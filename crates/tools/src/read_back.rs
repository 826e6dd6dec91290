//! Adds the design's ports, and the names of its flip-flops and memories, to what icebox_vlog reads
//! from a bitstream.
//!
//! icebox_vlog knows places only: `io_0_7_1` is a pin, `ram40_8_5` a memory, `/* FF 2 8 3 */` a
//! flip-flop. nextpnr's placement gives the cell at each place, so every place has exactly one
//! name. The names come from the placement; the function comes from the bits alone, so that a bit
//! that moved or changed is detected.

use crate::SynthesisError;
use crate::cells::pattern;
use crate::tool::{ICEBOX_VLOG, NEXTPNR};
use serde_json::{Map, Value};
use std::collections::{BTreeMap, HashMap, HashSet};
use std::fmt::Write as _;

/// The module with names.
pub(crate) fn named(text: &str, placement: &Value, top: &str) -> Result<String, SynthesisError> {
    let text = pattern("//.*").replace_all(text, "");
    let unread =
        |what: &str| SynthesisError::Unread { tool: ICEBOX_VLOG.name, what: what.to_owned() };
    let (head, body) = text.split_once(");").ok_or_else(|| unread("its ports"))?;
    let (body, _) = body.split_once("endmodule").ok_or_else(|| unread("its end"))?;
    let outputs: HashSet<&str> = head
        .split(',')
        .filter_map(|port| port.trim().rsplit_once("output "))
        .map(|(_, io)| io)
        .collect();
    let places = Places::of(placement)?;

    let mut names = HashMap::new();
    for (io, port) in &places.pins {
        names.insert(io.clone(), format!("\\{port}$pin "));
    }
    for (ram, name) in &places.memories {
        names.insert(ram.clone(), format!("\\{name} "));
    }
    // A flip-flop on a pin shares the pin's wire; the name of the flip-flop is used.
    for found in pattern(r"/\* FF +(\d+) +(\d+) +(\d+) \*/ always @\(posedge \w+\) .*? (\w+) <=")
        .captures_iter(body)
    {
        let (_, [x, y, z, wire]) = found.extract();
        let name = places
            .flip_flops
            .get(&format!("X{x}/Y{y}/lc{z}"))
            .ok_or_else(|| unread("an unknown flip-flop"))?;
        names.insert(wire.to_owned(), format!("\\{name} "));
    }
    let pad = places.pad_of_pll(body)?;
    if let Some((wire, io)) = &pad {
        names.insert(wire.clone(), names[io].clone());
    }
    // A pin that nothing reads, or whose level is another pin's, has no wire of its own there.
    let wired: HashSet<&str> = pattern(r"(?m)^(?:wire|reg) (.*);")
        .captures_iter(body)
        .flat_map(|found| found.extract::<1>().1[0].split(", ").collect::<Vec<_>>())
        .map(|wire| wire.split(' ').next().unwrap_or(wire))
        .collect();
    let place = pattern(r"\b(?:n\d+|io_\d+_\d+_\d+|ram40_\d+_\d+)\b");
    let named = place.replace_all(body, |found: &regex::Captures<'_>| {
        names.get(&found[0]).cloned().unwrap_or_else(|| found[0].to_owned())
    });

    // Writing to a string cannot fail.
    let (mut ports, mut wires) = (BTreeMap::new(), String::new());
    for (io, port) in &places.pins {
        let (name, bit) = port.split_once('[').unwrap_or((port, "0]"));
        let bit: usize = bit.trim_end_matches(']').parse().map_err(|_| unread("a port's bit"))?;
        let is_input = !outputs.contains(io.as_str());
        let widest = ports.entry(name).or_insert((is_input, port.contains('['), 0));
        widest.2 = widest.2.max(bit);
        let wire = &names[io];
        if !wired.contains(io.as_str()) && pad.as_ref().is_none_or(|(_, of_pll)| of_pll != io) {
            let _ = writeln!(wires, "wire {wire};");
        }
        let _ = if is_input {
            writeln!(wires, "assign {wire} = {port};")
        } else {
            writeln!(wires, "assign {port} = {wire};")
        };
    }
    let ports: Vec<String> = ports
        .into_iter()
        .map(|(name, (is_input, is_row, last))| {
            let range = if is_row { format!("[{last}:0] ") } else { String::new() };
            format!("    {} wire {range}{name}", if is_input { "input" } else { "output" })
        })
        .collect();
    Ok(format!("module {top} (\n{}\n);\n{named}\n{wires}endmodule\n", ports.join(",\n")))
}

/// The cell at each place, according to nextpnr's placement.
struct Places {
    /// `io_X_Y_Z`, and the port bit on that pin.
    pins: BTreeMap<String, String>,
    /// `ram40_X_Y`, and the name of the memory.
    memories: BTreeMap<String, String>,
    /// `XX/YY/lcZ`, and the name of the flip-flop's wire.
    flip_flops: BTreeMap<String, String>,
}

impl Places {
    fn of(placement: &Value) -> Result<Self, SynthesisError> {
        let unread =
            |what: &str| SynthesisError::Unread { tool: NEXTPNR.name, what: what.to_owned() };
        let map = |value: &'_ Value| -> Option<Map<String, Value>> { value.as_object().cloned() };
        let modules = map(&placement["modules"]).ok_or_else(|| unread("its modules"))?;
        let module = modules.values().next().ok_or_else(|| unread("its module"))?;
        let wires: HashMap<u64, String> = map(&module["netnames"])
            .into_iter()
            .flatten()
            .filter_map(|(name, wire)| Some((wire["bits"][0].as_u64()?, name)))
            .collect();
        let mut places =
            Self { pins: BTreeMap::new(), memories: BTreeMap::new(), flip_flops: BTreeMap::new() };
        for (name, cell) in map(&module["cells"]).ok_or_else(|| unread("its cells"))? {
            let place = cell["attributes"]["NEXTPNR_BEL"].as_str().unwrap_or_default();
            let numbers = place.replace(['X', 'Y'], "").replace("/io", "_").replace('/', "_");
            match cell["type"].as_str().unwrap_or_default() {
                "SB_IO" => {
                    places.pins.insert(
                        format!("io_{numbers}"),
                        name.trim_end_matches("$sb_io").to_owned(),
                    );
                }
                "ICESTORM_RAM" => {
                    let numbers = numbers.trim_end_matches("_ram");
                    places.memories.insert(
                        format!("ram40_{numbers}"),
                        name.trim_end_matches("_RAM").to_owned(),
                    );
                }
                "ICESTORM_LC" if cell["parameters"]["DFF_ENABLE"] == "1" => {
                    let wire = cell["connections"]["O"][0].as_u64().and_then(|bit| wires.get(&bit));
                    let wire = wire.ok_or_else(|| unread("a flip-flop's wire"))?;
                    places.flip_flops.insert(place.to_owned(), wire.clone());
                }
                _ => {}
            }
        }
        Ok(places)
    }

    /// The wire by which a PLL reads the level of a pad, and that pad. It is the only placed pin
    /// that icebox_vlog shows nowhere else.
    fn pad_of_pll(&self, body: &str) -> Result<Option<(String, String)>, SynthesisError> {
        let Some(wire) = pattern(r"\.PACKAGEPIN\((n\d+)\)").captures(body) else { return Ok(None) };
        let shown: HashSet<&str> =
            pattern(r"\bio_\d+_\d+_\d+\b").find_iter(body).map(|io| io.as_str()).collect();
        let mut hidden = self.pins.keys().filter(|io| !shown.contains(io.as_str()));
        match (hidden.next(), hidden.next()) {
            (Some(io), None) => Ok(Some((wire[1].to_owned(), io.clone()))),
            _ => Err(SynthesisError::Unread {
                tool: ICEBOX_VLOG.name,
                what: "the pad of the PLL".to_owned(),
            }),
        }
    }
}
