//! `plan` and `simulate` with G-code programs.

use crate::command::{Folder, GOOD, Ran};
use crate::schemas;
use serde_json::Value;

const MACHINE: &str = include_str!("../../../../sim/jobs/machine.toml");
const JOBS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../sim/jobs");
const PROGRAMS: [&str; 4] =
    ["square_and_arc.ngc", "chords_and_star.ngc", "trochoid.ngc", "relief.ngc"];

/// A folder with the machine of `sim/jobs/` and this program.
fn folder(program: impl AsRef<[u8]>) -> Folder {
    let folder = Folder::new();
    folder.write("m.toml", MACHINE);
    folder.write("job.ngc", program);
    folder
}

#[track_caller]
fn document(ran: &Ran) -> Value {
    assert_eq!((ran.status, ran.stderr.as_str()), (0, ""), "{}", ran.stdout);
    schemas::check(&ran.stdout)
}

#[track_caller]
fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn every_program_is_simulated_and_stays_within_its_tolerance() {
    for name in PROGRAMS {
        let folder = folder(std::fs::read(format!("{JOBS}/{name}")).unwrap());
        let done = document(&folder.run("simulate job.ngc --machine m.toml --json"));
        let (plan, check) = (&done["plan"], &done["check"]);
        // One step of each axis: 1/80, 1/80 and 1/400 mm.
        let bound = 0.01 + (2.0 / 6400.0 + 1.0 / 160_000.0_f64).sqrt();
        assert!((number(&check["deviation_bound_mm"]) - bound).abs() < 1e-9, "{name}: {check}");
        assert!(number(&check["deviation_mm"]) <= bound, "{name}: {check}");
        assert!(number(&check["deviation_mm"]) > 0.005, "{name}: the tolerance is used: {check}");
        for (axis, pulses) in
            plan["axes"].as_array().unwrap().iter().zip(done["positions"].as_array().unwrap())
        {
            assert_eq!(axis["residue"], 0, "{name}");
            assert_eq!(axis["end_steps"], *pulses, "{name}");
            for [found, limit] in [
                ["speed_steps_per_s", "speed_limit_steps_per_s"],
                ["acceleration_steps_per_s2", "acceleration_limit_steps_per_s2"],
                ["jerk_steps_per_s3", "jerk_limit_steps_per_s3"],
            ] {
                let most = number(&axis[limit]) * (1.0 + 1e-9);
                assert!(number(&axis[found]) <= most, "{name}: {found}: {axis}");
            }
        }
    }
}

#[test]
fn cores_and_levels_give_the_same_pulses() {
    let folder = folder("G64 P0.05 F1200\nG1 X2 Y1\nG2 X4 I1\nG1 X0 Y0 Z-0.5\n");
    // The model executes each clock, so the machine has fewer of them in a second.
    let slow = MACHINE.replace("80_000_000\ntick_ns = 1000", "20_000_000\ntick_ns = 4000");
    folder.write("m.toml", slow);
    let run = |more: &str| {
        let done =
            document(&folder.run(&format!("simulate job.ngc --machine m.toml --json{more}")));
        (done["check"].clone(), done["positions"].clone())
    };
    let fast = run("");
    assert_eq!(run(" --level model"), fast);
    let (check, positions) = run(" --core parallel");
    assert_eq!((check["passed"].clone(), positions), (true.into(), fast.1));
}

