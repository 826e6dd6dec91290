//! One kept answer as a file: the SHA-256 of all that follows, a line that says how long each part
//! is, and the parts.

use serde_json::{Value, json};
use sha2::{Digest as _, Sha256};
use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs;
use std::io::{self, Write as _};
use std::path::Path;

/// What a tool that ended with success has said and written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Record {
    pub stdout: Vec<u8>,
    pub stderr: Vec<u8>,
    /// Name and content of each file.
    pub files: BTreeMap<String, Vec<u8>>,
}

impl Record {
    /// The answer in a file; none where there is none, where somebody else could have written it,
    /// or where it is not as it was written.
    pub fn read(file: &Path) -> Option<Self> {
        if !carrystep_files::cache_holds(file).ok()? {
            return None;
        }
        let record = Self::parse(&fs::read(file).ok()?)?;
        // The date says when it was used last; where it cannot be set, the answer is removed early.
        let _ = fs::File::options()
            .append(true)
            .open(file)
            .and_then(|file| file.set_modified(std::time::SystemTime::now()));
        Some(record)
    }

    fn parse(bytes: &[u8]) -> Option<Self> {
        let (hash, rest) = line(bytes)?;
        if hex(&Sha256::digest(rest)).as_bytes() != hash {
            return None;
        }
        let (head, mut rest) = line(rest)?;
        let head: Value = serde_json::from_slice(head).ok()?;
        let mut part = |length: &Value| {
            let (part, after) = rest.split_at_checked(usize::try_from(length.as_u64()?).ok()?)?;
            rest = after;
            Some(part.to_vec())
        };
        let (stdout, stderr) = (part(&head["stdout"])?, part(&head["stderr"])?);
        let files = head["files"].as_array()?.iter().map(|file| {
            let name =
                file[0].as_str().filter(|name| !name.contains(['/', '\\']) && *name != "..")?;
            Some((name.to_owned(), part(&file[1])?))
        });
        Some(Self { stdout, stderr, files: files.collect::<Option<_>>()? })
    }

    fn bytes(&self) -> Vec<u8> {
        let files: Vec<Value> =
            self.files.iter().map(|(name, content)| json!([name, content.len()])).collect();
        let head =
            json!({"stdout": self.stdout.len(), "stderr": self.stderr.len(), "files": files});
        let mut rest = format!("{head}\n").into_bytes();
        rest.extend(self.stdout.iter().chain(&self.stderr));
        self.files.values().for_each(|content| rest.extend(content));
        [hex(&Sha256::digest(&rest)).as_bytes(), b"\n", &rest].concat()
    }

    /// Writes it, whole or not at all.
    pub fn write(&self, file: &Path) -> io::Result<()> {
        let folder = file.parent().unwrap_or(Path::new("."));
        let mut new = tempfile::NamedTempFile::new_in(folder)?;
        new.write_all(&self.bytes())?;
        new.persist(file)?;
        Ok(())
    }
}

fn line(bytes: &[u8]) -> Option<(&[u8], &[u8])> {
    let end = bytes.iter().position(|byte| *byte == b'\n')?;
    Some((&bytes[..end], &bytes[end + 1..]))
}

/// Bytes as hexadecimal digits.
pub(super) fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        // Writing to a string cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    })
}

#[cfg(test)]
mod tests {
    use super::Record;

    fn record() -> Record {
        let files =
            [("core.bin", vec![0, 10, 255]), ("log.txt", b"done\n".to_vec()), ("empty", vec![])];
        let files = files.map(|(name, content)| (name.to_owned(), content)).into();
        Record { stdout: b"a\nb".to_vec(), stderr: b"c".to_vec(), files }
    }

    #[test]
    fn an_answer_is_read_as_it_was_written() {
        assert_eq!(Record::parse(&record().bytes()), Some(record()));
        let nothing = Record { stdout: vec![], stderr: vec![], files: [].into() };
        assert_eq!(Record::parse(&nothing.bytes()), Some(nothing));
    }

    #[test]
    fn a_damaged_answer_is_not_used() {
        let bytes = record().bytes();
        for end in 0..bytes.len() {
            assert_eq!(Record::parse(&bytes[..end]), None);
        }
        for place in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[place] ^= 1;
            assert_eq!(Record::parse(&damaged), None, "byte {place}");
        }
    }
}
