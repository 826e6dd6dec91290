//! The iCEstick as it ships, placed and routed, from bytes on the line to pulses on the pins.

use carrystep_boards::board;
use carrystep_simulators::timed::TimedRun;
use carrystep_tests::board_session::Session;
use carrystep_tests::effort;
use carrystep_tools::ice40::{self, NextpnrPart};
use carrystep_tools::kept;

/// Cycles of the runs with other periods: the first thousand until the gate of the clock opens, and
/// the first request.
const BEGIN: u64 = 6_000;

/// The flip-flop of the falling edge: its input comes from the rising edge, half a period before.
const FALLING: &str = "clock_of_all.open_";

#[test]
fn an_icestick_moves_six_axes_with_its_delays() {
    if !effort::is_every_board() {
        return effort::say("the iCEstick with its delays: only in `cargo xtask long timing`");
    }
    let board = board("icestick").expect("a board");
    let session = Session::as_shipped(board);
    let gateware = &session.gateware;
    let (top, clock_hz) = (gateware.top(), gateware.build().timebase.clock_hz());
    let part = NextpnrPart { device: &board.parts[0].name, package: &board.parts[0].package };
    let netlist = ice40::synthesise(&session.verilog, &top, part.device).expect("a netlist");
    // The seed with which the shipped script reaches the clock.
    let placed =
        netlist.place_on(part, &session.file(".pcf"), clock_hz, 1).expect("a placed design");
    let verilog = placed.timed(&placed.sdf, &top).expect("Verilog with delays");

    // The whole ps below half a period: the simulated clock is not slower than the board's.
    let half = 500_000_000_000 / clock_hz;
    let run = session.timed(&verilog, half, u64::MAX);
    assert_eq!((&run.difference, &run.first_violation), (&None, &None));
    assert_eq!(run.cycles, session.cycles());
    let (least, most) = run.change_ps.expect("pulses");

    // The first requests: at the shortest period that their paths need there is no violation, and
    // at a shorter one there is.
    let needs = |run: &TimedRun| {
        let cells = run.needs_ps.iter().filter(|(cell, _)| !cell.starts_with(FALLING));
        *cells.map(|(_, need)| need).max().expect("registers")
    };
    let begin = session.timed(&verilog, half, BEGIN);
    let need = needs(&begin);
    assert_eq!(session.timed(&verilog, need.div_ceil(2), BEGIN).violations, 0, "{need} ps");
    let fast = session.timed(&verilog, (need - 1) / 2, BEGIN);
    assert!(fast.violations > 0, "{need} ps");
    // nextpnr's figure holds for every path, also for those that this session never uses.
    let (whole, limit) = (needs(&run), 1e6 / placed.mhz);
    assert!(whole as f64 <= limit + 1.0, "{whole} ps are needed, nextpnr says {limit}");

    kept::say();
    effort::figures(&format!(
        "{} cycles of the icestick at {} MHz: every pin as in the model, no violation; pins change {:.2} to {:.2} ns \
         after the clock; no path used needs more than {:.2} ns, by nextpnr none more than {limit:.2} ns; the \
         first {BEGIN} cycles need {:.3} ns, and a period {} ps shorter has {} violations",
        run.cycles,
        clock_hz as f64 / 1e6,
        least as f64 / 1e3,
        most as f64 / 1e3,
        whole as f64 / 1e3,
        need as f64 / 1e3,
        need - (need - 1) / 2 * 2,
        fast.violations,
    ));
}
