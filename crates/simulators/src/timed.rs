//! Replays recorded cycles on Verilog with delays, in Icarus, and counts violations of set-up and
//! hold times.

use crate::LevelError;
use crate::tool::{self, ICARUS, VVP};
use crate::vectors::Vectors;
use carrystep_tools::timed::{LATEST, VIOLATION};
use std::collections::BTreeMap;
use std::io::{BufRead, BufReader};
use std::process::{Command, Stdio};

const BENCH: &str = include_str!("../bench/timed_bench.v");

/// Time from the clock's rising edge to a change of the inputs, ps. The clock reaches the registers
/// through a gate and a global buffer, the inputs reach their synchronisers after a wire: 5 ns lie
/// well between two edges of any clock up to 100 MHz.
const LATE_PS: u64 = 5_000;

/// What a simulation with delays came to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct TimedRun {
    /// Cycles that were run.
    pub cycles: u64,
    /// The first cycle in which an output just before the next clock edge is not the recorded one,
    /// or the first in which an output changes twice; `None` if there is neither.
    pub difference: Option<String>,
    /// Violations of set-up and hold times.
    pub violations: u64,
    /// The first of them.
    pub first_violation: Option<String>,
    /// For each cell with a clock, the shortest period at which no input of it would have changed
    /// within its set-up time, ps. Only for cells whose inputs come from registers of the same
    /// edge.
    pub needs_ps: BTreeMap<String, u64>,
    /// Moments at which outputs changed.
    pub changes: u64,
    /// The shortest and the longest time from the clock's rising edge to a change of an output, ps.
    pub change_ps: Option<(u64, u64)>,
}

impl Vectors {
    /// Replays at most `cycles` cycles on the module of this name in this Verilog, which has delays
    /// in ps and prints violations as [`carrystep_tools::timed`] does. `half_ps` is half a period
    /// of the clock, at least 1.
    ///
    /// # Errors
    /// [`LevelError`] if Icarus is missing or fails.
    pub fn timed(
        &self,
        module: &str,
        verilog: &str,
        half_ps: u64,
        cycles: u64,
    ) -> Result<TimedRun, LevelError> {
        tool::find(&ICARUS)?;
        let folder = tempfile::tempdir().map_err(tool::io("cannot make a temporary folder"))?;
        let bench = self.bench(BENCH, module);
        let files = [("module.v", verilog), ("bench.v", &bench), ("vectors.txt", &self.text())];
        tool::put(folder.path(), &files)?;
        let compiles = ["-g2005", "-o", "bench.vvp", "bench.v", "module.v"];
        tool::complete(&ICARUS, Command::new(ICARUS.name).args(compiles).current_dir(&folder))?;
        let mut runs = Command::new(VVP.name);
        runs.args(["-n", "bench.vvp", "+vectors=vectors.txt"])
            .args([format!("+half={half_ps}"), format!("+late={}", LATE_PS.min(half_ps))])
            .arg(format!("+cycles={cycles}"))
            .current_dir(&folder)
            .stdout(Stdio::piped())
            .stderr(Stdio::null());
        let mut child = runs.spawn().map_err(tool::io("cannot start the simulation"))?;
        let lines = child.stdout.take().map(BufReader::new).into_iter().flat_map(BufRead::lines);
        let (mut difference, mut violations, mut first, mut end) = (None, 0, None, None);
        let mut needs_ps = BTreeMap::new();
        for line in lines {
            let line = line.map_err(tool::io("reading from the simulation"))?;
            if line.starts_with(VIOLATION) {
                violations += 1;
                first.get_or_insert(line);
            } else if let Some((ps, cell)) = latest(&line) {
                needs_ps.insert(cell.to_owned(), ps);
            } else if let Some(numbers) = line.strip_prefix("end ") {
                end = numbers.split(' ').map(str::parse).collect::<Result<Vec<u64>, _>>().ok();
            } else {
                difference.get_or_insert(line);
            }
        }
        child.wait().map_err(tool::io("waiting for the simulation"))?;
        let Some([cycles, changes, least, most]) = end.as_deref() else {
            let message = difference.unwrap_or_else(|| "it stopped without a report".to_owned());
            return Err(LevelError::Tool { tool: ICARUS.name, message });
        };
        Ok(TimedRun {
            cycles: *cycles,
            difference,
            violations,
            first_violation: first,
            needs_ps,
            changes: *changes,
            change_ps: (*changes > 0).then_some((*least, *most)),
        })
    }
}

/// A line `LATEST PS CELL`; the cell without the names of the bench. Each is longer than the cell's
/// line before.
fn latest(line: &str) -> Option<(u64, &str)> {
    let (ps, cell) = line.strip_prefix(LATEST)?.trim_start().split_once(' ')?;
    Some((ps.parse().ok()?, cell.strip_prefix("timed_bench.module_of_vectors.").unwrap_or(cell)))
}
