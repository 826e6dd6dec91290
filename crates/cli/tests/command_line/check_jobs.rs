//! `check` of captures of G-code programs: by carrystep and by others, whole and with planted
//! faults.

use crate::command::Folder;
use crate::peak;
use crate::schemas;
use serde_json::Value;
use std::fmt::Write as _;
use std::process::{Command, Stdio};

const MACHINE: &str = include_str!("../../../../sim/jobs/machine.toml");
const SQUARE: &str = include_str!("../../../../sim/jobs/square_and_arc.ngc");

/// A pin changes: time in ps, axis, whether it is STEP, level.
#[derive(Clone, Copy)]
struct Change {
    ps: u64,
    axis: usize,
    step: bool,
    level: bool,
}

/// The changes of the pins of x, y and z in a capture by carrystep, and the origin that it names.
fn read(vcd: &str) -> (Vec<Change>, i64) {
    let (mut codes, mut axis, mut ps) = (Vec::new(), 0, 0);
    let (mut changes, mut origin, mut settled) = (Vec::new(), 0, false);
    for line in vcd.lines() {
        let words: Vec<&str> = line.split_whitespace().collect();
        if let Some(at) = words.iter().find_map(|word| word.strip_prefix("origin_ps=")) {
            origin = at.parse().unwrap();
        }
        match words[..] {
            ["$scope", "module", name, ..] => {
                axis = ["x", "y", "z"].iter().position(|axis| *axis == name).unwrap_or(9);
            }
            ["$var", _, "1", code, name, ..] => codes.push((code.to_owned(), axis, name == "step")),
            _ => {}
        }
        if let Some(time) = line.strip_prefix('#') {
            ps = time.parse().unwrap();
            settled = ps > 0;
        } else if let Some(code) = line.strip_prefix(['0', '1'])
            && settled
        {
            let (_, axis, step) = codes.iter().find(|known| known.0 == code).unwrap();
            let level = line.starts_with('1');
            changes.push(Change { ps, axis: *axis, step: *step, level });
        }
    }
    (changes, origin)
}

/// A capture of another program: its own time, its own unit, its own names.
fn foreign(changes: &[Change], offset_ps: u64, sample_ps: u64) -> String {
    let unit = if sample_ps == 1 { "1 ps".to_owned() } else { format!("{} ns", sample_ps / 1000) };
    let mut text = format!("$timescale {unit} $end\n$scope module la $end\n");
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        for (pin, step) in [("step", true), ("dir", false)] {
            let code = char::from(b'A' + axis as u8 * 2 + u8::from(step));
            let _ = writeln!(text, "$var wire 1 {code} {name}_{pin} $end");
        }
    }
    text += "$upscope $end\n$enddefinitions $end\n#0\n";
    for axis in 0..3_u8 {
        let _ =
            write!(text, "0{}\n0{}\n", char::from(b'A' + axis * 2), char::from(b'B' + axis * 2));
    }
    let mut changes = changes.to_vec();
    changes.sort_by_key(|change| change.ps);
    for Change { ps, axis, step, level } in changes {
        let code = char::from(b'A' + axis as u8 * 2 + u8::from(step));
        let _ = writeln!(text, "#{}\n{}{code}", (ps + offset_ps) / sample_ps, u8::from(level));
    }
    text
}

const MAP: &str = "--map x.step=la.x_step --map x.dir=la.x_dir --map y.step=la.y_step \
                   --map y.dir=la.y_dir --map z.step=la.z_step --map z.dir=la.z_dir";

/// A job with its capture by carrystep.
fn captured() -> (Folder, Vec<Change>, i64) {
    let folder = Folder::new();
    folder.write("m.toml", MACHINE);
    folder.write("job.ngc", SQUARE);
    assert_eq!(folder.run("simulate job.ngc --machine m.toml --vcd own.vcd").status, 0);
    let (changes, origin) = read(&std::fs::read_to_string(folder.path("own.vcd")).unwrap());
    assert_eq!(changes.iter().filter(|change| change.step && change.level).count(), 9606 + 9598);
    (folder, changes, origin)
}

/// The check of a capture, with its exit status.
fn check(folder: &Folder, capture: &str, more: &str) -> (i32, Value) {
    let ran = folder.run(&format!("check {capture} job.ngc --machine m.toml --json{more}"));
    assert_eq!(ran.stderr, "");
    (ran.status, schemas::check(&ran.stdout)["check"].clone())
}

