//! The page of `--report`, opened in Chromium: it needs no network, writes no error to the console,
//! shows the figures of `--json`, and answers to mouse and buttons.

use crate::command::{Folder, GOOD};
use crate::schemas;
use serde_json::Value;
use std::process::Command;

const MACHINE: &str = include_str!("../../../../sim/jobs/machine.toml");
const SQUARE: &str = include_str!("../../../../sim/jobs/square_and_arc.ngc");
const DEMO: &str = include_str!("../../../../sim/demo.toml");
const SIX_AXIS: &str = include_str!("../../../../sim/six-axis.toml");

/// A page as the browser shows it.
struct Opened {
    /// The document after the page's script.
    html: String,
    /// What was written to the console.
    console: Vec<String>,
}

/// Opens a page of the folder. A window of this many pixels, without a network.
fn open(folder: &Folder, name: &str, window: &str) -> Opened {
    let profile = tempfile::tempdir().unwrap();
    let output = Command::new("chromium")
        .args(["--headless=new", "--no-sandbox", "--disable-gpu", "--dump-dom"])
        .args(["--enable-logging=stderr", "--virtual-time-budget=4000"])
        .args(["--host-resolver-rules=MAP * ~NOTFOUND", &format!("--window-size={window}")])
        .arg(format!("--user-data-dir={}", profile.path().display()))
        .arg(format!("file://{}", folder.path(name).display()))
        .output()
        .expect("chromium is installed: sudo apt-get install chromium");
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (html, log) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{log}");
    let console = log.lines().filter(|line| line.contains(":CONSOLE")).map(str::to_owned);
    Opened { html, console: console.collect() }
}

/// The text between two others, wherever they are.
fn between<'a>(text: &'a str, before: &str, after: &str) -> Option<&'a str> {
    Some(text.split_once(before)?.1.split_once(after)?.0)
}

/// The value of an attribute in a tag.
fn attribute(tag: &str, name: &str) -> Option<String> {
    Some(between(tag, &format!("{name}=\""), "\"")?.replace("&quot;", "\"").replace("&amp;", "&"))
}

/// Compares each figure of a page with the document that `--json` printed; the number of figures.
#[track_caller]
fn figures_equal(opened: &Opened, document: &Value) -> usize {
    assert_eq!(opened.console, Vec::<String>::new());
    assert!(opened.html.contains("data-ready=\"yes\""), "the script has not come to its end");
    let figures: Vec<&str> = opened.html.split("<span data-figure=").skip(1).collect();
    for figure in &figures {
        let tag = format!("data-figure={}", figure.split_once('>').unwrap().0);
        let pointer = attribute(&tag, "data-figure").unwrap();
        let value: Value = serde_json::from_str(&attribute(&tag, "data-value").unwrap()).unwrap();
        let expected = document.pointer(&pointer).unwrap_or_else(|| panic!("no {pointer}"));
        assert_eq!(value.as_f64(), expected.as_f64(), "{pointer}");
        assert!(expected.is_number(), "{pointer}: {expected}");
        // What the reader sees is this value, rounded.
        let shown = between(figure, ">", "</span>").unwrap();
        let per: f64 = attribute(&tag, "data-per").unwrap().parse().unwrap();
        let expected = expected.as_f64().unwrap() / per;
        let shown: f64 = shown.replace('\u{202f}', "").replace('\u{2212}', "-").parse().unwrap();
        assert!((shown - expected).abs() <= 5e-3 * expected.abs(), "{pointer}: {shown} {expected}");
    }
    figures.len()
}

fn job() -> Folder {
    let folder = Folder::new();
    folder.write("m.toml", MACHINE);
    folder.write("job.ngc", SQUARE);
    folder
}

#[test]
fn pages_of_programs_show_the_figures_of_json() {
    let folder = job();
    for (command, least) in [("plan", 30), ("simulate", 35)] {
        let ran = folder.run(&format!("{command} job.ngc --machine m.toml --report r.html --json"));
        assert_eq!((ran.status, ran.stderr.as_str()), (0, ""));
        let opened = open(&folder, "r.html", "1280,2000");
        let count = figures_equal(&opened, &schemas::check(&ran.stdout));
        assert!(count >= least, "{command}: {count} figures");
        for part in [
            "</span>acceleration of y</td>",
            "<code class=\"first\">G2 X40 Y0 I20 J0</code>",
            "<figcaption>Time by the distance",
        ] {
            assert!(opened.html.contains(part), "{command}: {part}");
        }
        assert_eq!(
            opened.html.contains("<figcaption>Pulses by the distance"),
            command == "simulate"
        );
        // Without a page, the same figures.
        let plain = folder.run(&format!("{command} job.ngc --machine m.toml --json"));
        let of = |text: &str| {
            let mut document = schemas::check(text);
            document.as_object_mut().unwrap().retain(|key, _| key != "run_s" && key != "files");
            document
        };
        assert_eq!(of(&plain.stdout), of(&ran.stdout));
    }
}

