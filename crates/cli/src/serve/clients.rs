//! The connections of senders: a pseudo-terminal, TCP and web pages. The first one drives the
//! machine; the others only watch. A page drives only if it says so and nobody else does. Nothing
//! blocks, and what waits for a slow reader is bounded.

use super::client::{Client, Id, Stream};
use super::http::Beginning;
use super::pty::Pty;
use super::web::{Said, Web, Word};
use std::io;
use std::net::TcpListener;

/// Most connections by TCP, and most pages. Further ones are closed at once.
const MOST: usize = 10;
/// Bytes that are read of the pseudo-terminal at once.
const READ: usize = 4096;
/// Bytes that wait for a reader from which on it gets no reports, and no line of it is taken.
const SLOW: usize = 4096;
/// Bytes that wait for a connection at most. By then it has not read for long, and is closed. The
/// pseudo-terminal cannot be closed: what is said to it above the bound is dropped.
const MOST_WAITING: usize = 1 << 16;

/// What has happened to a connection.
#[derive(Debug)]
pub enum Heard {
    /// It is new; whether it drives.
    Came(Id, bool),
    /// It has sent these bytes.
    Bytes(Id, Vec<u8>),
    /// One is gone; whether it drove.
    Gone(bool),
    /// A page says this.
    Word(Id, Word),
}

/// Who drives.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Driving {
    Nobody,
    This,
    Other,
}

/// All connections.
pub struct Clients {
    pty: Pty,
    listener: Option<TcpListener>,
    web: Option<Web>,
    clients: Vec<Client>,
    next: Id,
    driver: Option<Id>,
}

impl Clients {
    /// No connections yet.
    ///
    /// # Errors
    /// The listener cannot be made non-blocking.
    pub fn new(pty: Pty, listener: Option<TcpListener>, web: Option<Web>) -> io::Result<Self> {
        listener.as_ref().map_or(Ok(()), |listener| listener.set_nonblocking(true))?;
        Ok(Self { pty, listener, web, clients: Vec::new(), next: 1, driver: None })
    }

    /// The connection that drives.
    pub const fn driver(&self) -> Option<Id> {
        self.driver
    }

    /// What has happened since the last call. With `full`, nothing is read of the connection that
    /// drives.
    ///
    /// # Errors
    /// The pseudo-terminal has failed.
    pub fn poll(&mut self, full: bool) -> io::Result<Vec<Heard>> {
        let mut heard = Vec::new();
        self.accept(&mut heard);
        self.read_terminal(full, &mut heard)?;
        for at in 0..self.clients.len() {
            let drives = self.driver == Some(self.clients[at].id);
            if !(drives && full) {
                let (id, bytes) = (self.clients[at].id, self.clients[at].read_stream());
                if !bytes.is_empty() {
                    heard.push(Heard::Bytes(id, bytes));
                }
                self.read_page(at, &mut heard);
            }
        }
        self.flush()?;
        let gone: Vec<Id> =
            self.clients.iter().filter(|client| client.is_gone).map(|client| client.id).collect();
        self.clients.retain(|client| !client.is_gone);
        for id in gone {
            let drove = self.driver == Some(id);
            heard.push(Heard::Gone(drove));
            if drove {
                self.driver = None;
            }
        }
        // The one that has been there longest takes over.
        if self.driver.is_none()
            && let Some(client) = self.clients.iter().find(|client| !client.is_page())
        {
            self.driver = Some(client.id);
            heard.push(Heard::Came(client.id, true));
        }
        Ok(heard)
    }

    fn add(&mut self, stream: Stream, heard: &mut Vec<Heard>) {
        let id = self.next;
        self.next += 1;
        let client = Client::new(id, stream);
        let is_page = client.is_page();
        self.clients.push(client);
        if is_page {
            return;
        }
        if self.driver.is_some() {
            heard.push(Heard::Came(id, false));
        } else {
            self.driver = Some(id);
            heard.push(Heard::Came(id, true));
        }
    }

