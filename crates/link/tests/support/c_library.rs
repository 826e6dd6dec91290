//! The C library, compiled with strict warnings into a client that receives its commands through a
//! pipe.

use super::client::{Client, SLOTS};
use carrystep_link::C_LIBRARY;
use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::OnceLock;
use tempfile::TempDir;

pub const FLAGS: [&str; 8] =
    ["-std=c99", "-O2", "-Wall", "-Wextra", "-Wpedantic", "-Werror", "-Wconversion", "-Wshadow"];

/// A temporary directory with the library, in which programs are compiled.
pub struct Folder(TempDir);

impl Folder {
    /// Copies the library; `change` may alter the text of each file.
    pub fn new(change: impl Fn(&str, &str) -> String) -> Self {
        let folder = Self(tempfile::tempdir().expect("a temporary folder"));
        for (name, text) in C_LIBRARY {
            folder.write(name, &change(name, text));
        }
        folder
    }

    pub fn write(&self, name: &str, text: &str) {
        let path = self.0.path().join(name);
        std::fs::create_dir_all(path.parent().expect("a folder")).expect("a folder is made");
        std::fs::write(path, text).expect("a file is written");
    }

    /// Compiles; returns the compiler's messages if it fails.
    pub fn compile(&self, arguments: &[&str]) -> Result<PathBuf, String> {
        let compiler = std::env::var("CC").unwrap_or_else(|_| "gcc".to_owned());
        let program = self.0.path().join("program");
        let mut command = Command::new(&compiler);
        command
            .current_dir(self.0.path())
            .args(FLAGS)
            .arg("-I.")
            .args(arguments)
            .arg("-o")
            .arg(&program);
        let output = command
            .output()
            .unwrap_or_else(|error| panic!("{compiler} (apt-get install gcc): {error}"));
        if output.status.success() {
            Ok(program)
        } else {
            Err(String::from_utf8_lossy(&output.stderr).into_owned())
        }
    }
}

fn build(arguments: &[&str], change: impl Fn(&str, &str) -> String) -> (Folder, PathBuf) {
    let folder = Folder::new(change);
    folder.write("link_bench.c", include_str!("../bench/link_bench.c"));
    let slots = format!("-DCARRYSTEP_SLOTS={SLOTS}");
    let files = [
        "link_bench.c",
        "carrystep_feeder.c",
        "carrystep_session.c",
        "carrystep_frame.c",
        slots.as_str(),
    ];
    let program =
        folder.compile(&[&files, arguments].concat()).unwrap_or_else(|words| panic!("{words}"));
    (folder, program)
}

/// The running C client.
pub struct CClient {
    child: Child,
    to: ChildStdin,
    from: BufReader<ChildStdout>,
    _folder: Option<Folder>,
}

impl CClient {
    /// A client of the unchanged library, which is compiled once for all tests.
    pub fn shared() -> Self {
        static PROGRAM: OnceLock<(Folder, PathBuf)> = OnceLock::new();
        let (_, program) = PROGRAM.get_or_init(|| build(&[], |_, text| text.to_owned()));
        Self::run(program, None)
    }

    /// A client with additional compiler arguments and changed files.
    pub fn with(arguments: &[&str], change: impl Fn(&str, &str) -> String) -> Self {
        let (folder, program) = build(arguments, change);
        Self::run(&program, Some(folder))
    }

    fn run(program: &Path, folder: Option<Folder>) -> Self {
        let mut child = Command::new(program)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the bench runs");
        let to = child.stdin.take().expect("a pipe");
        let from = BufReader::new(child.stdout.take().expect("a pipe"));
        Self { child, to, from, _folder: folder }
    }
}

impl Client for CClient {
    fn say(&mut self, words: &str) -> String {
        writeln!(self.to, "{words}").expect("the bench listens");
        let mut line = String::new();
        self.from.read_line(&mut line).expect("the bench speaks");
        assert!(line.ends_with('\n'), "the bench has ended at: {words}");
        line.trim_end_matches('\n').to_owned()
    }
}

impl Drop for CClient {
    fn drop(&mut self) {
        // The client ends by itself when its input is closed; this ends one that hangs.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
