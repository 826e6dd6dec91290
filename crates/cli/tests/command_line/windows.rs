//! `carrystep simulate --from --to --axes`: the waveform of a part of a run.

use crate::command::{Folder, GOOD};

#[test]
fn window_is_a_part_of_the_waveform_and_no_capture() {
    let folder = Folder::with_move(GOOD);
    let times = |name: &str| {
        let text = std::fs::read_to_string(folder.path(name)).unwrap();
        let times: Vec<u64> =
            text.lines().filter_map(|line| line.strip_prefix('#')?.parse().ok()).collect();
        (times[0], times[times.len() - 1])
    };
    let whole = folder.run("simulate move.toml --vcd whole.vcd --fst whole.fst");
    let part = folder.run("simulate move.toml --vcd part.vcd --fst part.fst --from 0.01 --to 0.02");
    assert_eq!((whole.status, part.status), (0, 0));
    let ((_, end), (from, to)) = (times("whole.vcd"), times("part.vcd"));
    assert_eq!(to - from, 10_000_000_000);
    assert!(from >= 10_000_000_000 && to < end, "{from} {to} {end}");
    assert!(folder.path("part.fst").exists());
    // The run itself is checked as a whole.
    let report = |text: &str| text.lines().filter(|l| !l.starts_with("wrote")).count();
    assert_eq!(report(&whole.stdout), report(&part.stdout));
    folder.run("check part.vcd move.toml").refuses(
        "part.vcd: it shows only a part of a run (--from, --to or --axes of simulate); a check needs \
         all pulses",
    );
}

#[test]
fn window_outside_the_run_is_named() {
    let folder = Folder::with_move(GOOD);
    let before = folder.files();
    let refused = |options: &str, says: &str| {
        folder.run(&format!("simulate move.toml {options}")).refuses(says);
        assert_eq!(folder.files(), before, "{options}");
    };
    refused("--vcd a.vcd --from 1000", "--from 1000 is not within the moves, which take 0.");
    refused("--vcd a.vcd --from 0.02 --to 0.01", "--from 0.02 is not before --to 0.01");
    refused("--vcd a.vcd --from -1", "expected a time from 0 to 4000000 s");
    refused("--vcd a.vcd --to soon", "expected a number of seconds");
    refused("--fst a.fst --axes x,q", "no axis is called 'q': the axes are x");
    refused("--from 0.01", "<--vcd <FILE>|--fst <FILE>>");
}
