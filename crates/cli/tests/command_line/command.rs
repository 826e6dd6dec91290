//! Runs the command in a temporary folder of its own.

use crate::schemas;
use std::path::{Path, PathBuf};
use std::process::{Child, Command};
use tempfile::TempDir;

/// Two short moves of one axis. Every line is unique, so that a test can replace one.
pub const GOOD: &str = r#"[machine]
clock_hz = 48_000_000
tick_ns = 1000
phases = 16
phase = "half"

[[machine.axis]]
name = "x"
steps_per_unit = 5
start_speed = 200
speed_limit = 1000
accel_limit = 5000
driver = "a4988"

[[move]]
profile = "ranade"
to = { x = 2 }

[[move]]
profile = "trapezoid"
time = 0.05
to = { x = -1.3 }
"#;

/// A folder with files in which the command runs, and a folder for its memory of boards.
pub struct Folder(TempDir, TempDir);

/// The end of a run.
pub struct Ran {
    pub status: i32,
    pub stdout: String,
    pub stderr: String,
}

impl Folder {
    /// An empty folder.
    pub fn new() -> Self {
        Self(tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap())
    }

    /// A folder with the move file `move.toml`.
    pub fn with_move(text: impl AsRef<[u8]>) -> Self {
        let folder = Self::new();
        folder.write("move.toml", text);
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The folder of the command's memory of boards: CARRYSTEP_STATE.
    pub fn state(&self) -> &Path {
        self.1.path()
    }

    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        let path = self.path(name);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }

    /// The names of everything in the folder, including folders, sorted.
    pub fn files(&self) -> Vec<String> {
        fn walk(folder: &Path, top: &Path, found: &mut Vec<String>) {
            for entry in std::fs::read_dir(folder).unwrap() {
                let path = entry.unwrap().path();
                found.push(path.strip_prefix(top).unwrap().display().to_string());
                if path.is_dir() {
                    walk(&path, top, found);
                }
            }
        }
        let mut found = Vec::new();
        walk(self.0.path(), self.0.path(), &mut found);
        found.sort();
        found
    }

    /// The length in bytes of the longest output that a process has begun in the folder. Such a file
    /// has no name yet, so its link in `/proc` ends with ` (deleted)`. Inputs have names.
    #[cfg(target_os = "linux")]
    pub fn begun_by(&self, child: &Child) -> Option<u64> {
        let files = std::fs::read_dir(format!("/proc/{}/fd", child.id())).ok()?.flatten();
        let inside = files.filter(|file| {
            std::fs::read_link(file.path()).is_ok_and(|to| {
                to.starts_with(self.0.path()) && to.to_string_lossy().ends_with(" (deleted)")
            })
        });
        inside.filter_map(|file| file.path().metadata().ok()).map(|there| there.len()).max()
    }

    /// Runs `carrystep` with these arguments, separated by spaces.
    pub fn run(&self, arguments: &str) -> Ran {
        self.output(Command::new(env!("CARGO_BIN_EXE_carrystep")).args(arguments.split(' ')))
    }

    /// Runs `carrystep` as the command is configured. With `--json` the output must be one document
    /// that fits its schema, whatever the exit status is.
    pub fn output(&self, command: &mut Command) -> Ran {
        let output = command
            .current_dir(self.0.path())
            .env("CARRYSTEP_STATE", self.state())
            .output()
            .unwrap();
        let text = |bytes: Vec<u8>| String::from_utf8(bytes).expect("the command writes UTF-8");
        let ran = Ran {
            status: output.status.code().expect("no signal ended the command"),
            stdout: text(output.stdout),
            stderr: text(output.stderr),
        };
        assert!(!ran.stderr.contains("panicked"), "{}", ran.stderr);
        if command.get_args().any(|argument| argument == "--json") {
            schemas::check(&ran.stdout);
        }
        assert!(!ran.stderr.contains('\u{1b}'), "colours where no terminal is: {}", ran.stderr);
        ran
    }
}

impl Ran {
    /// Asserts that the input was refused: status 2, nothing but a document on standard output, and
    /// this text in the message.
    #[track_caller]
    pub fn refuses(&self, says: &str) {
        assert_eq!(self.status, 2, "{}{}", self.stdout, self.stderr);
        assert!(
            self.stdout.is_empty() || schemas::check(&self.stdout)["passed"] == false,
            "{}",
            self.stdout
        );
        assert!(self.stderr.contains(says), "wanted: {says}\nfound:\n{}", self.stderr);
    }

    /// Asserts the same, at this place of a file.
    #[track_caller]
    pub fn refuses_at(&self, file: &str, (line, column): (usize, usize), says: &str) {
        self.refuses(says);
        let place = format!("[{file}:{line}:{column}]");
        assert!(self.stderr.contains(&place), "wanted: {place} {says}\nfound:\n{}", self.stderr);
    }
}

/// Replaces a part of a text by another, in which `^` marks the place of the error. Returns the
/// text without the mark, and line and column of the mark.
#[track_caller]
pub fn edit(text: &str, old: &str, new: &str) -> (String, (usize, usize)) {
    assert_eq!(text.matches(old).count(), 1, "{old}");
    let marked = text.replace(old, new);
    let (before, after) = marked.split_once('^').expect("a place is marked");
    let line = before.matches('\n').count() + 1;
    let column = before.chars().rev().take_while(|&c| c != '\n').count() + 1;
    (format!("{before}{after}"), (line, column))
}

/// Each row is a part of [`GOOD`], its replacement with `^` at the place of the error, and the
/// expected message. The refused run was to write four files and must leave none.
#[track_caller]
pub fn all_refused(rows: &[(&str, &str, &str)]) {
    for (old, new, says) in rows {
        let (text, place) = edit(GOOD, old, new);
        let folder = Folder::with_move(text);
        let ran = folder.run(
            "simulate move.toml --vcd out/a.vcd --save out/a.gtkw --csv out/a.csv --plot out/a.svg",
        );
        ran.refuses_at("move.toml", place, says);
        assert_eq!(folder.files(), ["move.toml"]);
    }
}
