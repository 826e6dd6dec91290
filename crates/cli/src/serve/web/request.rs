//! The head of an HTTP request: what it asks for, or why it is refused.

use httparse::{EMPTY_HEADER, Request, Status};
use std::net::SocketAddr;

/// Most bytes of the head of a request.
pub const LONGEST_HEAD: usize = 8192;
/// Most headers.
const MOST_HEADERS: usize = 64;
/// The port of addresses that name none.
const HTTP: u16 = 80;

/// What a request asks for.
#[derive(Debug, PartialEq, Eq)]
pub enum Asked {
    /// The head is not whole.
    More,
    /// The page.
    Page,
    /// A WebSocket with this key. The head has so many bytes.
    Socket { key: String, head: usize },
    /// It is refused with this status, for this reason.
    Refused(&'static str, String),
}

/// Judges what has come of a request at an address of this computer.
pub fn judge(bytes: &[u8], at: SocketAddr) -> Asked {
    let mut headers = [EMPTY_HEADER; MOST_HEADERS];
    let mut request = Request::new(&mut headers);
    let head = match request.parse(bytes) {
        Ok(Status::Complete(head)) => head,
        Ok(Status::Partial) if bytes.len() < LONGEST_HEAD => return Asked::More,
        Ok(Status::Partial) => return bad("its head is too long"),
        Err(error) => return bad(&error.to_string()),
    };
    let Header::One(host) = header(&request, "host") else {
        return bad("it needs one header Host");
    };
    let names = names(at);
    if !names.iter().any(|name| name.eq_ignore_ascii_case(host)) {
        return forbidden(format!("this page is at http://{}/ only", names.join("/ and http://")));
    }
    let other = || forbidden("a page of another origin may not connect".to_owned());
    match header(&request, "origin") {
        Header::None => {}
        Header::One(origin) => match origin.strip_prefix("http://") {
            Some(origin) if origin.eq_ignore_ascii_case(host) => {}
            _ => return other(),
        },
        Header::Bad => return other(),
    }
    if request.method != Some("GET") {
        return Asked::Refused("405 Method Not Allowed", "only GET is answered".to_owned());
    }
    match request.path.unwrap_or_default() {
        "/" => Asked::Page,
        "/socket" => socket(&request, head),
        _ => Asked::Refused("404 Not Found", "there is one page: /".to_owned()),
    }
}

fn socket(request: &Request<'_, '_>, head: usize) -> Asked {
    let is = |name: &str, value: &str| {
        let Header::One(found) = header(request, name) else { return false };
        found.split(',').any(|part| part.trim().eq_ignore_ascii_case(value))
    };
    if !is("upgrade", "websocket")
        || !is("connection", "upgrade")
        || !is("sec-websocket-version", "13")
    {
        return bad("/socket is a WebSocket of version 13");
    }
    match header(request, "sec-websocket-key") {
        Header::One(key) if !key.is_empty() => Asked::Socket { key: key.to_owned(), head },
        _ => bad("a WebSocket needs a key"),
    }
}

/// A header of a request.
enum Header<'a> {
    None,
    One(&'a str),
    /// There are several, or it is no text.
    Bad,
}

fn header<'a>(request: &'a Request<'_, '_>, name: &str) -> Header<'a> {
    let mut found = request.headers.iter().filter(|one| one.name.eq_ignore_ascii_case(name));
    match (found.next(), found.next()) {
        (None, _) => Header::None,
        (Some(one), None) => {
            std::str::from_utf8(one.value).map_or(Header::Bad, |value| Header::One(value.trim()))
        }
        _ => Header::Bad,
    }
}

/// How a browser may name this address. A number cannot be bound to another computer later, as a
/// name can.
fn names(at: SocketAddr) -> Vec<String> {
    let (ip, port) = (at.ip().to_canonical(), at.port());
    let address = SocketAddr::new(ip, port).to_string();
    let mut names = vec![address];
    if ip.is_loopback() {
        names.push(format!("localhost:{port}"));
    }
    if port == HTTP {
        let short: Vec<String> =
            names.iter().filter_map(|name| name.strip_suffix(":80").map(str::to_owned)).collect();
        names.extend(short);
    }
    names
}

fn bad(why: &str) -> Asked {
    Asked::Refused("400 Bad Request", format!("no request: {why}"))
}

const fn forbidden(why: String) -> Asked {
    Asked::Refused("403 Forbidden", why)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn judged(request: &str) -> Asked {
        let request = request.replace('\n', "\r\n");
        judge(request.as_bytes(), "127.0.0.1:8000".parse().unwrap())
    }

    fn status(asked: &Asked) -> &str {
        match asked {
            Asked::Refused(status, _) => &status[..3],
            Asked::Page => "page",
            Asked::Socket { .. } => "socket",
            Asked::More => "more",
        }
    }

    #[test]
    fn only_the_own_host_and_origin_are_served() {
        for (headers, expected) in [
            ("Host: 127.0.0.1:8000", "page"),
            ("host: LOCALHOST:8000", "page"),
            ("Host: localhost:8000\nOrigin: http://localhost:8000", "page"),
            ("Host: localhost:8000\nOrigin: http://127.0.0.1:8000", "403"),
            ("Host: localhost:8000\nOrigin: https://localhost:8000", "403"),
            ("Host: localhost:8000\nOrigin: null", "403"),
            ("Host: localhost:8000\nOrigin: http://localhost:8000\nOrigin: http://a", "403"),
            ("Host: localhost", "403"),
            ("Host: localhost:80", "403"),
            ("Host: rebound.example:8000", "403"),
            ("Host: 192.168.1.1:8000", "403"),
            ("Host: localhost:8000\nHost: rebound.example:8000", "400"),
            ("Accept: */*", "400"),
        ] {
            let asked = judged(&format!("GET / HTTP/1.1\n{headers}\n\n"));
            assert_eq!(status(&asked), expected, "{headers}: {asked:?}");
        }
        // At the port of HTTP, browsers send no port.
        let at = "[::ffff:192.168.1.1]:80".parse().unwrap();
        for (host, expected) in [("192.168.1.1", "page"), ("localhost", "403")] {
            let request = format!("GET / HTTP/1.1\r\nHost: {host}\r\n\r\n");
            assert_eq!(status(&judge(request.as_bytes(), at)), expected, "{host}");
        }
    }

    #[test]
    fn requests_are_judged_as_soon_as_they_are_whole_or_wrong() {
        let whole = "GET / HTTP/1.1\r\nHost: localhost:8000\r\n\r\n";
        let at = "127.0.0.1:8000".parse().unwrap();
        for end in 0..whole.len() {
            assert_eq!(judge(&whole.as_bytes()[..end], at), Asked::More, "{end}");
        }
        assert_eq!(judge(whole.as_bytes(), at), Asked::Page);
        for garbage in ["\x16\x03\x01\x02\n\n", "G1 X5\n", "!\x18\n\n", "GET / HTTP/9\n\n"] {
            assert_eq!(status(&judged(garbage)), "400", "{garbage:?}");
        }
        let long = format!("GET / HTTP/1.1\r\nA: {}", "a".repeat(LONGEST_HEAD));
        assert_eq!(status(&judge(long.as_bytes(), at)), "400");
        for (request, expected) in [("POST /", "405"), ("GET /~", "404"), ("GET /socket", "400")] {
            let asked = judged(&format!("{request} HTTP/1.1\nHost: localhost:8000\n\n"));
            assert_eq!(status(&asked), expected, "{request}");
        }
    }
}