#[test]
fn pages_of_moves_show_the_figures_of_json() {
    let folder = Folder::new();
    folder.write("demo.toml", DEMO);
    folder.write("six-axis.toml", SIX_AXIS);
    let ran = folder.run("simulate demo.toml --report new/r.html --json");
    assert_eq!((ran.status, ran.stderr.as_str()), (0, ""));
    let opened = open(&folder, "new/r.html", "400,900");
    let document = schemas::check(&ran.stdout);
    assert!(figures_equal(&opened, &document) >= 30);
    assert!(opened.html.contains("<figcaption>Pulses of c by their error"));
    // Every pulse is in a class of its axis.
    for (axis, counts) in document["check"]["axes"]
        .as_array()
        .unwrap()
        .iter()
        .zip(document["error_counts"].as_array().unwrap())
    {
        let sum: u64 = counts["counts"].as_array().unwrap().iter().filter_map(Value::as_u64).sum();
        assert_eq!(axis["pulses_found"], sum);
        let at = |key: &str| counts[key].as_f64().unwrap();
        assert!(axis["error_min_ns"].as_f64().unwrap() >= at("from_ns"));
        assert!(axis["error_min_ns"].as_f64().unwrap() < at("from_ns") + at("width_ns"));
    }
    // The page of a plan has the document of the last line of `--json-lines`.
    let ran = folder.run("plan demo.toml --report p.html --json-lines");
    assert_eq!((ran.status, ran.stderr.as_str()), (0, ""));
    let last = schemas::check(ran.stdout.lines().last().unwrap());
    assert!(figures_equal(&open(&folder, "p.html", "1280,900"), &last) >= 15);
}

/// Adds a script to the end of a page, which writes what it finds to `data-found`.
fn with_script(folder: &Folder, script: &str) -> Opened {
    let page = std::fs::read_to_string(folder.path("r.html")).unwrap();
    let script = format!("<script>{script}</script></body>");
    folder.write("tried.html", page.replace("</body>", &script));
    open(folder, "tried.html", "1280,2000")
}

#[test]
fn page_answers_to_mouse_wheel_and_buttons() {
    let folder = job();
    let program = "G0 Z1\nG1 X10 F600\nZ-1\nX0 Y5\n";
    folder.write("job.ngc", program);
    assert_eq!(folder.run("plan job.ngc --machine m.toml --report r.html").status, 0);
    let script = include_str!("reports.js");
    let opened = with_script(&folder, script);
    assert_eq!(opened.console, Vec::<String>::new());
    let found = attribute(&opened.html, "data-found").unwrap();
    assert_eq!(found, ["true"; 12].join(","));
}

/// The tests above would see an error of the script.
#[test]
fn error_of_a_script_is_seen() {
    let folder = job();
    assert_eq!(folder.run("plan job.ngc --machine m.toml --report r.html").status, 0);
    let opened = with_script(&folder, "drawing.path.missing.length;");
    assert!(opened.console.iter().any(|line| line.contains("TypeError")), "{:?}", opened.console);
}

#[test]
fn nothing_of_a_program_is_taken_for_a_part_of_the_page() {
    let folder = job();
    let program =
        "(</script><script>document.title='taken'</script>)\nG1 X1 F600\nG1 X2 (<b>&amp;)\n";
    folder.write("a<b>.ngc", program);
    let ran = folder.run("plan a<b>.ngc --machine m.toml --report r.html --json");
    assert_eq!((ran.status, ran.stderr.as_str()), (0, ""));
    let opened = open(&folder, "r.html", "1280,900");
    figures_equal(&opened, &schemas::check(&ran.stdout));
    assert!(opened.html.contains("<h1>a&lt;b&gt;.ngc</h1>"));
    assert!(opened.html.contains("<code class=\"first\">G1 X2 (&lt;b&gt;&amp;amp;)"));
    assert!(!opened.html.contains("<title>taken"));
}

#[test]
fn page_appears_whole_or_not_at_all() {
    let folder = job();
    folder.write("old.html", "as it was");
    folder.write("bad.ngc", "G1 X1 F600\nG1 X2 Q\n");
    folder.write("move.toml", GOOD);
    for arguments in [
        "plan bad.ngc --machine m.toml --report old.html",
        "simulate bad.ngc --machine m.toml --report old.html",
        "simulate job.ngc --machine m.toml --vcd a.vcd --report a.vcd",
        "plan job.ngc --machine m.toml --report m.toml",
        "plan move.toml --report move.toml",
        "simulate move.toml --csv b.csv --report b.csv",
    ] {
        let before = folder.files();
        assert_eq!(folder.run(arguments).status, 2, "{arguments}");
        assert_eq!(folder.files(), before, "{arguments}");
        assert_eq!(std::fs::read_to_string(folder.path("old.html")).unwrap(), "as it was");
    }
    let ran = folder.run("simulate job.ngc --machine m.toml --report old.html --json");
    assert_eq!(schemas::check(&ran.stdout)["files"], serde_json::json!(["old.html"]));
    assert!(
        std::fs::read_to_string(folder.path("old.html")).unwrap().starts_with("<!doctype html>")
    );
}