#[test]
fn rows_of_a_plan_add_up_to_the_end_of_the_program() {
    let folder = folder("G1 X1.5 Y-2 F600\nX3\nG4 P0.1\nG0 Z1\n");
    let ran = folder.run("plan job.ngc --machine m.toml --json-lines");
    assert_eq!((ran.status, ran.stderr.as_str()), (0, ""));
    let documents: Vec<Value> = ran.stdout.lines().map(schemas::check).collect();
    let (end, rows) = documents.split_last().unwrap();
    let whole = |value: &Value| value.as_str().unwrap().parse::<i128>().unwrap();
    let (mut ticks, mut distances) = (0, [0_i128; 3]);
    for row in rows {
        let segments = row["segments"].as_array().unwrap();
        for (distance, segment) in distances.iter_mut().zip(segments) {
            assert_eq!(segment["ticks"], segments[0]["ticks"]);
            let n = i128::from(segment["ticks"].as_i64().unwrap());
            let [v, a, j] = ["v", "a", "j"].map(|name| whole(&segment[name]));
            *distance += n * v + n * (n - 1) / 2 * a + n * (n - 1) * (n - 2) / 6 * j;
        }
        ticks += segments[0]["ticks"].as_u64().unwrap();
    }
    assert_eq!(distances, [240, -160, 400].map(|steps: i128| steps << 64));
    assert_eq!((&end["total_ticks"], &end["rows"]), (&ticks.into(), &rows.len().into()));
    let last = |row: &Value| row["segments"][0]["last"] == true;
    assert!(rows.iter().position(last) == Some(rows.len() - 1));
}

#[test]
fn a_greater_tolerance_is_faster() {
    let folder = folder("F6000\nG1 X10\nY10\nX0\nY0\n");
    let seconds = |mm: &str| {
        let ran = folder.run(&format!("plan job.ngc --machine m.toml --json --tolerance {mm}"));
        number(&document(&ran)["total_s"])
    };
    assert!(seconds("0.1") < seconds("0.01") && seconds("0.01") < seconds("0.002"));
}

#[test]
fn options_of_programs_are_read() {
    let folder = folder("G91 G1 X5 F600\n");
    let plan = document(&folder.run("plan job.ngc --machine m.toml --json --at x=10,Z=-2.5"));
    let ends = |axis: &Value| (axis["start_steps"].clone(), axis["end_steps"].clone());
    let found: Vec<_> = plan["axes"].as_array().unwrap().iter().map(ends).collect();
    let steps = |from: i32, to: i32| (from.into(), to.into());
    assert_eq!(found, [steps(800, 1200), steps(0, 0), steps(-1000, -1000)]);
    let usage = |arguments: &str, says: &str| folder.run(arguments).refuses(says);
    usage("plan job.ngc", "add --machine");
    usage("plan job.ngc --machine m.toml --at q=1", "expected a letter");
    usage("plan job.ngc --machine m.toml --at x", "expected a letter");
    usage("plan job.ngc --machine m.toml --at a=1", "the start gives a");
    usage("plan job.ngc --machine m.toml --tolerance 0", "expected a tolerance");
    usage("plan job.ngc --machine m.toml --tolerance -1", "expected a tolerance");
    usage("plan job.ngc --machine m.toml --fit-ns 5", "--fit-ns is not available");
    usage("simulate job.ngc --machine m.toml --plot a.svg", "--plot is not available");
    usage("simulate job.ngc --machine m.toml --vcd a.vcd --from 1", "--from is not available");
    usage("plan job.ngc --machine no.toml", "no.toml");
    usage("plan no.ngc --machine m.toml", "no.ngc");
    folder.write("move.toml", GOOD);
    usage("plan move.toml --machine m.toml", "--machine is an option of G-code programs");
    usage("simulate move.toml --blocks 5", "--blocks is an option of G-code programs");
}

#[test]
fn names_that_end_in_nc_and_gcode_are_programs() {
    for name in ["a.nc", "b.gcode", "C.NGC"] {
        let folder = folder("");
        folder.write(name, "G1 X1 F600\n");
        let ran = folder.run(&format!("plan {name} --machine m.toml"));
        assert_eq!(ran.status, 0, "{name}: {}", ran.stderr);
    }
}

