//! The failures of the command, and the errors of the libraries that become one.

use carrystep_boards::BoardError;
use carrystep_check::TraceError;
use carrystep_files::InputError;
use carrystep_program::ProgramError;
use carrystep_simulators::LevelError;
use carrystep_tools::SynthesisError;
use carrystep_verilog::ExportError;

/// The reason why the command failed, which determines the exit status.
#[derive(Debug)]
pub enum Failure {
    /// Status 1: the check failed. The report has been printed already.
    Check,
    /// Status 1: the run failed.
    Run(String),
    /// Status 2: the input is wrong or a move is impossible.
    Input(InputError),
    /// Status 3: a tool is missing.
    Tool(String),
    /// Status 4: no case of a sweep ran, for example in an empty shard. The report has been printed
    /// already.
    NothingTried,
    /// Status 0: the reader of the output has closed the pipe.
    ReaderGone,
}

impl Failure {
    /// A failure with status 2 that points to no line of a file.
    pub fn input(message: impl Into<String>) -> Self {
        Self::Input(InputError::new(message))
    }

    /// The message, for a report of many runs.
    pub fn message(&self) -> String {
        match self {
            Self::Check => "the check failed".to_owned(),
            Self::NothingTried => "no case ran".to_owned(),
            Self::Run(message) | Self::Tool(message) => message.clone(),
            Self::Input(error) => error.to_string(),
            Self::ReaderGone => "nobody reads the output".to_owned(),
        }
    }
}

impl From<InputError> for Failure {
    fn from(error: InputError) -> Self {
        Self::Input(error)
    }
}

impl From<ProgramError> for Failure {
    fn from(error: ProgramError) -> Self {
        Self::Input(error.into())
    }
}

impl From<BoardError> for Failure {
    fn from(error: BoardError) -> Self {
        Self::input(error.to_string())
    }
}

impl From<ExportError> for Failure {
    fn from(error: ExportError) -> Self {
        match error {
            ExportError::Machine(error) => Self::Input(error),
            _ => Self::input(error.to_string()),
        }
    }
}

impl From<SynthesisError> for Failure {
    fn from(error: SynthesisError) -> Self {
        match error {
            SynthesisError::Missing(_) => Self::Tool(error.to_string()),
            _ => Self::Run(error.to_string()),
        }
    }
}

impl From<LevelError> for Failure {
    fn from(error: LevelError) -> Self {
        match error {
            LevelError::Missing(_) => Self::Tool(error.to_string()),
            LevelError::Cache { .. } => Self::input(error.to_string()),
            _ => Self::Run(error.to_string()),
        }
    }
}

impl From<TraceError> for Failure {
    fn from(error: TraceError) -> Self {
        Self::Input(InputError::new(error.to_string()))
    }
}
