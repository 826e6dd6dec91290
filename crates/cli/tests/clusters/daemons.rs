//! A Slurm of one node: munged, slurmctld and slurmd as processes of the test, with their own
//! configuration, state and ports. They end when the value is dropped.

use std::net::TcpListener;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// The longest time that a state is waited for.
const PATIENCE: Duration = Duration::from_secs(120);

pub struct Slurm {
    folder: TempDir,
    daemons: Vec<Child>,
}

/// A program on the path or where Debian has programs of the administrator.
fn program(name: &str) -> PathBuf {
    let path = std::env::var_os("PATH").unwrap_or_default();
    let mut folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    folders.push("/usr/sbin".into());
    let found = folders.into_iter().map(|folder| folder.join(name)).find(|path| path.is_file());
    found.unwrap_or_else(|| panic!("{name} is missing: `cargo xtask tools` installs it"))
}

fn said(command: &mut Command) -> String {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{command:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap().trim().to_owned()
}

impl Slurm {
    /// Starts the daemons and waits until the node is idle. The node runs `cores` jobs at the same
    /// time, whatever the number of real cores is.
    pub fn start(cores: u32) -> Self {
        let folder = tempfile::tempdir().unwrap();
        // munged refuses a socket in a folder that other users cannot reach.
        std::fs::set_permissions(folder.path(), PermissionsExt::from_mode(0o755)).unwrap();
        let mut slurm = Self { folder, daemons: Vec::new() };
        slurm.configure(cores);
        let path = |name: &str| slurm.path(name).display().to_string();
        let munged = [
            "--foreground".to_owned(),
            format!("--key-file={}", path("munge.key")),
            format!("--socket={}", path("munge.socket")),
            format!("--pid-file={}", path("munge.pid")),
            format!("--log-file={}", path("munge.log")),
            format!("--seed-file={}", path("munge.seed")),
        ];
        slurm.daemon("munged", &munged);
        slurm.wait("munged", |slurm| slurm.path("munge.socket").exists());
        slurm.daemon("slurmctld", &["-D", "-i"].map(str::to_owned));
        slurm.daemon("slurmd", &["-D", "-N", "worker"].map(str::to_owned));
        slurm.wait("an idle node", |slurm| {
            let nodes = slurm.run("sinfo", &["--noheader", "--format=%t"]);
            String::from_utf8_lossy(&nodes.stdout).trim() == "idle"
        });
        slurm
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn configure(&self, cores: u32) {
        let key: Vec<u8> = (0..128_u8).map(|n| n.wrapping_mul(167)).collect();
        std::fs::write(self.path("munge.key"), key).unwrap();
        std::fs::set_permissions(self.path("munge.key"), PermissionsExt::from_mode(0o600)).unwrap();
        for folder in ["state", "spool"] {
            std::fs::create_dir(self.path(folder)).unwrap();
        }
        // Both ports are taken at the same time, so that they are different.
        let ports = [0, 1].map(|_| TcpListener::bind("127.0.0.1:0").unwrap());
        let [controller, node] = ports.map(|port| port.local_addr().unwrap().port());
        let host = said(Command::new("hostname").arg("-s"));
        let user = said(Command::new("id").arg("-un"));
        let here = self.folder.path().display();
        let text = format!(
            "ClusterName=test
SlurmctldHost={host}(127.0.0.1)
SlurmctldPort={controller}
SlurmdPort={node}
SlurmUser={user}
SlurmdUser={user}
AuthType=auth/munge
AuthInfo=socket={here}/munge.socket
StateSaveLocation={here}/state
SlurmdSpoolDir={here}/spool
SlurmctldPidFile={here}/slurmctld.pid
SlurmdPidFile={here}/slurmd.pid
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
SwitchType=switch/none
MpiDefault=none
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerType=sched/builtin
SchedulerParameters=sched_interval=1,batch_sched_delay=0
SlurmdParameters=config_overrides
ReturnToService=2
KillWait=2
NodeName=worker NodeHostname={host} NodeAddr=127.0.0.1 CPUs={cores} State=UNKNOWN
PartitionName=all Nodes=worker Default=YES MaxTime=INFINITE State=UP
"
        );
        std::fs::write(self.path("slurm.conf"), text).unwrap();
        // Nothing here needs control groups, but slurmd loads a plug-in for them. The first
        // releases cannot disable it, and this one then finds no groups.
        let version = said(Command::new(program("slurmctld")).arg("-V"));
        let number = version.split_whitespace().nth(1).unwrap_or_default();
        let cgroup = if number < "23.02" {
            format!("CgroupPlugin=cgroup/v1\nCgroupMountpoint={here}/none\n")
        } else {
            "CgroupPlugin=disabled\n".to_owned()
        };
        std::fs::write(self.path("cgroup.conf"), cgroup).unwrap();
    }

    fn daemon(&mut self, name: &str, arguments: &[String]) {
        let log = std::fs::File::create(self.path(&format!("{name}.out"))).unwrap();
        let mut command = Command::new(program(name));
        command.args(arguments).env("SLURM_CONF", self.path("slurm.conf")).stdin(Stdio::null());
        command.stdout(log.try_clone().unwrap()).stderr(log);
        self.daemons.push(command.spawn().unwrap());
    }

    /// Lets a command find this Slurm.
    pub fn finds<'a>(&self, command: &'a mut Command) -> &'a mut Command {
        command.env("SLURM_CONF", self.path("slurm.conf"))
    }

    /// Runs a command of Slurm.
    pub fn run(&self, name: &str, arguments: &[&str]) -> Output {
        self.finds(Command::new(program(name)).args(arguments)).output().unwrap()
    }

    /// As [`Slurm::run`]; the command must succeed.
    #[track_caller]
    pub fn do_run(&self, name: &str, arguments: &[&str]) -> String {
        let output = self.run(name, arguments);
        let error = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{name} {arguments:?}: {error}");
        String::from_utf8(output.stdout).unwrap()
    }

    /// The state of each job and of each task of an array, as `3_17 COMPLETED`.
    pub fn states(&self) -> Vec<String> {
        let text =
            self.do_run("squeue", &["--noheader", "--array", "--states=all", "--format=%i %T"]);
        text.lines().map(|line| line.trim().to_owned()).collect()
    }

    /// Waits until no job is waiting or running.
    pub fn wait_for_all(&self) {
        self.wait("the end of all jobs", |slurm| {
            slurm.do_run("squeue", &["--noheader"]).trim().is_empty()
        });
    }

    /// Waits until something is true.
    #[track_caller]
    pub fn wait(&self, what: &str, mut is_true: impl FnMut(&Self) -> bool) {
        let begun = Instant::now();
        while !is_true(self) {
            if begun.elapsed() > PATIENCE {
                panic!("waited in vain for {what}\n{}", self.logs());
            }
            std::thread::sleep(Duration::from_millis(50));
        }
    }

    /// The ends of all logs.
    fn logs(&self) -> String {
        let log = |name: &str| {
            let text = std::fs::read_to_string(self.path(name)).unwrap_or_default();
            let lines: Vec<&str> = text.lines().collect();
            format!("== {name}\n{}\n", lines[lines.len().saturating_sub(30)..].join("\n"))
        };
        ["munged.out", "slurmctld.out", "slurmd.out"].map(log).concat()
    }
}

