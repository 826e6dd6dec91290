//! What tests ask of the component beside motion, and boards with inputs for it.

use super::world::{JOINTS, SCALE, World, build};
use carrystep_core::EngineBuild;
use carrystep_core::engine::{InputRow, Latch, LatchSource, LimitWiring};

/// Speed of `long`, steps per ms.
pub const SPEED: f64 = 2.5;
/// Where inputs become active, steps.
pub const EDGE: i32 = 400;

/// A board with a probe and a general input, and with these latches.
pub fn with(latches: Vec<Latch>) -> EngineBuild {
    let mut build = build();
    build.guard.limits = LimitWiring::None;
    build.guard.inputs = [InputRow { exist: 0b011, low: 0 }, InputRow::default()];
    build.guard.latches = latches;
    build.check().unwrap();
    build
}

/// A latch at the probe's pin.
pub fn at_probe() -> Latch {
    Latch { source: LatchSource::Switch { row: 2, axis: 0 }, low: false, looks: 1 }
}

impl World {
    /// The pins `homing` and `index-enable` of the joints, the outputs and the PWM's duty.
    pub fn asks(&mut self, homing: u32, index: u32, levels: u32, duty: f64) {
        let words = format!("asks {homing} {index} {levels} {duty:?}");
        assert_eq!(self.bench.say(&words), "ok");
    }

    /// Follows `place` until `done`. In that period the feedback is returned, in steps; in all
    /// others it must be the command.
    pub fn watched(
        &mut self,
        most_ms: u32,
        place: impl Fn(f64) -> [f64; JOINTS],
        done: impl Fn(&World) -> bool,
    ) -> [f64; JOINTS] {
        for period in 1..=most_ms {
            self.command = place(f64::from(period) / 1000.0);
            let says = self.servo(true);
            assert_eq!((says.fault, says.running), (0, true), "in period {period}");
            self.pass();
            if done(self) {
                return says.feedback.map(|units| units * SCALE);
            }
            for joint in 0..JOINTS {
                assert!(
                    (says.feedback[joint] - self.command[joint]).abs() < 1e-6,
                    "in period {period}"
                );
            }
        }
        panic!("not within {most_ms} ms: {:?}", self.says);
    }

    /// Goes on from the place of the command for 20 ms, in which the feedback is the command, and
    /// rests.
    pub fn goes_on(&mut self, per_ms: f64) {
        let from = self.command;
        self.follow(20, |time| [from[0] + time * 1000.0 * per_ms, from[1], from[2]]);
        let from = self.command;
        // The ramp of a tenth of a second.
        self.follow(100, |time| {
            [from[0] + 1000.0 * per_ms * (time - time * time / 0.2), from[1], from[2]]
        });
        self.rest();
    }
}

/// The edge lies half a step before the pulse that shows it, and is seen up to 10 us later.
pub fn is_the_edge(found: f64, edge: i32) {
    let off = found - (f64::from(edge) - 0.5);
    assert!((-0.02..0.1).contains(&off), "{found}: {off} steps off");
}
