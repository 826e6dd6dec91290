//! Tests that the generated header and the player, compiled from C and run on a simulated timer,
//! emit the pulses of the formula.

use crate::repeats;
use crate::support::{Bench, Move, ideal_delays, judge, lengths, source};
use carrystep_table::{
    Arithmetic, Kind, Motor, Options, Pulses, Speed, Table, TableError, TableRequest, TimerMode,
};
use carrystep_table::{Timer, Width};
use proptest::prelude::*;

/// The greatest difference of one rounded delay from that of the formula, counts.
fn per_pulse(table: &Table) -> f64 {
    match table.request().kind {
        Kind::Avr446 { arithmetic: Arithmetic::Integer, .. } => 3.0,
        _ => 0.5,
    }
}

fn check(table: &Table, extra: &[u32]) {
    let mut lengths = lengths(table);
    lengths.extend(extra);
    let moves: Vec<Move> = lengths.iter().copied().map(Move::of).collect();
    let fastest = table.request().timer.counts(table.cruise());
    let bench = Bench::of(table);
    for latency in [0, (fastest - 1).min(7)] {
        for (steps, pulses) in lengths.iter().copied().zip(bench.play(latency, &moves)) {
            judge(table, steps, &pulses, per_pulse(table))
                .unwrap_or_else(|words| panic!("{words}"));
            let mut clock = 0;
            let exact: Vec<u64> = table
                .delays(steps)
                .map(|counts| {
                    clock += u64::from(counts);
                    clock
                })
                .collect();
            assert_eq!(pulses, exact, "{steps} steps");
        }
    }
}

#[test]
fn source_table_is_played_exactly_in_both_modes() {
    for mode in [TimerMode::Ctc, TimerMode::FreeRunning] {
        let table = Table::new(source(mode, 1000, Pulses::One)).unwrap();
        check(&table, &[40_000]);
        // Each delay is the rounded one, and not only close to it.
        let rounded: Vec<u32> =
            ideal_delays(&table, 2500).iter().map(|c| c.round() as u32).collect();
        assert!(table.delays(2500).eq(rounded));
    }
}

#[test]
fn tables_by_group_and_by_time_are_played_exactly() {
    let bands = vec![5, 5, 10, 10, 20, 20, 30, 30, 40, 40];
    for pulses in [Pulses::ByGroup(bands), Pulses::ByTime(1e-3)] {
        for mode in [TimerMode::Ctc, TimerMode::FreeRunning] {
            check(&Table::new(source(mode, 600, pulses.clone())).unwrap(), &[17, 4444]);
        }
    }
}

#[test]
fn player_reads_nothing_outside_its_table() {
    for pulses in [Pulses::One, Pulses::ByTime(1e-3), Pulses::ByGroup(vec![3, 1, 2])] {
        let table = Table::new(source(TimerMode::Ctc, 60, pulses)).unwrap();
        let moves: Vec<Move> = lengths(&table).into_iter().map(Move::of).collect();
        let bench = Bench::of(&table)
            .flag("-fsanitize=address,undefined")
            .flag("-fno-sanitize-recover=all");
        assert_eq!(bench.play(0, &moves), Bench::of(&table).play(0, &moves));
    }
}

#[test]
fn stop_follows_the_ramp_down() {
    let table = Table::new(source(TimerMode::Ctc, 100, Pulses::ByTime(1e-3))).unwrap();
    let ramp = u32::try_from(table.figures().ramp_pulses).unwrap();
    let stops = [1, 2, ramp / 2, ramp, ramp + 1, ramp + 50, 4 * ramp - 3, 4 * ramp];
    let moves: Vec<Move> =
        stops.iter().map(|&stop| Move { steps: 4 * ramp, stop: Some(stop) }).collect();
    for (stop, pulses) in stops.into_iter().zip(Bench::of(&table).play(0, &moves)) {
        // The delay before pulse `stop` was the last one on the way up. The delays below it follow
        // in reverse.
        let down = (stop - 1).min(ramp).min(4 * ramp - stop);
        let rising: Vec<u64> = pulses
            .iter()
            .take(stop as usize)
            .scan(0, |before, &now| Some(now - std::mem::replace(before, now)))
            .collect();
        let falling: Vec<u64> =
            pulses.windows(2).map(|p| p[1] - p[0]).skip(stop as usize - 1).collect();
        assert_eq!(falling.len() as u32, down, "stopped at pulse {stop}: {} pulses", pulses.len());
        let whole: Vec<u64> = table.delays(4 * ramp).map(u64::from).collect();
        assert_eq!(rising, whole[..stop as usize]);
        assert_eq!(falling, whole[whole.len() - falling.len()..]);
    }
}

