//! The equations of crossed belts, as they are published: motors from letters, and letters from
//! motors.

use carrystep_files::{Machine, SourceText};

fn machine(order: [&str; 3]) -> Machine {
    let axis = |name: &str| {
        format!(
            "[[machine.axis]]\nname = \"{name}\"\nsteps_per_unit = 80\nspeed_limit = 100\n\
             accel_limit = 1000\ndriver = \"a4988\"\n"
        )
    };
    let text = format!(
        "[machine]\nkinematics = \"corexy\"\n[machine.guard]\nlimits = \"none\"\n{}",
        order.map(axis).concat()
    );
    Machine::from_source(&SourceText { path: "m.toml".into(), text: text.into() }).unwrap()
}

/// The other side are the equations as they are published, for any order of the axes.
#[test]
fn motors_are_sum_and_difference_in_any_order_of_axes() {
    for order in [["x", "y", "z"], ["z", "x", "y"], ["y", "z", "x"], ["y", "x", "z"]] {
        let machine = machine(order);
        let at = |name: &str| order.iter().position(|one| *one == name).unwrap();
        for [x, y, z] in [[3.0, 8.0, -5.0], [-70_001.0, 12.0, 0.0], [1e6, -999_999.0, 7.0]] {
            let mut letters = [0.0; 3];
            (letters[at("x")], letters[at("y")], letters[at("z")]) = (x, y, z);
            let motors = machine.motor_steps(&letters);
            let found = ["x", "y", "z"].map(|name| motors[at(name)]);
            assert_eq!(found, [x + y, x - y, z], "{order:?}");
            let back = [0, 1, 2].map(|axis| machine.letter_steps(axis, &motors));
            assert_eq!(back, letters, "{order:?}");
        }
        let masks = ["x", "y"].map(|name| machine.motors_of(at(name)));
        assert_eq!(masks, [1 << at("x") | 1 << at("y"); 2]);
        assert_eq!(machine.motors_of(at("z")), 1 << at("z"));
    }
}

#[test]
fn one_motor_moves_the_tool_along_a_diagonal() {
    let machine = machine(["x", "y", "z"]);
    let moved = [0, 1].map(|axis| machine.letter_steps(axis, &[3.0, 0.0, 0.0]));
    assert_eq!(moved, [1.5, 1.5]);
    let moved = [0, 1].map(|axis| machine.letter_steps(axis, &[0.0, 3.0, 0.0]));
    assert_eq!(moved, [1.5, -1.5]);
    assert!((1.5_f64.hypot(1.5) - 3.0 * machine.step_of_tool(0)).abs() < 1e-12);
    assert_eq!(machine.step_of_tool(2), 1.0);
}
