//! Captures of boards that have made several runs: the pulses, and the part behind a place where the
//! axes rested as a capture of its own, which `carrystep check` reads.

use std::collections::BTreeMap;

/// A time of a capture, ps.
type Time = u64;

/// A millisecond.
pub const MS: Time = 1_000_000_000;

/// A pulse: its time, and the positions of x, y, z behind it in steps from the beginning.
pub type Pulse = (Time, [i64; 3]);

/// A capture of a board with three axes.
pub struct Capture {
    /// Up to the definitions' end.
    head: String,
    /// The changes with their times, and the code of each.
    changes: Vec<(Time, String)>,
    /// The last line, without which a capture is not whole.
    last: String,
    /// Each pulse.
    pub pulses: Vec<Pulse>,
}

/// The code of the signal that a change belongs to.
fn code(change: &str) -> &str {
    change.split_once(' ').map_or_else(|| &change[1..], |(_, code)| code)
}

impl Capture {
    /// Reads the text of a capture. The positions are counted from the pins alone.
    pub fn read(text: &str) -> Self {
        let (head, body) = text.split_once("$enddefinitions $end\n").unwrap();
        let (body, last) = body.split_at(body.rfind("$comment").unwrap());
        let codes = |name: &str| -> Vec<&str> {
            let words = head.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
            words.filter(|words| words.get(4) == Some(&name)).map(|words| words[3]).collect()
        };
        let (steps, dirs) = (codes("step"), codes("dir"));
        let mut found = Self {
            head: format!("{head}$enddefinitions $end\n"),
            changes: Vec::new(),
            last: last.to_owned(),
            pulses: Vec::new(),
        };
        let (mut now, mut at, mut back) = (0, [0; 3], [false; 3]);
        for line in body.lines() {
            match line.as_bytes()[0] {
                b'#' => now = line[1..].parse().unwrap(),
                b'0' | b'1' | b'b' => {
                    let high = line.starts_with('1');
                    if let Some(axis) = dirs.iter().position(|dir| *dir == code(line)) {
                        back[axis] = high;
                    } else if let Some(axis) = steps.iter().position(|step| *step == code(line))
                        && high
                    {
                        at[axis] += if back[axis] { -1 } else { 1 };
                        found.pulses.push((now, at));
                    }
                    found.changes.push((now, line.to_owned()));
                }
                _ => {}
            }
        }
        found
    }

    /// When an output goes off for the first time.
    pub fn goes_off(&self, output: &str) -> Time {
        let declared = self.head.lines().find(|line| line.contains(&format!(" {output} ")));
        let pin = declared.unwrap().split_whitespace().nth(3).unwrap();
        let mut changes = self.changes.iter().filter(|(_, change)| code(change) == pin);
        changes.find(|(_, change)| change.starts_with('1')).expect("it goes on");
        changes.find(|(_, change)| change.starts_with('0')).expect("it goes off").0
    }

    /// The number of pulses before the first gap of more than 100 ms that is behind this time.
    pub fn rests_behind(&self, time: Time) -> usize {
        let mut pairs = self.pulses.windows(2);
        1 + pairs.position(|pair| pair[1].0 > time && pair[1].0 - pair[0].0 > 100 * MS).unwrap()
    }

    /// The capture from this time on, at which the axes rest.
    pub fn from(&self, time: Time) -> String {
        let later = self.changes.partition_point(|(at, _)| *at <= time);
        let (before, behind) = self.changes.split_at(later);
        let levels: BTreeMap<&str, &str> =
            before.iter().map(|(_, change)| (code(change), change.as_str())).collect();
        let (start, end) = self.head.split_once("origin_ps=").unwrap();
        let (_, end) = end.split_once(' ').unwrap();
        let mut text = format!("{start}origin_ps={time} {end}#0\n$dumpvars\n");
        levels.values().for_each(|level| text += &format!("{level}\n"));
        text += "$end\n";
        let mut now = None;
        for (at, change) in behind {
            if now.replace(*at) != Some(*at) {
                text += &format!("#{at}\n");
            }
            text += &format!("{change}\n");
        }
        text + &self.last
    }
}