#[test]
fn table_for_an_8_bit_timer_is_played_exactly() {
    for mode in [TimerMode::Ctc, TimerMode::FreeRunning] {
        let mut request = source(mode, 50, Pulses::One);
        request.timer = Timer { width: Width::Bits8, ..Timer::avr16(1_000_000, 8, mode) };
        request.start_frequency = 400.0;
        request.top_speed = Speed::StepsPerSecond(5000.0);
        let slow = Table::new(request.clone()).unwrap_err();
        assert!(matches!(slow, TableError::TooSlow { prescaler: Some(64), .. }), "{slow}");
        request.timer.prescaler = 64;
        check(&Table::new(request).unwrap(), &[]);
    }
}

#[test]
fn table_in_program_memory_is_read_with_pgm_read_word_only() {
    let table = Table::new(source(TimerMode::Ctc, 60, Pulses::ByTime(1e-3))).unwrap();
    let header = table.header(&Options::new("ramp").unwrap().program_memory(true));
    // Every word in "program memory" is scrambled, and only pgm_read_word restores it.
    let mut inside = false;
    let scrambled = header.lines().map(|line| {
        inside = (inside || line.contains("PROGMEM = {")) && !line.starts_with("};");
        let word = |piece: &str| match piece
            .trim()
            .trim_start_matches('{')
            .trim_end_matches("u}")
            .trim_end_matches('u')
            .parse::<u16>()
        {
            Ok(value) => piece.replace(&value.to_string(), &(value ^ 0x5A5A).to_string()),
            Err(_) => piece.to_owned(),
        };
        if inside {
            line.split(',').map(word).collect::<Vec<_>>().join(",")
        } else {
            line.to_owned()
        }
    });
    let scrambled: Vec<String> = scrambled.collect();
    assert_ne!(scrambled.join("\n") + "\n", header);
    let bench = Bench::new(&(scrambled.join("\n") + "\n")).flag("-DCARRYSTEP_PROGMEM");
    bench.write("avr/pgmspace.h", "#include <stdint.h>\n#define PROGMEM\nstatic inline uint16_t pgm_read_word(const uint16_t *word) { return (uint16_t)(*word ^ 0x5A5Au); }\n");
    for (steps, pulses) in
        [1, 50, 5000].into_iter().zip(bench.play(0, &[1, 50, 5000].map(Move::of)))
    {
        judge(&table, steps, &pulses, 0.5).unwrap_or_else(|words| panic!("{words}"));
    }
}

#[test]
fn compiler_refuses_a_header_for_another_clock_or_memory() {
    let table = Table::new(source(TimerMode::Ctc, 20, Pulses::One)).unwrap();
    let options = || Options::new("ramp").unwrap();
    let words = |bench: Bench| bench.compile(&["timer_bench.c", "carrystep_player.c"]).unwrap_err();
    assert!(
        words(Bench::of(&table).flag("-DF_CPU=8000000UL"))
            .contains("ramp was made for a clock of 16000000 Hz")
    );
    Bench::of(&table)
        .flag("-DF_CPU=16000000UL")
        .compile(&["timer_bench.c", "carrystep_player.c"])
        .unwrap();
    let flash = Bench::new(&table.header(&options().program_memory(true)));
    flash.write("avr/pgmspace.h", "#define PROGMEM\n");
    assert!(words(flash).contains("compile all files with -DCARRYSTEP_PROGMEM"));
    let plain = Bench::of(&table).flag("-DCARRYSTEP_PROGMEM");
    plain.write("avr/pgmspace.h", "#define pgm_read_word(word) (*(word))\n");
    assert!(words(plain).contains("compile all files without CARRYSTEP_PROGMEM"));
    // A declared length that is not the number of entries would leave a hole, which C fills with
    // zeros without a message. (Values that are missing from an array of the right length are not
    // noticed.)
    let header = table.header(&options());
    let holed = header.replace("ramp_compare[20]", "ramp_compare[21]");
    assert!(words(Bench::new(&holed)).contains("ramp_check_length"));
    // A header without the player needs no other file, in C and in C++.
    let bare = Bench::new(&table.header(&options().player(false)));
    bare.write(
        "bare.c",
        "#include \"ramp.h\"\nint main(void) { return ramp_compare[RAMP_ENTRIES - 1] == RAMP_CRUISE ? 0 : 1; }\n",
    );
    bare.compile(&["bare.c"]).unwrap();
}

