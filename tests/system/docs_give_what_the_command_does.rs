//! Figures of the documentation that describe the command and what surrounds it: exit statuses,
//! documents, the scripts of the action, and long moves and runs.

use carrystep_tests::pages::{self, grouped, says, word};
use carrystep_tests::sources::{behind, constant, power_of_ten, whole};

/// The exit status of a kind of failure, as the source of the command gives it.
fn status(kind: &str) -> u64 {
    whole(behind("crates/cli/src/ending.rs", kind))
}

#[test]
fn pages_give_the_exit_statuses_of_the_command() {
    let check = status("Failure::Check => return ExitCode::from(");
    let nothing = status("Failure::NothingTried => return ExitCode::from(");
    let run = status("Failure::Run(message) => (");
    let input = status("Failure::Input(error) => (");
    let tool = status("Failure::Tool(message) => (");
    // clap sets the status of wrong arguments; a test of the command requires it.
    let usage = whole(behind(
        "crates/cli/tests/command_line/bad_curves.rs",
        "assert_eq!(output.status.code(), Some(",
    ));
    assert_eq!(check, run, "one sentence gives the status of both");
    says(
        "README.md",
        &[format!(
            "is 0 for success, {run} if the check or the run failed, {input} for bad input or an impossible move, {tool} if a tool is missing, and {nothing} if no case of a sweep ran."
        )],
    );
    says(
        "docs/json.md",
        &[
            format!("if no case of a sweep ran (exit status {nothing})."),
            format!("a check (exit status {check}), or `doctor` with a missing tool ({tool})."),
            format!("`run` (exit status {run}: the run failed), `input` ({input}: an error"),
            format!("`usage` ({usage}: an error in the arguments), `tool` ({tool}: a program"),
        ],
    );
    says(
        "docs/flashing.md",
        &[
            format!("there is no bitstream, and the exit status is {check}."),
            format!("the exit status is still {check} if the placed gateware"),
            format!("run the script, and ends with exit status {tool}."),
        ],
    );
    says(
        "docs/sweeps.md",
        &[
            format!("and makes the exit status {check}."),
            format!("`passed` is null and the exit status is {nothing}:"),
            format!("| the disk is full | exit status {input};"),
        ],
    );
    says(
        "docs/performance.md",
        &[
            format!("the run ends with status {run} and the message `interrupted"),
            format!("at the first block that does not fit, with status {input}."),
        ],
    );
    says("docs/homing.md", &[format!("homing fails with exit status {run}, and the message")]);
}

#[test]
fn json_page_gives_the_draft_and_the_bits_of_a_number() {
    let schema = pages::file("docs/schemas/plan.json");
    let (_, rest) = schema.split_once("https://json-schema.org/draft/").expect("a draft");
    let (draft, _) = rest.split_once('/').expect("its end");
    says(
        "docs/json.md",
        &[
            format!("(draft {draft})"),
            format!("many JSON readers keep only {} bits.", f64::MANTISSA_DIGITS),
        ],
    );
}

/// The page says which option of the shell needs this version.
#[test]
fn page_of_the_action_names_the_option_that_needs_a_new_bash() {
    let script = pages::file(".github/actions/check/check.sh");
    assert!(script.lines().any(|line| line.starts_with("shopt -s ") && line.contains("globstar")));
    says("docs/ci.md", &["bash 4 or newer (whose option `globstar` it uses for `**`)".to_owned()]);
}

#[test]
fn architecture_page_gives_the_longest_slow_move() {
    let longest = power_of_ten(behind(
        "tests/rung_1_plan_stays_with_the_profile/slow.rs",
        "decades(1.0, 2000.0), decades(100.0, ",
    ));
    says("docs/architecture.md", &[format!("of each profile, up to 10^{longest} s.")]);
}

/// The table gives the hour's time on the date of its measurement.
#[test]
fn readme_says_how_long_the_hour_takes() {
    let page = pages::joined("docs/performance.md");
    let (_, rest) = page.split_once("against the float profile in ").expect("the hour");
    let seconds: f64 = rest.split(' ').next().and_then(|s| s.parse().ok()).expect("seconds");
    assert!(seconds < 60.0, "{seconds}");
    says("README.md", &["one hour of six axes in [under a minute]".to_owned()]);
}

/// The numbers between the brackets of a constant array of a source file.
fn array(file: &str, name: &str) -> Vec<u64> {
    let source = pages::file(file);
    let (_, rest) = source.split_once(&format!("const {name}: [")).expect("a constant array");
    let (_, rest) = rest.split_once(" = [").expect("its values");
    let (values, _) = rest.split_once(']').expect("their end");
    values.split(", ").map(|value| value.parse().expect("a number")).collect()
}

