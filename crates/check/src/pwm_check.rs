//! Compares the pin of the PWM with the duties that a plan sets.
//!
//! A counter goes from 0 to 4095, D clocks for each value, from configuration on, and nothing resets
//! it. The pin is high while the counter is below the duty; it follows both one clock later. A new
//! duty takes effect at once, wherever the counter is. ("Outputs" in docs/clock-by-clock.md.)
//!
//! ```text
//! counter  0 . . . . . . . 4095 0 . . . . . . . 4095 0
//! duty     ---- 1500 ------------------- 500 ---------
//! pin      ^^^^^^\______________^^^^^\_______________^^      the level that is expected
//! found    ^^^^^^^^\____________^^^^^\_______________^^
//! differs        ##                                          at most as long as the bound
//! ```
//!
//! The check compares levels and pairs no edges: a capture that misses a pulse shorter than its
//! sampling time is off for as long as this pulse, and fits again behind it. Memory holds the duties
//! that are due and have not taken effect.

use carrystep_core::Timebase;
use carrystep_core::engine::PWM_STEPS;
use schemars::JsonSchema;
use serde::Serialize;
use std::collections::VecDeque;
use std::fmt;

/// Rounding of times to ps, ps.
const ROUNDING_PS: u64 = 2000;
/// Most edges that wait until it is known where the plan begins and where the counter is 0.
const EARLY: usize = 1 << 18;
/// ps of a second.
const SECOND: i128 = 1_000_000_000_000;

/// The PWM of a build.
#[derive(Debug, Clone, Copy)]
pub struct PwmTiming {
    /// The clock.
    pub timebase: Timebase,
    /// Clocks of each value of the counter, from 1.
    pub divider: u32,
}

/// The check of the pin of the PWM.
#[derive(Debug, Clone, PartialEq, JsonSchema, Serialize)]
pub struct PwmReport {
    /// True if the pin has the level that the plan gives it at all times, within the bound.
    pub passed: bool,
    /// True if it was compared. False: where the counter is 0 does not show in the capture, because
    /// no duty lasts for a period.
    pub compared: bool,
    /// Number of duties that the plan sets.
    pub duties: u64,
    /// Number of edges of the pin.
    pub edges: u64,
    /// The longest time for which the pin has another level, ns.
    pub longest_ns: f64,
    /// How long that may be, ns.
    pub bound_ns: f64,
    /// How often it was longer.
    pub wrong: u64,
    /// The first time.
    pub first_wrong: Option<String>,
}

impl fmt::Display for PwmReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { duties, edges, longest_ns, bound_ns, wrong, first_wrong, .. } = self;
        if !self.compared {
            return writeln!(f, "not checked: the PWM; no duty lasts for a period of it");
        }
        writeln!(
            f,
            "PWM: {duties} duties, {edges} edges; another level for at most {longest_ns:.1} ns \
             (allowed {bound_ns:.1}); wrong: {wrong}"
        )?;
        first_wrong.iter().try_for_each(|first| writeln!(f, "  {first}"))
    }
}

/// Compares the pin with the duties. Duties are due, and edges come, in order of time; all duties
/// that are due up to an edge are told before it.
#[derive(Debug)]
pub(crate) struct PwmCheck {
    timing: PwmTiming,
    /// Where the plan begins, ps of the capture.
    base: Option<i128>,
    /// Where the counter's first clock is, ps of the capture.
    zero: Option<i128>,
    /// Duties and when they are due, ps from the start of the plan.
    due: VecDeque<(i128, u16)>,
    /// The expected level up to this clock of the counter, and what it follows from.
    at: i128,
    duty: u16,
    expected: bool,
    found: bool,
    /// Since when the two differ, ps of the capture.
    since: Option<i128>,
    /// The longest time, ps.
    longest: i128,
    bound: i128,
    /// When the present duty was due, ps of the capture, before it is known where the counter is 0.
    last: i128,
    /// Edges before the start of the plan was known, and whether there were too many.
    early: Vec<(u64, bool)>,
    lost: bool,
    duties: u64,
    edges: u64,
    wrong: u64,
    first_wrong: Option<String>,
}

impl PwmCheck {
    /// A check of a pin that is low. `zero` is the time at which the counter begins, `base` that at
    /// which the plan does, ps of the capture, as far as they are known. Times are uncertain by
    /// `slack_ps`.
    pub fn new(timing: PwmTiming, zero: Option<u64>, base: Option<i64>, slack_ps: u64) -> Self {
        let clock = SECOND as u64 / timing.timebase.clock_hz();
        let phase = timing.timebase.tick_ns() * 1000 / u64::from(timing.timebase.phases());
        // The start of a plan that is found from the pulses may be off by a phase.
        let unsure = if base.is_some() { 0 } else { phase };
        let bound = ROUNDING_PS + slack_ps + unsure + if zero.is_some() { 0 } else { clock };
        Self {
            timing,
            base: base.map(i128::from),
            zero: zero.map(i128::from),
            due: VecDeque::new(),
            at: 0,
            duty: 0,
            expected: false,
            found: false,
            since: None,
            longest: 0,
            bound: bound.into(),
            last: 0,
            early: Vec::new(),
            lost: false,
            duties: 0,
            edges: 0,
            wrong: 0,
            first_wrong: None,
        }
    }

    /// The plan sets a duty, ps from its start.
    pub fn due(&mut self, ps: i64, duty: u16) {
        self.due.push_back((ps.into(), duty));
        self.duties += 1;
    }

