//! `--junit` writes the XML that CI systems display; and `carrystep completions`.

use crate::command::{Folder, GOOD};
use roxmltree::Document;
use std::process::Command;

/// Name and failure message of each test case. The counts in the file must equal those of its
/// cases.
#[track_caller]
fn cases(folder: &Folder, name: &str) -> Vec<(String, Option<String>)> {
    let text = std::fs::read_to_string(folder.path(name)).unwrap();
    let document = Document::parse(&text).unwrap();
    let root = document.root_element();
    assert_eq!(root.tag_name().name(), "testsuites");
    let case = |node: roxmltree::Node<'_, '_>| {
        let failure = node.children().find(|child| child.has_tag_name("failure"));
        (
            node.attribute("name").unwrap().to_owned(),
            failure.map(|node| node.attribute("message").unwrap().to_owned()),
        )
    };
    let cases: Vec<_> =
        root.descendants().filter(|node| node.has_tag_name("testcase")).map(case).collect();
    let failed = cases.iter().filter(|(_, failure)| failure.is_some()).count();
    assert_eq!(root.attribute("tests"), Some(&*cases.len().to_string()));
    assert_eq!(root.attribute("failures"), Some(&*failed.to_string()));
    cases
}

#[test]
fn check_writes_one_test_case_per_axis() {
    let folder = Folder::with_move(GOOD);
    assert_eq!(folder.run("simulate move.toml --vcd a.vcd").status, 0);
    assert_eq!(folder.run("check a.vcd move.toml --junit out/check.xml").status, 0);
    assert_eq!(cases(&folder, "out/check.xml"), [("axis x".to_owned(), None)]);
    folder.write("longer.toml", GOOD.replace("x = 2", "x = 3"));
    assert_eq!(folder.run("check a.vcd longer.toml --junit out/check.xml --json").status, 1);
    let [(name, Some(message))] = &cases(&folder, "out/check.xml")[..] else {
        panic!("one case that failed")
    };
    assert!(name == "axis x" && message.contains("axis x"), "{message}");
    folder.run("check a.vcd move.toml --junit a.vcd").refuses("it is also the output a.vcd");
    folder.run("check a.vcd move.toml --junit move.toml").refuses("it is the input move.toml");
}

#[test]
fn sweep_writes_one_test_case_for_all_and_one_per_failure() {
    let folder = Folder::new();
    let text = GOOD.replace("\"a4988\"", "\"{{ driver }}\"");
    let sweep = |drivers: &str| {
        folder.write("s.toml", format!("move_file = '''\n{text}'''\n[vary]\ndriver = {drivers}\n"));
    };
    sweep("[\"a4988\", \"tmc2209\"]");
    assert_eq!(folder.run("sweep s.toml --junit s.xml").status, 0);
    assert_eq!(cases(&folder, "s.xml"), [("all cases".to_owned(), None)]);
    sweep("[\"a4988\", \"no<such>driver\"]");
    let ran = folder.run("sweep s.toml --junit s.xml --json");
    assert_eq!(ran.status, 1, "{}", ran.stderr);
    let found = cases(&folder, "s.xml");
    assert_eq!(found.len(), 2);
    assert_eq!(found[0].0, "all cases");
    assert!(found[0].1.as_ref().is_some_and(|message| message.contains("1 failed")), "{found:?}");
    assert!(
        found[1].0 == "case 1" && found[1].1.as_ref().unwrap().contains("no<such>driver"),
        "{found:?}"
    );
    folder.write("report.json", ran.stdout);
    folder
        .run("sweep --merge report.json --junit report.json")
        .refuses("it is also the output report.json");
    assert_eq!(folder.run("sweep --merge report.json --junit merged.xml").status, 1);
    assert_eq!(cases(&folder, "merged.xml"), found);
}

#[test]
fn a_shell_completes_subcommands_and_options() {
    let folder = Folder::new();
    for shell in ["bash", "elvish", "fish", "powershell", "zsh"] {
        let ran = folder.run(&format!("completions {shell}"));
        assert_eq!(ran.status, 0, "{}", ran.stderr);
        assert!(ran.stdout.contains("virtual-board") && ran.stdout.contains("fit-ns"), "{shell}");
    }
    folder.write("carrystep.bash", folder.run("completions bash").stdout);
    let script = "source carrystep.bash; \
                  COMP_WORDS=(carrystep simul); COMP_CWORD=1; _carrystep carrystep simul carrystep; echo \"${COMPREPLY[@]}\"";
    let ran = folder.output(Command::new("bash").args(["-c", script]));
    assert_eq!(ran.stdout.trim(), "simulate", "{}", ran.stderr);
}
