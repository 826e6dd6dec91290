//! `carrystep linuxcnc`: writes the configuration of LinuxCNC for a machine.

use crate::arguments::LinuxcncArguments;
use crate::failure::Failure;
use crate::output::{self, OutputFile};
use carrystep_core::link::{BuildId, LineKind};
use carrystep_files::{InputError, Machine};
use carrystep_linuxcnc::{BoardLine, Configuration, Wishes, component};
use schemars::JsonSchema;
use serde::Serialize;
use std::path::{Path, PathBuf};

/// Folder for the sources of the component, within that of the configuration.
const COMPONENT: &str = "component";

/// What `--json` prints.
#[derive(JsonSchema, Serialize)]
pub struct WrittenForLinuxcnc {
    passed: bool,
    build_id: String,
    port: String,
    /// Rate of a serial port, bit/s.
    #[serde(skip_serializing_if = "Option::is_none")]
    baud: Option<u32>,
    /// Rate of an SPI, Hz.
    #[serde(skip_serializing_if = "Option::is_none")]
    sck_hz: Option<u32>,
    /// Servo periods of 1 ms in a segment.
    periods: u32,
    /// Time from a command to its pulses, ms.
    horizon_ms: u32,
    joints: Vec<WrittenJoint>,
    /// What the user should know.
    notes: Vec<String>,
    files: Vec<PathBuf>,
}

#[derive(JsonSchema, Serialize)]
struct WrittenJoint {
    /// Name of the axis in the machine file.
    axis: String,
    /// Letter of the axis in LinuxCNC.
    letter: char,
    /// Joints with a lower number home earlier.
    home_sequence: u32,
}

/// Writes the configuration.
pub fn run(arguments: &LinuxcncArguments) -> Result<(), Failure> {
    let machine = Machine::load(&arguments.machine)?;
    let spi = machine.line().is_ok_and(|line| line == LineKind::Spi);
    let usual = if spi { "/dev/spidev0.0" } else { "/dev/ttyUSB1" };
    let wishes = Wishes {
        name: name(&arguments.machine),
        port: one_word(arguments.port.as_deref().unwrap_or(usual), "--port")?,
        horizon_ms: arguments.horizon_ms,
        display: one_word(&arguments.display, "--display")?,
        switches: arguments.switches.clone(),
    };
    let (configuration, notes) = Configuration::of_machine(&machine, wishes)
        .map_err(|error| Failure::input(format!("{}: {error}", arguments.machine.display())))?;
    let mut texts = configuration.files();
    if arguments.component {
        let folder = Path::new(COMPONENT);
        let sources = component().map(|(name, text)| {
            (folder.join(name).to_string_lossy().into_owned(), text.to_owned())
        });
        texts.extend(sources);
    }
    let (baud, sck_hz) = match configuration.line {
        BoardLine::Uart { baud } => (Some(baud), None),
        BoardLine::Spi { sck_hz } => (None, Some(sck_hz)),
    };
    let files = write(&arguments.out, &texts, arguments.force)?;
    let joint =
        |(joint, axis): (&carrystep_linuxcnc::Joint, &carrystep_files::Axis)| WrittenJoint {
            axis: axis.name.clone(),
            letter: joint.letter,
            home_sequence: joint.sequence,
        };
    let written = WrittenForLinuxcnc {
        passed: true,
        build_id: configuration.build.map_or_else(String::new, |id| BuildId(id).to_string()),
        port: configuration.port.clone(),
        baud,
        sck_hz,
        periods: configuration.periods,
        horizon_ms: configuration.horizon_ms,
        joints: configuration.joints.iter().zip(&machine.axes).map(joint).collect(),
        notes,
        files,
    };
    if arguments.json { output::print_json(&written) } else { output::print(&told(&written)) }
}

/// The text for people: files, figures, notes, and how to go on.
fn told(written: &WrittenForLinuxcnc) -> String {
    let WrittenForLinuxcnc { port, baud, sck_hz, periods, horizon_ms, build_id, .. } = written;
    let rate = match (baud, sck_hz) {
        (Some(baud), _) => format!("{baud} baud"),
        (None, sck_hz) => format!("{} Hz", sck_hz.unwrap_or(0)),
    };
    let letters: String = written.joints.iter().map(|joint| joint.letter).collect();
    let files: String =
        written.files.iter().map(|file| format!("wrote {}\n", file.display())).collect();
    let notes: String = written.notes.iter().map(|note| format!("note: {note}\n")).collect();
    let ini = written.files.first().map(|file| file.display().to_string()).unwrap_or_default();
    format!(
        "{files}{letters}: segments of {periods} ms, horizon {horizon_ms} ms; {port} at {rate}, \
         build {build_id}\n{notes}start it: linuxcnc {ini}\n"
    )
}

/// The name of the files: that of the machine file, with `-` for what LinuxCNC's files do not take.
fn name(machine: &Path) -> String {
    let stem = machine.file_stem().unwrap_or_default().to_string_lossy();
    let fit = |c: char| if c.is_ascii_alphanumeric() || c == '_' { c } else { '-' };
    stem.chars().map(fit).collect()
}

/// Text for a line of an INI file.
fn one_word(text: &str, option: &str) -> Result<String, Failure> {
    let fits = |c: char| !c.is_whitespace() && !c.is_control() && !"\"'#;[]$".contains(c);
    if !text.is_empty() && text.chars().all(fits) {
        return Ok(text.to_owned());
    }
    let message = format!("{option} {text:?} cannot stand in LinuxCNC's files");
    Err(InputError::new(message).help("a path without spaces, quotes, brackets, # ; and $").into())
}

/// Begins all files, then writes them, then lets them appear. Nothing is written if one of them is
/// there already and may not be replaced.
fn write(folder: &Path, texts: &[(String, String)], force: bool) -> Result<Vec<PathBuf>, Failure> {
    let there =
        |(name, _): &&(String, String)| !force && folder.join(name).symlink_metadata().is_ok();
    if let Some((name, _)) = texts.iter().find(there) {
        let message = format!("{} is there already", folder.join(name).display());
        let help = "take another folder for --out, or replace the files with --force";
        return Err(InputError::new(message).help(help).into());
    }
    let claim = |(name, _): &(String, String)| OutputFile::claim(&folder.join(name));
    let claims = texts.iter().map(claim).collect::<Result<Vec<_>, _>>()?;
    let mut files = claims.into_iter().map(OutputFile::begin).collect::<Result<Vec<_>, _>>()?;
    for (file, (_, text)) in files.iter_mut().zip(texts) {
        file.text(text)?;
    }
    files.into_iter().map(OutputFile::keep).collect()
}
