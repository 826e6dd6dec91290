//! Impossible curves and tables: exit status 2, and a message with the limit that forbids the
//! request and a value that works. Nothing is written.

use crate::curves::carrystep;

/// Arguments, and the expected message.
const REFUSED: &[(&str, &str)] = &[
    ("profile sine", "sine needs a speed to go to"),
    ("profile sine --speed 100", "sine needs an acceleration or a time"),
    ("profile sine --steps 100", "sine needs an acceleration limit"),
    (
        "profile scurve --speed 1000 --accel 5000",
        "scurve needs a jerk limit; the sine has one of 39269.9082 steps/s^3 at the same speed and acceleration",
    ),
    (
        "profile scurve --speed-mm-s 100 --accel-mm-s2 500 --travel-per-rev 5",
        "scurve needs a jerk limit; the sine has one of 3926.99082 mm/s^3 at the same speed and acceleration",
    ),
    (
        "profile scurve --speed 1000 --accel 50000 --jerk 1e5 --time 0.1",
        "scurve cannot be done with a jerk limit of 100000 steps/s^3: it needs at least 400000 steps/s^3, or a time of 0.2 s",
    ),
    (
        "profile scurve --steps 1000 --accel 5e4 --jerk 1e5 --time 0.5",
        "scurve cannot be done with a jerk limit of 100000 steps/s^3: it needs at least 256000 steps/s^3, or a time of 0.683990379 s",
    ),
    (
        "profile trapezoid --deg 360 --time 1 --accel-deg-s2 1400",
        "trapezoid cannot be done with an acceleration limit of 1400 degrees/s^2: it needs at least 1440 degrees/s^2, or a time of 1.01418511 s",
    ),
    (
        "profile trapezoid --steps 1000 --time 1 --accel 1e5 --speed 1000",
        "trapezoid cannot be done with a speed limit of 1000 steps/s: it needs at least 1010.20515 steps/s, or a time of 1.01 s",
    ),
    (
        "profile constant --speed 10",
        "constant has no ramp: it is for whole moves; give it a distance",
    ),
    (
        "profile constant --steps 100 --start-speed 50 --time 1",
        "constant cannot be done with a start speed of 50 steps/s: it needs at least 100 steps/s, or a time of 2 s",
    ),
    (
        "profile constant --steps 100",
        "constant cannot be done with a start speed of 0 steps/s: no time would do without a greater start speed",
    ),
    (
        "profile logistic --speed 1000 --accel 1000 --ti -2",
        "logistic cannot be done: with its centre at -2 s the logistic ramp has no time: it is past its end when it starts; a centre over -1.323",
    ),
    (
        "profile logistic --speed 1000 --accel 1000 --ti 1 --time 2",
        "the centre T_i fixes a ramp together with its acceleration: a time besides contradicts it; leave one out",
    ),
    (
        "profile logistic --steps 1000 --accel 1000 --ti 1",
        "the centre T_i is of a logistic ramp: a move has two, symmetric in themselves; leave it out",
    ),
    (
        "profile sine --speed 1000 --accel 1000 --ti 1",
        "the centre T_i is of a logistic ramp: none is asked for; leave it out",
    ),
    (
        "profile ranade --speed 100 --start-speed 100 --accel 10",
        "the top speed of 100 steps/s is not over the start speed of 100: a top speed over 100 or a start speed under 100 steps/s would do",
    ),
    (
        "profile sine --speed-mm-s 20 --accel 100",
        "millimetres need the travel per revolution of the motor; degrees, rpm and steps do without",
    ),
    (
        "profile sine --speed -5 --accel 1",
        "the speed is -5: it must be over 0: 1e-9 to 1e15 in steps",
    ),
    (
        "profile sine --speed 5 --accel nan",
        "the acceleration is NaN: it must be over 0: 1e-9 to 1e15 in steps",
    ),
    ("profile sine --speed 5 --time 0", "the time is 0: it must be over 0: 1e-9 to 1e15 s"),
    (
        "profile sine --rpm 5 --accel 1 --step-angle 0",
        "the step angle is 0: it must be over 0 and at most 180 degrees",
    ),
    ("profile sine --rpm 5 --accel 1 --microsteps 0", "the microsteps is 0: it must be 1 to 65536"),
    (
        "profile sine --steps 0 --accel 1",
        "the distance is 0: it must be one step or more, and at most 2^53",
    ),
    (
        "profile sine --steps 10.5 --accel 1",
        "10.5 steps is no whole number of steps: 10 or 11 steps would do",
    ),
    (
        "profile sine --deg 361 --accel 1",
        "361 degrees is no whole number of steps: 360 or 361.8 degrees would do",
    ),
    ("profile sine sine --speed 5 --accel 1", "sine is named twice"),
    (
        "profile sine --speed 5 --accel 1 --csv a --plot a",
        "cannot write a: it is also the output a",
    ),
    (
        "profile sine --speed 5 --accel 1 --csv - --json",
        "--csv - and --json would both go to standard output: give --csv a file",
    ),
    (
        "profile sine --steps 1e9 --accel 1 --csv -",
        "sine has 1000000000 steps: a list holds at most 1000000; its figures and its plot can be had",
    ),
    (
        "profile sine --speed 5 --accel 1 --timer-hz 0 --csv -",
        "the timer's clock is 0: it must be over 0 and at most 1e12 Hz",
    ),
    (
        "table logistic --entries 1000 --clock-hz 16000000 --start-frequency 100 --rpm 500",
        "the slowest entry waits 154033 counts, the 16-bit timer at most 65536: prescaler 8 would do",
    ),
    (
        "table avr446 --ramp-steps 100 --clock-hz 16000000 --prescaler 1024 --top-speed 50000",
        "the top speed waits 0.31 counts, at least 1 are needed: ",
    ),
    (
        "table avr446 --ramp-steps 0 --clock-hz 16000000 --top-speed 5000",
        "ramp_steps is 0: 1 to 1000000 is needed; the nearest is 1",
    ),
    (
        "table sine --ramp-steps 100 --clock-hz 16000000 --start-frequency 500 --top-speed 400",
        "a top speed of 400 steps/s is not over the start frequency of 500 steps/s: ",
    ),
    (
        "table sine --ramp-steps 100 --clock-hz 16000000 --prescaler 32 --top-speed 400",
        "the timer has no prescaler 32: it has 1, 8, 64, 256, 1024",
    ),
    (
        "table sine --ramp-steps 100 --clock-hz 16000000 --top-speed 4000 --name 2fast",
        "\"2fast\" is no name for a table: a letter, then up to 47 letters, digits or underscores",
    ),
    (
        "table logistic --entries 1000 --clock-hz 16000000 --prescaler 64 --start-frequency 500 --rpm 500 --pulses-by-group 1,2,3",
        "1000 entries do not divide into groups of 3: 999 or 1002 would do",
    ),
];

