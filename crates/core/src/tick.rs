//! The tick lengths that a clock allows. A tick must be a whole number of ns and of clocks, and
//! each of its phases must be a whole number of clocks.
//!
//! A machine file gives the tick in whole ns. All ticks of a clock are therefore multiples of one
//! smallest tick, the grain, of `lcm(phases, clock_hz / gcd(clock_hz, 10^9))` clocks.

use crate::build::{MAX_CLOCK_HZ, MAX_CLOCKS, MIN_CLOCKS_PER_TICK};
use crate::schedule::{least_clocks, least_clocks_of_adders};
use alloc::borrow::ToOwned;
use alloc::format;
use alloc::string::String;
use core::fmt;

/// Tick, in ns, of a machine file without `tick_ns` whose clock is [`FIXED_CLOCK_HZ`].
const FIXED_TICK_NS: u64 = 1000;

/// The default clock, Hz. Its default tick is fixed where an engine takes it, and not the shortest
/// that it takes.
pub const FIXED_CLOCK_HZ: u64 = 80_000_000;

/// If a chosen tick is longer than this, in ns, and fewer phases would shorten it, they are
/// proposed.
const LONG_NS: u64 = 4000;

/// Number of phases that is proposed where the tick is too long.
const FEWER_PHASES: u32 = 4;

/// The set of ticks that a clock allows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Ticks {
    grain_clocks: u64,
    grain_ns: u64,
}

impl Ticks {
    /// The ticks of a clock (Hz) that divide into this number of phases. `None` if even the
    /// shortest of them has more than [`MAX_CLOCKS`] clocks, or if the clock is not from 1 Hz to
    /// [`MAX_CLOCK_HZ`].
    pub fn of(clock_hz: u64, phases: u32) -> Option<Self> {
        const NS: u64 = 1_000_000_000;
        if !(1..=MAX_CLOCK_HZ).contains(&clock_hz) {
            return None;
        }
        let clocks = clock_hz / gcd(clock_hz, NS);
        let phases = u64::from(phases).max(1);
        let grain_clocks = clocks / gcd(clocks, phases) * phases;
        if grain_clocks > u64::from(MAX_CLOCKS) {
            return None;
        }
        Some(Self { grain_clocks, grain_ns: grain_clocks * NS / clock_hz })
    }

    /// The smallest tick, ns; every tick of this clock is a multiple of it.
    pub const fn grain_ns(&self) -> u64 {
        self.grain_ns
    }

    /// The shortest tick, ns, that has at least `clocks` clocks and at least
    /// [`MIN_CLOCKS_PER_TICK`]. `None` if that tick would have more than [`MAX_CLOCKS`].
    pub fn shortest(&self, clocks: u32) -> Option<u64> {
        let grains = u64::from(clocks.max(MIN_CLOCKS_PER_TICK)).div_ceil(self.grain_clocks);
        (grains <= self.most()).then_some(grains * self.grain_ns)
    }

    /// The nearest ticks, ns, below and above `tick_ns` that have at least `clocks` clocks.
    pub fn beside(&self, tick_ns: u64, clocks: u32) -> (Option<u64>, Option<u64>) {
        let Some(shortest) = self.shortest(clocks) else { return (None, None) };
        let longest = self.most() * self.grain_ns;
        let below = (tick_ns.saturating_sub(1) / self.grain_ns * self.grain_ns).min(longest);
        let above =
            (tick_ns / self.grain_ns).saturating_add(1).saturating_mul(self.grain_ns).max(shortest);
        ((below >= shortest).then_some(below), (above <= longest).then_some(above))
    }

    /// Length of the longest tick, in grains.
    fn most(&self) -> u64 {
        u64::from(MAX_CLOCKS) / self.grain_clocks
    }

    /// The slowest clock, Hz, at which an engine of so many axes takes this tick, ns; `None` where
    /// no clock does.
    pub fn clock_for_engine(tick_ns: u64, phases: u32, axes: usize) -> Option<u64> {
        Self::clock_for(tick_ns, phases, least_clocks(axes, phases))
    }

