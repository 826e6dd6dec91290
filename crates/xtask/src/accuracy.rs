//! The table of `docs/accuracy.md`: generated on demand, compared in every test run.

use crate::shell::{self, TaskResult};
use serde_json::Value;
use std::fmt::Write;
use std::fs;

const PAGE: &str = "docs/accuracy.md";
const BEGIN: &str = "<!-- `cargo xtask accuracy` writes from here ... -->";
const END: &str = "<!-- ... to here -->";

/// Fails if the page differs from the current measurements of the checker.
pub fn check() -> TaskResult {
    let page =
        fs::read_to_string(shell::root().join(PAGE)).map_err(|error| format!("{PAGE}: {error}"))?;
    if !page.contains(&block(&table()?)) {
        return Err(format!(
            "the table in {PAGE} is not what is measured: run `cargo xtask accuracy`"
        ));
    }
    shell::say("accuracy: true");
    Ok(())
}

/// Writes the table into the page.
pub fn write() -> TaskResult {
    let path = shell::root().join(PAGE);
    let page = fs::read_to_string(&path).map_err(|error| format!("{PAGE}: {error}"))?;
    let lost = || format!("{PAGE} has lost a mark of its table");
    let (before, rest) = page.split_once(BEGIN).ok_or_else(lost)?;
    let (_, after) = rest.split_once(END).ok_or_else(lost)?;
    let text = format!("{before}{}{after}", block(&table()?));
    fs::write(&path, text).map_err(|error| format!("{PAGE}: {error}"))
}

fn block(table: &str) -> String {
    format!("{BEGIN}\n\n{table}\n{END}")
}

/// One row for each profile and number of phases.
fn table() -> Result<String, String> {
    let mut text = String::from(
        "| profile | Q | segments | e min, ns | e max, ns | e rms, ns | about its mean, ns: theory | period jitter, ns: theory | speed ripple, %: theory |\n\
         |---|---|---|---|---|---|---|---|---|\n",
    );
    for profile in ["trapezoid", "scurve", "sine", "logistic"] {
        for phases in [1, 4, 16] {
            let report = simulate(profile, phases)?;
            let axis = &report["check"]["axes"][0];
            let figure = |name: &str| axis[name].as_f64().unwrap_or(f64::NAN);
            // Adding zero turns minus zero into plus zero.
            let whole = |name: &str| figure(name).round() + 0.0;
            let segments = &report["limits"]["axes"][0]["segments"];
            writeln!(
                text,
                "| {profile} | {phases} | {segments} | {} | {} | {} | {}: {} | {}: {} | {:.1}: {:.1} |",
                whole("error_min_ns"),
                whole("error_max_ns"),
                whole("error_rms_ns"),
                whole("error_std_ns"),
                whole("error_std_theory_ns"),
                whole("period_jitter_max_ns"),
                whole("period_jitter_theory_ns"),
                figure("speed_ripple_max_percent"),
                figure("speed_ripple_theory_percent"),
            )
            .map_err(|error| error.to_string())?;
        }
    }
    Ok(text)
}

/// Simulates the reference move on the model, and returns the report of the command.
fn simulate(profile: &str, phases: u32) -> Result<Value, String> {
    let file = format!("sim/out/accuracy-{profile}-{phases}.toml");
    // The jerk limit for the S-curve is the peak jerk of the sine profile.
    let jerk = if profile == "scurve" { "jerk_limit = 5_553_604\n" } else { "" };
    let text = format!(
        "[machine]\nclock_hz = 32_000_000\ntick_ns = 1000\nphases = {phases}\n\n[[machine.axis]]\nname = \"x\"\n\
         steps_per_unit = 1\nspeed_limit = 150_000\naccel_limit = 500_000\n{jerk}step_high_ns = 100\nstep_low_ns = 100\ndir_setup_ns = 100\n\
         dir_hold_ns = 100\n\n[[move]]\nprofile = \"{profile}\"\nto = {{ x = 20_000 }}\n"
    );
    fs::create_dir_all(shell::root().join("sim/out")).map_err(|error| error.to_string())?;
    fs::write(shell::root().join(&file), text).map_err(|error| format!("{file}: {error}"))?;
    let json = shell::carrystep(&["simulate", &file, "--json"])?;
    serde_json::from_str(&json).map_err(|error| format!("{file}: {error}"))
}
