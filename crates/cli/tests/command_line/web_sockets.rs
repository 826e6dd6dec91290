//! The WebSocket of `serve --web`, as a program reaches it: who is let in, what the token is for,
//! programs, ten pages at once, garbage. What people see is in `web_page.rs`.

use crate::sender::{Sender, Served, place};
use crate::serve_streams::folder;
use serde_json::Value;
use std::io::{Read as _, Write as _};
use std::net::TcpStream;
use std::time::{Duration, Instant};
use tungstenite::client::IntoClientRequest as _;
use tungstenite::http::HeaderValue;
use tungstenite::{Message, WebSocket};

const PATIENCE: Duration = Duration::from_secs(60);

/// A page without a browser.
pub struct Page {
    socket: WebSocket<TcpStream>,
    rest: String,
    address: String,
}

impl Page {
    /// Connects; `Err` is the status of the refusal.
    fn try_new(
        served: &Served,
        host: Option<&str>,
        origin: Option<&str>,
    ) -> Result<Self, (u16, String)> {
        let address = served.web_address();
        let mut request = format!("ws://{address}/socket").into_client_request().unwrap();
        let headers = request.headers_mut();
        let own = format!("http://{address}");
        headers.insert("Origin", HeaderValue::from_str(origin.unwrap_or(&own)).unwrap());
        if let Some(host) = host {
            headers.insert("Host", HeaderValue::from_str(host).unwrap());
        }
        let stream = TcpStream::connect(&address).unwrap();
        stream.set_read_timeout(Some(PATIENCE)).unwrap();
        match tungstenite::client(request, stream) {
            Ok((socket, _)) => Ok(Self { socket, rest: String::new(), address }),
            Err(tungstenite::HandshakeError::Failure(tungstenite::Error::Http(answer))) => {
                let body = answer.body().clone().unwrap_or_default();
                Err((answer.status().as_u16(), String::from_utf8(body).unwrap()))
            }
            Err(error) => panic!("{error}"),
        }
    }

    pub fn new(served: &Served) -> Self {
        Self::try_new(served, None, None).unwrap()
    }

    /// A page with the token.
    fn with_token(served: &Served) -> Self {
        let mut page = Self::new(served);
        page.say(&format!("token {}", served.token()));
        assert_eq!(page.until(|line| line.starts_with("web ")), "web may");
        page
    }

    pub fn say(&mut self, word: &str) {
        self.try_say(word).unwrap();
    }

    /// Fails if the connection was closed.
    pub fn try_say(&mut self, word: &str) -> Result<(), tungstenite::Error> {
        self.socket.send(Message::text(word))
    }

    fn send(&mut self, bytes: &[u8]) {
        self.socket.send(Message::binary(bytes.to_vec())).unwrap();
    }

    /// The next line.
    fn next(&mut self) -> String {
        loop {
            if let Some((line, rest)) = self.rest.split_once('\n') {
                let (line, rest) = (line.trim().to_owned(), rest.to_owned());
                self.rest = rest;
                return line;
            }
            let data = self.socket.read().unwrap().into_data();
            self.rest.push_str(std::str::from_utf8(&data).unwrap());
        }
    }

    fn until(&mut self, is_it: impl Fn(&str) -> bool) -> String {
        let begin = Instant::now();
        loop {
            let line = self.next();
            if is_it(&line) {
                return line;
            }
            assert!(begin.elapsed() < PATIENCE, "{line}");
        }
    }

    pub fn state(&mut self) -> Value {
        self.say("?");
        serde_json::from_str(&self.until(|line| line.starts_with('{'))).unwrap()
    }

    /// Waits for a state.
    fn waits(&mut self, state: &str) -> Value {
        let begin = Instant::now();
        loop {
            let found = self.state();
            if found["state"] == state {
                return found;
            }
            assert!(begin.elapsed() < PATIENCE, "wanted {state}: {found}");
        }
    }

    /// What is said to a text, which is refused.
    fn refused(&mut self, word: &str) -> String {
        self.say(word);
        self.until(|line| line.starts_with("web "))
    }
}

/// What is answered to these bytes, until the connection is closed.
fn answered(address: &str, bytes: &[u8]) -> String {
    let mut stream = TcpStream::connect(address).unwrap();
    stream.set_read_timeout(Some(PATIENCE)).unwrap();
    stream.write_all(bytes).unwrap();
    let mut said = String::new();
    stream.read_to_string(&mut said).unwrap();
    said
}

