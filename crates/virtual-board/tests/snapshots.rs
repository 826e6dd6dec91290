//! Snapshots of six moving axes over the line: P, positions, remaining ticks and queues are exactly
//! those of the closed form in the tick that the snapshot names, and no edge changes.

use crate::support::random::Random;
use crate::support::requests::Talk;
use crate::support::{CLOCK_HZ, Kind, TICK, build};
use carrystep_core::EngineBuild;
use carrystep_core::engine::{AxisStatus, commanded_steps};
use carrystep_core::link::Uart;
use carrystep_link::frame::of_axis;
use carrystep_link::registers::{
    SNAPSHOT, SNAPSHOT_DISCARDED, SNAPSHOT_LEFT, SNAPSHOT_P_HIGH, SNAPSHOT_P_LOW,
    SNAPSHOT_POSITION, SNAPSHOT_STATUS, SNAPSHOT_TICKS, START, TICKS,
};
use carrystep_model::fast::Edge;
use carrystep_virtual_board::{ModelBoard, VerilatedBoard};

const AXES: u8 = 6;

/// The value of P at which moves begin: half a step.
const START_P: i128 = 1 << 63;

/// A segment: ticks, and V, A, J in 2^-64 step per tick, tick^2, tick^3.
type Cubic = (u32, [i64; 3]);

/// Three segments for each axis, with speeds up to a tenth of a step per tick in both directions.
fn moves() -> Vec<Vec<Cubic>> {
    let mut random = Random::new(1891);
    let mut some = |most: i64| (random.below(2 * most as u64) as i64) - most;
    let mut segment = || {
        let ticks = (some(3000) + 5000) as u32;
        (ticks, [some(1 << 60), some(1 << 47), some(1 << 34)])
    };
    (0..AXES).map(|_| (0..3).map(|_| segment()).collect()).collect()
}

/// Distance after n ticks of a segment, in 2^-64 step (Newton's forward differences).
fn distance((_, [v, a, j]): Cubic, n: u32) -> i128 {
    let n = i128::from(n);
    n * i128::from(v) + n * (n - 1) / 2 * i128::from(a) + n * (n - 1) * (n - 2) / 6 * i128::from(j)
}

/// What a snapshot must show: the distance from the start in 2^-64 step, and of an axis that runs
/// the number of its segment and the ticks of it that follow the next one.
fn expected(segments: &[Cubic], since_start: u32) -> (i128, Option<(u8, u32)>) {
    let (mut travelled, mut n) = (0, since_start);
    for (number, segment) in (1..).zip(segments) {
        if n < segment.0 {
            return (travelled + distance(*segment, n), Some((number, segment.0 - 1 - n)));
        }
        travelled += distance(*segment, segment.0);
        n -= segment.0;
    }
    (travelled, None)
}

/// Queues all segments and starts the axes. Returns the number of the tick in which they execute
/// their first one.
fn start<B: Kind>(talk: &mut Talk<B>, moves: &[Vec<Cubic>]) -> u32 {
    for (axis, segments) in (0..).zip(moves) {
        for (number, &(ticks, cubic)) in segments.iter().enumerate() {
            let halves = cubic.map(|word| [word as u32, (word >> 32) as u32]).concat();
            let last = u32::from(number + 1 == segments.len());
            let words: Vec<u32> = [vec![ticks - 1], halves, vec![last]].concat();
            assert!(!talk.segment(axis, words.try_into().unwrap()).fault);
        }
    }
    assert!(!talk.write(START, (1 << AXES) - 1).fault);
    talk.rest(3 * TICK);
    let &[load] = talk.board.loads() else { panic!("one start") };
    assert!(load.is_multiple_of(TICK), "axes start where a tick begins");
    (load / TICK) as u32
}

