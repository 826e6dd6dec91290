//! Position commands become segments that the model of an axis runs to these commands; segments
//! follow the board's clock; the queue between the threads loses and doubles nothing.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_core::Segment;
use carrystep_model::parallel::axis::{AxisRegisters, tick};
use proptest::prelude::*;
use support::Bench;

const HALF: u64 = 1 << 63;
const STEP: f64 = 18_446_744_073_709_551_616.0;
/// Outcomes of `carrystep_blocks_take`.
const NONE: i64 = 0;
const BLOCK: i64 = 1;
const NOT_A_NUMBER: i64 = 2;
const OUT_OF_RANGE: i64 = 3;
const JUMP: i64 = 4;

/// An axis of the model with the place that its steps and P give, 2^-64 step.
struct Axis {
    registers: AxisRegisters,
    steps: i128,
}

impl Axis {
    fn new() -> Self {
        let mut registers = AxisRegisters::at_rest(HALF);
        // A tick of rest, of which the first segment is the successor.
        registers.waiting = Some(Segment { ticks: 1, v: 0, a: 0, j: 0, last: false });
        let (registers, _) = tick(registers, true, 4);
        Self { registers, steps: 0 }
    }

    fn place(&self) -> i128 {
        (self.steps << 64) + i128::from(self.registers.p) - i128::from(HALF)
    }

    /// Executes a tick, in which `next` is the segment that waits.
    fn tick(&mut self, next: Option<Segment>) {
        if next.is_some() {
            self.registers.waiting = next;
        }
        let (after, output) = tick(self.registers, false, 4);
        assert!(!output.overspeed && !output.underrun);
        self.steps += output.step.map_or(0, |step| if step.backward { -1 } else { 1 });
        self.registers = after;
    }
}

/// A motion of one axis: a command for each period, in steps, at rest at both ends.
#[derive(Debug, Clone)]
struct Motion {
    commands: Vec<f64>,
    /// Greatest speed and acceleration, steps/s and steps/s^2.
    speed: f64,
    acceleration: f64,
}

fn motion(pushes: &[i8], speed: f64, acceleration: f64, period: f64, rest: usize) -> Motion {
    let (mut place, mut now, mut commands) = (0.0_f64, 0.0_f64, Vec::new());
    let mut pass = |now: &mut f64, push: f64| {
        let next = (*now + push * acceleration * period).clamp(-speed, speed);
        place += (*now + next) / 2.0 * period;
        *now = next;
        commands.push(place);
    };
    for &push in pushes {
        for _ in 0..9 {
            pass(&mut now, f64::from(push));
        }
    }
    while now != 0.0 {
        let push = -(now / (acceleration * period)).clamp(-1.0, 1.0);
        pass(&mut now, push);
        now = if now.abs() < 1e-6 { 0.0 } else { now };
    }
    (0..rest).for_each(|_| pass(&mut now, 0.0));
    Motion { commands, speed, acceleration }
}

fn numbers(line: &str) -> Vec<i64> {
    line.split(' ').map(|word| word.parse().unwrap()).collect()
}

fn exact(steps: f64) -> i128 {
    (steps * STEP) as i128
}

