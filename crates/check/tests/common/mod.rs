//! A machine with known profiles, and the pulse train that an ideal generator makes of them.

use carrystep_check::*;
use carrystep_core::{PinTimes, Segment, StartPhase, Timebase};
use carrystep_profile::{Constant, Leg, ListEnd, Ramp, Source, Timeline};
use std::io::Cursor;
use std::sync::{Arc, Mutex};

pub const ORIGIN_PS: i64 = 123_456_789;
pub const NAMES: [&str; 6] = ["x", "y", "z", "a", "b", "c"];
pub const PINS_NS: PinTimes =
    PinTimes { step_high: 1000, step_low: 1000, dir_setup: 200, dir_hold: 200 };
pub const HIGH_PS: u64 = 1_041_667;

pub struct Machine {
    pub timebase: Timebase,
    pub timelines: Vec<Timeline>,
    pub total_ticks: u64,
}

impl Machine {
    /// A move out in 0.25 s and back in 0.25 s, with a distance of 1000 / (i + 1) steps for axis i.
    pub fn there_and_back(axes: usize) -> Self {
        let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
        let timeline = |index: usize| {
            let steps = 1000 / (index as u64 + 1);
            let leg = |start_tick, backward, profile| Leg {
                start_tick,
                backward,
                steps,
                profile,
                fit_seconds: 0.0,
            };
            let out = Ramp::triangle(steps as f64, 0.25, 0.0, steps as f64 * 64.0);
            // The least acceleration is four times the distance divided by the time squared. Half
            // as much again leaves time for a cruise.
            let acceleration = 6.0 * steps as f64 / 0.0625;
            let cruise = (0.0625 - 4.0 * steps as f64 / acceleration).sqrt();
            let top = 2.0 * steps as f64 / (0.25 + cruise);
            let back =
                Ramp::trapezoid(steps as f64, 0.25, 0.0, top, acceleration, top / acceleration);
            let flip = index % 2 == 1;
            let legs =
                vec![leg(0, flip, Arc::new(out) as _), leg(250_000, !flip, Arc::new(back) as _)];
            Timeline::new(timebase.tick_seconds(), legs)
        };
        Self { timebase, timelines: (0..axes).map(timeline).collect(), total_ticks: 500_000 }
    }

    /// One axis at constant speed: `steps` steps in one second.
    pub fn steady(steps: u64) -> Self {
        let timebase = Timebase::new(48_000_000, 1000, 16).unwrap();
        let profile = Arc::new(Constant::new(steps as f64, 1.0));
        let legs = vec![Leg { start_tick: 0, backward: false, steps, profile, fit_seconds: 0.0 }];
        let timelines = vec![Timeline::new(timebase.tick_seconds(), legs)];
        Self { timebase, timelines, total_ticks: 1_000_000 }
    }