#[test]
fn impossible_curves_and_tables_are_refused_with_the_reason() {
    for (arguments, said) in REFUSED {
        let output = carrystep(arguments);
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{arguments}: {told}");
        assert!(told.starts_with(&format!("error: {said}")), "{arguments}: {told}");
        assert!(output.stdout.is_empty() || arguments.ends_with("--json"), "{arguments}");
    }
}

/// Arguments that clap itself refuses also give status 2.
#[test]
fn invalid_arguments_are_refused_with_status_2() {
    let wrong = [
        "profile",
        "profile foo --speed 1 --accel 1",
        "profile sine --speed 10 --rpm 10 --accel 1",
        "profile sine --speed ten --accel 1",
        "table",
        "table sine --ramp-steps 100 --clock-hz 16000000",
        "table sine --ramp-steps 100 --clock-hz 16000000 --rpm 5 --top-speed 5",
        "table sine --ramp-steps 100 --clock-hz 16000000 --rpm 5 --bits 32",
        "table avr446 --entries 100 --clock-hz 16000000 --rpm 5",
    ];
    for arguments in wrong {
        let output = carrystep(arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments}");
        assert!(!output.stderr.is_empty() && output.stdout.is_empty(), "{arguments}");
    }
}

#[test]
fn files_appear_only_when_they_are_complete() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    // The second file cannot be created, so the first one does not appear either.
    std::fs::create_dir(folder.path().join("taken")).unwrap();
    let (csv, plot) = (path("a.csv"), path("taken"));
    let output =
        carrystep(&format!("profile sine --speed 500 --accel 1000 --csv {csv} --plot {plot}"));
    assert_eq!(output.status.code(), Some(2));
    let long = carrystep(&format!("profile sine --steps 1e9 --accel 1000 --csv {csv}"));
    assert_eq!(long.status.code(), Some(2));
    // The header of the table has the name of an existing folder.
    std::fs::create_dir_all(folder.path().join("out/ramp.h")).unwrap();
    let table = "table sine --ramp-steps 100 --clock-hz 1000000 --top-speed 4000 --out";
    assert_eq!(carrystep(&format!("{table} {}", path("out"))).status.code(), Some(2));
    let left = |name: &str| std::fs::read_dir(folder.path().join(name)).unwrap().count();
    assert_eq!((left("."), left("out"), left("taken")), (2, 1, 0));
}