#[test]
fn performance_page_gives_how_growth_is_measured() {
    let growth = "crates/xtask/benches/levels/growth.rs";
    let factors = array(growth, "FACTORS");
    let [one, ten, hundred] = factors[..] else { panic!("{factors:?}") };
    let ratio = constant(growth, "RATIO_AT_MOST");
    let turns = array(growth, "TURNS");
    let runs = |size| word(turns.iter().filter(|turn| **turn == size).count() as u64);
    let more = word(whole(constant(growth, "MORE")));
    let list = whole(constant("crates/profile/src/reference/row.rs", "MOST_ROWS"));
    assert_eq!(list, whole(constant("crates/table/src/request.rs", "MAX_RAMP")));
    let inputs = "crates/xtask/benches/levels/growth/inputs.rs";
    let shortest = whole(behind(inputs, "let steps = "));
    let longest = shortest + whole(behind(inputs, "number / 2 % ")) - 1;
    let words = format!("more than {ratio} times as long as at {one}");
    says(
        "docs/performance.md",
        &[
            format!("with {one}, {ten} and {hundred} times the work, and fails"),
            format!("at {ten} or {hundred} times the work takes {words}"),
            format!(
                "{} runs at {one}, {} at {ten} and {} at {hundred}.",
                runs(0),
                runs(1),
                runs(2)
            ),
            format!("up to {more} more rounds follow"),
            format!("S-curves of {shortest} to {longest} steps"),
            format!("a table's ramp has at most {} steps", grouped(list)),
            format!("The plan of more than {} moves is made twice", kept_moves()),
        ],
    );
    says(
        "CHANGELOG.md",
        &[
            format!("at {one}, {ten} and {hundred} times the work. It fails"),
            format!("at {ten} or {hundred} takes {words}"),
        ],
    );
}

/// The greatest number of moves whose plan is kept.
fn kept_moves() -> u64 {
    1 << whole(behind("crates/plan/src/stream.rs", "const KEPT: usize = 1 << "))
}

#[test]
fn pages_give_the_limits_of_a_long_move_file() {
    let mebibytes = constant("crates/files/src/input.rs", "MAX_TEXT_BYTES") / 1024.0_f64.powi(2);
    let whole_file = constant("crates/files/src/moves.rs", "WHOLE_BYTES") / 1024.0;
    says(
        "docs/machine-files.md",
        &[
            format!("One of over {whole_file} KiB is read move by move"),
            format!("have at most {mebibytes} MiB each"),
        ],
    );
    says(
        "docs/decisions/0065-plans-are-made-while-they-are-used.md",
        &[
            format!("a file of over {whole_file} KiB has its machine before its moves"),
            format!("The plan of up to {} moves is kept", kept_moves()),
            format!(
                "longer than {} MiB",
                1 << (whole(behind("crates/cli/src/spool.rs", "const KEPT: usize = 1 << ")) - 20)
            ),
        ],
    );
}

#[test]
fn performance_page_gives_the_rows_of_memory() {
    let rows = "crates/xtask/benches/levels/growth/rows.rs";
    let (source, page) = (pages::joined(rows), pages::file("docs/performance.md"));
    let moves = whole(constant(rows, "MANY"));
    let most = constant("crates/xtask/benches/levels/growth.rs", "MEGABYTES_AT_MOST");
    let (_, table) = page.split_once("| command | moves |").expect("the table");
    let table: Vec<&str> = table.lines().skip(2).take_while(|line| !line.is_empty()).collect();
    let number = whole(behind(rows, "MEMORY_ROWS: [Row; "));
    assert_eq!(table.len() as u64, number);
    for row in table {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let command = format!("\"{}\"", cells[0].trim_matches('`'));
        assert!(source.contains(&command), "{row}");
        assert_eq!(cells[1], moves.to_string(), "{row}");
        let megabytes: f64 = cells[2].parse().expect("a figure");
        assert!(cells[3] == most.to_string() && megabytes < most, "{row}");
    }
    says(
        "docs/performance.md",
        &[format!(
            "{} moves of a single step, and fails if it uses more than {most} MB",
            grouped(moves)
        )],
    );
}

#[test]
fn performance_page_gives_the_rows_of_growth() {
    let source = pages::joined("crates/xtask/benches/levels/growth/rows.rs").replace('_', "");
    let page = pages::file("docs/performance.md");
    let (_, table) = page.split_once("| command | unit |").expect("the table");
    let rows: Vec<&str> = table.lines().skip(2).take_while(|line| !line.is_empty()).collect();
    let number: usize = whole(behind("crates/xtask/benches/levels/growth/rows.rs", "[Row; "))
        .try_into()
        .expect("a small number");
    assert_eq!(rows.len(), number);
    let ratio = constant("crates/xtask/benches/levels/growth.rs", "RATIO_AT_MOST");
    for row in rows {
        let cells: Vec<&str> = row.trim_matches('|').split('|').map(str::trim).collect();
        let (command, unit, units) = (cells[0].trim_matches('`'), cells[1], cells[2]);
        let as_moves = source.contains(&format!("moves(\"{command}\", {units})"));
        let begin = format!("command: \"{command}\", input: Input::");
        let end = format!("unit: \"{unit}\", units: {units}");
        let as_row = source
            .split(&begin)
            .skip(1)
            .any(|rest| rest.split_once('}').is_some_and(|(rest, _)| rest.contains(&end)));
        assert!(as_row || (as_moves && unit == "move"), "{row}");
        let figures: Vec<f64> =
            cells[3..].iter().map(|cell| cell.parse().expect("a figure")).collect();
        for (time, shown) in [(1, 3), (2, 4)] {
            let of_times = figures[time] / figures[0];
            assert!((of_times - figures[shown]).abs() < 0.01, "{row}");
            assert!(figures[shown] <= ratio, "{row}");
        }
    }
}
