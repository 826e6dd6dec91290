//! Tests that the simulated timer finds planted bugs: each wrong line in the player must fail the
//! checks that the right player passes.

use crate::support::{Bench, Move, judge, lengths, source};
use carrystep_table::{Options, PLAYER, Pulses, Table, TimerMode};

/// Name of the bug, the right text (which occurs once in carrystep_player.c), and the wrong text.
const BUGS: [(&str, &str, &str); 12] = [
    ("first entry skipped", "player->entry = 0;", "player->entry = 1;"),
    (
        "short move overruns its middle",
        "player->left - 1 > player->at",
        "player->left > player->at",
    ),
    ("way down begins late", "player->left <= player->at)", "player->left < player->at)"),
    (
        "ramp walks past its end",
        "player->at < player->table->ramp",
        "player->at <= player->table->ramp",
    ),
    ("cruises at the first entry", "? table->cruise :", "? table->compare[0] :"),
    ("one pulse too many", "player->left <= 1", "player->left == 0"),
    ("one pulse too few", "player->left <= 1", "player->left <= 2"),
    ("entries last a pulse longer on the way up", "player->pulse == READ", "player->pulse > READ"),
    ("groups are not followed on the way up", "player->group++;", ""),
    ("groups are not followed on the way down", "player->group--;", ""),
    (
        "way down is counted, not mirrored",
        "player->pulse = READ(groups[player->group].pulses);",
        "player->pulse = 1;",
    ),
    (
        "group boundary off by one",
        "player->entry == READ(groups",
        "player->entry + 1 == READ(groups",
    ),
];

fn table(mode: TimerMode) -> Table {
    Table::new(source(mode, 60, Pulses::ByTime(1e-3))).expect("a table")
}

fn verdict(table: &Table, bench: &Bench) -> Result<(), String> {
    let lengths = lengths(table);
    let moves: Vec<Move> = lengths.iter().copied().map(Move::of).collect();
    bench.compile(&["timer_bench.c", "carrystep_player.c"]).expect("a bug that compiles");
    let played = bench.try_play(0, &moves)?;
    lengths
        .into_iter()
        .zip(played)
        .try_for_each(|(steps, pulses)| judge(table, steps, &pulses, 0.5))
}

#[test]
fn bugs_in_the_player_are_caught() {
    let table = table(TimerMode::Ctc);
    assert_eq!(verdict(&table, &Bench::of(&table)), Ok(()));
    let (file, text) = PLAYER[1];
    for (bug, right, wrong) in BUGS {
        assert_eq!(text.matches(right).count(), 1, "{bug}: {right}");
        let bench = Bench::of(&table);
        bench.write(file, &text.replace(right, wrong));
        let caught = verdict(&table, &bench);
        println!("{bug}: {caught:?}");
        assert!(caught.is_err(), "{bug} is not caught");
    }
}

#[test]
fn table_for_the_other_timer_mode_is_caught() {
    for (mode, other) in
        [(TimerMode::Ctc, TimerMode::FreeRunning), (TimerMode::FreeRunning, TimerMode::Ctc)]
    {
        // A table for one mode on a timer in the other mode: every delay is off by one.
        let (right, wrong) = (table(mode), table(other));
        let header = wrong.header(&Options::new("ramp").unwrap());
        let ctc = |yes: bool| format!("#define RAMP_CTC {}\n", i32::from(yes));
        let header = header.replace(&ctc(other == TimerMode::Ctc), &ctc(mode == TimerMode::Ctc));
        let caught = verdict(&right, &Bench::new(&header));
        assert!(caught.is_err(), "{other:?} values on a {mode:?} timer");
    }
}
