//! The claim on a port: a lock file named after the device's number, so that every path of the
//! device leads to the same file.

use super::control_socket::ControlSocket;
use super::{Holder, folder};
use crate::json;
use carrystep_link::BuildFacts;
use rustix::io::Errno;
use rustix::process::{Pid, test_kill_process};
use std::fs::{File, OpenOptions, TryLockError};
use std::io::{self, Read as _, Seek as _, Write as _};
use std::os::unix::fs::{FileTypeExt as _, MetadataExt as _, OpenOptionsExt as _};
use std::path::{Path, PathBuf};

/// A port that this command holds until the claim is dropped or the process ends.
pub struct PortClaim {
    /// The locked file; `None` if the port is not a device, in which case opening the port fails
    /// with its own message.
    lock: Option<(File, PathBuf)>,
    holder: Holder,
}

/// Claims the port for a command of this process. Returns `None` if another command of this user
/// holds it.
///
/// # Errors
/// The system refuses the folder or the lock file.
pub fn claim(
    port: &str,
    baud: u32,
    command: &'static str,
    listens: bool,
) -> io::Result<Option<PortClaim>> {
    claim_in(
        folder::folder,
        port,
        Holder {
            pid: std::process::id(),
            command: command.to_owned(),
            baud,
            listens,
            watchdog: None,
        },
    )
}

fn claim_in(
    folder: impl Fn() -> io::Result<PathBuf>,
    port: &str,
    holder: Holder,
) -> io::Result<Option<PortClaim>> {
    let Some(name) = device(port) else { return Ok(Some(PortClaim { lock: None, holder })) };
    let path = folder()?.join(name).with_extension("lock");
    loop {
        let mut options = OpenOptions::new();
        let file =
            options.read(true).write(true).create(true).truncate(false).mode(0o600).open(&path)?;
        match file.try_lock() {
            Err(TryLockError::WouldBlock) => return Ok(None),
            Err(TryLockError::Error(error)) => return Err(error),
            Ok(()) => {}
        }
        // The previous holder may have removed the file after it was opened and before it was
        // locked.
        if path
            .metadata()
            .is_ok_and(|there| file.metadata().is_ok_and(|own| own.ino() == there.ino()))
        {
            let mut claim = PortClaim { lock: Some((file, path)), holder };
            claim.tell();
            return Ok(Some(claim));
        }
    }
}

impl PortClaim {
    /// The holder that the lock file names.
    pub const fn holder(&self) -> &Holder {
        &self.holder
    }

    /// Opens the socket beside the lock file. A socket that a killed holder has left is replaced.
    pub(super) fn listen(&self) -> io::Result<Option<ControlSocket>> {
        self.lock
            .as_ref()
            .map(|(_, path)| ControlSocket::open(path.with_extension("socket")))
            .transpose()
    }

    /// Adds the watchdog's time of the connected board to the lock file.
    pub(super) fn connected(&mut self, facts: &BuildFacts) {
        self.holder.watchdog = Some((facts.watchdog_ticks, facts.tick_ns));
        self.tell();
    }

    /// What marks the claim as ending.
    ///
    /// # Errors
    /// The system gives no second handle of the lock file.
    pub fn end_mark(&self) -> io::Result<EndMark> {
        let file = self.lock.as_ref().map(|(file, _)| file.try_clone()).transpose()?;
        Ok(EndMark { file, holder: Holder { listens: false, ..self.holder.clone() } })
    }

    /// Writes the holder into the lock file.
    fn tell(&mut self) {
        if let Some((file, _)) = &mut self.lock {
            write(file, &self.holder);
        }
    }
}

/// Writes a holder into a lock file. The content serves messages and tells whether to wait for the
/// holder, so a failed write is ignored.
fn write(file: &mut File, holder: &Holder) {
    if let Ok(text) = json::line(holder) {
        let _ = file
            .set_len(0)
            .and_then(|()| file.rewind())
            .and_then(|()| file.write_all(text.as_bytes()));
    }
}

/// Marks a claim as ending: its command listens no longer, and other commands wait for it.
pub struct EndMark {
    /// The lock file; `None` if the port is not a device.
    file: Option<File>,
    holder: Holder,
}

impl EndMark {
    /// Marks the claim.
    pub fn set(&mut self) {
        if let Some(file) = &mut self.file {
            write(file, &self.holder);
        }
    }
}

