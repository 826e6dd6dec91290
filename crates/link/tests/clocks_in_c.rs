//! The comparison of clocks in C gives what the one in Rust gives, for clocks that are off by some
//! ppm, read in exchanges of any length, over wraps of TICKS and changes of the rate.

use crate::support::c_library::Folder;
use crate::support::random::Random;
use carrystep_link::{ClockComparison, TickCount};
use std::fmt::Write as _;
use std::io::Write as _;
use std::process::{Command, Stdio};

/// Greatest difference between both, parts per 10^9: C rounds to whole parts.
const ROUNDING: f64 = 3.0;

/// An observation: the value of TICKS, and the host's times before and after.
type Observation = (u32, u64, u64);

/// Reads of a clock that is off by so many ppm, and by other ones from the middle on.
fn observations(random: &mut Random, tick_ns: u32, off: [f64; 2], count: u64) -> Vec<Observation> {
    let (mut now, mut ticks) = (0_u64, f64::from(u32::MAX) - 1e5);
    let read = |number: u64| {
        let (pause, width) = (random.below(2_000_000) + 1, random.below(20_000) + 1);
        let part = random.below(width + 1);
        let off = off[usize::from(2 * number >= count)];
        let (before, rate) = (now + pause, (1.0 + off * 1e-6) * 1000.0 / f64::from(tick_ns));
        let value = ticks + (pause + part) as f64 * rate;
        ticks += (pause + width) as f64 * rate;
        now = before + width;
        (value as u64 as u32, before, now)
    };
    (0..count).map(read).collect()
}

#[test]
fn comparison_of_clocks_is_the_same_in_c() {
    let folder = Folder::new(|_, text| text.to_owned());
    folder.write("time_bench.c", include_str!("bench/time_bench.c"));
    let checks = ["-g", "-fsanitize=address,undefined", "-fno-sanitize-recover=all"];
    let files = ["time_bench.c", "carrystep_time.c"];
    let program = folder.compile(&[&files[..], &checks].concat()).unwrap();
    let mut random = Random::new(41);
    let mut restarts = 0;
    for off in [[0.0, 0.0], [200.0, 200.0], [-200.0, -200.0], [50.0, 5000.0], [-3.0, -400_000.0]] {
        let tick_ns = 500 + random.below(4000) as u32;
        let all = observations(&mut random, tick_ns, off, 400);
        let mut text = format!("{tick_ns}\n");
        for (value, before, after) in &all {
            writeln!(text, "{value} {before} {after}").unwrap();
        }
        let mut child =
            Command::new(&program).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(text.as_bytes()).unwrap();
        let output = child.wait_with_output().unwrap();
        assert!(output.status.success());
        let said = String::from_utf8(output.stdout).unwrap();
        let (mut count, mut clocks) = (TickCount::default(), ClockComparison::default());
        assert_eq!(said.lines().count(), all.len());
        for (&(value, before, after), line) in all.iter().zip(said.lines()) {
            let words: Vec<i64> = line.split(' ').map(|word| word.parse().unwrap()).collect();
            let tick = count.see(value);
            clocks.observe(tick_ns, tick, before, after);
            assert_eq!(words[0], tick);
            let wanted = clocks.difference();
            assert_eq!(words[1] == 1, wanted.is_some(), "{line}");
            restarts += usize::from(wanted.is_none());
            if let Some(wanted) = wanted {
                for (found, wanted) in [(words[2], wanted.ppm), (words[3], wanted.bound)] {
                    let found = found as f64;
                    assert!((found - 1000.0 * wanted).abs() <= ROUNDING, "{line}: {wanted}");
                }
            }
        }
        let last = clocks.difference().unwrap();
        assert!((last.ppm - off[1]).abs() <= last.bound && last.bound < 100.0, "{last:?}");
    }
    // One at the beginning of each, and at least one where the rate changes.
    assert!(restarts > 5, "{restarts}");
}
