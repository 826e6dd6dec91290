//! Which tool it is that answers: its version, and which file it is.

use crate::programs::{
    FLOWS, GXX, ICARUS, ICEBOX_VLOG, ICETIME, PYTHON, SH, Tool, VERILATOR, VVP, YOSYS, YOSYS_ABC,
    YOSYS_SMTBMC, Z3,
};
use std::collections::HashMap;
use std::ffi::OsString;
use std::fs;
use std::process::Command;
use std::sync::Mutex;

/// Tools that others start, and those that come in one package and tell its version.
const WITH: [(&str, &[Tool]); 8] = [
    (ICARUS.name, &[VVP]),
    (VERILATOR.name, &[GXX]),
    (YOSYS.name, &[YOSYS_ABC]),
    (YOSYS_ABC.name, &[YOSYS]),
    (YOSYS_SMTBMC.name, &[YOSYS, Z3]),
    (ICEBOX_VLOG.name, &[PYTHON, ICETIME]),
    (PYTHON.name, &[ICEBOX_VLOG]),
    (SH.name, &FLOWS),
];

/// What a tool from pip is called.
pub(super) fn name_of_pip(name: &str) -> String {
    format!("yowasp-{name}")
}

/// What is known of a tool, by its name and the path on which it is looked for.
type Known = HashMap<(&'static str, Option<OsString>), String>;

/// A tool and those that it starts: place, size, date and version of each. None where it is not
/// found.
pub(super) fn of(tool: &Tool) -> Option<String> {
    static KNOWN: Mutex<Option<Known>> = Mutex::new(None);
    // Tests change the path on which tools are looked for.
    let key = (tool.name, std::env::var_os("PATH"));
    let mut known = KNOWN.lock().ok()?;
    let known = known.get_or_insert_default();
    if let Some(text) = known.get(&key) {
        return Some(text.clone());
    }
    let with = WITH.iter().find(|(name, _)| *name == tool.name).map_or(&[][..], |(_, with)| with);
    let others = with.iter().map(|other| one(other).unwrap_or_default());
    let text: String = [one(tool)?].into_iter().chain(others).collect();
    known.insert(key, text.clone());
    Some(text)
}

fn one(tool: &Tool) -> Option<String> {
    let found =
        which::which_global(tool.name).or_else(|_| which::which_global(name_of_pip(tool.name)));
    let file = fs::canonicalize(found.ok()?).ok()?;
    let there = fs::metadata(&file).ok()?;
    let version = match tool.version {
        Some(option) => {
            let output = Command::new(&file).arg(option).output().ok()?;
            String::from_utf8_lossy(&[output.stdout, output.stderr].concat()).into_owned()
        }
        None => String::new(),
    };
    Some(format!("{} {} {:?} {version}\n", file.display(), there.len(), there.modified().ok()?))
}
