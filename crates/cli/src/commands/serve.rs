//! `carrystep serve`: programs that speak Grbl 1.1 drive a board.

use crate::arguments::{PortArguments, ServeArguments};
use crate::connection::{self, Connection};
use crate::failure::Failure;
use crate::memory::BoardMemory;
use crate::output;
use crate::serve::{Clients, Link, Pty, Requests, Server, find, lines, settings, simulate};
use carrystep_files::Machine;
use carrystep_grbl::{Dialect, Settings};
use carrystep_link::Ended;
use carrystep_program::{Letters, Offsets, RowOutputs};
use carrystep_runner::LINES;
use std::io::{self, Write as _};
use std::net::{SocketAddr, TcpListener};
use std::time::Instant;

/// Serves until Ctrl-C or `carrystep stop`.
pub fn run(arguments: &ServeArguments) -> Result<(), Failure> {
    let path = &arguments.machine;
    let machine = Machine::load(path)?;
    let refused = |fault: String| Failure::input(format!("{}: {fault}", path.display()));
    let letters = Letters::new(&machine).map_err(|fault| refused(fault.to_string()))?;
    carrystep_job::check_line(&machine).map_err(|error| refused(error.to_string()))?;
    let listener = listen(arguments)?;
    let pty = Pty::new().map_err(|error| Failure::Run(format!("no pseudo-terminal: {error}")))?;
    let link = arguments.link.as_deref().map(|path| Link::new(path, pty.name())).transpose()?;
    let port = match &arguments.port {
        Some(port) => port.clone(),
        None => simulate(&machine, path, arguments.fast)?,
    };
    let port = PortArguments { name: port };
    let mut connection = connection::to_machine(&port, &machine, path, "serve")?;
    let mut memory = BoardMemory::recall(&mut connection);
    memory.usable()?;
    connection::open(&mut connection)?;
    // `control` is bound before `board` so that it is dropped later: the port is closed before the
    // claim on it ends.
    let Connection { mut control, port, mut board, axes, .. } = connection;
    let (place, lost) = find(&machine, &letters, &memory, &board.status().positions)?;
    // Without a machine zero, nobody knows where the offsets are.
    let offsets = if lost { Offsets::default() } else { memory.work()?.clone() };
    let lines = lines(&machine, &place, offsets, arguments.tolerance)?;
    let dialect = Dialect::new(Settings::new(settings(&machine, &letters, &place.soft)), LINES);
    let name = pty.name().to_owned();
    let address = listener.as_ref().map(TcpListener::local_addr).transpose();
    let clients = Clients::new(pty, listener).map_err(|error| Failure::Run(error.to_string()))?;
    let mut requests = Requests::new((dialect, clients), lines, place, arguments.when_gone);
    (requests.alarm, requests.keeps) = (lost, !lost);
    requests.begins();
    control.runs_program(machine.output_uses.spindle_rpm.is_some());
    let outputs = RowOutputs::new(&machine, &letters);
    let mut server = Server {
        board: &mut board,
        control: &mut control,
        memory: &mut memory,
        machine: &machine,
        axes: &axes,
        requests,
        outputs,
        failed: None,
        inputs: Instant::now(),
        tolerance: arguments.tolerance,
    };
    if server.powers()? == Ended::Stopped {
        return Err(Failure::Run("stopped before the first sender came".to_owned()));
    }
    // Otherwise, a command that is killed leaves a file that does not match.
    let _ = server.memory.drives(server.board);
    tell(&name, arguments, address.ok().flatten(), &port)?;
    let served = server.serve();
    server.keeps_offsets();
    server.requests.farewell();
    drop(link);
    // If the file cannot be written, the old one no longer matches the board and is ignored.
    let _ = memory.keep(&mut board);
    served?;
    output::print("ended; the axes rest, and the positions are valid\n")
}

fn listen(arguments: &ServeArguments) -> Result<Option<TcpListener>, Failure> {
    let Some(port) = arguments.tcp else { return Ok(None) };
    let address = SocketAddr::new(arguments.listen, port);
    if !arguments.listen.is_loopback() {
        // If this write fails, there is no channel left to report it.
        let _ = writeln!(
            io::stderr(),
            "warning: raw TCP has no password: whoever reaches {address} can move the machine"
        );
    }
    let listener = TcpListener::bind(address)
        .map_err(|error| Failure::input(format!("cannot listen on {address}: {error}")))?;
    Ok(Some(listener))
}

fn tell(
    name: &str,
    arguments: &ServeArguments,
    address: Option<SocketAddr>,
    port: &str,
) -> Result<(), Failure> {
    let link = arguments.link.as_ref().map(|link| format!(", also {}", link.display()));
    let tcp = address.map(|address| format!("tcp {address}\n")).unwrap_or_default();
    output::print(&format!("pty {name}{}\n{tcp}board {port}\n", link.unwrap_or_default()))
}
