//! The real CNCjs: its installation from npm, its headless server, and a client of that server.

use crate::command::Folder;
use serde_json::{Value, json};
use std::fs;
use std::io::{BufRead as _, BufReader, Write as _};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// Longest time in which something has to come: a program takes minutes if the computer is busy.
const PATIENCE: Duration = Duration::from_secs(900);

/// What npm installs: CNCjs 1.11.5, and all that it needs in the versions of the lock file.
const WANTED: [(&str, &str); 2] = [
    ("package.json", include_str!("npm/package.json")),
    ("package-lock.json", include_str!("npm/package-lock.json")),
];

/// The folder in which CNCjs is installed; it is installed if it is not there.
fn installed() -> PathBuf {
    let there = Path::new(env!("CARGO_TARGET_TMPDIR")).join("cncjs");
    let is_that = WANTED
        .iter()
        .all(|(name, text)| fs::read_to_string(there.join(name)).is_ok_and(|found| found == *text));
    if is_that {
        return there;
    }
    // The folder gets its name when it is whole.
    let new = tempfile::tempdir_in(env!("CARGO_TARGET_TMPDIR")).unwrap();
    for (name, text) in WANTED {
        fs::write(new.path().join(name), text).unwrap();
    }
    let options = ["ci", "--ignore-scripts", "--omit=dev", "--no-audit", "--no-fund"];
    let ran = Command::new("npm").args(options).current_dir(new.path()).output();
    let ran = ran.unwrap_or_else(|error| panic!("npm: {error}"));
    assert!(ran.status.success(), "npm: {}", String::from_utf8_lossy(&ran.stderr));
    let _ = fs::remove_dir_all(&there);
    fs::rename(new.keep(), &there).unwrap();
    there
}

/// A running server of CNCjs, and a client that has opened the machine's port by it.
pub struct Cncjs {
    pub server: Child,
    client: Child,
    to: Option<ChildStdin>,
    events: Receiver<Value>,
    port: String,
    /// What the machine has answered that is neither `ok` nor a report.
    pub said: Vec<String>,
}

impl Cncjs {
    /// Starts a server on a free port, connects with it, and opens this serial port.
    pub fn new(folder: &Folder, port: &str) -> Self {
        let there = installed();
        let mut server = Command::new("node")
            .arg(there.join("node_modules/cncjs/bin/cncjs"))
            .args(["--port", "0", "--host", "127.0.0.1", "--controller", "Grbl", "--config"])
            .arg(folder.path("cncrc"))
            // It keeps sessions at home.
            .env("HOME", folder.path(""))
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .unwrap();
        let said = lines(server.stdout.take().unwrap());
        let url = loop {
            let line = said.recv_timeout(PATIENCE).expect("the server of CNCjs does not start");
            if let Some((_, url)) = line.split_once("Starting the server at ") {
                break url.trim().to_owned();
            }
        };
        let client = folder.path("cncjs.js");
        fs::write(&client, include_str!("cncjs.js")).unwrap();
        let mut client = Command::new("node")
            .arg(client)
            .arg(there.join("node_modules/socket.io-client"))
            .arg(url)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap();
        let (to, from) = (client.stdin.take(), lines(client.stdout.take().unwrap()));
        let (sender, events) = channel();
        std::thread::spawn(move || {
            for line in from {
                let event = serde_json::from_str(&line).expect(&line);
                if sender.send(event).is_err() {
                    return;
                }
            }
        });
        let port = port.to_owned();
        let mut this = Self { server, client, to, events, port, said: Vec::new() };
        this.until("connect", |_| true);
        this.open();
        this
    }

    /// Opens the serial port, and waits for the settings, for which CNCjs asks by itself. There is
    /// no welcome if the command has not noticed that the port was closed.
    pub fn open(&mut self) {
        self.emit(&json!(["open", self.port, { "controllerType": "Grbl", "baudrate": 115_200 }]));
        let done = self.until("open:done", |_| true);
        assert_eq!(done[1], "");
        self.until("serialport:read", |event| {
            event[1].as_str().is_some_and(|line| line.starts_with("$132="))
        });
        self.until("serialport:read", |event| event[1] == "ok");
    }

    pub fn close(&mut self) {
        self.emit(&json!(["close", self.port]));
        self.until("close:done", |_| true);
    }

    fn emit(&mut self, event: &Value) {
        writeln!(self.to.as_mut().unwrap(), "{event}").unwrap();
    }

    /// Gives CNCjs one of its commands.
    pub fn command(&mut self, name: &str, arguments: &[Value]) {
        let words = [json!("command"), json!(self.port), json!(name)];
        self.emit(&Value::Array([&words, arguments].concat()));
    }

    /// Waits for such an event, and returns it. Those before it are dropped.
    #[track_caller]
    pub fn until(&mut self, name: &str, is_it: impl Fn(&Value) -> bool) -> Value {
        let (begin, mut last) = (Instant::now(), Value::Null);
        loop {
            // Others come all the time.
            let rest = PATIENCE.saturating_sub(begin.elapsed());
            let Ok(event) = self.events.recv_timeout(rest) else {
                panic!("no such {name}; the last one: {last}; said: {:?}", self.said)
            };
            if event[0] == "serialport:read" {
                let line = event[1].as_str().unwrap();
                if line != "ok" && !line.starts_with('<') {
                    self.said.push(line.to_owned());
                }
            }
            assert!(event[0] != "error" && event[0] != "connect_error", "{event}");
            if event[0] == name {
                if is_it(&event) {
                    return event;
                }
                last = event;
            }
        }
    }

    /// Waits for a state of the machine.
    #[track_caller]
    pub fn state(&mut self, is_it: impl Fn(&Value) -> bool) -> Value {
        self.until("controller:state", |event| is_it(&event[2]["status"]))[2]["status"].clone()
    }

    /// Loads a program. With a null context instead of the empty one, the server would throw.
    pub fn load(&mut self, name: &str, program: &str) {
        self.command("gcode:load", &[json!(name), json!(program), json!({})]);
        self.until("gcode:load", |event| event[1] == name);
    }

    /// Waits until so many lines of the loaded program have been answered.
    #[track_caller]
    pub fn answered(&mut self, name: &str, lines: u64) {
        self.until("sender:status", |event| {
            event[1]["name"] == name && event[1]["received"].as_u64() >= Some(lines)
        });
    }

    /// Waits until all lines have been answered.
    #[track_caller]
    pub fn finishes(&mut self, name: &str) -> u64 {
        let event = self.until("sender:status", |event| {
            let (status, number) = (&event[1], |key: &str| event[1][key].as_u64().unwrap());
            status["name"] == name && number("total") > 0 && number("received") == number("total")
        });
        event[1]["total"].as_u64().unwrap()
    }

    /// Ends both processes, the server by Ctrl-C, as its user does.
    pub fn end(mut self) {
        self.to = None;
        assert!(self.client.wait().unwrap().success());
        crate::stops::signal(&self.server, "-INT");
        self.server.wait().unwrap();
    }
}

impl Drop for Cncjs {
    fn drop(&mut self) {
        // If the test has come so far, they have ended already.
        for child in [&mut self.client, &mut self.server] {
            let _ = child.kill();
            let _ = child.wait();
        }
    }
}

/// The lines of an output, which is read to its end.
fn lines(from: impl std::io::Read + Send + 'static) -> Receiver<String> {
    let (sender, lines) = channel();
    std::thread::spawn(move || {
        for line in BufReader::new(from).lines().map_while(Result::ok) {
            // A pipe that nobody reads would stop the process.
            let _ = sender.send(line);
        }
    });
    lines
}
