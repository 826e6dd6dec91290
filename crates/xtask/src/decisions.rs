//! The index of `docs/decisions/`, written from the pages themselves.
//!
//! The first line of a page is its title, `# 14. One 32-bit adder`; the third says when it was
//! decided, whether it holds, and what it is about:
//!
//! ```text
//! Date: 2026-11-19. Status: in force. Subject: engine.
//! Date: 2026-11-14. Status: replaced by 56. Subject: stops.
//! ```
//!
//! `index.md` lists all pages by subject, and `SUMMARY.md` lists them by number. `SUMMARY.md` also
//! lists the boards, in the order of the generated `docs/boards/index.md`.

use crate::shell::{self, TaskResult};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;

const FOLDER: &str = "docs/decisions";
const SUMMARY: &str = "docs/SUMMARY.md";
const BOARDS: &str = "docs/boards/index.md";
const HEAD: &str = "\
# Decisions

Each page is one choice that someone might undo, with its reason. The pages are numbered. The choice
on a page is never changed: one that no longer holds gets a new page, and the old page says which
page replaced it.

`cargo xtask decisions` writes this index from the third line of each page.
";

/// A page, as its first three lines describe it.
#[derive(Debug, PartialEq, Eq)]
struct Decision {
    number: u32,
    title: String,
    date: String,
    status: String,
    subject: String,
    file: String,
}

impl Decision {
    /// Reads the first three lines of a page; `file` is its name in the folder.
    fn read(file: &str, text: &str) -> Result<Self, String> {
        let wrong = |what: &str| format!("{FOLDER}/{file}: {what}");
        let mut lines = text.lines();
        let title = lines
            .next()
            .and_then(|line| line.strip_prefix("# "))
            .ok_or_else(|| wrong("no title"))?;
        let (number, title) =
            title.split_once(". ").ok_or_else(|| wrong("the title has no number"))?;
        let number = number.parse().map_err(|_| wrong("the title has no number"))?;
        if file.get(..4).and_then(|digits| digits.parse().ok()) != Some(number) {
            return Err(wrong("its name and its title have different numbers"));
        }
        let facts = lines.nth(1).unwrap_or_default();
        let form = || wrong("line 3 is not `Date: YYYY-MM-DD. Status: ... Subject: ...`");
        let facts = facts.strip_suffix('.').ok_or_else(form)?;
        let (date, rest) = facts
            .strip_prefix("Date: ")
            .and_then(|facts| facts.split_once(". Status: "))
            .ok_or_else(form)?;
        let (status, subject) = rest.split_once(". Subject: ").ok_or_else(form)?;
        let [title, date, status, subject, file] =
            [title, date, status, subject, file].map(str::to_owned);
        Ok(Self { number, title, date, status, subject, file })
    }
}

/// All pages in the order of their numbers, of which none is missing.
fn decisions() -> Result<Vec<Decision>, String> {
    let folder = shell::root().join(FOLDER);
    let entries = fs::read_dir(&folder).map_err(|error| format!("{FOLDER}: {error}"))?;
    let mut pages = Vec::new();
    for entry in entries {
        let path = entry.map_err(|error| format!("{FOLDER}: {error}"))?.path();
        let name =
            path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        if name == "index.md" {
            continue;
        }
        let text =
            fs::read_to_string(&path).map_err(|error| format!("{FOLDER}/{name}: {error}"))?;
        pages.push(Decision::read(&name, &text)?);
    }
    pages.sort_by_key(|page| page.number);
    match pages.iter().zip(1..).find(|(page, number)| page.number != *number) {
        Some((page, number)) => Err(format!(
            "{FOLDER}: {} follows, but number {number} is missing or twice there",
            page.file
        )),
        None => Ok(pages),
    }
}

/// The text of `index.md`.
fn index(pages: &[Decision]) -> String {
    let mut subjects: BTreeMap<&str, Vec<&Decision>> = BTreeMap::new();
    for page in pages {
        subjects.entry(&page.subject).or_default().push(page);
    }
    let mut text = HEAD.to_owned();
    for (subject, pages) in subjects {
        let _ = write!(
            text,
            "\n## {subject}\n\n| number | decision | date | status |\n|---|---|---|---|\n"
        );
        for Decision { number, title, date, status, file, .. } in pages {
            let _ = writeln!(text, "| {number} | [{title}]({file}) | {date} | {status} |");
        }
    }
    text
}

