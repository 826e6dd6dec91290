//! A motor that does not move while others do has no speed, not even one of rounding: the guard stops
//! motion toward a limit switch that is closed, however slow it is.

use crate::common;
use crate::common::measure::planned;
use crate::common::reader;
use carrystep_job::Item;

/// Places of a whole number of steps, mm; most have no exact float.
const PLACES: [f64; 6] = [0.0, 0.1, 1.2375, -33.3375, 299.9875, 7919.425];

#[test]
fn motor_that_rests_has_segments_of_zero() {
    let machine = common::machine(&reader::file("machine.toml"));
    for place in PLACES {
        let y = |more: f64| place / 3.0 + more;
        let text = format!(
            "G64 P0.01 F3000\nG0 X{place} Y{}\nG1 Y{}\nG1 Z-1.7\nG1 Y{} Z-2\nG1 Y{}\nG1 Y{} Z-0.4\n",
            y(0.0),
            y(7.1),
            y(5.3),
            y(4.95),
            y(9.0),
        );
        let mut items = reader::read(&text);
        items.insert(1, Item::Rest { dwell: 0.1, line: 2 });
        let rows = planned(&machine, &items).into_iter().skip_while(|row| row.line <= 2);
        let mut moving = 0;
        for row in rows {
            let [x, y, z] = [0, 1, 2].map(|axis| row.segments[axis]);
            assert_eq!((x.v, x.a, x.j), (0, 0, 0), "x{place}, line {}", row.line);
            moving += u32::from((y.v, z.v) != (0, 0));
        }
        assert!(moving > 50, "x{place}: {moving} rows in motion");
    }
}
