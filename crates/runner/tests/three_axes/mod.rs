//! A machine with three axes, for programs on a board of models.

use carrystep_files::{Machine, SourceText};

const AXES: &str = "
[[machine.axis]]
name = \"x\"
steps_per_unit = 80
speed_limit = 100
accel_limit = 1000
driver = \"tmc2209\"
[[machine.axis]]
name = \"y\"
steps_per_unit = 80
speed_limit = 100
accel_limit = 1000
driver = \"tmc2209\"
[[machine.axis]]
name = \"z\"
steps_per_unit = 400
speed_limit = 50
accel_limit = 500
driver = \"tmc2209\"
";

/// The machine with these tables in front of its axes, and its file.
pub fn machine(tables: &str) -> (Machine, SourceText) {
    let text = SourceText { path: "machine.toml".into(), text: (tables.to_owned() + AXES).into() };
    (Machine::from_source(&text).unwrap(), text)
}
