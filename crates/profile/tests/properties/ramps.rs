//! Properties of single ramps with parameters of every size, and with invalid parameters.

use super::decades;
use super::laws::{Slack, hold};
use carrystep_profile::{BadRamp, Curve, LogisticRamp, Profile, ScurveRamp, SineRamp};
use proptest::prelude::*;

const SLACK: Slack = Slack { rounding: 64.0, quadrature: 1e4 };

proptest! {
    #[test]
    fn logistic_ramps_obey_all_laws(w in decades(1e-3, 1e7), a in decades(1e-3, 1e9), centre in 0.1..40.0, shortfall in decades(1e-6, 0.3)) {
        let ramp = LogisticRamp::new(w, a, centre * w / (4.0 * a), shortfall).unwrap();
        // The relative precision of e^(k T_i) is k T_i epsilons, and that of the quadrature is (k T
        // / 64)^10.
        hold(&ramp, &Slack { rounding: 64.0 + 4.0 * centre, quadrature: 1e6 });
        let figures = ramp.figures();
        prop_assert!((figures.end_speed / (w * (1.0 - shortfall)) - 1.0).abs() < 1e-12);
        prop_assert!(figures.peak_acceleration <= a * (1.0 + 1e-12));
    }

    #[test]
    fn sine_ramps_obey_all_laws(top in decades(1e-3, 1e7), time in decades(1e-6, 1e4)) {
        hold(&SineRamp::new(top, time).unwrap(), &SLACK);
    }

    #[test]
    fn scurve_ramps_obey_all_laws(top in decades(1e-3, 1e7), start in 0.0..0.999, a in decades(1e-3, 1e9), j in decades(1e-3, 1e12)) {
        hold(&ScurveRamp::new(start * top, top, a, j).unwrap(), &SLACK);
        hold(&ScurveRamp::new(start * top, top, a, f64::INFINITY).unwrap(), &SLACK);
        hold(&ScurveRamp::new(0.0, top, f64::INFINITY, j).unwrap(), &SLACK);
    }

    /// 1 / c_n is a mean speed, so it lies between the speeds at both ends of the step, however
    /// late the step is.
    #[test]
    fn delay_lies_between_the_speeds_at_its_ends(top in decades(10.0, 1e6), time in decades(0.1, 1e4), at in 0.0..1.0_f64) {
        let ramp = SineRamp::new(top, time).unwrap();
        prop_assume!(ramp.distance() > 2.0);
        let n = (at * (ramp.distance() - 1.0)).floor();
        let mean = ramp.delay(n).recip();
        let [slow, fast] = [n, n + 1.0].map(|n| ramp.speed(ramp.crossing(n)));
        prop_assert!(mean >= slow * (1.0 - 1e-12) && mean <= fast * (1.0 + 1e-12), "{slow} {mean} {fast}");
    }

    /// Invalid parameters are refused or computed with. They cause no panic and no endless loop.
    #[test]
    fn invalid_ramp_parameters_never_panic(numbers in prop::array::uniform4(any::<f64>()), at in any::<f64>()) {
        let [a, b, c, d] = numbers;
        let ask = |curve: &dyn Curve<f64>| {
            let _ = (curve.position(at), curve.speed(at), curve.acceleration(at), curve.jerk(at), curve.crossing(at));
            let _ = (curve.mean_speed(at, b), curve.delay(at), curve.figures());
        };
        if let Ok(ramp) = LogisticRamp::new(a, b, c, d) { ask(&ramp) }
        if let Ok(ramp) = LogisticRamp::symmetric(a, b) { ask(&ramp) }
        if let Ok(ramp) = SineRamp::new(a, b) { ask(&ramp) }
        if let Ok(ramp) = ScurveRamp::new(a, b, c, d) { ask(&ramp) }
    }
}

#[test]
fn errors_name_the_parameter_and_a_value_that_works() {
    let late = LogisticRamp::new(1000.0, 5000.0, -0.3, 0.005).unwrap_err();
    let BadRamp::NoRampTime { least, .. } = late else { panic!("{late:?}") };
    assert!((least + 199.0_f64.ln() / 20.0).abs() < 1e-12);
    assert!(LogisticRamp::new(1000.0, 5000.0, least + 1e-6, 0.005).is_ok());
    assert_eq!(
        LogisticRamp::new(0.0, 5000.0, 0.3, 0.005).unwrap_err().to_string(),
        "the top speed is 0; it must be finite and over 0"
    );
    assert_eq!(
        SineRamp::new(1000.0, f64::NAN).unwrap_err().to_string(),
        "the ramp time is NaN; it must be finite and over 0"
    );
    assert_eq!(
        ScurveRamp::new(1000.0, 500.0, 1e4, 1e6).unwrap_err().to_string(),
        "a ramp up from 1000 to 500 steps/s; its top speed must be 1000 steps/s or more"
    );
    assert!(ScurveRamp::new(0.0, 500.0, f64::INFINITY, f64::INFINITY).is_err());
}
