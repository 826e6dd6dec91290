//! Tests of docs/machine-files.md: the page lists the keys and defaults of the reader, and its
//! examples are valid.

use carrystep_core::ChosenTick;
use carrystep_files::{Machine, MoveFile, SourceText};

const PAGE: &str = include_str!("../../../docs/machine-files.md");
const AXIS: &str = "[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 5\nspeed_limit = 1000\naccel_limit = 5000\n\
                    driver = \"a4988\"\n";
const MOVE: &str = "[[move]]\nprofile = \"ranade\"\nto = { x = 1 }\n";

fn source(text: &str) -> SourceText {
    SourceText { path: "page.toml".into(), text: text.into() }
}

fn machine(text: &str) -> Machine {
    Machine::from_source(&source(text)).unwrap()
}

/// Rows of the table under a heading; the first cell of a row is its key.
fn rows(heading: &str) -> Vec<Vec<&'static str>> {
    let (_, section) = PAGE.split_once(&format!("\n{heading}\n")).unwrap();
    let section = section.split("\n#").next().unwrap();
    let lines = section.lines().filter(|line| line.starts_with("| `"));
    lines.map(|line| line.trim_matches('|').split('|').map(str::trim).collect()).collect()
}

/// The first text in backticks.
fn quoted(text: &str) -> &str {
    text.split('`').nth(1).unwrap()
}

/// The names of keys in the first edition, which one sentence of the page lists.
fn former_names() -> impl Iterator<Item = &'static str> {
    let (_, rest) = PAGE.split_once("had in the first edition, ").unwrap();
    let (names, _) = rest.split_once("are still read").unwrap();
    names.split('`').skip(1).step_by(2)
}

/// The keys that the reader knows in the table that contains `colour`: its error for this unknown
/// key lists them.
fn known(text: &str) -> Vec<String> {
    let error = MoveFile::from_source(source(text)).unwrap_err().message;
    let (_, keys) = error.split_once("expected ").unwrap_or_else(|| panic!("{error}"));
    keys.split('`').skip(1).step_by(2).map(str::to_owned).collect()
}

#[test]
fn page_lists_the_keys_of_the_reader() {
    let tables = [
        ("## `[machine]`", format!("{MOVE}[machine]\ncolour = 1\n{AXIS}")),
        ("## `[[machine.axis]]`", format!("{MOVE}[machine]\n{AXIS}colour = 1\n")),
        ("### `home`", format!("{MOVE}[machine]\n{AXIS}home = {{ colour = 1 }}\n")),
        ("## `[machine.guard]`", format!("{MOVE}[machine.guard]\ncolour = 1\n{AXIS}")),
        ("## `[machine.inputs]`", format!("{MOVE}[machine.inputs]\ncolour = 1\n{AXIS}")),
        (
            "### `latches`",
            format!("{MOVE}[machine.inputs]\nlatches = [{{ colour = 1 }}]\n[machine]\n{AXIS}"),
        ),
        ("## `[machine.link]`", format!("{MOVE}[machine.link]\ncolour = 1\n{AXIS}")),
        ("## The move file", format!("colour = 1\n{MOVE}[machine]\n{AXIS}")),
        ("### `[[move]]`", format!("{MOVE}colour = 1\n[machine]\n{AXIS}")),
    ];
    for (heading, text) in tables {
        let mut shown: Vec<&str> = rows(heading).iter().map(|row| quoted(row[0])).collect();
        if heading == "## `[[machine.axis]]`" {
            shown.extend(former_names());
        }
        let mut read = known(&text);
        shown.sort_unstable();
        read.sort_unstable();
        assert_eq!(shown, read, "{heading}");
    }
}

#[test]
fn page_gives_the_defaults_of_the_reader() {
    // A default in backticks alone is a literal value.
    let given = |heading| {
        let literal = |cell: &str| {
            cell.starts_with('`') && cell.ends_with('`') && cell.matches('`').count() == 2
        };
        let rows = rows(heading).into_iter().filter(|row| row.len() > 2 && literal(row[2]));
        rows.map(|row| format!("{} = {}\n", quoted(row[0]), quoted(row[2]))).collect::<Vec<_>>()
    };
    let [top, axis, guard, link] =
        ["## `[machine]`", "## `[[machine.axis]]`", "## `[machine.guard]`", "## `[machine.link]`"]
            .map(given);
    assert_eq!((top.len(), axis.len(), guard.len(), link.len()), (8, 1, 7, 2));
    let bare = format!("{:?}", machine(&format!("[machine]\n{AXIS}")));
    let full = format!(
        "[machine]\n{}[machine.guard]\n{}[machine.link]\n{}{AXIS}{}",
        top.concat(),
        guard.concat(),
        link.concat(),
        axis.concat()
    );
    assert_eq!(format!("{:?}", machine(&full)), bare);
    let moved = |more: &str| {
        format!(
            "{:?}",
            MoveFile::from_source(source(&format!("{MOVE}{more}[machine]\n{AXIS}"))).unwrap().moves
                [0]
            .path
        )
    };
    assert_eq!(moved(&given("### `[[move]]`").concat()), moved(""));
}

