//! The moves that every level runs, from `sim/bench/`.

use carrystep_core::ports::Inputs;
use carrystep_core::{AXES, Command, EngineBuild, Program, Timebase};
use carrystep_files::MoveFile;
use carrystep_model::Fast;
use carrystep_plan::{Plan, plan};
use carrystep_simulators::{Job, Outcome, fast};
use std::fmt::Write as _;
use std::path::Path;

/// A move with a certain density of edges.
#[derive(Debug, Clone, Copy)]
pub struct Density {
    /// The name of the move file without its extension, and of the ratio `ratio_NAME` in the
    /// report.
    pub name: &'static str,
    pub what: &'static str,
    /// The required ratio of the fast model's speed to that of Verilator.
    pub wanted: f64,
}

/// The moves of the comparison, from the densest to the sparsest.
pub const DENSITIES: [Density; 3] = [
    Density { name: "busy", what: "all axes near 100 000 steps/s", wanted: 300.0 },
    Density { name: "typical", what: "all axes near 10 000 steps/s", wanted: 1_000.0 },
    Density { name: "rest", what: "mostly at rest", wanted: 10_000.0 },
];

/// A move with edges as dense as those of the typical move, but with few loads of segments. The
/// difference of the two gives the cost of an edge and that of a load.
pub const STEADY: Density =
    Density { name: "steady", what: "all axes at 10 000 steps/s, few loads", wanted: 0.0 };

/// A clock, Hz, at which an engine of six axes finishes the time slots of all axes within a tick of
/// 1 us.
const ENGINE_HZ: u64 = 80_000_000;

/// A planned move, ready to run.
pub struct Moves {
    pub plan: Plan,
    /// The engine that makes the same pulses.
    pub engine: EngineBuild,
    pub program: Program,
    /// The end of the run on the fast model.
    pub outcome: Outcome,
}

impl Moves {
    /// Reads and plans one of the move files.
    pub fn load(density: &Density) -> Result<Self, String> {
        let root =
            Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap_or(Path::new("."));
        let path = root.join("sim/bench").join(density.name).with_extension("toml");
        let file = MoveFile::load(&path).map_err(|error| error.to_string())?;
        let plan = plan::<f64>(&file).map_err(|error| format!("{}: {error}", path.display()))?;
        let program = plan.program();
        let (tick_ns, phases) = (plan.build.timebase.tick_ns(), plan.build.timebase.phases());
        let timebase =
            Timebase::new(ENGINE_HZ, tick_ns, phases).map_err(|error| error.to_string())?;
        let engine = EngineBuild { timebase, ..file.machine.engine() };
        engine.check().map_err(|error| error.to_string())?;
        let outcome = fast::run(
            &Job::new(&plan.build, &program, plan.total_ticks()),
            &mut fast::EdgesOnly(()),
        )
        .map_err(|error| error.to_string())?;
        Ok(Self { plan, engine, program, outcome })
    }

    /// The move as the job of any level.
    pub fn job(&self) -> Job<'_> {
        Job::new(&self.plan.build, &self.program, self.plan.total_ticks())
    }

    /// Number of segments that are loaded.
    pub fn loads(&self) -> usize {
        self.program.iter().filter(|command| matches!(command, Command::Segment { .. })).count()
    }

    /// The commands with the cycle in which each is taken, as text for a harness without a host.
    pub fn feed(&self) -> String {
        let mut core = Fast::new(&self.plan.build, AXES);
        let mut text = String::new();
        for command in &self.program {
            let (inputs, line) = match *command {
                Command::Segment { axis, segment: s } => {
                    let line = format!(
                        "0 {axis:x} {:x} {:x} {:x} {:x} {}",
                        s.ticks,
                        s.v,
                        s.a,
                        s.j,
                        u8::from(s.last)
                    );
                    (Inputs { segment: Some((axis, s)), ..Inputs::default() }, line)
                }
                Command::Start { mask } => (
                    Inputs { start: Some(mask), ..Inputs::default() },
                    format!("1 {mask:x} 0 0 0 0 0"),
                ),
                Command::Wait { .. } | Command::Clear | Command::Outputs(_) => continue,
            };
            loop {
                let outputs = core.outputs(&inputs);
                let taken =
                    if inputs.start.is_some() { outputs.start_ready } else { outputs.seg_ready };
                if taken || core.leap(&inputs, u64::MAX, &mut ()) == 0 {
                    if taken {
                        // Writing to a string cannot fail.
                        let _ = writeln!(text, "{} {line}", core.cycle());
                    }
                    core.clock(&inputs, &mut ());
                }
                if taken {
                    break;
                }
            }
        }
        text
    }
}
