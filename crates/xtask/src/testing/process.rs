//! One test binary while it runs. Its output goes to a file, which shows when each test began.

use super::binaries::Binary;
use super::outcome::Counts;
use super::slices::Slice;
use crate::shell;
use std::fs::{self, File};
use std::io::{Read as _, Seek as _, SeekFrom};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// A binary that has been started.
pub struct Running {
    /// Which slice it runs.
    pub slice: usize,
    count: Option<usize>,
    child: Child,
    path: PathBuf,
    begun: Instant,
    seen: Seen,
    worked: Option<Duration>,
}

/// A binary that has ended.
pub struct EndedProcess {
    /// Its tests.
    pub counts: Counts,
    /// From its start to its end.
    pub took: Duration,
    /// Processor time of it and of the processes that it started, where the system tells it.
    pub worked: Option<Duration>,
    /// Seconds of each test.
    pub seconds: Vec<(String, f64)>,
    /// All that it printed.
    pub output: String,
}

/// The names of all tests of a binary.
///
/// # Errors
/// It cannot be started, or prints no list.
pub fn tests(binary: &Binary) -> Result<Vec<String>, String> {
    if !binary.lists {
        return Ok(Vec::new());
    }
    let output = command(binary).args(["--list", "--format", "terse"]).output();
    let output = output.map_err(|error| shell::cannot("start", &binary.program, &error))?;
    if !output.status.success() {
        return Err(format!("{} --list failed ({})", binary.id, output.status));
    }
    Ok(listed(&String::from_utf8_lossy(&output.stdout)))
}

/// `name: test` on a line each.
fn listed(text: &str) -> Vec<String> {
    text.lines().filter_map(|line| line.strip_suffix(": test")).map(str::to_owned).collect()
}

fn command(binary: &Binary) -> Command {
    let mut command = Command::new(&binary.program);
    command
        .args(&binary.arguments)
        .current_dir(&binary.folder)
        .env("PATH", shell::path())
        .envs(binary.environment.iter().cloned());
    command
}

impl Running {
    /// Starts a slice; its output goes to this file.
    ///
    /// # Errors
    /// The system's.
    pub fn start(
        binary: &Binary,
        slice: &Slice,
        place: usize,
        path: &Path,
    ) -> Result<Self, String> {
        let wrong = |error| shell::cannot("write", path, &error);
        let file = File::options().create(true).append(true).open(path).map_err(wrong)?;
        let mut command = command(binary);
        // One test at a time: a line is printed where each begins, and the other cores have other
        // slices.
        command.arg("--test-threads=1");
        if !slice.names.is_empty() {
            command.arg("--exact").args(&slice.names);
        }
        let errors = file.try_clone().map_err(wrong)?;
        let child = command.stdin(Stdio::null()).stdout(file).stderr(errors).spawn();
        let child = child.map_err(|error| shell::cannot("start", &binary.program, &error))?;
        let (count, path, begun) = (slice.count, path.to_owned(), Instant::now());
        Ok(Self { slice: place, count, child, path, begun, seen: Seen::default(), worked: None })
    }

    /// Looks at it; what it came to, where it has ended.
    ///
    /// # Errors
    /// The system's.
    pub fn poll(&mut self) -> Result<Option<EndedProcess>, String> {
        // After `try_wait` has seen the end, the system has forgotten the process.
        self.worked = processor_time(self.child.id()).or(self.worked);
        let status =
            self.child.try_wait().map_err(|error| format!("cannot wait for a test: {error}"))?;
        let now = self.begun.elapsed();
        self.seen
            .read(&self.path, now)
            .map_err(|error| shell::cannot("read", &self.path, &error))?;
        let Some(status) = status else { return Ok(None) };
        let output =
            fs::read(&self.path).map_err(|error| shell::cannot("read", &self.path, &error))?;
        let output = String::from_utf8_lossy(&output).into_owned();
        let counts = Counts::of(&output, status.success(), self.count);
        let mut seconds = self.seen.seconds(now);
        if self.count.is_none() {
            seconds = vec![(String::new(), now.as_secs_f64())];
        }
        Ok(Some(EndedProcess { counts, took: now, worked: self.worked, seconds, output }))
    }
}

/// The processor time of a process and of those of its children that it has waited for. Linux alone
/// tells it.
fn processor_time(process: u32) -> Option<Duration> {
    processor_time_in(&fs::read_to_string(format!("/proc/{process}/stat")).ok()?)
}

/// The sum of the fields 14 to 17 of `/proc/PID/stat`, in hundredths of a second. The second field,
/// the name of the program in parentheses, may contain spaces.
fn processor_time_in(stat: &str) -> Option<Duration> {
    let (_, fields) = stat.rsplit_once(") ")?;
    let times = fields.split(' ').skip(11).take(4);
    let times: Vec<u64> = times.map(str::parse).collect::<Result<_, _>>().ok()?;
    (times.len() == 4).then(|| Duration::from_millis(10 * times.iter().sum::<u64>()))
}

