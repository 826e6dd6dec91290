//! Who holds a port: a lock file named after the device's number, so that every name of the device leads to it.

use super::door::Door;
use super::{Holder, folder};
use carrystep_link::Facts;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read as _, Seek as _, Write as _};
use std::os::unix::fs::{FileTypeExt as _, MetadataExt as _, OpenOptionsExt as _};
use std::path::{Path, PathBuf};

/// A port that this command holds, until it is dropped or the process ends.
pub struct Claim {
    /// The lock file, locked; nothing where the port is no device, which the serial port refuses by its own words.
    lock: Option<(File, PathBuf)>,
    holder: Holder,
}

/// Claims the port for a command of this process. Nothing: another command of this user holds it.
///
/// # Errors
/// The system gives no folder or no file for the lock.
pub fn claim(port: &str, baud: u32, command: &'static str, listens: bool) -> io::Result<Option<Claim>> {
    claim_in(
        folder::folder,
        port,
        Holder { pid: std::process::id(), command: command.to_owned(), baud, listens, watchdog: None },
    )
}

fn claim_in(folder: impl Fn() -> io::Result<PathBuf>, port: &str, holder: Holder) -> io::Result<Option<Claim>> {
    let Some(name) = device(port) else { return Ok(Some(Claim { lock: None, holder })) };
    let path = folder()?.join(name).with_extension("lock");
    loop {
        let mut options = OpenOptions::new();
        let file = options.read(true).write(true).create(true).truncate(false).mode(0o600).open(&path)?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => return Ok(None),
            Err(TryLockError::Error(error)) => return Err(error),
            Ok(()) => {}
        }
        // The holder before may have removed the file between our opening and our locking it.
        if path.metadata().is_ok_and(|there| file.metadata().is_ok_and(|own| own.ino() == there.ino())) {
            let mut claim = Claim { lock: Some((file, path)), holder };
            claim.tell();
            return Ok(Some(claim));
        }
    }
}

impl Claim {
    /// Who this is.
    pub const fn holder(&self) -> &Holder {
        &self.holder
    }

    /// The socket beside the lock. What a holder that was killed has left is replaced.
    pub(super) fn listen(&self) -> io::Result<Option<Door>> {
        self.lock.as_ref().map(|(_, path)| Door::open(path.with_extension("socket"))).transpose()
    }

    /// The board has said how long its watchdog waits.
    pub(super) fn connected(&mut self, facts: &Facts) {
        self.holder.watchdog = Some((facts.watchdog_ticks, facts.tick_ns));
        self.tell();
    }

    /// Writes into the lock file who holds it. It is a courtesy to others, so a full disk stops nothing.
    fn tell(&mut self) {
        if let Some((file, _)) = &mut self.lock
            && let Ok(text) = serde_json::to_string(&self.holder)
        {
            let _ = file.set_len(0).and_then(|()| file.rewind()).and_then(|()| file.write_all(text.as_bytes()));
        }
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        if let Some((_, path)) = &self.lock {
            // It is still locked, so nobody else uses it.
            let _ = std::fs::remove_file(path);
        }
    }
}

/// Who holds the port, where that is a command of this user.
pub fn holder(port: &str) -> Option<Holder> {
    let name = device(port)?;
    folder::all().iter().find_map(|folder| held(&folder.join(&name).with_extension("lock")))
}

fn held(path: &Path) -> Option<Holder> {
    let mut file = File::open(path).ok()?;
    match file.try_lock_shared() {
        Err(TryLockError::WouldBlock) => {}
        // Whoever wrote it is gone.
        _ => return None,
    }
    let mut text = String::new();
    file.read_to_string(&mut text).ok()?;
    serde_json::from_str(&text).ok()
}

/// A name for the device behind a port: its major and minor number; nothing where there is no such device.
pub(super) fn device(port: &str) -> Option<String> {
    let there = std::fs::metadata(port).ok().filter(|there| there.file_type().is_char_device())?;
    let number = there.rdev();
    Some(format!("{}-{}", rustix::fs::major(number), rustix::fs::minor(number)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_name_of_a_device_leads_to_its_number() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("port");
        std::os::unix::fs::symlink("/dev/null", &link).unwrap();
        if cfg!(target_os = "linux") {
            assert_eq!(device("/dev/null").unwrap(), "1-3");
        }
        assert_eq!(device(link.to_str().unwrap()), device("/dev/null"));
        assert_eq!(device(folder.path().to_str().unwrap()), None);
        assert_eq!(device("/dev/carrystep-none"), None);
    }

    #[test]
    fn a_port_has_one_holder_at_a_time() {
        let folder = tempfile::tempdir().unwrap();
        let who =
            |command: &str| Holder { pid: 7, command: command.to_owned(), baud: 9600, listens: true, watchdog: None };
        let take = |command| claim_in(|| Ok(folder.path().to_owned()), "/dev/null", who(command)).unwrap();
        let mut first = take("run").expect("nobody has it");
        let path = first.lock.as_ref().unwrap().1.clone();
        assert!(take("jog").is_none());
        first.connected(&Facts { watchdog_ticks: 50_000, tick_ns: 2000, ..Facts::default() });
        assert_eq!(held(&path), Some(Holder { watchdog: Some((50_000, 2000)), ..who("run") }));
        drop(first);
        assert_eq!(held(&path), None);
        // What a holder that was killed has left: a file that nobody has locked.
        std::fs::write(&path, serde_json::to_string(&who("run")).unwrap()).unwrap();
        assert_eq!(held(&path), None);
        let second = take("jog").expect("nobody has it");
        assert_eq!(held(&path), Some(who("jog")));
        drop(second);
        assert!(!path.exists());
    }
}
