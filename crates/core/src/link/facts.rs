//! The registers that hold facts of the build, such as its id and its number of axes.

use super::BuildId;
use super::registers::{
    AXIS_COUNT, BUILD_HIGH, BUILD_LOW, CLOCK_HZ, IDENTITY, IDENTITY_VALUE, PHASES, PROTOCOL,
    PROTOCOL_VERSION, QUEUE_DEPTH, TICK_NS, WATCHDOG_TICKS,
};
use crate::EngineBuild;

/// Address and value of each of these registers.
pub fn facts(build: &EngineBuild, id: BuildId) -> [(u8, u32); 10] {
    let [low, high] = id.halves();
    let time = &build.timebase;
    [
        (IDENTITY, IDENTITY_VALUE),
        (PROTOCOL, PROTOCOL_VERSION),
        (BUILD_LOW, low),
        (BUILD_HIGH, high),
        (AXIS_COUNT, build.axes() as u32),
        (CLOCK_HZ, time.clock_hz() as u32),
        (TICK_NS, time.tick_ns() as u32),
        (PHASES, time.phases()),
        (WATCHDOG_TICKS, build.guard.watchdog * build.guard.round),
        (QUEUE_DEPTH, build.queue as u32),
    ]
}
