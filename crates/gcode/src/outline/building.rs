//! Joins the O-words of a file as they are read: beginnings, branches and ends of blocks.

use super::{Node, Outline, Style};
use crate::error::{ErrorKind, Fault, GcodeError};
use crate::source::Place;
use crate::syntax::{Block, Label, OWord};
use std::sync::Arc;

/// Greatest number of O-words in a file, which bounds the memory.
const MOST_O_WORDS: usize = 100_000;

/// Greatest depth of blocks in blocks.
const DEEPEST_BLOCK: usize = 100;

/// A block that is not closed yet.
struct Open {
    label: Box<str>,
    /// The O-word that opened it.
    first: usize,
    /// Its last branch: the same, or the last `elseif` or `else`.
    last: usize,
    line: u64,
}

/// An outline of which only the first lines are known.
#[derive(Default)]
pub(super) struct Building {
    outline: Outline,
    open: Vec<Open>,
}

impl Building {
    /// Adds the O-word of a line, if it has one.
    pub(super) fn add(&mut self, block: &Block, at: Place, after: Place) -> Result<(), Fault> {
        let Some(control) = &block.control else {
            return Ok(());
        };
        let word = control.word;
        let this = self.outline.nodes.len();
        let fault = |kind| Fault::new(control.column, kind);
        let label = match &control.label {
            Label::Fixed(label) => label.clone(),
            Label::Computed(_) if word == OWord::Call => "".into(),
            Label::Computed(_) => return Err(fault(ErrorKind::ComputedLabel(word.text()))),
        };
        if this >= MOST_O_WORDS {
            return Err(fault(ErrorKind::TooManyOWords(MOST_O_WORDS)));
        }
        if self.open.len() >= DEEPEST_BLOCK {
            return Err(fault(ErrorKind::BlocksTooDeep(DEEPEST_BLOCK)));
        }
        let node = Node { word, at, after, leads_to: this, end: this, ends_do: false };
        self.outline.nodes.push(node);
        let line = at.lines + 1;
        match word {
            OWord::Call => Ok(()),
            OWord::Sub => self.begin_sub(Style::Words, &label, this).map(|()| {
                self.open.push(Open { label, first: this, last: this, line });
            }),
            OWord::Program => self.begin_sub(Style::Numbered, &label, this),
            OWord::While if self.closes(&label, &[OWord::Do]) => {
                self.outline.nodes[this].ends_do = true;
                self.end(this);
                Ok(())
            }
            OWord::If | OWord::While | OWord::Do | OWord::Repeat => {
                self.open.push(Open { label, first: this, last: this, line });
                Ok(())
            }
            OWord::ElseIf | OWord::Else | OWord::EndIf => self.branch(&label, this),
            OWord::EndWhile => self.end_of(&label, this, OWord::While),
            OWord::EndRepeat => self.end_of(&label, this, OWord::Repeat),
            OWord::EndSub => self.end_of(&label, this, OWord::Sub),
            OWord::Break | OWord::Continue => {
                self.inside(&label, this, &[OWord::While, OWord::Do, OWord::Repeat])
            }
            // The label of `return` is that of the block around it, or any other: it ends the call.
            OWord::Return => self.inside_sub(&label, this),
        }
        .map_err(fault)
    }

    fn begin_sub(&mut self, style: Style, label: &str, this: usize) -> Result<(), ErrorKind> {
        if let Some(open) = self.open.last() {
            return Err(ErrorKind::SubInside(open.label.to_string()));
        }
        if let Some(first) = self.outline.subs.insert((style, label.into()), this) {
            let line = self.outline.nodes[first].at.lines + 1;
            return Err(ErrorKind::SubTwice { label: label.into(), line });
        }
        Ok(())
    }

    /// Whether the innermost open block has this label and begins with one of these words.
    fn closes(&self, label: &str, words: &[OWord]) -> bool {
        self.open.last().is_some_and(|open| self.fits(open, label, words))
    }

    fn fits(&self, open: &Open, label: &str, words: &[OWord]) -> bool {
        *open.label == *label && words.contains(&self.outline.nodes[open.first].word)
    }

    /// The error for a word that fits no open block.
    fn nothing_open(&self, label: &str, this: usize) -> ErrorKind {
        let open = match self.open.last() {
            None => "no block is open".to_owned(),
            Some(open) => {
                let word = self.outline.nodes[open.first].word.text();
                format!(
                    "the innermost open block is `o{} {word}` in line {}",
                    open.label, open.line
                )
            }
        };
        let word = self.outline.nodes[this].word.text();
        ErrorKind::NothingOpen { word, label: label.to_owned(), open }
    }

    fn branch(&mut self, label: &str, this: usize) -> Result<(), ErrorKind> {
        let nodes = &self.outline.nodes;
        let after_else = self.open.last().is_some_and(|open| nodes[open.last].word == OWord::Else);
        let is_end = nodes[this].word == OWord::EndIf;
        if !self.closes(label, &[OWord::If]) || after_else && !is_end {
            return Err(self.nothing_open(label, this));
        }
        let Some(open) = self.open.last_mut() else { return Ok(()) };
        self.outline.nodes[open.last].leads_to = this;
        open.last = this;
        if is_end && let Some(open) = self.open.pop() {
            let mut branch = open.first;
            while branch != this {
                self.outline.nodes[branch].end = this;
                branch = self.outline.nodes[branch].leads_to;
            }
        }
        Ok(())
    }

    fn end_of(&mut self, label: &str, this: usize, word: OWord) -> Result<(), ErrorKind> {
        if !self.closes(label, &[word]) {
            return Err(self.nothing_open(label, this));
        }
        self.end(this);
        Ok(())
    }

    /// Closes the innermost block: beginning and end lead to each other.
    fn end(&mut self, this: usize) {
        if let Some(open) = self.open.pop() {
            self.outline.nodes[open.first].leads_to = this;
            self.outline.nodes[this].leads_to = open.first;
        }
    }

    /// A word that leads to the beginning of an open block of its label.
    fn inside(&mut self, label: &str, this: usize, words: &[OWord]) -> Result<(), ErrorKind> {
        match self.open.iter().rev().find(|open| self.fits(open, label, words)) {
            Some(open) => {
                self.outline.nodes[this].leads_to = open.first;
                Ok(())
            }
            None => Err(self.nothing_open(label, this)),
        }
    }

    fn inside_sub(&mut self, label: &str, this: usize) -> Result<(), ErrorKind> {
        match self.open.first().filter(|open| self.outline.nodes[open.first].word == OWord::Sub) {
            Some(open) => {
                self.outline.nodes[this].leads_to = open.first;
                Ok(())
            }
            None => Err(self.nothing_open(label, this)),
        }
    }

    /// The outline, once all lines have been added.
    pub(super) fn finish(self, name: &Arc<str>) -> Result<Outline, GcodeError> {
        match self.open.last() {
            None => Ok(self.outline),
            Some(open) => {
                let word = self.outline.nodes[open.first].word.text();
                let kind = ErrorKind::NotClosed { word, label: open.label.to_string() };
                Err(GcodeError { file: name.clone(), line: open.line, column: 1, kind })
            }
        }
    }
}
