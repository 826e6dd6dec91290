//! The connection to a board: opening the port, identifying the board, and the messages when
//! something fails.

use crate::arguments::{PeerArguments, PortArguments};
use crate::claimed_line::ClaimedLine;
use crate::control::{self, Control, Holder, SocketRequest};
use crate::failure::Failure;
use crate::found::{Known, names};
use crate::interrupt;
use carrystep_core::engine::Cause;
use carrystep_core::link::{BuildId, LineKind, Uart};
use carrystep_files::{Axis, Machine, decimal};
use carrystep_link::host::SystemClock;
use carrystep_link::line::serial::{OpenError, SerialLine};
use carrystep_link::{
    Answer, BuildFacts, Ended, Host, HostError, Patience, Status, random_session,
};
use std::io::{self, Write as _};
use std::path::Path;
use std::time::{Duration, Instant};

/// How long a command waits for a port that is held by a command that only reads or stops, or that
/// has ended; those release it by themselves.
const SOON: Duration = Duration::from_secs(10);

/// Where Linux has its pseudo-terminals, behind which are programs, such as a virtual board.
const PSEUDO_TERMINALS: &str = "/dev/pts/";

/// Times for the answers of a program, ms: until a request is sent again, until a port is given up
/// at which nothing has answered, and until one is given up that has answered before. A busy system
/// was seen to deliver no byte of any pseudo-terminal for 4.4 s, and copies of requests that it then
/// delivers together cost a fast board the time of its queues.
const RESEND_TO_A_PROGRAM: u32 = 3000;
const SILENCE_OF_A_PROGRAM: u32 = 10_000;
const LOSS_OF_A_PROGRAM: u32 = 30_000;

/// Time between two reads of the state of a board that is a program, ms. A fast board runs ahead of the
/// last byte by 6 ms of a move (`PART_IN_A_MOVE` in `crates/virtual-board/src/pace.rs`), and then waits
/// for the next one: with the 20 ms of a real board it would home no faster than a real one.
const STATUS_PERIOD_OF_A_PROGRAM: u32 = 2;

/// A board on a serial port.
pub type ConnectedBoard = Host<ClaimedLine<SerialLine>, SystemClock>;

/// The errors of a board on a serial port.
pub type ConnectedBoardError = HostError<io::Error>;

/// A connected board, the names of its axes, and the claim on its port.
pub struct Connection {
    /// The board.
    pub board: ConnectedBoard,
    /// The names of the axes of the build, in order.
    pub axes: Vec<String>,
    /// Steps per unit of each axis; empty if no machine file is known.
    pub steps_per_unit: Vec<f64>,
    /// For each axis the registers that count in its letter's place, as the memory of the board keeps
    /// them; empty if no machine file is known.
    pub registers: Vec<Vec<i8>>,
    /// Whether a limit freezes the axes of this gateware; `None` if no machine file is known.
    pub limit_freezes: Option<bool>,
    /// The port's name.
    pub port: String,
    /// The claim on the port, through which other commands find and reach this one.
    pub control: Control,
}

/// The reason why there is no connection.
pub struct Refused {
    /// True if another program uses the port.
    pub busy: bool,
    /// The failure to report.
    pub failure: Failure,
}

impl From<Refused> for Failure {
    fn from(refused: Refused) -> Self {
        refused.failure
    }
}

/// The UART of a machine and the id of its engine on that line. `name` is the path of the machine
/// file, for messages.
///
/// # Errors
/// The engine or the line of the machine is invalid, or the line is an SPI.
pub fn wanted(machine: &Machine, name: &Path) -> Result<(Uart, BuildId), Failure> {
    let refused = |error: String| Failure::input(format!("{}: {error}", name.display()));
    let engine = machine.engine();
    engine.check().map_err(|error| refused(error.to_string()))?;
    match machine.line().map_err(|error| refused(error.to_string()))? {
        LineKind::Uart(uart) => Ok((uart, uart.build_id(&engine))),
        LineKind::Spi => {
            Err(refused("its host link is an SPI: no serial port leads there".to_owned()))
        }
    }
}

/// Connects to the board of a machine in order to drive it; `command` is the name of the
/// subcommand. A board that was built from a different machine is refused. Nothing is written to
/// the board. From now on `carrystep stop` reaches this command through [`Connection::control`].
pub fn to_machine(
    port: &PortArguments,
    machine: &Machine,
    name: &Path,
    command: &'static str,
) -> Result<Connection, Failure> {
    Ok(machines(port, machine, name, command, true)?)
}

