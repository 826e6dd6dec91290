//! `kinematics` in machine files: what makes the motors of crossed belts equal, what is refused, and
//! what moves of letters become.

use carrystep_files::machine::Kinematics;
use carrystep_files::{BigDecimal, InputError, Machine, MoveFile, SourceText};

fn source(text: &str) -> SourceText {
    SourceText { path: "m.toml".into(), text: text.into() }
}

fn read(text: &str) -> Result<Machine, InputError> {
    Machine::from_source(&source(text))
}

const HEAD: &str = "[machine]\nkinematics = \"corexy\"\n[machine.guard]\nlimits = \"one\"\n";

const X: &str = "[[machine.axis]]
name = \"x\"
steps_per_unit = 80
speed_limit = 100
accel_limit = 1000
stop_accel = 2000
driver = \"tmc2209\"
travel = [0, 300]
home = { toward = \"min\", seek_speed = 20, slow_speed = 1, move_off = 5, pull_off = 2, position = 0 }
";

const Y: &str = "[[machine.axis]]
name = \"y\"
steps_per_unit = 80
speed_limit = 90
accel_limit = 1200
jerk_limit = 50_000
stop_accel = 1500
driver = \"a4988\"
travel = [0, 200]
home = { toward = \"max\", seek_speed = 30, slow_speed = 2, move_off = 5, pull_off = 2, position = 200 }
";

const Z: &str = "[[machine.axis]]
name = \"z\"
steps_per_unit = 400
speed_limit = 10
accel_limit = 100
driver = \"a4988\"
";

#[test]
fn motors_of_crossed_belts_have_the_least_limits_and_the_longest_times() {
    let machine = read(&[HEAD, X, Y, Z].concat()).unwrap();
    assert_eq!(machine.kinematics, Kinematics::CoreXy);
    let [x, y, z] = &machine.axes[..] else { panic!("three axes") };
    for axis in [x, y] {
        assert_eq!(axis.speed_limit.steps, BigDecimal::from(90 * 80));
        assert_eq!(axis.accel_limit.steps, BigDecimal::from(1000 * 80));
        assert_eq!(axis.jerk_limit.as_ref().unwrap().steps, BigDecimal::from(50_000 * 80));
        assert_eq!((axis.stop, axis.pins), (y.stop, y.pins));
    }
    // What is of the letters stays.
    assert_eq!([x, y].map(|axis| axis.travel), [Some([0, 24_000]), Some([0, 16_000])]);
    assert_ne!(x.home.unwrap().seek, y.home.unwrap().seek);
    assert_eq!(z.speed_limit.steps, BigDecimal::from(10 * 400));
    assert_eq!(machine.home_order, [[0, 1]]);
}

#[test]
fn machine_file_without_the_key_is_cartesian() {
    let plain = [HEAD, X, Y, Z].concat().replace("kinematics = \"corexy\"\n", "");
    let named = plain.replace("[machine]\n", "[machine]\nkinematics = \"cartesian\"\n");
    for text in [plain, named] {
        let machine = read(&text).unwrap();
        assert_eq!(machine.kinematics, Kinematics::Cartesian);
        assert_eq!(machine.motors_of(0), 1);
        assert_ne!(machine.axes[0].speed_limit, machine.axes[1].speed_limit);
    }
}

#[test]
fn other_letters_may_have_several_motors() {
    let z2 = Z.replace("name = \"z\"", "name = \"z2\"\nletter = \"z\"");
    let machine = read(&[HEAD, Z, X, &z2, Y].concat()).unwrap();
    assert_eq!((machine.motors_of(0), machine.motors_of(1)), (0b0101, 0b1010));
}

#[test]
fn machines_that_cannot_have_crossed_belts_are_refused() {
    let change = |from: &str, to: &str| [HEAD, X, Y, Z].concat().replacen(from, to, 1);
    let x2 = X.replace("name = \"x\"", "name = \"x2\"\nletter = \"x\"");
    for (text, message, help) in [
        ([HEAD, X, Z].concat(), "the machine has no axis y", "axes x and y"),
        ([HEAD, Z].concat(), "the machine has no axis x", "axes x and y"),
        ([HEAD, X, &x2, Y].concat(), "the motor 'x2' is a second one of x", "one axis each"),
        (
            [HEAD, X, &Y.replace("steps_per_unit = 80", "steps_per_unit = 100")].concat(),
            "the motors of x and y have 80 and 100 steps per unit",
            "same steps_per_unit",
        ),
        (
            [HEAD, &X.replacen("steps", "unit = \"mm\"\nsteps", 1), Y].concat(),
            "the motors of x and y are in mm and",
            "same unit",
        ),
        (change("\"one\"", "\"each\""), "with limits = \"each\"", "limits = \"one\""),
        (
            change("[machine.guard]\nlimits = \"one\"\n", ""),
            "with limits = \"pair\"",
            "at 45 degrees",
        ),
        (
            [HEAD, X, &Y[..Y.find("home").unwrap()]].concat(),
            "x has a home table, and y has none",
            "give both",
        ),
        (change("\"corexy\"", "\"delta\""), "delta", ""),
    ] {
        let error = read(&text).unwrap_err();
        assert!(error.message.contains(message), "{message}: {}", error.message);
        let given = error.help.clone().unwrap_or_default();
        assert!(given.contains(help), "{message}: {given}");
        assert!(error.place.is_some(), "{message}");
    }
}

#[test]
fn moves_name_letters_and_move_both_motors() {
    let moves = "[[move]]\nprofile = \"trapezoid\"\nto = { x = 2.5 }\n\
                 [[move]]\nprofile = \"trapezoid\"\nto = { y = 1, z = 0.5 }\n\
                 [[move]]\nprofile = \"trapezoid\"\nto = { x = -2.5, y = 1.50625 }\n";
    let machine = read(&[HEAD, X, Y, Z].concat()).unwrap();
    let file = MoveFile::of_moves(machine, source(moves)).unwrap();
    let steps: Vec<&[i64]> = file.moves.iter().map(|one| &one.steps[..]).collect();
    // The sum of all is x = 0, y = 2.50625: 200.5 steps, rounded away from zero.
    assert_eq!(steps, [&[200, 200, 0][..], &[80, -80, 200], &[-79, -321, 0]]);
    let rounding: Vec<f64> = file.moves[2].rounding.clone();
    assert_eq!(rounding, [-0.5, 0.5, 0.0]);
}

#[test]
fn move_beyond_a_motors_register_is_refused_with_its_place() {
    let moves = "[[move]]\nprofile = \"trapezoid\"\nto = { x = 20_000_000, y = 20_000_000 }\n";
    let machine = read(&[HEAD, X, Y, Z].concat()).unwrap();
    let error = MoveFile::of_moves(machine, source(moves)).unwrap_err();
    assert!(error.message.contains("axis 'x' would stand at"), "{}", error.message);
}
