//! `check` of the outputs in captures of programs: by carrystep and by others, whole and with
//! planted faults.

use crate::command::{Folder, Ran};
use crate::schemas;
use serde_json::Value;
use std::fmt::Write as _;

const TICK_PS: u64 = 1_000_000;

/// A capture as text: its header, and each change with its time.
#[derive(Clone)]
struct Lines {
    header: String,
    changes: Vec<(u64, String)>,
    end: String,
}

impl Lines {
    fn read(vcd: &str) -> Self {
        let (header, rest) = vcd.split_once("#0\n").unwrap();
        let (values, end) = rest.split_at(rest.find("$comment").unwrap());
        let (mut ps, mut changes) = (0, Vec::new());
        for line in values.lines() {
            match line.strip_prefix('#') {
                Some(time) => ps = time.parse().unwrap(),
                None => changes.push((ps, line.to_owned())),
            }
        }
        // The last time has no changes.
        Self { header: header.to_owned(), changes, end: format!("#{ps}\n{end}") }
    }

    /// The code of an output.
    fn code(&self, output: u8) -> String {
        let name = format!(" output_{output} $end");
        let line = self.header.lines().find(|line| line.ends_with(&name)).unwrap();
        line.split_whitespace().nth(3).unwrap().to_owned()
    }

    /// The places of the changes of an output, without its first level.
    fn of(&self, output: u8) -> Vec<usize> {
        let code = self.code(output);
        let changes = |at: &usize| {
            let (ps, line) = &self.changes[*at];
            *ps > 0 && line.strip_prefix(['0', '1']) == Some(code.as_str())
        };
        (0..self.changes.len()).filter(changes).collect()
    }

    fn text(&self) -> String {
        let mut changes = self.changes.clone();
        changes.sort_by_key(|(ps, _)| *ps);
        let mut text = format!("{}#0\n", self.header);
        let mut before = 0;
        for (ps, line) in changes {
            if ps > before {
                let _ = writeln!(text, "#{ps}");
                before = ps;
            }
            let _ = writeln!(text, "{line}");
        }
        text + &self.end
    }

    /// The same, as another program would write it: without a header of carrystep, with names of
    /// its own, and later.
    fn foreign(&self, later: u64) -> Self {
        let lines = self.header.lines().filter(|line| !line.contains("carrystep origin"));
        let header = lines.fold(String::new(), |text, line| text + line + "\n");
        let header = header.replace(" output_", " la_");
        let moved =
            |(ps, line): &(u64, String)| (if *ps > 0 { ps + later } else { 0 }, line.clone());
        Self { header, changes: self.changes.iter().map(moved).collect(), end: String::new() }
    }
}

/// A folder with `sim/jobs/outputs.ngc`, and its capture by carrystep.
fn captured() -> (Folder, Lines) {
    let folder = Folder::new();
    folder.write("m.toml", include_str!("../../../../sim/jobs/outputs.toml"));
    folder.write("job.ngc", include_str!("../../../../sim/jobs/outputs.ngc"));
    assert_eq!(folder.run("simulate job.ngc --machine m.toml --vcd own.vcd").status, 0);
    let lines = Lines::read(&std::fs::read_to_string(folder.path("own.vcd")).unwrap());
    assert_eq!([0, 1, 2, 3].map(|output| lines.of(output).len()), [2, 0, 2, 4]);
    (folder, lines)
}

fn check(folder: &Folder, more: &str) -> Ran {
    folder.run(&format!("check c.vcd job.ngc --machine m.toml{more}"))
}

fn document(folder: &Folder, more: &str) -> (i32, Value) {
    let ran = check(folder, &format!(" --json{more}"));
    assert_eq!(ran.stderr, "");
    (ran.status, schemas::check(&ran.stdout)["check"].clone())
}

/// The failures of a capture with planted changes: with the times, and by the path alone.
#[track_caller]
fn failures(plant: impl FnOnce(&mut Lines)) -> [Vec<String>; 2] {
    let (folder, mut lines) = captured();
    plant(&mut lines);
    folder.write("c.vcd", lines.text());
    ["", " --path-only"].map(|more| {
        let (status, found) = document(&folder, more);
        let of = |key: &str| found[key].as_array().cloned().unwrap_or_default();
        let all = of("times").into_iter().chain(of("output_times")).chain([found["path"].clone()]);
        let lists = all.flat_map(|one| one["failures"].as_array().unwrap().clone());
        let failures: Vec<String> = lists.map(|text| text.as_str().unwrap().to_owned()).collect();
        assert_eq!(status == 0, failures.is_empty(), "{failures:?}");
        failures
    })
}

#[test]
fn outputs_of_an_own_capture_pass() {
    let (folder, lines) = captured();
    folder.write("c.vcd", lines.text());
    let (status, found) = document(&folder, "");
    assert_eq!((status, &found["outputs_not_checked"]), (0, &Value::Array(Vec::new())));
    assert_eq!(found["path"]["output_changes"], 6);
    let outputs = found["output_times"].as_array().unwrap();
    let counts: Vec<_> = outputs.iter().map(|one| one["changes_found"].as_u64().unwrap()).collect();
    assert_eq!(counts, [2, 0, 2, 4]);
    assert_eq!(
        (&outputs[3]["error_min_ns"], &outputs[3]["error_max_ns"]),
        (&0.0.into(), &0.0.into())
    );
    let ran = check(&folder, " --junit j.xml");
    assert!(ran.stdout.contains("3           4/4    0.0    0.0    2.0\n"), "{}", ran.stdout);
    assert!(std::fs::read_to_string(folder.path("j.xml")).unwrap().contains("output 3"));
}

