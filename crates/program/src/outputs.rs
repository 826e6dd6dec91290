//! What the outputs of a machine do for a program: spindle, coolant, and outputs that the program
//! names.

use crate::error::Fault;
use crate::laser::LaserPower;
use carrystep_core::OutputChange;
use carrystep_core::engine::{Outputs, PWM_STEPS};
use carrystep_files::Machine;
use carrystep_files::machine::OutputUses;
use carrystep_gcode::Turn;

/// The outputs of a machine, and what programs do with them.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ProgramOutputs {
    exist: Outputs,
    uses: OutputUses,
}

/// What a code changes. `is_all` is false if the code asks for more than the machine can switch.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Effect {
    pub(crate) change: OutputChange,
    pub(crate) is_all: bool,
}

impl ProgramOutputs {
    pub(crate) const fn new(machine: &Machine) -> Self {
        Self { exist: machine.outputs, uses: machine.output_uses }
    }

    /// M3, M4, M5 and S, in turns per minute.
    pub(crate) fn spindle(&self, turn: Turn, rpm: f64) -> Result<Effect, Fault> {
        let OutputUses { spindle, spindle_reverse, spindle_rpm, laser, .. } = self.uses;
        let turns = turn != Turn::Off;
        let is_reverse = turn == Turn::Counterclockwise;
        let is_switched = spindle.is_some() || spindle_rpm.is_some();
        if is_reverse && is_switched && spindle_reverse.is_none() && !laser {
            return Err(Fault::NoReverse);
        }
        let mut change = level(spindle, turns).then(level(spindle_reverse, is_reverse));
        if let Some(most) = spindle_rpm {
            let rpm = if turns { rpm } else { 0.0 };
            if rpm > f64::from(most) {
                return Err(Fault::SpindleSpeed { rpm, most });
            }
            // That of a laser follows the motion.
            change.duty = Some(duty(rpm / f64::from(most))).filter(|_| !laser);
        }
        Ok(Effect { change, is_all: is_switched })
    }

    /// Whether the spindle is a laser.
    pub(crate) const fn has_laser(&self) -> bool {
        self.uses.laser
    }

    /// The power of a laser that is switched by M3, M4, M5 and S, in a move with a feed in mm/s, or
    /// in a rapid move. `None` if the machine has no laser.
    pub(crate) fn laser(&self, turn: Turn, rpm: f64, feed: Option<f64>) -> Option<LaserPower> {
        let most = self.uses.spindle_rpm.filter(|_| self.uses.laser)?;
        let duty = duty(rpm / f64::from(most));
        Some(match (turn, feed) {
            (Turn::Clockwise, Some(_)) if duty > 0 => LaserPower::Constant { duty },
            (Turn::Counterclockwise, Some(feed)) if duty > 0 => {
                LaserPower::Following { duty, feed: feed as f32 }
            }
            _ => LaserPower::Off,
        })
    }

    /// M7, M8, M9: what is on from here on.
    pub(crate) fn coolant(&self, mist: bool, flood: bool) -> Effect {
        let uses = self.uses;
        let change = level(uses.mist, mist).then(level(uses.flood, flood));
        let lacks = (mist && uses.mist.is_none()) || (flood && uses.flood.is_none());
        Effect { change, is_all: !lacks && change.mask != 0 }
    }

    /// M62 to M65.
    pub(crate) fn digital(&self, index: u32, on: bool) -> Result<Effect, Fault> {
        if !self.exist.is_any() {
            return Ok(Effect { change: OutputChange::NONE, is_all: false });
        }
        let count = self.exist.exist.count_ones();
        let number = u8::try_from(index).ok().filter(|_| index < count);
        let Some(number) = number else { return Err(Fault::NoOutput { index, count }) };
        let is_used = |(_, other): &(&str, Option<u8>)| *other == Some(number);
        if let Some((key, _)) = self.uses.named().into_iter().find(is_used) {
            return Err(Fault::OutputInUse { index, key });
        }
        Ok(Effect { change: level(Some(number), on), is_all: true })
    }

    /// M67, M68: the duty of the PWM, from 0 to 1.
    pub(crate) fn analog(&self, index: u32, value: f64) -> Result<Effect, Fault> {
        if !self.exist.is_any() {
            return Ok(Effect { change: OutputChange::NONE, is_all: false });
        }
        if index != 0 || self.exist.pwm_divider == 0 || self.uses.spindle_rpm.is_some() {
            return Err(Fault::NoAnalogOutput { index });
        }
        if !(0.0..=1.0).contains(&value) {
            return Err(Fault::Duty { value });
        }
        let change = OutputChange { duty: Some(duty(value)), ..OutputChange::NONE };
        Ok(Effect { change, is_all: true })
    }
}

/// The change of one output; none if there is no output.
fn level(output: Option<u8>, on: bool) -> OutputChange {
    let mask = output.map_or(0, |number| 1_u8.checked_shl(number.into()).unwrap_or(0));
    OutputChange { mask, levels: if on { mask } else { 0 }, duty: None }
}

