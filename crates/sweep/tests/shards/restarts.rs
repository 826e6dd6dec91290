//! Shards that are stopped and started again.

use crate::support::{BY, Folder, json, kept_bytes, stopped_and_started, whole};
use carrystep_sweep::{KeptShard, Part, Progress, Shard, SweepReport};
use proptest::prelude::*;
use std::collections::BTreeSet;

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
