//! Tests of `[machine.outputs]`: the values in the gateware, and every kind of mistake.

use carrystep_core::engine::Outputs;
use carrystep_files::machine::OutputUses;
use carrystep_files::{InputError, Machine, SourceText};

fn outputs(keys: &str) -> Result<Outputs, InputError> {
    machine(keys).map(|machine| machine.engine().outputs)
}

fn machine(keys: &str) -> Result<Machine, InputError> {
    let axis = "[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 1.0\nspeed_limit = 5000.0\n\
                accel_limit = 25000.0\ndriver = \"a4988\"\n";
    let text = format!("[machine]\n[machine.outputs]\n{keys}\n{axis}");
    let source = SourceText { path: "machine.toml".into(), text: text.into() };
    Machine::from_source(&source)
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
fn keys_give_programs_their_outputs() {
    assert_eq!(machine("count = 8").unwrap().output_uses, OutputUses::default());
    let keys = "count = 4\npwm_divider = 1\nspindle = 0\nspindle_reverse = 3\nmist = 1\n\
                flood = 2\nspindle_rpm = 24_000";
    let all = OutputUses {
        spindle: Some(0),
        spindle_reverse: Some(3),
        mist: Some(1),
        flood: Some(2),
        spindle_rpm: Some(24_000),
        laser: false,
    };
    assert_eq!(machine(keys).unwrap().output_uses, all);
    let laser = "pwm_divider = 1\nspindle_rpm = 1000\nlaser = true";
    let uses = OutputUses { spindle_rpm: Some(1000), laser: true, ..OutputUses::default() };
    assert_eq!(machine(laser).unwrap().output_uses, uses);
}

#[test]
fn mistakes_are_refused_by_name() {
    for (keys, said) in [
        ("count = 9", "count = 9: an engine has at most 8"),
        ("pwm_divider = 0", "pwm_divider = 0: it is from 1 to 256"),
        ("pwm_divider = 257", "pwm_divider = 257: it is from 1 to 256"),
        ("count = 2\nspindle = 2", "spindle = 2: `count` gives 2 outputs"),
        ("mist = 0", "mist = 0: `count` gives 0 outputs"),
        ("count = 2\nflood = 200", "flood = 200: `count` gives 2 outputs"),
        ("count = 2\nmist = 1\nflood = 1", "flood = 1: another key has this output"),
        ("count = 2\nspindle_rpm = 9", "spindle_rpm = 9: the machine has no PWM"),
        ("pwm_divider = 1\nspindle_rpm = 0", "spindle_rpm = 0: it is from 1 to 1000000"),
        ("pwm_divider = 1\nlaser = true", "laser = true: spindle_rpm is missing"),
        (
            "pwm_divider = 1\nspindle_rpm = 9\nlaser = true\nat_ramps = \"stay\"",
            "laser = true: at_ramps is \"stay\"",
        ),
        (
            "count = 1\npwm_divider = 1\nspindle_rpm = 9\nspindle_reverse = 0\nlaser = true",
            "laser = true: a laser does not turn",
        ),
    ] {
        let error = outputs(keys).unwrap_err().to_string();
        assert!(error.contains(said), "{error}");
    }
    assert!(outputs("colour = 1").is_err());
}