/// What rounding of A and J to integers, and of the speed to a double, may do to V: 2^-64 step per
/// tick.
fn rounding(ticks: u32) -> i128 {
    i128::from(ticks) * i128::from(ticks) + (1 << 16)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]

    #[test]
    fn model_runs_segments_to_the_commands(
        pushes in prop::collection::vec(-1_i8..=1, 1..30),
        speed in 10.0_f64..100_000.0,
        ramp in 0.01_f64..0.5,
        periods in prop::sample::select(vec![1_usize, 2, 4, 8]),
        period_ns in prop::sample::select(vec![500_000_u32, 1_000_000, 2_000_000]),
        tick_ns in 700_u32..4000,
        trim in -2_000_000_i32..2_000_000,
    ) {
        let period = f64::from(period_ns) * 1e-9;
        let motion = motion(&pushes, speed, speed / ramp, period, 3 * periods + 2);
        let mut bench = Bench::parts().run("blocks");
        let most = motion.speed;
        let head = format!("1 {periods} {period_ns} {tick_ns} {trim} {most}");
        prop_assert_eq!(bench.say(&head), "1");
        let mut axis = Axis::new();
        let (mut blocks, mut total) = (0_usize, 0_u64);
        let mut last: Option<(i128, i128)> = None;
        for command in &motion.commands {
            let said = numbers(&bench.say(&format!("{command:?}")));
            prop_assert!(said[0] == NONE || said[0] == BLOCK, "{:?}", said);
            if said[0] == NONE {
                continue;
            }
            let (ticks, v, a, j) = (said[2] as u32, said[3], said[4], said[5]);
            let mut next = Some(Segment { ticks, v, a, j, last: false });
            // Speed is continuous: V changes by no more than acceleration does in a tick.
            if let Some((v_end, a_end)) = last {
                let allowed = i128::from(a).abs() + i128::from(j).abs() + i128::abs(a_end) + rounding(ticks);
                prop_assert!((i128::from(v) - v_end).abs() <= allowed, "{v} {v_end} {allowed}");
            }
            // The tick before the first of the segment is still of the one before.
            axis.tick(next.take());
            let samples = &motion.commands[blocks * periods..(blocks + 1) * periods];
            let mut due = 0;
            for done in 1..=ticks {
                if done < ticks {
                    axis.tick(None);
                } else {
                    // P after the last tick, without executing it: the next segment waits for it.
                    let last = axis.registers;
                    let after = axis.place() + i128::from(last.v);
                    let end = exact(samples[periods - 1]);
                    let allowed = i128::from(ticks);
                    prop_assert!((after - end).abs() <= allowed, "block {blocks}: {}", after - end);
                }
                let passed = f64::from(done) * periods as f64 / f64::from(ticks);
                if passed >= (due + 1) as f64 && done < ticks {
                    let length = periods as f64 * period;
                    let bound = motion.acceleration * length * (length / 8.0 + period / 4.0)
                        + motion.speed * f64::from(tick_ns) * 2e-9
                        + 1e-6;
                    let error = axis.place() as f64 / STEP - samples[due];
                    prop_assert!(error.abs() <= bound, "{error} > {bound}");
                    due += 1;
                }
            }
            let n = i128::from(ticks);
            let v_end = i128::from(v) + n * i128::from(a) + n * (n - 1) / 2 * i128::from(j);
            let a_end = i128::from(a) + n * i128::from(j);
            // The speed at the end is that of the commands around it.
            let at = (blocks + 1) * periods - 1;
            let before = at.checked_sub(1).map_or(0.0, |at| motion.commands[at]);
            let slope = (motion.commands[at + 1] - before) / 2.0 * periods as f64 / f64::from(ticks);
            let off = (v_end as f64 - slope * STEP).abs();
            let allowed = (a_end.abs() + i128::from(j).abs() + rounding(ticks)) as f64;
            prop_assert!(off <= allowed, "{off} > {allowed}");
            last = Some((v_end, a_end));
            blocks += 1;
            total += u64::from(ticks);
        }
        prop_assert!(blocks >= motion.commands.len() / periods - 1);
        // At the end, all is at rest: the last pulse was that of the rounded command.
        let command = motion.commands.last().unwrap();
        prop_assert_eq!(axis.registers.v, 0);
        let off = axis.place() - exact(*command);
        prop_assert!(off.abs() <= 1 << 22, "{off}");
        let nominal = (blocks * periods) as f64 * f64::from(period_ns) / f64::from(tick_ns);
        let wanted = nominal * (1.0 + f64::from(trim) * 1e-9);
        prop_assert!((total as f64 - wanted).abs() <= 1.0, "{total} {wanted}");
        bench.end();
    }

    /// The sum over whole ticks meets the continuous cubic at every tick: a tick is not half off.
    #[test]
    fn cubic_is_met_at_every_tick(
        ticks in 2_u32..8000,
        v0 in -0.3_f64..0.3,
        change in -0.1_f64..0.1,
        bend in -0.05_f64..0.05,
    ) {
        let (n, v1) = (f64::from(ticks), v0 + change);
        let distance = (v0 + v1) / 2.0 * n + bend * n;
        let mut bench = Bench::parts().run("cubic");
        let said = numbers(&bench.say(&format!("{ticks} {distance:?} {v0:?} {v1:?}")));
        bench.end();
        // Only accelerations that a tick cannot hold are refused.
        prop_assume!(said[0] == 1);
        let [v, a, j] = [1, 2, 3].map(|at| said[at] as f64 / STEP);
        for done in [1, 2, ticks / 3, ticks / 2, ticks - 1, ticks] {
            let t = f64::from(done);
            let run = t * v + t * (t - 1.0) / 2.0 * a + t * (t - 1.0) * (t - 2.0) / 6.0 * j;
            let u = t / n;
            let wanted = distance * (3.0 - 2.0 * u) * u * u
                + v0 * n * u * (1.0 - u) * (1.0 - u)
                - v1 * n * u * u * (1.0 - u);
            prop_assert!((run - wanted).abs() < 1e-6, "{done} of {ticks}: {run} {wanted}");
        }
    }
}

