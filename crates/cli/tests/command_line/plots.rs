//! `carrystep simulate --plot`: what the picture says.

use crate::command::Folder;

/// What a passed run shows of jitter and ripple is within what the plot says is allowed, a fit included.
#[test]
fn a_plot_shows_what_is_allowed() {
    let folder = Folder::new();
    for profile in ["sine", "logistic", "trapezoid"] {
        folder.write(
            "move.toml",
            format!(
                "[machine]\n[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 1\nspeed_limit = 150_000\n\
                 accel_limit = 500_000\nstep_ns = 100\ngap_ns = 100\nsetup_ns = 100\nhold_ns = 100\n\
                 [[move]]\nprofile = \"{profile}\"\nto = {{ x = 20_000 }}\n"
            ),
        );
        assert_eq!(folder.run("simulate move.toml --plot move.svg").status, 0);
        let svg = std::fs::read_to_string(folder.path("move.svg")).unwrap();
        let line = svg.lines().find(|line| line.contains("jitter ")).unwrap();
        let numbers: Vec<f64> = line.split([' ', '\n']).filter_map(|word| word.parse().ok()).collect();
        let [jitter, jitter_most, ripple, ripple_most] = numbers[..] else { panic!("{line}") };
        assert!(0.0 < jitter && jitter <= jitter_most, "{profile}: {line}");
        assert!(0.0 < ripple && ripple <= ripple_most, "{profile}: {line}");
    }
}
