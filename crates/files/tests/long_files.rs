//! A long move file is read move by move. It must give the moves and the mistakes of the same text
//! read as a whole.

use carrystep_files::{InputError, Move, MoveFile, MoveSource, SourceText};
use std::path::PathBuf;
use tempfile::TempDir;

const MACHINE: &str = "[machine]\nhome_order = [\n[\"x\"], # [[move]]\n]\n\
    [[machine.axis]]\nname = \"x\"\nsteps_per_unit = 5\nspeed_limit = 1000\naccel_limit = 5000\n\
    jerk_limit = 1e6\ndriver = \"a4988\"\nhome = { toward = \"min\", seek_speed = 20, slow_speed = 2, move_off = 5, max_travel = 30, pull_off = 2, position = 0 }\n\
    [[machine.axis]]\nname = \"y\"\nsteps_per_unit = 3\nspeed_limit = 1000\naccel_limit = 5000\ndriver = \"a4988\"\n";

/// Moves in every way in which TOML writes them.
const MOVES: &str = "\n# the first\n[[move]] # with a note\nprofile = \"ranade\"\nto = { x = 0.07 }\n\
    [[move]]\npath = \"straight\"\nprofile = \"trapezoid\"\n[move.to]\nx = -0.1\n\"y\" = 1e-1\n\n\
    [[ \"move\" ]]\r\nprofile = \"scurve\"\r\ntime = 0.25\r\nfit_ns = 7\r\nto.x = -1\r\n";

/// A machine and moves of over 256 KiB.
fn long_text() -> String {
    format!("{MACHINE}{}", MOVES.repeat((300 << 10) / MOVES.len()))
}

struct Folder(TempDir);

impl Folder {
    fn with(text: impl AsRef<[u8]>) -> (Self, PathBuf) {
        let folder = Self(tempfile::tempdir().unwrap());
        let path = folder.0.path().join("moves.toml");
        std::fs::write(&path, text).unwrap();
        (folder, path)
    }
}

/// The moves of a file, or its first mistake: the name of the file without its folder, line,
/// column, message and remedy.
fn read(text: impl AsRef<[u8]>) -> Result<Vec<Move>, String> {
    let (_folder, path) = Folder::with(text);
    let told = |error: InputError| {
        let told = error.to_string();
        told[told.find("moves.toml").unwrap_or(0)..].to_owned()
    };
    let source = MoveSource::open(&path).map_err(told)?;
    let read = || source.moves()?.collect::<Result<Vec<Move>, _>>();
    let first = read().map_err(told)?;
    assert_eq!(read().map_err(told)?.len(), first.len());
    Ok(first)
}

fn mistake(text: impl AsRef<[u8]>) -> String {
    read(text).map(|moves| moves.len()).unwrap_err()
}

fn whole(text: &str) -> Result<MoveFile, String> {
    let source = SourceText { path: "moves.toml".into(), text: text.into() };
    MoveFile::from_source(source).map_err(|error| error.to_string())
}

#[test]
fn moves_are_those_of_the_text_as_a_whole() {
    let text = long_text();
    let (long, whole) = (read(&text).unwrap(), whole(&text).unwrap().moves);
    assert!(long.len() > 1000);
    assert_eq!(long.len(), whole.len());
    for (index, (found, wanted)) in long.iter().zip(&whole).enumerate() {
        let facts = |moved: &Move| {
            let Move { profile, path, fit_ns, rounding, .. } = moved;
            (*profile, *path, moved.time.clone(), *fit_ns, moved.steps.clone(), rounding.clone())
        };
        assert_eq!(facts(found), facts(wanted), "move {index}");
    }
}

#[test]
fn a_later_error_points_to_the_move_and_shows_the_lines_around_it() {
    let text = long_text();
    let (_folder, path) = Folder::with(&text);
    let source = MoveSource::open(&path).unwrap();
    let as_a_whole = whole(&text).unwrap();
    for (index, moved) in source.moves().unwrap().enumerate().skip(1200).take(3) {
        let moved = moved.unwrap();
        let found = source.move_error(&moved, "no");
        let wanted = as_a_whole.move_error(index, "no");
        assert_eq!(found.line_column(), wanted.line_column());
        let (part, span) = found.place.unwrap();
        let line = |text: &str, at: usize| text[..at].matches('\n').count();
        let at = line(&part.text, span.start);
        let (whole, whole_span) = wanted.place.unwrap();
        let first = line(&whole.text, whole_span.start) - at;
        let around: Vec<&str> = whole.text.lines().skip(first).take(at + 2).collect();
        assert!(at == 1 && part.text.lines().take(at + 2).eq(around), "{}", part.text);
    }
}

