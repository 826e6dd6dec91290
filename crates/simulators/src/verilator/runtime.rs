//! Verilator's own code, compiled once. Each simulation is linked with it, and compiling it takes
//! about half of the processor time of a compilation.
//!
//! The object files are kept in the cache, under the hash of everything on which they depend. They
//! are copied into the folder of a compilation, and `make` compiles what is not there.

use super::{OPTIONS, hash};
use crate::cache;
use crate::tool::VERILATOR;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The object files, as Verilator's makefile calls them. One that a version of Verilator does not
/// have is not kept.
const OBJECTS: [&str; 2] = ["verilated.o", "verilated_threads.o"];

/// The kept object files of one kind of compilation.
pub struct Runtime(PathBuf);

impl Runtime {
    /// The object files for compilations with these options; none where a version is unknown.
    pub fn new(cache: &Path, options: &[&str]) -> Option<Self> {
        let versions = [version(VERILATOR.name)?, version("g++")?];
        let texts = versions.iter().map(String::as_str).chain(OPTIONS);
        let hash = hash(texts.chain(options.iter().copied()));
        Some(Self(cache.join(format!("runtime_{hash}"))))
    }

    /// Copies what is kept into Verilator's output folder, which may not exist yet. Returns the
    /// options of Verilator with which `make` takes the copies as they are: it would compile them
    /// anew, because the makefile of this compilation is newer.
    pub fn lend(&self, output: &Path) -> io::Result<Vec<String>> {
        let mut options = Vec::new();
        for name in OBJECTS {
            let kept = self.object(name);
            // A file that another user may have written is linked into nothing.
            if cache::holds(&kept).unwrap_or(false) {
                fs::create_dir_all(output)?;
                fs::copy(kept, output.join(name))?;
                options.extend(["-MAKEFLAGS".to_owned(), format!("-o {name}")]);
            }
        }
        Ok(options)
    }

    /// Keeps what is not kept yet. What cannot be kept is compiled again.
    pub fn keep(&self, output: &Path) {
        for name in OBJECTS {
            let (made, kept) = (output.join(name), self.object(name));
            if !kept.exists() && cache::only_ours(&made).is_ok() {
                // A rename is atomic: no other process finds half a file.
                let _ = fs::rename(made, kept);
            }
        }
    }

    fn object(&self, name: &str) -> PathBuf {
        self.0.with_extension(name)
    }
}

/// What a program prints about its version.
fn version(program: &str) -> Option<String> {
    let output = Command::new(program).arg("--version").output().ok()?;
    output.status.success().then(|| String::from_utf8_lossy(&output.stdout).into_owned())
}

#[cfg(test)]
mod tests {
    use super::{OBJECTS, Runtime};
    use std::fs;

    #[test]
    fn objects_are_lent_as_they_were_kept_and_only_for_the_same_options() {
        let cache = tempfile::tempdir().unwrap();
        let (first, second) = (cache.path().join("first"), cache.path().join("second"));
        let runtime = |option| Runtime::new(cache.path(), &["-CFLAGS", option]).unwrap();
        runtime("-DAXES=6").lend(&first).unwrap();
        assert!(!first.exists(), "nothing is kept yet");
        fs::create_dir(&first).unwrap();
        OBJECTS.iter().for_each(|name| fs::write(first.join(name), *name).unwrap());
        runtime("-DAXES=6").keep(&first);
        runtime("-DAXES=8").lend(&second).unwrap();
        assert!(!second.exists(), "other options have other objects");
        let options = runtime("-DAXES=6").lend(&second).unwrap();
        assert_eq!(options.concat(), "-MAKEFLAGS-o verilated.o-MAKEFLAGS-o verilated_threads.o");
        for name in OBJECTS {
            assert_eq!(fs::read_to_string(second.join(name)).unwrap(), name);
        }
    }

    #[cfg(unix)]
    #[test]
    fn an_object_that_others_can_write_is_not_lent() {
        use std::os::unix::fs::PermissionsExt as _;
        let cache = tempfile::tempdir().unwrap();
        let output = cache.path().join("output");
        fs::create_dir(&output).unwrap();
        fs::write(output.join(OBJECTS[0]), "planted").unwrap();
        let runtime = Runtime::new(cache.path(), &[]).unwrap();
        runtime.keep(&output);
        fs::set_permissions(runtime.object(OBJECTS[0]), fs::Permissions::from_mode(0o722)).unwrap();
        assert!(runtime.lend(&output).unwrap().is_empty());
        assert!(!output.join(OBJECTS[0]).exists());
    }
}
