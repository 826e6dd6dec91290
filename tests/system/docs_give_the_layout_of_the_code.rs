//! Pages show the schedule of a time slot, the words of the memories and the fields of an answer as
//! they stand in the code.

use carrystep_core::engine::{MAX_AXES, QUEUE_DEPTHS, SEGMENT_WORDS};
use carrystep_core::link::ANSWER;
use carrystep_hdl::engine::layout::{self, INDICES};
use carrystep_tests::pages::{self, says, word};
use carrystep_tests::sources::{behind, whole};

/// The value of a constant of the layout.
fn beat(name: &str) -> usize {
    let found = INDICES.iter().find(|(known, _)| *known == name);
    found.unwrap_or_else(|| panic!("no {name}")).1
}

/// The line of a page that begins with this word.
fn line_of(page: &str, word: &str) -> String {
    let line = page.lines().find(|line| line.trim_start().starts_with(word));
    line.unwrap_or_else(|| panic!("no line of `{word}`")).to_owned()
}

#[test]
fn engine_page_draws_the_beats_of_the_layout() {
    let page = pages::file("docs/engine.md");
    let head = line_of(&page, "beat       0");
    let places: Vec<usize> = head
        .char_indices()
        .filter(|(at, c)| {
            c.is_ascii_digit() && !head[..*at].ends_with(|c: char| c.is_ascii_digit())
        })
        .map(|(at, _)| at)
        .collect();
    let numbers: Vec<usize> = head.split_whitespace().filter_map(|n| n.parse().ok()).collect();
    assert_eq!(numbers, (0..=beat("BEAT_PHASE")).collect::<Vec<_>>(), "{head}");
    assert_eq!(places.len(), numbers.len(), "{head}");
    let rows: [(&str, &[(&str, &str)]); 4] = [
        (
            "reads",
            &[
                ("A ", "BEAT_READ_A_LOW"),
                ("J ", "BEAT_READ_J_LOW"),
                ("V ", "BEAT_READ_V_LOW"),
                ("P ", "BEAT_READ_P_LOW"),
                ("n ", "BEAT_READ_TICKS"),
                ("pos", "BEAT_READ_POSITION"),
                ("J'", "BEAT_READ_J_HIGH"),
                ("A'", "BEAT_READ_A_HIGH"),
                ("V'", "BEAT_READ_V_HIGH"),
                ("P'", "BEAT_READ_P_HIGH"),
                ("tick", "BEAT_READ_TICK"),
                ("tick", "BEAT_READ_TICK_AGAIN"),
            ],
        ),
        (
            "adds",
            &[
                ("P+V ", "BEAT_SUM_P_LOW"),
                ("n-1", "BEAT_SUM_TICKS"),
                ("put", "BEAT_SUM_PUT"),
                ("P+V'", "BEAT_SUM_P_HIGH"),
                ("V/2", "BEAT_BISECT_1"),
                ("V/4", "BEAT_BISECT_2"),
                ("V/8  V/16", "BEAT_BISECT_3"),
                ("tick", "BEAT_SUM_TICK"),
            ],
        ),
        (
            "writes",
            &[
                ("A ", "BEAT_WRITE_A_LOW"),
                ("V ", "BEAT_WRITE_V_LOW"),
                ("P ", "BEAT_WRITE_P_LOW"),
                ("n ", "BEAT_WRITE_TICKS"),
                ("pos", "BEAT_WRITE_POSITION"),
                ("put", "BEAT_WRITE_PUT"),
                ("A'", "BEAT_WRITE_A_HIGH"),
                ("V'", "BEAT_WRITE_V_HIGH"),
                ("P'", "BEAT_WRITE_P_HIGH"),
            ],
        ),
        (
            "outputs",
            &[
                ("P ", "BEAT_STATE_P_LOW"),
                ("n ", "BEAT_STATE_LEFT"),
                ("pos", "BEAT_STATE_POSITION"),
                ("sw ", "BEAT_STATE_SWITCH"),
                ("P'", "BEAT_STATE_P_HIGH"),
                ("tick", "BEAT_STATE_TICK"),
                ("stat", "BEAT_STATE_STATUS"),
            ],
        ),
    ];
    for (name, cells) in rows {
        let row = line_of(&page, &format!("{name}  "));
        for (text, constant) in cells {
            let cell = &row[places[beat(constant)]..];
            assert!(format!("{cell} ").starts_with(text), "{constant}: `{text}` is not at: {cell}");
        }
        // The row of sums also names sums for which the layout has no constant.
        let named = row.split_whitespace().filter(|cell| !["|", name].contains(cell)).count();
        assert!(name == "adds" || named == cells.len(), "{row}");
    }
    let at = beat;
    let (add, write) = (
        at("BEAT_SUM_P_LOW") - at("BEAT_READ_P_LOW"),
        at("BEAT_WRITE_P_LOW") - at("BEAT_READ_P_LOW"),
    );
    let v = at("BEAT_READ_V_LOW");
    says(
        "docs/engine.md",
        &[
            format!("is added in beat k + {add}, and the sum is written in beat k + {write}."),
            format!(
                "is read in beat {v}, added in beat {} and written in beat {}",
                v + add,
                v + write
            ),
            format!("(A in beat {}, J' in beat {})", at("BEAT_READ_A_LOW"), at("BEAT_READ_J_HIGH")),
            format!("passes through the adder in beat {}", at("BEAT_SUM_PUT")),
            format!("Beat {} adds the high halves of P and V", at("BEAT_SUM_P_HIGH")),
            format!("in order, 0 to {}, and then its commit", SEGMENT_WORDS - 1),
        ],
    );
    assert_eq!(at("BEAT_WRITE_V_LOW"), v + write);
}

