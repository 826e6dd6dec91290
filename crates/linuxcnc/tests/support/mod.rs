//! Compiles the component's C files with a bench that a test talks with through pipes.
#![allow(dead_code, reason = "each test uses a part")]

mod compiled;
pub mod line;
pub mod loader;
pub mod rounds;
pub mod signals;
pub mod world;

use carrystep_linuxcnc::component;
use compiled::compiled;
use std::io::{BufRead, BufReader, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::OnceLock;

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
}

impl Bench {
    /// Compiles a bench; `change` may alter each file.
    pub fn new(text: &str, change: impl Fn(&str, &str) -> String) -> Self {
        let component = component().map(|(name, text)| (name, change(name, text)));
        let own = [
            ("bench.c", text),
            ("spi_bench.c", include_str!("../bench/spi_bench.c")),
            ("spi_bench.h", include_str!("../bench/spi_bench.h")),
        ]
        .map(|(name, text)| (name, text.to_owned()));
        let files: Vec<_> = component.chain(own).collect();
        let arguments = [&FLAGS[..], &["bench.c"], &FILES, &["-lpthread"]].concat();
        Self { program: compiled(&files, &arguments) }
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
