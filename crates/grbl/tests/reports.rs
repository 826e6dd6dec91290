//! Status reports: their form, and which field comes when.

use carrystep_grbl::{
    Accessories, Dialect, MachineSettings, OverrideStep, Overrides, Pins, Seen, Settings, State,
};
use proptest::prelude::*;

fn dialect() -> Dialect {
    Dialect::new(Settings::new(MachineSettings::default()), 1000)
}

fn seen(state: State) -> Seen {
    Seen {
        state,
        machine: vec![1.0, -10.0, 25.4],
        offset: vec![0.0, 1.5, 0.0],
        blocks: 1000,
        bytes: 1024,
        ..Seen::default()
    }
}

#[test]
fn report_has_the_form_of_the_documentation() {
    let mut dialect = dialect();
    let first = dialect.report(&seen(State::Idle));
    let want = "<Idle|MPos:1.000,-10.000,25.400|Bf:1000,1024|FS:0,0|WCO:0.000,1.500,0.000>\r\n";
    assert_eq!(first, want);
    let full = Seen {
        line: Some(42),
        feed: 1500.2,
        rpm: 8000.0,
        pins: Pins { limits: 0b101, probe: true, door: true, reset: true },
        accessories: Accessories { spindle: Some(true), flood: true, mist: true },
        ..seen(State::Hold { rests: false })
    };
    let want = "<Hold:1|MPos:1.000,-10.000,25.400|Bf:1000,1024|Ln:42|FS:1500,8000|Pn:XZPDR|\
                Ov:100,100,100|A:CFM>\r\n";
    assert_eq!(dialect.report(&full), want);
    (dialect.settings.report, dialect.settings.inches) = (0, true);
    let want = "<Run|WPos:0.0394,-0.4528,1.0000|FS:59.1,8000>\r\n";
    let line = Seen { line: Some(0), pins: Pins::default(), ..full };
    assert_eq!(dialect.report(&Seen { state: State::Run, ..line }), want);
}

/// The numbers of the reports, from 1, that have this field.
fn with(field: &str, state: State, count: usize) -> Vec<usize> {
    let mut dialect = dialect();
    let reports = (1..=count).map(|number| (number, dialect.report(&seen(state))));
    reports.filter(|(_, text)| text.contains(field)).map(|(number, _)| number).collect()
}

#[test]
fn offset_and_overrides_come_now_and_then_and_never_together() {
    assert_eq!(with("|WCO:", State::Idle, 31), [1, 11, 21, 31]);
    assert_eq!(with("|WCO:", State::Run, 62), [1, 31, 61]);
    let [offsets, overrides] = ["|WCO:", "|Ov:"].map(|field| with(field, State::Run, 100));
    assert_eq!(overrides.first(), Some(&2));
    assert!(overrides.windows(2).all(|two| two[1] - two[0] <= 21), "{overrides:?}");
    assert!(overrides.iter().all(|number| !offsets.contains(number)));
}

#[test]
fn change_comes_with_the_next_report() {
    let mut dialect = dialect();
    for _ in 0..3 {
        dialect.report(&seen(State::Idle));
    }
    let moved = Seen { offset: vec![0.0, 2.0, 0.0], ..seen(State::Idle) };
    assert!(dialect.report(&moved).contains("|WCO:0.000,2.000,0.000>"));
    let faster = Seen { overrides: Overrides::NONE.after(OverrideStep::Feed(10)), ..moved.clone() };
    assert!(dialect.report(&faster).contains("|Ov:110,100,100>"));
    assert!(!dialect.report(&faster).contains("|Ov:"));
    // Both at once: the offset first.
    let both = seen(State::Idle);
    assert!(dialect.report(&both).contains("|WCO:"));
    assert!(dialect.report(&both).contains("|Ov:100,100,100"));
    dialect.reporter.restart();
    assert!(dialect.report(&both).contains("|WCO:"));
}

proptest! {
    #[test]
    fn overrides_stay_within_their_ranges(
        steps in prop::collection::vec((0_u8..5, -10_i8..=10), 0..100),
    ) {
        let mut now = Overrides::NONE;
        for (kind, by) in steps {
            now = now.after(match kind {
                0 => OverrideStep::Feed(by),
                1 => OverrideStep::Spindle(by),
                2 => OverrideStep::RapidHalf,
                3 => OverrideStep::RapidQuarter,
                _ => OverrideStep::RapidFull,
            });
            prop_assert!((10..=200).contains(&now.feed) && (10..=200).contains(&now.spindle));
            prop_assert!([100, 50, 25].contains(&now.rapid));
        }
        let reset = now.after(OverrideStep::FeedReset).after(OverrideStep::SpindleReset);
        prop_assert_eq!(reset.after(OverrideStep::RapidFull), Overrides::NONE);
    }

    #[test]
    fn report_is_one_line_in_angle_brackets(
        places in prop::collection::vec(-1e9_f64..1e9, 6),
        feed in 0.0_f64..1e6,
    ) {
        let mut dialect = dialect();
        let text = dialect.report(&Seen { machine: places.clone(), offset: places, feed, ..Seen::default() });
        prop_assert!(text.starts_with('<') && text.ends_with(">\r\n"));
        prop_assert_eq!(text.matches(['<', '>', '\n']).count(), 3);
    }
}
