//! `carrystep profile`: the curves of the literature as figures, tables and plots.

use crate::arguments::ProfileArguments;
use crate::failure::Failure;
use crate::figures::{self, FiguresJson};
use crate::output::{self, OutputFile};
use carrystep_core::ProfileKind;
use carrystep_core::StartPhase;
use carrystep_profile::reference::{
    CsvError, Drive, Length, Listing, PictureError, Reference, ReferenceError, Row, Scale, picture,
    write_csv,
};
use schemars::JsonSchema;
use serde::Serialize;
use std::io;
use std::path::{Path, PathBuf};

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct Profiles<'a> {
    passed: bool,
    drive: &'a Drive,
    phase: StartPhase,
    #[serde(skip_serializing_if = "Option::is_none")]
    timer_hz: Option<f64>,
    profiles: Vec<ProfileJson>,
    files: Vec<PathBuf>,
}

#[derive(JsonSchema, Serialize)]
struct ProfileJson {
    kind: ProfileKind,
    ramp: bool,
    figures: FiguresJson,
    steps: Vec<Row>,
}

/// Prints, lists and draws the requested curves.
pub fn run(arguments: &ProfileArguments) -> Result<(), Failure> {
    only_once(arguments)?;
    let request = arguments.request();
    let references = request.references(&arguments.kinds)?;
    let listing = arguments.listing();
    let files = files(arguments, &references, &request.drive)?;
    if arguments.json {
        let profiles = references
            .iter()
            .map(|reference| json(reference, &listing))
            .collect::<Result<_, _>>()?;
        let Listing { phase, clock_hz: timer_hz } = listing;
        let drive = &request.drive;
        return output::print_json(&Profiles {
            passed: true,
            drive,
            phase,
            timer_hz,
            profiles,
            files,
        });
    }
    if to_stdout(arguments) {
        return Ok(write_csv(io::stdout().lock(), &references, &listing)?);
    }
    let wrote: Vec<String> =
        files.iter().map(|file| format!("wrote {}\n", file.display())).collect();
    output::print(&format!("{}{}", figures::table(&references, &request.drive), wrote.concat()))
}

fn only_once(arguments: &ProfileArguments) -> Result<(), Failure> {
    let ProfileArguments { kinds, .. } = arguments;
    if let Some((_, twice)) =
        kinds.iter().enumerate().find(|(place, kind)| kinds[..*place].contains(kind))
    {
        return Err(Failure::input(format!("{twice} is named twice")));
    }
    if arguments.json && to_stdout(arguments) {
        return Err(Failure::input(
            "--csv - and --json would both go to standard output: give --csv a file",
        ));
    }
    Ok(())
}

fn to_stdout(arguments: &ProfileArguments) -> bool {
    arguments.csv.as_deref() == Some(Path::new("-"))
}

/// Begins all files, then writes them, then lets them appear.
fn files(
    arguments: &ProfileArguments,
    references: &[Reference],
    drive: &Drive,
) -> Result<Vec<PathBuf>, Failure> {
    let claim = |path: Option<&PathBuf>| path.map(|path| OutputFile::claim(path)).transpose();
    let claims = [
        claim(arguments.csv.as_ref().filter(|_| !to_stdout(arguments)))?,
        claim(arguments.plot.as_ref())?,
    ];
    let [csv, plot] = claims.map(|claim| claim.map(OutputFile::begin).transpose());
    let (mut csv, mut plot) = (csv?, plot?);
    if let Some(file) = &mut csv {
        write_csv(file, references, &arguments.listing())?;
    }
    if let Some(file) = &mut plot {
        file.text(&picture(references, scale(drive)?)?)?;
    }
    [csv, plot].into_iter().flatten().map(OutputFile::keep).collect()
}

/// The unit of the plot: millimetres if the drive has a travel per turn, otherwise steps.
fn scale(drive: &Drive) -> Result<Scale, ReferenceError> {
    let unit = drive.travel_per_rev_mm.map_or(Length::Step, |_| Length::Millimetre);
    Ok(Scale { unit, steps: drive.steps_in(unit)? })
}

fn json(reference: &Reference, listing: &Listing) -> Result<ProfileJson, ReferenceError> {
    Ok(ProfileJson {
        kind: reference.kind(),
        ramp: reference.is_ramp(),
        figures: FiguresJson::new(reference),
        steps: reference.rows(listing)?.collect(),
    })
}

impl From<ReferenceError> for Failure {
    fn from(error: ReferenceError) -> Self {
        Self::input(error.to_string())
    }
}

impl From<PictureError> for Failure {
    fn from(error: PictureError) -> Self {
        Self::Run(error.to_string())
    }
}

impl From<CsvError> for Failure {
    fn from(error: CsvError) -> Self {
        match error {
            CsvError::Write(error) if error.kind() == io::ErrorKind::BrokenPipe => Self::ReaderGone,
            _ => Self::input(error.to_string()),
        }
    }
}
