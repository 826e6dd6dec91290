//! The line to a board: opened, known, and what went wrong with it.

use crate::arguments::{Peer, Port};
use crate::failure::Failure;
use crate::interrupt;
use carrystep_link::host::SystemClock;
use carrystep_link::line::serial::{OpenError, SerialLine};
use carrystep_link::registers::CAUSES;
use carrystep_link::{Host, HostError, Patience};
use carrystep_spec::Machine;
use carrystep_spec::link::{BuildId, Line, Uart};
use std::io;
use std::path::Path;

/// A board on a serial port.
pub type Board = Host<SerialLine, SystemClock>;

/// What goes wrong between it and us.
pub type BoardError = HostError<io::Error>;

/// A connected board, and the names of its axes.
pub struct Connection {
    /// The board.
    pub board: Board,
    /// A name for each axis of the build.
    pub axes: Vec<String>,
}

/// The machine's UART and the id of its engine on it; `name` is the file that says so.
pub fn wanted(machine: &Machine, name: &Path) -> Result<(Uart, BuildId), Failure> {
    let refused = |error: String| Failure::input(format!("{}: {error}", name.display()));
    let engine = machine.engine();
    engine.check().map_err(|error| refused(error.to_string()))?;
    match machine.line().map_err(|error| refused(error.to_string()))? {
        Line::Uart(uart) => Ok((uart, uart.build_id(&engine))),
        Line::Spi => Err(refused("its host link is an SPI: no serial port leads there".to_owned())),
    }
}

/// Connects to the board of a machine; any other is refused. Nothing is written.
pub fn to_machine(port: &Port, machine: &Machine, name: &Path) -> Result<Connection, Failure> {
    let (uart, id) = wanted(machine, name)?;
    let board = connect(&port.name, uart.baud(), Some(id))?;
    Ok(Connection { board, axes: machine.axes.iter().map(|axis| axis.name.clone()).collect() })
}

/// Connects to whatever carrystep board there is, or to the one of a machine.
pub fn to_peer(peer: &Peer) -> Result<Connection, Failure> {
    if let Some(path) = &peer.machine {
        return to_machine(&peer.port, &Machine::load(path)?, path);
    }
    let board = connect(&peer.port.name, peer.baud, None)?;
    let axes = (0..board.facts().axes).map(|axis| axis.to_string()).collect();
    Ok(Connection { board, axes })
}

fn connect(port: &str, baud: u32, id: Option<BuildId>) -> Result<Board, Failure> {
    // From here on Ctrl-C is a stop that is waited for.
    interrupt::watch();
    let line = SerialLine::open(port, baud).map_err(|error| Failure::input(opening(port, &error)))?;
    // Whoever is there but is not who was meant is wrong input: nothing was moved.
    Board::connect(line, SystemClock::default(), id.map(|id| id.0), Patience::default())
        .map_err(|error| Failure::input(format!("{port}: {error}")))
}

/// The doctor knows more of why a port may not be used.
fn opening(port: &str, error: &OpenError) -> String {
    let access = match error {
        OpenError::Busy { .. } | OpenError::NotPermitted { .. } => carrystep_doctor::obstacle(Path::new(port)),
        OpenError::Absent { .. } | OpenError::NoPort { .. } | OpenError::Unusable { .. } => None,
    };
    access.map_or_else(|| error.to_string(), |access| format!("serial port {port} {access}"))
}

/// What went wrong with a board that was driven already; its axes have these names.
pub fn broken(error: &BoardError, axes: &[String]) -> Failure {
    let of = |mask: u8| {
        let is_of = |number: usize| mask.checked_shr(number as u32).is_some_and(|bits| bits & 1 == 1);
        let names: Vec<&str> = (0..).zip(axes).filter(|&(number, _)| is_of(number)).map(|(_, name)| &**name).collect();
        names.join(", ")
    };
    match *error {
        HostError::Program(error) => Failure::input(error.to_string()),
        HostError::Line(ref why) => Failure::Run(format!("{error}: {why}; what moves stops by its watchdog")),
        HostError::NotIdle => Failure::Run(format!("{error}: `carrystep stop --clear` does that")),
        HostError::Fault { cause, culprits } => {
            let cause = CAUSES.get(usize::from(cause)).unwrap_or(&"?");
            let from = if culprits == 0 { String::new() } else { format!(", from {}", of(culprits)) };
            Failure::Run(format!("the machine has stopped: {cause}{from}; `carrystep stop --clear` resumes"))
        }
        HostError::NoLimit { axes } => {
            Failure::Run(format!("the homing move is over, and no limit was met by {}", of(axes)))
        }
        _ => Failure::Run(error.to_string()),
    }
}
