//! Judges an axis when its capture has ended, and writes its report.
//!
//! Transcripts in tests/ quote the messages.

use super::AxisCheck;
use crate::ideal::{NS, moment, phase_ps};
use crate::line_check::Off;
use crate::pins::{Shortest, Stretch};
use crate::report::AxisReport;

impl AxisCheck<'_> {
    /// Judges the axis. All changes were taken with `origin_ps`; `shift_ps` is added to it now.
    pub(crate) fn finish(mut self, origin_ps: i64, shift_ps: i64, line: Option<Off>) -> AxisReport {
        if self.found.watch.step() {
            self.fail("STEP is still high when the capture ends");
        }
        self.miss_rest(origin_ps.saturating_add(shift_ps));
        let found = self.found.watch.pulses();
        if found != self.travel.pulses {
            self.fail(&format!("{found} pulses, {} expected", self.travel.pulses));
        }
        if self.found.position != self.travel.position {
            self.fail(&format!(
                "final position {}, {} expected",
                self.found.position, self.travel.position
            ));
        }
        let phase = phase_ps(&self.timebase);
        let (fit, bound) = (self.fit_ps, self.bound_ps());
        self.judge_errors(shift_ps as f64, bound);
        if let Some(Off { steps, bound, pulse }) = line.filter(|off| off.steps > off.bound) {
            self.fail(&format!(
                "{steps:.3} steps off its line after a pulse {pulse}, the bound is {bound:.3} steps"
            ));
        }
        let Shortest { step_high, step_low, dir_setup, dir_hold } = self.found.watch.shortest();
        let required = self.pins_ns;
        self.judge_pin("STEP high", step_high, required.step_high);
        self.judge_pin("STEP low", step_low, required.step_low);
        self.judge_pin("DIR set-up", dir_setup, required.dir_setup);
        self.judge_pin("DIR hold", dir_hold, required.dir_hold);
        let ns = |stretch: Option<Stretch>| stretch.map(|stretch| stretch.ps as f64 / NS);
        let errors = self.found.errors.shifted(-shift_ps);
        self.failures.append(&mut self.found.pulse_failures);
        AxisReport {
            axis: self.name.to_owned(),
            unit: self.unit.cloned(),
            passed: self.failures.is_empty(),
            pulses_expected: self.travel.pulses,
            pulses_found: found,
            position_expected: self.travel.position,
            position_found: self.found.position,
            pulses_wrong_direction: self.found.wrong_direction,
            error_min_ns: errors.min().map(|e| e.value / NS),
            error_max_ns: errors.max().map(|e| e.value / NS),
            error_rms_ns: errors.rms().map(|rms| rms / NS),
            error_std_ns: errors.deviation().map(|std| std / NS),
            error_std_theory_ns: phase / 12_f64.sqrt() / NS,
            error_fit_ns: fit / NS,
            error_bound_ns: bound / NS,
            step_high_min_ns: ns(step_high),
            step_high_required_ns: required.step_high as f64,
            step_low_min_ns: ns(step_low),
            step_low_required_ns: required.step_low as f64,
            dir_setup_min_ns: ns(dir_setup),
            dir_setup_required_ns: required.dir_setup as f64,
            dir_hold_min_ns: ns(dir_hold),
            dir_hold_required_ns: required.dir_hold as f64,
            period_jitter_max_ns: self.found.jitter_ps.map(|jitter| jitter / NS),
            period_jitter_theory_ns: (phase + 2.0 * self.found.curvature_ps) / NS,
            speed_ripple_max_percent: self.found.ripple.map(|ripple| 100.0 * ripple),
            speed_ripple_theory_percent: 100.0 * phase / self.found.shortest_ideal_ps,
            line_off_max_steps: line.map(|off| off.steps),
            line_off_bound_steps: line.map(|off| off.bound),
            failures: self.failures,
            failures_omitted: self.found.omitted,
        }
    }

    fn judge_errors(&mut self, shift: f64, bound: f64) {
        let worst = [(self.found.errors.min(), "early"), (self.found.errors.max(), "late")];
        for (extreme, word) in worst {
            let Some(extreme) = extreme else { continue };
            let error = extreme.value - shift;
            let beyond = if word == "early" { error < -bound } else { error > bound };
            if beyond {
                self.fail(&format!(
                    "pulse {} at {} is {:.1} ns {word}, the bound is {:.1} ns",
                    extreme.number,
                    moment(extreme.ps),
                    error.abs() / NS,
                    bound / NS
                ));
            }
        }
    }

    /// Fails if the shortest stretch of a pin's level is shorter than the driver requires, ns.
    fn judge_pin(&mut self, name: &str, shortest: Option<Stretch>, required: u64) {
        let Some(Stretch { ps, pulse, end }) = shortest else { return };
        if (ps as f64 + self.slack_ps) < required as f64 * NS {
            self.fail(&format!(
                "{name} of {:.1} ns at pulse {pulse} ({}), the driver needs {required} ns",
                ps as f64 / NS,
                moment(end)
            ));
        }
    }
}
