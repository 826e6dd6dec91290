//! `--json` prints one document per run, also on failure, and it fits the schema in
//! `docs/schemas/`.

use crate::command::{Folder, GOOD, Ran};
use crate::schemas::check;
use serde_json::{Value, json};
use std::process::Command;

#[test]
fn schema_rejects_a_wrong_document() {
    let folder = Folder::with_move(GOOD);
    let mut document = check(&folder.run("plan move.toml --json").stdout);
    for (field, wrong) in [("passed", json!("yes")), ("tick_ns", json!(-1)), ("moves", json!({}))] {
        let mut other = document.clone();
        other[field] = wrong;
        assert!(std::panic::catch_unwind(|| check(&other.to_string())).is_err(), "{field}");
    }
    document["schema"]["version"] = json!(0);
    assert!(std::panic::catch_unwind(|| check(&document.to_string())).is_err());
}

/// Every report whose document no other test checks.
#[test]
fn every_report_fits_its_schema() {
    let folder = Folder::with_move(GOOD);
    for (arguments, name) in [
        ("boards", "boards"),
        ("boards icebreaker", "boards"),
        ("verilog --out engine", "verilog"),
        ("verilog --core parallel --out parallel", "verilog"),
        ("verilog --board papilio-pro --out board", "verilog-board"),
        ("table sine --ramp-steps 100 --clock-hz 16000000 --prescaler 8 --top-speed 4000", "table"),
        (
            "table sine --ramp-steps 100 --clock-hz 16000000 --prescaler 8 --top-speed 4000 --out table",
            "table",
        ),
        ("profile ranade trapezoid --steps 1000 --accel 1e5 --timer-hz 1e6", "profile"),
        ("profile logistic --steps 1000 --accel 1e5", "profile"),
        ("simulate move.toml", "simulate"),
        ("simulate move.toml --core parallel", "simulate"),
        ("plan move.toml", "plan"),
    ] {
        let ran = folder.run(&format!("{arguments} --json"));
        assert_eq!(ran.status, 0, "{arguments}: {}", ran.stderr);
        assert_eq!(
            check(&ran.stdout)["schema"],
            json!({"name": format!("carrystep.{name}"), "version": 1})
        );
    }
}

/// The error in the document of a failed run.
#[track_caller]
fn error(ran: &Ran, status: i32) -> Value {
    assert_eq!(ran.status, status, "{}", ran.stderr);
    let document = check(&ran.stdout);
    assert_eq!(
        (&document["schema"]["name"], &document["passed"]),
        (&json!("carrystep.failure"), &json!(false))
    );
    let error = document["error"].clone();
    assert!(error["message"].as_str().is_some_and(|message| !message.is_empty()), "{error}");
    error
}

#[test]
fn bad_input_is_reported_as_a_document_with_its_place() {
    let folder = Folder::with_move(GOOD.replace("a4988", "a4989"));
    let found = error(&folder.run("plan move.toml --json"), 2);
    assert_eq!((&found["kind"], &found["file"]), (&json!("input"), &json!("move.toml")));
    assert_eq!((&found["line"], &found["column"]), (&json!(13), &json!(10)));
    assert_eq!(found["message"], "no driver is called 'a4989' (did you mean 'a4988'?)");
    assert!(found["help"].as_str().unwrap().starts_with("known: a4988"), "{found}");

    folder.write("move.toml", GOOD.replace("time = 0.05", "time = 0.0005"));
    let found = error(&folder.run("simulate move.toml --json --vcd a.vcd"), 2);
    assert_eq!((&found["kind"], &found["line"]), (&json!("input"), &json!(19)));
    let found = error(&folder.run("sweep nowhere.toml --json"), 2);
    assert_eq!(
        (&found["kind"], &found["file"], &found["line"]),
        (&json!("input"), &Value::Null, &Value::Null)
    );
    error(&folder.run("boards iceraker --json"), 2);
    error(&folder.run("status --port nowhere --json"), 2);
    error(&folder.run("jog x 1 --machine nowhere.toml --port nowhere --json"), 2);
    error(&folder.run("doctor nowhere --json"), 2);
}

#[test]
fn refused_arguments_are_reported_as_a_document() {
    let folder = Folder::new();
    for (arguments, says) in [
        ("plan --json", "required arguments were not provided"),
        ("--json", "'--json'"),
        ("simulat --json", "unrecognized subcommand 'simulat'"),
        ("simulate m.toml --level slow --json", "invalid value 'slow'"),
        ("sweep --json --shard 0/3 s.toml", "'0/3' is not N/OF"),
    ] {
        let found = error(&folder.run(arguments), 2);
        assert_eq!(found["kind"], "usage");
        assert!(found["message"].as_str().unwrap().contains(says), "{found}");
    }
    let ran = folder.output(Command::new(env!("CARGO_BIN_EXE_carrystep")).args(["plan", "--help"]));
    assert!(ran.status == 0 && ran.stdout.contains("Usage:"), "{}", ran.stdout);
    // After `--`, `--json` is the name of a file.
    let ran = Command::new(env!("CARGO_BIN_EXE_carrystep"))
        .args(["plan", "--", "--json"])
        .output()
        .unwrap();
    assert_eq!((ran.status.code(), ran.stdout.len()), (Some(2), 0));
}

#[test]
fn missing_tool_is_reported_as_a_document() {
    let folder = Folder::with_move(GOOD);
    let without_tools = |arguments: &str| {
        let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
        folder.output(command.args(arguments.split(' ')).env("PATH", folder.path("no-tools")))
    };
    for arguments in [
        "simulate move.toml --level icarus --json",
        "build --board icestick --out out --json",
        "selftest --board icestick --out out --json",
    ] {
        let found = error(&without_tools(arguments), 3);
        assert_eq!(found["kind"], "tool");
        assert!(found["message"].as_str().unwrap().contains("is not installed"), "{found}");
    }
    // The doctor has printed its report already, so there is no second document.
    let ran = without_tools("doctor --json");
    assert_eq!(
        (ran.status, &check(&ran.stdout)["schema"]["name"]),
        (3, &json!("carrystep.doctor"))
    );
}
