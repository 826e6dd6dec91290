//! The answers to lines: one for each, whatever it is, in each state.

use carrystep_grbl::{
    Action, Alarm, AxisSettings, Dialect, Door, ErrorCode, MachineSettings, Outcome, Parameters,
    ParserState, Request, Restore, Restored, Settings, State,
};
use proptest::prelude::*;

const STATES: [State; 11] = [
    State::Idle,
    State::Run,
    State::Hold { rests: true },
    State::Hold { rests: false },
    State::Jog,
    State::Alarm,
    State::Door(Door::IsClosed),
    State::Door(Door::Stops),
    State::Check,
    State::Home,
    State::Sleep,
];

fn dialect() -> Dialect {
    let axis = |letter: usize, name: &str| AxisSettings {
        letter,
        name: name.to_owned(),
        steps_per_unit: 160.0,
        rate: 6000.0,
        acceleration: 500.0,
        travel: 300.0,
    };
    let axes = vec![axis(0, "x"), axis(1, "y"), axis(2, "z")];
    let machine = MachineSettings { axes, tolerance: 0.01, ..MachineSettings::default() };
    Dialect::new(Settings::new(machine), 1000)
}

fn modes() -> ParserState {
    ParserState {
        motion: "G1".to_owned(),
        system: "G55".to_owned(),
        plane: 18,
        inches: false,
        incremental: true,
        inverse_time: false,
        spindle: 3,
        mist: false,
        flood: true,
        tool: 2,
        feed: 500.4,
        rpm: 12_000.0,
    }
}

fn said(dialect: &mut Dialect, line: &str, state: State) -> String {
    match dialect.line(line, state, Parameters::default, modes) {
        Outcome::Answered(text) => text,
        Outcome::Do(action) => panic!("{line}: {action:?}"),
    }
}

fn done<'a>(dialect: &mut Dialect, line: &'a str, state: State) -> Action<'a> {
    match dialect.line(line, state, Parameters::default, modes) {
        Outcome::Answered(text) => panic!("{line}: {text}"),
        Outcome::Do(action) => action,
    }
}

#[test]
fn settings_are_shown_and_those_of_the_machine_are_refused_by_name() {
    let mut dialect = dialect();
    let text = said(&mut dialect, "$$", State::Idle);
    for line in
        ["$10=3\r\n", "$100=160.000\r\n", "$112=6000.000\r\n", "$132=300.000\r\n", "$32=0\r\n"]
    {
        assert!(text.contains(line), "{line} in {text}");
    }
    assert!(text.ends_with("\r\nok\r\n"));
    let refused = said(&mut dialect, "$110=9000", State::Idle);
    assert_eq!(refused, "[MSG:$110 is given by speed of axis x]\r\nerror:3\r\n");
    // What was read may be written back.
    assert_eq!(said(&mut dialect, "$110=6000.000", State::Idle), "ok\r\n");
    assert_eq!(said(&mut dialect, "$10=0", State::Idle), "ok\r\n");
    assert_eq!(said(&mut dialect, "$13=1", State::Idle), "ok\r\n");
    assert_eq!((dialect.settings.report, dialect.settings.inches), (0, true));
    assert_eq!(said(&mut dialect, "$10=256", State::Idle).lines().last(), Some("error:3"));
    for (line, code) in [("$99=1", 3), ("$10=-1", 4), ("$10=x", 2), ("$10=1e1", 2), ("$Q", 3)] {
        assert_eq!(said(&mut dialect, line, State::Idle), format!("error:{code}\r\n"), "{line}");
    }
    let restored = done(&mut dialect, "$RST=$", State::Alarm);
    assert_eq!(restored, Action::Restore(Restored { parameters: false }));
    assert_eq!((dialect.settings.report, dialect.settings.inches), (3, false));
}

#[test]
fn queries_have_the_form_of_the_documentation() {
    let mut dialect = dialect();
    let state = said(&mut dialect, "$G", State::Run);
    assert_eq!(state, "[GC:G1 G55 G18 G21 G91 G94 M3 M8 T2 F500 S12000]\r\nok\r\n");
    let parameters = Parameters {
        systems: std::array::from_fn(|number| vec![number as f64, -0.0004, 2.5]),
        ..Parameters::default()
    };
    let text = parameters.text(false);
    assert!(text.starts_with("[G54:0.000,0.000,2.500]\r\n[G55:1.000,0.000,2.500]\r\n"), "{text}");
    assert!(text.ends_with("[TLO:0.000]\r\n[PRB::0]\r\n"), "{text}");
    assert!(parameters.text(true).contains("[G59:0.1969,0.0000,0.0984]"));
    let build = said(&mut dialect, "$I", State::Idle);
    assert!(build.starts_with("[VER:1.1h.") && build.contains("[OPT:VNM,1000,1024]"), "{build}");
    assert!(said(&mut dialect, "$", State::Run).starts_with("[HLP:$$ $# $G $I $N "));
    assert_eq!(said(&mut dialect, "$N", State::Idle), "$N0=\r\n$N1=\r\nok\r\n");
    assert_eq!(said(&mut dialect, "$N0=", State::Idle), "ok\r\n");
    assert!(said(&mut dialect, "$N0=G20", State::Idle).ends_with("error:3\r\n"));
    assert_eq!(said(&mut dialect, "", State::Alarm), "ok\r\n");
}

