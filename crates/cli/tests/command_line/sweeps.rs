//! `carrystep sweep`: shards merge to the whole, and a failing case does not stop the others.

use crate::command::{Folder, GOOD};
use serde_json::Value;

/// The moves of [`GOOD`] with varied driver, phases and distance. `drivers` is the list of drivers;
/// two of them give 24 cases.
fn sweep(drivers: &str) -> Folder {
    let folder = Folder::new();
    let blanks = [
        ("\"a4988\"", "\"{{ driver }}\""),
        ("phases = 16", "phases = {{ phases }}"),
        ("x = 2 ", "x = {{ to }} "),
    ];
    let text =
        blanks.into_iter().fold(GOOD.to_owned(), |text, (old, new)| text.replacen(old, new, 1));
    let vary = format!("driver = {drivers}\nphases = [1, 4, 16]\nto = [0, 1, 2, 30]\n");
    folder.write("sweep.toml", format!("move_file = '''\n{text}'''\n[vary]\n{vary}"));
    folder
}

fn json(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_else(|error| panic!("{error}: {text}"))
}

#[test]
fn shards_merge_to_the_whole_in_any_order() {
    let folder = sweep("[\"a4988\", \"tmc2209\"]");
    for options in ["", " --sample 50 --seed 7"] {
        let whole = folder.run(&format!("sweep sweep.toml --json{options}"));
        assert_eq!(whole.status, 0, "{}", whole.stdout);
        for shard in 1..=3 {
            let ran = folder.run(&format!("sweep sweep.toml --json --shard {shard}/3{options}"));
            assert_eq!(ran.status, 0, "{}", ran.stdout);
            folder.write(&format!("{shard}.json"), ran.stdout);
        }
        let merged = folder.run("sweep --json --merge 3.json 1.json 2.json");
        assert_eq!(merged.stdout, whole.stdout, "byte for byte");
        folder
            .run("sweep --merge 1.json 3.json")
            .refuses("each shard is needed once, with all its cases; missing: 2/3");
    }
    let report = json(&folder.run("sweep sweep.toml --json").stdout);
    assert_eq!(report["cases_passed"], 24);
    assert!(
        report["worst"]["step high"]["value"].as_f64().is_some_and(|part| part <= 1.0),
        "{report}"
    );
}

/// A JSON reader that scales by powers of ten would change the last digit of some numbers.
#[test]
fn merged_figures_keep_their_last_digit() {
    let folder = sweep("[\"a4988\", \"tmc2209\"]");
    let mut one = json(&folder.run("sweep sweep.toml --json --shard 1/2").stdout);
    folder.write("2.json", folder.run("sweep sweep.toml --json --shard 2/2").stdout);
    let figures: Vec<f64> =
        (1..=1000).map(|k| (f64::from(k) * 0.618_033_988_749_894_9).fract()).collect();
    let late = one["worst"]["late"].clone();
    for (k, &value) in figures.iter().enumerate() {
        one["worst"][format!("figure {k}")] = late.clone();
        one["worst"][format!("figure {k}")]["value"] = value.into();
    }
    folder.write("1.json", one.to_string());
    let merged = folder.run("sweep --json --merge 1.json 2.json").stdout;
    for value in figures {
        assert!(merged.contains(&format!("\"value\": {value:?},")), "{value:?}");
    }
}

