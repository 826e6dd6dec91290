//! Programs that senders stream to `carrystep serve`: the end is exact, the pulses are those of
//! `carrystep run`, and nothing is lost.

use crate::command::Folder;
use crate::run_programs::{MACHINE, run};
use crate::sender::{Sender, Served, is_answer};
use crate::virtual_boards::{Board, passed};
use std::collections::BTreeMap;
use std::fmt::Write as _;

pub fn folder() -> Folder {
    let folder = Folder::new();
    folder.write("machine.toml", MACHINE);
    folder
}

/// A program of so many short lines around a flower, and its end.
fn flower(lines: usize) -> (String, [f64; 3]) {
    let mut text = "G21 G90 F1500\nM3 S1000\n".to_owned();
    let mut end = [0.0; 3];
    for number in 1..=lines {
        let angle = number as f64 * 0.05;
        let radius = 3.0 + 0.5 * (5.0 * angle).sin();
        end = [radius * angle.cos(), radius * angle.sin(), (number % 7) as f64 * 0.01];
        let [x, y, z] = end;
        writeln!(text, "N{number} G1 X{x:.3} Y{y:.3} Z{z:.2}").unwrap();
    }
    text.push_str("G3 X2 Y4 R9 (an arc)\nM5\n");
    end = [2.0, 4.0, end[2]];
    (text, end)
}

/// Where the machine of these tests is, if it is asked for this place: whole steps.
fn steps(at: [f64; 3]) -> Vec<f64> {
    let round = |(at, steps): (f64, f64)| ((at * steps).round() / steps * 1000.0).round() / 1000.0;
    at.into_iter().zip([80.0, 80.0, 400.0]).map(round).collect()
}

#[test]
fn streamed_program_ends_where_it_should() {
    let folder = folder();
    let (program, end) = flower(400);
    for counts in [true, false] {
        let served = Served::new(&folder, "");
        let mut sender = if counts { Sender::tcp(&served) } else { Sender::pty(&served) };
        if counts {
            sender.counted(&program, 1024);
        } else {
            sender.simple(&program);
        }
        assert_eq!(sender.place(), steps(end));
        // Back, with the modes that are in force.
        sender.simple("G91\nG0 X-2 Y-4\nG90\nG1 Z0");
        assert_eq!(sender.place(), [0.0; 3]);
        let (status, said) = served.interrupt();
        assert_eq!(status, 0, "{said}");
    }
}

#[test]
fn lines_that_overfill_the_buffer_are_not_lost() {
    let folder = folder();
    let served = Served::new(&folder, "");
    let mut sender = Sender::tcp(&served);
    // Thirty times as much as the buffer takes.
    let (program, end) = flower(1000);
    sender.send(&program);
    for _ in program.lines() {
        assert_eq!(sender.until(is_answer), "ok");
    }
    assert_eq!(sender.place(), steps(end));
}

/// The edges of a capture, with times from the first edge on, ps. The step pin of x rises in
/// `x.step1`.
pub fn edges(vcd: &str) -> Vec<(u64, String)> {
    let (header, changes) = vcd.split_once("$enddefinitions $end").unwrap();
    let (mut names, mut scope) = (BTreeMap::new(), "");
    for line in header.lines() {
        match line.split_whitespace().collect::<Vec<_>>()[..] {
            ["$scope", _, name, ..] => scope = name,
            ["$var", _, _, code, name, ..] => {
                names.insert(code.to_owned(), format!("{scope}.{name}"));
            }
            _ => {}
        }
    }
    let (mut time, mut first) = (0, None);
    let mut edges = Vec::new();
    let mut levels = BTreeMap::new();
    for line in changes.lines() {
        if let Some(text) = line.strip_prefix('#') {
            time = text.parse::<u64>().unwrap();
        } else if let Some(level) = line.chars().next().filter(|c| matches!(c, '0' | '1')) {
            let name = &names[&line[1..]];
            if levels.insert(name.clone(), level).is_some_and(|before| before != level) {
                let first = *first.get_or_insert(time);
                edges.push((time - first, format!("{name}{level}")));
            }
        }
    }
    edges
}

#[test]
fn pulses_of_a_program_that_is_sent_in_a_hold_are_those_of_run() {
    let folder = folder();
    let (program, _) = flower(150);
    folder.write("job.ngc", format!("{program}M2\n"));
    let board = Board::new(&folder, "--fast --vcd run.vcd");
    passed(&run(&folder, &board, ""));
    board.end();

    let board = Board::new(&folder, "--fast --vcd serve.vcd");
    let served = Served::with(&folder, &format!("--port {}", board.port));
    let mut sender = Sender::tcp(&served);
    sender.send("!");
    sender.simple(&program);
    sender.done("M2");
    assert!(sender.report().starts_with("<Hold:0|MPos:0.000,0.000,0.000|"));
    sender.send("~");
    sender.until(|line| line == "[MSG:Pgm End]");
    sender.place();
    assert_eq!(served.interrupt().0, 0);
    board.end();

    let [ran, streamed] = ["run.vcd", "serve.vcd"]
        .map(|name| edges(&std::fs::read_to_string(folder.path(name)).unwrap()));
    assert!(ran.len() > 3000, "{}", ran.len());
    let differs = ran.iter().zip(&streamed).position(|(one, other)| one != other);
    assert_eq!((differs, ran.len()), (None, streamed.len()));
    // The check of the program finds nothing either.
    let ran = folder.run("check serve.vcd job.ngc --machine machine.toml");
    assert!(ran.stdout.contains("ALL HOLDS"), "{}{}", ran.stdout, ran.stderr);
}
