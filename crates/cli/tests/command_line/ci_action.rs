//! The action for other repositories, executed step by step as a runner does, in a folder outside
//! this checkout.

use crate::command::{Folder, GOOD, Ran};
use std::collections::BTreeMap;
use std::process::Command;

const ACTION: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../.github/actions/check");

/// A step: its command, and its environment.
type Step = (String, Vec<(String, String)>);

/// The defaults of the inputs, and the steps. The file is YAML in a simple form with one key and
/// value per line.
fn action() -> (BTreeMap<String, String>, Vec<Step>) {
    let text = std::fs::read_to_string(format!("{ACTION}/action.yml")).unwrap();
    let (head, steps) = text.split_once("  steps:\n").unwrap();
    let (mut defaults, mut input) = (BTreeMap::new(), String::new());
    for line in head.lines() {
        if let Some(name) = line.strip_prefix("  ").filter(|line| !line.starts_with(' ')) {
            input = name.trim_end_matches(':').to_owned();
        }
        if let Some(value) = line.strip_prefix("    default: ") {
            defaults.insert(input.clone(), value.trim_matches('"').to_owned());
        }
    }
    let step = |step: &str| {
        let run = step
            .lines()
            .find_map(|line| line.trim().strip_prefix("run: "))
            .expect("a step runs something");
        let variable = |line: &str| {
            let (name, value) = line.strip_prefix("        ")?.split_once(": ")?;
            Some((name.to_owned(), value.to_owned()))
        };
        (run.trim_matches('\'').to_owned(), step.lines().filter_map(variable).collect())
    };
    (defaults, steps.split("    - name: ").skip(1).map(step).collect())
}

/// Runs the action's steps with these inputs; the first failing step ends the action.
fn run(folder: &Folder, given: &[(&str, &str)]) -> Ran {
    let (mut inputs, steps) = action();
    for (name, value) in
        given.iter().copied().chain([("carrystep", env!("CARGO_BIN_EXE_carrystep"))])
    {
        assert!(inputs.insert(name.to_owned(), value.to_owned()).is_some(), "{name}");
    }
    let runner = tempfile::tempdir().unwrap();
    let file = runner.path().join("env");
    std::fs::write(&file, "").unwrap();
    let mut last = Ran { status: 0, stdout: String::new(), stderr: String::new() };
    assert_eq!(steps.len(), 2);
    for (run, variables) in steps {
        let mut command = Command::new("bash");
        command.args(["--noprofile", "--norc", "-eo", "pipefail", "-c", &run]);
        command
            .env("GITHUB_ACTION_PATH", ACTION)
            .env("GITHUB_ENV", &file)
            .env("RUNNER_TEMP", runner.path());
        for (name, value) in variables {
            let input = value.trim_start_matches("${{ inputs.").trim_end_matches(" }}");
            command.env(name, &inputs[input]);
        }
        for line in std::fs::read_to_string(&file).unwrap().lines() {
            let (name, value) = line.split_once('=').unwrap();
            command.env(name, value);
        }
        last = folder.output(&mut command);
        if last.status != 0 {
            break;
        }
    }
    last
}

/// A repository with a machine, moves and the Verilog that was generated from them.
fn repository() -> Folder {
    let folder = Folder::new();
    let (machine, moves) = GOOD.split_at(GOOD.find("[[move]]").unwrap());
    folder.write("machines/mill one.toml", machine);
    folder.write(
        "moves/there/and back.toml",
        format!("machine_file = \"../../machines/mill one.toml\"\n{moves}"),
    );
    folder.write("machine.toml", machine);
    let made = folder.run("verilog --core engine --machine machine.toml --out hdl");
    assert_eq!(made.status, 0, "{}", made.stderr);
    folder
}

const INPUTS: [(&str, &str); 3] = [
    ("machines", "machine.toml\nmachines/*.toml\n"),
    ("moves", "moves/**/*.toml"),
    ("verilog", "hdl machine.toml --core engine\n"),
];

#[test]
fn correct_repository_passes() {
    let folder = repository();
    let before = folder.files();
    let ran = run(&folder, &INPUTS);
    assert_eq!(ran.status, 0, "{}{}", ran.stdout, ran.stderr);
    assert!(ran.stdout.ends_with("4 checked, 0 failed\n"), "{}", ran.stdout);
    assert!(ran.stdout.contains("passed: moves/there/and back.toml\n"), "{}", ran.stdout);
    assert_eq!(folder.files(), before);
}

#[test]
fn every_wrong_file_fails_and_is_named() {
    let good = repository();
    let text = |name: &str| std::fs::read_to_string(good.path(name)).unwrap();
    let moves = text("moves/there/and back.toml");
    let verilog = text("hdl/carrystep_engine.v");
    for (file, wrong, name, says) in [
        (
            "moves/there/and back.toml",
            moves.replace("time = 0.05", "time = 0.0005"),
            "moves/there/and back.toml",
            "move",
        ),
        ("machines/mill one.toml", "[machine]\n".to_owned(), "machines/mill one.toml", "axis"),
        ("hdl/carrystep_engine.v", verilog.replacen("<=", "=", 1), "hdl", "<="),
        (
            "machine.toml",
            GOOD.split("[[move]]").next().unwrap().replace("a4988", "tmc2209"),
            "hdl",
            "@@",
        ),
    ] {
        let folder = repository();
        folder.write(file, wrong);
        let ran = run(&folder, &INPUTS);
        assert_eq!(ran.status, 1, "{file}: {}{}", ran.stdout, ran.stderr);
        assert!(
            ran.stdout.contains(&format!("::error::failed: {name}\n")),
            "{file}: {}",
            ran.stdout
        );
        assert!(ran.stdout.contains(says), "{file}: {}", ran.stdout);
    }
    std::fs::remove_file(good.path("hdl/carrystep_engine.v")).unwrap();
    assert_eq!(run(&good, &INPUTS).status, 1);
}

#[test]
fn action_with_nothing_to_check_fails() {
    let folder = repository();
    let ran = run(&folder, &[]);
    assert_eq!(ran.status, 1);
    assert!(ran.stdout.contains("nothing to check"), "{}", ran.stdout);
    let ran = run(&folder, &[("moves", "moves/*.toml\nmoves/**/*.toml")]);
    assert_eq!(ran.status, 1);
    assert!(ran.stdout.contains("no file matches moves/*.toml"), "{}", ran.stdout);
    let ran = run(&folder, &[("machines", "nowhere.toml")]);
    assert_eq!(ran.status, 1);
}