#[test]
fn a_mistake_is_that_of_the_text_as_a_whole() {
    let text = long_text();
    let last = text.rfind("[[ \"move\" ]]").unwrap();
    let (before, end) = text.split_at(last);
    for (old, new) in [
        ("scurve", "curve"),
        ("time = 0.25", "time = -0.25"),
        ("time = 0.25", "time = 0.25 0.25"),
        ("fit_ns = 7", "fit = 7"),
        ("fit_ns = 7", "fit_ns = 7\r\nfit_ns = 7"),
        ("to.x = -1", "to.z = -1"),
        ("to.x = -1", "to.x = 1e9"),
        ("to.x = -1", ""),
        ("to.x = -1", "to = { x = 1"),
        ("to.x = -1", "to.x = [\r\n1\r\n]"),
        ("to.x = -1", "to.x = \"\"\"\r\n[[move]]"),
        ("to.x = -1", "to.x = 1\r\n[move.to]\r\nx = 1"),
        ("to.x = -1", "to.x = 1\r\n[move.by]\r\nx = 1"),
    ] {
        let wrong = end.replacen(old, new, 1);
        assert_ne!(wrong, end, "{old}");
        let wrong = format!("{before}{wrong}");
        assert_eq!(mistake(&wrong), whole(&wrong).err().unwrap(), "{new}");
    }
    for (old, new) in
        [("steps_per_unit = 5", "steps_per_unit = 0"), ("name = \"x\"", "nam = \"x\"")]
    {
        let wrong = text.replacen(old, new, 1);
        assert_eq!(mistake(&wrong), whole(&wrong).err().unwrap(), "{new}");
    }
}

#[test]
fn what_only_a_long_file_cannot_have_is_refused_with_its_line() {
    let text = long_text();
    let lines = text.lines().count();
    let later = format!("{text}[machine.extra]\n");
    let says = format!(
        "moves.toml:{}:1: in a long file the machine stands before the moves\n  help: put this table before the first [[move]]",
        lines + 1
    );
    assert_eq!(mistake(&later), says);
    let line = text.find("\n[[move]]").unwrap();
    let first_line = text[..line].matches('\n').count() + 2;
    let note = "# a note of many words, which makes this move long\n".repeat(100_000);
    let mut long = text.clone();
    long.insert_str(text.find("profile = \"ranade\"").unwrap(), &note);
    let says = format!("moves.toml:{first_line}: this move has over 4194304 bytes (4 MiB)");
    assert_eq!(mistake(&long), says);
    let long = format!("{note}{text}");
    let says = "moves.toml:1: what stands before the first [[move]] has over 4194304 bytes (4 MiB)";
    assert_eq!(mistake(&long), says);
    let long = format!("{text}[[move]] #{}", " ".repeat(5 << 20));
    assert_eq!(
        mistake(&long),
        format!("moves.toml:{}: the line has over 4194304 bytes (4 MiB)", lines + 1)
    );
    let not_utf8 = [text.as_bytes(), b"[[move]] # \xc3\xa9\xff"].concat();
    let says =
        format!("moves.toml:{}:13: not UTF-8\n  help: a text file in TOML is expected", lines + 1);
    assert_eq!(mistake(&not_utf8), says);
    let both = text.replacen("[machine]", "move = []\n[machine]", 1);
    assert!(read(&both).is_ok(), "an empty list before the moves has no move to lose");
    let both = text.replacen(
        "[machine]",
        "move = [{ profile = \"ranade\", to = { x = 1 } }]\n[machine]",
        1,
    );
    assert_eq!(
        mistake(&both),
        "moves.toml:1:9: a long file has each of its moves in a [[move]] table"
    );
}

#[test]
fn a_long_file_without_moves_is_read_as_a_whole() {
    let list = "{ profile = \"ranade\", to = { x = 1 } },\n".repeat(8000);
    let text = format!("move = [\n{list}]\n{MACHINE}");
    assert_eq!(read(&text).unwrap().len(), 8000);
    let none = format!("{MACHINE}{}", "# no move\n".repeat(40_000));
    assert_eq!(mistake(&none), "moves.toml:1:1: no moves\n  help: add a [[move]] table");
}

#[test]
fn a_file_that_changes_is_refused() {
    let text = long_text();
    let (_folder, path) = Folder::with(&text);
    let source = MoveSource::open(&path).unwrap();
    let mut moves = source.moves().unwrap();
    assert!(moves.next().unwrap().is_ok());
    std::fs::write(&path, format!("{text}\n")).unwrap();
    let last = moves.last().unwrap().unwrap_err().to_string();
    assert!(last.contains("has changed while it was read"), "{last}");
    let later = source.moves().unwrap_err().to_string();
    assert!(later.contains("has changed while it was read"), "{later}");
    std::fs::remove_file(&path).unwrap();
    assert!(source.moves().unwrap_err().to_string().contains("cannot read"));
}
