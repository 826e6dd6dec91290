//! Programs in C that tests start, compiled once for all test programs that need the same one.

use sha2::{Digest as _, Sha256};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The program that GCC makes of these files (name and content) with these arguments. Cargo's folder
/// for files of tests keeps it under the hash of both.
pub fn compiled(files: &[(&str, String)], arguments: &[&str]) -> PathBuf {
    let compiler = std::env::var("CC").unwrap_or_else(|_| "gcc".to_owned());
    let version = Command::new(&compiler).arg("--version").output();
    let version =
        version.unwrap_or_else(|error| panic!("{compiler} (apt-get install gcc): {error}")).stdout;
    let mut hash = Sha256::new();
    let texts = files.iter().flat_map(|(name, text)| [name.as_bytes(), text.as_bytes()]);
    let arguments_of = arguments.iter().map(|argument| argument.as_bytes());
    for text in [compiler.as_bytes(), &version].into_iter().chain(texts).chain(arguments_of) {
        // The length keeps texts apart that follow each other.
        hash.update((text.len() as u64).to_le_bytes());
        hash.update(text);
    }
    let name: String = hash.finalize().iter().map(|byte| format!("{byte:02x}")).collect();
    let kept = Path::new(env!("CARGO_TARGET_TMPDIR"));
    let program = kept.join(name);
    if !program.exists() {
        // Cargo makes this folder when it compiles tests; somebody may have removed it since.
        fs::create_dir_all(kept).unwrap();
        let folder = tempfile::tempdir_in(kept).unwrap();
        for (name, text) in files {
            fs::write(folder.path().join(name), text).unwrap();
        }
        let output = Command::new(&compiler)
            .current_dir(folder.path())
            .args(arguments)
            .args(["-o", "program"])
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        // Another test program that makes the same one finds it whole, or not at all.
        fs::rename(folder.path().join("program"), &program).unwrap();
    }
    program
}
