//! The image of `sim/container/Dockerfile`: it is built from a clean clone, and a sender streams a
//! program to what starts in it.
//!
//! It takes many minutes, so this is a longer run: `cargo xtask long container`. It needs root,
//! buildah, mmdebstrap and rustup. Without CARRYSTEP_CONTAINER the test does nothing. No registry of
//! images is asked: the base images are made of Debian's packages and the toolchain of rustup, and
//! get the names that the recipe uses.
#![allow(clippy::print_stderr, reason = "figures, for the page of longer runs")]

use crate::sender::Sender;
use std::io::{BufRead as _, BufReader, Read as _};
use std::net::{Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

const RECIPE: &str = include_str!("../../../../sim/container/Dockerfile");
const WORKSPACE: &str = include_str!("../../../../Cargo.toml");
const PROGRAM: &str = include_str!("../../../../sim/jobs/chords_and_star.ngc");
/// Where it ends, mm.
const END: [f64; 3] = [25.0, 0.0, 0.0];
/// The address that the recipe publishes, seen from this computer.
const ADDRESS: SocketAddr = SocketAddr::new(std::net::IpAddr::V4(Ipv4Addr::LOCALHOST), 23000);
/// The certificates that this computer trusts, which a proxy may have changed.
const CERTIFICATES: &str = "/etc/ssl/certs/ca-certificates.crt";

/// The release of Rust that the recipe builds with.
fn rust() -> &'static str {
    RECIPE
        .split_once("FROM rust:")
        .and_then(|(_, rest)| rest.split_once("-slim-bookworm"))
        .unwrap()
        .0
}

#[test]
fn recipe_builds_with_the_oldest_rust_that_the_workspace_supports() {
    assert!(WORKSPACE.contains(&format!("\nrust-version = \"{}\"\n", rust())), "{}", rust());
}

/// Runs a program, which must pass, and returns its output.
#[track_caller]
fn ran(command: &mut Command) -> String {
    let ran = command.output().unwrap_or_else(|error| panic!("{command:?}: {error}"));
    assert!(ran.status.success(), "{command:?}: {}", String::from_utf8_lossy(&ran.stderr));
    String::from_utf8(ran.stdout).unwrap().trim().to_owned()
}

/// A folder with images and containers of its own.
struct Store(tempfile::TempDir);

impl Store {
    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn command(&self, words: &[&str]) -> Command {
        let mut command = Command::new("buildah");
        command.arg("--root").arg(self.path("root")).arg("--runroot").arg(self.path("runroot"));
        command.args(["--storage-driver", "vfs"]).args(words).env("BUILDAH_ISOLATION", "chroot");
        command
    }

    #[track_caller]
    fn buildah(&self, words: &[&str]) -> String {
        ran(&mut self.command(words))
    }

    /// Makes a base image of Debian's packages, with these options of mmdebstrap and these files.
    fn base(&self, name: &str, options: &[&str], files: &[(&Path, &str)]) {
        let tar = self.path("base.tar");
        let mut debian = Command::new("mmdebstrap");
        debian.args(["--quiet", "--variant=minbase", "--dpkgopt=path-exclude=/usr/share/doc/*"]);
        debian.args(["--dpkgopt=path-exclude=/usr/share/locale/*"]);
        ran(debian.args(options).arg("bookworm").arg(&tar));
        let container = self.buildah(&["from", "scratch"]);
        self.buildah(&["add", "--quiet", &container, &tar.to_string_lossy(), "/"]);
        for (from, to) in files {
            self.buildah(&["add", "--quiet", &container, &from.to_string_lossy(), to]);
        }
        let path = "PATH=/usr/local/rust/bin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin";
        self.buildah(&["config", "--env", path, &container]);
        self.buildah(&[
            "commit",
            "--quiet",
            "--rm",
            &container,
            &format!("docker.io/library/{name}"),
        ]);
    }

    /// What the image has under this name in its configuration: words between brackets, or a text.
    fn config(&self, key: &str) -> String {
        let format = format!("{{{{.OCIv1.Config.{key}}}}}");
        let said = self.buildah(&["inspect", "--type", "image", "--format", &format, "carrystep"]);
        said.trim_matches(['[', ']']).to_owned()
    }
}

