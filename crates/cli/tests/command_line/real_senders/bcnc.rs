//! The sender of the real bCNC, without its window: its installation from PyPI, and a run of it.

use crate::command::Folder;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// bCNC, and the packages that its sender imports. The window needs more of them.
const WANTED: [&str; 4] = ["bCNC==0.9.16", "pyserial==3.5", "numpy==2.2.6", "svgelements==1.9.6"];

/// The virtual environment with these packages; it is made if it is not there.
fn installed() -> PathBuf {
    let there = Path::new(env!("CARGO_TARGET_TMPDIR")).join("bcnc");
    // It has the name of its folder in its files, so that it cannot be moved; a mark says that it is
    // whole.
    let mark = there.join("whole");
    let wanted = WANTED.join("\n");
    if fs::read_to_string(&mark).is_ok_and(|found| found == wanted) {
        return there;
    }
    let _ = fs::remove_dir_all(&there);
    run(Command::new("python3").args(["-m", "venv"]).arg(&there));
    let pip = ["-m", "pip", "install", "--quiet", "--no-deps"];
    run(Command::new(there.join("bin/python")).args(pip).args(WANTED));
    fs::write(mark, wanted).unwrap();
    there
}

/// Streams the program `job.ngc` of the folder to this port, with an override and a pause. Returns
/// what bCNC knows at the end.
pub fn streams(folder: &Folder, port: &Path) -> Value {
    let python = installed().join("bin/python");
    let where_is = "import sysconfig; print(sysconfig.get_path('purelib'), end='')";
    let library = run(Command::new(&python).args(["-c", where_is]));
    let script = folder.path("bcnc.py");
    fs::write(&script, include_str!("bcnc.py")).unwrap();
    // bCNC keeps its configuration at home.
    let said = run(Command::new(python)
        .arg(script)
        .arg(Path::new(&library).join("bCNC"))
        .arg(port)
        .arg(folder.path("job.ngc"))
        .env("HOME", folder.path("")));
    let last = said.lines().last().expect("bCNC says nothing");
    serde_json::from_str(last).expect(&said)
}

/// Runs a command that must succeed, and returns its output.
fn run(command: &mut Command) -> String {
    let ran = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let [said, error] = [&ran.stdout, &ran.stderr].map(|text| String::from_utf8_lossy(text));
    assert!(ran.status.success(), "{command:?}: {said}{error}");
    said.into_owned()
}
