//! Changes of single entries in nextpnr's file of delays.

use std::collections::HashSet;

/// A name as nextpnr writes it.
fn escaped(name: &str) -> String {
    let escapes = |character| match character {
        '$' | '\\' | '[' | ']' | ':' => vec!['\\', character],
        _ => vec![character],
    };
    name.chars().flat_map(escapes).collect()
}

/// The file with every line replaced that `new` replaces. `new` receives the cell to which the line
/// belongs, as nextpnr writes its name, and the line's words.
fn with(sdf: &str, new: impl Fn(&str, &[&str]) -> Option<String>) -> String {
    let mut cell = String::new();
    let lines = sdf.lines().map(|line| {
        if let Some(name) = line.trim().strip_prefix("(INSTANCE ") {
            cell = name.trim_end_matches(')').to_owned();
        }
        let words: Vec<&str> = line.split_whitespace().collect();
        new(&cell, &words).unwrap_or_else(|| line.to_owned()) + "\n"
    });
    lines.collect()
}

/// The delay in `(A:A:A)`, ps.
fn delay(word: &str) -> u64 {
    let first = word.trim_start_matches('(').split(':').next();
    first.and_then(|number| number.parse().ok()).expect("a delay")
}

/// The file with the wires to all inputs of a cell longer, except those to its clock.
pub fn with_longer_wires(sdf: &str, cell: &str, more: u64) -> String {
    let cell = escaped(cell) + "/";
    with(sdf, |_, words| match words {
        ["(INTERCONNECT", from, to, value, _]
            if to.strip_prefix(&cell).is_some_and(|pin| !pin.ends_with("CLK")) =>
        {
            let value = delay(value) + more;
            let value = format!("({value}:{value}:{value})");
            Some(format!("(INTERCONNECT {from} {to} {value} {value})"))
        }
        _ => None,
    })
}

/// The checks of all inputs that may change: cells and their inputs.
pub fn checks(sdf: &str) -> Vec<(String, String)> {
    let wires = sdf.lines().filter_map(|line| line.trim().strip_prefix("(INTERCONNECT "));
    let ends = wires.filter(|wire| !wire.starts_with("\\$PACKER")).filter_map(|wire| {
        let (cell, pin) = wire.split(' ').nth(1)?.rsplit_once('/')?;
        Some((cell.replace('\\', ""), pin.to_owned()))
    });
    let changing: HashSet<(String, String)> = ends.collect();
    let mut cell = String::new();
    let mut all = Vec::new();
    for line in sdf.lines().map(str::trim) {
        if let Some(name) = line.strip_prefix("(INSTANCE ") {
            cell = name.trim_end_matches(')').replace('\\', "");
        } else if let Some(check) = line.strip_prefix("(SETUPHOLD (posedge ") {
            let (pin, _) = check.split_once(')').expect("an input");
            all.push((cell.clone(), pin.to_owned()));
        }
    }
    all.retain(|check| changing.contains(check));
    all
}

/// The file with another check of an input; without one if `times`, set-up and hold in ps, is
/// `None`.
pub fn with_check(sdf: &str, (cell, pin): &(String, String), times: Option<(u64, u64)>) -> String {
    let (cell, pin) = (escaped(cell), format!("{pin})"));
    with(sdf, |of, words| match words {
        ["(SETUPHOLD", edge, input, at, clock, ..] if of == cell && *input == pin => {
            let check = times.map(|(setup, hold)| {
                format!(
                    "(SETUPHOLD {edge} {input} {at} {clock} ({setup}:{setup}:{setup}) ({hold}:{hold}:{hold}))"
                )
            });
            Some(check.unwrap_or_default())
        }
        _ => None,
    })
}

/// The file without its first line that begins with these words.
pub fn without_first(sdf: &str, begin: &str) -> String {
    let at = sdf.find(begin).expect("such a line");
    let end = sdf[at..].find('\n').expect("its end");
    format!("{}{}", &sdf[..at], &sdf[at + end..])
}