/// The number of a process, which is ended if the test fails.
struct Process(String);

impl Drop for Process {
    fn drop(&mut self) {
        // It has ended already if the test has come so far.
        if std::thread::panicking() {
            let _ = Command::new("kill").args(["-KILL", &self.0]).status();
        }
    }
}

/// Starts what the image starts, streams a program to it, and stops it with the signal that the
/// image names.
fn serves(store: &Store, container: &str) {
    let started = store.config("Entrypoint") + " " + &store.config("Cmd");
    let mut command =
        store.command(&["run", container, "--", "sh", "-c", "echo $$; exec \"$@\"", "sh"]);
    command.args(started.split_whitespace()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let mut child = command.spawn().unwrap();
    let mut said = BufReader::new(child.stdout.take().unwrap());
    let mut next = || {
        let mut line = String::new();
        said.read_line(&mut line).unwrap();
        line.trim().to_owned()
    };
    // Isolated by chroot, a process has the number that it has outside.
    let (process, _pty) = (Process(next()), next());
    assert_eq!(next(), "tcp 0.0.0.0:23000");
    let status = std::fs::read_to_string(format!("/proc/{}/status", process.0)).unwrap();
    assert!(status.contains("Name:\tcarrystep\n") && status.contains("Uid:\t65534\t"), "{status}");
    let mut sender = Sender::at(ADDRESS);
    sender.counted(PROGRAM, 1024);
    assert_eq!(sender.place(), END);
    let signal = store.config("StopSignal");
    ran(Command::new("kill").args([&format!("-{}", signal.trim_start_matches("SIG")), &process.0]));
    let mut rest = String::new();
    said.read_to_string(&mut rest).unwrap();
    child.stderr.take().unwrap().read_to_string(&mut rest).unwrap();
    assert!(child.wait().unwrap().success(), "{rest}");
    assert!(rest.contains("the positions are valid") && rest.contains("no password"), "{rest}");
}

#[test]
fn container_serves_a_sender() {
    if std::env::var_os("CARRYSTEP_CONTAINER").is_none() {
        return;
    }
    let store = Store(tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap());
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().unwrap();
    let clone = store.path("clone");
    let from = format!("file://{}", workspace.display());
    ran(Command::new("git").args(["clone", "--quiet", "--depth", "1", &from]).arg(&clone));
    store.base("debian:bookworm-slim", &[], &[]);
    let home = store.path("rustup");
    let mut rustup = Command::new("rustup");
    rustup.args(["toolchain", "install", rust(), "--profile", "minimal", "--no-self-update"]);
    ran(rustup.env("RUSTUP_HOME", &home));
    let toolchain = std::fs::read_dir(home.join("toolchains")).unwrap().next().unwrap().unwrap();
    let files = [(&*toolchain.path(), "/usr/local/rust"), (Path::new(CERTIFICATES), CERTIFICATES)];
    let packages = ["--include=ca-certificates,gcc,libc6-dev"];
    store.base(&format!("rust:{}-slim-bookworm", rust()), &packages, &files);
    let begun = Instant::now();
    let mut build = store.command(&["bud", "--network", "host", "--pull-never", "-t", "carrystep"]);
    build.args(["-f", "sim/container/Dockerfile", "."]).current_dir(&clone);
    ran(&mut build);
    let minutes = begun.elapsed().as_secs() / 60;
    let size = |name| store.buildah(&["images", "--format", "{{.Size}}", name]);
    let sizes = ["carrystep", "debian:bookworm-slim"].map(size);
    // Twice in the same container, so with the state that the first one has left.
    let container = store.buildah(&["from", "--pull-never", "carrystep"]);
    for _ in 0..2 {
        serves(&store, &container);
    }
    eprintln!(
        "FIGURES {minutes} minutes to build, an image of {} on base images of Debian's packages ({}), \
         {} lines streamed twice as nobody, ends exact, ended by the stop signal",
        sizes[0],
        sizes[1],
        PROGRAM.lines().count()
    );
}