#[test]
fn page_gives_the_ticks_that_are_chosen() {
    let rows = PAGE.lines().filter_map(|line| line.strip_prefix("| ")?.split_once(" MHz | "));
    let mut seen = 0;
    for (mhz, rest) in rows {
        let ticks: Vec<u64> = rest
            .trim_end_matches(" |")
            .split(" | ")
            .map(|cell| cell.trim_end_matches(" ns").parse().unwrap())
            .collect();
        let chosen = |phases| {
            ChosenTick::new(mhz.parse::<u64>().unwrap() * 1_000_000, phases, 6).unwrap().tick_ns
        };
        assert_eq!(ticks, [chosen(16), chosen(4)], "{mhz} MHz");
        seen += 1;
    }
    assert_eq!(seen, 6);
}

#[test]
fn every_value_named_by_the_page_is_valid() {
    for row in rows("## `[machine.guard]`").into_iter().filter(|row| row[3].starts_with("`\"")) {
        for word in row[3].split(", ") {
            machine(&format!("[machine.guard]\n{} = {}\n{AXIS}", quoted(row[0]), quoted(word)));
        }
    }
    let axes = rows("## `[[machine.axis]]`");
    let drivers = axes.iter().find(|row| row[0] == "`driver`").unwrap();
    let known: Vec<&str> = carrystep_files::driver::drivers().keys().map(String::as_str).collect();
    assert_eq!(drivers[3], known.join(", "));
}

#[test]
fn page_gives_the_ranges_of_the_guard() {
    for row in rows("## `[machine.guard]`").into_iter().filter(|row| row[3].starts_with("0 to ")) {
        let most = row[3].trim_start_matches("0 to ").split(' ').next().unwrap();
        let read = |more: &str| {
            let text = format!("[machine.guard]\n{} = {most}{more}e3\n{AXIS}", quoted(row[0]));
            Machine::from_source(&source(&text)).is_ok()
        };
        assert!(read(""), "{row:?}");
        assert!(!read("01"), "{row:?}");
    }
}

#[test]
fn examples_are_valid_and_the_first_has_every_key() {
    let blocks: Vec<&str> =
        PAGE.split("```toml\n").skip(1).map(|rest| rest.split("```").next().unwrap()).collect();
    machine(blocks[0]);
    for heading in [
        "## `[machine]`",
        "## `[[machine.axis]]`",
        "## `[machine.guard]`",
        "## `[machine.inputs]`",
        "## `[machine.link]`",
    ] {
        // `latches` stands in place of other keys of the example, and has an example of its own.
        for row in rows(heading).iter().filter(|row| quoted(row[0]) != "latches") {
            let key = quoted(row[0]);
            let table = ["guard", "inputs", "outputs", "link", "axis"].contains(&key);
            let there = blocks[0].contains(&if table {
                format!("machine.{key}]")
            } else {
                format!("\n{key} = ")
            });
            assert!(there, "{key}");
        }
    }
    let (_, home) = blocks[0].split_once("\nhome = {").unwrap();
    for row in rows("### `home`") {
        assert!(home.contains(&format!(" {} = ", quoted(row[0]))), "{row:?}");
    }
    let (_, latches) = PAGE.split_once("\n    latches = [").unwrap();
    let (latches, _) = latches.split_once("\n    ]").unwrap();
    let inputs = format!("[machine.inputs]\nprobe = \"low\"\nlatches = [{latches}]\n");
    assert_eq!(machine(&format!("[machine]\n{inputs}{AXIS}")).guard.latches.len(), 3);
    let two = format!("{AXIS}{}", AXIS.replace("\"x\"", "\"y\""));
    let (first, moves) = blocks[1].split_once("\n\n").unwrap();
    assert!(first.starts_with("machine_file = "));
    assert_eq!(
        MoveFile::from_source(source(&format!("{moves}[machine]\n{two}"))).unwrap().moves.len(),
        1
    );
}
