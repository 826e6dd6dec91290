//! GNU parallel runs the shards, is stopped, and is started again.

use crate::folder::{Folder, kept, shown, succeeded};
use std::process::Command;

fn run_sh(folder: &Folder) -> Command {
    let mut command = Command::new("sh");
    // From another folder, because the script finds its own.
    command.arg(folder.path("jobs/run.sh")).current_dir("/").env("PARALLEL", "--jobs 2");
    command
}

#[test]
fn shards_by_gnu_parallel_merge_to_one_run() {
    let folder = Folder::new(&[100, 110, 120, 130], &["a4988", "none", "dm542"], "60");
    let arguments = ["sweep", "the sweep.toml", "--parallel", "jobs", "--shards", "5"];
    let said = succeeded(&folder.carrystep(&arguments).output().unwrap());
    assert!(said.contains("12 cases in 5 shards\nnext: `sh run.sh`"), "{said}");
    // A shard that fails does not keep the others from running.
    std::fs::create_dir(folder.path("jobs/shard-2.kept")).unwrap();
    let output = run_sh(&folder).output().unwrap();
    assert_eq!(output.status.code(), Some(2), "{}", shown(&output));
    assert!(shown(&output).contains("shard-2.kept"), "{}", shown(&output));
    assert!(!folder.path("jobs/report.json").exists());
    for shard in [1, 3, 4, 5] {
        let (done, all) = kept(&folder.path(&format!("jobs/shard-{shard}.kept"))).unwrap();
        assert_eq!(done, all, "shard {shard}");
    }
    std::fs::remove_dir(folder.path("jobs/shard-2.kept")).unwrap();
    let output = run_sh(&folder).output().unwrap();
    assert_eq!(output.status.code(), Some(1), "{}", shown(&output));
    assert_eq!(folder.read("jobs/report.json"), folder.whole(), "byte for byte");
    // Without the failing driver, the verdict is another one. The kept files are of the old sweep.
    let text = folder.read("the sweep.toml").replace("\"none\"", "\"tmc2209\"");
    std::fs::write(folder.path("the sweep.toml"), text).unwrap();
    let output = run_sh(&folder).output().unwrap();
    let says = "it keeps the progress of another run";
    assert!(shown(&output).contains(says), "{}", shown(&output));
    for shard in 1..=5 {
        std::fs::remove_file(folder.path(&format!("jobs/shard-{shard}.kept"))).unwrap();
    }
    succeeded(&run_sh(&folder).output().unwrap());
    assert_eq!(folder.read("jobs/report.json"), folder.whole(), "byte for byte");
}

/// The line for GNU parallel in docs/checks.md, as it stands there.
#[test]
fn slices_of_a_capture_by_gnu_parallel_merge_to_one_check() {
    let page = include_str!("../../../../docs/checks.md");
    let line = page.lines().find_map(|line| line.strip_prefix("    parallel ")).unwrap();
    let folder = Folder::new(&[100], &["a4988"], "60");
    let text = folder.read("the sweep.toml");
    let moves = text.split("'''").nth(1).unwrap();
    let moves = moves.replace("{{ driver }}", "a4988").replace("{{ a_to }}", "9000");
    std::fs::write(folder.path("move.toml"), moves).unwrap();
    succeeded(&folder.carrystep(&["simulate", "move.toml", "--vcd", "long.vcd"]).output().unwrap());
    let carrystep = std::path::Path::new(crate::folder::CARRYSTEP).parent().unwrap();
    let path = format!("{}:{}", carrystep.display(), std::env::var("PATH").unwrap());
    let mut parallel = Command::new("sh");
    parallel.args(["-c", &format!("parallel {line}")]).current_dir(folder.path(""));
    succeeded(&parallel.env("PATH", path).env("PARALLEL", "--jobs 2").output().unwrap());
    let slices: Vec<String> = (1..=64).map(|slice| format!("{slice}.slice")).collect();
    let check = ["check", "long.vcd", "move.toml", "--json"];
    let mut merge = check.to_vec();
    merge.push("--merge");
    merge.extend(slices.iter().map(String::as_str));
    let merged = folder.carrystep(&merge).output().unwrap();
    assert_eq!(succeeded(&merged), succeeded(&folder.carrystep(&check).output().unwrap()));
    assert!(merged.stderr.is_empty(), "{}", shown(&merged));
}