#[test]
fn sweep_in_which_no_case_ran_does_not_pass() {
    let folder = sweep("[\"a4988\"]");
    folder.run("sweep sweep.toml --sample 0").refuses("--sample 0 tries nothing: give at least 1");
    let mut shards = Vec::new();
    for shard in 1..=13 {
        let ran = folder.run(&format!("sweep sweep.toml --json --shard {shard}/13"));
        // There are twelve cases, so the last shard is empty.
        let (status, passed) = if shard == 13 { (4, Value::Null) } else { (0, true.into()) };
        assert_eq!((ran.status, &json(&ran.stdout)["passed"]), (status, &passed), "{}", ran.stdout);
        folder.write(&format!("{shard}.json"), ran.stdout);
        shards.push(format!("{shard}.json"));
    }
    let text = folder.run("sweep sweep.toml --shard 13/13");
    assert!(
        text.status == 4 && text.stdout.ends_with("NOTHING TRIED: no case ran\n"),
        "{}",
        text.stdout
    );
    let merged = folder.run(&format!("sweep --json --merge {}", shards.join(" ")));
    assert_eq!((merged.status, merged.stdout), (0, folder.run("sweep sweep.toml --json").stdout));
    // A sweep in which every move is impossible has the same result as an empty one.
    let impossible = std::fs::read_to_string(folder.path("sweep.toml")).unwrap().replacen(
        "[[move]]",
        "[[move]]\ntime = 1e-6",
        1,
    );
    folder.write("impossible.toml", impossible.replace("to = [0, 1, 2, 30]", "to = [1, 2, 30]"));
    let refused = folder.run("sweep impossible.toml --json");
    assert_eq!(
        (refused.status, &json(&refused.stdout)["passed"]),
        (4, &Value::Null),
        "{}",
        refused.stdout
    );
}

#[test]
fn a_sweep_is_of_one_core() {
    let folder = sweep("[\"a4988\"]");
    for core in ["engine", "parallel"] {
        for shard in 1..=2 {
            let ran =
                folder.run(&format!("sweep sweep.toml --json --core {core} --shard {shard}/2"));
            assert_eq!(
                (ran.status, &json(&ran.stdout)["core"]),
                (0, &core.into()),
                "{}",
                ran.stdout
            );
            folder.write(&format!("{core}{shard}.json"), ran.stdout);
        }
        let merged =
            json(&folder.run(&format!("sweep --json --merge {core}1.json {core}2.json")).stdout);
        assert_eq!((&merged["core"], &merged["cases_passed"]), (&core.into(), &12.into()));
    }
    let ran = folder.run("sweep --merge engine1.json parallel2.json");
    ran.refuses("are not one sweep");
    assert_eq!(folder.run("sweep --core parallel --merge engine1.json engine2.json").status, 2);
}

/// What only the parallel core can hold fails on the engine by name, and is never left out in
/// silence.
#[test]
fn machines_that_the_engine_cannot_hold_fail_on_it() {
    let folder = sweep("[\"a4988\"]");
    let text = std::fs::read_to_string(folder.path("sweep.toml")).unwrap();
    folder.write("sweep.toml", text.replace("clock_hz = 48_000_000", "clock_hz = 16_000_000"));
    let ran = folder.run("sweep sweep.toml --json");
    let report = json(&ran.stdout);
    // Four moves in 16 phases of one clock each.
    assert_eq!(
        (ran.status, &report["cases_passed"], &report["cases_failed"]),
        (1, &8.into(), &4.into()),
        "{report}"
    );
    assert!(
        report["failures"][0]["message"].as_str().unwrap().contains("`--core parallel`"),
        "{report}"
    );
    assert_eq!(folder.run("sweep sweep.toml --core parallel").status, 0);
}

#[test]
fn a_failing_case_stops_no_other() {
    let folder = sweep("[\"a4988\", \"none\"]");
    let ran = folder.run("sweep sweep.toml --json");
    let report = json(&ran.stdout);
    assert_eq!(ran.status, 1);
    assert_eq!((&report["cases_passed"], &report["cases_failed"]), (&12.into(), &12.into()));
    assert_eq!(report["failures"][0]["values"]["driver"], "none");
}

#[test]
fn malformed_sweeps_are_refused() {
    let folder = sweep("[]");
    folder.run("sweep sweep.toml").refuses("driver: an empty list");
    folder.run("sweep none.toml").refuses("cannot read none.toml");
    folder.run("sweep --merge sweep.toml").refuses("sweep.toml: no report of a sweep");
    assert_eq!(folder.run("sweep sweep.toml --shard 4/3").status, 2);
    folder.write("range.toml", "move_file = ''\n[vary]\nx = { from = 1, to = 2 }\n");
    folder.run("sweep range.toml").refuses("x: a range has no grid");
}
