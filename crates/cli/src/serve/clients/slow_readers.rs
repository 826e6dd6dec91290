//! What is said to a connection that never reads is bounded, whoever it is and whatever it is told:
//! messages that nobody asked for, too, as the welcome of each reset.
#![allow(clippy::unwrap_used)] // Tests may panic.

use super::{Clients, Heard, MOST_WAITING};
use crate::serve::pty::Pty;
use std::fs::{File, OpenOptions};
use std::io::Read as _;
use std::net::{TcpListener, TcpStream};

const LINE: &str = "[MSG:something that nobody has asked for]\r\n";

/// Far more lines than the system keeps for a connection that does not read: 200 MB.
const LINES: usize = 5_000_000;

/// Connections, the stream of a first one by TCP, and the other end of the terminal.
fn clients() -> (Clients, TcpStream, File) {
    let (pty, listener) = (Pty::new().unwrap(), TcpListener::bind("127.0.0.1:0").unwrap());
    let stream = TcpStream::connect(listener.local_addr().unwrap()).unwrap();
    let name = pty.name().to_owned();
    let mut clients = Clients::new(pty, Some(listener), None).unwrap();
    while clients.driver().is_none() {
        clients.poll(false).unwrap();
    }
    let terminal = OpenOptions::new().read(true).write(true).open(name).unwrap();
    (clients, stream, terminal)
}

/// Says lines, and checks that what waits is bounded. Returns what was heard meanwhile if it is
/// that a connection is gone.
fn says(clients: &mut Clients, to: u64) -> Option<bool> {
    for _ in 0..LINES {
        clients.say(to, LINE);
        assert!(clients.clients.iter().all(|client| client.out.len() <= MOST_WAITING));
        for heard in clients.poll(false).unwrap() {
            if let Heard::Gone(drove) = heard {
                return Some(drove);
            }
        }
    }
    None
}

#[test]
fn driver_by_tcp_that_is_told_more_than_it_reads_is_gone() {
    let (mut clients, mut stream, _terminal) = clients();
    let driver = clients.driver().unwrap();
    assert_eq!(says(&mut clients, driver), Some(true));
    // What it was sent before is whole.
    let mut said = Vec::new();
    // The connection may be reset behind it.
    let _ = stream.read_to_end(&mut said);
    assert!(said.chunks_exact(LINE.len()).all(|line| line == LINE.as_bytes()));
    assert!(said.len() > MOST_WAITING);
}

#[test]
fn terminal_that_is_told_more_than_it_reads_keeps_whole_lines() {
    let (mut clients, stream, mut terminal) = clients();
    drop(stream);
    let first = clients.driver().unwrap();
    while clients.driver().is_none_or(|driver| driver == first) {
        clients.poll(false).unwrap();
    }
    let driver = clients.driver().unwrap();
    for _ in 0..10_000 {
        clients.say(driver, LINE);
        clients.poll(false).unwrap();
        assert!(clients.clients.iter().all(|client| client.out.len() <= MOST_WAITING));
    }
    // It reads again, and is told again.
    let (mut said, mut bytes) = (Vec::new(), [0; 4096]);
    while !clients.all_is_said() {
        let count = terminal.read(&mut bytes).unwrap();
        said.extend(&bytes[..count]);
        clients.poll(false).unwrap();
    }
    clients.say(driver, "ok\r\n");
    clients.poll(false).unwrap();
    while !said.ends_with(b"ok\r\n") {
        let count = terminal.read(&mut bytes).unwrap();
        said.extend(&bytes[..count]);
    }
    said.truncate(said.len() - 4);
    assert!(said.len() > MOST_WAITING);
    assert!(said.chunks(LINE.len()).all(|line| line == LINE.as_bytes()));
}
