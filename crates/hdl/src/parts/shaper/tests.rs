//! Checks the shaper's timing on small examples. The proofs of the shaper and the comparison with
//! the model in every clock are in the workspace's `tests` folder.

use super::*;
use crate::sim::{assert_synthesizes, rising_edge, settle};

fn shaper(step_high: u32, step_low: u32, dir_setup: u32, dir_hold: u32) -> Shaper {
    let mut shaper = Shaper::new(&PinTiming { step_high, step_low, dir_setup, dir_hold }).unwrap();
    shaper.connect_all();
    shaper
}

/// Runs one clock with a step requested forward (`>`), backward (`<`) or not at all (`.`). Returns
/// STEP and DIR in that clock.
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

/// Runs one clock for each character of `requests`. Returns drawings of STEP and DIR.
fn draw(shaper: &mut Shaper, requests: &str) -> (String, String) {
    let level = |high| if high { '^' } else { '_' };
    requests
        .chars()
        .map(|what| clock(shaper, what))
        .map(|(step, dir)| (level(step), level(dir)))
        .unzip()
}

#[test]
fn shaper_keeps_the_step_high_and_the_gap() {
    let (step, dir) = draw(&mut shaper(3, 2, 1, 1), "...>.>.........");
    assert_eq!(step, "____^^^__^^^___");
    assert_eq!(dir, "_______________");
}

#[test]
fn shaper_keeps_the_set_up_time_from_the_first_cycle() {
    let (step, _) = draw(&mut shaper(1, 1, 4, 1), ">........");
    assert_eq!(step, "____^____");
}

#[test]
fn reversal_keeps_hold_and_set_up_times() {
    let (step, dir) = draw(&mut shaper(2, 1, 3, 6), "...>.<..............");
    assert_eq!(step, "____^^_______^^_____");
    assert_eq!(dir, "__________^^^^^^^^^^");
}

#[test]
fn second_step_held_back_is_an_overrun_and_counts_as_discarded() {
    let mut late = shaper(5, 5, 1, 1);
    draw(&mut late, ">.>");
    assert!(late.held_back.val() && !late.overrun.val());
    draw(&mut late, ">");
    assert!(late.overrun.val());
    assert_eq!(late.discarded.val().value(), 1);
}

#[test]
fn freeze_lets_the_pulse_end_and_counts_discarded_steps() {
    let mut shaper = shaper(4, 2, 1, 1);
    draw(&mut shaper, ">.>");
    shaper.frozen.next = true;
    let (step, _) = draw(&mut shaper, ".>...........");
    assert_eq!(step, "^^___________");
    assert_eq!(shaper.discarded.val().value(), 2);
    assert_eq!(shaper.position.val().value(), 1);
}

#[test]
fn position_counts_steps_in_both_directions() {
    let mut shaper = shaper(1, 1, 1, 1);
    draw(&mut shaper, ">..>..<...<...<...");
    assert_eq!(shaper.position.val(), Word::from(-1_i64));
}

#[test]
fn shaper_rejects_pin_timings_out_of_range() {
    let pins = PinTiming { step_low: 0, ..PinTiming::SHORTEST };
    assert_eq!(Shaper::new(&pins).err(), Some(HdlError::PinTiming { name: "step_low", clocks: 0 }));
    let pins = PinTiming { dir_hold: MAX_CLOCKS + 1, ..PinTiming::SHORTEST };
    assert!(Shaper::new(&pins).is_err());
}

#[test]
fn shaper_synthesizes() {
    assert_synthesizes(shaper(5, 5, 1, 1), "carrystep_shaper");
}