/// Every slot of the drawing begins with the words of a segment, and ends with a word of the state
/// of the axis.
#[test]
fn engine_page_draws_the_words_of_the_memory() {
    let page = pages::file("docs/engine.md");
    let head = line_of(&page, "word       0");
    let place = |word: u64| head.find(&format!(" {word}")).expect("a word") + 1;
    let numbers: Vec<u64> = head.split_whitespace().filter_map(|n| n.parse().ok()).collect();
    assert_eq!(numbers, (0..=layout::WORD_STATE).collect::<Vec<_>>(), "{head}");
    let slots = [
        ("slot 0  ", "P, low", vec![layout::SLOT_P_LOW]),
        ("slot 1  ", "P, high", vec![layout::SLOT_P_HIGH]),
        ("slot 2  ", "position", vec![layout::SLOT_POSITION]),
        ("slot 3  ", "discarded steps", vec![layout::SLOT_DISCARDED]),
        ("slot 4 5", "-s, low and high", vec![layout::SLOT_DOWN_LOW, layout::SLOT_DOWN_HIGH]),
        ("slot 6 7", "s, low and high", vec![layout::SLOT_UP_LOW, layout::SLOT_UP_HIGH]),
    ];
    for (name, state, numbers) in slots {
        let row = line_of(&page, name);
        let shown: Vec<u64> = name.split_whitespace().filter_map(|n| n.parse().ok()).collect();
        assert_eq!(shown, numbers, "{row}");
        for (word, text) in [
            (layout::WORD_TICKS, "ticks-1 "),
            (layout::WORD_V_LOW, "V "),
            (layout::WORD_A_LOW, "A "),
            (layout::WORD_J_LOW, "J "),
            (layout::WORD_STATE, state),
        ] {
            assert!(row[place(word)..].starts_with(text), "{text} is not at word {word}: {row}");
        }
    }
    // The widths of the three numbers in an address.
    let word = layout::state_address(0, 0).count_ones();
    let slot = layout::state_address(1, 0).ilog2() - word;
    let axis = MAX_AXES.ilog2();
    // The two highest bits belong to deeper queues; with eight axes, one of them tells the number of
    // the tick from the words of the eighth axis.
    assert_eq!(memory("store.rs", "segments").0, 2 + axis + slot + word);
    assert_eq!(layout::state_address(0, 1).ilog2(), word);
    says("docs/engine.md", &[format!("address axis {axis} | slot {slot} | word {word} word 0")]);
}

