//! The lines themselves: SPI as a bus sees it, serial ports that are there, busy, absent or none at all.
#![allow(clippy::unwrap_used, reason = "clippy.toml's allowance reaches unit tests only")]

mod support;

use carrystep_link::line::serial::{OpenError, SerialLine};
use carrystep_link::line::spi::SpiLine;
use carrystep_link::{Clock, Exchanged, Host, HostError, Line, Patience};
use embedded_hal::spi::{ErrorType, Operation, SpiDevice};
use serialport::{SerialPort, TTYPort};
use std::collections::VecDeque;
use std::convert::Infallible;
use std::io::{Read, Write};
use support::device::Device;

/// A gateware on a bus: each byte goes both ways at once.
struct Bus {
    device: Device,
    back: VecDeque<u8>,
    seen: Vec<u8>,
}

impl Bus {
    fn new() -> Self {
        Self { device: Device::new(6, 0x2a), back: VecDeque::new(), seen: Vec::new() }
    }
}

impl ErrorType for Bus {
    type Error = Infallible;
}

impl SpiDevice for Bus {
    fn transaction(&mut self, operations: &mut [Operation<'_, u8>]) -> Result<(), Infallible> {
        for operation in operations {
            let Operation::TransferInPlace(bytes) = operation else { panic!("another operation") };
            for byte in bytes.iter_mut() {
                self.seen.push(*byte);
                let out = std::mem::replace(byte, self.back.pop_front().unwrap_or(0xc0));
                self.back.extend(self.device.byte(out));
            }
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
fn spi_sends_end_while_there_is_nothing_to_say() {
    let mut line = SpiLine::new(Bus::new());
    let mut into = [0; 64];
    assert_eq!(line.exchange(&[], &mut into).unwrap(), Exchanged { sent: 0, received: 16 });
    assert_eq!(line.exchange(&[1; 5], &mut into).unwrap(), Exchanged { sent: 5, received: 16 });
    assert_eq!(line.exchange(&[2; 40], &mut into).unwrap(), Exchanged { sent: 40, received: 40 });
    assert_eq!(line.exchange(&[3; 90], &mut into).unwrap(), Exchanged { sent: 64, received: 64 });
    assert_eq!(line.exchange(&[4; 9], &mut into[..4]).unwrap(), Exchanged { sent: 4, received: 4 });
    let bus = line.free();
    let expected = [vec![0xc0; 16], vec![1; 5], vec![0xc0; 11], vec![2; 40], vec![3; 64], vec![4; 4]];
    assert_eq!(bus.seen, expected.concat());
}

#[test]
fn a_host_over_spi() {
    let mut host: Host<_, _> =
        Host::connect(SpiLine::new(Bus::new()), Counter(0), Some(0x0123_4567_89ab_cdef), Patience::default()).unwrap();
    host.enable().unwrap();
    let segment = carrystep_link::Segment { ticks: 3, v: 1 << 50, a: 0, j: 0, last: true };
    // Time stands still on this bus, so the move never ends: it is stopped.
    let ended = host.jog(1, &[segment], |progress| {
        if progress.handed_over { carrystep_link::Wish::Stop } else { carrystep_link::Wish::GoOn }
    });
    assert_eq!(ended, Ok(carrystep_link::Ended::Stopped));
    assert_eq!(host.free().free().device.log.len(), 4);
}

#[test]
fn a_host_over_a_serial_port() {
    let (mut board, port) = TTYPort::pair().unwrap();
    let behind = std::thread::spawn(move || {
        let mut device = Device::new(6, 0);
        board.set_timeout(std::time::Duration::from_millis(5)).unwrap();
        let mut bytes = [0; 256];
        loop {
            match board.read(&mut bytes) {
                Ok(come) => {
                    let answers: Vec<u8> = bytes[..come].iter().flat_map(|&byte| device.byte(byte)).collect();
                    board.write_all(&answers).unwrap();
                }
                Err(error) if error.kind() == std::io::ErrorKind::TimedOut => device.elapse(2000),
                Err(_) => return device,
            }
        }
    });
    let patience = Patience { silence: 60_000, change: 60_000, ..Patience::default() };
    let line = SerialLine::from_port(Box::new(port));
    let mut host: Host<_, carrystep_link::host::SystemClock> =
        Host::connect(line, carrystep_link::host::SystemClock::default(), None, patience).unwrap();
    host.enable().unwrap();
    let segment = carrystep_link::Segment { ticks: 5000, v: 1 << 50, a: 0, j: 0, last: true };
    let ended = host.jog(1, &[segment], |_| carrystep_link::Wish::GoOn).unwrap();
    assert_eq!((ended, host.status().positions[1]), (carrystep_link::Ended::Done, 5000));
    drop(host);
    assert_eq!(behind.join().unwrap().log.len(), 3);
}

#[test]
fn a_port_that_cannot_be_opened_says_why() {
    let absent = SerialLine::open("/dev/carrystep-none", 921_600).err().unwrap();
    assert!(matches!(&absent, OpenError::Absent { port, .. } if port == "/dev/carrystep-none"), "{absent}");
    assert!(absent.to_string().starts_with("there is no serial port /dev/carrystep-none: "), "{absent}");

    let (_board, port) = TTYPort::pair().unwrap();
    let name = port.name().unwrap();
    drop(port);
    let first = SerialLine::open(&name, 921_600).unwrap();
    let busy = SerialLine::open(&name, 921_600).err().unwrap();
    assert_eq!(busy, OpenError::Busy { port: name });
    drop(first);

    let file = tempfile::NamedTempFile::new().unwrap();
    let none = SerialLine::open(file.path().to_str().unwrap(), 921_600).err().unwrap();
    assert!(matches!(none, OpenError::Unusable { .. }), "{none}");
}

#[test]
fn a_line_that_is_gone_is_named() {
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
