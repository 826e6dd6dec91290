//! The contents of the picture that `carrystep simulate --plot` draws.

use crate::command::Folder;

/// Jitter and ripple of a passed run stay within the bounds that the plot states, fits included.
#[test]
fn plotted_errors_stay_within_the_plotted_bounds() {
    let folder = Folder::new();
    for profile in ["sine", "logistic", "trapezoid"] {
        folder.write(
            "move.toml",
            format!(
                "[machine]\n[[machine.axis]]\nname = \"x\"\nsteps_per_unit = 1\nspeed_limit = 150_000\n\
                 accel_limit = 500_000\nstep_high_ns = 100\nstep_low_ns = 100\ndir_setup_ns = 100\ndir_hold_ns = 100\n\
                 [[move]]\nprofile = \"{profile}\"\nto = {{ x = 20_000 }}\n"
            ),
        );
        assert_eq!(folder.run("simulate move.toml --plot move.svg").status, 0);
        let svg = std::fs::read_to_string(folder.path("move.svg")).unwrap();
        let line = svg.lines().find(|line| line.contains("jitter ")).unwrap();
        let numbers: Vec<f64> =
            line.split([' ', '\n']).filter_map(|word| word.parse().ok()).collect();
        let [jitter, jitter_most, ripple, ripple_most] = numbers[..] else { panic!("{line}") };
        assert!(0.0 < jitter && jitter <= jitter_most, "{profile}: {line}");
        assert!(0.0 < ripple && ripple <= ripple_most, "{profile}: {line}");
    }
}
