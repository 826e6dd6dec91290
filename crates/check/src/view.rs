//! The part of a run that a waveform shows.

/// A window in time, and the axes in it. The default is the whole run with all axes.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct View {
    from_ps: Option<u64>,
    to_ps: Option<u64>,
    /// The numbers of the axes; `None`: all of them.
    axes: Option<Vec<usize>>,
}

impl View {
    /// Shows the run from the first time to the second one only, ps of the capture; `None` is the
    /// beginning or the end of the run. The caller ensures that the first is before the second.
    #[must_use]
    pub fn between(mut self, from_ps: Option<u64>, to_ps: Option<u64>) -> Self {
        (self.from_ps, self.to_ps) = (from_ps, to_ps);
        self
    }

    /// Shows the axes with these numbers only.
    #[must_use]
    pub fn of_axes(mut self, axes: Vec<usize>) -> Self {
        self.axes = Some(axes);
        self
    }

    /// Whether the axis with this number is shown.
    pub fn shows(&self, axis: usize) -> bool {
        self.axes.as_ref().is_none_or(|axes| axes.contains(&axis))
    }

    /// The length of what is shown of a capture that ends at `end_ps`, ps.
    pub fn length_ps(&self, end_ps: u64) -> u64 {
        self.to_ps.unwrap_or(end_ps).min(end_ps).saturating_sub(self.from_ps.unwrap_or(0))
    }

    /// The first time that is shown, ps of the capture, unless it is the beginning of the run.
    pub(crate) fn first_ps(&self) -> Option<u64> {
        self.from_ps
    }

    /// The last time that is shown, ps of the capture, unless it is the end of the run.
    pub(crate) fn last_ps(&self) -> Option<u64> {
        self.to_ps
    }

    /// Where a time lies.
    pub(crate) fn place(&self, ps: u64) -> Place {
        match (self.from_ps, self.to_ps) {
            (Some(from), _) if ps < from => Place::Before,
            (_, Some(to)) if ps > to => Place::After,
            _ => Place::Within,
        }
    }
}

/// A time beside the window of a [`View`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Place {
    Before,
    Within,
    After,
}
