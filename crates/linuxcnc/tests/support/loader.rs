//! The component as HAL loads it, with a HAL of the test's own (`bench/hal_bench.c`).

use carrystep_linuxcnc::component;
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};
use tempfile::TempDir;

/// Flags of the sanitizers of both threads.
pub const SANITIZERS: [&str; 2] = ["-fsanitize=address,undefined", "-fsanitize=thread"];

/// A program with the component.
pub struct Loader {
    pub program: PathBuf,
    _folder: TempDir,
}

impl Loader {
    /// Compiles it with these flags.
    pub fn new(flags: &[&str]) -> Self {
        let folder = TempDir::new().unwrap();
        for (name, text) in component() {
            fs::write(folder.path().join(name), text).unwrap();
        }
        for (name, text) in [
            ("rtapi.h", include_str!("../bench/hal/rtapi.h")),
            ("rtapi_app.h", include_str!("../bench/hal/rtapi_app.h")),
            ("hal.h", include_str!("../bench/hal/hal.h")),
            ("hal_bench.c", include_str!("../bench/hal_bench.c")),
            ("spidev_stand_in.c", include_str!("../bench/spidev_stand_in.c")),
        ] {
            fs::write(folder.path().join(name), text).unwrap();
        }
        let sources = component().map(|(name, _)| name).filter(|name| name.ends_with(".c"));
        let output = Command::new(std::env::var("CC").unwrap_or_else(|_| "gcc".to_owned()))
            .current_dir(folder.path())
            .args(["-std=gnu99", "-O1", "-g", "-Wall", "-Wextra", "-Werror"])
            .args(["-DCARRYSTEP_SLOTS=64", "-I.", "hal_bench.c"])
            .args(sources.filter(|name| !name.contains("feeder")))
            .args(flags)
            .args(["-lm", "-lpthread", "-o", "hal_bench"])
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        Self { program: folder.path().join("hal_bench"), _folder: folder }
    }

    /// Runs it to its end, and returns what it says.
    pub fn say(&self, words: &[&str]) -> String {
        said(&Command::new(&self.program).args(words).output().unwrap())
    }
}

/// What a program that must succeed has said.
pub fn said(output: &Output) -> String {
    let all = [&output.stdout[..], &output.stderr[..]].concat();
    let text = String::from_utf8_lossy(&all).into_owned();
    assert!(output.status.success(), "{:?}: {text}", output.status);
    text
}
