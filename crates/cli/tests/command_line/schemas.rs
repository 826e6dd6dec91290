//! A document of `--json` beside the committed schema that it names.
//!
//! A program in Python checks it, with the module `jsonschema`: the crate of that name and what it
//! needs took a twentieth of the processor time in which the tests are compiled.

use serde_json::{Value, json};
use std::io::{BufRead as _, BufReader, Write as _};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::{LazyLock, Mutex, PoisonError};

/// The folder of the committed schemas.
const SCHEMAS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/schemas");

/// The program, which runs until the tests of this process have ended.
static CHECKER: LazyLock<Mutex<Checker>> = LazyLock::new(|| Mutex::new(Checker::new()));

/// Parses a text that must be one document and checks it against its own schema.
#[track_caller]
pub fn check(text: &str) -> Value {
    let document: Value =
        serde_json::from_str(text).unwrap_or_else(|error| panic!("no document: {error}\n{text}"));
    let name = document["schema"]["name"].as_str().and_then(|name| name.strip_prefix("carrystep."));
    let name = name.unwrap_or_else(|| panic!("no schema is named: {text}"));
    let wrong = CHECKER.lock().unwrap_or_else(PoisonError::into_inner).errors(name, &document);
    assert_eq!(wrong, json!([]), "{name}: {text}");
    document
}

/// The running program.
struct Checker {
    asked: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Checker {
    /// Starts it in the first Python on the path that has the module.
    fn new() -> Self {
        let pythons = which::which_all("python3").expect("a path");
        let mut started = pythons.filter_map(|python| {
            let mut command = Command::new(python);
            command.arg("-c").arg(include_str!("schemas.py"));
            command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
            let Child { stdin, stdout, .. } = command.spawn().ok()?;
            let mut this = Self { asked: stdin?, answers: BufReader::new(stdout?) };
            (this.answer() == "ready\n").then_some(this)
        });
        started.next().expect("no Python has jsonschema: sudo apt-get install python3-jsonschema")
    }

    /// The next line of the program; empty if it has ended.
    fn answer(&mut self) -> String {
        let mut line = String::new();
        self.answers.read_line(&mut line).unwrap();
        line
    }

    /// What is wrong with a document, beside the schema of this name.
    fn errors(&mut self, name: &str, document: &Value) -> Value {
        let schema = format!("{SCHEMAS}/{name}.json");
        writeln!(self.asked, "{}", json!({ "schema": schema, "document": document })).unwrap();
        serde_json::from_str(&self.answer()).expect("the checker has ended")
    }
}

#[test]
fn document_that_is_not_as_its_schema_says_is_found() {
    let good = json!({
        "schema": { "name": "carrystep.failure", "version": 1 },
        "passed": false,
        "error": {
            "kind": "usage", "message": "?",
            "file": null, "line": null, "column": null, "help": null
        },
    });
    check(&good.to_string());
    let errors = |document: &Value| CHECKER.lock().unwrap().errors("failure", document);
    let mut bad = good.clone();
    bad["error"]["kind"] = "none".into();
    assert_eq!(errors(&bad).as_array().unwrap().len(), 1);
    bad["error"].as_object_mut().unwrap().remove("message");
    assert_eq!(errors(&bad).as_array().unwrap().len(), 2);
}
