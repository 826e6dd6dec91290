//! The shaper's promises on small examples; the proofs and the lock-step are elsewhere.

use super::*;
use crate::sim::{assert_synthesizes, rising_edge, settle};

fn shaper(width: u32, gap: u32, setup: u32, hold: u32) -> Shaper {
    let mut shaper = Shaper::new(&PinTiming { width, gap, setup, hold }).unwrap();
    shaper.connect_all();
    shaper
}

/// One clock, with a step requested forward (`>`), backward (`<`) or not (`.`); the pins in it.
fn clock(shaper: &mut Shaper, what: char) -> (bool, bool) {
    shaper.request.next = what != '.';
    shaper.request_back.next = what == '<';
    shaper.want_fwd.next = what == '>';
    shaper.want_back.next = what == '<';
    shaper.clock.next = false.into();
    settle(shaper);
    let pins = (shaper.step.val(), shaper.dir.val());
    shaper.clock.next = true.into();
    rising_edge(shaper);
    settle(shaper);
    pins
}

/// STEP and DIR over these requests, drawn.
fn draw(shaper: &mut Shaper, requests: &str) -> (String, String) {
    let level = |high| if high { '^' } else { '_' };
    requests.chars().map(|what| clock(shaper, what)).map(|(step, dir)| (level(step), level(dir))).unzip()
}

#[test]
fn width_and_gap() {
    let (step, dir) = draw(&mut shaper(3, 2, 1, 1), "...>.>.........");
    assert_eq!(step, "____^^^__^^^___");
    assert_eq!(dir, "_______________");
}

#[test]
fn set_up_holds_from_the_first_cycle() {
    let (step, _) = draw(&mut shaper(1, 1, 4, 1), ">........");
    assert_eq!(step, "____^____");
}

#[test]
fn a_reversal_keeps_hold_and_set_up() {
    let (step, dir) = draw(&mut shaper(2, 1, 3, 6), "...>.<..............");
    assert_eq!(step, "____^^_______^^_____");
    assert_eq!(dir, "__________^^^^^^^^^^");
}

#[test]
fn a_second_owed_step_is_an_overrun_and_is_counted() {
    let mut late = shaper(5, 5, 1, 1);
    draw(&mut late, ">.>");
    assert!(late.owed.val() && !late.overrun.val());
    draw(&mut late, ">");
    assert!(late.overrun.val());
    assert_eq!(late.discarded.val().value(), 1);
}

#[test]
fn a_freeze_lets_the_pulse_end_and_counts_what_is_lost() {
    let mut shaper = shaper(4, 2, 1, 1);
    draw(&mut shaper, ">.>");
    shaper.frozen.next = true;
    let (step, _) = draw(&mut shaper, ".>...........");
    assert_eq!(step, "^^___________");
    assert_eq!(shaper.discarded.val().value(), 2);
    assert_eq!(shaper.position.val().value(), 1);
}

#[test]
fn the_position_counts_both_ways() {
    let mut shaper = shaper(1, 1, 1, 1);
    draw(&mut shaper, ">..>..<...<...<...");
    assert_eq!(shaper.position.val(), Word::from(-1_i64));
}

#[test]
fn timings_are_checked() {
    let pins = PinTiming { gap: 0, ..PinTiming::SHORTEST };
    assert_eq!(Shaper::new(&pins).err(), Some(HdlError::PinTiming { name: "gap", clocks: 0 }));
    let pins = PinTiming { hold: MAX_CLOCKS + 1, ..PinTiming::SHORTEST };
    assert!(Shaper::new(&pins).is_err());
}

#[test]
fn shaper_synthesizes() {
    assert_synthesizes(shaper(5, 5, 1, 1), "carrystep_shaper");
}
