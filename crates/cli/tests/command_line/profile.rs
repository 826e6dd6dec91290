//! `carrystep profile` reproduces the examples of the sources in the sources' units.

use crate::curves::{close, golden, json, names, stdout};
use carrystep_core::ProfileKind;
use serde_json::{Value, json};

const SORN: &str =
    "--step-angle 1.8 --microsteps 2 --travel-per-rev 5 --speed-mm-min 1000 --accel-mm-s2 80";

#[test]
fn profile_reproduces_the_example_of_the_logistic_source() {
    let case = &golden("logistic.json")["cases"][0];
    let all = json(&format!("profile logistic trapezoid {SORN} --ti 0.4"));
    let [logistic, trapezoid] = [0, 1].map(|i| &all["profiles"][i]);
    let (figures, source) = (&logistic["figures"], &case["sigmoid"]["profile_code"]);
    assert_eq!(figures["whole_steps"], source["n"].as_f64().unwrap());
    assert_eq!(logistic["steps"].as_array().unwrap().len(), 369);
    close(&figures["steps"], &case["sigmoid"]["code_0.995"]["n_exact"]);
    close(&figures["seconds"], &case["sigmoid"]["code_0.995"]["t_end_s"]);
    close(&figures["start_speed_steps_per_s"], &case["sigmoid"]["start_speed_steps_s"]);
    close(&figures["first_delay_s"], &source["c0"]);
    close(&logistic["steps"][0]["delay_s"], &source["c0"]);
    close(&logistic["steps"][1]["delay_s"], &source["c1"]);
    close(&logistic["steps"][1]["time_s"], &source["c0"]);
    close(&logistic["steps"][184]["delay_s"], &source["c_mid"]);

    let (figures, source) = (&trapezoid["figures"], &case["trap"]);
    assert_eq!(figures["whole_steps"], source["n"].as_f64().unwrap());
    close(&figures["steps"], &source["n_exact"]);
    close(&figures["seconds"], &source["T_a_exact"]);
    for (n, name) in ["c0", "c1", "c2"].into_iter().enumerate() {
        close(&trapezoid["steps"][n]["delay_s"], &source[name]);
    }

    let symmetric = json(&format!("profile logistic {SORN}"));
    close(&symmetric["profiles"][0]["figures"]["seconds"], &case["sigmoid"]["T_a_symmetric"]);
    close(&symmetric["profiles"][0]["figures"]["steps"], &case["sigmoid"]["ramp_steps_symmetric"]);
}

#[test]
fn profile_reproduces_the_example_of_the_sinusoidal_source() {
    let source = golden("sinusoid.json");
    let sine = json("profile sine --speed 10000 --time 0.2");
    let (figures, steps) = (&sine["profiles"][0]["figures"], &sine["profiles"][0]["steps"]);
    close(&figures["steps"], &source["example"]["N_ramp_steps"]);
    close(&figures["peak_acceleration_steps_per_s2"], &source["example"]["peak_accel"]);
    close(&figures["peak_jerk_steps_per_s3"], &source["example"]["peak_jerk"]);
    for (n, time) in source["t_n_s"].as_object().unwrap() {
        close(&steps[n.parse::<usize>().unwrap()]["time_s"], time);
    }
    close(&steps[0]["delay_s"], &source["c_0_first_delay_s"]);
    close(&steps[1]["delay_s"], &source["c_1_s"]);
    close(&steps[999]["delay_s"], &source["c_999_s"]);
}

#[test]
fn profile_reproduces_the_example_of_the_trapezoid_source() {
    let source = golden("trapezoid_austin.json");
    let all = json("profile trapezoid --deg 360 --time 1 --accel-deg-s2 1800 --timer-hz 1e6");
    let (figures, steps) = (&all["profiles"][0]["figures"], &all["profiles"][0]["steps"]);
    close(&figures["steps"], &source["units"]["steps"]);
    let degrees = figures["top_speed_steps_per_s"].as_f64().unwrap() * 1.8;
    close(&degrees.into(), &source["omega_minus_valid"]);
    for (n, counts) in [(0, 44_721), (1, 18_524), (2, 14_214), (10, 6903)] {
        assert_eq!(steps[n]["delay_counts"], counts);
    }
}