/// The bits of the addresses and of the words of a memory of the engine.
fn memory(file: &str, name: &str) -> (u32, u32) {
    let source = format!("crates/hdl/src/engine/{file}");
    let address = whole(behind(&source, &format!("{name}: Memory<")));
    let bits = whole(behind(&source, &format!("{name}: Memory<{address}, ")));
    (address as u32, bits as u32)
}

#[test]
fn engine_page_counts_the_block_rams() {
    const RAM: (u32, u32) = (256, 16);
    let rams =
        |(address, bits): (u32, u32)| (1_u32 << address).div_ceil(RAM.0) * bits.div_ceil(RAM.1);
    // With queues of seven segments, the two highest bits of the address have no effect.
    let (address, bits) = memory("store.rs", "segments");
    let address = address - 2;
    let (wide, deep) = (bits / RAM.1, (1 << address) / RAM.0);
    assert_eq!(
        1 << address,
        MAX_AXES as u32 * (QUEUE_DEPTHS[0] as u32 + 1) * (SEGMENT_WORDS as u32 + 1)
    );
    let control = memory("queue.rs", "control");
    let others = [
        memory("queue.rs", "lasts"),
        memory("switches.rs", "switch_memory"),
        memory("event_wheel.rs", "event_memory"),
    ];
    assert!(others.into_iter().all(|memory| rams(memory) == 1));
    let all = wide * deep + rams(control) + others.len() as u32;
    let measured = pages::file("hdl-out/resources.md");
    let row = measured.lines().find(|line| line.starts_with("| hx8k ct256 | 6 | 1 us |"));
    assert_eq!(row.and_then(|row| row.split(" | ").nth(6)), Some(all.to_string().as_str()));
    let number = |count: u32| word(count.into());
    says(
        "docs/engine.md",
        &[
            format!(
                "{} x {} bit block RAMs, {} wide and {} deep. It holds {bits}-bit words:",
                RAM.0,
                RAM.1,
                number(wide),
                number(deep)
            ),
            format!(
                "{} axes, {} slots per axis, {} words per slot",
                word(MAX_AXES as u64),
                word(QUEUE_DEPTHS[0] as u64 + 1),
                word(u64::from(SEGMENT_WORDS) + 1)
            ),
            format!("has {} bits and takes {} more block RAMs", control.1, number(rams(control))),
        ],
    );
}

/// The hand-written table of the answer has the fields of the code, with their places.
#[test]
fn protocol_page_gives_the_fields_of_the_answer() {
    let page = pages::file("docs/protocol.md");
    let (_, table) = page.split_once("## The answer\n").expect("the answer");
    let (table, _) = table.split_once("\n\nBit 5 of byte 3").expect("the end of the table");
    let rows = table.lines().filter_map(|line| line.strip_prefix("| ")).skip(1);
    let shown: Vec<[String; 3]> = rows
        .filter(|row| !row.starts_with("-"))
        .map(|row| {
            let mut cells = row.split('|').map(|cell| cell.trim().to_owned());
            [(); 3].map(|()| cells.next().unwrap_or_default())
        })
        .collect();
    let mut wanted = Vec::new();
    let place = |bit: u8, bits: u8| match bits {
        8 => String::new(),
        1 => bit.to_string(),
        _ => format!("{}..{bit}", bit + bits - 1),
    };
    for field in &ANSWER {
        wanted.push((
            field.byte,
            field.bit,
            [field.byte.to_string(), place(field.bit, field.bits), field.name.to_owned()],
        ));
    }
    wanted.sort_by_key(|(byte, bit, _)| (*byte, *bit));
    let wanted: Vec<[String; 3]> = wanted.into_iter().map(|(_, _, row)| row).collect();
    assert_eq!(shown[..wanted.len()], wanted[..]);
    let rest: Vec<&str> = shown[wanted.len()..].iter().map(|row| row[2].as_str()).collect();
    assert_eq!(rest, ["data", "CRC"]);
}