#[test]
fn a_dwell_without_moves_is_planned_and_simulated() {
    let folder = folder("G1 X0 F100\nG4 P0.1\n");
    let done = document(&folder.run("simulate job.ngc --machine m.toml --json"));
    assert_eq!(
        (&done["plan"]["moves"], &done["plan"]["total_ticks"]),
        (&0.into(), &100_000.into())
    );
    assert!(done["check"]["deviation_line"].is_null());
}

#[test]
fn switches_that_the_gateware_lacks_are_reported() {
    let folder = folder("M3 S1000\nG1 X1 F600\nM8\nG1 X2\nM0\nG1 X3\nM62 P1\nG1 X4\nM2\n");
    let ran = folder.run("plan job.ngc --machine m.toml");
    for line in [
        "not done: pause (1, first in line 5): the job rests; its time has no waiting",
        "not done: spindle (2, first in line 1): the job rests; nothing is switched",
        "not done: coolant (2, first in line 3): the job rests; nothing is switched",
        "not done: output (1, first in line 7): the job rests; nothing is switched",
        "no travel for x, y, z: no soft limits",
    ] {
        assert!(ran.stdout.contains(line), "wanted: {line}\n{}", ran.stdout);
    }
}

/// Programs with the place of their mistake and a part of the message.
const REFUSED: [(&str, (usize, usize), &str); 9] = [
    ("G0 X1\nG1 X2\n", (2, 1), "without a feed"),
    ("G0 X1\nG1 X2 F0\n", (2, 1), "feed of 0"),
    ("G1 X1 F600\nG2 X5 Y0 I1\n", (2, 1), "the arc does not meet its end"),
    ("G1 X1 F600\nG2 X1 I0\n", (2, 1), "the arc has a radius of 0"),
    ("G0 X1\nG0 B1\n", (2, 1), "b moves, and the machine has no axis b"),
    ("G0 X1\nG0 X-200\n", (2, 1), "beyond its travel of -100 to 250"),
    ("G0 X1\nG0 Y3 Q1\n", (2, 7), "Q"),
    ("o1 sub\nG0 X1\n", (1, 1), "is never closed"),
    ("G0 Z1e9\n", (1, 6), "uses E"),
];

#[test]
fn mistakes_are_refused_with_their_place_and_nothing_is_written() {
    let travel =
        MACHINE.replacen("steps_per_unit = 80", "steps_per_unit = 80\ntravel = [-100, 250]", 1);
    for (text, place, says) in REFUSED {
        let folder = folder(text);
        folder.write("m.toml", &travel);
        let arguments = "simulate job.ngc --machine m.toml --vcd out/a.vcd --csv out/a.csv";
        folder.run(arguments).refuses_at("job.ngc", place, says);
        folder.run(&format!("{arguments} --json")).refuses(says);
        folder.run("plan job.ngc --machine m.toml").refuses_at("job.ngc", place, says);
        assert_eq!(folder.files(), ["job.ngc", "m.toml"], "{text}");
    }
}

/// `simulate` plans while it runs, so that the run has begun when it reads the last line.
#[test]
fn mistake_behind_a_long_rest_is_refused_and_no_file_appears() {
    let folder = folder("G1 X1 F600\nG4 P300\nG1 X2 Q1\n");
    for level in ["fast", "fast --core parallel"] {
        let arguments = format!(
            "simulate job.ngc --machine m.toml --vcd new/a.vcd --csv a.csv --level {level}"
        );
        folder.run(&arguments).refuses_at("job.ngc", (3, 7), "Q");
        folder.run(&format!("{arguments} --json")).refuses("Q");
        assert_eq!(folder.files(), ["job.ngc", "m.toml"], "no folder either");
    }
}

