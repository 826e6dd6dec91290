//! Installs the tools that the tests need beside Cargo, by apt where possible. A new tool is a row
//! of `NEEDED`.

use crate::shell::{self, TaskResult};
use std::path::Path;

/// Each program, and the Debian package that contains it.
const NEEDED: [(&str, &str); 24] = [
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

/// The folder of daemons, which is not on every user's path.
const DAEMONS: &str = "/usr/sbin";

/// Installs the missing tools, or reports which ones must be installed by hand.
pub fn install() -> TaskResult {
    let missing = missing();
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
    match self::missing().as_slice() {
        [] => Ok(()),
        still => Err(format!("still missing after apt-get: {}\n{advice}", still.join(", "))),
    }
}

fn missing() -> Vec<&'static str> {
    let mut packages: Vec<&str> = NEEDED
        .iter()
        .filter(|(program, _)| {
            !shell::is_there(program) && !Path::new(DAEMONS).join(program).exists()
        })
        .map(|&(_, package)| package)
        .collect();
    packages.dedup();
    packages
}
