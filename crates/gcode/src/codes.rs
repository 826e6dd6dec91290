//! The G and M codes: which of them are done, and which exclude each other in a line.

use crate::error::{ErrorKind, short};
use std::fmt;

/// A G or M code, in tenths: G38.2 is `g` and 382.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Code {
    /// `g` or `m`.
    pub(crate) letter: u8,
    pub(crate) tenths: u16,
    pub(crate) column: u32,
}

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let letter = char::from(self.letter.to_ascii_uppercase());
        write!(f, "{letter}{}", self.tenths / 10)?;
        if self.tenths.is_multiple_of(10) { Ok(()) } else { write!(f, ".{}", self.tenths % 10) }
    }
}

/// A modal group. Of each group, a line has at most one code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Group {
    /// G4, G10, G28, G30, G53, G92.
    Once,
    Motion,
    Plane,
    Distance,
    CentreDistance,
    FeedMode,
    Units,
    CutterRadius,
    /// G8.
    Diameter,
    ToolLength,
    Retract,
    System,
    Path,
    SpindleMode,
    /// M62 to M68.
    Output,
    /// M0, M1, M2, M30, M60, M98, M99.
    Stop,
    /// M6.
    Tool,
    Spindle,
    /// M7, M8 and M9.
    Coolant,
    Overrides,
}

/// Number of groups.
pub(crate) const GROUPS: usize = Group::Overrides as usize + 1;

impl Code {
    /// Makes a code of a value.
    pub(crate) fn new(letter: u8, value: f64, column: u32) -> Result<Self, ErrorKind> {
        let tenths = (value * 10.0).round();
        let is_code = (value * 10.0 - tenths).abs() < 0.001 && (0.0..10_000.0).contains(&tenths);
        if !is_code {
            let letter = char::from(letter.to_ascii_uppercase());
            return Err(ErrorKind::UnknownCode(format!("{letter}{}", short(value))));
        }
        Ok(Self { letter, tenths: tenths as u16, column })
    }

    /// Its group, if the code is done.
    pub(crate) fn group(self) -> Result<Group, ErrorKind> {
        let group = if self.letter == b'g' { g_group(self.tenths) } else { m_group(self.tenths) };
        group.map_err(|reason| match reason {
            Some(reason) => ErrorKind::NotDone { code: self.to_string(), reason },
            None => ErrorKind::UnknownCode(self.to_string()),
        })
    }
}

/// The group of a G code, or why it is not done.
fn g_group(tenths: u16) -> Result<Group, Option<&'static str>> {
    Ok(match tenths {
        40 | 100 | 280 | 281 | 300 | 301 | 530 | 920..=923 => Group::Once,
        0 | 10 | 20 | 30 | 382..=385 | 800 | 810 | 820 | 830 => Group::Motion,
        170 | 180 | 190 => Group::Plane,
        900 | 910 => Group::Distance,
        901 | 911 => Group::CentreDistance,
        930 | 940 => Group::FeedMode,
        200 | 210 => Group::Units,
        400 => Group::CutterRadius,
        80 => Group::Diameter,
        430..=432 | 490 => Group::ToolLength,
        980 | 990 => Group::Retract,
        540 | 550 | 560 | 570 | 580 | 590..=593 => Group::System,
        610 | 611 | 640 => Group::Path,
        970 => Group::SpindleMode,
        410 | 411 | 420 | 421 => {
            return Err(Some("cutter compensation; let the CAM program compute the path"));
        }
        330 | 331 => return Err(Some("motion in step with the spindle, which is not measured")),
        760 => return Err(Some("a threading cycle; the spindle is not measured")),
        950 => return Err(Some("feed per turn of the spindle; use G94 or G93")),
        960 => return Err(Some("constant surface speed; use G97 and S")),
        50..=53 => return Err(Some("splines; write lines or arcs")),
        70 => return Err(Some("X as a diameter, on lathes")),
        171 | 181 | 191 => return Err(Some("planes of U, V and W, which are no axes here")),
        150 | 160 => return Err(Some("polar coordinates as a mode; use @ and ^")),
        520 => return Err(Some("local coordinates; use G92 or G10 L2")),
        500 | 510 => return Err(Some("scaling; multiply the values")),
        680 | 690 => return Err(Some("rotation; use R of G10 L2")),
        700 | 710..=712 | 720..=722 => return Err(Some("lathe cycles; write the moves")),
        730 | 740 | 840 | 850 | 860 | 870 | 880 | 890 => {
            return Err(Some("a cycle that is not done; use G81, G82 or G83, or write the moves"));
        }
        _ => return Err(None),
    })
}

/// The group of an M code, or why it is not done.
fn m_group(tenths: u16) -> Result<Group, Option<&'static str>> {
    Ok(match tenths {
        0 | 10 | 20 | 300 | 600 | 980 | 990 => Group::Stop,
        30 | 40 | 50 => Group::Spindle,
        60 => Group::Tool,
        70 | 80 | 90 => Group::Coolant,
        480 | 490 => Group::Overrides,
        620 | 630 | 640 | 650 | 660 | 670 | 680 => Group::Output,
        190 => return Err(Some("the spindle is not oriented")),
        500 | 510 | 520 | 530 => {
            return Err(Some("single overrides and adaptive feed; use M48 and M49"));
        }
        610 => return Err(Some("a tool without its change; use T and M6")),
        700 | 710 | 720 | 730 => return Err(Some("saved modes; write the modes anew")),
        _ if (1000..=1990).contains(&tenths) && tenths.is_multiple_of(10) => {
            return Err(Some("programs of the user are not run"));
        }
        _ => return Err(None),
    })
}
