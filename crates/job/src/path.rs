//! The programmed path around the places that are being planned: a window of pieces.

use crate::piece::Piece;
use crate::vector::{Point, dot, from_to};
use std::collections::VecDeque;

/// A place on the programmed path.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd, Default)]
pub(crate) struct Place {
    /// The piece, counted from the first one.
    pub piece: u64,
    /// Length along it.
    pub along: f64,
}

/// The pieces from the oldest one that is still needed on.
#[derive(Debug)]
pub(crate) struct Path<const N: usize> {
    pieces: VecDeque<Piece<N>>,
    first: u64,
    /// The first `linear` letters are linear, the others rotary.
    pub linear: usize,
}

/// A corner at the end of a piece.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Corner {
    /// The piece before the corner.
    pub piece: u64,
    /// Where it is on the way between two places, as a part of that way.
    pub part: f64,
    /// The scalar product of the directions before and after it.
    pub turn: f64,
}

impl Corner {
    /// How far from the tip the curve may pass a corner, as a multiple of the tolerance. Where the
    /// distance from both sides is the tolerance, that from the tip is the tolerance divided by the
    /// sine of half the angle between the sides.
    pub fn reach(&self) -> f64 {
        let sine = ((1.0 + self.turn) / 2.0).max(0.0).sqrt();
        sine.recip().clamp(1.0, MOST_REACH)
    }
}

/// The greatest distance from the tip of an acute corner, as a multiple of the tolerance.
pub(crate) const MOST_REACH: f64 = 2.0;

/// Two directions are a corner if their scalar product is below this.
const STRAIGHT: f64 = 1.0 - 1e-9;

/// A place of the path, with its point.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Near<const N: usize> {
    pub place: Place,
    pub point: Point<N>,
}

impl<const N: usize> Path<N> {
    pub fn new(linear: usize) -> Self {
        Self { pieces: VecDeque::new(), first: 0, linear }
    }

    pub fn push(&mut self, piece: Piece<N>) {
        self.pieces.push_back(piece);
    }

    /// The number after that of the last piece.
    pub fn end(&self) -> u64 {
        self.first + self.pieces.len() as u64
    }

    /// Drops the pieces before this one.
    pub fn forget_before(&mut self, piece: u64) {
        while self.first < piece && self.pieces.len() > 1 {
            self.pieces.pop_front();
            self.first += 1;
        }
    }

    /// A piece of the window; numbers beyond it give its first or last piece.
    pub fn piece(&self, number: u64) -> Option<&Piece<N>> {
        let last = self.pieces.len().checked_sub(1)?;
        let index = usize::try_from(number.saturating_sub(self.first)).unwrap_or(last);
        self.pieces.get(index.min(last))
    }

    /// The square of the distance as a part of the tolerance: Euclidean over linear letters, and
    /// the greatest over rotary letters.
    pub fn off(&self, from: &Point<N>, to: &Point<N>, piece: &Piece<N>) -> f64 {
        let d = from_to(from, to);
        let linear: f64 = d[..self.linear].iter().map(|x| x * x).sum();
        let rotary = d[self.linear..].iter().map(|x| x * x).fold(0.0, f64::max);
        let part = |x: f64, tolerance: f64| if x > 0.0 { x / (tolerance * tolerance) } else { 0.0 };
        part(linear, piece.tolerance.linear).max(part(rotary, piece.tolerance.rotary))
    }

    /// The point at a place.
    pub fn at(&self, place: Place) -> Option<Near<N>> {
        Some(Near { place, point: self.piece(place.piece)?.at(place.along) })
    }

    /// The end of the piece before a corner.
    pub fn tip(&self, corner: &Corner) -> Option<Near<N>> {
        let piece = self.piece(corner.piece)?;
        let place = Place { piece: corner.piece, along: piece.length };
        Some(Near { place, point: piece.end })
    }

    /// The place of the path nearest to `point`, from `from` to the end of piece `last`.
    pub fn nearest(&self, point: &Point<N>, from: Place, to: Place) -> Option<Near<N>> {
        if from.piece >= self.first && from.piece == to.piece && to.piece < self.end() {
            // There is nothing to compare.
            let piece = self.piece(from.piece)?;
            let along = piece.nearest(point, from.along, to.along);
            let place = Place { piece: from.piece, along };
            return Some(Near { place, point: piece.at(along) });
        }
        let mut best: Option<(f64, Near<N>)> = None;
        for number in from.piece.max(self.first)..=to.piece.max(from.piece).min(self.end() - 1) {
            let piece = self.piece(number)?;
            let along = piece.nearest(
                point,
                if number == from.piece { from.along } else { 0.0 },
                if number == to.piece { to.along } else { f64::INFINITY },
            );
            let at = piece.at(along);
            let off = self.off(&at, point, piece);
            if best.as_ref().is_none_or(|(least, _)| off < *least) {
                best = Some((off, Near { place: Place { piece: number, along }, point: at }));
            }
        }
        best.map(|(_, near)| near)
    }

    /// The sharpest corner between two places; `None` if there is no corner.
    pub fn sharpest(&self, from: Place, to: Place) -> Option<Corner> {
        let (mut length, mut best) = (-from.along, None);
        let mut least = STRAIGHT;
        for number in from.piece..to.piece {
            let (a, b) = (self.piece(number)?, self.piece(number + 1)?);
            length += a.length;
            let turn = dot(&a.tangent(a.length), &b.tangent(0.0));
            if turn < least {
                least = turn;
                best = Some((number, length, turn));
            }
        }
        let (piece, at, turn) = best?;
        let part = at / (length + to.along);
        let part = if part.is_finite() { part.clamp(0.0, 1.0) } else { 0.5 };
        Some(Corner { piece, part, turn })
    }

    /// The place at a part of the way between two places.
    pub fn part(&self, from: Place, to: Place, part: f64) -> Option<Near<N>> {
        let mut length = -from.along;
        for number in from.piece..to.piece {
            length += self.piece(number)?.length;
        }
        let mut left = (length + to.along) * part + from.along;
        let mut number = from.piece;
        while number < to.piece && left > self.piece(number)?.length {
            left -= self.piece(number)?.length;
            number += 1;
        }
        let piece = self.piece(number)?;
        let along = left.clamp(0.0, piece.length);
        Some(Near { place: Place { piece: number, along }, point: piece.at(along) })
    }
}