#[test]
fn equal_speeds_in_different_units_give_equal_ramps() {
    let motor = "--step-angle 1.8 --microsteps 2 --travel-per-rev 5 --accel 6400";
    let ramp = |speed: &str| {
        json(&format!("profile sine {motor} {speed}"))["profiles"][0]["figures"].clone()
    };
    let steps = ramp("--speed 1280");
    for speed in ["--rpm 192", "--speed-mm-s 16", "--speed-mm-min 960", "--speed-deg-s 1152"] {
        close(&ramp(speed)["seconds"], &steps["seconds"]);
    }
}

/// A triangle goes directly from one ramp into the other, so its acceleration jumps twice as far.
#[test]
fn acceleration_of_a_triangle_jumps_twice_as_far_as_that_of_a_trapezoid() {
    let jump = |asked: &str| {
        let all = json(&format!("profile trapezoid ranade --steps 100 --accel 1000 {asked}"));
        [0, 1].map(|i| {
            all["profiles"][i]["figures"]["acceleration_jump_steps_per_s2"].as_f64().unwrap()
        })
    };
    let (triangle, trapezoid) = (jump(""), jump("--speed 100"));
    assert!(triangle.iter().all(|jump| (jump / 2000.0 - 1.0).abs() < 1e-12), "{triangle:?}");
    assert!(trapezoid.iter().all(|jump| (jump / 1000.0 - 1.0).abs() < 1e-12), "{trapezoid:?}");
}

/// Jerk that consists of impulses has no greatest value. A curve without impulses has no jumps.
#[test]
fn jerk_of_impulses_is_null_and_missing_jumps_are_zero() {
    let all = json("profile trapezoid ranade scurve sine --steps 20000 --accel 500000 --jerk 5e6");
    let figures = |kind: usize| all["profiles"][kind]["figures"].clone();
    for kind in [0, 1] {
        assert_eq!(figures(kind)["peak_jerk_steps_per_s3"], json!(null));
        assert_eq!(figures(kind)["peak_jerk_reason"], "impulses where the acceleration jumps");
    }
    for kind in [2, 3] {
        assert_eq!(figures(kind)["acceleration_jump_steps_per_s2"], json!(0.0));
        assert!(figures(kind)["peak_jerk_steps_per_s3"].as_f64().unwrap() > 1e6);
        assert_eq!(figures(kind).get("peak_jerk_reason"), None);
    }
}

/// From rest at constant acceleration, 2 x = a t^2, and x = n - 1/2 in the middle of step n.
#[test]
fn half_phase_lists_the_middles_of_the_steps() {
    let all = json("profile trapezoid --speed 1000 --accel 5000 --phase half");
    assert_eq!(all["phase"], "half");
    let steps = all["profiles"][0]["steps"].as_array().unwrap();
    assert_eq!(steps.len(), 100);
    for (n, row) in (1..).zip(steps) {
        assert_eq!(row["step"], n);
        close(&row["time_s"], &((2.0 * f64::from(n) - 1.0) / 5000.0).sqrt().into());
    }
}

#[test]
fn json_has_stable_names() {
    let all = json("profile scurve --steps 40 --accel 5000 --jerk 1e5 --timer-hz 1e6");
    assert_eq!(
        names(&all),
        ["drive", "files", "passed", "phase", "profiles", "schema", "timer_hz"]
    );
    assert_eq!(all["drive"], json!({"step_angle_deg": 1.8, "microsteps": 1}));
    let profile = &all["profiles"][0];
    assert_eq!(names(profile), ["figures", "kind", "ramp", "steps"]);
    assert_eq!((&profile["kind"], &profile["ramp"]), (&json!("scurve"), &json!(false)));
    let figures = [
        "acceleration_jump_steps_per_s2",
        "end_speed_steps_per_s",
        "first_delay_s",
        "last_delay_s",
        "peak_acceleration_steps_per_s2",
        "peak_jerk_steps_per_s3",
        "seconds",
        "start_speed_steps_per_s",
        "steps",
        "top_speed_steps_per_s",
        "whole_steps",
    ];
    assert_eq!(names(&profile["figures"]), figures);
    let steps = profile["steps"].as_array().unwrap();
    assert_eq!(steps.len(), 41);
    assert_eq!(
        names(&steps[0]),
        ["delay_counts", "delay_s", "speed_steps_per_s", "step", "time_s"]
    );
    assert_eq!(steps[40]["delay_s"], Value::Null);
}

