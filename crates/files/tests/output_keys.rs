//! Tests of `[machine.outputs]`: the values in the gateware, and every kind of mistake.

use carrystep_core::engine::Outputs;
use carrystep_files::{InputError, Machine, SourceText};

fn outputs(keys: &str) -> Result<Outputs, InputError> {
    let axis = "[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 1.0\nspeed_limit = 5000.0\n\
                accel_limit = 25000.0\ndriver = \"a4988\"\n";
    let text = format!("[machine]\n[machine.outputs]\n{keys}\n{axis}");
    let source = SourceText { path: "machine.toml".into(), text: text.into() };
    Machine::from_source(&source).map(|machine| machine.engine().outputs)
}

#[test]
fn keys_give_the_outputs_of_the_build() {
    assert_eq!(outputs("").unwrap(), Outputs::default());
    let all = Outputs { exist: 0xff, pwm_divider: 12, off_at_ramps: true };
    assert_eq!(outputs("count = 8\npwm_divider = 12").unwrap(), all);
    let stay = Outputs { exist: 0b11, pwm_divider: 0, off_at_ramps: false };
    assert_eq!(outputs("count = 2\nat_ramps = \"stay\"").unwrap(), stay);
}

#[test]
fn mistakes_are_refused_by_name() {
    for (keys, said) in [
        ("count = 9", "count = 9: an engine has at most 8"),
        ("pwm_divider = 0", "pwm_divider = 0: it is from 1 to 256"),
        ("pwm_divider = 257", "pwm_divider = 257: it is from 1 to 256"),
    ] {
        let error = outputs(keys).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
    assert!(outputs("colour = 1").is_err());
}