/// The duty for a part of the whole, from 0 to 1. The greatest duty is one step short of 1.
fn duty(part: f64) -> u16 {
    let steps = (part * f64::from(PWM_STEPS)).round();
    steps.min(f64::from(PWM_STEPS - 1)) as u16
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Four outputs and a PWM: spindle 0, its direction 1, flood 3.
    const OUTPUTS: ProgramOutputs = ProgramOutputs {
        exist: Outputs { exist: 0xf, pwm_divider: 4, off_at_ramps: true },
        uses: OutputUses {
            spindle: Some(0),
            spindle_reverse: Some(1),
            mist: None,
            flood: Some(3),
            spindle_rpm: Some(24_000),
            laser: false,
        },
    };

    fn change(mask: u8, levels: u8, duty: Option<u16>) -> OutputChange {
        OutputChange { mask, levels, duty }
    }

    #[test]
    fn spindle_turns_both_ways_at_its_speed() {
        let told = |turn, rpm| OUTPUTS.spindle(turn, rpm).map(|effect| effect.change);
        assert_eq!(told(Turn::Clockwise, 12_000.0), Ok(change(3, 1, Some(2048))));
        assert_eq!(told(Turn::Counterclockwise, 24_000.0), Ok(change(3, 3, Some(4095))));
        assert_eq!(told(Turn::Off, 24_000.0), Ok(change(3, 0, Some(0))));
        let fast = told(Turn::Clockwise, 24_001.0);
        assert_eq!(fast, Err(Fault::SpindleSpeed { rpm: 24_001.0, most: 24_000 }));
        let mut one_way = OUTPUTS;
        one_way.uses.spindle_reverse = None;
        assert_eq!(one_way.spindle(Turn::Counterclockwise, 1.0), Err(Fault::NoReverse));
        // A spindle that has only its speed would turn forward.
        one_way.uses.spindle = None;
        assert_eq!(one_way.spindle(Turn::Counterclockwise, 1.0), Err(Fault::NoReverse));
    }

    #[test]
    fn coolant_that_has_no_output_is_told() {
        let flood = Effect { change: change(8, 8, None), is_all: true };
        assert_eq!(OUTPUTS.coolant(false, true), flood);
        assert_eq!(OUTPUTS.coolant(true, true), Effect { is_all: false, ..flood });
        let off = Effect { change: change(8, 0, None), is_all: true };
        assert_eq!(OUTPUTS.coolant(false, false), off);
    }

    #[test]
    fn outputs_are_named_by_their_numbers() {
        let on = OUTPUTS.digital(2, true).map(|effect| effect.change);
        assert_eq!(on, Ok(change(4, 4, None)));
        assert_eq!(OUTPUTS.digital(4, true), Err(Fault::NoOutput { index: 4, count: 4 }));
        let flood = Fault::OutputInUse { index: 3, key: "flood" };
        assert_eq!(OUTPUTS.digital(3, true), Err(flood));
    }

    #[test]
    fn laser_is_on_in_moves_with_a_feed() {
        assert_eq!(OUTPUTS.laser(Turn::Clockwise, 1000.0, Some(1.0)), None);
        let mut laser = OUTPUTS;
        (laser.uses.laser, laser.uses.spindle_reverse) = (true, None);
        let power = |turn, rpm, feed| laser.laser(turn, rpm, feed).unwrap();
        let constant = LaserPower::Constant { duty: 2048 };
        assert_eq!(power(Turn::Clockwise, 12_000.0, Some(5.0)), constant);
        let following = LaserPower::Following { duty: 2048, feed: 5.0 };
        assert_eq!(power(Turn::Counterclockwise, 12_000.0, Some(5.0)), following);
        assert_eq!(power(Turn::Counterclockwise, 12_000.0, None), LaserPower::Off);
        assert_eq!(power(Turn::Clockwise, 0.0, Some(5.0)), LaserPower::Off);
        assert_eq!(power(Turn::Off, 12_000.0, Some(5.0)), LaserPower::Off);
        // M4 switches the output `spindle` alone, and no duty.
        let on = laser.spindle(Turn::Counterclockwise, 12_000.0).map(|effect| effect.change);
        assert_eq!(on, Ok(change(1, 1, None)));
    }

    #[test]
    fn analog_output_has_the_duty_that_the_program_gives() {
        assert_eq!(OUTPUTS.analog(0, 0.5), Err(Fault::NoAnalogOutput { index: 0 }));
        let mut laser = OUTPUTS;
        laser.uses.spindle_rpm = None;
        let half = laser.analog(0, 0.5).map(|effect| effect.change);
        assert_eq!(half, Ok(change(0, 0, Some(2048))));
        assert_eq!(laser.analog(1, 0.5), Err(Fault::NoAnalogOutput { index: 1 }));
        assert_eq!(laser.analog(0, 1.5), Err(Fault::Duty { value: 1.5 }));
    }

    #[test]
    fn machine_without_outputs_does_nothing_and_says_so() {
        let none = ProgramOutputs { exist: Outputs::default(), uses: OutputUses::default() };
        let nothing = Effect { change: OutputChange::NONE, is_all: false };
        assert_eq!(none.spindle(Turn::Counterclockwise, 1e9), Ok(nothing));
        assert_eq!(none.coolant(true, false), nothing);
        assert_eq!(none.digital(9, true), Ok(nothing));
        assert_eq!(none.analog(9, 9.0), Ok(nothing));
        assert_eq!(none.spindle(Turn::Off, 0.0), Ok(nothing));
        assert_eq!(none.coolant(false, false), nothing);
    }
}