#[test]
fn own_capture_passes_with_its_own_origin() {
    let (folder, _, origin) = captured();
    let (status, found) = check(&folder, "own.vcd", "");
    assert_eq!(
        (status, &found["origin"], &found["origin_ps"]),
        (0, &"known".into(), &origin.into())
    );
    for axis in found["times"].as_array().unwrap().iter().take(2) {
        let error = |name: &str| axis[name].as_f64().unwrap();
        // The gateware places edges at the phase before their time.
        assert!(error("error_min_ns") >= -62.6 && error("error_max_ns") <= 0.1, "{axis}");
        assert!(error("error_min_ns") < -50.0, "phases are seen: {axis}");
    }
    // Another program, another tolerance, another machine.
    folder.write("other.ngc", SQUARE.replace("G3 X0 Y0 I-20 J0", "G2 X0 Y0 I-20 J0"));
    assert_eq!(folder.run("check own.vcd other.ngc --machine m.toml").status, 1);
    folder.write("slow.toml", MACHINE.replace("1000", "900"));
    assert_ne!(folder.run("check own.vcd job.ngc --machine slow.toml").status, 0);
    let table = folder.run("check own.vcd job.ngc --machine m.toml --junit j.xml");
    assert!(table.stdout.ends_with("ALL HOLDS\n"), "{}", table.stdout);
    let xml = std::fs::read_to_string(folder.path("j.xml")).unwrap();
    assert!(xml.contains("path") && xml.contains("axis z"), "{xml}");
}

#[test]
fn foreign_capture_passes_with_one_offset_that_is_reported() {
    let (folder, changes, origin) = captured();
    let offset = 987_654_321;
    folder.write("la.vcd", foreign(&changes, offset, 1));
    let (status, found) = check(&folder, "la.vcd", &format!(" {MAP}"));
    assert_eq!((status, &found["origin"]), (0, &"midpoint".into()), "{found}");
    let wrong = found["origin_ps"].as_i64().unwrap() - origin - offset as i64;
    assert!(wrong.abs() <= 62_500, "{wrong} ps");
    // Logic analysers with samples of 100 ns and of 10 ns.
    folder.write("la.vcd", foreign(&changes, offset, 100_000));
    assert_eq!(check(&folder, "la.vcd", &format!(" {MAP}")).0, 1);
    assert_eq!(check(&folder, "la.vcd", &format!(" {MAP} --slack-ns 100")).0, 0);
    folder.write("la.vcd", foreign(&changes, offset, 10_000));
    assert_eq!(check(&folder, "la.vcd", &format!(" {MAP} --slack-ns 10")).0, 0);
    let fixed = format!(" {MAP} --slack-ns 10 --origin-ps {}", origin + offset as i64);
    assert_eq!(check(&folder, "la.vcd", &fixed).0, 0);
    let fixed = format!(" {MAP} --slack-ns 10 --origin-ps {}", origin + offset as i64 + 200_000);
    assert_eq!(check(&folder, "la.vcd", &fixed).0, 1);
}

/// The failures of a capture with planted changes, as carrystep's and as another's; with the times
/// and without.
fn failures(plant: impl Fn(&mut Vec<Change>)) -> [Vec<String>; 2] {
    let (folder, mut changes, _) = captured();
    plant(&mut changes);
    folder.write("la.vcd", foreign(&changes, 55_555, 1));
    ["", " --path-only"].map(|more| {
        let (status, found) = check(&folder, "la.vcd", &format!(" {MAP}{more}"));
        let axes = found["times"].as_array().cloned().unwrap_or_default();
        let lists = axes.iter().chain([&found["path"]]).map(|one| &one["failures"]);
        let failures: Vec<String> = lists
            .flat_map(|list| list.as_array().unwrap())
            .map(|text| text.as_str().unwrap().to_owned())
            .collect();
        assert_eq!(status == 0, failures.is_empty(), "{failures:?}");
        failures
    })
}

#[track_caller]
fn says(failures: &[String], part: &str) {
    assert!(failures.iter().any(|failure| failure.contains(part)), "{part}: {failures:?}");
}

/// The places of the rising edges of STEP of an axis.
fn rises(changes: &[Change], axis: usize) -> Vec<usize> {
    (0..changes.len())
        .filter(|&at| changes[at].axis == axis && changes[at].step && changes[at].level)
        .collect()
}

#[test]
fn lost_pulse_is_caught() {
    let [times, path] = failures(|changes| {
        let at = rises(changes, 0)[700];
        let fall =
            (at + 1..changes.len()).find(|&k| changes[k].axis == 0 && changes[k].step).unwrap();
        changes.remove(fall);
        changes.remove(at);
    });
    says(&times, "axis x: 9605 pulses, the plan makes 9606");
    says(&path, "axis x: the pulses end at");
}