    /// The slowest clock, Hz, at which this tick, ns, has at least so many clocks; `None` where no
    /// clock does.
    pub fn clock_for(tick_ns: u64, phases: u32, least: u32) -> Option<u64> {
        const NS: u64 = 1_000_000_000;
        if tick_ns == 0 {
            return None;
        }
        // Clocks of a tick come in grains, so that phases are whole clocks and the clock is whole
        // Hz.
        let common = gcd(tick_ns, NS);
        let (whole, per_phase) = (tick_ns / common, u64::from(phases).max(1));
        let grain = (whole / gcd(whole, per_phase)).checked_mul(per_phase)?;
        let needed = least.max(MIN_CLOCKS_PER_TICK);
        let clocks = u64::from(needed).div_ceil(grain) * grain;
        if clocks > u64::from(MAX_CLOCKS) {
            return None;
        }
        let clock_hz = clocks / whole * (NS / common);
        (clock_hz <= MAX_CLOCK_HZ).then_some(clock_hz)
    }

    /// The shortest tick that an engine of so many axes takes, ns.
    pub fn for_engine(clock_hz: u64, phases: u32, axes: usize) -> Option<u64> {
        Self::of(clock_hz, phases)?.shortest(least_clocks(axes, phases))
    }
}

/// The tick that carrystep chooses for a machine file without `tick_ns`.
///
/// It is the shortest tick that an engine of the machine's axes supports. The parallel core
/// supports that tick too, so that a machine has the same tick on either core.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ChosenTick {
    /// Clock, Hz.
    pub clock_hz: u64,
    /// Chosen tick, ns.
    pub tick_ns: u64,
    /// Phases of a tick: 1, 4 or 16.
    pub phases: u32,
    /// Number of axes of the machine.
    pub axes: usize,
    /// Number of adders of its engine.
    pub adders: usize,
    /// The tick, ns, that fewer phases would allow, if this tick is long and that one is shorter.
    pub fewer_phases_ns: Option<u64>,
}

impl ChosenTick {
    /// Chooses the shortest tick for an engine; `None` if the clock allows no tick.
    pub fn new(clock_hz: u64, phases: u32, axes: usize) -> Option<Self> {
        Self::with_adders(clock_hz, phases, axes, 1)
    }

    /// As [`ChosenTick::new`], for an engine with this number of adders, which is at least 1.
    pub fn with_adders(clock_hz: u64, phases: u32, axes: usize, adders: usize) -> Option<Self> {
        let shortest = |phases| {
            Ticks::of(clock_hz, phases)?.shortest(least_clocks_of_adders(axes, adders, phases))
        };
        let tick_ns = shortest(phases)?;
        let fewer =
            (tick_ns > LONG_NS && phases > FEWER_PHASES).then(|| shortest(FEWER_PHASES)).flatten();
        let fewer_phases_ns = fewer.filter(|&shorter| shorter < tick_ns);
        Some(Self { clock_hz, tick_ns, phases, axes, adders, fewer_phases_ns })
    }

    /// A sentence that proposes fewer phases, if they would shorten a long tick.
    pub fn proposal(&self) -> Option<String> {
        let Self { fewer_phases_ns, tick_ns, .. } = self;
        fewer_phases_ns.map(|shorter| {
            format!("{tick_ns} ns is long: `phases = {FEWER_PHASES}` would allow {shorter} ns")
        })
    }
}

impl fmt::Display for ChosenTick {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { clock_hz, tick_ns, phases, axes, adders, .. } = self;
        let axes = counted(*axes);
        write!(
            f,
            "tick_ns = {tick_ns}, the shortest at {} MHz in {phases} phases with {axes}",
            mhz(*clock_hz)
        )?;
        if *adders > 1 {
            write!(f, " on {adders} adders")?;
        }
        self.proposal().map_or(Ok(()), |proposal| write!(f, "; {proposal}"))
    }
}

/// The tick of a clock whose machine file gives none: fixed at the default clock, as long as its
/// time slots hold the axes, otherwise the one that is chosen.
pub fn default_tick(clock_hz: u64, phases: u32, axes: usize) -> Option<(u64, Option<ChosenTick>)> {
    let chosen = ChosenTick::new(clock_hz, phases, axes);
    if clock_hz == FIXED_CLOCK_HZ && chosen.is_none_or(|chosen| chosen.tick_ns <= FIXED_TICK_NS) {
        return Some((FIXED_TICK_NS, None));
    }
    chosen.map(|chosen| (chosen.tick_ns, Some(chosen)))
}

