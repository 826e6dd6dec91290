//! A folder with a sweep. Its name has characters that a shell, YAML and Slurm treat specially.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use tempfile::TempDir;

pub const CARRYSTEP: &str = env!("CARGO_BIN_EXE_carrystep");

pub struct Folder {
    _temporary: TempDir,
    path: PathBuf,
}

impl Folder {
    /// A folder with `the sweep.toml`. The case of number n has the value n % `tos.len()` of `tos`
    /// and, for each of those, all values of `drivers`.
    pub fn new(tos: &[u64], drivers: &[&str], time: &str) -> Self {
        let temporary = tempfile::tempdir().unwrap();
        let path = temporary.path().join("it's a \"folder\" of $HOME & 100%");
        std::fs::create_dir(&path).unwrap();
        let text = format!(
            r#"
move_file = '''
[machine]
clock_hz = 48_000_000
tick_ns = 1000
[[machine.axis]]
name = "x"
steps_per_unit = 5
start_speed = 200
speed_limit = 1000
accel_limit = 5000
driver = "{{{{ driver }}}}"
[[move]]
profile = "constant"
time = {time}
to = {{ x = {{{{ a_to }}}} }}
'''
[vary]
a_to = {tos:?}
driver = {drivers:?}
"#
        );
        std::fs::write(path.join("the sweep.toml"), text).unwrap();
        Self { _temporary: temporary, path }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.path.join(name)
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// The command, in this folder.
    pub fn carrystep(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(CARRYSTEP);
        command.args(arguments).current_dir(&self.path);
        command
    }

    /// The report of a single run that names the sweep file by its absolute path, as the scripts
    /// do: messages of failed cases quote the path.
    pub fn whole(&self) -> String {
        let file = self.path("the sweep.toml");
        let output = self.carrystep(&["sweep", file.to_str().unwrap(), "--json"]).output().unwrap();
        String::from_utf8(output.stdout).unwrap()
    }
}

/// Standard output of a run that must succeed.
#[track_caller]
pub fn succeeded(output: &Output) -> String {
    assert!(output.status.success(), "{}", shown(output));
    String::from_utf8(output.stdout.clone()).unwrap()
}

pub fn shown(output: &Output) -> String {
    let text = |bytes| String::from_utf8_lossy(bytes).into_owned();
    format!("{}\n{}{}", output.status, text(&output.stdout), text(&output.stderr))
}

/// The numbers of judged cases and of all cases in the file in which a shard keeps its progress.
pub fn kept(path: &Path) -> Option<(u64, u64)> {
    let text = std::fs::read_to_string(path).ok()?;
    let body: serde_json::Value = serde_json::from_str(text.split_once('\n')?.1).ok()?;
    let shard = |name: &str| body["report"]["shards"][0][name].as_u64();
    let all = (body["report"]["cases"].as_u64()? - shard("number")?) / shard("count")? + 1;
    let ranges = body["done"].as_array()?.iter();
    let lengths = ranges.map(|range| Some(range[1].as_u64()? - range[0].as_u64()?));
    Some((lengths.sum::<Option<u64>>()?, all))
}