#[test]
fn commands_that_nothing_can_follow_are_refused() {
    let refused = [
        ("0 nan", NOT_A_NUMBER, 1),
        ("inf 0", NOT_A_NUMBER, 0),
        ("0 -inf", NOT_A_NUMBER, 1),
        ("1e300 0", OUT_OF_RANGE, 0),
        ("0 -2147483648", OUT_OF_RANGE, 1),
        ("0 50.2", JUMP, 1),
        ("-51 0", JUMP, 0),
    ];
    for (words, outcome, culprit) in refused {
        let mut bench = Bench::parts().run("blocks");
        assert_eq!(bench.say("2 4 1000000 1000 0 50000 50000"), "1");
        assert_eq!(numbers(&bench.say("50 -50")), [NONE, 1]);
        assert_eq!(numbers(&bench.say("0 0")), [NONE, 1]);
        assert_eq!(numbers(&bench.say(words)), [outcome, culprit], "{words}");
        bench.end();
    }
    for words in ["9 4 1000000 1000 0 1 1 1 1 1 1 1 1 1", "1 0 1000000 1000 0 1"] {
        assert_eq!(Bench::parts().run("blocks").say(words), "0", "{words}");
    }
    for words in ["1 4 1000000 0 0 1", "1 65 1000000 1000 0 1", "1 1 1000 1000 0 1"] {
        assert_eq!(Bench::parts().run("blocks").say(words), "0", "{words}");
    }
}

/// Ten minutes of a board whose clock is off by 200 ppm, with snapshots that come late by up to
/// 8 ms, and a computer that falls behind by 20 ms once.
#[test]
fn lead_stays_at_the_horizon_for_ten_minutes() {
    const HORIZON: f64 = 40_000.0;
    for ppm in [-200.0, 200.0] {
        for knows in [false, true] {
            let mut bench = Bench::parts().run("trim");
            bench.say(&format!("{HORIZON}"));
            let (mut lead, mut trim, mut worst) = (HORIZON, 0.0, 0.0_f64);
            for number in 0..60_000_u64 {
                lead += 10_000.0 * (trim * 1e-9 - ppm * 1e-6);
                lead -= if number == 30_000 { 20_000.0 } else { 0.0 };
                let noise = (number.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 51) as f64;
                let faster = if knows { ppm * 1e3 } else { 0.0 };
                let said = bench.say(&format!("{} {faster}", (lead + noise).round()));
                trim = said.parse::<f64>().unwrap();
                if !(30_000..=40_000).contains(&number) {
                    worst = worst.max((lead - HORIZON).abs());
                }
            }
            assert!(worst < 12_000.0, "{ppm} ppm, known {knows}: off by {worst} ticks");
            bench.end();
        }
    }
}

#[test]
fn ring_passes_every_element_once_and_in_order() {
    let mut bench = Bench::parts().run("ring");
    assert_eq!(bench.say("200000"), "200000");
    bench.end();
}