#[test]
fn output_that_is_late_by_a_tick_is_caught_by_its_time() {
    let [times, path] = failures(|lines| {
        let at = lines.of(3)[1];
        lines.changes[at].0 += TICK_PS;
    });
    assert_eq!(times.len(), 1, "{times:?}");
    assert!(times[0].starts_with("output 3: change 2 at "), "{times:?}");
    assert!(times[0].ends_with(" s is 1000.0 ns late, the bound is 2.0 ns"), "{times:?}");
    assert_eq!(path, Vec::<String>::new());
}

#[test]
fn output_that_is_early_by_a_clock_is_caught_by_its_time() {
    let [times, _] = failures(|lines| {
        let at = lines.of(0)[0];
        lines.changes[at].0 -= 12_500;
    });
    assert!(times[0].contains("output 0: change 1 at ") && times[0].contains("12.5 ns early"));
}

#[test]
fn output_that_is_missing_is_caught_by_both() {
    let [times, path] = failures(|lines| {
        let of_flood = lines.of(2);
        lines.changes.remove(of_flood[1]);
        lines.changes.remove(of_flood[0]);
    });
    assert_eq!(times[0], "output 2: 0 changes, the plan makes 2");
    assert!(path[0].starts_with("output 2 does not change where line 3 does it"), "{path:?}");
}

#[test]
fn wrong_output_is_caught_by_both() {
    let [times, path] = failures(|lines| {
        let (wrong, at) = (lines.code(1), lines.of(3));
        at.into_iter().for_each(|at| lines.changes[at].1.replace_range(1.., &wrong));
    });
    assert!(times.iter().any(|one| one == "output 1: 4 changes, the plan makes 0"), "{times:?}");
    assert!(times.iter().any(|one| one == "output 3: 0 changes, the plan makes 4"), "{times:?}");
    assert!(path[0].starts_with("output 1 changes before the tool is where line"), "{path:?}");
}

/// The place is compared with the program, whatever the plan says.
#[test]
fn output_that_changes_at_the_next_corner_is_caught_by_its_place() {
    let [_, path] = failures(|lines| {
        let of_three = lines.of(3);
        lines.changes[of_three[1]].0 = lines.changes[of_three[2]].0 - 10 * TICK_PS;
    });
    assert!(path[0].starts_with("output 3 does not change where line 9 does it"), "{path:?}");
}

#[test]
fn foreign_capture_without_outputs_says_so() {
    let (folder, lines) = captured();
    folder.write("c.vcd", lines.foreign(777_777).text());
    let (status, found) = document(&folder, "");
    assert_eq!((status, &found["outputs_not_checked"]), (0, &serde_json::json!([0, 1, 2, 3])));
    assert_eq!(
        (&found["output_times"], &found["path"]["output_changes"]),
        (&serde_json::json!([]), &Value::Null)
    );
    let ran = check(&folder, "");
    let said = "not checked: output 0, 1, 2, 3; the capture does not show it\n";
    assert!(ran.stdout.contains(said), "{}", ran.stdout);
}

#[test]
fn outputs_of_a_foreign_capture_are_found_by_the_map() {
    let map = " --map output_3=carrystep.la_3 --map output_0=carrystep.la_0";
    let (folder, lines) = captured();
    folder.write("c.vcd", lines.foreign(777_777).text());
    let (status, found) = document(&folder, map);
    assert_eq!((status, &found["outputs_not_checked"]), (0, &serde_json::json!([1, 2])), "{found}");
    assert_eq!(found["origin"], "midpoint");
    let mut late = lines.foreign(777_777);
    // The codes of the signals are those of the own capture.
    lines.of(3).iter().take(1).for_each(|at| late.changes[*at].0 += TICK_PS);
    folder.write("c.vcd", late.text());
    let ran = check(&folder, map);
    assert_eq!(ran.status, 1);
    assert!(ran.stdout.contains("FAILED output 3: change 1 at "), "{}", ran.stdout);
    for (map, says) in [
        (
            " --map output_4=carrystep.la_3",
            "outputs are compared with programs on machines that have",
        ),
        (" --map output_3=carrystep.la_9", "carrystep.la_9 for output_3"),
        (" --map output_3=carrystep.la_3 --map output_3=carrystep.la_2", "already mapped"),
    ] {
        check(&folder, map).refuses(says);
    }
}

/// A logic analyser sees two outputs of one change in two samples.
#[test]
fn outputs_may_change_within_the_slack_of_each_other() {
    let (folder, lines) = captured();
    let mut skewed = lines.clone();
    let [spindle, flood] = [0, 2].map(|output| lines.of(output)[0]);
    assert_eq!(skewed.changes[spindle].0, skewed.changes[flood].0);
    skewed.changes[spindle].0 += 100_000;
    folder.write("c.vcd", skewed.text());
    assert_eq!(check(&folder, " --slack-ns 100").status, 0);
    assert_eq!(check(&folder, "").status, 1);
}
