//! `carrystep serve`: programs that speak Grbl 1.1 drive a board.

use crate::arguments::{PortArguments, ServeArguments};
use crate::connection::{self, Connection};
use crate::failure::Failure;
use crate::memory::BoardMemory;
use crate::output;
use crate::serve::{
    Accessories, Clients, Link, Pty, Requests, Server, Web, find, lines, settings, simulate,
};
use carrystep_files::Machine;
use carrystep_grbl::{Dialect, Settings};
use carrystep_link::Ended;
use carrystep_program::{Letters, Offsets, RowOutputs};
use carrystep_runner::LINES;
use std::io::{self, Write as _};
use std::net::{Ipv4Addr, Ipv6Addr, SocketAddr, TcpListener};
use std::time::Instant;

/// Serves until Ctrl-C or `carrystep stop`.
pub fn run(arguments: &ServeArguments) -> Result<(), Failure> {
    let path = &arguments.machine;
    let machine = Machine::load(path)?;
    let refused = |fault: String| Failure::input(format!("{}: {fault}", path.display()));
    let letters = Letters::new(&machine).map_err(|fault| refused(fault.to_string()))?;
    carrystep_job::check_line(&machine).map_err(|error| refused(error.to_string()))?;
    let listener = listen(arguments, arguments.tcp, TCP_WARNING)?;
    let (web, page) = match listen(arguments, arguments.web, WEB_WARNING)? {
        Some(listener) => {
            let (web, page) = web(listener).map_err(|error| Failure::Run(error.to_string()))?;
            (Some(web), Some(page))
        }
        None => (None, None),
    };
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
    let clients = Clients::new(pty, listener, web);
    let clients = clients.map_err(|error| Failure::Run(error.to_string()))?;
    let mut requests =
        Requests::new(&machine, (dialect, clients), lines, place, arguments.when_gone);
    requests.accessories = Accessories::new(&machine);
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
    tell(&name, arguments, address.ok().flatten(), &port, page)?;
    let served = server.serve();
    server.keeps_offsets();
    server.requests.farewell();
    drop(link);
    // If the file cannot be written, the old one no longer matches the board and is ignored.
    let _ = memory.keep(&mut board);
    served?;
    output::print("ended; the axes rest, and the positions are valid\n")
}

/// What is dangerous in another address than that of this computer itself.
const TCP_WARNING: &str = "raw TCP has no password: whoever reaches it can move the machine";
const WEB_WARNING: &str = "the page is not encrypted: whoever reaches it can watch and stop, and \
                           whoever reads along gets the token";

fn listen(
    arguments: &ServeArguments,
    port: Option<u16>,
    warning: &str,
) -> Result<Option<TcpListener>, Failure> {
    let Some(port) = port else { return Ok(None) };
    let address = SocketAddr::new(arguments.listen, port);
    if !arguments.listen.is_loopback() {
        // If this write fails, there is no channel left to report it.
        let _ = writeln!(io::stderr(), "warning: {address}: {warning}");
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
    page: Option<String>,
) -> Result<(), Failure> {
    let link = arguments.link.as_ref().map(|link| format!(", also {}", link.display()));
    let tcp = address.map(|address| format!("tcp {address}\n")).unwrap_or_default();
    let page = page.map(|page| format!("web {page}\n")).unwrap_or_default();
    output::print(&format!("pty {name}{}\n{tcp}board {port}\n{page}", link.unwrap_or_default()))
}

/// The pages at a listener, and the link to them with the token.
fn web(listener: TcpListener) -> io::Result<(Web, String)> {
    let mut address = listener.local_addr()?;
    if address.ip().is_unspecified() {
        // It means all addresses, and is none.
        address.set_ip(match address {
            SocketAddr::V4(_) => Ipv4Addr::LOCALHOST.into(),
            SocketAddr::V6(_) => Ipv6Addr::LOCALHOST.into(),
        });
    }
    let (web, token) = Web::new(listener)?;
    Ok((web, format!("http://{address}/#token={token}")))
}
