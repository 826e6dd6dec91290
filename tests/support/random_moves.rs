//! Generates random moves of random machines, as move files.

use carrystep_core::{PinTimes, ProfileKind};
use carrystep_files::{MoveFile, SourceText};
use carrystep_plan::plan;
use proptest::prelude::*;

const CLOCK_HZ: u64 = 64_000_000;

/// The range of durations.
#[derive(Debug, Clone, Copy)]
pub enum Pace {
    /// From microseconds to days.
    Any,
    /// Fractions of a second, which are quick to simulate. No ramp ends within a few ticks, so that
    /// edges keep the bound of the accuracy contract, which uses the acceleration at the edge
    /// itself.
    Brisk,
}

/// A move file from its text.
pub fn file(text: &str) -> MoveFile {
    MoveFile::from_source(SourceText { path: "test.toml".into(), text: text.into() })
        .unwrap_or_else(|error| panic!("{error}\n{text}"))
}

#[derive(Debug, Clone)]
struct RandomAxis {
    speed: f64,
    start: f64,
    accel: f64,
    /// The jerk limit as a multiple of the acceleration limit, in 1/s.
    jerk: f64,
    per_unit: f64,
    pins: PinTimes,
}

/// Some moves of one machine.
#[derive(Debug, Clone)]
pub struct RandomMoves {
    tick_ns: u64,
    phases: u32,
    zero: bool,
    axes: Vec<RandomAxis>,
    moves: Vec<RandomMove>,
}

#[derive(Debug, Clone)]
struct RandomMove {
    profile: ProfileKind,
    /// Approximate number of steps of each axis.
    steps: Vec<i32>,
    /// The time as a multiple of the least time; `None` is the least time.
    stretch: Option<f64>,
    straight: bool,
    /// Tolerance of a fit, ns.
    fit_ns: Option<u64>,
}

impl RandomMoves {
    fn text(&self, times: &[Option<String>]) -> String {
        use std::fmt::Write as _;
        let phase = if self.zero { "zero" } else { "half" };
        let mut text = format!(
            "[machine]\nclock_hz = {CLOCK_HZ}\ntick_ns = {}\nphases = {}\nphase = \"{phase}\"\n",
            self.tick_ns, self.phases
        );
        for (i, axis) in self.axes.iter().enumerate() {
            let PinTimes { step_high, step_low, dir_setup, dir_hold } = axis.pins;
            // The greatest speed that tick, phases, width and gap allow; dividing by the units
            // makes it fractional.
            let clocks = |ns: u64| ((ns * CLOCK_HZ).div_ceil(1_000_000_000)).max(1) as f64;
            let phase = (self.tick_ns * CLOCK_HZ / 1_000_000_000) as f64 / f64::from(self.phases);
            let period = (clocks(step_high) + clocks(step_low) + phase) / CLOCK_HZ as f64;
            let most = (1.0 / period).min(0.4999e9 / self.tick_ns as f64);
            let speed = axis.speed.min(most * 0.999999);
            let accel = axis.accel.min(0.49e18 / (self.tick_ns * self.tick_ns) as f64);
            let u = axis.per_unit;
            write!(
                text,
                "[[machine.axis]]\nname = \"a{i}\"\nsteps_per_unit = {u:?}\nspeed_limit = {:?}\nstart_speed = {:?}\n\
                 accel_limit = {:?}\njerk_limit = {:?}\nstep_high_ns = {step_high}\nstep_low_ns = {step_low}\ndir_setup_ns = {dir_setup}\n\
                 dir_hold_ns = {dir_hold}\n",
                speed / u,
                speed * axis.start / u * 0.9999999,
                accel / u,
                accel / u * axis.jerk
            )
            .expect("a string takes all");
        }
        let constant = self.axes.iter().all(|axis| axis.start > 0.0);
        for (i, RandomMove { profile, steps, straight, fit_ns, .. }) in
            self.moves.iter().enumerate()
        {
            let profile = if *profile == ProfileKind::Constant && !constant {
                ProfileKind::Ranade
            } else {
                *profile
            };
            let to: Vec<String> = (steps.iter().zip(&self.axes).enumerate())
                .map(|(i, (&n, axis))| format!("a{i} = {:?}", f64::from(n) / axis.per_unit))
                .collect();
            let time =
                times.get(i).cloned().flatten().map_or(String::new(), |t| format!("time = {t}\n"));
            let fit = fit_ns.map_or(String::new(), |ns| format!("fit_ns = {ns}\n"));
            let path = if *straight { "straight" } else { "free" };
            write!(
                text,
                "[[move]]\nprofile = \"{profile}\"\npath = \"{path}\"\n{time}{fit}to = {{ {} }}\n",
                to.join(", ")
            )
            .expect("a string takes all");
        }
        text
    }