    /// The plan begins at this time of the capture.
    pub fn begin(&mut self, base: i64) {
        self.base.get_or_insert(base.into());
        for (ps, level) in std::mem::take(&mut self.early) {
            self.edge(ps.into(), level);
        }
    }

    /// The pin has this level from `ps` on.
    pub fn pin(&mut self, ps: u64, level: bool) {
        self.edges += 1;
        match self.base {
            Some(_) => self.edge(ps.into(), level),
            None if self.early.len() < EARLY => self.early.push((ps, level)),
            // What is beyond this is not compared.
            None => self.lost = true,
        }
    }

    fn edge(&mut self, ps: i128, level: bool) {
        if self.zero.is_none() {
            self.find_zero(ps, level);
        } else {
            self.reach(ps);
            self.compare(ps, self.expected, level);
        }
    }

    /// Where the counter is 0 shows in a rise of the pin behind a period with one duty. The
    /// comparison begins there.
    fn find_zero(&mut self, ps: i128, level: bool) {
        let base = self.base.unwrap_or(0);
        while let Some(&(due, duty)) = self.due.front().filter(|(due, _)| base + due <= ps) {
            (self.last, self.duty) = (base + due, duty);
            self.due.pop_front();
        }
        let next = self.due.front().map(|&(due, _)| base + due);
        let lasts = ps - self.last > self.ps_of(self.period()) + 2 * self.bound
            && next.is_none_or(|next| next > ps + self.bound);
        if level && self.duty > 0 && lasts {
            // The pin follows the counter one clock later.
            self.zero = Some(ps - self.ps_of(1));
            self.at = 1;
            (self.expected, self.found) = (true, true);
        }
    }

    /// Ends the check at `ps`.
    pub fn end(&mut self, ps: u64) -> PwmReport {
        // A pin that is never high, and never due to be, needs no counter.
        let idle = self.edges == 0 && self.due.iter().all(|&(_, duty)| duty == 0);
        let compared = (self.base.is_some() && self.zero.is_some() && !self.lost) || idle;
        if compared && !idle {
            let end = i128::from(ps);
            self.reach(end);
            if let Some(since) = self.since {
                self.differed(since, end);
            }
        }
        PwmReport {
            passed: self.wrong == 0,
            compared,
            duties: self.duties,
            edges: self.edges,
            longest_ns: self.longest as f64 / 1e3,
            bound_ns: self.bound as f64 / 1e3,
            wrong: self.wrong,
            first_wrong: self.first_wrong.clone(),
        }
    }

    fn period(&self) -> i128 {
        i128::from(PWM_STEPS) * i128::from(self.timing.divider)
    }

    fn hz(&self) -> i128 {
        self.timing.timebase.clock_hz().into()
    }

    /// The time of a clock of the counter from its first one on, ps.
    fn ps_of(&self, clock: i128) -> i128 {
        (clock * SECOND + self.hz() / 2).div_euclid(self.hz())
    }

    /// The clock of the counter that is nearest to a time of the capture.
    fn clock(&self, ps: i128) -> i128 {
        ((ps - self.zero.unwrap_or(0)) * self.hz() + SECOND / 2).div_euclid(SECOND)
    }

    /// The next edge that is expected behind the clock `at`, as long as the duty stays.
    fn next_edge(&self) -> Option<i128> {
        let period = self.period();
        let high = i128::from(self.duty) * i128::from(self.timing.divider);
        // The pin's level in a clock follows from the counter in the clock before.
        let place = self.at.rem_euclid(period);
        let next = self.at + 1;
        match (self.expected, place < high) {
            (true, false) | (false, true) => Some(next),
            (true, true) => Some(next + high - place),
            (false, false) => (high > 0).then_some(next + period - place),
        }
    }

    /// Follows the plan up to a time of the capture.
    fn reach(&mut self, ps: i128) {
        let (Some(base), Some(zero)) = (self.base, self.zero) else { return };
        loop {
            let edge = self.next_edge();
            let due = self.due.front().map(|&(due, duty)| (self.clock(base + due), duty));
            if let Some((clock, duty)) = due
                && edge.is_none_or(|edge| clock <= edge)
                && zero + self.ps_of(clock) <= ps
            {
                self.due.pop_front();
                (self.at, self.duty) = (self.at.max(clock - 1), duty);
            } else if let Some(edge) = edge.filter(|&edge| zero + self.ps_of(edge) <= ps) {
                self.at = edge;
                self.compare(zero + self.ps_of(edge), !self.expected, self.found);
            } else {
                return;
            }
        }
    }

    /// From `ps` on, the pin is expected to have one level and has the other.
    fn compare(&mut self, ps: i128, expected: bool, found: bool) {
        (self.expected, self.found) = (expected, found);
        if expected != found {
            self.since.get_or_insert(ps);
            return;
        }
        if let Some(since) = self.since.take() {
            self.differed(since, ps);
        }
    }

    /// The pin had the wrong level from one time to another.
    fn differed(&mut self, since: i128, ps: i128) {
        let lasted = ps - since;
        self.longest = self.longest.max(lasted);
        if lasted > self.bound {
            self.wrong += 1;
            self.first_wrong.get_or_insert_with(|| {
                let (at, ns) = (since as f64 / 1e12, lasted as f64 / 1e3);
                format!("at {at:.9} s the pin of the PWM has the wrong level for {ns:.1} ns")
            });
        }
    }
}

#[cfg(test)]
mod tests;