/// Takes a snapshot, and compares all of it with the closed form. Returns its tick.
fn compare<B: Kind>(talk: &mut Talk<B>, moves: &[Vec<Cubic>], started: u32) -> u32 {
    let before = (talk.board.cycle() / TICK) as u32;
    let answer = talk.write(SNAPSHOT, 0);
    assert!(answer.written && !answer.fault && answer.refusal.is_none());
    let ticks = talk.read(SNAPSHOT_TICKS).data;
    assert!(ticks > before && ticks <= (talk.board.cycle() / TICK) as u32);
    for (axis, segments) in (0..).zip(moves) {
        let mut read = |register| talk.read(of_axis(register, axis)).data;
        assert_eq!(read(SNAPSHOT_TICKS), ticks, "axis {axis}");
        let p =
            i128::from(u64::from(read(SNAPSHOT_P_HIGH)) << 32 | u64::from(read(SNAPSHOT_P_LOW)));
        let status = AxisStatus::of_word(read(SNAPSHOT_STATUS));
        let commanded = commanded_steps(read(SNAPSHOT_POSITION).cast_signed(), status);
        let (travelled, running) = expected(segments, ticks - started);
        let found = (i128::from(commanded) << 64) + p - START_P;
        assert_eq!(found, travelled, "axis {axis}, tick {ticks}, started in tick {started}");
        let slots = status.running.then(|| (status.slot, read(SNAPSHOT_LEFT)));
        assert_eq!(slots, running, "axis {axis}, tick {ticks}");
        let waiting = running.map_or(0, |(number, _)| 3 - number);
        assert_eq!(status.waiting, waiting, "axis {axis}, tick {ticks}");
        if !status.running {
            assert_eq!((read(SNAPSHOT_DISCARDED), status.on_way.abs() <= 2), (0, true));
        }
    }
    ticks
}

/// Snapshots in random clocks of the motion, and one at rest. Returns the edges, with clocks
/// counted from the start.
fn exact<B: Kind>() -> Vec<Edge> {
    exact_of(Talk::<B>::powered())
}

fn exact_of<B: Kind>(mut talk: Talk<B>) -> Vec<Edge> {
    let moves = moves();
    let started = start(&mut talk, &moves);
    let mut random = Random::new(7);
    let ticks = |segments: &Vec<Cubic>| segments.iter().map(|(ticks, _)| ticks).sum::<u32>();
    let longest = moves.iter().map(ticks).max().unwrap();
    let mut snapshots = 0;
    while compare(&mut talk, &moves, started) < started + longest {
        talk.rest(random.below(20 * TICK));
        snapshots += 1;
    }
    assert!(snapshots > 5, "{snapshots} snapshots in motion");
    talk.rest(10 * TICK);
    compare(&mut talk, &moves, started);
    // The live words go on; those of the snapshot stay.
    let [live, kept] = [TICKS, SNAPSHOT_TICKS].map(|register| talk.read(register).data);
    assert!(live > kept);
    assert!(!talk.read(TICKS).fault && talk.read(TICKS).idle);
    talk.edges.since(u64::from(started) * TICK)
}

#[test]
fn snapshots_are_the_closed_form_on_a_board_of_models() {
    exact::<ModelBoard>();
}

#[test]
fn snapshots_are_the_closed_form_on_a_board_of_verilog() {
    assert_eq!(exact::<VerilatedBoard>(), exact::<ModelBoard>());
}

/// Each adder has a register mirror of its own in the link; the pulses are those of one adder.
#[test]
fn snapshots_and_pulses_on_several_adders_are_those_of_one() {
    let one = exact::<ModelBoard>();
    let uart = Uart::new(CLOCK_HZ, 3_000_000).unwrap();
    for adders in [2, 6] {
        let build = EngineBuild { adders, ..build() };
        let model = Talk::with(ModelBoard::new(&build, uart)).power();
        assert_eq!(exact_of(model), one, "{adders} adders, models");
        if adders == 6 {
            let verilog = Talk::with(VerilatedBoard::new(&build, uart).unwrap()).power();
            assert_eq!(exact_of(verilog), one, "{adders} adders, Verilog");
        }
    }
}

#[test]
fn snapshots_change_no_edge() {
    let mut talk = Talk::<ModelBoard>::powered();
    let started = start(&mut talk, &moves());
    while !talk.read(TICKS).idle {}
    talk.rest(TICK);
    assert_eq!(talk.edges.since(u64::from(started) * TICK), exact::<ModelBoard>());
}
