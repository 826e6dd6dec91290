//! Answers of slow external tools, kept for the next run.
//!
//! A tool is asked in a folder, by its arguments and the files in that folder. Its answer is what
//! it prints and the files that it writes there. An answer is kept in the user's cache folder by
//! the SHA-256 of the whole question: the tools with their versions, the arguments, and name and
//! content of every file in the folder. So a changed input is another question, which the tool is
//! asked anew.
//!
//! Only an answer of a tool that ended with success is kept, and only where the caller finds it
//! complete: a solver that ran out of time would answer otherwise on a faster machine. A kept
//! answer carries the hash of its own content; a damaged one is not used. Of a simulation whose
//! output is compared with an expected one, only the hash of the output is kept ([`difference`]).
//!
//! With `CARRYSTEP_FRESH=1` no kept answer is used; `cargo xtask long` sets it.

mod identity;
mod known;
mod record;

pub use known::difference;

use crate::programs::Tool;
use record::Record;
use sha2::{Digest as _, Sha256};
use std::collections::BTreeMap;
use std::fs;
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus, Output};
use std::sync::Once;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::{Duration, SystemTime};

/// Asks all tools anew, whatever is kept.
const FRESH: &str = "CARRYSTEP_FRESH";

/// The folder of answers in the user's cache folder.
const FOLDER: &str = "answers";

/// An answer that has not been used for so long is removed.
const UNUSED: Duration = Duration::from_secs(30 * 24 * 3600);

static ASKED: AtomicUsize = AtomicUsize::new(0);
static KEPT: AtomicUsize = AtomicUsize::new(0);
static NEVER: AtomicBool = AtomicBool::new(false);

/// From now on this process asks every tool anew and keeps nothing: for a command whose user
/// expects the tools to be run.
pub fn never() {
    NEVER.store(true, Ordering::Relaxed);
}

/// How many answers this process has used. `cargo xtask test` reads the line of each rung.
pub fn summary() -> String {
    let kept = KEPT.load(Ordering::Relaxed);
    let all = kept + ASKED.load(Ordering::Relaxed);
    format!("{all} answers of tools, {kept} of them kept from an earlier run")
}

/// Prints [`summary`], if this process has used any answer.
pub fn say() {
    if KEPT.load(Ordering::Relaxed) + ASKED.load(Ordering::Relaxed) > 0 {
        // Nobody is left to tell if this fails.
        let _ = writeln!(io::stderr(), "{}", summary());
    }
}

/// Runs a tool to its end in a folder, or takes the answer that it gave before. An answer is kept
/// where the tool ended with success and `is_complete` agrees.
///
/// # Errors
/// The tool cannot be started, or a kept file cannot be written into the folder.
pub fn output(
    tool: &Tool,
    folder: &Path,
    arguments: &[&str],
    is_complete: impl FnOnce(&Output) -> bool,
) -> io::Result<Output> {
    Question { tool, folder, arguments, is_fresh: is_fresh(), answers: answers() }.ask(is_complete)
}

/// Whether every tool is asked anew.
fn is_fresh() -> bool {
    std::env::var_os(FRESH).is_some_and(|value| !value.is_empty() && value != "0")
}

/// The user's folder of answers. Where it cannot be used nothing is kept, and every tool is asked.
fn answers() -> Option<PathBuf> {
    if NEVER.load(Ordering::Relaxed) {
        return None;
    }
    let folder = carrystep_files::cache_folder_of(FOLDER).ok()?;
    static REMOVED: Once = Once::new();
    REMOVED.call_once(|| remove_unused(&folder, SystemTime::now()));
    Some(folder)
}

/// Removes the answers that nothing has used for long. What cannot be removed stays.
fn remove_unused(folder: &Path, now: SystemTime) {
    for file in fs::read_dir(folder).into_iter().flatten().flatten() {
        let used = file.metadata().and_then(|there| there.modified());
        if used.is_ok_and(|used| now.duration_since(used).is_ok_and(|since| since > UNUSED)) {
            let _ = fs::remove_file(file.path());
        }
    }
}

/// What a tool is asked.
struct Question<'a> {
    tool: &'a Tool,
    folder: &'a Path,
    arguments: &'a [&'a str],
    is_fresh: bool,
    /// Where answers are kept; none: they are not.
    answers: Option<PathBuf>,
}

impl Question<'_> {
    fn ask(&self, is_complete: impl FnOnce(&Output) -> bool) -> io::Result<Output> {
        let before = files(self.folder).ok();
        let kept = self.answers.as_deref().zip(before.as_ref());
        let place = kept.and_then(|(answers, before)| Some(answers.join(self.key(before)?)));
        if let Some(record) = place.as_deref().filter(|_| !self.is_fresh).and_then(Record::read) {
            KEPT.fetch_add(1, Ordering::Relaxed);
            record
                .files
                .iter()
                .try_for_each(|(name, content)| fs::write(self.folder.join(name), content))?;
            return Ok(Output {
                status: ExitStatus::default(),
                stdout: record.stdout,
                stderr: record.stderr,
            });
        }
        let output = self.run()?;
        ASKED.fetch_add(1, Ordering::Relaxed);
        if let (Some(place), Some(before)) = (place, before)
            && output.status.success()
            && is_complete(&output)
            && let Ok(mut after) = files(self.folder)
        {
            after.retain(|name, content| before.get(name) != Some(content));
            let (stdout, stderr) = (output.stdout.clone(), output.stderr.clone());
            // An answer that cannot be kept is asked for again.
            let _ = Record { stdout, stderr, files: after }.write(&place);
        }
        Ok(output)
    }

    fn run(&self) -> io::Result<Output> {
        let start =
            |name: &str| Command::new(name).args(self.arguments).current_dir(self.folder).output();
        // The same tools from pip have a name of their own.
        start(self.tool.name).or_else(|error| match error.kind() {
            io::ErrorKind::NotFound => start(&identity::name_of_pip(self.tool.name)),
            _ => Err(error),
        })
    }

    /// The hash of all that the answer depends on. A tool of which nothing is known has none.
    fn key(&self, files: &BTreeMap<String, Vec<u8>>) -> Option<String> {
        let mut hash = Sha256::new();
        // Each part with its length: no two questions are one text.
        let mut add = |part: &[u8]| {
            hash.update((part.len() as u64).to_le_bytes());
            hash.update(part);
        };
        add(identity::of(self.tool)?.as_bytes());
        add(&self.arguments.len().to_le_bytes());
        self.arguments.iter().for_each(|argument| add(argument.as_bytes()));
        for (name, content) in files {
            add(name.as_bytes());
            add(content);
        }
        Some(record::hex(&hash.finalize()))
    }
}

/// Name and content of all files in a folder; an error where there is anything else in it.
fn files(folder: &Path) -> io::Result<BTreeMap<String, Vec<u8>>> {
    let mut all = BTreeMap::new();
    for file in fs::read_dir(folder)? {
        let file = file?;
        let name = file.file_name().into_string().map_err(|_| io::ErrorKind::InvalidData)?;
        if !file.file_type()?.is_file() {
            return Err(io::ErrorKind::Unsupported.into());
        }
        all.insert(name, fs::read(file.path())?);
    }
    Ok(all)
}

#[cfg(test)]
#[path = "kept/tests.rs"]
mod tests;