#[test]
fn other_hosts_and_origins_are_refused_and_nothing_acts() {
    let folder = folder();
    let served = Served::new(&folder, "--web 0");
    let address = served.web_address();
    let port = address.rsplit(':').next().unwrap().to_owned();
    let rebound = format!("rebound.example:{port}");
    let evil = format!("http://rebound.example:{port}");
    for (host, origin) in [
        (Some(rebound.as_str()), None),
        (Some(rebound.as_str()), Some(evil.as_str())),
        (Some("localhost"), None),
        (None, Some("https://example.com")),
        (None, Some(evil.as_str())),
        (None, Some("null")),
    ] {
        let refused = Page::try_new(&served, host, origin).err();
        assert_eq!(refused.map(|(status, _)| status), Some(403), "{host:?} {origin:?}");
    }
    let page = answered(&address, format!("GET / HTTP/1.1\r\nHost: {address}\r\n\r\n").as_bytes());
    assert!(page.starts_with("HTTP/1.1 200 OK\r\n"), "{page}");
    assert!(page.contains("frame-ancestors 'none'") && page.ends_with("</html>\n"));
    let rebound = format!("GET / HTTP/1.1\r\nHost: {rebound}\r\n\r\n");
    assert!(answered(&address, rebound.as_bytes()).starts_with("HTTP/1.1 403 Forbidden\r\n"));
    assert_eq!(Page::new(&served).state()["state"], "Idle");
}

#[test]
fn page_without_the_token_watches_and_stops() {
    let folder = folder();
    let served = Served::new(&folder, "--web 0");
    let mut page = Page::new(&served);
    for word in ["hold", "resume", "drive", "release", "feed +10", "rapid 25", "spindle 100"] {
        assert_eq!(
            page.refused(word),
            format!("web refused {word}: only a page with the token may")
        );
    }
    page.send(b"G0 X1\n!\x18");
    let said = page.until(|line| line.starts_with("web "));
    assert_eq!(said, "web refused lines: only a page with the token may");
    // It is no longer the first message.
    let token = format!("token {}", served.token());
    assert!(page.refused(&token).starts_with("web refused token: "));
    let mut other = Page::new(&served);
    assert!(other.refused("token 00112233445566778899aabbccddeeff").contains("refused token"));
    assert!(other.refused("hold").contains("refused hold"));
    let state = page.state();
    assert_eq!((&state["state"], &state["may"]), (&"Idle".into(), &false.into()), "{state}");
    assert_eq!(state["machine"], serde_json::json!([0.0, 0.0, 0.0]));
    assert_eq!(state["overrides"], serde_json::json!([100, 100, 100]));

    let mut sender = Sender::tcp(&served);
    sender.simple("G21 G91 F60\nG1 X20");
    assert_eq!(page.waits("Run")["driver"], "other");
    while page.state()["machine"][0] == 0.0 {}
    page.say("stop");
    sender.until(|line| line == "ALARM:3");
    sender.until(|line| line == "[MSG:stopped on the web page]");
    let state = page.waits("Alarm");
    assert_eq!(state["why"], "stopped on the web page");
    assert!(sender.ask("G0 X1").contains(&"error:9".to_owned()));
    let stopped = place(&sender.report())[0];
    assert!(stopped > 0.0 && stopped < 20.0, "{stopped}");
    // The command goes on: the sender unlocks the machine, at a place that is known.
    sender.done("$X");
    sender.simple("G90\nG0 X0");
    assert_eq!(sender.place(), [0.0; 3]);
    // At rest, and in a hold, it stops as well.
    page.say("stop");
    page.waits("Alarm");
    sender.simple("$X\nG91 G1 X5 F60");
    page.waits("Run");
    sender.send("!");
    page.waits("Hold:0");
    page.say("stop");
    page.waits("Alarm");
    sender.simple("$X\nG90 G0 X0");
    assert_eq!(sender.place(), [0.0; 3]);
    assert_eq!(served.interrupt().0, 0);
}