/// When the line `test NAME ... ` was seen of each test.
#[derive(Default)]
struct Seen {
    /// Up to where the file has been read: the beginning of its last line.
    offset: u64,
    begun: Vec<(String, Duration)>,
}

impl Seen {
    /// Reads what is new in the file.
    fn read(&mut self, path: &Path, now: Duration) -> std::io::Result<()> {
        let mut file = File::open(path)?;
        if file.metadata()?.len() <= self.offset {
            return Ok(());
        }
        file.seek(SeekFrom::Start(self.offset))?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        self.take(&bytes, now);
        Ok(())
    }

    fn take(&mut self, bytes: &[u8], now: Duration) {
        for line in bytes.split(|byte| *byte == b'\n') {
            let line = String::from_utf8_lossy(line);
            let Some((name, _)) =
                line.strip_prefix("test ").and_then(|rest| rest.split_once(" ... "))
            else {
                continue;
            };
            // What libtest adds to a name: `test name - should panic ... ok`.
            let name = name.split(" - ").next().unwrap_or(name);
            if self.begun.iter().all(|(seen, _)| seen != name) {
                self.begun.push((name.to_owned(), now));
            }
        }
        let whole = bytes.iter().rposition(|byte| *byte == b'\n').map_or(0, |place| place + 1);
        self.offset += whole as u64;
    }

    /// A test ends where the next one begins, the last one with its binary.
    fn seconds(&self, end: Duration) -> Vec<(String, f64)> {
        let ends = self.begun.iter().skip(1).map(|(_, begun)| *begun).chain([end]);
        let took = |((name, begun), end): (&(String, Duration), Duration)| {
            (name.clone(), end.saturating_sub(*begun).as_secs_f64())
        };
        self.begun.iter().zip(ends).map(took).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::slices::Needs;
    use super::{Binary, Running, Seen, Slice, listed, processor_time_in, tests};
    use std::time::Duration;

    #[test]
    fn tests_are_listed() {
        assert_eq!(listed("one: test\na::two: test\nfast: benchmark\n\n"), ["one", "a::two"]);
    }

    #[test]
    fn processor_time_is_that_of_a_process_and_its_children() {
        let stat = "7 (a ) name) S 1 2 3 4 5 6 7 8 9 10 100 20 3 4 20 0 1 0 99 1000";
        assert_eq!(processor_time_in(stat), Some(Duration::from_millis(1270)));
        assert_eq!(processor_time_in("7 (name) S 1"), None);
        assert_eq!(processor_time_in(""), None);
    }

    #[test]
    fn a_test_lasts_until_the_next_begins() {
        let mut seen = Seen::default();
        let at = Duration::from_secs;
        // The end of a line may come much later than its beginning.
        for (text, from, now) in [
            ("running 2 tests\ntest a ... ", 0, 1),
            ("test a ... ", 16, 3),
            ("test a ... words\nok\ntest b - should panic ... ", 16, 4),
            ("test b - should panic ... ok\n", 36, 9),
        ] {
            assert_eq!(seen.offset, from);
            seen.take(text.as_bytes(), at(now));
        }
        assert_eq!(seen.seconds(at(9)), [("a".to_owned(), 3.0), ("b".to_owned(), 5.0)]);
    }

    /// The binary of these tests is a test binary, too.
    #[test]
    fn a_slice_of_a_real_binary_runs() {
        let program = std::env::current_exe().unwrap();
        let folder = std::env::temp_dir();
        let (id, arguments) = ("xtask".to_owned(), Vec::new());
        let binary =
            Binary { id, program, arguments, folder, environment: Vec::new(), lists: true };
        let own = "testing::process::tests::tests_are_listed".to_owned();
        assert!(tests(&binary).unwrap().contains(&own));
        let path = std::env::temp_dir().join(format!("carrystep-xtask-{}.txt", std::process::id()));
        let slice = |names: Vec<String>, count| Slice {
            binary: 0,
            names,
            count,
            needs: Needs::OneCore,
            seconds: 0.0,
        };
        for (name, count, passed, failed) in
            [(&*own, 1, 1, 0), (&*own, 2, 1, 1), ("no such test", 1, 0, 1)]
        {
            let _ = std::fs::remove_file(&path);
            let mut running =
                Running::start(&binary, &slice(vec![name.to_owned()], Some(count)), 0, &path)
                    .unwrap();
            let ended = loop {
                if let Some(ended) = running.poll().unwrap() {
                    break ended;
                }
            };
            assert_eq!(
                (ended.counts.passed, ended.counts.failed),
                (passed, failed),
                "{}",
                ended.output
            );
            assert_eq!(ended.seconds.len(), passed);
        }
        std::fs::remove_file(&path).unwrap();
    }
}