#[test]
fn files_that_are_no_programs_are_refused() {
    let mut binary: Vec<u8> = (0..=255).collect();
    binary.extend([0; 100_000]);
    for bytes in [binary, vec![b'G'; 100_000], vec![0xff; 10], b"G0 X1\x1b[31m\n".to_vec()] {
        let folder = folder(&bytes);
        let ran = folder.run("simulate job.ngc --machine m.toml --vcd a.vcd");
        ran.refuses("[job.ngc:");
        assert_eq!(folder.files(), ["job.ngc", "m.toml"]);
    }
    let folder = folder("");
    folder.write("dir.ngc/file", "");
    folder.run("plan dir.ngc --machine m.toml").refuses("it is a folder");
}

#[test]
fn loops_without_end_are_refused() {
    let folder = folder("o1 while [1]\nG91 G0 X0.01\no1 endwhile\n");
    let ran = folder.run("plan job.ngc --machine m.toml --blocks 1000");
    ran.refuses("have run more than 1000 lines");
}

#[test]
fn output_never_replaces_the_program() {
    let folder = folder("G1 X1 F600\n");
    let ran = folder.run("simulate job.ngc --machine m.toml --csv job.ngc");
    ran.refuses("job.ngc");
    assert_eq!(std::fs::read_to_string(folder.path("job.ngc")).unwrap(), "G1 X1 F600\n");
}

#[test]
fn waveform_and_csv_have_every_pulse() {
    let folder = folder("G1 X2 Y-1 F600\nX0\n");
    let done =
        document(&folder.run("simulate job.ngc --machine m.toml --vcd a.vcd --csv a.csv --json"));
    assert_eq!(done["files"], serde_json::json!(["a.vcd", "a.csv"]));
    let read = |name: &str| std::fs::read_to_string(folder.path(name)).unwrap();
    let csv = read("a.csv");
    for axis in done["check"]["axes"].as_array().unwrap() {
        let name = format!("{},", axis["axis"].as_str().unwrap());
        let count = csv.lines().filter(|line| line.starts_with(&name)).count();
        assert_eq!(axis["pulses"], count, "{axis}");
    }
    assert!(read("a.vcd").contains("carrystep end"));
}

#[cfg(target_os = "linux")]
#[test]
fn memory_does_not_depend_on_the_length_of_a_program() {
    use std::process::{Command, Stdio};
    let folder = folder("F3000\no1 repeat [2500]\nG1 X1\nY1\nX0\nY0\no1 endrepeat\n");
    for arguments in ["plan job.ngc --machine m.toml", "simulate job.ngc --machine m.toml"] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
        command.args(arguments.split(' ')).current_dir(folder.path("")).stdout(Stdio::null());
        let (status, most) = crate::peak::memory(command.stderr(Stdio::null())).unwrap();
        assert_eq!(status.code(), Some(0), "{arguments}");
        assert!((1..64 << 20).contains(&most), "{arguments}: {most} bytes");
    }
}

/// A rotary axis alone, with X and Y, in inverse time, and corners within 0.01 degrees.
#[test]
fn rotary_axes_are_simulated_in_degrees() {
    let folder =
        folder("F600\nG1 A30\nF1200\nX30 Y40 A90\nG93\nG1 A60 F30\nX0 Y1 F20\nA62 F30\nX1 F20\n");
    folder.write("m.toml", MACHINE.replace("name = \"z\"", "name = \"a\"\nunit = \"deg\""));
    let done = document(&folder.run("simulate job.ngc --machine m.toml --json --vcd own.vcd"));
    assert_eq!((&done["passed"], &done["plan"]["rotary_deg"]), (&true.into(), &62.0.into()));
    let check = &done["check"];
    let (found, bound) = (number(&check["deviation_deg"]), number(&check["deviation_bound_deg"]));
    // One step is 1/400 degree.
    assert!((bound - 0.0125).abs() < 1e-9 && found <= bound + 1e-9, "{check}");
    assert_eq!(folder.run("check own.vcd job.ngc --machine m.toml").status, 0);
    folder.write("other.ngc", "F600\nG1 A30.1\n");
    assert_eq!(folder.run("check own.vcd other.ngc --machine m.toml --path-only").status, 1);
}