impl Drop for Slurm {
    fn drop(&mut self) {
        // The jobs first: each has a process of its own, which slurmd does not end.
        if self.daemons.len() == 3 {
            let _ = self.run("scancel", &["--signal=KILL", "--full", "--user", &user_id()]);
            let _ = self.run("scancel", &["--user", &user_id()]);
            let begun = Instant::now();
            while begun.elapsed() < Duration::from_secs(10)
                && !self.run("squeue", &["--noheader"]).stdout.is_empty()
            {
                std::thread::sleep(Duration::from_millis(50));
            }
        }
        for daemon in self.daemons.iter_mut().rev() {
            end(daemon);
        }
    }
}

/// Asks a daemon to end, so that it ends the processes that it has started, and kills it if it does
/// not.
fn end(daemon: &mut Child) {
    let _ = Command::new("kill").arg(daemon.id().to_string()).status();
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_secs(10) {
        if !matches!(daemon.try_wait(), Ok(None)) {
            return;
        }
        std::thread::sleep(Duration::from_millis(50));
    }
    let _ = daemon.kill();
    let _ = daemon.wait();
}

fn user_id() -> String {
    said(Command::new("id").arg("-u"))
}

/// The process of a shard: the one with these two arguments and this file among its arguments.
pub fn process_of(shard: &str, kept: &Path) -> Option<u32> {
    let kept = kept.to_str()?;
    let processes = std::fs::read_dir("/proc").ok()?.flatten();
    processes.filter_map(|entry| entry.file_name().to_str()?.parse().ok()).find(|id: &u32| {
        let line = std::fs::read(format!("/proc/{id}/cmdline")).unwrap_or_default();
        let words: Vec<&[u8]> = line.split(|&byte| byte == 0).collect();
        words.windows(2).any(|pair| pair == [b"--shard", shard.as_bytes()])
            && words.contains(&kept.as_bytes())
    })
}
