//! The power of a laser along a path, and how the planner carries it.

use carrystep_core::engine::PWM_STEPS;

/// Bit of a mark: it is the power of a laser. Places to wait at have bit 63 (`sync.rs`).
const LASER: u64 = 1 << 62;
/// Bits of such a mark that hold the duty.
const DUTY: u64 = PWM_STEPS as u64 - 1;
/// Bit of such a mark: the power follows the speed.
const FOLLOWS: u64 = 1 << 12;
/// First of the bits that hold the feed as a float.
const FEED: u32 = 16;

/// The power of a laser from a place of the path on.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum LaserPower {
    /// The laser is off.
    #[default]
    Off,
    /// The same duty at each speed (M3), 0 to 4095 of 4096. At rest the laser is off.
    Constant {
        /// The duty.
        duty: u16,
    },
    /// A duty in proportion to the speed (M4), so that each mm of the path gets the same energy.
    Following {
        /// The duty at the feed, 0 to 4095 of 4096.
        duty: u16,
        /// The feed, mm/s (degrees/s where only rotary axes move).
        feed: f32,
    },
}

impl LaserPower {
    /// The duty of the PWM at a speed along the path, in the unit of the feed. An override may make
    /// the motion faster than the feed; the greatest duty is one step short of 1.
    pub fn duty(self, speed: f64) -> u16 {
        match self {
            Self::Constant { duty } if speed > 0.0 => duty,
            Self::Following { duty, feed } if speed > 0.0 && feed > 0.0 => {
                let duty = f64::from(duty) * speed / f64::from(feed);
                duty.round().min(f64::from(PWM_STEPS - 1)) as u16
            }
            _ => 0,
        }
    }

    /// The mark that the planner carries.
    pub(crate) fn mark(self) -> u64 {
        match self {
            Self::Off => LASER,
            Self::Constant { duty } => LASER | u64::from(duty),
            Self::Following { duty, feed } => {
                LASER | FOLLOWS | u64::from(duty) | u64::from(feed.to_bits()) << FEED
            }
        }
    }

    /// The power in a mark, if it is none of a place to wait at.
    pub(crate) fn of_mark(mark: u64) -> Option<Self> {
        if mark & LASER == 0 {
            return None;
        }
        let duty = (mark & DUTY) as u16;
        let feed = f32::from_bits((mark >> FEED) as u32);
        Some(if mark & FOLLOWS != 0 {
            Self::Following { duty, feed }
        } else if duty > 0 {
            Self::Constant { duty }
        } else {
            Self::Off
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn mark_gives_the_power_back(duty in 1_u16..4096, feed in 1e-3_f32..1e6) {
            for power in [
                LaserPower::Off,
                LaserPower::Constant { duty },
                LaserPower::Following { duty, feed },
            ] {
                prop_assert_eq!(LaserPower::of_mark(power.mark()), Some(power));
            }
        }

        #[test]
        fn each_mm_gets_the_same_energy(
            duty in 0_u16..4096, feed in 1e-3_f32..1e6, speed in 0.0_f64..1e7,
        ) {
            let following = LaserPower::Following { duty, feed }.duty(speed);
            let ideal = (f64::from(duty) * speed / f64::from(feed)).min(4095.0);
            prop_assert!((f64::from(following) - ideal).abs() <= 0.5 + 1e-9 * ideal);
        }
    }

    #[test]
    fn laser_is_off_at_rest() {
        assert_eq!(LaserPower::Constant { duty: 9 }.duty(0.0), 0);
        assert_eq!(LaserPower::Following { duty: 9, feed: 1.0 }.duty(0.0), 0);
        assert_eq!(LaserPower::Off.duty(1.0), 0);
    }
}
