//! Shards that are stopped and started again, and the merge of their reports. The judge is a
//! function of the number of the case, so that a run takes no time.

#![allow(clippy::unwrap_used, clippy::expect_used)] // Tests may panic.

use carrystep_sweep::{
    Case, CaseVerdict, JudgedBy, KeptShard, Part, Progress, Shard, SweepError, SweepFile,
    SweepReport, run,
};
use proptest::prelude::*;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicU64, Ordering};
use tempfile::TempDir;

const SWEEP: &str = r#"
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

const BY: JudgedBy<'_> = JudgedBy { core: "engine", carrystep: "1.2.3", build: "0123" };

/// A folder with a sweep file. Each file in it has a new name, because a process that has read a
/// file does not replace it.
struct Folder(TempDir, AtomicU64);

impl Folder {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("sweep.toml"), SWEEP).unwrap();
        Self(folder, AtomicU64::new(0))
    }

    fn sweep(&self, cases: u64) -> SweepFile {
        SweepFile::load(&self.0.path().join("sweep.toml"), Some(cases), 1).unwrap()
    }

    fn file(&self) -> PathBuf {
        self.0.path().join(self.1.fetch_add(1, Ordering::Relaxed).to_string())
    }

    fn write(&self, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.file();
        std::fs::write(&path, bytes).unwrap();
        path
    }
}

/// Every kind of verdict, and equal figures in many cases.
fn verdict(case: &Case) -> CaseVerdict {
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
fn whole(sweep: &SweepFile, shard: Shard) -> SweepReport {
    let judge = |case: &Case| ControlFlow::Continue(verdict(case));
    let progress = run(sweep, Progress::new(sweep, shard, BY), judge, |_| Ok(())).unwrap();
    assert!(progress.is_complete());
    progress.into_report()
}

fn json(report: &SweepReport) -> String {
    serde_json::to_string(report).unwrap()
}

/// Runs a shard that keeps its progress in a file. After each number of cases in `stops` the
/// process ends, and the file may have any state that was kept until then.
fn stopped_and_started(
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
        if progress.is_complete() {
            kept.save(&progress).unwrap();
        }
    }
    judged.into_inner().unwrap()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    #[test]
    fn shards_that_are_stopped_merge_to_the_whole(
        cases in 1_u64..80,
        count in 1_u64..6,
        stops in prop::collection::vec(0_u64..20, 0..4),
        rotate in 0_usize..6,
    ) {
        let folder = Folder::new();
        let sweep = folder.sweep(cases);
        let mut paths = Vec::new();
        let mut judged = BTreeSet::new();
        for number in 1..=count {
            let path = folder.file();
            let shard = Shard { number, count };
            judged.extend(stopped_and_started(&sweep, shard, &path, &stops).into_keys());
            paths.push(path);
        }
        prop_assert_eq!(judged, (0..cases).collect::<BTreeSet<_>>());
        paths.rotate_left(rotate % count as usize);
        let parts = paths.iter().map(|path| Part::read(path).unwrap()).collect();
        let merged = SweepReport::merge(parts).unwrap();
        prop_assert_eq!(json(&merged), json(&whole(&sweep, Shard::WHOLE)));
    }

    /// A report from a file is not trusted. Whatever it states, it is refused or it is consistent.
    #[test]
    fn changed_numbers_of_a_report_do_not_change_a_total(
        field in prop::sample::select(vec![
            "cases_passed", "cases_refused", "cases_failed", "cases", "seed", "number", "count",
            "case",
        ]),
        value in prop_oneof![0_u64..100, Just(u64::MAX), Just(1 << 63), any::<u64>()],
    ) {
        let folder = Folder::new();
        let sweep = folder.sweep(40);
        let shards = [1, 2].map(|number| whole(&sweep, Shard { number, count: 2 }));
        let text = json(&shards[1]);
        let at = text.find(&format!("\"{field}\":")).unwrap() + field.len() + 3;
        let end = at + text[at..].find(|c: char| !c.is_ascii_digit()).unwrap();
        let changed = format!("{}{value}{}", &text[..at], &text[end..]);
        let first = Part::read(&folder.write(json(&shards[0]))).unwrap();
        if let Ok(second) = Part::read(&folder.write(&changed))
            && let Ok(merged) = SweepReport::merge(vec![first, second])
        {
            let whole = whole(&sweep, Shard::WHOLE);
            prop_assert_eq!(merged.cases_passed, whole.cases_passed);
            prop_assert_eq!(merged.cases_refused, whole.cases_refused);
            prop_assert_eq!(merged.cases_failed, whole.cases_failed);
        }
    }
}

#[test]
fn a_started_shard_judges_only_missing_cases() {
    let folder = Folder::new();
    let sweep = folder.sweep(30);
    let shard = Shard { number: 1, count: 1 };
    // All of the first nine cases are kept, because every third one is written.
    let judged = stopped_and_started(&sweep, shard, &folder.file(), &[9]);
    assert_eq!(judged.values().sum::<u32>(), 30);
    let judged = stopped_and_started(&sweep, shard, &folder.file(), &[10]);
    assert_eq!((judged.len(), judged.values().sum::<u32>()), (30, 31));
}

/// The bytes of a kept file: of a complete shard, or of one that was stopped.
fn kept_bytes(folder: &Folder, sweep: &SweepFile, shard: Shard, cases: u64) -> Vec<u8> {
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

#[test]
fn damaged_file_is_refused_wherever_it_is_cut_or_changed() {
    let folder = Folder::new();
    let sweep = folder.sweep(12);
    for cases in [5, 12] {
        let bytes = kept_bytes(&folder, &sweep, Shard::WHOLE, cases);
        let cuts = (0..bytes.len()).map(|length| bytes[..length].to_vec());
        let changes = (0..bytes.len()).map(|at| {
            let mut changed = bytes.clone();
            changed[at] ^= 1 << (at % 8);
            changed
        });
        let twice = [bytes.clone(), bytes.clone()].concat();
        for (number, damaged) in cuts.chain(changes).chain([twice]).enumerate() {
            let path = folder.write(&damaged);
            let opened = KeptShard::open(&path, Progress::new(&sweep, Shard::WHOLE, BY));
            assert!(opened.is_err(), "{}", String::from_utf8_lossy(&damaged));
            assert_eq!(std::fs::read(&path).unwrap(), damaged, "a refused file is not replaced");
            // Both read the file by the same function, and a process remembers each input.
            if number % 50 == 0 {
                assert!(Part::read(&path).is_err(), "{}", String::from_utf8_lossy(&damaged));
            }
            std::fs::remove_file(path).unwrap();
        }
    }
}

/// A part with these cases of a shard.
fn part(folder: &Folder, sweep: &SweepFile, number: u64, count: u64, cases: u64) -> Part {
    let shard = Shard { number, count };
    Part::read(&folder.write(kept_bytes(folder, sweep, shard, cases))).unwrap()
}

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