/// Connects in order to read or to stop: to the board of the machine if `peer` names one, otherwise
/// to any carrystep board at this baud rate.
pub fn to_peer(
    peer: &PeerArguments,
    baud: u32,
    command: &'static str,
) -> Result<Connection, Refused> {
    let fine = |failure| Refused { busy: false, failure };
    if let Some(path) = &peer.machine {
        let machine = Machine::load(path).map_err(|error| fine(error.into()))?;
        return machines(&peer.port, &machine, path, command, false);
    }
    let (board, control) = connect(&peer.port.name, baud, None, command, false)?;
    let axes = (0..board.facts().axes).map(|axis| axis.to_string()).collect();
    Ok(known(Connection {
        board,
        axes,
        steps_per_unit: Vec::new(),
        registers: Vec::new(),
        limit_freezes: None,
        port: peer.port.name.clone(),
        control,
    }))
}

fn machines(
    port: &PortArguments,
    machine: &Machine,
    name: &Path,
    command: &'static str,
    drives: bool,
) -> Result<Connection, Refused> {
    let (uart, id) = wanted(machine, name).map_err(|failure| Refused { busy: false, failure })?;
    let (board, control) = connect(&port.name, uart.baud(), Some(id), command, drives)?;
    let axes = machine.axes.iter().map(|axis| axis.name.clone()).collect();
    // The float is only displayed; no decision depends on it.
    let steps = |axis: &Axis| decimal::to_f64(&axis.steps_per_unit);
    let steps_per_unit = machine.axes.iter().map(steps).collect();
    let of_axis = |axis: usize| match machine.is_crossed(axis) {
        true => (0..machine.axes.len()).map(|motor| machine.coefficient(motor, axis)).collect(),
        false => Vec::new(),
    };
    let registers = (0..machine.axes.len()).map(of_axis).collect();
    let limit_freezes = Some(machine.guard.limit_freezes);
    let port = port.name.clone();
    Ok(known(Connection { board, axes, steps_per_unit, registers, limit_freezes, port, control }))
}

/// Passes the constants of the board to the control.
fn known(mut connection: Connection) -> Connection {
    let Connection { board, axes, steps_per_unit, port, control, .. } = &mut connection;
    let facts = *board.facts();
    let known = Known {
        port: port.clone(),
        facts,
        axes: axes.clone(),
        steps_per_unit: steps_per_unit.clone(),
    };
    control.connected(&facts, known);
    connection
}

fn connect(
    port: &str,
    baud: u32,
    id: Option<BuildId>,
    command: &'static str,
    drives: bool,
) -> Result<(ConnectedBoard, Control), Refused> {
    let fine = |message: String| Refused { busy: false, failure: Failure::input(message) };
    let busy = |message: String| Refused { busy: true, failure: Failure::input(message) };
    // From here on Ctrl-C requests a stop and does not end the process.
    interrupt::watch();
    let unclaimed =
        |error: io::Error| fine(format!("no lock for the serial port {port} can be made: {error}"));
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
    let line = ClaimedLine::new(line, claim.end_mark().map_err(unclaimed)?);
    let control = Control::new(claim, drives).map_err(unclaimed)?;
    // A wrong board is an input error: nothing was moved.
    let board =
        ConnectedBoard::connect(line, SystemClock::default(), id.map(|id| id.0), patience(port))
            .map_err(|error| fine(format!("{port}: {error}")))?;
    Ok((board, control))
}

/// For how long to wait for the board. A pseudo-terminal loses no byte; the program at its other end
/// may be late, and requests that are sent again because of that would only fill the line.
fn patience(port: &str) -> Patience {
    let real = std::fs::canonicalize(port).unwrap_or_default();
    let mut patience = Patience::default();
    if real.starts_with(PSEUDO_TERMINALS) {
        patience.timing.resend = RESEND_TO_A_PROGRAM;
        patience.silence = SILENCE_OF_A_PROGRAM;
        patience.lost = LOSS_OF_A_PROGRAM;
        patience.status_period = STATUS_PERIOD_OF_A_PROGRAM;
    }
    patience
}

