//! The names of the top modules, and the purpose of each module, which stands above it in the
//! exported Verilog. A new module needs a row here.

use crate::ExportError;

/// Name of the parallel core's top module and of its files, without the number of axes.
pub(crate) const PARALLEL: &str = "carrystep_parallel";

/// Name of the parallel core's top module and of its files, for a core of this number of axes.
pub fn parallel_name(axes: usize) -> String {
    format!("{PARALLEL}_{axes}")
}

/// Name of the engine's top module and of its files.
pub const ENGINE_NAME: &str = "carrystep_engine";

/// Name of the host link's top module and of its file.
pub const LINK_NAME: &str = "carrystep_link";

/// Name of the self-test's module and of its file.
pub const SELF_TEST_NAME: &str = "carrystep_self_test";

/// The purpose of each module, in one line.
const PURPOSES: [(&str, &str); 56] = [
    (
        "carrystep_tick",
        "The tick counter: a strobe in the last clock of each tick, and the phases of a tick.",
    ),
    ("carrystep_sequencer", "Holds the running segment of an axis and one waiting segment."),
    (
        "carrystep_step_edge",
        "Finds the phase of a step in its tick by bisection; requests the step in that phase.",
    ),
    (
        "carrystep_axis",
        "One axis: P, V, A, J. Each carry of P is a step. The last five ports are for observation.",
    ),
    (
        "carrystep_shaper",
        "Drives STEP and DIR of one axis with the pulse width, gap, set-up and hold of its driver.",
    ),
    (
        PARALLEL,
        "Parallel axes on one tick counter: accepts segments and starts, freezes at a fault.",
    ),
    (
        "carrystep_time_slot",
        "The schedule: in each tick every axis has a time slot of thirteen clocks (beats).",
    ),
    (
        "carrystep_adder",
        "The only adder, 32 bits: P + V, V + A, A + J, remaining ticks, positions, bisection.",
    ),
    ("carrystep_control", "Memory of the control words: the queue state and flags of each axis."),
    ("carrystep_lasts", "Memory of one bit per segment: the segment is the last of its move."),
    (
        "carrystep_queue",
        "The segment queue of each axis: which segment runs, and which segments wait.",
    ),
    (
        "carrystep_step_counts",
        "Counts pulses and discarded steps in memory, and the steps that are on their way.",
    ),
    (
        "carrystep_cut_control",
        "The stages of a cut, which drops the segments behind a named one in several axes.",
    ),
    (
        "carrystep_segments",
        "Memory of the segments, also used as registers, and of an axis' state between moves.",
    ),
    (
        "carrystep_store",
        "The segment memory with its address selection: reads and writes the words of a time slot.",
    ),
    (
        "carrystep_event_memory",
        "Memory of the event wheel: the steps of all axes in each phase of four ticks.",
    ),
    (
        "carrystep_event_wheel",
        "The event wheel: holds the pending steps of all axes, ordered by tick and phase.",
    ),
    (
        "carrystep_output_words",
        "Memory of the commits of axis 0: which outputs change, and their levels.",
    ),
    ("carrystep_duty_words", "Memory of the commits of axis 0: the duty of the PWM."),
    (
        "carrystep_output_control",
        "The outputs, which change where a segment of axis 0 begins; and the new duties of the PWM.",
    ),
    ("carrystep_pulse_width", "The PWM: its pin is active for the duty, a part of each period."),
    (
        "carrystep_pulser",
        "Drives STEP and DIR of one axis with the pulse width, gap, set-up and hold of its driver.",
    ),
    (
        "carrystep_switch_memory",
        "Memory of the debounced state of each switch, and its count of deviating samples.",
    ),
    (
        "carrystep_switches",
        "Samples and debounces limits and other inputs, each in the time slot of its axis.",
    ),
    (
        "carrystep_resets",
        "The reset: freezes the engine, waits for rest, and restores the state at configuration.",
    ),
    (
        "carrystep_seek_control",
        "Seek: the source of a seek, the axes that wait for it, and those that have hit it.",
    ),
    (
        "carrystep_edge_latch",
        "The latch: at an edge of its pin the state of all axes is output on a page of its own.",
    ),
    (
        "carrystep_latch_bank",
        "Latches 1 to 3, and the records that all latches hold, of which latches of one strobe share one.",
    ),
    (
        "carrystep_readout",
        "Outputs the state of every axis in its time slot, and takes snapshots of all axes.",
    ),
    (
        "carrystep_stops",
        "Latches the first cause of a stop, and controls the stop until the host clears it.",
    ),
    (
        "carrystep_supervisor",
        "Monitors the e-stop and the host (watchdog), and times the power of the drivers.",
    ),
    ("carrystep_uart_in", "The UART receiver: eight data bits, no parity, one stop bit."),
    ("carrystep_uart_out", "The UART transmitter: eight data bits, no parity, one stop bit."),
    ("carrystep_uart", "A UART: receiver and transmitter."),
    ("carrystep_spi", "An SPI peripheral in mode 0; SCK may be up to a fifth of the clock."),
    (
        "carrystep_crc",
        "Computes the CRC-32 of frames, and assembles words from bytes; one bit per clock.",
    ),
    (
        "carrystep_processor",
        "A small processor that reads the host's requests, executes them and writes the answers.",
    ),
    ("carrystep_instructions", "Program memory of the processor carrystep_processor."),
    (
        "carrystep_register_mirror",
        "What the host can read: constants of the build, and the last words of state of each axis.",
    ),
    (
        "carrystep_known",
        "Memory of carrystep_register_mirror: constants of the build, and the words of state of each axis.",
    ),
    (
        "carrystep_latch_view",
        "What the host reads of several latches: a record of one of them, and the state of all.",
    ),
    ("carrystep_kept", "Memory of carrystep_latch_view: the words of state of four records."),
    (
        "carrystep_data",
        "Data memory of carrystep_processor: the request, its answer, constants and variables.",
    ),
    ("carrystep_ring", "Ring buffer of the received bytes that the processor has not read yet."),
    (
        LINK_NAME,
        "The host link: receives requests, passes segments to the engine and sends answers.",
    ),
    ("carrystep_walk", "The walk: one output at a time is 1, for a second."),
    ("carrystep_watch", "The watch: compares the inputs with the levels that were reported last."),
    ("carrystep_texts", "Memory of carrystep_speech: a line of text for each pin."),
    ("carrystep_speech", "Sends the names of pins over the UART, and echoes what the host sends."),
    (
        SELF_TEST_NAME,
        "The self-test of a board: outputs become active one by one, and inputs are reported.",
    ),
    (
        "carrystep_lane_slots",
        "The schedule of several adders: the axes of a time slot, one of each adder, share thirteen clocks.",
    ),
    (
        "carrystep_count_place",
        "Puts the counts of one pulser at their place in the word of the counts of all pulsers.",
    ),
    ("carrystep_lane_counts", "Selects the counts of the pulser of the axis of a time slot."),
    (
        "carrystep_findings",
        "Tells the stop control what the axes of a time slot have found, the lowest axis first.",
    ),
    (
        "carrystep_lane_seek",
        "Seek with several adders: its source, the axes that wait for it, and those that have hit it.",
    ),
    (ENGINE_NAME, "The engine: all axes on one adder, with their queues, starts, stops and pins."),
];

/// The purpose of the module with this usual name.
///
/// # Errors
/// [`ExportError`] if the table does not have the module.
pub(crate) fn purpose(usual: &str) -> Result<&'static str, ExportError> {
    let found = PURPOSES.iter().find(|(kind, _)| without_axes(usual) == *kind);
    let (_, purpose) = found.ok_or_else(|| ExportError::undescribed(usual, "the module"))?;
    Ok(purpose)
}

/// The name of a module without its number of axes, if it has one: `carrystep_parallel` for
/// `carrystep_parallel_3`.
fn without_axes(usual: &str) -> &str {
    match usual.rsplit_once('_') {
        Some((name, axes)) if axes.parse::<usize>().is_ok() => name,
        _ => usual,
    }
}
