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
