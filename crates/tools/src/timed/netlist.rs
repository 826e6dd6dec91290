//! Reads the placed netlist that nextpnr writes (`--write`): ports, cells, and the nets between
//! them.

use super::unread;
use crate::SynthesisError;
use serde_json::Value;
use std::collections::{BTreeMap, HashMap};

/// A placed netlist. A net is a number.
pub(super) struct Netlist {
    /// The ports of the design, each with its direction and the nets of its bits.
    pub ports: BTreeMap<String, (bool, Vec<u64>)>,
    /// The cells by their names.
    pub cells: BTreeMap<String, Cell>,
    /// The output that drives each net: cell and pin.
    pub drivers: HashMap<u64, (String, String)>,
}

/// A placed cell.
pub(super) struct Cell {
    /// Its type, such as `ICESTORM_LC`.
    pub kind: String,
    /// The nets of its connected pins.
    pub pins: BTreeMap<String, u64>,
    parameters: BTreeMap<String, String>,
    /// Whether it is a global buffer whose input is not a wire of the fabric.
    pub is_for_pad: bool,
}

impl Netlist {
    pub(super) fn of(placement: &Value) -> Result<Self, SynthesisError> {
        let modules = placement["modules"].as_object().ok_or_else(|| unread("its modules"))?;
        let module = modules.values().next().ok_or_else(|| unread("its module"))?;
        let object =
            |name: &str| module[name].as_object().ok_or_else(|| unread(format!("its {name}")));
        let mut ports = BTreeMap::new();
        for (name, port) in object("ports")? {
            ports.insert(name.clone(), (port["direction"] == "input", nets(name, &port["bits"])?));
        }
        let (mut cells, mut drivers) = (BTreeMap::new(), HashMap::new());
        for (name, cell) in object("cells")? {
            let mut pins = BTreeMap::new();
            for (pin, bits) in cell["connections"].as_object().into_iter().flatten() {
                let [net] = nets(name, bits)?[..] else { continue };
                pins.insert(pin.clone(), net);
                if cell["port_directions"][pin] == "output"
                    && drivers.insert(net, (name.clone(), pin.clone())).is_some()
                {
                    return Err(unread(format!("two drivers of a net, one is {name}")));
                }
            }
            let texts = cell["parameters"].as_object().into_iter().flatten();
            let parameters =
                texts.filter_map(|(name, text)| Some((name.clone(), text.as_str()?.to_owned())));
            let cell = Cell {
                kind: cell["type"].as_str().unwrap_or_default().to_owned(),
                pins,
                parameters: parameters.collect(),
                is_for_pad: cell["attributes"]["FOR_PAD_IN"] == "1",
            };
            cells.insert(name.clone(), cell);
        }
        Ok(Self { ports, cells, drivers })
    }
}

impl Cell {
    /// A parameter, a binary number as text. A digit that the design leaves open, `x`, is 0 in the
    /// bitstream.
    pub(super) fn binary(&self, name: &str) -> Result<String, SynthesisError> {
        let text = self.parameters.get(name).map(|text| text.replace('x', "0"));
        text.filter(|text| !text.is_empty() && text.bytes().all(|digit| b"01".contains(&digit)))
            .ok_or_else(|| unread(format!("the parameter {name} of a cell {}", self.kind)))
    }

    /// A parameter of at most 64 bits.
    pub(super) fn number(&self, name: &str) -> Result<u64, SynthesisError> {
        let text = self.binary(name)?;
        u64::from_str_radix(&text, 2)
            .map_err(|_| unread(format!("the parameter {name}: {text} is too long")))
    }

    /// Fails unless a parameter has this value. `what` describes the function of any other value.
    pub(super) fn must_be(&self, name: &str, value: u64, what: &str) -> Result<(), SynthesisError> {
        if self.number(name)? == value { Ok(()) } else { Err(without_model(what)) }
    }
}

/// A cell or a function of a cell has no model with delays.
pub(super) fn without_model(what: &str) -> SynthesisError {
    unread(format!("{what}: there is no model with delays of it"))
}

/// The nets of a port or pin.
fn nets(name: &str, bits: &Value) -> Result<Vec<u64>, SynthesisError> {
    let bits = bits.as_array().ok_or_else(|| unread(format!("the nets of {name}")))?;
    let nets =
        bits.iter().map(|bit| bit.as_u64().ok_or_else(|| unread(format!("a net of {name}"))));
    nets.collect()
}