impl Drop for PortClaim {
    fn drop(&mut self) {
        if let Some((_, path)) = &self.lock {
            // The file is still locked, so no other command uses it.
            let _ = std::fs::remove_file(path);
        }
    }
}

/// The holder of the port, if it is a command of this user. `None` also while a new holder has not
/// yet written who it is.
pub fn holder(port: &str) -> Option<Holder> {
    let name = device(port)?;
    folder::all().iter().find_map(|folder| held(&folder.join(&name).with_extension("lock")))
}

fn held(path: &Path) -> Option<Holder> {
    let mut file = File::open(path).ok()?;
    match file.try_lock_shared() {
        Err(TryLockError::WouldBlock) => {}
        // The file is not locked, so its writer has ended.
        _ => return None,
    }
    let mut text = String::new();
    file.read_to_string(&mut text).ok()?;
    // A file that a killed holder has left still names that one when the next holder has locked it
    // and has not yet written.
    serde_json::from_str(&text).ok().filter(exists)
}

/// True if the process of this holder exists.
fn exists(holder: &Holder) -> bool {
    let process = i32::try_from(holder.pid).ok().and_then(Pid::from_raw);
    process.is_some_and(|process| test_kill_process(process) != Err(Errno::SRCH))
}

/// A name for the device of a port, made from its major and minor number; `None` if there is no
/// such device.
pub(super) fn device(port: &str) -> Option<String> {
    let there = std::fs::metadata(port).ok().filter(|there| there.file_type().is_char_device())?;
    let number = there.rdev();
    Some(format!("{}-{}", rustix::fs::major(number), rustix::fs::minor(number)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::claimed_line::ClaimedLine;
    use std::cell::Cell;
    use std::rc::Rc;

    fn who(command: &str) -> Holder {
        let command = command.to_owned();
        Holder { pid: std::process::id(), command, baud: 9600, listens: true, watchdog: None }
    }

    #[test]
    fn every_path_of_a_device_gives_the_same_number() {
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
        let take =
            |command| claim_in(|| Ok(folder.path().to_owned()), "/dev/null", who(command)).unwrap();
        let mut first = take("run").expect("nobody has it");
        let path = first.lock.as_ref().unwrap().1.clone();
        assert!(take("jog").is_none());
        first.connected(&BuildFacts {
            watchdog_ticks: 50_000,
            tick_ns: 2000,
            ..BuildFacts::default()
        });
        assert_eq!(held(&path), Some(Holder { watchdog: Some((50_000, 2000)), ..who("run") }));
        first.end_mark().unwrap().set();
        assert!(!held(&path).unwrap().listens);
        assert!(take("jog").is_none());
        drop(first);
        assert_eq!(held(&path), None);
        // A killed holder leaves a file that nobody has locked.
        std::fs::write(&path, serde_json::to_string(&who("run")).unwrap()).unwrap();
        assert_eq!(held(&path), None);
        let second = take("jog").expect("nobody has it");
        assert_eq!(held(&path), Some(who("jog")));
        drop(second);
        assert!(!path.exists());
    }

    #[test]
    fn a_killed_holder_is_not_named_while_the_next_one_has_not_written() {
        let mut ended = std::process::Command::new("true").spawn().unwrap();
        let killed = Holder { pid: ended.id(), ..who("serve") };
        ended.wait().unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("1-3.lock");
        for (left, named) in [(killed, None), (who("run"), Some(who("run")))] {
            std::fs::write(&path, serde_json::to_string(&left).unwrap()).unwrap();
            let next = File::open(&path).unwrap();
            next.lock().unwrap();
            assert_eq!(held(&path), named);
        }
    }

    #[test]
    fn a_claim_is_ending_when_its_port_is_closed() {
        /// A port that notes, when it is closed, whether the holder of its claim listens.
        struct Port(PathBuf, Rc<Cell<Option<bool>>>);
        impl Drop for Port {
            fn drop(&mut self) {
                self.1.set(held(&self.0).map(|holder| holder.listens));
            }
        }
        let folder = tempfile::tempdir().unwrap();
        let claim = claim_in(|| Ok(folder.path().to_owned()), "/dev/null", who("run")).unwrap();
        let claim = claim.expect("nobody has it");
        let path = claim.lock.as_ref().unwrap().1.clone();
        assert!(held(&path).unwrap().listens);
        let listens = Rc::new(Cell::new(None));
        let port = Port(path, listens.clone());
        drop(ClaimedLine::new(port, claim.end_mark().unwrap()));
        assert_eq!(listens.get(), Some(false));
    }
}
