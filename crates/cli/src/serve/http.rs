//! Recognizes HTTP at the beginning of a connection. A web page of any site can make a browser
//! connect to a port of this computer, and its bytes must not reach the machine: `~` in an address
//! would let it go on.

/// The words with which a line of HTTP begins, each with its blank.
const METHODS: [&[u8]; 10] = [
    b"GET ",
    b"HEAD ",
    b"POST ",
    b"PUT ",
    b"DELETE ",
    b"CONNECT ",
    b"OPTIONS ",
    b"TRACE ",
    b"PATCH ",
    b"PRI ",
];

/// The beginning of a connection.
#[derive(Debug, Default)]
pub struct Beginning {
    held: Vec<u8>,
    is_over: bool,
}

/// What the bytes so far are.
#[derive(Debug, PartialEq, Eq)]
pub enum Judged {
    /// These bytes are no HTTP.
    Fine(Vec<u8>),
    /// HTTP: the connection is to be closed, and nothing of it acts.
    Http,
}

impl Beginning {
    /// Judges further bytes. Bytes that may begin a line of HTTP are kept back.
    pub fn judge(&mut self, bytes: &[u8]) -> Judged {
        if self.is_over {
            return Judged::Fine(bytes.to_vec());
        }
        self.held.extend_from_slice(bytes);
        let held = &self.held;
        if METHODS.iter().any(|method| held.starts_with(method)) {
            return Judged::Http;
        }
        if METHODS.iter().any(|method| method.starts_with(held)) {
            return Judged::Fine(Vec::new());
        }
        self.is_over = true;
        Judged::Fine(std::mem::take(&mut self.held))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What acts of these bytes, if they come in pieces of this length.
    fn judged(bytes: &[u8], piece: usize) -> Option<Vec<u8>> {
        let mut beginning = Beginning::default();
        let mut out = Vec::new();
        for bytes in bytes.chunks(piece) {
            match beginning.judge(bytes) {
                Judged::Fine(bytes) => out.extend(bytes),
                Judged::Http => {
                    assert!(out.is_empty());
                    return None;
                }
            }
        }
        Some(out)
    }

    #[test]
    fn http_is_recognized_in_any_pieces_before_anything_acts() {
        for piece in 1..40 {
            for request in ["GET /~?!\x18 HTTP/1.1\r\n", "POST / HTTP/1.1\r\n~", "OPTIONS * HTTP"] {
                assert_eq!(judged(request.as_bytes(), piece), None, "{request} {piece}");
            }
            for line in ["G1 X1\n~", "?", "$$\n", "\n", "GE\n", "\x18", "G0 X1 GET /\n", "g"] {
                let bytes = line.as_bytes();
                assert_eq!(judged(bytes, piece).as_deref(), Some(bytes), "{line:?} {piece}");
            }
        }
        // A line that may still become HTTP waits for its next byte.
        assert_eq!(judged(b"G", 1).as_deref(), Some(&b""[..]));
    }
}
