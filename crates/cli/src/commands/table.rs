//! `carrystep table`: makes a timer compare table as a C header, and writes the player for it.

use crate::arguments::{TableArguments as Arguments, TableKind};
use crate::failure::Failure;
use crate::output::{self, OutputFile};
use carrystep_table::{PLAYER, Table, TableError, TableFigures};
use schemars::JsonSchema;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct Tabled<'a> {
    passed: bool,
    #[serde(flatten)]
    table: &'a Table,
    files: Vec<PathBuf>,
}

/// Makes a table and prints it or writes it to the folder.
pub fn run(arguments: &Arguments) -> Result<(), Failure> {
    let kind = &arguments.kind;
    let output = &kind.common().output;
    let options = output.options()?;
    let table = Table::new(kind.request())?;
    let header = table.header(&options);
    let Some(folder) = &output.out else {
        return if output.json { json(&table, vec![]) } else { output::print(&header) };
    };
    let mut texts = vec![(format!("{}.h", options.name()), header.as_str())];
    texts.extend(player(kind).map(|(name, text)| (name.to_owned(), text)));
    let files = write(folder, &texts)?;
    if output.json {
        return json(&table, files);
    }
    let wrote: Vec<String> =
        files.iter().map(|file| format!("wrote {}\n", file.display())).collect();
    output::print(&format!("{}{}", figures(table.figures()), wrote.concat()))
}

fn json(table: &Table, files: Vec<PathBuf>) -> Result<(), Failure> {
    output::print_json(&Tabled { passed: true, table, files })
}

/// The source files that play this table.
fn player(kind: &TableKind) -> impl Iterator<Item = (&'static str, &'static str)> {
    let inverse = matches!(kind, TableKind::Sine { inverse: Some(_), .. });
    let bare = kind.common().output.bare;
    let needed = move |name: &str| if name.starts_with("carrystep_sine") { inverse } else { !bare };
    PLAYER.into_iter().filter(move |(name, _)| needed(name))
}

/// Begins all files, then writes them, then lets them appear.
fn write(folder: &Path, texts: &[(String, &str)]) -> Result<Vec<PathBuf>, Failure> {
    let claim = |(name, _): &(String, &str)| OutputFile::claim(&folder.join(name));
    let claims = texts.iter().map(claim).collect::<Result<Vec<_>, _>>()?;
    let mut files = claims.into_iter().map(OutputFile::begin).collect::<Result<Vec<_>, _>>()?;
    for (file, (_, text)) in files.iter_mut().zip(texts) {
        file.text(text)?;
    }
    files.into_iter().map(OutputFile::keep).collect()
}

fn figures(figures: &TableFigures) -> String {
    let TableFigures { timer_hz, entries, ramp_pulses, ramp_seconds, ramp_seconds_ideal, .. } =
        figures;
    let TableFigures { first_speed, top_speed_asked, top_speed, top_rpm, .. } = figures;
    let TableFigures { worst_speed_error, peak_acceleration, bytes, .. } = figures;
    format!(
        "table              {entries} entries, {ramp_pulses} pulses, {bytes} bytes\n\
         timer              {timer_hz} counts/s\n\
         ramp               {ramp_seconds:.6} s, by the formula {ramp_seconds_ideal:.6} s\n\
         first speed        {first_speed:.3} steps/s: the jump from rest\n\
         top speed          {top_speed:.3} steps/s ({top_rpm:.3} rpm), asked {top_speed_asked:.3}\n\
         worst rounding     {:.3} % of a speed\n\
         peak acceleration  {peak_acceleration:.0} steps/s^2\n",
        100.0 * worst_speed_error
    )
}

impl From<TableError> for Failure {
    fn from(error: TableError) -> Self {
        Self::input(error.to_string())
    }
}
