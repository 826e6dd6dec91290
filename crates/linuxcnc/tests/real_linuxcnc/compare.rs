//! The pulses of a board against the motor-pos-cmd of every servo period.

use crate::board::Done;
use crate::{JOINTS, PERIODS, SCALES, TICK};
use std::ops::Range;

/// A servo period.
pub struct Sample {
    pub number: u64,
    pub steps: [f64; JOINTS],
    pub running: bool,
    pub end_ticks: u64,
}

/// The samples, or `None` if some were lost.
pub fn samples(text: &str) -> Option<Vec<Sample>> {
    let lines = text.lines().filter(|line| line.split_whitespace().count() == 7);
    let all: Vec<Sample> = lines
        .map(|line| {
            let words: Vec<&str> = line.split_whitespace().collect();
            Sample {
                number: words[0].parse().unwrap(),
                steps: [0, 1, 2].map(|at| words[1 + at].parse::<f64>().unwrap() * SCALES[at]),
                running: words[4] == "1",
                end_ticks: words[5].parse().unwrap(),
            }
        })
        .collect();
    let whole = all.windows(2).all(|pair| pair[1].number == pair[0].number + 1);
    (whole && !text.contains("overrun")).then_some(all)
}

/// Steps of joint 0 in a period: a command that moves further jumps, as no axis can. At the speed of
/// homing, an index pulse is reported before the axis is commanded to be so far behind it.
const JUMP: f64 = 10.0;
const REPORT: f64 = 60.0;

/// The periods in which joint 0 returns to its command, which has jumped to an index pulse: a second
/// (carrystep_glide.h), and the blocks around it.
fn returns(samples: &[Sample]) -> Range<u64> {
    let way = |pair: &[Sample]| (pair[1].steps[0] - pair[0].steps[0]).abs();
    samples.windows(2).find(|pair| way(pair) > JUMP).map_or(0..0, |pair| {
        assert!(way(pair) < REPORT, "{} steps", way(pair));
        let blocks = 2 * PERIODS as u64;
        pair[1].number - blocks..pair[1].number + 1000 + blocks
    })
}

/// The greatest distance of the pulses from the commands, for each joint, and how many servo periods
/// were compared.
pub fn compare(samples: &[Sample], done: &Done) -> ([f64; JOINTS], usize) {
    let (mut worst, mut compared) = ([0.0_f64; JOINTS], 0);
    let returns = returns(samples);
    let (mut at, mut places) = (0, [0_i32; JOINTS]);
    let streams: Vec<&[Sample]> =
        samples.chunk_by(|a, b| a.running == b.running).filter(|run| run[0].running).collect();
    assert_eq!(streams.len(), done.loads.len(), "each stream has one start");
    for (stream, &load) in streams.iter().zip(&done.loads) {
        let stop =
            done.stops.iter().map(|stop| stop.0).find(|&stop| stop > load).unwrap_or(u64::MAX);
        // A block is known one period after its end.
        let ends: Vec<(usize, u64)> = (1..stream.len())
            .filter(|&at| stream[at].end_ticks != stream[at - 1].end_ticks)
            .map(|at| (at - 1, stream[at].end_ticks))
            .collect();
        for pair in ends.windows(2) {
            let [(first, begin), (last, end)] = [pair[0], pair[1]];
            if last - first != PERIODS || end < begin {
                continue;
            }
            for number in first + 1..=last {
                let part = (number - first) as u64 * (end - begin) / PERIODS as u64;
                let clock = load + (begin + part) * TICK;
                if clock >= stop {
                    break;
                }
                while done.pulses.get(at).is_some_and(|pulse| pulse.0 <= clock) {
                    let (_, axis, step) = done.pulses[at];
                    if axis < JOINTS {
                        places[axis] += step;
                    }
                    at += 1;
                }
                if returns.contains(&stream[number].number) {
                    continue;
                }
                for joint in 0..JOINTS {
                    let off = stream[number].steps[joint] - f64::from(places[joint]);
                    worst[joint] = worst[joint].max(off.abs());
                }
                compared += 1;
            }
        }
    }
    (worst, compared)
}
