//! Reads the EDIF of a design a second time, with spydrnet, and compares: the cells and nets with
//! those of our own reader, and the names with those of the board's constraint file. ISE applies a
//! constraint to the net of that name, and ignores a pin of a net that it does not find.

mod constraints;

use super::edif;
use crate::SynthesisError;
use crate::programs::SPYDRNET;
use crate::tool;
use constraints::Constraints;
use serde::Deserialize;
use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;
use thiserror::Error;

const SCRIPT: &str = include_str!("independent/read.py");

/// Exit code of the script if a Python has no spydrnet.
const LACKING: i32 = 3;

/// What differs between the EDIF, as spydrnet reads it, and our own reading or the constraints.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum Mismatch {
    /// The constraint file has a line that the templates do not write.
    #[error("line {number} of the constraints is of an unknown form: {line}")]
    Line {
        /// Counted from 1.
        number: usize,
        /// The line.
        line: String,
    },
    /// A port has two pins.
    #[error("the constraints place {port} twice")]
    Twice {
        /// The port.
        port: String,
    },
    /// The constraint file names a port that the EDIF does not have.
    #[error("the constraints name {port}, which is no port of the EDIF")]
    NoPort {
        /// The port.
        port: String,
    },
    /// The EDIF has a port without a pin.
    #[error("the constraints place no pin for the port {port} of the EDIF")]
    NoPin {
        /// The port.
        port: String,
    },
    /// The net at a port has another name, so that ISE would not find it.
    #[error("the net at the port {port} is named {}, so that constraints do not apply to it", .net.as_deref().unwrap_or("nothing"))]
    Net {
        /// The port.
        port: String,
        /// Name of its net, if it has one.
        net: Option<String>,
    },
    /// No constraint gives the period of a clock.
    #[error("the constraints give no clock a period")]
    NoClock,
    /// The two readers count different numbers of a cell.
    #[error("{cell}: our reader counts {ours}, spydrnet {theirs}")]
    Cells {
        /// The cell.
        cell: String,
        /// Our own count.
        ours: usize,
        /// That of spydrnet.
        theirs: usize,
    },
    /// A net that one of the two readers does not find.
    #[error("only one of the two readers finds a net with these ends: {ends}")]
    Joined {
        /// Its ends, each as instance/port/bit.
        ends: String,
    },
}

/// What was compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Compared {
    /// Cells of the design.
    pub cells: usize,
    /// Nets with at least one end.
    pub nets: usize,
    /// Bits of ports, each with a pin.
    pub ports: usize,
}

/// The output of the script.
#[derive(Deserialize)]
struct Reading {
    /// Each port, and the net at each of its bits from the left.
    ports: BTreeMap<String, Vec<Option<String>>>,
    cells: BTreeMap<String, usize>,
    /// The ends of each net.
    nets: BTreeSet<String>,
}

/// An EDIF file as spydrnet reads it.
#[derive(Debug)]
pub struct ReadTwice {
    counts: Compared,
    /// What our own reader finds differently.
    different: Vec<Mismatch>,
    /// Each bit of each port, and the net at it.
    bits: BTreeMap<String, Option<String>>,
}

impl ReadTwice {
    /// Reads an EDIF file with spydrnet and with our own reader.
    ///
    /// # Errors
    /// [`SynthesisError`] if spydrnet is missing or one of the readers refuses the file.
    pub fn of(edif: &str) -> Result<Self, SynthesisError> {
        let theirs = reading(edif)?;
        let ours = edif::contents(edif)?;
        let mut different = Vec::new();
        for cell in ours.cells.keys().chain(theirs.cells.keys()).collect::<BTreeSet<_>>() {
            let count = |of: &BTreeMap<String, usize>| of.get(cell).copied().unwrap_or_default();
            let (ours, theirs) = (count(&ours.cells), count(&theirs.cells));
            if ours != theirs {
                different.push(Mismatch::Cells { cell: cell.clone(), ours, theirs });
            }
        }
        let joined = ours.nets.symmetric_difference(&theirs.nets);
        different.extend(joined.map(|ends| Mismatch::Joined { ends: ends.clone() }));
        let bits = bits(&theirs.ports)?;
        let counts = Compared {
            cells: theirs.cells.values().sum(),
            nets: theirs.nets.len(),
            ports: bits.len(),
        };
        Ok(Self { counts, different, bits })
    }

    /// Compares the two readings with each other, and the names of ports and nets with those of a
    /// constraint file.
    ///
    /// # Errors
    /// All that differs.
    pub fn against(&self, constraints: &str) -> Result<Compared, Vec<Mismatch>> {
        let mut found = self.different.clone();
        match Constraints::of(constraints) {
            Ok(constraints) => found.extend(names(&self.bits, &constraints)),
            Err(unread) => found.push(unread),
        }
        if found.is_empty() { Ok(self.counts) } else { Err(found) }
    }
}

/// What differs between the ports of the EDIF, each with its net, and the constraints.
fn names(bits: &BTreeMap<String, Option<String>>, constraints: &Constraints) -> Vec<Mismatch> {
    let named: BTreeSet<&String> = constraints.placed.union(&constraints.clocks).collect();
    let unknown = named.into_iter().filter(|port| !bits.contains_key(*port));
    let mut found: Vec<Mismatch> =
        unknown.map(|port| Mismatch::NoPort { port: port.clone() }).collect();
    for (port, net) in bits {
        if !constraints.placed.contains(port) {
            found.push(Mismatch::NoPin { port: port.clone() });
        }
        if net.as_ref() != Some(port) {
            found.push(Mismatch::Net { port: port.clone(), net: net.clone() });
        }
    }
    if constraints.clocks.is_empty() {
        found.push(Mismatch::NoClock);
    }
    found
}

/// Each bit of each port, and the net at it. `step[5:0]` gives `step[5]` first.
fn bits(
    ports: &BTreeMap<String, Vec<Option<String>>>,
) -> Result<BTreeMap<String, Option<String>>, SynthesisError> {
    let mut all = BTreeMap::new();
    for (port, nets) in ports {
        let range = port.strip_suffix(":0]").and_then(|port| port.split_once('['));
        match (range, nets.as_slice()) {
            (None, [net]) => {
                all.insert(port.clone(), net.clone());
            }
            (Some((name, left)), nets) if left.parse() == Ok(nets.len().saturating_sub(1)) => {
                let bits = nets.iter().rev().enumerate();
                all.extend(bits.map(|(bit, net)| (format!("{name}[{bit}]"), net.clone())));
            }
            _ => return Err(unread(format!("which bits the port {port} has"))),
        }
    }
    Ok(all)
}

/// The file as spydrnet reads it, in the first Python on the path that has it.
fn reading(edif: &str) -> Result<Reading, SynthesisError> {
    let folder = tool::folder()?;
    tool::write(folder.path(), "read.py", SCRIPT)?;
    tool::write(folder.path(), "design.edif", edif)?;
    for python in which::which_all_global("python3").into_iter().flatten() {
        let output = Command::new(python)
            .args(["read.py", "design.edif"])
            .current_dir(folder.path())
            .output()
            .map_err(|_| SynthesisError::Missing(SPYDRNET))?;
        if output.status.code() == Some(LACKING) {
            continue;
        }
        if !output.status.success() {
            return Err(unread(String::from_utf8_lossy(&output.stderr).trim().to_owned()));
        }
        return serde_json::from_slice(&output.stdout).map_err(|error| unread(error.to_string()));
    }
    Err(SynthesisError::Missing(SPYDRNET))
}

fn unread(what: String) -> SynthesisError {
    SynthesisError::Unread { tool: SPYDRNET.name, what }
}
