//! The connections of `carrystep serve`: who drives and who watches, senders that vanish, HTTP,
//! other commands beside it, a board that is gone.

use crate::sender::{Sender, Served, place};
use crate::serve_streams::folder;
use crate::stops::stop;
use crate::virtual_boards::{Board, passed};
use std::io::{ErrorKind, Read as _, Write as _};
use std::net::TcpStream;
use std::time::Duration;

/// A way that takes some seconds.
const WAY: &str = "G21 G91 F180\nG1 X5\nG1 Y5";

#[test]
fn first_connection_drives_and_nine_others_watch() {
    let folder = folder();
    let served = Served::new(&folder, "");
    let mut first = Sender::tcp(&served);
    let mut watchers: Vec<Sender> = (0..9).map(|_| Sender::tcp(&served)).collect();
    // The eleventh is closed.
    let mut eleventh = TcpStream::connect(served.tcp).unwrap();
    eleventh.set_read_timeout(Some(Duration::from_secs(60))).unwrap();
    match eleventh.read(&mut [0]) {
        Ok(count) => assert_eq!(count, 0),
        Err(error) => assert_eq!(error.kind(), ErrorKind::ConnectionReset),
    }
    first.done("G0 X1");
    first.place();
    for watcher in &mut watchers {
        assert_eq!(place(&watcher.report()), [1.0, 0.0, 0.0]);
        assert_eq!(watcher.ask("G0 X2").last().unwrap(), "error:8");
        watcher.send("!\u{18}");
    }
    assert!(first.report().starts_with("<Idle|MPos:1.000,"));
    // The one that has waited longest takes over.
    drop(first);
    watchers[0].until(|line| line.starts_with("Grbl 1.1"));
    watchers[0].done("G0 X3");
    assert_eq!(watchers[0].place(), [3.0, 0.0, 0.0]);
}

#[test]
fn http_closes_its_connection_and_does_nothing() {
    let folder = folder();
    let served = Served::new(&folder, "");
    for request in [
        "GET /?~ HTTP/1.1\r\nHost: localhost\r\n\r\n!\u{18}",
        "POST / HTTP/1.1\r\nContent-Length: 6\r\n\r\nG0 X5\n",
        "\nGET / HTTP/1.1\r\nG0 X5\r\n",
    ] {
        let mut stream = TcpStream::connect(served.tcp).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        // It only ends a test that hangs: a busy computer may run nothing for half a minute.
        stream.set_read_timeout(Some(Duration::from_secs(180))).unwrap();
        let mut said = Vec::new();
        // The connection may be reset, because not all was read.
        let ended = stream.read_to_end(&mut said);
        assert!(!matches!(ended, Err(error) if error.kind() == ErrorKind::WouldBlock));
    }
    let mut sender = Sender::tcp(&served);
    assert!(sender.report().starts_with("<Idle|MPos:0.000,"));
}

#[test]
fn sender_that_vanishes_leaves_a_job_that_is_finished_or_a_machine_at_rest() {
    let folder = folder();
    for (option, pty) in [("finish", false), ("finish", true), ("stop", false), ("stop", true)] {
        let served = Served::with(&folder, &format!("--virtual --fast --when-gone {option}"));
        let connect = || if pty { Sender::pty(&served) } else { Sender::tcp(&served) };
        let mut sender = connect();
        sender.simple(WAY);
        sender.state("Run");
        drop(sender);
        if pty {
            // A terminal that is closed and opened at once is that of the same sender.
            std::thread::sleep(Duration::from_millis(300));
        }
        let mut next = connect();
        let at = next.place();
        if option == "finish" {
            assert_eq!(at, [5.0, 5.0, 0.0], "{option} {pty}");
        } else {
            assert!(at[0] <= 5.0 && at[1] < 5.0, "{option} {pty}: {at:?}");
        }
        next.simple("G90 G0 X0 Y0");
        assert_eq!(next.place(), [0.0; 3]);
        assert_eq!(served.interrupt().0, 0);
    }
}

#[test]
fn other_commands_work_beside_it() {
    let folder = folder();
    let board = Board::new(&folder, "--fast");
    let served = Served::with(&folder, &format!("--port {} --link grbl", board.port));
    assert!(std::fs::read_link(folder.path("grbl")).unwrap().ends_with(&served.pty));
    let mut sender = Sender::tcp(&served);
    sender.simple(WAY);
    sender.state("Run");
    let port = &served.board;
    let ran = |what: &str| folder.run(&format!("{what} --port {port}"));
    passed(&ran("hold"));
    sender.state("Hold:0");
    // The axes rest a little before the command waits.
    loop {
        let told = ran("status --json");
        passed(&told);
        let told: serde_json::Value = serde_json::from_str(&told.stdout).unwrap();
        assert_eq!(told["held_by"]["command"], "serve", "{told}");
        if !told["waits"].is_null() {
            break;
        }
    }
    passed(&ran("resume"));
    sender.state("Run");
    // A second command does not get the board.
    let second = folder.run(&format!("serve --machine machine.toml --port {port}"));
    second.refuses("is in use by `carrystep serve`");
    passed(&stop(&folder, port, ""));
    sender.until(|line| line == "ALARM:3");
    let (status, said) = served.end();
    assert_eq!(status, 0, "{said}");
    assert!(std::fs::symlink_metadata(folder.path("grbl")).is_err());
}

#[test]
fn board_that_is_gone_is_an_alarm_and_ends_the_command() {
    let folder = folder();
    let mut board = Board::new(&folder, "--fast");
    let served = Served::with(&folder, &format!("--port {}", board.port));
    let mut sender = Sender::tcp(&served);
    sender.simple(WAY);
    sender.state("Run");
    board.child.kill().unwrap();
    board.child.wait().unwrap();
    sender.until(|line| line == "ALARM:3");
    sender.until(|line| line == "[MSG:the board is gone]");
    let (status, said) = served.end();
    assert_eq!(status, 1, "{said}");
}

#[test]
fn other_computers_are_let_in_only_when_asked_and_with_a_warning() {
    let folder = folder();
    for (options, warned) in
        [("", false), ("--listen 127.0.0.1", false), ("--listen 0.0.0.0", true)]
    {
        let served = Served::new(&folder, options);
        assert_eq!(served.tcp.ip().is_loopback(), !warned, "{}", served.tcp);
        let (status, said) = served.interrupt();
        assert_eq!(status, 0, "{said}");
        let warning = "warning: 0.0.0.0:0: raw TCP has no password";
        assert_eq!(said.contains(warning), warned, "{said}");
    }
}

#[test]
fn bad_options_are_refused() {
    let folder = folder();
    let refuses = |options: &str, says: &str| {
        folder.run(&format!("serve --machine machine.toml {options}")).refuses(says);
    };
    refuses("", "--port");
    refuses("--virtual --port /dev/null", "cannot be used with");
    refuses("--port /dev/null --fast", "cannot be used with");
    refuses("--virtual --listen 0.0.0.0", "--tcp");
    refuses("--port /dev/null", "/dev/null");
    refuses("--virtual --link machine.toml", "something else than a symbolic link");
    refuses("--virtual --tolerance 0", "--tolerance");
}