/// Opens a session with the board in order to drive it. While axes of another host move, or its
/// segments wait, this says so and waits for their end: a host that has died is stopped by the
/// board's watchdog. Ctrl-C and `carrystep stop` end the wait.
///
/// # Errors
/// A stop is in force, the board stays busy, or the wait was ended.
pub fn open(connection: &mut Connection) -> Result<(), Failure> {
    let Connection { board, axes, control, port, .. } = connection;
    let stopped = |status: &Status| match status.answer {
        Answer { fault: true, cause, culprits, .. } => {
            Err(broken(&HostError::Fault { cause, culprits }, axes))
        }
        _ => Ok(()),
    };
    stopped(board.status())?;
    let mut told = false;
    let ended = board.open_while(random_session(), |progress| {
        if !std::mem::replace(&mut told, true) {
            // If this write fails, there is no channel left to report it.
            let _ = writeln!(
                io::stderr(),
                "{port}: axes move or segments wait, of another host: waiting for their end; \
                 `carrystep stop` stops them"
            );
        }
        control.wish(progress.status)
    });
    match ended.map_err(|error| broken(&error, axes))? {
        Ended::Done | Ended::SeekEnded => stopped(board.status()),
        Ended::Stopped => Err(Failure::Run(
            "stopped while it waited for the axes of another host; nothing was sent".to_owned(),
        )),
    }
}

/// The message for a port that cannot be opened. The doctor knows more causes than the system's
/// error.
fn opening(port: &str, error: &OpenError) -> String {
    let access = match error {
        OpenError::Busy { .. } | OpenError::NotPermitted { .. } => {
            carrystep_tools::doctor::obstacle(Path::new(port))
        }
        OpenError::Absent { .. } | OpenError::NoPort { .. } | OpenError::Unusable { .. } => None,
    };
    access.map_or_else(|| error.to_string(), |access| format!("serial port {port} {access}"))
}

/// The failure for an error of a board that is being driven; `axes` are the names of its axes.
pub fn broken(error: &ConnectedBoardError, axes: &[String]) -> Failure {
    match *error {
        HostError::Program(error) => Failure::input(error.to_string()),
        HostError::Line(ref why) => {
            Failure::Run(format!("{error}: {why}; what moves stops by its watchdog"))
        }
        HostError::NotIdle => Failure::Run(format!("{error}: `carrystep stop --clear` does that")),
        HostError::Fault { cause, culprits } => {
            let (name, remedy) = Cause::from_number(cause)
                .map_or(("?", "`carrystep stop --clear`"), |cause| (cause.name(), cause.remedy()));
            let from = if culprits == 0 {
                String::new()
            } else {
                format!(", from {}", names(axes, culprits))
            };
            Failure::Run(format!("the machine has stopped: {name}{from}; {remedy}"))
        }
        _ => Failure::Run(error.to_string()),
    }
}

/// The same during a run. If the line is lost, the message says what the axes do now.
pub fn lost(error: &ConnectedBoardError, axes: &[String], facts: &BuildFacts) -> Failure {
    let why = match error {
        HostError::Line(why) => format!("{error}: {why}"),
        HostError::Lost { .. } => error.to_string(),
        _ => return broken(error, axes),
    };
    let watchdog = watchdog((facts.watchdog_ticks, facts.tick_ns));
    Failure::Run(format!("{why}; {watchdog}. Then `carrystep status` says where they are"))
}

/// What stops the axes of a board that no longer hears its host, and when. The arguments are the
/// ticks of its watchdog and the tick in ns.
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

/// The message if the driving command was asked for something and does not respond; `what` is the
/// missing response (`answer` or `end`).
pub fn hangs(port: &str, holder: &Holder, asked: SocketRequest, what: &str) -> String {
    let pid = holder.pid;
    let asleep = if suspended(pid) {
        let then = if asked == SocketRequest::Stop {
            ": then it stops the axes, as it was asked to"
        } else {
            ""
        };
        format!("; it is suspended, and `kill -CONT {pid}` wakes it{then}")
    } else {
        String::new()
    };
    let now = match holder.watchdog {
        Some(known) => {
            format!("As the board said when that command connected: {}", watchdog(known))
        }
        None => "It had not connected to the board, so it has moved nothing".to_owned(),
    };
    format!(
        "{holder} holds {port} and does not {what}{asleep}. {now}. If anything still moves, press the e-stop"
    )
}

/// True if the system has suspended the process, for example by Ctrl-Z.
fn suspended(pid: u32) -> bool {
    let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).unwrap_or_default();
    // The process name stands in parentheses and may contain any character; the letter after it is
    // the state.
    stat.rsplit_once(')').is_some_and(|(_, rest)| rest.trim_start().starts_with(['T', 't']))
}
