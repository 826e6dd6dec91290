//! The HAL component of LinuxCNC for a board with the engine, as C sources (docs/linuxcnc.md).
//!
//! ```text
//! carrystep_main      parameters and messages of HAL
//!   carrystep_pins      its pins; nothing else knows HAL
//!   carrystep_servo     what the real-time function does in a servo period; never waits
//!     carrystep_glide     the jump of a command at an index pulse
//!     carrystep_blocks    position commands to cubic segments
//!   carrystep_port      the thread that owns the line (POSIX)
//!     carrystep_uart      a serial port
//!     carrystep_spi       an SPI by spidev
//!     carrystep_pump      connects, sends blocks, takes snapshots; knows no port and no clock
//!       carrystep_facts     which board it is
//!       carrystep_look      what is read of it again and again
//!       carrystep_latches   when latches are armed, and which record counts
//!       carrystep_feedback  where the axes are, and where they were commanded to be
//!       carrystep_trim      lengths of segments by the board's clock
//!   carrystep_ring      the queues between the real-time function and the thread
//! ```
//!
//! [`component`] lists these files with those of the C library of `carrystep-link` that they need.

mod configuration;

pub use configuration::{
    BoardLine, Configuration, HomeSwitch, Homing, Joint, LETTERS, MachineRefused, OutputNets,
    SwitchRefused, Wishes,
};

use carrystep_link::C_LIBRARY;

/// Name and text of each file that belongs to the component alone.
pub const COMPONENT: [(&str, &str); 30] = [
    ("Makefile", include_str!("../c/Makefile")),
    ("carrystep.9", include_str!("../c/carrystep.9")),
    ("carrystep_main.c", include_str!("../c/carrystep_main.c")),
    ("carrystep_pins.h", include_str!("../c/carrystep_pins.h")),
    ("carrystep_pins.c", include_str!("../c/carrystep_pins.c")),
    ("carrystep_servo.h", include_str!("../c/carrystep_servo.h")),
    ("carrystep_servo.c", include_str!("../c/carrystep_servo.c")),
    ("carrystep_blocks.h", include_str!("../c/carrystep_blocks.h")),
    ("carrystep_blocks.c", include_str!("../c/carrystep_blocks.c")),
    ("carrystep_glide.h", include_str!("../c/carrystep_glide.h")),
    ("carrystep_glide.c", include_str!("../c/carrystep_glide.c")),
    ("carrystep_port.h", include_str!("../c/carrystep_port.h")),
    ("carrystep_port.c", include_str!("../c/carrystep_port.c")),
    ("carrystep_line.h", include_str!("../c/carrystep_line.h")),
    ("carrystep_uart.c", include_str!("../c/carrystep_uart.c")),
    ("carrystep_spi.c", include_str!("../c/carrystep_spi.c")),
    ("carrystep_pump.h", include_str!("../c/carrystep_pump.h")),
    ("carrystep_pump.c", include_str!("../c/carrystep_pump.c")),
    ("carrystep_facts.h", include_str!("../c/carrystep_facts.h")),
    ("carrystep_facts.c", include_str!("../c/carrystep_facts.c")),
    ("carrystep_look.h", include_str!("../c/carrystep_look.h")),
    ("carrystep_look.c", include_str!("../c/carrystep_look.c")),
    ("carrystep_latches.h", include_str!("../c/carrystep_latches.h")),
    ("carrystep_latches.c", include_str!("../c/carrystep_latches.c")),
    ("carrystep_feedback.h", include_str!("../c/carrystep_feedback.h")),
    ("carrystep_feedback.c", include_str!("../c/carrystep_feedback.c")),
    ("carrystep_trim.h", include_str!("../c/carrystep_trim.h")),
    ("carrystep_trim.c", include_str!("../c/carrystep_trim.c")),
    ("carrystep_ring.h", include_str!("../c/carrystep_ring.h")),
    ("carrystep_ring.c", include_str!("../c/carrystep_ring.c")),
];

/// Name and text of each file that builds the component: in a folder with these files, `make`
/// writes `carrystep.so`.
pub fn component() -> impl Iterator<Item = (&'static str, &'static str)> {
    COMPONENT.into_iter().chain(C_LIBRARY)
}
