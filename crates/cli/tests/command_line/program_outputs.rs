//! Programs that switch outputs: when and where the pins change, and what is refused.

use crate::command::Folder;
use crate::schemas;
use std::collections::BTreeMap;

const MACHINE: &str = include_str!("../../../../sim/jobs/outputs.toml");
const PROGRAM: &str = include_str!("../../../../sim/jobs/outputs.ngc");
const STEPS_PER_MM: f64 = 80.0;

fn folder(program: &str) -> Folder {
    let folder = Folder::new();
    folder.write("m.toml", MACHINE);
    folder.write("job.ngc", program);
    folder
}

/// The changes of the outputs in a VCD: number, level, and the place of x and y in mm.
pub fn changes(vcd: &str) -> Vec<(usize, bool, [f64; 2])> {
    let mut signals = BTreeMap::new();
    let (mut scope, mut at, mut found) = ("", [0.0; 2], Vec::new());
    let mut begun = false;
    for line in vcd.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words[..] {
            ["$scope", _, name, ..] => scope = name,
            ["$upscope", ..] => scope = "carrystep",
            ["$var", _, _, code, name, ..] => {
                signals.insert(code, format!("{scope}.{name}"));
            }
            [time] if time.starts_with('#') => begun |= time != "#0",
            [value, code] if value.starts_with('b') => {
                let steps = i64::from_str_radix(&value[1..], 2).unwrap() as i32;
                let axis = ["x.position", "y.position"].iter().position(|s| *s == signals[code]);
                axis.into_iter().for_each(|axis| at[axis] = f64::from(steps) / STEPS_PER_MM);
            }
            [change] if begun && change.starts_with(['0', '1']) => {
                if let Some(number) = signals[&change[1..]].strip_prefix("carrystep.output_") {
                    found.push((number.parse().unwrap(), change.starts_with('1'), at));
                }
            }
            _ => {}
        }
    }
    found
}

#[test]
fn outputs_change_where_the_program_says() {
    let folder = folder(PROGRAM);
    let ran = folder.run("simulate job.ngc --machine m.toml --json --vcd job.vcd");
    assert_eq!((ran.status, ran.stderr.as_str()), (0, ""), "{}", ran.stdout);
    let outputs = &schemas::check(&ran.stdout)["outputs"];
    assert_eq!((&outputs["passed"], &outputs["changes"]), (&true.into(), &6.into()));
    let wanted = [
        (0, true, [0.0, 0.0]),
        (2, true, [0.0, 0.0]),
        (3, true, [5.0, 5.0]),
        (3, false, [15.0, 5.0]),
        (3, true, [15.0, 15.0]),
        (3, false, [5.0, 15.0]),
        (0, false, [5.0, 5.0]),
        (2, false, [5.0, 5.0]),
    ];
    let found = changes(&std::fs::read_to_string(folder.path("job.vcd")).unwrap());
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    for ((number, level, [x, y]), (wanted, high, place)) in found.into_iter().zip(wanted) {
        assert_eq!((number, level), (wanted, high));
        // At rest in the place itself; in motion within the tolerance and a segment of 4 ms at the
        // corner's speed.
        let off = (x - place[0]).hypot(y - place[1]);
        assert!(off <= if number == 3 { 0.3 } else { 1e-9 }, "{number} at {x} {y}: {off} mm");
    }
}

#[test]
fn plan_tells_the_changes_of_each_row() {
    let folder = folder("M3 S12000 M8\nG1 X1 F600\nM62 P3\nX2\nM2\n");
    let ran = folder.run("plan job.ngc --machine m.toml --json-lines");
    assert_eq!((ran.status, ran.stderr.as_str()), (0, ""));
    let documents = ran.stdout.lines().map(schemas::check);
    let changes: Vec<String> =
        documents.filter_map(|row| row.get("outputs").map(serde_json::Value::to_string)).collect();
    let row = |mask: u8, levels: u8, duty: &str| {
        format!(r#"{{"duty":{duty},"levels":{levels},"mask":{mask}}}"#)
    };
    assert_eq!(changes, [row(7, 5, "2048"), row(8, 8, "null"), row(7, 0, "0")]);
    let text = folder.run("plan job.ngc --machine m.toml --segments").stdout;
    for said in ["output 0 on\noutput 1 off\noutput 2 on\nduty 2048/4096\n", "output 3 on\n"] {
        assert!(text.contains(said), "{text}");
    }
}

#[test]
fn levels_agree_about_outputs() {
    let folder = folder("M3 S9000\nG1 X0.5 F3000\nM62 P3\nX1\nM64 P3\nM63 P3\nX0\nM5\n");
    let run = |level: &str| {
        let ran = folder.run(&format!("simulate job.ngc --machine m.toml --json --level {level}"));
        assert_eq!((ran.status, ran.stderr.as_str()), (0, ""), "{}", ran.stdout);
        schemas::check(&ran.stdout)["outputs"].clone()
    };
    let fast = run("fast");
    assert_eq!((&fast["passed"], &fast["changes"]), (&true.into(), &4.into()), "{fast}");
    assert_eq!(run("model"), fast);
}

#[test]
fn machine_without_outputs_says_what_is_not_switched() {
    let folder = folder("M3 S9000 M8\nM64 P9\nM68 E7 Q9\nG1 X0.5 F3000\nM2\n");
    folder.write("m.toml", include_str!("../../../../sim/jobs/machine.toml"));
    let ran = folder.run("simulate job.ngc --machine m.toml");
    assert_eq!(ran.status, 0, "{}", ran.stderr);
    for said in ["spindle (2, first in line 1)", "coolant (2, first", "output (2, first in line 2)"]
    {
        assert!(ran.stdout.contains(said), "{}", ran.stdout);
    }
    assert!(!ran.stdout.contains("outputs in their"), "{}", ran.stdout);
}

#[test]
fn outputs_that_do_not_exist_are_refused_with_their_lines() {
    for (line, said) in [
        ("M64 P4", "output 4 would change: the machine has 4 outputs, numbered from 0"),
        ("M62 P2", "output 2 would change: it is the machine's `flood`"),
        ("M3 S24001", "the spindle would turn at 24001 turns per minute: it has 24000 at most"),
        ("M68 E0 Q0.5", "analog output 0 would change: the machine has no such output"),
    ] {
        let folder = folder(&format!("G1 X1 F600\n{line}\nX2\n"));
        let ran = folder.run("plan job.ngc --machine m.toml");
        assert_eq!(ran.status, 2, "{line}: {}", ran.stdout);
        assert!(ran.stderr.contains(said) && ran.stderr.contains("job.ngc:2"), "{}", ran.stderr);
    }
    let folder = folder(PROGRAM);
    folder.write("m.toml", MACHINE.replace("spindle_reverse = 1\n", ""));
    folder.write("job.ngc", PROGRAM.replace("M3", "M4"));
    let ran = folder.run("plan job.ngc --machine m.toml");
    assert!(ran.stderr.contains("M4: no output of the machine reverses the spindle"));
    let ran = folder.run("simulate job.ngc --machine m.toml --core parallel");
    assert!(ran.status == 2 && ran.stderr.contains("the parallel core has no outputs"));
}