    fn accept(&mut self, heard: &mut Vec<Heard>) {
        while let Some(Ok((stream, _))) = self.listener.as_ref().map(TcpListener::accept) {
            let count = self.clients.iter().filter(|client| client.is_tcp()).count();
            let ready = stream.set_nonblocking(true).and_then(|()| stream.set_nodelay(true));
            if count < MOST && ready.is_ok() {
                self.add(Stream::Tcp(stream, Beginning::default()), heard);
            }
        }
        for socket in self.web.as_mut().map(Web::poll).unwrap_or_default() {
            if self.clients.iter().filter(|client| client.is_page()).count() < MOST {
                self.add(Stream::Page(Box::new(socket)), heard);
            }
        }
    }

    fn read_terminal(&mut self, full: bool, heard: &mut Vec<Heard>) -> io::Result<()> {
        let at = self.clients.iter().position(Client::is_terminal);
        let drives = at.is_some_and(|at| self.driver == Some(self.clients[at].id));
        if full && drives {
            return Ok(());
        }
        let mut bytes = [0; READ];
        let read = self.pty.read(&mut bytes)?;
        if at.is_none() && self.pty.is_open() {
            self.add(Stream::Terminal, heard);
        }
        let client = self.clients.iter_mut().find(|client| client.is_terminal());
        match (read, client) {
            (Some(count), Some(client)) if count > 0 => {
                heard.push(Heard::Bytes(client.id, bytes[..count].to_vec()));
            }
            (None, Some(client)) => client.is_gone = true,
            _ => {}
        }
        Ok(())
    }

    /// Sends what waits, as far as there is room.
    fn flush(&mut self) -> io::Result<()> {
        let pty = &mut self.pty;
        for client in self.clients.iter_mut().filter(|client| !client.is_gone) {
            client.flush(pty)?;
        }
        Ok(())
    }

    /// Reads what a page says.
    fn read_page(&mut self, at: usize, heard: &mut Vec<Heard>) {
        let (id, said) = (self.clients[at].id, self.clients[at].read_page());
        for said in said {
            match said {
                Said::Answered(line) => self.say(id, &line),
                Said::Bytes(bytes) => heard.push(Heard::Bytes(id, bytes)),
                Said::Word(Word::Drive) => {
                    if self.driver.is_none() {
                        self.driver = Some(id);
                        heard.push(Heard::Came(id, true));
                    }
                    let drives = self.driver == Some(id);
                    self.say(id, if drives { "web drives\n" } else { "web other drives\n" });
                }
                Said::Word(Word::Release) if self.driver == Some(id) => {
                    self.driver = None;
                    heard.push(Heard::Gone(true));
                }
                Said::Word(word) => heard.push(Heard::Word(id, word)),
            }
        }
    }

    /// Who drives, as this connection sees it.
    pub fn driving(&self, id: Id) -> Driving {
        match self.driver {
            None => Driving::Nobody,
            Some(driver) if driver == id => Driving::This,
            Some(_) => Driving::Other,
        }
    }

    /// Whether a connection is a page that has the token.
    pub fn may(&self, id: Id) -> bool {
        self.clients.iter().any(|client| client.id == id && client.may())
    }

    /// Sends a text to a connection, if not too much waits for it already.
    pub fn say(&mut self, to: Id, text: &str) {
        let Some(client) = self.clients.iter_mut().find(|client| client.id == to) else { return };
        if client.out.len() + text.len() <= MOST_WAITING {
            client.out.extend(text.as_bytes());
        } else if !client.is_terminal() {
            client.is_gone = true;
        }
    }

    /// Sends a text to the connection that drives, if there is one.
    pub fn tell(&mut self, text: &str) {
        if let Some(driver) = self.driver {
            self.say(driver, text);
        }
    }

    /// Whether a connection reads slower than it is answered.
    pub fn is_slow(&self, id: Id) -> bool {
        let waits = |client: &Client| client.id == id && client.out.len() > SLOW;
        self.clients.iter().any(waits)
    }

    /// Whether nothing waits for the connection that drives.
    pub fn all_is_said(&self) -> bool {
        self.clients.iter().all(|client| client.out.is_empty())
    }

    /// Closes a connection that is not the pseudo-terminal.
    pub fn close(&mut self, id: Id) {
        let client = self.clients.iter_mut().find(|client| client.id == id);
        client.into_iter().for_each(|client| client.is_gone = !client.is_terminal());
    }
}

#[cfg(test)]
mod slow_readers;