    pub fn names(&self) -> &'static [&'static str] {
        &NAMES[..self.timelines.len()]
    }

    pub fn setup(&self, origin: Origin) -> Setup<'_> {
        let axes = self.timelines.iter().zip(NAMES).map(|(timeline, name)| AxisSetup {
            name,
            unit: None,
            timeline: timeline.clone(),
            pins_ns: PINS_NS,
            travel: timeline.legs().collect(),
        });
        let (timebase, phase, courses) = (self.timebase, StartPhase::Half, None);
        Setup { timebase, phase, axes: axes.collect(), courses, origin, slack_ps: 0 }
    }

    /// The train of an ideal generator, which rounds down to its phase grid: all axes, in order of
    /// time.
    pub fn train(&self) -> Vec<PinChange> {
        let mut all = Vec::new();
        for (index, timeline) in self.timelines.iter().enumerate() {
            let mut dir = false;
            let mut free = ORIGIN_PS as u64;
            for crossing in timeline.crossings(StartPhase::Half) {
                let tick_ps = self.timebase.tick_ns() * 1000;
                let grid = tick_ps / u64::from(self.timebase.phases());
                let local = (crossing.seconds * 1e12) as u64 / grid * grid;
                let ps = ORIGIN_PS as u64 + crossing.start_tick * tick_ps + local;
                let mut put =
                    |ps, pin, level| all.push(PinChange { ps, axis: index as u8, pin, level });
                if crossing.backward != dir {
                    dir = crossing.backward;
                    put(u64::midpoint(free, ps), Pin::Dir, dir);
                }
                put(ps, Pin::Step, true);
                put(ps + HIGH_PS, Pin::Step, false);
                free = ps + HIGH_PS;
            }
        }
        all.sort_by_key(|change| change.ps);
        all
    }

    pub fn check(&self, train: &[PinChange], origin: Origin) -> CheckReport {
        self.check_setup(train, self.setup(origin))
    }

    /// The same timelines, whose legs are made one by one when they are asked for.
    pub fn growing(&self) -> Vec<Timeline> {
        let ends: Vec<ListEnd<Leg>> = self.timelines.iter().map(|_| ListEnd::default()).collect();
        let mut legs: Vec<(usize, Leg)> = self
            .timelines
            .iter()
            .enumerate()
            .flat_map(|(axis, timeline)| timeline.legs().map(move |leg| (axis, leg)))
            .collect();
        legs.sort_by_key(|(_, leg)| leg.start_tick);
        legs.reverse();
        let source = Arc::new(OneByOne::default());
        let of = |end: &ListEnd<Leg>| {
            Timeline::new(self.timebase.tick_seconds(), end.reader(source.clone()))
        };
        let timelines = ends.iter().map(of).collect();
        *source.0.lock().unwrap() = Lists { left: legs, ends };
        timelines
    }

    /// Checks a train in this thread, and twice in threads beside it, which must find the same;
    /// also if the legs of the timelines are made while it is checked.
    pub fn check_setup<'a>(&'a self, train: &[PinChange], setup: Setup<'a>) -> CheckReport {
        let ((), one_by_one) = check_beside(setup.clone(), |sink| play(train, sink));
        let (sent, together) = check_beside(setup.clone(), |sink| sink.changes(train));
        sent.unwrap();
        let mut growing = setup.clone();
        let mut checker = Checker::new(setup);
        play(train, &mut checker);
        let report = checker.finish();
        assert_eq!(report, one_by_one);
        for (axis, timeline) in growing.axes.iter_mut().zip(self.growing()) {
            axis.timeline = timeline;
        }
        let ((), grown) = check_beside(growing, |sink| play(train, sink));
        assert_eq!(report, grown);
        assert_eq!(report, together);
        report
    }

    /// Arbitrary segments that fill the run. V follows from them and is independent of the profile.
    pub fn segments(&self) -> Vec<(u64, Segment)> {
        let piece = self.total_ticks / 5;
        let segment = |k: u64| Segment {
            ticks: piece as u32,
            v: (k as i64 - 2) << 50,
            a: -(1 << 30) * k as i64,
            j: (1 << 12) - (k as i64) * 3000,
            last: k == 4,
        };
        (0..5).map(|k| (k * piece, segment(k))).collect()
    }

    pub fn waves(&self) -> Waves<'_> {
        let axes = self.timelines.iter().zip(NAMES).map(|(timeline, name)| AxisWaves {
            name,
            timeline: timeline.clone(),
            segments: Box::new(self.segments().into_iter()),
        });
        Waves {
            timebase: self.timebase,
            phase: StartPhase::Half,
            origin_ps: ORIGIN_PS,
            total_ticks: self.total_ticks,
            axes: axes.collect(),
            view: View::default(),
        }
    }

    pub fn vcd(&self, train: &[PinChange]) -> Vec<u8> {
        let mut bytes = Vec::new();
        play(train, &mut *vcd_writer(&mut bytes, self.waves()));
        bytes
    }

    pub fn fst(&self, train: &[PinChange]) -> Vec<u8> {
        let mut file = Cursor::new(Vec::new());
        play(train, &mut *fst_writer(&mut file, self.waves()));
        file.into_inner()
    }

    pub fn plot_setup(&self) -> PlotSetup<'_> {
        let timelines = self.timelines.iter().cloned().zip(NAMES);
        let axes = timelines.map(|(timeline, name)| PlotAxis { name, timeline });
        PlotSetup {
            title: "There and back",
            timebase: self.timebase,
            phase: StartPhase::Half,
            origin_ps: ORIGIN_PS,
            total_ticks: self.total_ticks,
            axes: axes.collect(),
        }
    }
}

/// Makes one leg at a time.
#[derive(Default)]
struct OneByOne(Mutex<Lists>);

#[derive(Default)]
struct Lists {
    /// The legs that are left, each with its axis; the next one is the last.
    left: Vec<(usize, Leg)>,
    ends: Vec<ListEnd<Leg>>,
}

impl Source for OneByOne {
    fn grow(&self) {
        let Lists { left, ends } = &mut *self.0.lock().unwrap();
        match left.pop() {
            Some((axis, leg)) => ends[axis].push(leg),
            None => ends.iter().for_each(ListEnd::close),
        }
    }

    fn known_to(&self) -> u64 {
        let lists = self.0.lock().unwrap();
        lists.left.last().map_or(u64::MAX, |(_, leg)| leg.start_tick)
    }
}

pub const KNOWN: Origin = Origin::Known { ps: ORIGIN_PS };

pub fn play(train: &[PinChange], sink: &mut dyn PinSink) {
    for &change in train {
        sink.change(change).unwrap();
    }
    sink.end(train.last().map_or(0, |change| change.ps) + 1_000_000).unwrap();
}

/// The index in the train of the `k`-th rising edge of STEP of an axis, with k counted from 1.
pub fn rise(train: &[PinChange], axis: u8, k: usize) -> usize {
    let rises = |c: &PinChange| c.axis == axis && c.pin == Pin::Step && c.level;
    (0..train.len()).filter(|&at| rises(&train[at])).nth(k - 1).unwrap()
}

/// The index of the falling edge of STEP after a rising one.
pub fn fall(train: &[PinChange], rise: usize) -> usize {
    let axis = train[rise].axis;
    (rise..train.len())
        .find(|&at| train[at].axis == axis && train[at].pin == Pin::Step && !train[at].level)
        .unwrap()
}

/// The index of the `k`-th change of DIR of an axis, with k counted from 1.
pub fn dir_change(train: &[PinChange], axis: u8, k: usize) -> usize {
    (0..train.len())
        .filter(|&at| train[at].axis == axis && train[at].pin == Pin::Dir)
        .nth(k - 1)
        .unwrap()
}
