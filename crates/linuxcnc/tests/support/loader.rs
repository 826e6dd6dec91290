//! The component as HAL loads it, with a HAL of the test's own (`bench/hal_bench.c`).

use super::compiled::compiled;
use carrystep_linuxcnc::component;
use std::path::PathBuf;
use std::process::{Command, Output};

/// Flags of the sanitizers of both threads.
pub const SANITIZERS: [&str; 2] = ["-fsanitize=address,undefined", "-fsanitize=thread"];

/// A program with the component.
pub struct Loader {
    pub program: PathBuf,
}

impl Loader {
    /// Compiles it with these flags.
    pub fn new(flags: &[&str]) -> Self {
        let own = [
            ("rtapi.h", include_str!("../bench/hal/rtapi.h")),
            ("rtapi_app.h", include_str!("../bench/hal/rtapi_app.h")),
            ("hal.h", include_str!("../bench/hal/hal.h")),
            ("hal_bench.c", include_str!("../bench/hal_bench.c")),
            ("spidev_stand_in.c", include_str!("../bench/spidev_stand_in.c")),
        ];
        let files: Vec<_> =
            component().chain(own).map(|(name, text)| (name, text.to_owned())).collect();
        let sources = component().map(|(name, _)| name);
        let mut arguments = vec!["-std=gnu99", "-O1", "-g", "-Wall", "-Wextra", "-Werror"];
        arguments.extend(["-DCARRYSTEP_SLOTS=64", "-I.", "hal_bench.c"]);
        arguments.extend(sources.filter(|name| name.ends_with(".c") && !name.contains("feeder")));
        arguments.extend(flags);
        arguments.extend(["-lm", "-lpthread"]);
        Self { program: compiled(&files, &arguments) }
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
