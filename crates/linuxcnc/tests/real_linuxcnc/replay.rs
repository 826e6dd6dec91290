//! What the real LinuxCNC sends to a board in a short program, replayed on the exported Verilog: all
//! pins and all answers are the same in every clock.

use crate::board::{recorded, uart};
use crate::installation::linuxcnc;
use crate::{ALONE, Outcome, Workshop, is_whole, machine_with};
use carrystep_virtual_board::{ModelBoard, VerilatedBoard};
use std::fs;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, PoisonError};

/// The clock is slow, because the Verilog takes time for each clock. The line has 16 clocks per bit.
const SLOW: (&str, &str) = (
    "clock_hz = 80_000_000\ntick_ns = 1000\n",
    "clock_hz = 8_000_000\ntick_ns = 8000\nlink = { baud = 500_000 }\n",
);
/// Clocks of a byte on the line.
const BYTE_CLOCKS: u64 = 10 * 16;

/// All axes move, and output 0 is switched in motion.
const PROGRAM: &str = "G21 G90 G64 P0.05 F1800\nG1 X3 Y2\nM62 P0\nG3 X3 Y2 I-1 J1\nM63 P0\n\
    G1 X-1 Z0.6\nG1 X0 Y0 Z0\nM2\n";

#[test]
fn run_of_the_real_linuxcnc_replayed_on_the_verilog_is_the_same_in_every_clock() {
    let _alone = ALONE.lock().unwrap_or_else(PoisonError::into_inner);
    let Some(workshop) = Workshop::new() else { return };
    let program = workshop.folder.path().join("short.ngc");
    fs::write(&program, PROGRAM).unwrap();
    workshop.until_not_void("replay", |folder| {
        let machine = machine_with(&[SLOW]);
        let end = Arc::new(AtomicBool::new(false));
        let (port, thread) = recorded(&machine, Arc::clone(&end));
        let ran = linuxcnc(folder, &machine, &port, "program", &program);
        end.store(true, Ordering::Relaxed);
        let recording = thread.join().unwrap();
        if ran.late() {
            return Outcome::Void(format!("later than the horizon: {}", ran.result));
        }
        is_whole(&ran);
        let levels: Vec<u8> = recording.levels.iter().map(|&(_, levels)| levels).collect();
        assert_eq!(levels, [1, 0], "output 0");
        let (engine, uart) = (machine.engine(), uart(&machine));
        let pins = recording.pins(ModelBoard::new(&engine, uart));
        let verilog = || VerilatedBoard::new(&engine, uart).unwrap();
        assert_eq!(recording.difference(verilog(), &pins), None);
        let wrong = recording.with_a_wrong_bit().difference(verilog(), &pins);
        assert!(wrong.is_some(), "a wrong bit");
        let (late, clocks) = recording.with_a_late_byte(BYTE_CLOCKS);
        let found = late.difference(verilog(), &pins);
        assert!(found.is_some(), "a byte that is {clocks} clocks late");
        Outcome::Good(format!(
            "{} clocks, {} bytes to the board, {} edges, {} changes of pins: no difference",
            recording.clocks,
            recording.events.len(),
            recording.edges.len(),
            pins.len()
        ))
    });
}
