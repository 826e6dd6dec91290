//! Benchmark: lines of G-code per second, for short lines, arcs, expressions, and loops.
//!
//!     cargo bench -p carrystep-gcode

#![allow(clippy::expect_used, reason = "clippy.toml's allowance reaches unit tests only")]

use carrystep_gcode::{Interpreter, Options};
use divan::Bencher;
use divan::counter::ItemsCount;
use std::io::Cursor;

fn main() {
    divan::main();
}

/// Lines of each program; a loop runs as many.
const LINES: usize = 10_000;

/// Reads a program to its end, with the number of lines that run as the count.
fn read(bencher: Bencher<'_, '_>, text: &str) {
    bencher.counter(ItemsCount::new(LINES)).bench(|| {
        let program = Interpreter::new(Cursor::new(text), "bench.ngc", &Options::default());
        program.expect("a program").fold(0_u64, |count, step| {
            step.expect("a step");
            count + 1
        })
    });
}

#[divan::bench]
fn short_lines(bencher: Bencher<'_, '_>) {
    let line = |n: usize| format!("G1 X{}.350 Y0.{:03} Z-{}.629\n", n % 100, n % 1000, n % 7);
    read(bencher, &("F600\n".to_owned() + &(1..LINES).map(line).collect::<String>()));
}

#[divan::bench]
fn arcs(bencher: Bencher<'_, '_>) {
    read(bencher, &("F600\n".to_owned() + &"G2 X10 I5 J0\nG3 X0 I-5 J0\n".repeat(LINES / 2)));
}

#[divan::bench]
fn expressions(bencher: Bencher<'_, '_>) {
    let lines = "G1 X[#<scale>*2.5+SIN[30]] Y[#1/3-#2**2]\nX0 Y0\n".repeat(LINES / 2);
    read(bencher, &("F600\n#<scale>=2 #1=3 #2=4\n".to_owned() + &lines));
}

#[divan::bench]
fn a_loop(bencher: Bencher<'_, '_>) {
    let rounds = LINES / 5;
    let text = "F600\no1 while [#1 LT ".to_owned()
        + &rounds.to_string()
        + "]\n#1=[#1+1]\nG1 X[#1 MOD 7]\nG1 X0\no1 endwhile\n";
    read(bencher, &text);
}
