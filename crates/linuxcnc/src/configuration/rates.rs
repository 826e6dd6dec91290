//! How long segments are and how far ahead they are sent, so that line and queue hold them.

use super::BoardLine;
use super::refused::{BAUDS, MachineRefused};

/// Bytes of a segment on the line, with the ends of its frame and a few escapes.
const SEGMENT_BYTES: u32 = 44;
/// Bits of a byte on a UART and on an SPI.
const UART_BITS: u32 = 10;
const SPI_BITS: u32 = 8;
/// Greatest rate of an SPI, Hz, without a look at its wires: what short jumper wires carry.
const MOST_SCK_HZ: u64 = 4_000_000;
/// Lengths of segments in servo periods of 1 ms, the best first: the error of a cubic grows with
/// the fourth power of its length.
const PERIODS: [u32; 3] = [4, 8, 16];
/// The horizon, ms, where nothing else is asked for.
const HORIZON_MS: u32 = 40;
/// Least number of segments in a horizon.
const SEGMENTS: u32 = 5;
/// Greatest horizon of the component, ms.
const MOST_MS: u32 = 1000;

/// The rate of an SPI to a gateware with this clock, Hz: half of what the gateware can, which leaves
/// room for a controller whose SCK is not even.
pub fn sck_hz(clock_hz: u64) -> u32 {
    u32::try_from((clock_hz / 10).min(MOST_SCK_HZ)).unwrap_or(u32::MAX)
}

/// Periods of a segment and horizon in ms, for so many joints on a line of this rate and with
/// queues of this depth. Segments take at most half of the line: snapshots and answers use the rest.
pub fn choose(
    joints: u32,
    line: BoardLine,
    depth: u32,
    horizon_ms: Option<u32>,
) -> Result<(u32, u32), MachineRefused> {
    let (rate, bits) = match line {
        BoardLine::Uart { baud } if !BAUDS.contains(&baud) => {
            return Err(MachineRefused::Baud { baud });
        }
        BoardLine::Uart { baud } => (baud, UART_BITS),
        BoardLine::Spi { sck_hz } => (sck_hz, SPI_BITS),
    };
    let line_holds = |periods: u32| joints * SEGMENT_BYTES * bits * 1000 / periods <= rate / 2;
    let horizon = |periods: u32| horizon_ms.unwrap_or(HORIZON_MS.max(SEGMENTS * periods));
    let queue_holds = |periods: u32| horizon(periods) <= (depth * periods).min(MOST_MS);
    let fits = PERIODS.into_iter().filter(|&periods| line_holds(periods));
    let mut fits = fits.skip_while(|&periods| !queue_holds(periods));
    match fits.next() {
        Some(periods) if horizon(periods) >= 2 * periods => Ok((periods, horizon(periods))),
        Some(periods) => Err(MachineRefused::ShortHorizon { least_ms: 2 * periods }),
        None if line_holds(PERIODS[PERIODS.len() - 1]) => Err(MachineRefused::LongHorizon {
            most_ms: (depth * PERIODS[PERIODS.len() - 1]).min(MOST_MS),
        }),
        None => Err(MachineRefused::SlowLine { rate, joints }),
    }
}