/// As [`default_tick`], for an engine with this number of adders: with several of them the shortest
/// tick, at any clock.
pub fn default_tick_of_adders(
    clock_hz: u64,
    phases: u32,
    axes: usize,
    adders: usize,
) -> Option<(u64, Option<ChosenTick>)> {
    if adders <= 1 {
        return default_tick(clock_hz, phases, axes);
    }
    let chosen = ChosenTick::with_adders(clock_hz, phases, axes, adders);
    chosen.map(|chosen| (chosen.tick_ns, Some(chosen)))
}

/// A help line for a tick that the clock does not allow: the nearest ticks, and the shortest for an
/// engine.
pub fn nearest_ticks(clock_hz: u64, tick_ns: u64, phases: u32, axes: usize) -> String {
    let at = format!("at {} MHz in {phases} phases", mhz(clock_hz));
    let Some(ticks) = Ticks::of(clock_hz, phases) else {
        return format!(
            "{at} no tick of whole ns is a whole number of clocks; a multiple of 1 MHz has ticks"
        );
    };
    let nearest = match ticks.beside(tick_ns, MIN_CLOCKS_PER_TICK) {
        (Some(below), Some(above)) => format!("{below} ns and {above} ns are the nearest ticks"),
        (Some(one), None) | (None, Some(one)) => format!("{one} ns is the nearest tick"),
        (None, None) => "there is no tick".to_owned(),
    };
    let engine = ticks.shortest(least_clocks(axes, phases));
    let engine = engine.map_or_else(String::new, |ns| {
        format!("; an engine of {} takes {ns} ns or more", counted(axes))
    });
    let finer = Ticks::of(clock_hz, FEWER_PHASES)
        .filter(|finer| phases > FEWER_PHASES && finer.grain_ns < ticks.grain_ns);
    let finer = finer.map_or_else(String::new, |finer| {
        format!("; `phases = {FEWER_PHASES}` allows multiples of {} ns", finer.grain_ns)
    });
    format!("{at}, {nearest}{engine}{finer}")
}

/// The number of axes in words: `1 axis`, `6 axes`.
fn counted(axes: usize) -> String {
    if axes == 1 { "1 axis".to_owned() } else { format!("{axes} axes") }
}

/// A frequency in MHz, with as many decimals as it needs to be exact.
pub fn mhz(hz: u64) -> String {
    let digits = format!("{}.{:06}", hz / 1_000_000, hz % 1_000_000);
    digits.trim_end_matches('0').trim_end_matches('.').to_owned()
}

