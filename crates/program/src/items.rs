//! Events as what the planner is given: moves, rests and marks.

use crate::event::{Event, ProgrammedMove, Reading};
use crate::letters::Letters;
use crate::switch::Switch;
use crate::sync::SyncPoint;
use carrystep_gcode::Point;
use carrystep_job::{Arc, Element, Item};

/// Time in s for which the tool rests where outputs change before a wait, so that a row has the
/// change.
const SWITCHING: f64 = 0.004;

/// What makes items of events.
#[derive(Debug, Clone)]
pub(crate) struct Items {
    /// The place where the last move that was read ends, exactly as programmed.
    pub end: Point,
    /// The places to wait at since the last motion, change of outputs or dwell.
    waits: Vec<SyncPoint>,
    /// Whether outputs have changed since then, so that no row has the change yet.
    is_marked: bool,
    letters: Letters,
}

impl Items {
    /// The items of a program that begins at this place.
    pub const fn new(letters: Letters, start: Point) -> Self {
        Self { end: start, waits: Vec::new(), is_marked: false, letters }
    }

    /// What the planner is given for an event. A place to wait at is only marked when something
    /// follows it.
    pub fn items(&mut self, event: &Event) -> Vec<Item> {
        let rest = |dwell: f64, line: u64| Item::Rest { dwell, line };
        let (first, then) = match *event {
            Event::Move(ref one) => {
                self.end = one.to;
                self.is_marked &= one.length() == 0.0;
                (None, Some(Item::Move(self.element(one))))
            }
            Event::Rest { seconds, line } if seconds > 0.0 => {
                self.is_marked = false;
                (None, Some(rest(seconds, line)))
            }
            Event::Rest { line, .. } => (Some(rest(0.0, line)), None),
            Event::Outputs { change, with_motion, line } => {
                let mark = Item::Mark(change.word().into());
                self.is_marked = true;
                (Some(rest(0.0, line)).filter(|_| !with_motion), Some(mark))
            }
            Event::Laser { power, .. } => (None, Some(Item::NearMark(power.mark()))),
            Event::Switch { switch, line } => {
                self.waits.extend(SyncPoint::of(switch, line));
                // What was switched before a wait is switched when the wait begins: the spindle
                // does not turn in a tool change.
                let stops = SyncPoint::of(switch, line).is_some();
                let dwell = if stops && self.is_marked { SWITCHING } else { 0.0 };
                self.is_marked &= dwell == 0.0;
                (Some(rest(dwell, line)), None)
            }
            Event::Reading { reading: Reading::Probe { .. }, line } => {
                // The probe move ends here, so that what follows is a stretch of its own.
                self.waits.push(SyncPoint { switch: Switch::Probe, line });
                (Some(rest(0.0, line)), None)
            }
            Event::Reading { reading: Reading::Input { .. }, .. } => (None, None),
            Event::End { line } => {
                // Something may follow an input that is not what the plan assumes.
                let reads = self.waits.iter().any(|wait| wait.switch == Switch::Input);
                (None, reads.then(|| rest(SWITCHING, line)))
            }
        };
        let mut items: Vec<Item> = first.into_iter().collect();
        if let Some(then) = then {
            items.extend(self.waits.drain(..).map(|point| Item::Mark(point.mark())));
            items.push(then);
        }
        items
    }

    fn element(&self, one: &ProgrammedMove) -> Element {
        let arc = one.arc.and_then(|arc| {
            let [first, second, _] = arc.plane.axes();
            let plane = [self.letters.number(first)?, self.letters.number(second)?];
            Some(Arc { plane, centre: arc.centre, angle: arc.sweep })
        });
        let to = self.letters.coordinates(&one.to);
        Element {
            to,
            arc,
            feed: one.feed,
            tolerance: one.tolerance,
            line: one.line,
            block: one.block,
        }
    }
}