fn requests() -> impl Strategy<Value = TableRequest> {
    let kind = (0..4, 1_u32..150, 0.5..12.0, 0.2..1.0, any::<bool>()).prop_map(
        |(kind, steps, steepness, centre, off)| match kind {
            0 => Kind::Logistic {
                entries: steps,
                steepness,
                centre: off.then_some(centre * f64::from(steps)),
            },
            1 => Kind::Avr446 { ramp_steps: steps, arithmetic: Arithmetic::Float },
            2 => Kind::Avr446 { ramp_steps: steps, arithmetic: Arithmetic::Integer },
            _ => Kind::Sine { ramp_steps: steps, inverse: None },
        },
    );
    let pulses = prop_oneof![
        Just(Pulses::One),
        prop::collection::vec(1_u32..6, 1..4).prop_map(Pulses::ByGroup),
        (1e-4..5e-3).prop_map(Pulses::ByTime),
    ];
    let start = prop_oneof![Just(0.0), 50.0..800.0];
    let timer = (
        prop::sample::select(vec![1_000_000, 8_000_000, 16_000_000, 20_000_000]),
        any::<bool>(),
        any::<bool>(),
    );
    (kind, pulses, start, 1.02..30.0, timer).prop_map(
        |(kind, pulses, start, ratio, (clock, ctc, small))| {
            let mut timer =
                Timer::avr16(clock, 8, if ctc { TimerMode::Ctc } else { TimerMode::FreeRunning });
            timer.width = if small { Width::Bits8 } else { Width::Bits16 };
            let top_speed = Speed::StepsPerSecond(f64::max(start, 60.0) * ratio);
            let motor = Motor { step_angle_deg: 1.8, microsteps: 1 };
            TableRequest { timer, motor, start_frequency: start, top_speed, kind, pulses }
        },
    )
}

/// The table of the request, after it was changed as the errors advise.
fn advised(mut request: TableRequest) -> Option<Table> {
    for _ in 0..4 {
        match Table::new(request.clone()) {
            Ok(table) => return Some(table),
            Err(
                TableError::TooSlow { prescaler: Some(p), .. }
                | TableError::TooFast { prescaler: Some(p), .. },
            ) => {
                assert_ne!(request.timer.prescaler, p, "advice that changes nothing: {request:?}");
                request.timer.prescaler = p;
            }
            Err(TableError::Groups { length, unit, .. }) => {
                let length = length.max(unit).next_multiple_of(unit);
                match &mut request.kind {
                    Kind::Logistic { entries, .. } => *entries = length,
                    Kind::Avr446 { ramp_steps, .. } | Kind::Sine { ramp_steps, .. } => {
                        *ramp_steps = length;
                    }
                }
            }
            Err(TableError::TooSlow { prescaler: None, .. }) => return None,
            Err(error) => panic!("{error}: {request:?}"),
        }
    }
    panic!("three pieces of advice were not enough: {request:?}");
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: repeats::part(60, 3),
        failure_persistence: None,
        ..ProptestConfig::default()
    })]

    #[test]
    fn any_table_is_played_exactly_at_any_length(request in requests(), extra in prop::collection::vec(0_u32..3000, 6)) {
        if let Some(table) = advised(request) {
            check(&table, &extra);
        }
    }
}
