//! Random programs that both interpreters accept: units, offsets, rotation, straight moves, arcs in
//! all planes, and drilling cycles, in any order.

use crate::support::{point, words};
use carrystep_gcode::Point;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::sample::{select, subsequence};

/// G code and the letters of the first, second and normal axis and of the centre of each plane.
const PLANES: [(&str, [char; 3], [char; 2]); 3] = [
    ("G17", ['X', 'Y', 'Z'], ['I', 'J']),
    ("G18", ['Z', 'X', 'Y'], ['K', 'I']),
    ("G19", ['Y', 'Z', 'X'], ['J', 'K']),
];

/// What a program may have, so that LinuxCNC does what it means: in a rotated coordinate system its
/// arcs outside of XY are none; a change of units does not convert its tool offsets, a rotation
/// does not turn them, and those of A, B and C are not taken off in G53, G28 and G30; a change of
/// the rotation while G92 is in effect changes the place.
#[derive(Debug, Clone, Copy)]
enum Kind {
    Units,
    Rotation,
    Tools,
}

/// A program.
pub fn program() -> impl Strategy<Value = String> {
    select(&[Kind::Units, Kind::Rotation, Kind::Tools][..]).prop_flat_map(|kind| {
        let lines = vec(line(kind), 10..80);
        lines.prop_map(|lines| format!("G21 G90 G17 F600\n{}\nM2\n", lines.join("\n")))
    })
}

fn line(kind: Kind) -> BoxedStrategy<String> {
    let with_axes = |codes: &'static [&str]| {
        (select(codes), axes()).prop_map(|(code, axes)| format!("{code} {axes}"))
    };
    let (planes, rotation) = match kind {
        Kind::Rotation => (1, (0_i32..360).boxed()),
        Kind::Units | Kind::Tools => (3, Just(0).boxed()),
    };
    let offsets = point().prop_map(|to| format!("G43.1 X{} Y{} Z{}", to[0], to[1], to[2]));
    // Every seventh tool has an offset of A.
    let table = (select(&["G43", "G43.2"][..]), 0_u32..14, 1_u32..7)
        .prop_map(|(code, sevens, tool)| format!("{code} H{}", 7 * sevens + tool));
    let special = match kind {
        Kind::Units => select(&["G20", "G21"][..]).prop_map(str::to_owned).boxed(),
        Kind::Rotation => Just("G91.1".to_owned()).boxed(),
        Kind::Tools => prop_oneof![offsets, table, Just("G49".to_owned())].boxed(),
    };
    let g92 = match kind {
        Kind::Rotation => Just("G64".to_owned()).boxed(),
        Kind::Units | Kind::Tools => prop_oneof![
            with_axes(&["G92"]),
            select(&["G92.1", "G92.2", "G92.3"][..]).prop_map(str::to_owned),
        ]
        .boxed(),
    };
    let stores = &["G28.1", "G30.1"][..];
    let systems = &["G54", "G55", "G56", "G57", "G58", "G59", "G59.1", "G59.2", "G59.3"][..];
    prop_oneof![
        3 => with_axes(&["G0", "G1", "G91 G0", "G91 G1"]).prop_map(|line| line + "\nG90"),
        1 => with_axes(&["G53 G0", "G53 G1", "G28", "G30"]),
        1 => g92,
        1 => select(stores).prop_map(str::to_owned),
        1 => select(systems).prop_map(str::to_owned),
        1 => special,
        1 => (0..10, axes(), rotation).prop_map(|(system, axes, degrees)| {
            format!("G10 L2 P{system} {axes} R{degrees}")
        }),
        1 => (0..10, axes()).prop_map(|(system, axes)| format!("G10 L20 P{system} {axes}")),
        2 => arc(planes),
        1 => cycle(),
    ]
    .boxed()
}

/// Words of some axes, at least one.
fn axes() -> impl Strategy<Value = String> {
    (point(), subsequence((0..6).collect::<Vec<_>>(), 1..=6)).prop_map(|(point, axes)| {
        let all = words(&point);
        let all: Vec<&str> = all.split(' ').collect();
        axes.into_iter().map(|axis| all[axis].to_owned() + " ").collect()
    })
}

/// An arc by its centre or by its radius, from wherever the program is.
fn arc(planes: usize) -> impl Strategy<Value = String> {
    let by_centre = (0.1_f64..50.0, 0.0_f64..360.0, 0.0_f64..360.0, 1..4, axes_normal());
    let by_centre = by_centre.prop_map(|(radius, from, to, turns, (normal, rotary))| {
        let on_circle = |degrees: f64| {
            let (sin, cos) = degrees.to_radians().sin_cos();
            [radius * cos, radius * sin]
        };
        let (from, to) = (on_circle(from), on_circle(to));
        let values = [to[0] - from[0], to[1] - from[1], normal];
        (values, format!("%0{:.6} %1{:.6} P{turns} A{rotary:.3}", -from[0], -from[1]))
    });
    let by_radius =
        ([-40.0_f64..40.0, -40.0_f64..40.0], 1.01_f64..5.0, any::<bool>(), axes_normal());
    let by_radius = by_radius.prop_map(|([x, y], factor, major, (normal, _))| {
        // At least a millimetre away.
        let x = if x < 0.0 { x - 1.0 } else { x + 1.0 };
        let radius = x.hypot(y) / 2.0 * factor * if major { -1.0 } else { 1.0 };
        ([x, y, normal], format!("R{radius:.6}"))
    });
    let plane = select(&PLANES[..planes]);
    let code = select(&["G2", "G3"][..]);
    (plane, code, prop_oneof![by_centre, by_radius]).prop_map(|(plane, code, (values, rest))| {
        let (name, letters, centre) = plane;
        let ends = letters.iter().zip(values).map(|(letter, value)| format!("{letter}{value:.6} "));
        let rest = rest.replace("%0", &centre[0].to_string()).replace("%1", &centre[1].to_string());
        format!("{name} G91 {code} {}{rest}\nG90 G17", ends.collect::<String>())
    })
}

/// A helix height and a turn of A.
fn axes_normal() -> impl Strategy<Value = (f64, f64)> {
    (-9.0..9.0, -90.0..90.0)
}

/// Two lines of one cycle.
fn cycle() -> impl Strategy<Value = String> {
    let kind = select(&["G81", "G82 P0.5", "G83 Q2.5", "G83 Q40"][..]);
    let modes = select(&["G98", "G99", "G98 G91", "G99 G91"][..]);
    let numbers = (-5.0_f64..5.0, -30.0_f64..-6.0, 1..4, point(), any::<bool>());
    (kind, modes, select(&PLANES[..]), numbers).prop_map(|(kind, modes, plane, numbers)| {
        let (name, [first, second, normal], _) = plane;
        let (r, bottom, holes, to, again): (f64, f64, i32, Point, bool) = numbers;
        let over = |x: f64, y: f64| format!("{first}{x} {second}{y}");
        let more = if again { format!("{} L2\n", over(to[2], to[3])) } else { String::new() };
        format!(
            "{name} {modes} {kind} {} {normal}{bottom:.3} R{r:.3} L{holes}\n{more}G80 G90 G17",
            over(to[0], to[1])
        )
    })
}
