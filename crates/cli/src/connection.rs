//! The line to a board: opened, known, and what went wrong with it.

use crate::arguments::{Peer, Port};
use crate::control::{self, Control, Holder, Request};
use crate::failure::Failure;
use crate::found::{Known, names};
use crate::interrupt;
use carrystep_core::engine::CAUSES;
use carrystep_core::link::{BuildId, Line, Uart};
use carrystep_files::{Axis, Machine, decimal};
use carrystep_link::host::SystemClock;
use carrystep_link::line::serial::{OpenError, SerialLine};
use carrystep_link::{Facts, Host, HostError, Patience};
use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

/// For so long a command waits for one that only looks or stops: those give the port back by themselves.
const SOON: Duration = Duration::from_secs(2);

/// A board on a serial port.
pub type Board = Host<SerialLine, SystemClock>;

/// What goes wrong between it and us.
pub type BoardError = HostError<io::Error>;

/// A connected board, the names of its axes, and the hold on its port.
pub struct Connection {
    /// The board.
    pub board: Board,
    /// A name for each axis of the build.
    pub axes: Vec<String>,
    /// Steps in a unit of each axis; empty where no machine is known.
    pub steps_per_unit: Vec<f64>,
    /// The port's name.
    pub port: String,
    /// The hold on the port: other commands find out who drives the board, and reach that one.
    pub control: Control,
}

/// Why there is no connection.
pub struct Refused {
    /// Another program has the port.
    pub busy: bool,
    /// What to tell.
    pub failure: Failure,
}

