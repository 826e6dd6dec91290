//! Compiles the component's C files with a bench that a test talks with through pipes.
#![allow(dead_code, reason = "each test uses a part")]

pub mod line;
pub mod loader;
pub mod rounds;
pub mod signals;
pub mod world;

use carrystep_linuxcnc::component;
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::OnceLock;
use tempfile::TempDir;

const FLAGS: [&str; 14] = [
    "-std=c99",
    "-D_DEFAULT_SOURCE",
    "-Wl,--wrap=ioctl",
    "-O1",
    "-g",
    "-Wall",
    "-Wextra",
    "-Wpedantic",
    "-Werror",
    "-Wconversion",
    "-Wshadow",
    "-fsanitize=address,undefined",
    "-fno-sanitize-recover=all",
    "-DCARRYSTEP_SLOTS=64",
];

/// What knows neither HAL nor a thread, and the SPI.
const FILES: [&str; 15] = [
    "carrystep_servo.c",
    "carrystep_glide.c",
    "carrystep_blocks.c",
    "carrystep_feedback.c",
    "carrystep_facts.c",
    "carrystep_look.c",
    "carrystep_latches.c",
    "carrystep_ring.c",
    "carrystep_trim.c",
    "carrystep_pump.c",
    "carrystep_session.c",
    "carrystep_frame.c",
    "carrystep_time.c",
    "carrystep_spi.c",
    "spi_bench.c",
];

/// A bench, compiled with the sanitizers of GCC.
pub struct Bench {
    program: PathBuf,
    _folder: TempDir,
}

impl Bench {
    /// Compiles a bench; `change` may alter each file.
    pub fn new(text: &str, change: impl Fn(&str, &str) -> String) -> Self {
        let folder = tempfile::tempdir().unwrap();
        for (name, text) in component() {
            std::fs::write(folder.path().join(name), change(name, text)).unwrap();
        }
        for (name, text) in [
            ("bench.c", text),
            ("spi_bench.c", include_str!("../bench/spi_bench.c")),
            ("spi_bench.h", include_str!("../bench/spi_bench.h")),
        ] {
            std::fs::write(folder.path().join(name), text).unwrap();
        }
        let program = folder.path().join("bench");
        let compiler = std::env::var("CC").unwrap_or_else(|_| "gcc".to_owned());
        let output = Command::new(&compiler)
            .current_dir(folder.path())
            .args(FLAGS)
            .arg("bench.c")
            .args(FILES)
            .args(["-lpthread", "-o", "bench"])
            .output()
            .unwrap_or_else(|error| panic!("{compiler} (apt-get install gcc): {error}"));
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        Self { program, _folder: folder }
    }

    /// The bench of blocks, ring and trim.
    pub fn parts() -> &'static Self {
        static BENCH: OnceLock<Bench> = OnceLock::new();
        BENCH.get_or_init(|| {
            Self::new(include_str!("../bench/parts_bench.c"), |_, text| text.to_owned())
        })
    }

    /// The whole component but HAL and thread.
    pub fn component() -> &'static Self {
        static BENCH: OnceLock<Bench> = OnceLock::new();
        BENCH.get_or_init(|| {
            Self::new(include_str!("../bench/component_bench.c"), |_, text| text.to_owned())
        })
    }

    /// Starts it in a mode.
    pub fn run(&self, mode: &str) -> Running {
        let mut child = Command::new(&self.program)
            .arg(mode)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let to = child.stdin.take();
        let from = BufReader::new(child.stdout.take().unwrap());
        Running { child, to, from }
    }
}

/// A bench that runs.
pub struct Running {
    child: Child,
    to: Option<ChildStdin>,
    from: BufReader<ChildStdout>,
}

impl Running {
    /// Sends a line and returns the line that answers it.
    pub fn say(&mut self, words: &str) -> String {
        writeln!(self.to.as_mut().unwrap(), "{words}").unwrap();
        let mut line = String::new();
        self.from.read_line(&mut line).unwrap();
        assert!(line.ends_with('\n'), "the bench has ended at: {words}");
        line.trim_end().to_owned()
    }

    /// Ends the bench; it must report no error, and no leak of memory.
    pub fn end(mut self) {
        drop(self.to.take());
        assert!(self.child.wait().unwrap().success());
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
