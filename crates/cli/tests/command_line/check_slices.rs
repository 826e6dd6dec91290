//! `carrystep check --slice` and `--merge`: the report of the whole capture, or a refusal.

use crate::command::{Folder, GOOD};

/// A folder with a capture `c.vcd` of `move.toml`, in which one pulse is missing, and its three
/// slices.
fn sliced() -> Folder {
    let folder = Folder::with_move(GOOD);
    assert_eq!(folder.run("simulate move.toml --vcd c.vcd").status, 0);
    let text = std::fs::read_to_string(folder.path("c.vcd")).unwrap();
    let code = text.lines().find_map(|line| line.strip_suffix(" step $end")).unwrap();
    let code = code.rsplit(' ').next().unwrap();
    // The third rise of STEP, and the fall after it.
    let is_level = |line: &&str| *line == format!("1{code}") || *line == format!("0{code}");
    let places: Vec<usize> = text.match_indices('\n').map(|(place, _)| place + 1).collect();
    let levels = places
        .iter()
        .filter(|&&place| text[place..].lines().next().is_some_and(|line| is_level(&line)));
    let mut lost: Vec<usize> = levels.copied().skip(5).take(2).collect();
    let mut text = text.clone();
    while let Some(place) = lost.pop() {
        text.replace_range(place..=place + code.len() + 1, "");
    }
    folder.write("c.vcd", text);
    for slice in 1..=3 {
        let ran =
            folder.run(&format!("check c.vcd move.toml --slice {slice}/3 --out {slice}.slice"));
        assert_eq!(ran.status, 0, "a slice gives no verdict: {}", ran.stderr);
        assert!(ran.stdout.starts_with(&format!("slice {slice}/3: bytes ")), "{}", ran.stdout);
    }
    folder
}

#[test]
fn slices_merge_to_the_report_of_the_whole_capture() {
    let folder = sliced();
    for option in ["", " --json"] {
        let whole = folder.run(&format!("check c.vcd move.toml{option}"));
        let slices = format!("check c.vcd move.toml{option} --merge 3.slice 1.slice 2.slice");
        let merged = folder.run(&slices);
        assert!(whole.stdout.contains("is missing, due at"), "{}", whole.stdout);
        assert_eq!((merged.status, &merged.stdout), (1, &whole.stdout));
        // A slice that is checked again is replaced.
        folder.run("check c.vcd move.toml --slice 2/3 --out 2.slice");
        assert_eq!(folder.run(&slices).stdout, whole.stdout);
    }
    let ran = folder.run("check c.vcd move.toml --junit r.xml --merge 1.slice 2.slice 3.slice");
    assert_eq!(ran.status, 1);
    assert!(std::fs::read_to_string(folder.path("r.xml")).unwrap().contains("is missing"));
}

#[test]
fn slices_that_do_not_belong_together_are_refused() {
    let folder = sliced();
    let merge = |slices: &str| folder.run(&format!("check c.vcd move.toml --merge {slices}"));
    merge("1.slice 3.slice").refuses("each of the 3 slices is needed once; missing: 2");
    merge("1.slice 2.slice 3.slice 2.slice")
        .refuses("slice 2 occurs twice: in 2.slice and in 2.slice");
    merge("1.slice 2.slice move.toml").refuses("move.toml: no slice of a check");
    merge("1.slice 2.slice 4.slice").refuses("cannot read 4.slice");
    let text = std::fs::read_to_string(folder.path("2.slice")).unwrap();
    for length in (0..text.len()).step_by(97) {
        folder.write("cut.slice", &text[..length]);
        let ran = merge("1.slice cut.slice 3.slice");
        let says = if length < 22 { "no slice of a check" } else { "it is damaged" };
        ran.refuses(says);
    }
    folder.write("changed.slice", text.replace("\"number\":2", "\"number\":3"));
    merge("1.slice changed.slice 3.slice").refuses("changed.slice: it is damaged");
    folder.write("new.slice", text.replacen("slice 1 ", "slice 2 ", 1));
    merge("1.slice new.slice").refuses("new.slice: it has version 2 of the format");
    folder.run("check c.vcd move.toml --slice 2/4 --out four.slice");
    merge("1.slice four.slice 3.slice")
        .refuses("1.slice and four.slice are not of one check: the numbers of slices differ");
    folder.run("check c.vcd move.toml --slack-ns 10 --slice 2/3 --out slack.slice");
    merge("1.slice slack.slice 3.slice")
        .refuses("1.slice and slack.slice are not of one check: the options differ");
    folder
        .run("check c.vcd move.toml --slack-ns 10 --merge 1.slice 2.slice 3.slice")
        .refuses("1.slice and this merge are not of one check: the options differ");
    let (text, _) = crate::command::edit(GOOD, "x = 2 ", "^x = 3 ");
    folder.write("move.toml", text);
    merge("1.slice 2.slice 3.slice")
        .refuses("1.slice and this merge are not of one check: the moves or the machines differ");
    folder.write("move.toml", GOOD);
    let capture = std::fs::read_to_string(folder.path("c.vcd")).unwrap();
    folder.write("c.vcd", capture.clone() + "$comment more $end\n");
    merge("1.slice 2.slice 3.slice").refuses("slice 1 is of another capture");
}

#[test]
fn slices_that_cannot_be_kept_are_refused_before_the_check() {
    let folder = sliced();
    let refused = |options: &str, says: &str| {
        folder.run(&format!("check c.vcd move.toml {options}")).refuses(says);
    };
    refused("--slice 4/3 --out 4.slice", "'4/3' is not N/OF: 3/16 is the third of sixteen");
    refused("--slice 2/3", "--out <SLICE>");
    refused("--out 2.slice", "--slice <N/OF>");
    refused("--slice 2/3 --out c.vcd", "c.vcd");
    refused("--slice 2/3 --out 2.slice --merge 1.slice", "cannot be used with");
    refused("--merge 1.slice 2.slice 3.slice --junit 2.slice", "2.slice");
    assert!(folder.run("check c.vcd move.toml --slice 2/3 --out new/2.slice").status == 0);
}
