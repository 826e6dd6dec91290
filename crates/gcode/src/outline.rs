//! The outline of a program: its O-words and where each of them leads.
//!
//! The outline is made once, before the first line is executed. A program whose blocks do not close
//! is therefore refused before anything moves, and a loop, branch or call is a jump to a place in
//! the file that is known. The memory grows with the number of O-words only.

mod building;

use crate::error::GcodeError;
use crate::grammar::{self, LineKind};
use crate::outline::building::Building;
use crate::source::{Place, Source};
use crate::squeeze::Squeezed;
use crate::syntax::{Block, OWord};
use std::collections::HashMap;
use std::io::{Read, Seek};
use std::sync::Arc;

/// An O-word in the file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Node {
    pub(crate) word: OWord,
    /// The beginning of its line.
    pub(crate) at: Place,
    /// The beginning of the line after it.
    pub(crate) after: Place,
    /// Where it leads: the next branch of `if`, the end of a loop or a subroutine from its
    /// beginning and from `break`, the beginning from its end and from `continue`.
    pub(crate) leads_to: usize,
    /// For `elseif` and `else`: the `endif`.
    pub(crate) end: usize,
    /// True for the `while` that ends a `do`.
    pub(crate) ends_do: bool,
}

/// All O-words in the order of the file.
#[derive(Debug, Default)]
pub(crate) struct Outline {
    pub(crate) nodes: Vec<Node>,
    /// The subroutines by style and label.
    subs: HashMap<(Style, Box<str>), usize>,
}

/// How a subroutine is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(crate) enum Style {
    /// `o100 sub` to `o100 endsub`, called by `o100 call`.
    Words,
    /// `O100` to `M99`, called by `M98 P100`, as Fanuc's controls have it.
    Numbered,
}

impl Style {
    /// The beginning of a subroutine, as messages show it.
    pub(crate) fn text(self, label: &str) -> String {
        match self {
            Self::Words => format!("o{label} sub"),
            Self::Numbered => format!("O{label}"),
        }
    }
}

impl Outline {
    /// Reads all O-words of a file, from its beginning.
    ///
    /// # Errors
    /// The first O-word that is malformed, or without a beginning or an end.
    pub(crate) fn read<R: Read + Seek>(
        source: &mut Source<R>,
        name: &Arc<str>,
        skips_deletable: bool,
    ) -> Result<Self, GcodeError> {
        let mut building = Building::default();
        let mut line = Squeezed::default();
        let mut block = Block::default();
        let mut percents = 0;
        loop {
            let at = source.next_place();
            let fault =
                |column, kind| GcodeError { file: name.clone(), line: at.lines + 1, column, kind };
            if !source.advance().map_err(|kind| fault(0, kind))? {
                break;
            }
            if !may_matter(source.line()) || line.read(source.line()).is_err() {
                continue;
            }
            match grammar::kind(&line) {
                LineKind::Percent => {
                    percents += 1;
                    if percents == 2 {
                        break;
                    }
                }
                LineKind::Deletable if skips_deletable => {}
                _ if !is_control(&line.text) => {}
                _ => {
                    grammar::read(&line, &mut block)
                        .and_then(|()| building.add(&block, at, source.next_place()))
                        .map_err(|wrong| fault(wrong.column, wrong.kind))?;
                }
            }
        }
        building.finish(name)
    }

    /// The O-word of the line that begins here.
    pub(crate) fn node_at(&self, offset: u64) -> Option<usize> {
        self.nodes.binary_search_by_key(&offset, |node| node.at.offset).ok()
    }

    /// The beginning of a subroutine.
    pub(crate) fn sub(&self, style: Style, label: &str) -> Option<usize> {
        self.subs.get(&(style, label.into())).copied()
    }
}

/// Whether a line can be an O-word or `%`, judged by its first character. This is quick, and most
/// lines are neither.
fn may_matter(line: &[u8]) -> bool {
    let first = line.iter().find(|byte| !byte.is_ascii_whitespace());
    matches!(first, Some(b'o' | b'O' | b'n' | b'N' | b'/' | b'%' | b'('))
}

/// Whether a line without blanks is an O-word.
fn is_control(text: &[u8]) -> bool {
    let text = text.strip_prefix(b"/").unwrap_or(text);
    let number = match text.strip_prefix(b"n") {
        Some(rest) => rest.iter().position(|c| !c.is_ascii_digit() && *c != b'.').map(|at| at + 1),
        None => Some(0),
    };
    number.and_then(|at| text.get(at)) == Some(&b'o')
}