#[test]
fn what_needs_the_machine_is_left_to_its_owner() {
    let mut dialect = dialect();
    for (line, action) in [
        ("G0X1", Action::Gcode("G0X1")),
        ("$J=G91X1F100", Action::Jog("G91X1F100")),
        ("$H", Action::Home(None)),
        ("$HZ", Action::Home(Some('Z'))),
        ("$X", Action::Unlock),
        ("$C", Action::Check),
        ("$SLP", Action::Sleep),
        ("$RST=#", Action::Restore(Restored { parameters: true })),
        ("$RST=*", Action::Restore(Restored { parameters: true })),
    ] {
        assert_eq!(done(&mut dialect, line, State::Idle), action, "{line}");
    }
    assert_eq!(said(&mut dialect, "$J=", State::Idle), "error:16\r\n");
    assert_eq!(said(&mut dialect, "$JX1", State::Idle), "error:16\r\n");
}

/// The states in which each kind of line is allowed, and what is answered in the others.
#[test]
fn each_state_locks_what_grbl_locks() {
    let all = &STATES[..];
    let moving = [State::Run, State::Hold { rests: true }, State::Home];
    let table: [(Request<'_>, ErrorCode, &[State]); 6] = [
        (Request::Gcode("G0"), ErrorCode::Locked, &[State::Alarm, State::Jog, State::Sleep]),
        (Request::Settings, ErrorCode::NotIdle, &moving),
        (Request::Jog("X1F1"), ErrorCode::NotIdle, &[State::Run, State::Alarm, State::Check]),
        (Request::Home(None), ErrorCode::NotIdle, &[State::Run, State::Jog, State::Check]),
        (Request::Parameters, ErrorCode::NotIdle, &[State::Run, State::Jog, State::Sleep]),
        (Request::Restore(Restore::All), ErrorCode::NotIdle, &moving),
    ];
    for (request, code, refused) in table {
        for &state in refused {
            assert_eq!(request.is_allowed(state), Err(code), "{request:?} {state}");
        }
        assert_eq!(request.is_allowed(State::Idle), Ok(()), "{request:?}");
    }
    for state in all {
        assert_eq!(Request::Unlock.is_allowed(*state), Ok(()));
        assert_eq!(Request::ParserState.is_allowed(*state), Ok(()));
    }
    assert_eq!(Request::Home(None).is_allowed(State::Alarm), Ok(()));
    assert_eq!(Request::Jog("X1F1").is_allowed(State::Jog), Ok(()));
}

#[test]
fn numbers_are_those_of_the_documentation() {
    let errors = [
        (ErrorCode::ExpectedLetter, 1),
        (ErrorCode::NotIdle, 8),
        (ErrorCode::Locked, 9),
        (ErrorCode::Overflow, 11),
        (ErrorCode::Travel, 15),
        (ErrorCode::BadJog, 16),
        (ErrorCode::UnknownCode, 20),
        (ErrorCode::NoFeed, 22),
        (ErrorCode::BadTarget, 33),
        (ErrorCode::UnusedWords, 36),
    ];
    for (code, number) in errors {
        assert_eq!(Dialect::error(code), format!("error:{number}\r\n"));
    }
    let alarms = [(Alarm::HardLimit, 1), (Alarm::SoftLimit, 2), (Alarm::HomingSearch, 9)];
    for (alarm, number) in alarms {
        assert_eq!(Dialect::alarm(alarm), format!("ALARM:{number}\r\n"));
    }
}

proptest! {
    #[test]
    fn each_line_has_one_answer(
        line in prop_oneof!["[!-~]{0,40}", "[$][A-Z0-9$#=.*-]{0,12}", "[$]J=[GXYZF0-9.]{0,20}"],
        state in prop::sample::select(&STATES[..]),
    ) {
        let mut dialect = dialect();
        if let Outcome::Answered(text) = dialect.line(&line, state, Parameters::default, modes) {
            prop_assert!(text.ends_with("\r\n"), "{}", text);
            let is_end = |line: &str| line == "ok" || line.starts_with("error:");
            let ends = text.lines().filter(|line| is_end(line)).count();
            prop_assert_eq!(ends, 1, "{}", text);
            prop_assert!(text.lines().last().is_some_and(is_end), "{}", text);
        }
    }
}
