//! Runs one axis of the exported Verilog in Icarus, without the tick counter and the shaper, so
//! that long programs need few clocks.

use crate::golden::Edge;
use carrystep_core::{Build, Segment};
use std::fmt::Write as _;
use std::process::Command;

const BENCH: &str = include_str!("axis_bench.v");

/// Runs segments back to back and returns every edge and the final P.
pub fn edges_in_icarus(build: &Build, segments: &[Segment]) -> (Vec<Edge>, u64) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let verilog = carrystep_verilog::parallel_verilog(build, 1, "a test").expect("the core");
    let mut program = String::new();
    for Segment { ticks, v, a, j, last } in segments {
        writeln!(program, "{ticks:x} {v:x} {a:x} {j:x} {}", u8::from(*last)).expect("a string");
    }
    for (name, text) in
        [("core.v", verilog.as_str()), ("bench.v", BENCH), ("program.txt", &program)]
    {
        std::fs::write(folder.path().join(name), text).expect("a file");
    }
    let run = |program: &str, arguments: &[&str]| {
        let output = Command::new(program).args(arguments).current_dir(&folder).output();
        let output = output
            .unwrap_or_else(|_| panic!("{program} is missing: sudo apt-get install iverilog"));
        let text = String::from_utf8([output.stdout, output.stderr].concat()).expect("text");
        assert!(output.status.success(), "{program}: {text}");
        text
    };
    run("iverilog", &["-g2005", "-s", "axis_bench", "-o", "bench.vvp", "bench.v", "core.v"]);
    let text = run("vvp", &["-n", "bench.vvp", "+program=program.txt"]);
    let (edges, p) = text.rsplit_once("P ").unwrap_or_else(|| panic!("no end: {text}"));
    let edge = |line: &str| {
        let mut fields = line.split(' ').map(|field| field.parse::<u64>().expect("a number"));
        let mut next = || fields.next().expect("three fields");
        let (tick, phase, back) = (next(), next(), next());
        (tick, phase as u32, if back == 1 { -1 } else { 1 })
    };
    (edges.lines().map(edge).collect(), u64::from_str_radix(p.trim(), 16).expect("P in hex"))
}