/// `SUMMARY.md` with the list of these pages in place of the one that it has.
fn summary(before: &str, pages: &[Decision]) -> String {
    let entry = |Decision { number, title, file, .. }: &Decision| {
        (format!("{number}. {title}"), file.clone())
    };
    listed(before, "decisions", &pages.iter().map(entry).collect::<Vec<_>>())
}

/// `SUMMARY.md` with these pages of a folder below the folder's index. Each page is a title and the
/// name of a file.
fn listed(before: &str, folder: &str, pages: &[(String, String)]) -> String {
    let list = pages
        .iter()
        .map(|(title, file)| format!("  - [{title}]({folder}/{file})\n"))
        .collect::<String>();
    let (in_folder, its_index) = (format!("]({folder}/"), format!("]({folder}/index.md)"));
    let is_listed = |line: &&str| line.starts_with("  - [") && line.contains(&in_folder);
    let rest = before.lines().filter(|line| !is_listed(line)).map(|line| format!("{line}\n"));
    rest.map(|line| if line.contains(&its_index) { line + &list } else { line }).collect()
}

/// The boards' pages, in the order of the table in their generated index: its rows begin with
/// ``| [`name`](name.md) |``.
fn boards(index: &str) -> Vec<(String, String)> {
    let entry = |line: &str| {
        let (name, rest) = line.strip_prefix("| [`")?.split_once("`](")?;
        Some((name.to_owned(), rest.split_once(')')?.0.to_owned()))
    };
    index.lines().filter_map(entry).collect()
}

/// The files as they must be, by their path from the root.
fn expected() -> Result<[(&'static str, String); 2], String> {
    let pages = decisions()?;
    let read = |file: &str| {
        fs::read_to_string(shell::root().join(file)).map_err(|error| format!("{file}: {error}"))
    };
    let all = listed(&summary(&read(SUMMARY)?, &pages), "boards", &boards(&read(BOARDS)?));
    Ok([("docs/decisions/index.md", index(&pages)), (SUMMARY, all)])
}

/// Writes the index and the summary.
pub fn write() -> TaskResult {
    for (file, text) in expected()? {
        fs::write(shell::root().join(file), text).map_err(|error| format!("{file}: {error}"))?;
    }
    Ok(())
}

/// Fails where the index or the summary is not that of the pages.
pub fn check() -> TaskResult {
    for (file, text) in expected()? {
        let found = fs::read_to_string(shell::root().join(file))
            .map_err(|error| format!("{file}: {error}"))?;
        if found != text {
            return Err(format!("{file} is not that of the pages: run `cargo xtask decisions`"));
        }
    }
    shell::say("decisions: all are in the index");
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str =
        "# 7. Exact decimals\n\nDate: 2026-11-14. Status: in force. Subject: files.\n\nText.\n";

    #[test]
    fn a_page_is_read_from_its_first_three_lines() {
        let page = Decision::read("0007-exact.md", PAGE).unwrap();
        assert_eq!((page.number, &*page.title, &*page.date), (7, "Exact decimals", "2026-11-14"));
        assert_eq!((&*page.status, &*page.subject), ("in force", "files"));
        assert!(Decision::read("0008-exact.md", PAGE).unwrap_err().contains("different numbers"));
        let bare = PAGE.replace("Date: ", "");
        assert!(Decision::read("0007-exact.md", &bare).unwrap_err().contains("line 3"));
    }

    #[test]
    fn a_summary_lists_every_page_once_and_keeps_the_rest() {
        let before = "- [Decisions](decisions/index.md)\n  - [1. Old](decisions/0001-old.md)\n- [End](end.md)\n";
        let pages = [Decision::read("0007-exact.md", PAGE).unwrap()];
        let after = summary(before, &pages);
        assert_eq!(
            after,
            "- [Decisions](decisions/index.md)\n  - [7. Exact decimals](decisions/0007-exact.md)\n- [End](end.md)\n"
        );
        assert_eq!(summary(&after, &pages), after);
    }

    #[test]
    fn a_summary_lists_the_boards_of_their_index() {
        let index =
            "| board | |\n|---|---|\n| [`one`](one.md) | One |\n| [`two`](two.md) | Two |\n";
        let before = "- [Boards](boards/index.md)\n  - [old](boards/old.md)\n- [End](end.md)\n";
        assert_eq!(
            listed(before, "boards", &boards(index)),
            "- [Boards](boards/index.md)\n  - [one](boards/one.md)\n  - [two](boards/two.md)\n- [End](end.md)\n"
        );
    }

    #[test]
    fn the_committed_index_is_that_of_the_pages() {
        check().unwrap();
    }
}
