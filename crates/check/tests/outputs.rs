//! Tests the CSV and the plot of a whole run.

use crate::common::*;
use carrystep_check::*;
use carrystep_core::StartPhase;

#[test]
fn csv_has_a_line_for_every_pulse() {
    let machine = Machine::there_and_back(2);
    let mut bytes = Vec::new();
    let axes =
        machine.timelines.iter().cloned().zip(NAMES).map(|(timeline, name)| (name, timeline));
    play(
        &machine.train(),
        &mut *csv_writer(&mut bytes, &machine.timebase, StartPhase::Half, ORIGIN_PS, axes),
    );
    let text = String::from_utf8(bytes).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 1 + 2000 + 1000);
    assert_eq!(lines[0], "axis,pulse,time_s,speed_steps_per_s,direction,error_ns");
    // 64000 steps/s^2 for half a step takes sqrt(1 / 64000) = 0.003952847075 s, rounded down to a
    // phase.
    assert!(lines.contains(&"x,1,0.003952812500,,forward,-34.575"), "{}", lines[1]);
    let last: Vec<&str> =
        lines.iter().rfind(|line| line.starts_with("x,2000,")).unwrap().split(',').collect();
    assert_eq!(last[4], "backward");
    assert!((last[2].parse::<f64>().unwrap() - 0.4967).abs() < 1e-3, "{last:?}");
    assert!(last[3].parse::<f64>().unwrap() > 0.0);
}

#[test]
fn csv_of_an_empty_run_has_a_heading() {
    let machine = Machine::steady(1);
    let mut bytes = Vec::new();
    play(&[], &mut *csv_writer(&mut bytes, &machine.timebase, StartPhase::Half, 0, []));
    assert_eq!(bytes, b"axis,pulse,time_s,speed_steps_per_s,direction,error_ns\n");
}

#[test]
fn plot_stays_small_and_names_what_it_shows() {
    for axes in [1, 2, 6] {
        let machine = Machine::there_and_back(axes);
        let train = machine.train();
        let mut plot = Plot::new(machine.plot_setup());
        play(&train, &mut plot);
        let svg = plot.svg(&machine.check(&train, KNOWN)).unwrap();
        assert!(svg.len() < 1_500_000, "{}", svg.len());
        for word in [
            "There and back",
            "steps/s",
            "error, ns",
            "time, ms",
            "profile",
            "bound",
            "jitter",
            "speed ripple",
        ] {
            assert!(svg.contains(word), "{word}");
        }
        if let Some(folder) = std::env::var_os("CARRYSTEP_PLOTS") {
            std::fs::write(std::path::Path::new(&folder).join(format!("{axes}.svg")), svg).unwrap();
        }
    }
}

/// Writes a VCD and its save file for inspection by eye, if `CARRYSTEP_PLOTS` names a folder.
#[test]
fn waveform_and_save_file_are_written_on_request() {
    let Some(folder) = std::env::var_os("CARRYSTEP_PLOTS") else { return };
    let machine = Machine::there_and_back(6);
    let folder = std::path::Path::new(&folder);
    std::fs::write(folder.join("run.vcd"), machine.vcd(&machine.train())).unwrap();
    std::fs::write(
        folder.join("run.gtkw"),
        save_file("run.vcd", machine.names(), 500_000_000_000).unwrap(),
    )
    .unwrap();
}