#[test]
fn doubled_pulse_is_caught() {
    let [times, path] = failures(|changes| {
        let Change { ps, .. } = changes[rises(changes, 1)[1000]];
        let new = |ps, level| Change { ps, axis: 1, step: true, level };
        changes.extend([new(ps + 40_000_000, true), new(ps + 40_200_000, false)]);
    });
    says(&times, "axis y: 9599 pulses, the plan makes 9598");
    says(&path, "axis y: the pulses end at");
}

#[test]
fn late_pulse_is_caught_by_its_time_alone() {
    let [times, path] = failures(|changes| {
        let at = rises(changes, 0)[5000];
        changes[at].ps += 1_000_000;
        let fall =
            (at..changes.len()).find(|&k| changes[k].axis == 0 && !changes[k].level).unwrap();
        changes[fall].ps += 1_000_000;
    });
    says(&times, "axis x: pulse 5001 at ");
    says(&times, " ns late");
    assert_eq!(path, Vec::<String>::new());
}

#[test]
fn swapped_axes_are_caught() {
    let [times, path] = failures(|changes| {
        changes.iter_mut().for_each(|change| change.axis = [1, 0, 2][change.axis]);
    });
    says(&times, "axis x: ");
    says(&path, "the tool leaves the path");
}

#[test]
fn axis_that_is_late_is_caught() {
    let late = |by: u64| {
        failures(move |changes: &mut Vec<Change>| {
            let of_y = changes.iter_mut().filter(|change| change.axis == 1);
            of_y.for_each(|change| change.ps += by);
        })
    };
    // By 5 us only the times show it, by 5 ms the path does, too.
    let [times, path] = late(5_000_000);
    says(&times, "axis x: pulse ");
    says(&times, "axis y: pulse ");
    assert_eq!(path, Vec::<String>::new());
    says(&late(5_000_000_000)[1], "the tool leaves the path");
}

#[test]
fn capture_of_another_controller_is_checked_by_its_path() {
    let [times, path] = failures(|changes| {
        changes.iter_mut().for_each(|change| change.ps = change.ps * 17 / 10);
    });
    says(&times, " ns late");
    assert_eq!(path, Vec::<String>::new());
}

#[test]
fn options_of_move_files_and_of_programs_are_not_mixed() {
    let (folder, ..) = captured();
    folder.write("move.toml", crate::command::GOOD);
    for (arguments, says) in [
        ("check own.vcd job.ngc", "needs a machine"),
        ("check own.vcd job.ngc --machine m.toml --fit-ns 5", "--fit-ns is not available"),
        (
            "check own.vcd job.ngc --machine m.toml --slice 1/2 --out s",
            "--slice is not available for G-code programs: each slice would have to plan the program",
        ),
        (
            "check own.vcd job.ngc --machine m.toml --merge s",
            "leave out --merge: the memory of a check does not grow with the capture",
        ),
        ("check own.vcd move.toml --path-only", "--path-only is an option of G-code programs"),
        ("check own.vcd move.toml --machine m.toml", "--machine is an option of G-code programs"),
        ("check m.toml job.ngc --machine m.toml", "m.toml"),
    ] {
        folder.run(arguments).refuses(says);
    }
}

/// Ten times the job needs the same memory, also where no pulse of an axis comes.
#[test]
fn memory_of_a_check_does_not_grow_with_the_capture() {
    let (folder, ..) = captured();
    let mut peaks = Vec::new();
    for rounds in [2, 20] {
        let text =
            format!("G64 P0.01 F6000\no1 repeat [{rounds}]\nG1 X20 Y20\nX0\nY0\no1 endrepeat\n");
        folder.write("job.ngc", text);
        assert_eq!(folder.run("simulate job.ngc --machine m.toml --vcd own.vcd").status, 0);
        let (mut changes, _) = read(&std::fs::read_to_string(folder.path("own.vcd")).unwrap());
        changes.retain(|change| change.axis != 1);
        folder.write("la.vcd", foreign(&changes, 0, 1));
        for capture in ["own.vcd".to_owned(), format!("la.vcd {MAP}")] {
            let arguments = format!("check {capture} job.ngc --machine m.toml");
            let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
            command.args(arguments.split(' ')).current_dir(folder.path("")).stdout(Stdio::null());
            let (status, bytes) = peak::memory(command.stderr(Stdio::null())).unwrap();
            assert_eq!(status.code(), Some(i32::from(capture != "own.vcd")));
            peaks.push(bytes);
        }
    }
    assert!(peaks[2] < peaks[0] + 4_000_000 && peaks[3] < peaks[1] + 4_000_000, "{peaks:?}");
}
