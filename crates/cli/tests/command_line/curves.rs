//! Helpers for the commands that need no move file, and golden numbers to compare with.

use serde_json::Value;
use std::path::Path;
use std::process::{Command, Output};

/// Runs the command.
pub fn carrystep(arguments: &str) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
    command.env("COLUMNS", "200").args(arguments.split_whitespace()).output().unwrap()
}

/// The output of a successful run.
#[track_caller]
pub fn stdout(arguments: &str) -> String {
    let output = carrystep(arguments);
    let told = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), told.as_ref()), (Some(0), ""), "carrystep {arguments}");
    String::from_utf8(output.stdout).unwrap()
}

#[track_caller]
pub fn json(arguments: &str) -> Value {
    serde_json::from_str(&stdout(&format!("{arguments} --json"))).unwrap()
}

/// The names of the fields of an object.
pub fn names(value: &Value) -> Vec<&str> {
    value.as_object().unwrap().keys().map(String::as_str).collect()
}

/// The golden numbers of a source.
pub fn golden(name: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/golden").join(name);
    serde_json::from_str(&std::fs::read_to_string(path).unwrap()).unwrap()
}

/// Compares two numbers to twelve digits.
#[track_caller]
pub fn close(found: &Value, golden: &Value) {
    let number =
        |value: &Value| value.as_f64().unwrap_or_else(|| value.as_str().unwrap().parse().unwrap());
    let (found, golden) = (number(found), number(golden));
    assert!((found / golden - 1.0).abs() < 1e-12, "{found}, golden {golden}");
}

#[test]
fn the_examples_of_the_help_work() {
    let folder = tempfile::tempdir().unwrap();
    let mut run = 0;
    for help in ["profile", "table logistic", "table avr446", "table sine"] {
        let text = stdout(&format!("{help} --help"));
        for line in text.lines().filter_map(|line| line.trim().strip_prefix("carrystep ")) {
            let mut example = Command::new(env!("CARGO_BIN_EXE_carrystep"));
            let output =
                example.args(line.split_whitespace()).current_dir(folder.path()).output().unwrap();
            assert!(output.status.success(), "{line}: {}", String::from_utf8_lossy(&output.stderr));
            run += 1;
        }
    }
    assert_eq!(run, 6);
}