fn gcd(a: u64, b: u64) -> u64 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::Timebase;
    use alloc::string::ToString as _;

    #[test]
    fn shortest_tick_of_common_clocks_for_six_axes() {
        let chosen = |mhz: u64| ChosenTick::new(mhz * 1_000_000, 16, 6).unwrap();
        let ticks = [25, 27, 50, 80, 100, 125].map(|mhz| chosen(mhz).tick_ns);
        assert_eq!(ticks, [3200, 16_000, 1600, 1000, 800, 640]);
        assert_eq!(chosen(27).fewer_phases_ns, Some(4000));
        assert_eq!(chosen(25).fewer_phases_ns, None);
        assert_eq!(
            chosen(27).to_string(),
            "tick_ns = 16000, the shortest at 27 MHz in 16 phases with 6 axes; 16000 ns is long: `phases = 4` would \
             allow 4000 ns"
        );
    }

    #[test]
    fn chosen_tick_is_the_shortest_that_passes_all_checks() {
        for clock_hz in [
            1_000_000,
            12_000_000,
            12_288_000,
            25_000_000,
            27_000_000,
            33_300_000,
            125_000_000,
            999_000_000,
        ] {
            for phases in [1, 4, 16] {
                for axes in 1..=8 {
                    let fits = |ns: &u64| {
                        Timebase::new(clock_hz, *ns, phases)
                            .is_ok_and(|time| crate::engine::check_schedule(axes, &time).is_ok())
                    };
                    let searched = (1..=200_000_u64).find(fits);
                    assert_eq!(
                        Ticks::for_engine(clock_hz, phases, axes),
                        searched,
                        "{clock_hz} Hz, {phases}, {axes}"
                    );
                }
            }
        }
    }

    #[test]
    fn the_clock_for_a_tick_is_the_slowest_of_all_that_fit() {
        for tick_ns in
            [0, 1, 7, 333, 640, 1000, 1200, 1500, 2000, 2560, 3000, 16_000, 1_000_000, u64::MAX]
        {
            for phases in [1, 4, 16] {
                for axes in 1..=8 {
                    let fits = |hz: &u64| {
                        Timebase::new(*hz, tick_ns, phases)
                            .is_ok_and(|time| crate::engine::check_schedule(axes, &time).is_ok())
                    };
                    let found = Ticks::clock_for_engine(tick_ns, phases, axes);
                    assert!(
                        found.is_none_or(|hz| fits(&hz)),
                        "{tick_ns} ns, {phases}, {axes}: {found:?}"
                    );
                    // Any that fits has a whole number of clocks in the tick: all of them can be
                    // tried.
                    let of = |clocks: u64| {
                        let hz = u128::from(clocks) * 1_000_000_000;
                        let tick = u128::from(tick_ns).max(1);
                        hz.is_multiple_of(tick)
                            .then(|| u64::try_from(hz / tick).unwrap_or(u64::MAX))
                    };
                    let searched = (1..=u64::from(MAX_CLOCKS)).filter_map(of).find(fits);
                    assert_eq!(found, searched, "{tick_ns} ns, {phases} phases, {axes} axes");
                }
            }
        }
    }

    #[test]
    fn the_default_clock_has_1_us_for_six_axes_and_the_shortest_tick_for_more() {
        let at_default = |axes| default_tick(FIXED_CLOCK_HZ, 16, axes).unwrap();
        for axes in 1..=6 {
            assert_eq!(at_default(axes), (1000, None));
        }
        for (axes, shortest) in [(7, 1200), (8, 1400)] {
            let (tick_ns, chosen) = at_default(axes);
            assert_eq!((tick_ns, chosen.map(|chosen| chosen.axes)), (shortest, Some(axes)));
        }
    }

    #[test]
    fn ticks_beside_another_fit_and_none_is_nearer() {
        let fits = |hz, ns: u64| Timebase::new(hz, ns, 16).is_ok();
        for hz in [25_000_000, 27_000_000, 48_000_000, 100_000_000] {
            let ticks = Ticks::of(hz, 16).unwrap();
            for tick in [1, 100, 640, 1000, 1001, 15_999, 16_000, 100_000] {
                let (below, above) = ticks.beside(tick, MIN_CLOCKS_PER_TICK);
                assert_eq!(below, (1..tick).rev().find(|&ns| fits(hz, ns)), "{hz} Hz, {tick} ns");
                assert_eq!(
                    above,
                    (tick + 1..tick + 100_000).find(|&ns| fits(hz, ns)),
                    "{hz} Hz, {tick} ns"
                );
            }
        }
        // The longest tick of 1 GHz has 65536 clocks.
        assert_eq!(
            Ticks::of(1_000_000_000, 16).unwrap().beside(1_000_000, 16),
            (Some(65_536), None)
        );
    }

    #[test]
    fn megahertz_are_shown_exactly() {
        let shown = [48_000_000, 37_500_000, 1, 100_000_001].map(mhz);
        assert_eq!(shown, ["48", "37.5", "0.000001", "100.000001"]);
    }

    #[test]
    fn clock_without_ticks_is_reported() {
        assert_eq!([33_333_333, 0, u64::MAX].map(|hz| Ticks::of(hz, 16)), [None; 3]);
        assert_eq!(Ticks::of(48_000_000, u32::MAX), None);
        assert!(nearest_ticks(33_333_333, 1000, 16, 6).contains("no tick of whole ns"));
    }
}
