//! Mutation tests: the C library and the gateware in miniature, each with one wrong line, must fail
//! a test that the correct ones pass.

use crate::support::c_library::CClient;
use crate::support::client::{Client, RustClient};
use crate::support::conversation::{converse, scripts};
use crate::support::device::Bugs;
use crate::support::random::{Random, program};
use crate::support::soak::{Soak, TICKS, soak};
use crate::support::wire::Faults;

/// Mutations of the C library: name, correct text (which occurs once in its file), wrong text.
const IN_C: [(&str, &str, &str); 35] = [
    ("CRC is not looked at", "|| carrystep_crc(frame, content) != word_at(frame, content)", ""),
    ("length is not looked at", "length != CARRYSTEP_ANSWER_BYTES || ", ""),
    ("END is not escaped", "if (frame[at] == CARRYSTEP_END) {", "if (false) {"),
    ("ESC is not escaped", "} else if (frame[at] == CARRYSTEP_ESC) {", "} else if (false) {"),
    ("a wrong escape is taken", "decoder->broken = true;\n        }\n    }", "}\n    }"),
    ("an unfinished escape is taken", "decoder->broken || decoder->escaped", "decoder->broken"),
    (
        "a long frame is cut to size",
        "} else {\n        decoder->broken = true;\n    }\n    return CARRYSTEP_NOTHING;",
        "}\n    return CARRYSTEP_NOTHING;",
    ),
    ("ticks are not less one", "segment->ticks - 1u", "segment->ticks"),
    (
        "an old count is believed",
        "if (advance > session->reached) {",
        "if (false && advance > session->reached) {",
    ),
    ("refusals of writes that were never sent are believed", "behind < session->reached &&", ""),
    (
        "refusals of another write of the same number are believed",
        " &&\n           session->slots[slot(session, behind)].address == answer->address",
        "",
    ),
    ("a read is always free", "request->writes || session != 0", "request->writes"),
    ("a write has no session", "request->writes || session != 0", "session != 0"),
    ("a busy OPEN opens", "answer->reason == 0 ? session->opening : 0", "session->opening"),
    ("any answer to an OPEN opens", "        if (single) {", "        if (true) {"),
    ("a lost session is kept", "        leave(session);\n        return", "        return"),
    (
        "a stop waits for the writes",
        "    carrystep_withdraw(session);\n    withdraw",
        "    withdraw",
    ),
    (
        "a stop waits for the reads",
        "(session->singles[index].request.writes && !session->singles[found].request.writes)",
        "false",
    ),
    ("a cut has the number of a refused one", "session->keeps_refused_cut &&", "false &&"),
    ("a start is fed without power", "return UNPOWERED;", ""),
    (
        "a start is written without power",
        "WRITES(CARRYSTEP_START) && !carrystep_may_start(session)",
        "0",
    ),
    (
        "what was never sent may be executed",
        "if (advance > session->reached) {",
        "if (advance > session->length) {",
    ),
    (
        "every refusal begins a new round",
        "!session->has_refused || behind <= session->refused",
        "true",
    ),
    (
        "no refusal begins a new round after the first",
        "!session->has_refused || behind <= session->refused",
        "!session->has_refused",
    ),
    ("a busy start is sent again at once", "session->busy = busy;", ""),
    (
        "nothing is sent again by time",
        "waited >= session->resend)",
        "false && waited >= session->resend)",
    ),
    (
        "a read that overtakes another one is ignored",
        "overtake(session, false,",
        "if (0) overtake(session, false,",
    ),
    (
        "a write that overtakes a read is ignored",
        "overtake(session, true,",
        "if (0) overtake(session, true,",
    ),
    ("an overtaken read is sent again each time", " && !session->singles[index].sent_again", ""),
    (
        "a question is answered by any answer",
        " &&\n            session->singles[index].sequence == answer->sequence",
        "",
    ),
    (
        "segments on their way are not counted",
        "answer->free > under_way ? answer->free - under_way : 0",
        "answer->free",
    ),
    ("a start does not wait for the other", "!session->starting && !session->armed", "true"),
    ("a start does not wait for its segments", "feeder->axes[axis].waiting == 0", "false"),
    ("only axis 0 is fed first", "feeder->axes[axis].ticks < feeder->axes[found].ticks", "false"),
    (
        "a withdrawn segment stays on its way",
        "settle(session, &session->slots[slot(session, session->length)]);",
        "",
    ),
];

fn verdict(client: &mut dyn Client) -> Result<(), String> {
    for (name, text) in scripts() {
        converse(client, &text).map_err(|words| format!("{name}: {words}"))?;
    }
    run(client, Bugs::default())
}

fn run(client: &mut dyn Client, bugs: Bugs) -> Result<(), String> {
    let commands = program(&mut Random::new(7), 6, 800, 20 * TICKS);
    let outcome = soak(client, &commands, Soak { faults: Faults::BAD, seed: 7, axes: 6, bugs })?;
    outcome.fault.map_or(Ok(()), |cause| Err(format!("the machine stopped: {cause}")))
}

#[test]
fn bugs_planted_in_the_client_are_caught() {
    assert_eq!(verdict(&mut CClient::shared()), Ok(()));
    for (bug, right, wrong) in IN_C {
        let planted = std::cell::Cell::new(0);
        // gcc takes the last -O. With -O2, which comes first, it takes most of this test's time.
        let arguments = ["-Wno-error", "-w", "-O0"];
        let mut client = CClient::with(&arguments, |_, text| {
            planted.set(planted.get() + text.matches(right).count());
            text.replace(right, wrong)
        });
        assert_eq!(planted.get(), 1, "{bug}: {right}");
        let caught = verdict(&mut client);
        println!("{bug}: {caught:?}");
        assert!(caught.is_err(), "{bug} is not caught");
    }
}

#[test]
fn bugs_planted_in_the_gateware_are_caught() {
    assert_eq!(run(&mut RustClient::default(), Bugs::default()), Ok(()));
    let bugs = [
        Bugs { no_crc: true, ..Bugs::default() },
        Bugs { executes_again: true, ..Bugs::default() },
        Bugs { skips_the_missing: true, ..Bugs::default() },
        Bugs { no_escape: true, ..Bugs::default() },
    ];
    for bug in bugs {
        let caught = run(&mut RustClient::default(), bug);
        println!("{bug:?}: {caught:?}");
        assert!(caught.is_err(), "{bug:?} is not caught");
    }
}
