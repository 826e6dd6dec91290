//! `carrystep table` reproduces the tables of the sources.

use crate::curves::{golden, json, names, stdout};
use serde_json::{Value, json};
use std::path::Path;
use std::process::Command;

const SOURCE: &str = "table logistic --entries 1000 --clock-hz 16000000 --prescaler 64 --start-frequency 500 \
                      --rpm 500 --microsteps 8";

#[test]
fn logistic_table_equals_the_look_up_method_of_the_source() {
    let golden = &golden("timer_table.json")["table_Fle_6"];
    let table = json(&format!("{SOURCE} --mode free-running"));
    let compare: Vec<u64> =
        table["compare"].as_array().unwrap().iter().map(|v| v.as_u64().unwrap()).collect();
    assert_eq!(json!(compare[..10]), golden["OCR_0..9"]);
    for i in [100, 250, 500, 750, 999] {
        assert_eq!(golden[format!("OCR_{i}")], compare[i]);
    }
    assert_eq!(golden["sum_OCR_0..999"], compare.iter().sum::<u64>());
    // In CTC mode a period is one count longer than the compare value.
    let ctc = json(SOURCE);
    let one_less: Vec<u64> = compare.iter().map(|value| value - 1).collect();
    assert_eq!(ctc["compare"], json!(one_less));
    assert_eq!(json(&format!("{SOURCE} --fle 6 --centre 500"))["compare"], ctc["compare"]);
}

/// The integers of the application note: 1 MHz, 200 steps per turn, 1000 steps/s^2.
#[test]
fn avr446_table_equals_the_integers_of_the_application_note() {
    let source = &golden("trapezoid_austin.json")["avr446_integer"];
    let asked = "table avr446 --arithmetic integer --ramp-steps 500 --clock-hz 1000000 --top-speed 1000 --mode free-running";
    let table = json(asked);
    let first: Vec<Value> = table["compare"].as_array().unwrap().iter().take(12).cloned().collect();
    assert_eq!(json!(first), source["first_12"]);
    assert_eq!(table["compare"][100], source["c_100"]);
}

#[test]
fn json_has_stable_names() {
    let table = json(&format!("{SOURCE} --pulses-by-group 1,2,3,4"));
    let expected =
        ["compare", "cruise", "figures", "files", "groups", "passed", "request", "schema"];
    assert_eq!(names(&table), expected);
    assert_eq!(table["groups"][3], json!({"end": 1000, "pulses": 4}));
    assert_eq!(table["request"]["kind"], "logistic");
    let sine = "table sine --ramp-steps 200 --clock-hz 1000000 --top-speed 5000 --inverse 256";
    assert_eq!(json(sine)["inverse"].as_array().unwrap().len(), 257);
}

/// Compiles header and player together in strict C99.
fn compiles(folder: &Path, name: &str, flags: &[&str]) {
    let main = format!(
        "#include \"{name}.h\"\nint main(void) {{ return (int)({name}_compare[0] == 0); }}\n"
    );
    std::fs::write(folder.join("main.c"), main).unwrap();
    let sources = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let sources = sources.filter(|path| path.extension().is_some_and(|extension| extension == "c"));
    let strict = [
        "-std=c99",
        "-Wall",
        "-Wextra",
        "-Wpedantic",
        "-Werror",
        "-Wno-unused-const-variable",
        "-o",
    ];
    let mut gcc = Command::new("gcc");
    gcc.args(strict).arg(folder.join("main")).args(flags).args(sources).arg("-lm");
    let output = gcc.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
}

fn files(folder: &Path) -> Vec<String> {
    let mut names: Vec<String> = std::fs::read_dir(folder)
        .unwrap()
        .map(|e| e.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn written_table_and_player_compile() {
    let folder = tempfile::tempdir().unwrap();
    let out = |name: &str| folder.path().join(name);
    let write =
        |arguments: &str, name: &str| stdout(&format!("{arguments} --out {}", out(name).display()));

    let told = write(SOURCE, "plain");
    assert_eq!(files(&out("plain")), ["carrystep_player.c", "carrystep_player.h", "ramp.h"]);
    assert!(told.contains("table              1000 entries, 1000 pulses, "), "{told}");
    assert!(told.contains(&format!("wrote {}\n", out("plain").join("ramp.h").display())), "{told}");
    compiles(&out("plain"), "ramp", &[]);
    // Without a folder the same header goes to standard output.
    assert_eq!(stdout(SOURCE), std::fs::read_to_string(out("plain").join("ramp.h")).unwrap());

    let sine =
        "table sine --ramp-steps 200 --clock-hz 1000000 --top-speed 5000 --inverse 64 --name soft";
    write(sine, "sine");
    let all = [
        "carrystep_player.c",
        "carrystep_player.h",
        "carrystep_sine.c",
        "carrystep_sine.h",
        "soft.h",
    ];
    assert_eq!(files(&out("sine")), all);
    compiles(&out("sine"), "soft", &[]);

    write(&format!("{SOURCE} --bare"), "bare");
    assert_eq!(files(&out("bare")), ["ramp.h"]);
    compiles(&out("bare"), "ramp", &["-DF_CPU=16000000"]);

    assert!(stdout(&format!("{SOURCE} --progmem")).contains("ramp_compare[1000] PROGMEM"));
}
