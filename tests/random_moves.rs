//! Short moves of random machines, as the text of a move file: quick to simulate, clock by clock.

use carrystep_spec::ProfileKind;
use proptest::prelude::*;
use std::fmt::Write as _;

/// One axis and how far it goes.
#[derive(Debug, Clone)]
struct Axis {
    /// Steps/s.
    speed: f64,
    /// Start speed as a part of it.
    start: f64,
    /// Seconds from 0 to the speed limit at the acceleration limit, and to that at the jerk limit.
    rise: [f64; 2],
    /// Steps in a unit.
    per_unit: f64,
    /// Step, gap, set-up and hold, ns.
    pins: [u64; 4],
    /// Steps, about.
    steps: i32,
}

/// A move of one to three axes.
#[derive(Debug, Clone)]
pub struct RandomMove {
    profile: ProfileKind,
    phases: u32,
    zero: bool,
    axes: Vec<Axis>,
    straight: bool,
    /// Tolerance of a fit, ns.
    fit_ns: Option<u64>,
    /// Over the least time by this factor.
    stretch: Option<f64>,
}

impl RandomMove {
    /// The move file; `least` is the move's least time, seconds, once it is known.
    pub fn text(&self, least: Option<f64>) -> String {
        let phase = if self.zero { "zero" } else { "half" };
        let mut text = format!(
            "[machine]\nclock_hz = 48_000_000\ntick_ns = 1000\nphases = {}\nphase = \"{phase}\"\n",
            self.phases
        );
        let mut to = Vec::new();
        for (i, Axis { speed, start, rise, per_unit, pins: [step, gap, setup, hold], steps }) in
            self.axes.iter().enumerate()
        {
            // As fast as the driver allows, at most.
            let speed = speed.min(0.9e9 / (step + gap + 250) as f64);
            let accel = speed / rise[0];
            let [start, speed, accel, jerk] =
                [speed * start, speed, accel, accel / rise[1]].map(|limit| limit / per_unit);
            write!(
                text,
                "[[machine.axis]]\nname = \"a{i}\"\nsteps_per_unit = {per_unit:?}\nspeed_limit = {speed:?}\n\
                 start_speed = {start:?}\naccel_limit = {accel:?}\njerk_limit = {jerk:?}\n\
                 step_ns = {step}\ngap_ns = {gap}\nsetup_ns = {setup}\nhold_ns = {hold}\n"
            )
            .expect("a string takes all");
            to.push(format!("a{i} = {:?}", f64::from(*steps) / per_unit));
        }
        // Phase zero needs whole ticks.
        let digits = if self.zero { 6 } else { 9 };
        let time = self
            .stretch
            .zip(least)
            .map_or(String::new(), |(stretch, least)| format!("time = {:.digits$}\n", least * stretch));
        let profile = self.profile;
        let path = if self.straight { "straight" } else { "free" };
        let fit = self.fit_ns.map_or(String::new(), |ns| format!("fit_ns = {ns}\n"));
        write!(text, "[[move]]\npath = \"{path}\"\n{fit}profile = \"{profile}\"\n{time}to = {{ {} }}\n", to.join(", "))
            .expect("a string takes all");
        text
    }

    /// Whether a time of its own is to be given.
    pub fn is_stretched(&self) -> bool {
        self.stretch.is_some()
    }
}

fn axis() -> impl Strategy<Value = Axis> {
    let decades = |low: f64, high: f64| (low.ln()..high.ln()).prop_map(f64::exp);
    let start = prop_oneof![2 => Just(0.0), 1 => 0.01..0.9];
    let rise = [decades(1e-4, 5e-3), decades(1e-4, 5e-3)];
    let pins = [1_u64..2000, 1_u64..2000, 1_u64..10_000, 1_u64..10_000];
    let unit = prop_oneof![Just(1.0), Just(80.0), decades(0.01, 1000.0)];
    let steps = prop_oneof![1 => -3..4, 2 => -40..40, 3 => -600..600];
    (decades(20_000.0, 200_000.0), start, rise, unit, pins, steps)
        .prop_map(|(speed, start, rise, per_unit, pins, steps)| Axis { speed, start, rise, per_unit, pins, steps })
}

/// A move with one of these profiles.
pub fn random_move(profile: ProfileKind) -> impl Strategy<Value = RandomMove> {
    let axes = proptest::collection::vec(axis(), 1..=3);
    let stretch = proptest::option::of(1.01..3.0);
    let phases = prop_oneof![3 => Just(16_u32), 1 => Just(4)];
    let fit_ns = proptest::option::of((0.0..10.0_f64).prop_map(|power| power.exp2() as u64));
    (axes, phases, any::<[bool; 2]>(), fit_ns, stretch).prop_map(
        move |(axes, phases, [zero, straight], fit_ns, stretch)| RandomMove {
            profile,
            phases,
            zero,
            axes,
            straight,
            fit_ns,
            stretch,
        },
    )
}
