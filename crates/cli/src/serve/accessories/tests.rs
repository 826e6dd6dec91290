//! What is switched at rest, and what comes back.

use super::*;

const SPINDLE: u8 = 1;
const FLOOD: u8 = 2;

/// A machine with spindle, speed and flood, which are on.
fn running() -> Accessories {
    let uses = OutputUses {
        spindle: Some(0),
        flood: Some(1),
        spindle_rpm: Some(1000),
        ..OutputUses::default()
    };
    let mut this = Accessories { uses, ..Accessories::default() };
    this.sent(change(SPINDLE | FLOOD, SPINDLE | FLOOD, Some(700)));
    this
}

fn change(mask: u8, levels: u8, duty: Option<u16>) -> OutputChange {
    OutputChange { mask, levels, duty }
}

/// What is switched at rest, and the wait behind it.
fn switched(of: &mut Accessories, holds: bool, door: bool) -> Option<(OutputChange, f64)> {
    let due = of.due(holds, door)?;
    of.sent(due.change);
    Some((due.change, due.dwell))
}

#[test]
fn spindle_gets_back_its_speed_and_resume_waits_for_it() {
    let mut all = running();
    let (off, on) = (change(SPINDLE, 0, Some(0)), change(SPINDLE, SPINDLE, Some(700)));
    all.toggle_spindle();
    assert_eq!(switched(&mut all, true, false), Some((off, 0.0)));
    assert_eq!((all.turns(), switched(&mut all, true, false)), (None, None));
    all.toggle_spindle();
    assert_eq!(switched(&mut all, true, false), Some((on, 0.0)));
    all.toggle_spindle();
    switched(&mut all, true, false);
    assert_eq!(switched(&mut all, false, false), Some((on, SPINDLE_DWELL)));
    assert_eq!((all.turns(), switched(&mut all, false, false)), (Some(false), None));
}

#[test]
fn door_takes_over_a_stopped_spindle_and_gives_back_all() {
    let mut all = running();
    all.toggle_spindle();
    switched(&mut all, true, false);
    let off = change(SPINDLE | FLOOD, 0, Some(0));
    assert_eq!(switched(&mut all, true, true), Some((off, 0.0)));
    assert!(all.is_parked());
    assert_eq!(switched(&mut all, true, true), None);
    let on = change(SPINDLE | FLOOD, SPINDLE | FLOOD, Some(700));
    assert_eq!(switched(&mut all, false, false), Some((on, SPINDLE_DWELL)));
    assert!(!all.is_parked());
    // Without a spindle that turns, nothing has to wait.
    all.sent(change(SPINDLE, 0, Some(0)));
    switched(&mut all, true, true);
    let on = change(SPINDLE | FLOOD, FLOOD, Some(0));
    assert_eq!(switched(&mut all, false, false), Some((on, 0.0)));
}

#[test]
fn reset_and_alarm_give_nothing_back() {
    let mut all = running();
    switched(&mut all, true, true);
    all.forget();
    assert_eq!(switched(&mut all, false, false), None);
    all.toggle(Coolant::Flood);
    all.reset();
    assert_eq!(switched(&mut all, false, false), Some((change(3, 0, Some(0)), 0.0)));
    assert_eq!(switched(&mut all, false, false), None);
    assert_eq!((all.is_on(Coolant::Flood), all.is_on(Coolant::Mist)), (Some(false), None));
}

#[test]
fn stretch_that_goes_on_behind_a_hold_keeps_what_was_switched_at_rest() {
    let mut all = running();
    all.sent(change(FLOOD, 0, None));
    all.begins();
    all.of_stretch(change(SPINDLE | FLOOD, FLOOD, Some(0)));
    all.toggle(Coolant::Flood);
    let left = all.take_coolant();
    all.give_back(left);
    assert_eq!(switched(&mut all, true, false), Some((change(FLOOD, 0, None), 0.0)));
    all.begins();
    all.of_stretch(change(SPINDLE, SPINDLE, Some(9)));
    assert_eq!((all.turns(), all.is_on(Coolant::Flood)), (Some(false), Some(false)));
}
