//! The shape of a ramp, and the ramp of a shape.

use crate::curve::Curve;
use crate::logistic::LogisticRamp;
use crate::own::{OwnRamp, Shape};
use crate::profile::Real;
use crate::sine::SineRamp;

impl OwnRamp {
    /// The ramp of a shape, or `None` if it takes no time or if `F` is less precise than f64: the
    /// floats of such a profile are a curve of their own.
    pub(crate) fn of<F: Real>(shape: Shape, duration: F, distance: F) -> Option<Self> {
        let precise = F::epsilon().to_f64() <= Some(f64::EPSILON);
        let (duration, distance) = (duration.to_f64()?, distance.to_f64()?);
        let ramp = Self { shape, duration, distance };
        (precise && duration > 0.0 && distance > 0.0).then_some(ramp)
    }
}

impl Shape {
    /// The ramp up of this shape that travels `distance` steps in `duration` seconds, both over 0.
    pub fn ramp(self, duration: f64, distance: f64) -> Box<dyn Curve<f64>> {
        match self {
            Self::Sine => Box::new(SineRamp::lasting(2.0 * distance / duration, duration)),
            Self::Logistic { start } => {
                Box::new(LogisticRamp::shaped(f64::from_bits(start), duration, distance))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::own::{OwnRamp, Shape};
    use crate::profile::Profile;
    use crate::refusal::Limits;
    use crate::rule::{logistic, sine};

    const LIMITS: Limits<f64> =
        Limits { start_speed: 100.0, speed: 5e4, acceleration: 4e5, jerk: f64::INFINITY };

    #[test]
    fn a_ramp_is_its_shape_in_its_duration_and_distance() {
        for start_speed in [0.0, 100.0, 1e4] {
            let limits = Limits { start_speed, ..LIMITS };
            for steps in [100.0, 1e4, 1e5] {
                let moves: [Box<dyn Profile<f64>>; 2] = [
                    Box::new(sine(steps, 3.0, &limits).unwrap()),
                    Box::new(logistic(steps, 3.0, &limits).unwrap()),
                ];
                for whole in moves {
                    let [up, down] = whole.own_ramps().unwrap();
                    let ramp = up.shape.ramp(up.duration, up.distance);
                    for t in (0..=64).map(|k| up.duration * f64::from(k) / 64.0) {
                        let [here, there] = [ramp.position(t), whole.position(t)];
                        assert!((here - there).abs() <= 1e-13 * up.distance, "{here} {there}");
                        let left = whole.distance() - whole.position(whole.duration() - t);
                        assert!((here - left).abs() <= 1e-11 * steps, "{here} {left}");
                    }
                    assert_eq!(up.shape, down.shape);
                }
            }
        }
    }

    #[test]
    fn a_ramp_in_f32_has_no_shape() {
        assert_eq!(OwnRamp::of(Shape::Sine, 1.0_f32, 1.0), None);
        assert_eq!(OwnRamp::of(Shape::Sine, 0.0_f64, 1.0), None);
    }
}
