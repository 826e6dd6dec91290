//! 64 shards on a real Slurm: one is killed and requeued, one fails and is submitted again.

use crate::daemons::{Slurm, process_of};
use crate::folder::{Folder, kept, shown, succeeded};
use std::process::Command;
use std::time::{Duration, Instant};

const SHARDS: u64 = 64;

/// The shard that takes long and is killed.
const KILLED: &str = "5/64";

/// The time in which Slurm removes the files of a task that was killed.
const SETTLED: Duration = Duration::from_secs(3);

/// Submits the sweep and returns the job ids of the array and of the merge.
fn submit(slurm: &Slurm, folder: &Folder) -> (String, String) {
    let mut command = folder.carrystep(&[
        "sweep",
        "the sweep.toml",
        "--shards",
        "64",
        "--slurm",
        "a job",
        "--submit",
        "--json",
    ]);
    let output = slurm.finds(&mut command).output().unwrap();
    let document: serde_json::Value = serde_json::from_str(&succeeded(&output)).unwrap();
    assert_eq!((&document["shards"], &document["cases"]), (&64.into(), &640.into()));
    let id = |name: &str| document["submitted"][name].as_str().unwrap().to_owned();
    (id("shards"), id("merge"))
}

/// Moves of 64 distances and ten drivers, two of which fail. The case of number n has the distance
/// of number n % 64, so each shard has one distance. The fifth takes about 0.3 s a case.
fn sweep() -> Folder {
    let mut tos: Vec<u64> = (1..=SHARDS).map(|n| 100 + n).collect();
    tos[4] = 600_000;
    // Each move takes a time that suits its distance.
    let time = "{{ [1, a_to|float / 30]|max }}";
    let drivers = ["a4988", "tmc2209", "dm542", "none", "a4988"];
    Folder::new(&tos, &[drivers, drivers].concat(), time)
}

#[test]
fn shards_that_are_killed_or_fail_are_finished_later_and_merge_to_one_run() {
    let folder = sweep();
    let slurm = Slurm::start(8);
    // A folder of this name: the shard cannot write its file.
    std::fs::create_dir_all(folder.path("a job/shard-9.kept")).unwrap();
    let (array, merge) = submit(&slurm, &folder);

    let path = folder.path("a job/shard-5.kept");
    slurm.wait("a shard in the middle", |_| kept(&path).is_some_and(|(done, _)| done > 0));
    let process = process_of(KILLED, &path).expect("the shard runs");
    assert!(Command::new("kill").args(["-KILL", &process.to_string()]).status().unwrap().success());
    let task = format!("{array}_5");
    slurm.wait("the end of the killed shard", |slurm| {
        slurm.states().iter().any(|state| *state == format!("{task} FAILED"))
    });
    let before = kept(&path).unwrap();
    assert!(0 < before.0 && before.0 < before.1, "{before:?}");
    let mut last = before;
    let mut requeued: Option<Instant> = None;
    slurm.wait("the end of the requeued shard", |slurm| {
        let states = slurm.states();
        let is = |state: &str| states.contains(&format!("{task} {state}"));
        // Slurm removes the files of the killed task some moments after its end. A task that starts
        // before that loses its script and fails, so Slurm lets a requeued task wait for two
        // minutes. Some seconds are enough here; if they were not, the task is requeued again.
        if is("FAILED") {
            slurm.do_run("scontrol", &["requeue", &task]);
            requeued = Some(Instant::now());
        } else if is("PENDING") && requeued.is_some_and(|at| at.elapsed() > SETTLED) {
            slurm.run("scontrol", &["update", &format!("JobId={task}"), "StartTime=now"]);
        }
        let now = kept(&path).unwrap();
        assert!(now.0 >= last.0, "the shard has begun anew: {now:?} after {last:?}");
        last = now;
        now.0 == now.1
    });
    slurm.wait_for_all();
    let states = slurm.states();
    let has = |state: String| assert!(states.contains(&state), "no {state}: {states:?}");
    for shard in (1..=SHARDS).filter(|&shard| shard != 9) {
        has(format!("{array}_{shard} COMPLETED"));
    }
    has(format!("{array}_9 FAILED"));
    has(format!("{merge} FAILED"));
    let log = folder.read("a job/shard-9.log");
    assert!(log.contains("is a directory"), "{log}");
    let log = folder.read("a job/merge.log");
    assert!(log.contains("shard-9.kept"), "{log}");
    assert!(!folder.path("a job/report.json").exists());

    // The same command again finishes what is missing.
    std::fs::remove_dir(folder.path("a job/shard-9.kept")).unwrap();
    let (array, merge) = submit(&slurm, &folder);
    slurm.wait_for_all();
    let states = slurm.states();
    let has = |state: String| assert!(states.contains(&state), "no {state}: {states:?}");
    (1..=SHARDS).for_each(|shard| has(format!("{array}_{shard} COMPLETED")));
    // Two drivers do not exist, so the verdict of the merge is that cases failed.
    has(format!("{merge} FAILED"));
    let report = folder.read("a job/report.json");
    assert_eq!(report, folder.whole(), "byte for byte");
    let document: serde_json::Value = serde_json::from_str(&report).unwrap();
    let count = |name: &str| document[name].as_u64().unwrap();
    assert_eq!((count("cases_passed"), count("cases_failed")), (512, 128));
    let log = folder.read("a job/merge.log");
    assert!(log.contains("512 passed, 0 refused, 128 failed"), "{log}");
}

#[test]
fn submission_that_fails_says_what_was_submitted() {
    let folder = Folder::new(&[100], &["a4988"], "60");
    let arguments = ["sweep", "the sweep.toml", "--slurm", "jobs", "--submit"];
    let fakes = folder.path("fakes");
    std::fs::create_dir(&fakes).unwrap();
    let fake = |script: &str| {
        use std::os::unix::fs::PermissionsExt;
        std::fs::write(fakes.join("sbatch"), format!("#!/bin/sh\n{script}\n")).unwrap();
        std::fs::set_permissions(fakes.join("sbatch"), PermissionsExt::from_mode(0o755)).unwrap();
    };
    let run = || folder.carrystep(&arguments).env("PATH", &fakes).output().unwrap();
    let missing = run();
    assert_eq!(missing.status.code(), Some(3), "{}", shown(&missing));
    assert!(shown(&missing).contains("cannot start sbatch"), "{}", shown(&missing));
    fake("echo 'sbatch: error: no partition' >&2; exit 1");
    let refused = run();
    assert_eq!(refused.status.code(), Some(1), "{}", shown(&refused));
    assert!(shown(&refused).contains("sbatch did not submit shards.sbatch: sbatch: error: no"));
    fake("case $2 in --dep*) exit 1;; esac; echo '17;here'");
    let half = run();
    assert_eq!(half.status.code(), Some(1), "{}", shown(&half));
    let says = "the shards were submitted as job 17, but not the merge";
    assert!(shown(&half).contains(says), "{}", shown(&half));
    assert!(shown(&half).contains("sbatch --dependency=afterany:17 merge.sbatch"));
    fake("echo 'Submitted batch job 3'");
    assert_eq!(run().status.code(), Some(1), "an answer without a number is no job");
}
