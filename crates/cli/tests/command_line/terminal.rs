//! What a user sees on a terminal: colours, progress, errors that begin with a word, tables of 80
//! columns.

use crate::command::{Folder, GOOD};
use serialport::{SerialPort as _, TTYPort};
use std::fs::File;
use std::io::{Read as _, Write as _};
use std::process::{Child, Command, ExitStatus};
use std::time::{Duration, Instant};

/// A time-out that is far longer than anything that these tests wait for.
const PATIENCE: Duration = Duration::from_secs(120);

/// A pseudo-terminal on which a command runs with all three of its streams.
pub struct Screen {
    ours: TTYPort,
    /// Held open: after the last close of this end, what a quick command has written and nobody has
    /// read yet would be lost.
    _theirs: TTYPort,
    child: Child,
    seen: String,
    looked_at: usize,
}

impl Screen {
    /// Starts a command on a new terminal.
    pub fn start(command: &mut Command) -> Self {
        let (mut ours, theirs) = TTYPort::pair().unwrap();
        let name = theirs.name().unwrap();
        ours.set_timeout(Duration::from_millis(20)).unwrap();
        let open = || File::options().read(true).write(true).open(&name).unwrap();
        let child = command
            .stdin(open())
            .stdout(open())
            .stderr(open())
            .env("TERM", "xterm")
            .spawn()
            .unwrap();
        Self { ours, _theirs: theirs, child, seen: String::new(), looked_at: 0 }
    }

    /// Reads the available output; returns false if there is none.
    fn look(&mut self) -> bool {
        let mut bytes = [0; 4096];
        let come = self.ours.read(&mut bytes).unwrap_or(0);
        self.seen.push_str(&String::from_utf8_lossy(&bytes[..come]));
        come > 0
    }

    /// Reads until this text appears after the text that was waited for before.
    #[track_caller]
    pub fn waits_for(&mut self, text: &str) {
        let begun = Instant::now();
        loop {
            if let Some(at) = self.seen[self.looked_at..].find(text) {
                self.looked_at += at + text.len();
                return;
            }
            assert!(
                self.look() || begun.elapsed() < PATIENCE,
                "waited for {text:?}, seen:\n{}",
                self.seen
            );
            if begun.elapsed() > PATIENCE {
                panic!("waited for {text:?}, seen:\n{}", self.seen);
            }
        }
    }

    pub fn types(&mut self, text: &str) {
        self.ours.write_all(text.as_bytes()).unwrap();
    }

    /// Waits for the command to end, and reads its remaining output.
    pub fn ends(&mut self) -> ExitStatus {
        let begun = Instant::now();
        loop {
            let ended = self.child.try_wait().unwrap();
            let more = self.look();
            match ended {
                Some(status) if !more => return status,
                _ => assert!(begun.elapsed() < PATIENCE, "it does not end, seen:\n{}", self.seen),
            }
        }
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // The command may have ended already.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn command(folder: &Folder, arguments: &str) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_carrystep"));
    command
        .args(arguments.split(' '))
        .current_dir(folder.path(""))
        .env_remove("NO_COLOR")
        .env_remove("CLICOLOR_FORCE");
    command
}

#[test]
fn verdicts_have_colours_on_a_terminal_that_wants_them() {
    let folder = Folder::with_move(GOOD);
    assert_eq!(folder.run("simulate move.toml --vcd a.vcd").status, 0);
    folder.write("longer.toml", GOOD.replace("x = 2", "x = 3"));
    let shown = |command: &mut Command| {
        let mut screen = Screen::start(command);
        screen.ends();
        std::mem::take(&mut screen.seen)
    };
    let (red, green) =
        ("\u{1b}[1m\u{1b}[31mFAILED\u{1b}[0m", "\u{1b}[1m\u{1b}[32mALL HOLDS\u{1b}[0m");
    let failed = shown(&mut command(&folder, "check a.vcd longer.toml"));
    assert!(failed.contains(red), "{failed}");
    let held = shown(&mut command(&folder, "simulate move.toml"));
    assert!(held.contains(green), "{held}");
    for plain in [
        shown(command(&folder, "check a.vcd longer.toml").env("NO_COLOR", "1")),
        folder.run("check a.vcd longer.toml").stdout,
        shown(command(&folder, "plan nothing.toml").env("NO_COLOR", "1")),
    ] {
        assert!(!plain.contains('\u{1b}'), "{plain:?}");
    }
}

#[test]
fn error_message_begins_with_the_word_error() {
    let folder = Folder::with_move(GOOD.replace("phases = 16", "phases = 3"));
    let ran = folder.run("plan move.toml");
    assert!(
        ran.stderr.starts_with("error: 3 phases: a tick has 1, 4 or 16 phases\n"),
        "{}",
        ran.stderr
    );
    let mut screen = Screen::start(command(&folder, "plan move.toml").env("NO_COLOR", "1"));
    screen.ends();
    assert!(screen.seen.starts_with("error: 3 phases"), "{}", screen.seen);
    assert!(!screen.seen.contains('\u{d7}'), "{}", screen.seen);
}

/// The move makes one step per quarter of an hour of machine time, and the level simulates every
/// clock, so no edge comes during the test. The progress must be displayed nevertheless.
#[test]
fn progress_is_shown_even_if_no_edge_comes() {
    let crawl = GOOD.replace("start_speed = 200", "start_speed = 1").replacen(
        "profile = \"ranade\"\nto = { x = 2 }",
        "profile = \"constant\"\ntime = 1_000_000\nto = { x = 200 }",
        1,
    );
    let folder = Folder::with_move(crawl);
    for arguments in
        ["simulate move.toml --core parallel --level model", "simulate move.toml --level rust-hdl"]
    {
        let mut screen = Screen::start(&mut command(&folder, arguments));
        screen.waits_for(if arguments.contains("model") { "model " } else { "rust-hdl " });
        screen.waits_for("  0 % ");
        // The run has 48 million million clocks, which take days at any speed of this level.
        screen.waits_for(" h ");
        screen.waits_for("left at ");
        screen.waits_for(" k clocks/s");
    }
}

#[test]
fn tables_fit_into_80_columns() {
    let folder = Folder::new();
    let demo = folder.run("demo --out demo");
    assert_eq!(demo.status, 0, "{}", demo.stderr);
    for ran in [
        demo,
        folder.run("plan demo/demo.toml"),
        folder.run("plan demo/demo.toml --segments"),
        folder.run("simulate demo/demo.toml --level model"),
        folder.run("simulate demo/demo.toml --core parallel"),
    ] {
        for line in ran.stdout.lines() {
            assert!(line.chars().count() <= 80, "{} columns: {line}", line.chars().count());
        }
    }
    let plan = folder.run("plan demo/demo.toml").stdout;
    assert!(plan.contains("316.472 of 500 mm/s ") && plan.contains(" deg/s^2"), "{plan}");
}
