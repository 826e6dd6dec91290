//! `plan --json-lines` prints what `plan --json` prints, a line for each move, and the failure of a
//! later move behind the moves before it.

use crate::command::{Folder, GOOD};
use crate::schemas;
use serde_json::{Value, json};

/// The lines, each checked against the schema that it names.
fn lines(folder: &Folder, status: i32) -> Vec<Value> {
    let ran = folder.run("plan move.toml --json-lines");
    assert_eq!(ran.status, status, "{}", ran.stderr);
    ran.stdout.lines().map(schemas::check).collect()
}

/// A move file of four moves.
fn four_moves() -> String {
    let (machine, moved) = GOOD.split_at(GOOD.find("[[move]]").unwrap());
    format!("{machine}{}", format!("{moved}\n").repeat(2))
}

/// The document without the fields that only lines have.
fn part(line: &Value, number: Option<usize>) -> Value {
    let mut part = line.clone();
    let fields = part.as_object_mut().unwrap();
    fields.remove("schema");
    assert_eq!(fields.remove("number"), number.map(|number| json!(number)));
    part
}

#[test]
fn lines_are_the_moves_and_the_limits_of_the_one_document() {
    let folder = Folder::with_move(four_moves());
    let whole = schemas::check(&folder.run("plan move.toml --json").stdout);
    let lines = lines(&folder, 0);
    let (end, moves) = lines.split_last().unwrap();
    let moves: Vec<Value> =
        moves.iter().enumerate().map(|(index, line)| part(line, Some(index + 1))).collect();
    assert_eq!(json!(moves), whole["moves"]);
    assert_eq!(moves.len(), 4);
    assert_eq!(end["moves"], 4);
    for field in ["passed", "tick_ns", "limits"] {
        assert_eq!(end[field], whole[field], "{field}");
    }
}

#[test]
fn impossible_move_follows_the_moves_before_it_as_a_failure() {
    let text = four_moves();
    let (before, after) = text.rsplit_once("time = 0.05").unwrap();
    let folder = Folder::with_move(format!("{before}time = 0.0005{after}"));
    let lines = lines(&folder, 2);
    let names: Vec<&str> =
        lines.iter().map(|line| line["schema"]["name"].as_str().unwrap()).collect();
    let (failure, moves) = names.split_last().unwrap();
    assert_eq!((*failure, moves), ("carrystep.failure", ["carrystep.plan-move"; 3].as_slice()));
    assert!(lines[3]["error"]["message"].as_str().unwrap().starts_with("move 4, axis"));
}

#[test]
fn only_one_form_of_output_is_accepted() {
    let folder = Folder::with_move(GOOD);
    for other in ["--json", "--segments"] {
        let ran = folder.run(&format!("plan move.toml --json-lines {other}"));
        assert_eq!(ran.status, 2, "{other}");
        assert_eq!(schemas::check(ran.stdout.trim_end())["error"]["kind"], "usage");
    }
}
