//! The mutants that nothing catches, as `docs/mutants.md` lists them: one line with the name, and
//! the reason below it.
//!
//! ```text
//! - `supervisor: eq B[3] always 1: wire silent = silence == WATCHDOG;`
//!   Proved equal: its module, for any inputs.
//! ```

use super::equal::Scope;
use crate::moves::root;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;
use std::sync::Mutex;

const END: &str = "<!-- ... to here -->";

/// The begin of the list of an engine: `shipped` or `full`.
fn begin(engine: &str) -> String {
    format!("<!-- `cargo xtask mutants --write` writes from here, {engine} ... -->")
}

/// Two tests write lists into the same page.
static PAGE: Mutex<()> = Mutex::new(());

/// The placeholder for a reason that nobody has found yet. The test fails as long as the page
/// contains it.
pub const NO_REASON: &str = "WHY IS IT HARMLESS?";

/// The beginning of a reason that is a proof and not written by a person.
pub const PROVED: &str = "Proved equal";

/// The reason for a mutant that is proved equal in this scope.
pub fn proved(scope: Scope) -> String {
    let of = match scope {
        Scope::Module => "its module, for any inputs",
        Scope::Memories => "its module with the memory in it, for any inputs",
        Scope::Engine => "the whole engine, for any inputs and any words in memory",
    };
    format!("{PROVED}: {of}.")
}

/// Reasons by the names of the mutants.
pub type Survivors = BTreeMap<String, String>;

fn page() -> PathBuf {
    root().join("docs/mutants.md")
}

/// Reads the listed survivors of an engine.
///
/// # Panics If the page has no list of it.
pub fn read(engine: &str) -> Survivors {
    let text = {
        let _alone = PAGE.lock();
        std::fs::read_to_string(page()).expect("docs/mutants.md")
    };
    let list = text
        .split_once(&begin(engine))
        .and_then(|(_, rest)| rest.split_once(END))
        .expect("the list in docs/mutants.md")
        .0;
    let items = list.split("\n- `").skip(1).filter_map(|item| item.split_once("`\n"));
    items
        .map(|(name, reason)| {
            (name.to_owned(), reason.split_whitespace().collect::<Vec<_>>().join(" "))
        })
        .collect()
}

/// Rewrites the list of an engine.
///
/// # Panics If the page cannot be written.
pub fn write(engine: &str, survivors: &Survivors) {
    let _alone = PAGE.lock();
    let text = std::fs::read_to_string(page()).expect("docs/mutants.md");
    let begin = begin(engine);
    let (before, rest) = text.split_once(&begin).expect("the list in docs/mutants.md");
    let (_, after) = rest.split_once(END).expect("the end of the list in docs/mutants.md");
    let mut list = String::new();
    for (name, reason) in survivors {
        // Writing to a string cannot fail.
        let _ = writeln!(list, "- `{name}`\n  {reason}");
    }
    std::fs::write(page(), format!("{before}{begin}\n\n{list}\n{END}{after}"))
        .expect("docs/mutants.md");
}