/// The CSV contains the same numbers as the JSON, up to the rounding of its reader.
#[test]
fn csv_has_the_same_numbers_as_the_json() {
    let asked = "profile trapezoid sine --steps 30 --accel 3000";
    let csv = stdout(&format!("{asked} --csv -"));
    let json = json(asked);
    let mut lines = csv.lines();
    assert_eq!(lines.next(), Some("kind,step,time_s,speed_steps_per_s,delay_s"));
    for profile in json["profiles"].as_array().unwrap() {
        for row in profile["steps"].as_array().unwrap() {
            let cells: Vec<&str> = lines.next().unwrap().split(',').collect();
            assert_eq!(
                (cells[0], cells[1]),
                (profile["kind"].as_str().unwrap(), row["step"].to_string().as_str())
            );
            for (cell, name) in cells[2..].iter().zip(["time_s", "speed_steps_per_s", "delay_s"]) {
                let (cell, number) = (cell.parse::<f64>().ok(), row[name].as_f64());
                let close = cell.zip(number).is_some_and(|(a, b)| (a - b).abs() <= 1e-15 * b.abs());
                assert!(close || cell == number, "{name}: {cells:?}");
            }
        }
    }
    assert_eq!(lines.next(), None);
}

#[test]
fn pictures_are_well_formed() {
    let folder = tempfile::tempdir().unwrap();
    let plot = folder.path().join("new/plot.svg");
    let kinds = |of: fn(&ProfileKind) -> bool| {
        let named = ProfileKind::ALL.iter().filter(|&kind| of(kind));
        named.map(|kind| kind.name()).collect::<Vec<_>>().join(" ")
    };
    let limits = "--accel 5000 --jerk 1e5 --start-speed 100";
    let ramps = kinds(|&kind| kind != ProfileKind::Constant);
    let asked = [
        &format!("{ramps} --speed 2000 {limits}"),
        &format!("{} --steps 500 {limits}", kinds(|_| true)),
        "constant --steps 3 --start-speed 100",
        "scurve --mm 20 --travel-per-rev 8 --microsteps 16 --speed-mm-s 50 --accel-mm-s2 500 --jerk-mm-s3 9000",
    ];
    for asked in asked {
        let told = stdout(&format!("profile {asked} --plot {}", plot.display()));
        assert!(told.ends_with(&format!("wrote {}\n", plot.display())), "{told}");
        let text = std::fs::read_to_string(&plot).unwrap();
        let picture = roxmltree::Document::parse(&text).unwrap();
        let words: Vec<&str> =
            picture.descendants().filter_map(|node| node.text().map(str::trim)).collect();
        for kind in asked.split_whitespace().take_while(|word| !word.starts_with('-')) {
            assert!(
                words.iter().any(|word| word.starts_with(&format!("{kind}, "))),
                "{kind} in {words:?}"
            );
        }
        let unit = if asked.contains("mm") { "mm" } else { "steps" };
        assert!(words.contains(&format!("speed, {unit}/s").as_str()), "{words:?}");
    }
}

#[test]
fn the_page_has_the_picture_that_its_command_draws() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let page = std::fs::read_to_string(format!("{root}/docs/profiles.md")).unwrap();
    let line =
        page.lines().find(|line| line.contains("--plot docs/pictures/profiles.svg")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    let drawn = folder.path().join("profiles.svg");
    let asked = line.trim().strip_prefix("carrystep ").unwrap();
    stdout(&asked.replace("docs/pictures/profiles.svg", &drawn.display().to_string()));
    let shown = std::fs::read_to_string(format!("{root}/docs/pictures/profiles.svg")).unwrap();
    assert!(shown.len() < 300_000);
    assert!(
        shown == std::fs::read_to_string(drawn).unwrap(),
        "draw it anew: cargo run --release -- {asked}"
    );
}