impl From<Refused> for Failure {
    fn from(refused: Refused) -> Self {
        refused.failure
    }
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

/// Connects to the board of a machine, to drive it by a command of this name; any other board is refused. Nothing is
/// written. From now on `carrystep stop` reaches this command through [`Connection::control`].
pub fn to_machine(port: &Port, machine: &Machine, name: &Path, command: &'static str) -> Result<Connection, Failure> {
    Ok(machines(port, machine, name, command, true)?)
}

/// Connects to whatever carrystep board there is, at this baud rate, or to the one of a machine, only to look or to stop.
pub fn to_peer(peer: &Peer, baud: u32, command: &'static str) -> Result<Connection, Refused> {
    let fine = |failure| Refused { busy: false, failure };
    if let Some(path) = &peer.machine {
        let machine = Machine::load(path).map_err(|error| fine(error.into()))?;
        return machines(&peer.port, &machine, path, command, false);
    }
    let (board, control) = connect(&peer.port.name, baud, None, command, false)?;
    let axes = (0..board.facts().axes).map(|axis| axis.to_string()).collect();
    Ok(known(Connection { board, axes, steps_per_unit: Vec::new(), port: peer.port.name.clone(), control }))
}

fn machines(
    port: &Port,
    machine: &Machine,
    name: &Path,
    command: &'static str,
    drives: bool,
) -> Result<Connection, Refused> {
    let (uart, id) = wanted(machine, name).map_err(|failure| Refused { busy: false, failure })?;
    let (board, control) = connect(&port.name, uart.baud(), Some(id), command, drives)?;
    let axes = machine.axes.iter().map(|axis| axis.name.clone()).collect();
    // For the eye only: a float decides nothing here.
    let steps = |axis: &Axis| decimal::to_f64(&axis.steps_per_unit);
    let steps_per_unit = machine.axes.iter().map(steps).collect();
    Ok(known(Connection { board, axes, steps_per_unit, port: port.name.clone(), control }))
}

/// The control knows the board now.
fn known(mut connection: Connection) -> Connection {
    let Connection { board, axes, steps_per_unit, port, control } = &mut connection;
    let facts = *board.facts();
    let known = Known { port: port.clone(), facts, axes: axes.clone(), steps_per_unit: steps_per_unit.clone() };
    control.connected(&facts, known);
    connection
}

fn connect(
    port: &str,
    baud: u32,
    id: Option<BuildId>,
    command: &'static str,
    drives: bool,
) -> Result<(Board, Control), Refused> {
    let fine = |message: String| Refused { busy: false, failure: Failure::input(message) };
    let busy = |message: String| Refused { busy: true, failure: Failure::input(message) };
    // From here on Ctrl-C is a stop that is waited for.
    interrupt::watch();
    let unclaimed = |error: io::Error| fine(format!("no lock for the serial port {port} can be made: {error}"));
    let begin = Instant::now();
    let claim = loop {
        if let Some(claim) = control::claim(port, baud, command, drives).map_err(unclaimed)? {
            break claim;
        }
        let holder = control::holder(port);
        if !holder.as_ref().is_some_and(|holder| holder.listens) && begin.elapsed() < SOON {
            std::thread::sleep(Duration::from_millis(5));
            continue;
        }
        let by = holder.map_or_else(|| "another carrystep command".to_owned(), |by| by.to_string());
        let help = "wait for its end, or stop it with `carrystep stop`";
        return Err(busy(format!("serial port {port} is in use by {by}: {help}")));
    };
    let line = SerialLine::open(port, baud).map_err(|error| match error {
        OpenError::Busy { .. } => busy(opening(port, &error)),
        _ => fine(opening(port, &error)),
    })?;
    let control = Control::new(claim, drives).map_err(unclaimed)?;
    // Whoever is there but is not who was meant is wrong input: nothing was moved.
    let board = Board::connect(line, SystemClock::default(), id.map(|id| id.0), Patience::default())
        .map_err(|error| fine(format!("{port}: {error}")))?;
    Ok((board, control))
}

/// The doctor knows more of why a port may not be used.
fn opening(port: &str, error: &OpenError) -> String {
    let access = match error {
        OpenError::Busy { .. } | OpenError::NotPermitted { .. } => carrystep_tools::doctor::obstacle(Path::new(port)),
        OpenError::Absent { .. } | OpenError::NoPort { .. } | OpenError::Unusable { .. } => None,
    };
    access.map_or_else(|| error.to_string(), |access| format!("serial port {port} {access}"))
}

/// What went wrong with a board that was driven already; its axes have these names.
pub fn broken(error: &BoardError, axes: &[String]) -> Failure {
    match *error {
        HostError::Program(error) => Failure::input(error.to_string()),
        HostError::Line(ref why) => Failure::Run(format!("{error}: {why}; what moves stops by its watchdog")),
        HostError::NotIdle => Failure::Run(format!("{error}: `carrystep stop --clear` does that")),
        HostError::Fault { cause, culprits } => {
            let remedy = CAUSES.get(usize::from(cause)).map_or("`carrystep stop --clear`", |cause| cause.remedy());
            let name = CAUSES.get(usize::from(cause)).map_or_else(|| "?".to_owned(), ToString::to_string);
            let from = if culprits == 0 { String::new() } else { format!(", from {}", names(axes, culprits)) };
            Failure::Run(format!("the machine has stopped: {name}{from}; {remedy}"))
        }
        _ => Failure::Run(error.to_string()),
    }
}

/// The same in the middle of a run: where the line is lost, what the axes do now.
pub fn lost(error: &BoardError, axes: &[String], facts: &Facts) -> Failure {
    let why = match error {
        HostError::Line(why) => format!("{error}: {why}"),
        HostError::Lost { .. } | HostError::OutOfStep(_) | HostError::Foreign(_) => error.to_string(),
        _ => return broken(error, axes),
    };
    let watchdog = watchdog((facts.watchdog_ticks, facts.tick_ns));
    Failure::Run(format!("{why}; {watchdog}. Then `carrystep status` says where they are"))
}

/// What stops the axes of a board that hears nothing more, and when; ticks of its watchdog, and ns of a tick.
fn watchdog((ticks, tick_ns): (u32, u32)) -> String {
    if ticks == 0 {
        return "this board has no watchdog: its axes go on until their queues are empty. Press the e-stop".to_owned();
    }
    let ms = (u64::from(ticks) * u64::from(tick_ns)).div_ceil(1_000_000);
    format!(
        "the board's watchdog ramps the axes down {ms} ms after the last request that the board has heard, or a queue \
         that runs dry does so before"
    )
}

/// What to tell where the command that drives the board was asked for this, and does not `answer`, or does not `end`.
pub fn hangs(port: &str, holder: &Holder, asked: Request, what: &str) -> String {
    let pid = holder.pid;
    let asleep = if suspended(pid) {
        let then = if asked == Request::Stop { ": then it stops the axes, as it was asked to" } else { "" };
        format!("; it is suspended, and `kill -CONT {pid}` wakes it{then}")
    } else {
        String::new()
    };
    let now = match holder.watchdog {
        Some(known) => format!("As the board said when that command connected: {}", watchdog(known)),
        None => "It had not connected to the board, so it has moved nothing".to_owned(),
    };
    format!("{holder} holds {port} and does not {what}{asleep}. {now}. If anything still moves, press the e-stop")
}

/// Whether the system has suspended a process: by Ctrl-Z, for one.
fn suspended(pid: u32) -> bool {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
    // Its name stands in parentheses, and may have any characters; the state is the letter behind it.
    stat.rsplit_once(')').is_some_and(|(_, rest)| rest.trim_start().starts_with(['T', 't']))
}
