//! Parts that do not make one sweep are refused.

use crate::support::{BY, Folder, SWEEP, json, part, stopped_and_started, verdict, whole};
use carrystep_sweep::{
    Case, CaseVerdict, JudgedBy, KeptShard, Part, Progress, Shard, SweepError, SweepFile,
    SweepReport, run,
};
use std::ops::ControlFlow;
use std::path::Path;

#[test]
fn merge_names_missing_and_incomplete_shards_and_those_that_occur_twice() {
    let folder = Folder::new();
    let sweep = folder.sweep(12);
    let error = |parts: Vec<Part>| SweepReport::merge(parts).unwrap_err();
    assert!(matches!(error(vec![]), SweepError::NoReport));
    let text =
        error(vec![part(&folder, &sweep, 4, 4, 2), part(&folder, &sweep, 1, 4, 3)]).to_string();
    assert!(
        text.contains("with all its cases; missing: 2/4, 3/4; 4/4 has 2 of 3 cases in "),
        "{text}"
    );
    let text = error(vec![part(&folder, &sweep, 1, 2, 6), part(&folder, &sweep, 1, 2, 6)]);
    assert!(text.to_string().starts_with("shard 1/2 occurs twice: in "), "{text}");
    let text = error(vec![part(&folder, &sweep, 1, 2, 6), part(&folder, &sweep, 2, 3, 4)]);
    assert!(text.to_string().contains("the number of shards is 2 in one and 3 in the other"));
    let text = error(vec![part(&folder, &sweep, 7, 1_000_000_000_000, 0)]).to_string();
    let only = error(vec![part(&folder, &sweep, 2, 2, 6)]).to_string();
    assert!(only.contains("with all its cases; missing: 1/2\n"), "{only}");
    let ten = "missing: 1/1000000000000, 2/1000000000000, ";
    assert!(text.contains(ten) && text.contains(", and more\n"), "{text}");
}

#[test]
fn reports_of_other_runs_are_refused_by_the_property_that_differs() {
    let folder = Folder::new();
    let shard = |number| Shard { number, count: 2 };
    let report = |sweep: &SweepFile, by, number| {
        let fresh = Progress::new(sweep, shard(number), by);
        let judge = |case: &Case| ControlFlow::Continue(verdict(case));
        run(sweep, fresh, judge, |_| Ok(())).unwrap().into_report()
    };
    let load = |path: &Path, sample, seed| SweepFile::load(path, sample, seed).unwrap();
    let path = folder.0.path().join("sweep.toml");
    let sweep = load(&path, Some(12), 1);
    let grid = SWEEP.replace("{ from = 1, to = 100 }", "[1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]");
    let grid = load(&folder.write(grid), None, 1);
    let other_text = load(&folder.write(SWEEP.replace("1000\n", "2000\n")), Some(12), 1);
    let cases = [
        (&sweep, JudgedBy { carrystep: "1.2.4", ..BY }, "the version of carrystep is 1.2.3"),
        (&sweep, JudgedBy { build: "0124", ..BY }, "the build of carrystep is 0123"),
        (&sweep, JudgedBy { core: "parallel", ..BY }, "the core is engine"),
        (&grid, BY, "--sample is 12 in one and none in the other"),
        (&load(&path, Some(13), 1), BY, "--sample is 12 in one and 13 in the other"),
        (&load(&path, Some(12), 2), BY, "--seed is 1 in one and 2 in the other"),
        (&other_text, BY, "the hash of the sweep file and these options is "),
    ];
    for (other, by, says) in cases {
        let parts = [report(&sweep, BY, 1), report(other, by, 2)];
        let parts = parts.map(|report| Part::read(&folder.write(json(&report))).unwrap());
        let error = SweepReport::merge(parts.into()).unwrap_err().to_string();
        assert!(error.contains("are not one sweep: ") && error.contains(says), "{error}");
        // The same for a shard that is started again.
        let path = folder.file();
        drop(KeptShard::open(&path, Progress::new(&sweep, shard(1), BY)).unwrap());
        let error = KeptShard::open(&path, Progress::new(other, shard(1), by)).unwrap_err();
        let error = error.to_string();
        assert!(error.contains("it keeps the progress of another run"), "{error}");
    }
}

#[test]
fn a_shard_without_cases_keeps_a_file_that_can_be_merged() {
    let folder = Folder::new();
    let sweep = folder.sweep(1);
    let paths = [1, 2].map(|number| {
        let path = folder.file();
        stopped_and_started(&sweep, Shard { number, count: 2 }, &path, &[]);
        path
    });
    let parts = paths.iter().map(|path| Part::read(path).unwrap()).collect();
    assert_eq!(json(&SweepReport::merge(parts).unwrap()), json(&whole(&sweep, Shard::WHOLE)));
}

#[test]
fn a_sample_of_as_many_cases_as_the_grid_is_another_sweep() {
    let folder = Folder::new();
    let path = folder.write(SWEEP.replace("{ from = 1, to = 100 }", "[1, 2, 3]"));
    let fingerprint = |sample| SweepFile::load(&path, sample, 1).unwrap().fingerprint("engine");
    assert_ne!(fingerprint(None), fingerprint(Some(3)));
}

#[test]
fn a_machine_file_that_changes_ends_the_run_and_the_merge() {
    let folder = Folder::new();
    let (head, rest) = SWEEP.split_once("[machine]").unwrap();
    let (machine, rest) = rest.split_once("[[move]]").unwrap();
    let machine = format!("[machine]{machine}");
    let write = |text: &str| std::fs::write(folder.0.path().join("m.toml"), text).unwrap();
    write(&machine);
    let text = format!("{head}machine_file = \"m.toml\"\n[[move]]{rest}");
    let sweep = SweepFile::load(&folder.write(text), Some(10), 1).unwrap();
    let first = whole(&sweep, Shard { number: 1, count: 2 });
    assert_eq!(first.cases_refused, 1, "{first}");
    assert_eq!(first.machine_files.keys().collect::<Vec<_>>(), ["m.toml"]);
    write(&format!("{machine}\n# another one\n"));
    let second = whole(&sweep, Shard { number: 2, count: 2 });
    let parts = [first, second].map(|one| Part::read(&folder.write(json(&one))).unwrap());
    let error = SweepReport::merge(parts.into()).unwrap_err();
    assert!(error.to_string().starts_with("the machine file m.toml is not the one"), "{error}");
    let after = |_: &Progress| {
        write(&machine);
        Ok(())
    };
    let judge = |case: &Case| ControlFlow::Continue(verdict(case));
    let ran = run(&sweep, Progress::new(&sweep, Shard::WHOLE, BY), judge, after);
    assert!(matches!(ran, Err(SweepError::MachineChanged(_))), "{ran:?}");
}

#[test]
fn figure_that_is_not_a_number_is_a_failure() {
    let folder = Folder::new();
    let sweep = folder.sweep(3);
    for value in [f64::NAN, f64::INFINITY] {
        let judge = |_: &Case| ControlFlow::Continue(CaseVerdict::Passed([("late", value)].into()));
        let ran = run(&sweep, Progress::new(&sweep, Shard::WHOLE, BY), judge, |_| Ok(())).unwrap();
        let report = ran.into_report();
        assert_eq!((report.cases_failed, report.passed), (3, Some(false)));
        assert_eq!(report.failures[0].message, "the figure 'late' is not a number");
    }
}
