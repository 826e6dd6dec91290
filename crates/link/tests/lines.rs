//! Tests of the lines: SPI as seen on the bus, and serial ports that are free, busy, absent or no
//! serial ports. Tests with a host and a board are in crates/virtual-board/tests.

use carrystep_link::line::serial::{OpenError, SerialLine};
use carrystep_link::line::spi::SpiLine;
use carrystep_link::{Clock, Exchanged, Host, HostError, Line, Patience};
use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use serialport::{SerialPort, TTYPort};
use std::convert::Infallible;

/// A bus without a device that records what was sent.
#[derive(Default)]
struct Bus(Vec<u8>);

impl ErrorType for Bus {
    type Error = Infallible;
}

impl SpiDevice for Bus {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        for operation in operations {
            let Operation::TransferInPlace(bytes) = operation else { panic!("another operation") };
            self.0.extend(&**bytes);
        }
        Ok(())
    }
}

struct Counter(u32);

impl Clock for Counter {
    fn milliseconds(&mut self) -> u32 {
        self.0 += 1;
        self.0 / 8
    }
}

#[test]
fn spi_sends_end_while_there_is_nothing_else_to_send() {
    let mut line = SpiLine::new(Bus::default());
    let mut into = [0; 64];
    assert_eq!(line.exchange(&[], &mut into).unwrap(), Exchanged { sent: 0, received: 16 });
    assert_eq!(line.exchange(&[1; 5], &mut into).unwrap(), Exchanged { sent: 5, received: 16 });
    assert_eq!(line.exchange(&[2; 40], &mut into).unwrap(), Exchanged { sent: 40, received: 40 });
    assert_eq!(line.exchange(&[3; 90], &mut into).unwrap(), Exchanged { sent: 64, received: 64 });
    assert_eq!(line.exchange(&[4; 9], &mut into[..4]).unwrap(), Exchanged { sent: 4, received: 4 });
    let expected =
        [vec![0xc0; 16], vec![1; 5], vec![0xc0; 11], vec![2; 40], vec![3; 64], vec![4; 4]];
    assert_eq!(line.free().0, expected.concat());
}

/// A second host must not open the port, or the two would take each other's acknowledgements for
/// their own.
#[cfg(unix)]
#[test]
fn port_is_locked_under_all_of_its_names() {
    let (_board, port) = TTYPort::pair().unwrap();
    let name = port.name().unwrap();
    drop(port);
    let folder = tempfile::tempdir().unwrap();
    let link = folder.path().join("port");
    std::os::unix::fs::symlink(&name, &link).unwrap();
    let first = SerialLine::open(&name, 921_600).unwrap();
    for other in [name.as_str(), link.to_str().unwrap()] {
        let refused = SerialLine::open(other, 921_600).err().unwrap();
        assert!(matches!(&refused, OpenError::Busy { .. }), "{refused}");
    }
    drop(first);
    SerialLine::open(link.to_str().unwrap(), 921_600).unwrap();
}

/// A board that does not read must not block its host.
#[cfg(unix)]
#[test]
fn line_that_nobody_reads_does_not_block() {
    let (_board, port) = TTYPort::pair().unwrap();
    let name = port.name().unwrap();
    drop(port);
    let mut line = SerialLine::open(&name, 3_000_000).unwrap();
    let (tell, told) = std::sync::mpsc::channel();
    std::thread::spawn(move || {
        let sent: usize =
            (0..1000).map(|_| line.exchange(&[0x55; 256], &mut [0; 256]).unwrap().sent).sum();
        tell.send(sent).unwrap();
    });
    let sent = told.recv_timeout(std::time::Duration::from_secs(30)).expect("it hangs");
    assert!((8_192..=12_288).contains(&sent), "{sent}");
}

#[test]
fn port_that_cannot_be_opened_gives_the_reason() {
    let absent = SerialLine::open("/dev/carrystep-none", 921_600).err().unwrap();
    assert!(
        matches!(&absent, OpenError::Absent { port, .. } if port == "/dev/carrystep-none"),
        "{absent}"
    );
    assert!(
        absent.to_string().starts_with("there is no serial port /dev/carrystep-none: "),
        "{absent}"
    );

    let (_board, port) = TTYPort::pair().unwrap();
    let name = port.name().unwrap();
    drop(port);
    let first = SerialLine::open(&name, 921_600).unwrap();
    let busy = SerialLine::open(&name, 921_600).err().unwrap();
    assert_eq!(busy, OpenError::Busy { port: name });
    drop(first);

    let file = tempfile::NamedTempFile::new().unwrap();
    for path in [file.path(), file.path().parent().unwrap()] {
        let none = SerialLine::open(path.to_str().unwrap(), 921_600).err().unwrap();
        assert!(matches!(none, OpenError::NoPort { .. }), "{none}");
    }
    let none = SerialLine::open("/dev/null", 921_600).err().unwrap();
    assert!(matches!(none, OpenError::Unusable { .. }), "{none}");
}

#[test]
fn lost_line_is_reported() {
    struct Gone;
    impl Line for Gone {
        type Error = &'static str;
        fn exchange(&mut self, _: &[u8], _: &mut [u8]) -> Result<Exchanged, &'static str> {
            Err("unplugged")
        }
    }
    let error = Host::<_, _>::connect(Gone, Counter(0), None, Patience::default()).err().unwrap();
    assert_eq!(error, HostError::Line("unplugged"));
}
