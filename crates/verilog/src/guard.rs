//! The lines of an engine's header that describe its guard: the times as counted, in the units of
//! the machine file.

use carrystep_core::EngineBuild;
use carrystep_core::engine::{Between, LimitWiring};

/// The lines of the header.
pub(crate) fn lines(build: &EngineBuild) -> String {
    let figures = build.guard_figures();
    let between = |time: Between, unit| format!("{} to {} {unit}", time.least, time.most);
    let watchdog = figures.watchdog_ms.map_or("none".into(), |time| {
        format!("{} without a valid frame of the host: ramp", between(time, "ms"))
    });
    let enable =
        figures.enable_ms.map_or("no time from ENABLE to the first start".into(), |time| {
            format!("{} from ENABLE to the first start", between(time, "ms"))
        });
    let wiring = match figures.limits {
        LimitWiring::None => None,
        LimitWiring::Pair => Some("two per axis"),
        LimitWiring::Each => Some("one per axis"),
        LimitWiring::One => Some("one for all axes, bit 0 of limit_min"),
    };
    let limits = wiring.zip(figures.debounce_us).map_or("none".into(), |(wiring, time)| {
        let (level, stop) = (figures.limit_level, figures.limit_stop);
        format!("{wiring}, active {level}, debounced for {}: {stop}", between(time, "us"))
    });
    let adders = match build.adders {
        1 => String::new(),
        adders => {
            format!("// Adders       {adders}: axis i is computed by the adder i % {adders}\n")
        }
    };
    let mut text = format!(
        "\
{adders}// Guard        counts in rounds of {} ticks, {} us
//   watchdog   {watchdog}
//   enable     {enable}
//   e-stop     active {}: freeze
//   limits     {limits}
",
        build.guard.round, figures.round_us, figures.estop
    );
    for (axis, ramp) in figures.stop_accel_steps_per_s2.iter().enumerate() {
        text.push_str(&format!("//   axis {axis}     ramps by {} steps/s^2\n", six_digits(*ramp)));
    }
    text
}

/// A number with six significant digits, so that the rounding to 2^-64 step is not visible.
fn six_digits(number: f64) -> String {
    let rounded = format!("{number:.5e}");
    rounded.parse::<f64>().map_or(rounded, |number| number.to_string())
}
