//! The plan does not depend on the number of letters for which the planner is compiled: three or six.

use carrystep_files::{Machine, SourceText};
use carrystep_job::{Arc, Element, Item, Planner, Row, Tolerance, rows};

fn machine(letters: &str) -> Machine {
    let mut text = String::from(
        "[machine]\nclock_hz = 80_000_000\ntick_ns = 1000\nlink = { baud = 2_000_000 }\n",
    );
    for letter in letters.chars() {
        text += &format!(
            "[[machine.axis]]\nname = \"{letter}\"\nsteps_per_unit = 80\nspeed_limit = 100\n\
             accel_limit = 1000\ndriver = \"tmc2209\"\n"
        );
    }
    Machine::from_source(&SourceText { path: "machine.toml".into(), text: text.into() }).unwrap()
}

/// A corner, an arc, a reversal and a long line; then short lines to and fro, some of them shorter
/// than the linear tolerance. The rotary tolerance is a fortieth of it: a planner that applies it to a
/// machine without rotary letters plans these lines in another way.
fn items(letters: usize) -> Vec<Item> {
    let mut ends = vec![[10.0, 0.0], [10.0, 5.0], [14.0, 9.0], [13.0, 9.0], [0.0, -20.0]];
    let mut random = 1_u32;
    ends.extend((0..40).map(|_| {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        [f64::from(random >> 24) / 3000.0, f64::from(random >> 16 & 255) / 3000.0 - 20.0]
    }));
    let element = |(number, end): (usize, [f64; 2])| {
        let angle = -std::f64::consts::FRAC_PI_2;
        let arc = Arc { plane: [0, 1], centre: [14.0, 5.0], angle };
        let mut to = end.to_vec();
        to.resize(letters, number.min(5) as f64 / 4.0);
        Item::Move(Element {
            to,
            arc: (number == 2).then_some(arc),
            feed: (number != 4).then_some(30.0),
            tolerance: Tolerance { linear: 0.02, rotary: 0.0005 },
            line: number as u64,
            block: 0,
        })
    };
    let mut items: Vec<Item> = ends.into_iter().enumerate().map(element).collect();
    items.insert(4, Item::Mark(7));
    items
}

fn planned(machine: &Machine, linear: usize, room: usize) -> Vec<Row> {
    let letters = machine.axes.len();
    let planner = Planner::with_room(machine, linear, &vec![0.0; letters], room).unwrap();
    rows(planner, items(letters)).map(Result::unwrap).collect()
}

#[test]
fn room_for_further_letters_changes_no_segment() {
    for (letters, linear) in [("xy", 2), ("xyz", 3), ("xya", 2)] {
        let machine = machine(letters);
        let three = planned(&machine, linear, 0);
        assert!(three.len() > 300, "{} rows of {letters}", three.len());
        assert_eq!(three, planned(&machine, linear, 6), "{letters}");
    }
}
