//! The mutants that nothing catches, as `docs/mutants.md` lists them: a line for the name, the reason below it.
//!
//! ```text
//! - `watch: eq B[3] always 1: wire silent = silence == WATCHDOG;`
//!   Proved equal: its module, for any inputs.
//! ```

use super::equal::Scope;
use crate::moves::root;
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::PathBuf;

const BEGIN: &str = "<!-- `cargo xtask mutants --write` writes from here ... -->";
const END: &str = "<!-- ... to here -->";

/// What stands where nobody has found a reason yet; the test fails as long as it does.
pub const NO_REASON: &str = "WHY IS IT HARMLESS?";

/// Before what is proved, not written by a person.
pub const PROVED: &str = "Proved equal";

/// How a mutant is proved to be the engine, in words.
pub fn proved(scope: Scope) -> String {
    let of = match scope {
        Scope::Module => "its module, for any inputs",
        Scope::Memories => "its module with the memory in it, for any inputs",
        Scope::Engine => "the whole engine, for any inputs and any words in memory",
    };
    format!("{PROVED}: {of}.")
}

/// Reasons by name.
pub type Survivors = BTreeMap<String, String>;

fn page() -> PathBuf {
    root().join("docs/mutants.md")
}

/// The listed survivors.
///
/// # Panics
/// Where the page has lost its list.
pub fn read() -> Survivors {
    let text = std::fs::read_to_string(page()).expect("docs/mutants.md");
    let list =
        text.split_once(BEGIN).and_then(|(_, rest)| rest.split_once(END)).expect("the list in docs/mutants.md").0;
    let items = list.split("\n- `").skip(1).filter_map(|item| item.split_once("`\n"));
    items.map(|(name, reason)| (name.to_owned(), reason.split_whitespace().collect::<Vec<_>>().join(" "))).collect()
}

/// Writes the list anew.
///
/// # Panics
/// Where the page cannot be written.
pub fn write(survivors: &Survivors) {
    let text = std::fs::read_to_string(page()).expect("docs/mutants.md");
    let (before, rest) = text.split_once(BEGIN).expect("the list in docs/mutants.md");
    let (_, after) = rest.split_once(END).expect("the end of the list in docs/mutants.md");
    let mut list = String::new();
    for (name, reason) in survivors {
        // Writing to a string cannot fail.
        let _ = writeln!(list, "- `{name}`\n  {reason}");
    }
    std::fs::write(page(), format!("{before}{BEGIN}\n\n{list}\n{END}{after}")).expect("docs/mutants.md");
}
