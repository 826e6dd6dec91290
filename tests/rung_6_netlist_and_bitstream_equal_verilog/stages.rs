//! The engine at each stage: Verilog, netlist, placed design, bitstream read back.

use carrystep_core::EngineBuild;
use carrystep_core::engine::Guard;
use carrystep_files::Machine;
use carrystep_tools::ice40::{self, Netlist, NextpnrPart, PlacedDesign};
use std::path::Path;
use std::sync::OnceLock;

/// A part with pins for all ports of the engine.
const PART: NextpnrPart<'static> = NextpnrPart { device: "hx8k", package: "ct256" };

pub struct Stages {
    pub build: EngineBuild,
    pub verilog: String,
    pub netlist: Netlist,
    pub placed: PlacedDesign,
    /// The bitstream, read back as Verilog.
    pub read_back: String,
}

impl Stages {
    fn new(build: EngineBuild, verilog: String) -> Self {
        let netlist = ice40::synthesise(&verilog, carrystep_verilog::ENGINE_NAME, PART.device)
            .expect("a netlist");
        let clock_hz = build.timebase.clock_hz();
        let placed = netlist.place(PART, clock_hz, 1).expect("a placed design");
        let read_back = placed.read_back(&netlist, &placed.asc).expect("a bitstream");
        Self { build, verilog, netlist, placed, read_back }
    }
}

fn root() -> &'static Path {
    Path::new(concat!(env!("CARGO_MANIFEST_DIR"), "/.."))
}

fn shipped_build() -> EngineBuild {
    Machine::load(&root().join("sim/six-axis.toml")).expect("a fine machine").engine()
}

/// The Verilog in `hdl-out`.
pub fn shipped() -> &'static Stages {
    static STAGES: OnceLock<Stages> = OnceLock::new();
    STAGES.get_or_init(|| {
        let file =
            root().join("hdl-out/core").join(format!("{}.v", carrystep_verilog::ENGINE_NAME));
        Stages::new(shipped_build(), std::fs::read_to_string(file).expect("the exported Verilog"))
    })
}

/// The same engine with a guard whose rounds are so short that all of its functions occur within
/// thousands of clocks.
pub fn hurried() -> &'static Stages {
    static STAGES: OnceLock<Stages> = OnceLock::new();
    STAGES.get_or_init(|| {
        let build = shipped_build();
        let guard = Guard { round: 2, debounce: 3, watchdog: 40, enable: 2, ..build.guard };
        let build = EngineBuild { guard, ..build };
        let verilog = carrystep_verilog::engine_verilog(&build, "a test").expect("a fine build");
        Stages::new(build, verilog)
    })
}
