//! A sweep, a judge, and shards that are stopped.

use carrystep_sweep::{
    Case, CaseVerdict, JudgedBy, KeptShard, Part, Progress, Shard, SweepFile, SweepReport, run,
};
use std::collections::BTreeMap;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use tempfile::TempDir;

pub const SWEEP: &str = r#"
move_file = '''
[machine]
[[machine.axis]]
name = "x"
steps_per_unit = 1
speed_limit = 1000
accel_limit = 10000
driver = "a4988"
[[move]]
profile = "ranade"
to = { x = {{ to }} }
'''
[vary]
to = { from = 1, to = 100 }
"#;

pub const BY: JudgedBy<'_> = JudgedBy { core: "engine", carrystep: "1.2.3", build: "0123" };

/// A folder with a sweep file. Each file in it has a new name, because a process that has read a
/// file does not replace it.
pub struct Folder(pub TempDir, AtomicU64);

impl Folder {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("sweep.toml"), SWEEP).unwrap();
        Self(folder, AtomicU64::new(0))
    }

    pub fn sweep(&self, cases: u64) -> SweepFile {
        SweepFile::load(&self.0.path().join("sweep.toml"), Some(cases), 1).unwrap()
    }

    pub fn file(&self) -> PathBuf {
        self.0.path().join(self.1.fetch_add(1, Ordering::Relaxed).to_string())
    }

    pub fn write(&self, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.file();
        std::fs::write(&path, bytes).unwrap();
        path
    }
}

/// Every kind of verdict, and equal figures in many cases.
pub fn verdict(case: &Case) -> CaseVerdict {
    match case.number % 7 {
        0 => CaseVerdict::Refused("impossible".to_owned()),
        1 => CaseVerdict::Failed(format!("case {}", case.number)),
        rest => {
            let figures = [("same", 1.0), ("third", rest as f64 / 3.0), ("none", -0.0)];
            CaseVerdict::Passed(figures.into_iter().collect::<BTreeMap<_, _>>())
        }
    }
}

/// Runs a shard to its end, without a file.
pub fn whole(sweep: &SweepFile, shard: Shard) -> SweepReport {
    let judge = |case: &Case| ControlFlow::Continue(verdict(case));
    let progress = run(sweep, Progress::new(sweep, shard, BY), judge, |_| Ok(())).unwrap();
    assert!(progress.is_complete());
    progress.into_report()
}

pub fn json(report: &SweepReport) -> String {
    serde_json::to_string(report).unwrap()
}

/// Runs a shard that keeps its progress in a file. After each number of cases in `stops` the
/// process ends, and the file may have any state that was kept until then.
pub fn stopped_and_started(
    sweep: &SweepFile,
    shard: Shard,
    path: &Path,
    stops: &[u64],
) -> BTreeMap<u64, u32> {
    let judged = Mutex::new(BTreeMap::new());
    for stop in stops.iter().copied().chain([u64::MAX]) {
        let (mut kept, progress) = KeptShard::open(path, Progress::new(sweep, shard, BY)).unwrap();
        let (left, mut count) = (AtomicU64::new(stop), 0);
        let judge = |case: &Case| {
            let go = left.fetch_update(Ordering::Relaxed, Ordering::Relaxed, |n| n.checked_sub(1));
            if go.is_err() {
                return ControlFlow::Break(());
            }
            *judged.lock().unwrap().entry(case.number).or_insert(0) += 1;
            ControlFlow::Continue(verdict(case))
        };
        let after = |progress: &Progress| {
            count += 1;
            // A process that is killed has kept only some of its progress.
            if count % 3 == 0 { kept.save(progress) } else { Ok(()) }
        };
        let progress = run(sweep, progress, judge, after).unwrap();
        if count > 0 && progress.is_complete() {
            kept.save(&progress).unwrap();
        }
    }
    judged.into_inner().unwrap()
}

/// The bytes of a kept file: of a complete shard, or of one that was stopped.
pub fn kept_bytes(folder: &Folder, sweep: &SweepFile, shard: Shard, cases: u64) -> Vec<u8> {
    let path = folder.file();
    let left = AtomicU64::new(cases);
    let (mut kept, progress) = KeptShard::open(&path, Progress::new(sweep, shard, BY)).unwrap();
    let judge = |case: &Case| match left
        .fetch_update(Ordering::Relaxed, Ordering::Relaxed, |n| n.checked_sub(1))
    {
        Ok(_) => ControlFlow::Continue(verdict(case)),
        Err(_) => ControlFlow::Break(()),
    };
    let progress = run(sweep, progress, judge, |_| Ok(())).unwrap();
    kept.save(&progress).unwrap();
    std::fs::read(path).unwrap()
}

/// A part with these cases of a shard.
pub fn part(folder: &Folder, sweep: &SweepFile, number: u64, count: u64, cases: u64) -> Part {
    let shard = Shard { number, count };
    Part::read(&folder.write(kept_bytes(folder, sweep, shard, cases))).unwrap()
}