    /// The file without times, and the same file with the stretched times.
    pub fn files(&self) -> Vec<MoveFile> {
        let fast = file(&self.text(&[]));
        let planned =
            plan::<f64>(&fast).unwrap_or_else(|error| panic!("{error}\n{}", self.text(&[])));
        let times: Vec<Option<String>> = (self.moves.iter().zip(&planned.moves))
            .map(|(RandomMove { stretch, .. }, planned)| {
                // A file allows times up to 10^6 s.
                if planned.seconds > 0.9e6 {
                    return None;
                }
                let ns = (planned.seconds * 1e9 * (*stretch)?).min(1e15);
                let ticks = (ns / self.tick_ns as f64).ceil() * self.tick_ns as f64;
                Some(if self.zero {
                    format!("{:.9}", ticks / 1e9)
                } else {
                    format!("{:.12}", ns / 1e9)
                })
            })
            .collect();
        vec![fast, file(&self.text(&times))]
    }
}

fn decades(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

fn axis(pace: Pace) -> impl Strategy<Value = RandomAxis> {
    let [speed, accel, jerk] = match pace {
        Pace::Any => [(1.0, 1e6), (1.0, 1e8), (0.1, 1e5)],
        Pace::Brisk => [(2e4, 2e5), (4e6, 2e8), (200.0, 1e4)],
    }
    .map(|(low, high)| decades(low, high));
    let start = prop_oneof![2 => Just(0.0), 2 => 0.001..0.9, 1 => Just(1.0)];
    let pins = [1_u64..3000, 1_u64..3000, 1_u64..40_000, 1_u64..40_000];
    let unit = prop_oneof![Just(1.0), Just(80.0), decades(0.01, 1000.0)];
    (speed, start, accel, jerk, unit, pins).prop_map(
        |(speed, start, accel, jerk, per_unit, [step_high, step_low, dir_setup, dir_hold])| {
            RandomAxis {
                speed,
                start,
                accel,
                jerk,
                per_unit,
                pins: PinTimes { step_high, step_low, dir_setup, dir_hold },
            }
        },
    )
}

/// One to four moves of these kinds, for machines with one to three axes.
pub fn random_moves(
    pace: Pace,
    kinds: &'static [ProfileKind],
) -> impl Strategy<Value = RandomMoves> {
    let ticks: &[u64] = match pace {
        Pace::Any => &[500, 1000, 2000, 10_000],
        Pace::Brisk => &[500, 1000],
    };
    let tick = prop::sample::select(ticks);
    let phases = prop_oneof![Just(1_u32), Just(4), Just(16)];
    (tick, phases, any::<bool>(), proptest::collection::vec(axis(pace), 1..4)).prop_flat_map(
        move |(tick_ns, phases, zero, axes)| {
            let steps = prop_oneof![1 => Just(0), 2 => -3..4, 3 => -40..40, 3 => -3000..3000];
            let steps = proptest::collection::vec(steps, axes.len());
            let stretch =
                proptest::option::of(prop_oneof![Just(1.0000001), 1.0001..1.5, 1.0001..20.0]);
            let fit_ns = proptest::option::of(decades(1.0, 1e5).prop_map(|ns| ns as u64));
            let moved = (prop::sample::select(kinds), steps, any::<bool>(), stretch, fit_ns)
                .prop_map(|(profile, steps, straight, stretch, fit_ns)| RandomMove {
                    profile,
                    steps,
                    stretch,
                    straight,
                    fit_ns,
                });
            let moves = proptest::collection::vec(moved, 1..5);
            moves.prop_map(move |moves| RandomMoves {
                tick_ns,
                phases,
                zero,
                axes: axes.clone(),
                moves,
            })
        },
    )
}
