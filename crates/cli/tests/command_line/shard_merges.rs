//! `carrystep sweep --merge`: parts that do not make the whole sweep are refused.

use crate::command::{Folder, GOOD};
use serde_json::Value;

/// A folder with the reports `1.json` to `3.json` of a sweep of four cases.
fn shards() -> Folder {
    let folder = Folder::new();
    let text = GOOD.replace("x = 2 ", "x = {{ to }} ");
    folder.write("sweep.toml", format!("move_file = '''\n{text}'''\n[vary]\nto = [0, 1, 2, 30]\n"));
    for shard in 1..=3 {
        let ran = folder.run(&format!("sweep sweep.toml --json --shard {shard}/3"));
        assert_eq!(ran.status, 0, "{}", ran.stdout);
        folder.write(&format!("{shard}.json"), ran.stdout);
    }
    folder
}

#[test]
fn missing_shards_and_shards_that_occur_twice_are_refused_by_name() {
    let folder = shards();
    folder.run("sweep --merge 2.json").refuses("missing: 1/3, 3/3");
    folder
        .run("sweep --merge 1.json 2.json 3.json 2.json")
        .refuses("shard 2/3 occurs twice: in 2.json and in 2.json");
    std::fs::copy(folder.path("3.json"), folder.path("copy.json")).unwrap();
    folder
        .run("sweep --merge 1.json 2.json 3.json copy.json --report r.json")
        .refuses("shard 3/3 occurs twice: in 3.json and in copy.json");
    folder.run("sweep --merge 1.json 2.json 4.json").refuses("cannot read 4.json");
    assert!(!folder.path("r.json").exists());
}

#[test]
fn reports_that_are_cut_or_changed_are_refused() {
    let folder = shards();
    let text = std::fs::read_to_string(folder.path("2.json")).unwrap();
    let end = text.trim_end().len();
    for length in (0..end).step_by(37).chain([end - 1]) {
        folder.write("cut.json", &text[..length]);
        folder
            .run("sweep --merge 1.json cut.json 3.json")
            .refuses("cut.json: no report of a sweep");
    }
    let report: Value = serde_json::from_str(&text).unwrap();
    let case = report["worst"]["late"]["case"].as_u64().unwrap();
    for (field, value, says) in [
        ("cases_passed", 2_i64, "2 passed, 0 refused and 0 failed are not 1 cases"),
        ("cases_failed", 1, "1 passed, 0 refused and 1 failed are not 1 cases"),
        ("cases", 5, "1 passed, 0 refused and 0 failed are not 2 cases"),
        ("cases", 4_000_000_000_000_000_000, "are not "),
    ] {
        let mut changed = report.clone();
        changed[field] = value.into();
        folder.write("changed.json", changed.to_string());
        folder.run("sweep --merge 1.json changed.json 3.json").refuses(says);
    }
    let mut changed = report.clone();
    changed["worst"]["late"]["case"] = (case + 1).into();
    folder.write("changed.json", changed.to_string());
    folder
        .run("sweep --merge 1.json changed.json 3.json")
        .refuses(&format!("case {} is not one of its cases", case + 1));
    let mut changed = report;
    changed["shards"][0]["number"] = 0.into();
    folder.write("changed.json", changed.to_string());
    folder.run("sweep --merge 1.json changed.json 3.json").refuses("it is not of one shard");
}

#[test]
fn reports_of_other_versions_are_refused() {
    let folder = shards();
    let report: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path("2.json")).unwrap()).unwrap();
    for (field, says) in [("carrystep", "the version of carrystep is "), ("build", "the build of ")]
    {
        let mut other = report.clone();
        other[field] = "9.9.9".into();
        folder.write("other.json", other.to_string());
        folder
            .run("sweep --merge 1.json other.json 3.json")
            .refuses(&format!("1.json and other.json are not one sweep: {says}"));
    }
    let mut old = report;
    old.as_object_mut().unwrap().remove("carrystep");
    folder.write("old.json", old.to_string());
    folder
        .run("sweep --merge 1.json old.json 3.json")
        .refuses("old.json: a report of an older carrystep, which does not state its version");
    let failure = folder.run("sweep none.toml --json").stdout;
    folder.write("failure.json", failure);
    folder.run("sweep --merge failure.json").refuses("failure.json: no report of a sweep");
}

#[test]
fn numbers_that_are_not_finite_are_refused_in_a_sweep_file() {
    let folder = shards();
    let text = std::fs::read_to_string(folder.path("sweep.toml")).unwrap();
    folder.write("nan.toml", text.replace("[0, 1,", "[0, nan,"));
    folder.run("sweep nan.toml").refuses("to: a number that is not finite");
}