#[test]
fn page_with_the_token_streams_a_program_and_reaches_its_end() {
    let folder = folder();
    let served = Served::new(&folder, "--web 0");
    let mut page = Page::with_token(&served);
    assert!(page.state()["may"].as_bool().unwrap());
    page.say("drive");
    page.until(|line| line == "web drives");
    assert_eq!(page.state()["driver"], "this");
    let program = ["G21 G90 F1500", "G1 X3", "G3 X1 Y2 I-2 J0", "G1 Z0.5", "G1 X2 Y2"];
    for line in program {
        page.send(format!("{line}\n").as_bytes());
        page.until(|line| line == "ok");
    }
    let state = page.waits("Idle");
    assert_eq!(state["machine"], serde_json::json!([2.0, 2.0, 0.5]));
    // A sender that comes meanwhile watches; it drives as soon as the page does not.
    let mut sender = Sender::tcp(&served);
    assert_eq!(sender.ask("G0 X2").last().unwrap(), "error:8");
    page.say("release");
    sender.until(|line| line.starts_with("Grbl 1.1"));
    sender.done("G91 G1 X20 F60");
    assert_eq!(page.refused("drive"), "web other drives");
    page.send(b"G0 X0\n");
    page.until(|line| line == "error:8");
    // Hold, resume and overrides work beside the sender.
    page.say("hold");
    page.waits("Hold:0");
    for word in ["feed +10", "feed +10", "rapid 25", "spindle -10"] {
        page.say(word);
    }
    assert_eq!(page.state()["overrides"], serde_json::json!([120, 25, 90]));
    page.say("resume");
    page.waits("Run");
    page.say("stop");
    page.waits("Alarm");
    assert_eq!(page.refused("G0 X5"), "web refused G0 X5: unknown");
}

#[test]
fn ten_pages_at_once_are_answered_and_the_eleventh_is_closed() {
    let folder = folder();
    let served = Served::new(&folder, "--web 0");
    let mut pages: Vec<Page> = (0..10).map(|_| Page::new(&served)).collect();
    for page in &mut pages {
        assert_eq!(page.state()["state"], "Idle");
    }
    let mut eleventh = Page::new(&served);
    assert!(eleventh.socket.read().is_err());
    // The pages drive nothing: a sender that comes later does.
    let mut sender = Sender::tcp(&served);
    sender.done("G0 X1");
    for page in &mut pages {
        page.waits("Idle");
        assert_eq!(page.state()["machine"][0], 1.0);
    }
    drop(pages);
    let begin = Instant::now();
    loop {
        let mut page = Page::new(&served);
        page.say("?");
        if page.socket.read().is_ok() {
            break;
        }
        assert!(begin.elapsed() < PATIENCE);
    }
}

#[test]
fn garbage_and_silence_harm_nothing() {
    let folder = folder();
    let served = Served::new(&folder, "--web 0");
    let address = served.web_address();
    for garbage in
        [&b"\x16\x03\x01\x00\xff\x01\x00\n\n"[..], b"G0 X5\n!\x18\n", b"\0\0\0\0\r\n\r\n"]
    {
        let said = answered(&address, garbage);
        assert!(said.starts_with("HTTP/1.1 400 Bad Request\r\n"), "{garbage:?}: {said}");
    }
    let endless = format!("GET / HTTP/1.1\r\nA: {}", "a".repeat(9000));
    assert!(answered(&address, endless.as_bytes()).starts_with("HTTP/1.1 400 "));
    // Silent connections, more than are kept, keep nobody out.
    let silent: Vec<TcpStream> = (0..40).map(|_| TcpStream::connect(&address).unwrap()).collect();
    let mut page = Page::with_token(&served);
    // Frames that are no frames, and a message that is too long, close their connection only.
    let mut broken = Page::new(&served);
    broken.socket.get_mut().write_all(&[0xff; 64]).unwrap();
    while broken.socket.read().is_ok() {}
    let mut long = Page::with_token(&served);
    long.send(&[b'a'; 5000]);
    while long.socket.read().is_ok() {}
    // A page that never reads keeps nobody waiting.
    let mut deaf = Page::new(&served);
    (0..500).for_each(|_| deaf.say("?"));
    assert_eq!(page.state()["state"], "Idle");
    assert_eq!(page.address, address);
    drop(silent);
    assert_eq!(served.interrupt().0, 0);
}

#[test]
fn page_that_drives_and_vanishes_is_a_sender_that_vanishes() {
    let folder = folder();
    for (option, ends) in [("finish", true), ("stop", false)] {
        let served = Served::new(&folder, &format!("--web 0 --when-gone {option}"));
        let mut page = Page::with_token(&served);
        page.say("drive");
        page.until(|line| line == "web drives");
        page.send(b"G21 G91 F180\nG1 X5\n");
        page.waits("Run");
        drop(page);
        let mut page = Page::new(&served);
        let begin = Instant::now();
        while page.state()["driver"] != "nobody" {
            assert!(begin.elapsed() < PATIENCE);
        }
        let at = page.waits("Idle")["machine"][0].as_f64().unwrap();
        assert_eq!(at >= 5.0, ends, "{option}: {at}");
    }
}
