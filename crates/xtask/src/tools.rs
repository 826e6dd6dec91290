//! Installs the tools that the tests need beside Cargo, by apt where possible. A new tool is a row
//! of `NEEDED`.

use crate::shell::{self, TaskResult};
use std::path::Path;

/// Each program, and the Debian package that contains it.
const NEEDED: &[(&str, &str)] = &[
    ("iverilog", "iverilog"),
    ("vvp", "iverilog"),
    ("verilator", "verilator"),
    ("g++", "g++"),
    ("gcc", "gcc"),
    ("nm", "binutils"),
    ("make", "make"),
    ("yosys", "yosys"),
    ("yosys-smtbmc", "yosys"),
    ("z3", "z3"),
    ("nextpnr-ice40", "nextpnr-ice40"),
    ("icepack", "fpga-icestorm"),
    ("icebox_vlog", "fpga-icestorm"),
    ("icetime", "fpga-icestorm-chipdb"),
    ("slurmctld", "slurmctld"),
    ("slurmd", "slurmd"),
    ("sbatch", "slurm-client"),
    ("munged", "munge"),
    ("parallel", "parallel"),
    ("hostname", "hostname"),
    ("rs274", "linuxcnc-uspace"),
    ("halcompile", "linuxcnc-uspace-dev"),
    ("valgrind", "valgrind"),
    ("chromium", "chromium"),
];

/// The same for the long run of senders alone, because these packages are large.
const OF_SENDERS: &[(&str, &str)] = &[("node", "nodejs"), ("npm", "npm"), ("python3", "python3")];

/// Modules of Python for that run, which have packages of their own in Debian.
const MODULES_OF_SENDERS: [(&str, &str); 2] =
    [("tkinter", "python3-tk"), ("ensurepip", "python3-venv")];

/// The folder of daemons, which is not on every user's path.
const DAEMONS: &str = "/usr/sbin";

/// Installs the missing tools, or reports which ones must be installed by hand.
///
/// # Errors
/// A tool is missing and cannot be installed.
pub fn install() -> TaskResult {
    install_of(|| missing(NEEDED))
}

/// Installs what the long run of senders needs beside that.
///
/// # Errors
/// A tool is missing and cannot be installed.
pub fn install_for_senders() -> TaskResult {
    install_of(|| {
        let lacks =
            |module: &str| shell::read("python3", &["-c", &format!("import {module}")]).is_err();
        let modules = MODULES_OF_SENDERS.iter().filter(|(module, _)| lacks(module));
        missing(OF_SENDERS).into_iter().chain(modules.map(|&(_, package)| package)).collect()
    })
}

/// Installs the packages that this names, which must name none then.
fn install_of(find: impl Fn() -> Vec<&'static str>) -> TaskResult {
    let missing = find();
    if missing.is_empty() {
        return Ok(());
    }
    let line = format!("apt-get install -y --no-install-recommends {}", missing.join(" "));
    let advice = format!("missing for the tests: {}\n  install: sudo {line}", missing.join(", "));
    if !shell::is_there("apt-get") {
        return Err(format!(
            "{advice}\n  (this system has no apt-get: use its own packages of these names)"
        ));
    }
    let root = shell::read("id", &["-u"]).is_ok_and(|id| id.trim() == "0");
    let before: &[&str] = if root { &[] } else { &["sudo", "-n"] };
    let apt = |arguments: &[&str]| {
        let words: Vec<&str> =
            before.iter().chain(&["apt-get"]).chain(arguments).copied().collect();
        shell::run(words[0], &words[1..])
    };
    let packages: Vec<&str> =
        ["install", "-y", "--no-install-recommends"].into_iter().chain(missing).collect();
    apt(&["update"]).and_then(|()| apt(&packages)).map_err(|error| format!("{error}\n{advice}"))?;
    match find().as_slice() {
        [] => Ok(()),
        still => Err(format!("still missing after apt-get: {}\n{advice}", still.join(", "))),
    }
}

fn missing(needed: &[(&'static str, &'static str)]) -> Vec<&'static str> {
    let mut packages: Vec<&str> = needed
        .iter()
        .filter(|(program, _)| {
            !shell::is_there(program) && !Path::new(DAEMONS).join(program).exists()
        })
        .map(|&(_, package)| package)
        .collect();
    packages.dedup();
    packages
}
