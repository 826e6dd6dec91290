//! The page of a long job has a bounded size.

#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches test functions only")]

use carrystep_core::Segment;
use carrystep_report::{AxisSetup, Detail, Motion, Recorder, write_page};

/// Greatest size of a page, bytes.
const MOST: usize = 3_000_000;

/// Numbers that look random, the same in every run.
fn mixed(number: u64) -> u64 {
    let x = number.wrapping_add(1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    (x ^ (x >> 29)).wrapping_mul(0xBF58_476D_1CE4_E5B9) >> 20
}

/// The page of so many rows of six axes that go to and fro without any order.
fn page(rows: u64) -> Vec<u8> {
    let axis = |(number, name): (usize, char)| AxisSetup {
        name: name.to_string(),
        title: format!("axis {name}"),
        letter: vec![(number, 1.0)],
        unit: "mm".into(),
        steps_per_unit: 80.0,
        start: 0.0,
        limits: [Some(100.0), Some(1000.0), Some(250_000.0)],
        linear: name < 'd',
        counts: 1.0,
    };
    let mut recorder = Recorder::new(
        "abcdef".chars().enumerate().map(axis).collect(),
        1e-6,
        true,
        Detail::Drawing,
    );
    for number in 0..rows {
        let segments: Vec<Segment> = (0..6)
            .map(|axis| {
                let random = (mixed(number * 6 + axis) % 2001) as i64 - 1000;
                // Up to 100 mm/s.
                Segment {
                    ticks: 4000,
                    v: random * 147_573_952_589_676,
                    a: random,
                    j: 0,
                    last: false,
                }
            })
            .collect();
        recorder.row(&Motion {
            ticks: 4000,
            segments: &segments,
            line: number + 1,
            feed: 80.0,
            given: false,
            off: (mixed(number) % 100) as f64 / 100.0,
            corner: 2.0,
        });
    }
    let (time_use, drawing) = recorder.finish();
    let mut page = Vec::new();
    write_page(&mut page, "long", &time_use, &drawing.unwrap(), &[]).unwrap();
    page
}

#[test]
fn page_of_a_long_job_has_a_bounded_size() {
    let [short, long] = [page(20_000), page(600_000)].map(|page| page.len());
    assert!(short < MOST && long < MOST, "{short} {long}");
    // The drawing is as fine as its size allows.
    assert!(long > MOST / 4, "{long}");
}
