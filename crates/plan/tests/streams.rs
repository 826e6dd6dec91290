//! A plan that is made while it is read is the plan that is made at once, and it holds no more
//! moves than its readers are apart.

use carrystep_core::StartPhase;
use carrystep_files::{InputError, MoveFile, MoveSource, SourceText};
use carrystep_plan::{Pass, PlannedMove, Survey, Totals, plan};
use std::fmt::Write as _;
use std::path::Path;
use std::sync::{Arc, Weak};

const MACHINE: &str = "[machine]\n\
    [[machine.axis]]\nname = \"x\"\nsteps_per_unit = 80\nspeed_limit = 300\naccel_limit = 3000\ndriver = \"a4988\"\n\
    [[machine.axis]]\nname = \"y\"\nsteps_per_unit = 80\nspeed_limit = 200\naccel_limit = 2000\ndriver = \"a4988\"\n\
    [[machine.axis]]\nname = \"z\"\nsteps_per_unit = 400\nspeed_limit = 20\naccel_limit = 200\ndriver = \"a4988\"\n";

/// So many moves: x there and back, y in every third move, and z in the last one only.
fn text(moves: usize) -> String {
    let mut text = MACHINE.to_owned();
    for number in 0..moves {
        let sign = if number % 2 == 0 { "" } else { "-" };
        let y = if number % 3 == 0 { ", y = 0.0125" } else { "" };
        let z = if number + 1 == moves { ", z = 1" } else { "" };
        let path = if number % 5 == 0 { "path = \"straight\"\n" } else { "" };
        let to = format!("x = {sign}0.05{y}{z}");
        writeln!(text, "[[move]]\n{path}profile = \"trapezoid\"\nto = {{ {to} }}").unwrap();
    }
    text
}

fn whole(text: &str) -> MoveFile {
    MoveFile::from_source(SourceText { path: "moves.toml".into(), text: text.into() }).unwrap()
}

fn survey(path: &Path) -> Survey {
    Survey::new(MoveSource::open(path).unwrap(), |_| Ok::<(), InputError>(())).unwrap()
}

/// A file of these moves, for as long as the folder is kept.
fn file(moves: usize) -> (tempfile::TempDir, std::path::PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("moves.toml");
    std::fs::write(&path, text(moves)).unwrap();
    (folder, path)
}

fn facts(planned: &PlannedMove) -> String {
    format!("{} {:?} {:?}", planned.start_tick, planned.course(&timebase()), planned.commands())
}

fn timebase() -> carrystep_core::Timebase {
    whole(&text(1)).machine.timebase
}

#[test]
fn plan_that_is_made_while_it_is_read_is_the_plan_of_the_file() {
    // The first file is kept and planned once, the second one is planned again by each pass.
    for moves in [10, 6000] {
        let (_folder, path) = file(moves);
        let (survey, plan) = (survey(&path), plan::<f64>(&whole(&text(moves))).unwrap());
        assert_eq!(
            format!("{:?}", survey.totals()),
            format!("{:?}", plan.moves.iter().collect::<Totals>())
        );
        assert_eq!(survey.totals().moves, moves as u64);
        for _ in 0..2 {
            let Pass { moves, timelines, courses } = survey.begin();
            assert!(moves.map(|planned| facts(&planned)).eq(plan.moves.iter().map(facts)));
            for (found, wanted) in timelines.iter().zip(plan.timelines()) {
                let phase = StartPhase::Half;
                assert!(found.crossings(phase).eq(wanted.crossings(phase)));
            }
            assert!(courses.unwrap().eq(plan.courses()));
        }
        survey.whole().unwrap();
    }
}

#[test]
fn moves_behind_all_readers_are_freed() {
    let (_folder, path) = file(6000);
    let survey = survey(&path);
    let Pass { moves, timelines, courses } = survey.begin();
    let mut walks: Vec<_> = timelines.iter().map(|timeline| timeline.walk()).collect();
    let mut courses = courses.unwrap();
    drop(timelines);
    let mut seen: Vec<Weak<PlannedMove>> = Vec::new();
    for planned in moves {
        seen.push(Arc::downgrade(&planned));
        // The axis z moves last of all; its reader does not ask for more than its place in time.
        walks.iter_mut().for_each(|walk| walk.go_to(planned.start_tick as f64));
        courses.next();
        drop(planned);
        let kept = seen.iter().rev().take(20).filter(|planned| planned.strong_count() > 0).count();
        assert!(kept <= 2, "{kept} moves are kept");
    }
    assert_eq!(seen.len(), 6000);
    assert!(seen.iter().all(|planned| planned.strong_count() == 0));
}

#[test]
fn a_refused_move_ends_the_survey_with_its_line() {
    let (_folder, path) = file(6000);
    let long = text(6000).replace("z = 1 }", "z = 1 }\ntime = 1e-3");
    std::fs::write(&path, &long).unwrap();
    let source = MoveSource::open(&path).unwrap();
    let mut planned = 0;
    let watch = |_: &PlannedMove| {
        planned += 1;
        Ok::<(), InputError>(())
    };
    let error = Survey::new(source, watch).unwrap_err();
    let line = long[..long.rfind("[[move]]").unwrap()].matches('\n').count() + 1;
    assert_eq!((planned, error.line_column()), (5999, Some((line, 1))), "{error}");
    assert!(error.message.starts_with("move 6000, axis z"), "{error}");
}

#[test]
fn a_file_that_changes_ends_the_lists_and_is_told() {
    let (_folder, path) = file(6000);
    let survey = survey(&path);
    std::fs::write(&path, text(5999)).unwrap();
    let pass = survey.begin();
    assert!(pass.moves.count() < 6000);
    let error = survey.whole().unwrap_err();
    assert!(error.message.contains("has changed while it was read"), "{error}");
}
