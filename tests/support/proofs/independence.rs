//! Proves promise 16 on the exported engine: neither a snapshot nor a latch changes an edge.
//!
//! The engine is brought to single bits: each memory becomes flip-flops and multiplexers, each
//! operation gates. Then it is determined on which inputs an output depends, through any number of
//! flip-flops. If there is no path from the inputs of snapshots and latches to an output, no value
//! of these inputs changes it, in any clock.
//!
//! ```text
//! snapshot, latch, latch_arm, ... ---> state, refreshed, latch_armed, ...    what the host reads
//!                                 -/-> step, dir, enabled, fault, ...        all other outputs
//! ```

use super::builds::{
    engine_with_latch_on_adders, engine_with_latches, engine_with_outputs, exported,
};
use super::solver::{ProofError, run_until};
use super::{Bug, Case};
use carrystep_core::engine::{EngineBuild, Latch};
use carrystep_tools::programs::YOSYS;
use std::fs;
use std::sync::Arc;

/// The number of the promise.
pub const PROMISE: u32 = 16;

/// The label of what is proved.
const LABEL: &str = "promise_16_no_path_to_another_output";

/// The inputs that snapshots and latches have.
const REQUESTS: &str = "i:snapshot* i:latch* i:more_latch*";
/// The outputs that the host reads of them.
const READ: &str = "o:state* o:refreshed* o:latch* o:more_latch*";

/// Yosys commands that bring the engine to single bits.
const TO_BITS: &str = "proc\nflatten\nopt_clean\nmemory -nomap\nopt\nmemory_map\nopt\nsimplemap\n\
     opt_expr\nsplitnets -ports\nopt_clean\n";

/// Changes of an engine that make an output depend on a snapshot or a latch, each with the number of
/// the case in which it is planted.
pub const BUGS: &[(usize, Bug)] = &[
    (
        0,
        Bug {
            breaks: LABEL,
            text: "unfed <= unfed | (masked & queue_empty);",
            becomes: "unfed <= unfed | (masked & queue_empty) | readout_page[1];",
        },
    ),
    (
        0,
        Bug {
            breaks: LABEL,
            text: ".starts(going & masked),\n        .halted",
            becomes: ".starts(going & masked & !edge_latch_latches),\n        .halted",
        },
    ),
    (
        2,
        Bug {
            breaks: LABEL,
            text: ".starts(going & masked_1),\n        .halted",
            becomes: ".starts(going & masked_1 & !edge_latch_latches),\n        .halted",
        },
    ),
];

/// What an engine shows about its snapshots and latches.
#[derive(Debug)]
pub struct Paths {
    /// The inputs of snapshots and latches on which another output than theirs depends.
    pub harmful: Vec<String>,
    /// Those on which an output depends that the host reads of them.
    pub read: Vec<String>,
}

/// The engines for which it is proved: of two axes with four latches; of six axes with one latch, all
/// outputs, PWM and cuts; and of two axes on two adders.
pub fn cases() -> Vec<Case> {
    let (mut build, _) = engine_with_outputs(0xff, 2);
    build.guard.latches = vec![Latch::of_pin(false, 2)];
    let case = |(build, verilog): (EngineBuild, Arc<str>)| Case {
        name: format!(
            "{} axes on {}, {} latches",
            build.axes(),
            build.adders,
            build.guard.latches.len()
        ),
        dut: "carrystep_engine".into(),
        parameters: Vec::new(),
        verilog,
        numbers: Vec::new(),
    };
    [engine_with_latches(4), exported(build), engine_with_latch_on_adders()].map(case).into()
}

/// Finds the paths from snapshots and latches to the outputs of an engine.
///
/// # Errors
/// If yosys is missing or fails, or does not answer.
pub fn paths(case: &Case) -> Result<Paths, ProofError> {
    let dir = tempfile::tempdir()?;
    fs::write(dir.path().join("exported.v"), case.verilog.as_bytes())?;
    fs::write(dir.path().join("paths.ys"), script(case))?;
    let is_complete = |said: &str| said.contains("READ\n");
    let (fine, said) = run_until(dir.path(), YOSYS, &["-q", "paths.ys"], is_complete)?;
    let answers = said.split_once("HARMFUL\n").and_then(|(_, rest)| rest.split_once("READ\n"));
    let Some((harmful, read)) = answers.filter(|_| fine) else {
        return Err(ProofError::Tool { tool: "yosys", said });
    };
    let names = |text: &str| text.lines().map(str::to_owned).collect();
    Ok(Paths { harmful: names(harmful), read: names(read) })
}

fn script(case: &Case) -> String {
    format!(
        "read_verilog -sv exported.v\nhierarchy -check -top {dut}\n{TO_BITS}\
         select -set requests {REQUESTS}\n\
         select -set read {READ}\n\
         select -set read_cone @read %ci*\n\
         select -set other_cone o:* @read %d %ci*\n\
         tee -o /dev/stdout log HARMFUL\n\
         tee -o /dev/stdout select -list @other_cone @requests %i\n\
         tee -o /dev/stdout log READ\n\
         tee -o /dev/stdout select -list @read_cone @requests %i\n",
        dut = case.dut
    )
}
