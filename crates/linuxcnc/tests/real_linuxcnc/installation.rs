//! The real LinuxCNC: the component among its modules, and a run of it as a user without rights.

use crate::{HORIZON_MS, PERIODS, PRIORITIES};
use carrystep_files::Machine;
use carrystep_linuxcnc::{Configuration, Homing, Wishes, component};
use std::fs::{self, Permissions};
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

/// Where LinuxCNC looks for modules.
const MODULES: &str = "/usr/lib/linuxcnc/modules";

/// The component in LinuxCNC's folder of modules, while this exists.
pub struct Module(PathBuf);

impl Module {
    pub fn build(folder: &Path) -> Self {
        let own = folder.join("component");
        fs::create_dir(&own).unwrap();
        for (name, text) in component() {
            fs::write(own.join(name), text).unwrap();
        }
        run(Command::new("make").current_dir(&own));
        let to = Path::new(MODULES).join("carrystep.so");
        fs::copy(own.join("carrystep.so"), &to)
            .unwrap_or_else(|error| panic!("{}: {error}", to.display()));
        Self(to)
    }
}

impl Drop for Module {
    fn drop(&mut self) {
        let _ = fs::remove_file(&self.0);
    }
}

fn run(command: &mut Command) {
    let output = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    let said = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{command:?}: {said}");
}

/// Gives a thread, or with `-a` all threads of a process, a priority under SCHED_FIFO. Without the
/// right to it, nothing changes.
pub fn prefer(which: &[&str], priority: &str, id: &str) {
    let _ = Command::new("chrt").args(which).args(["-f", "-p", priority, id]).output();
}

/// LinuxCNC's real-time process that was started in this folder.
fn real_time(folder: &Path) -> Option<String> {
    let wanted = format!("RTAPI_FIFO_PATH={}", folder.join("fifo").display());
    for entry in fs::read_dir("/proc").ok()? {
        let path = entry.ok()?.path();
        let is_ours = || {
            let name = fs::read_to_string(path.join("comm")).ok()?;
            let environment = fs::read(path.join("environ")).ok()?;
            let ours = environment.split(|&byte| byte == 0).any(|word| word == wanted.as_bytes());
            (name.trim() == "rtapi_app" && ours).then_some(())
        };
        if is_ours().is_some() {
            return Some(path.file_name()?.to_str()?.to_owned());
        }
    }
    None
}

/// Watches LinuxCNC's real-time process until `end` is set: gives it its priority, and kills it when
/// its user interface has asked for that by a file.
fn watch(folder: PathBuf, end: Arc<AtomicBool>) -> JoinHandle<()> {
    thread::spawn(move || {
        while !end.load(Ordering::Relaxed) {
            if let Some(id) = real_time(&folder) {
                if folder.join("kill").exists() {
                    run(Command::new("kill").args(["-9", &id]));
                    let _ = fs::rename(folder.join("kill"), folder.join("killed"));
                } else {
                    prefer(&["-a"], PRIORITIES[1], &id);
                }
            }
            thread::sleep(Duration::from_millis(100));
        }
    })
}

/// The home switch of joint 0.
const SWITCH: &str = "x,input=0,toward=min,seek_speed=20,slow_speed=2,pull_off=5,position=0";

/// What `carrystep linuxcnc` writes for the machine; with a switch for joint 0, or without a probe.
/// With an index latch, joint 0 homes on the first index pulse behind its switch.
fn configuration(machine: &Machine, port: &str, homes: bool) -> Configuration {
    let wishes = Wishes {
        name: "virtual".to_owned(),
        port: port.to_owned(),
        horizon_ms: Some(HORIZON_MS),
        display: "./ui.py".to_owned(),
        switches: if homes { vec![SWITCH.parse().unwrap()] } else { Vec::new() },
    };
    let (mut configuration, _) = Configuration::of_machine(machine, wishes).unwrap();
    assert_eq!(configuration.periods as usize, PERIODS);
    configuration.hal_files = vec!["sampler.hal".to_owned()];
    // Without a probe, LinuxCNC's own following error is at its tightest.
    configuration.probe = homes;
    if configuration.index_latch.is_some()
        && let Homing::Switch { index, .. } = &mut configuration.joints[0].homing
    {
        *index = true;
    }
    configuration
}

const SAMPLER: &str = "\
loadrt sampler cfg=fffbuf depth=30000
addf sampler.0 servo-thread
net joint-0-cmd => sampler.0.pin.0
net joint-1-cmd => sampler.0.pin.1
net joint-2-cmd => sampler.0.pin.2
net running carrystep.0.running => sampler.0.pin.3
net end-ticks carrystep.0.end-ticks => sampler.0.pin.4
net reserve carrystep.0.reserve-ms => sampler.0.pin.5
";

/// What a run of LinuxCNC left.
pub struct Ran {
    /// Standard output and standard error.
    pub said: String,
    /// What the user interface found, as JSON.
    pub result: String,
    /// What halsampler wrote.
    pub samples: String,
}

impl Ran {
    /// A number of the result.
    pub fn number(&self, key: &str) -> f64 {
        let found = self.result.split_once(&format!("\"{key}\":"));
        let (_, rest) = found.unwrap_or_else(|| panic!("{key}: {}", self.result));
        let end = rest.find([',', '\n', '}']).unwrap();
        rest[..end].trim().parse().unwrap()
    }

    /// Whether the computer was later than the horizon, as the component names it.
    pub fn late(&self) -> bool {
        let late = ["fault 3:", "fault 7:", "fault 23:", "fault 26:"];
        late.iter().any(|late| self.said.contains(late))
    }
}

/// Runs LinuxCNC for this machine at this port; `what` is the part of ui.py that is run.
pub fn linuxcnc(folder: &Path, machine: &Machine, port: &str, what: &str, program: &Path) -> Ran {
    fs::set_permissions(port, Permissions::from_mode(0o666)).unwrap();
    let run = tempfile::tempdir_in(folder).unwrap();
    let own = run.path();
    fs::set_permissions(own, Permissions::from_mode(0o777)).unwrap();
    for (name, text) in configuration(machine, port, what.starts_with("home")).files() {
        // `comp-g1.ngc` has a tool of one inch.
        let tools = if name.ends_with(".tbl") { "T4 P4 D25.4\n" } else { "" };
        fs::write(own.join(name), text + tools).unwrap();
    }
    fs::write(own.join("sampler.hal"), SAMPLER).unwrap();
    fs::write(own.join("ui.py"), include_str!("ui.py")).unwrap();
    fs::set_permissions(own.join("ui.py"), Permissions::from_mode(0o755)).unwrap();
    let end = Arc::new(AtomicBool::new(false));
    let watched = watch(own.to_owned(), Arc::clone(&end));
    // LinuxCNC refuses root.
    let nobody = ["--reuid=65534", "--regid=65534", "--clear-groups", "linuxcnc", "-r"];
    let output = Command::new("timeout")
        .args(["-k", "20", "1500", "setpriv"])
        .args(nobody)
        .arg("virtual.ini")
        .current_dir(own)
        .env("HOME", own)
        .env("RTAPI_UID", "65534")
        .env("RTAPI_FIFO_PATH", own.join("fifo"))
        .env("WHAT", what)
        .env("PROGRAM", program)
        .output()
        .unwrap();
    end.store(true, Ordering::Relaxed);
    watched.join().unwrap();
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    let result = fs::read_to_string(own.join("result.json")).unwrap_or_else(|_| panic!("{said}"));
    let samples = fs::read_to_string(own.join("samples.txt")).unwrap_or_default();
    Ran { said: said.into_owned(), result, samples }
}
