//! Subroutines by number (M98, M99), and subroutines in files of their own.

use crate::support::{steps, xs};
use carrystep_gcode::{Canon, ErrorKind, GcodeError, Interpreter, Options, Step};
use std::path::Path;
use tempfile::TempDir;

/// A folder with these files.
fn folder(files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).expect("a file");
    }
    folder
}

/// Reads `job.ngc` in a folder.
fn run(folder: &Path) -> Result<Vec<Step>, GcodeError> {
    Interpreter::open(&folder.join("job.ngc"), &Options::default())?.collect()
}

/// The message of a refused `job.ngc`, without the name of the folder.
fn refused(files: &[(&str, &str)]) -> String {
    let folder = folder(files);
    let shown = run(folder.path()).expect_err("refused").to_string();
    shown.replace(&format!("{}/", folder.path().display()), "")
}

#[test]
fn m98_runs_a_subroutine_as_often_as_l_says_and_shares_the_numbered_parameters() {
    let text = "O1\n#1=5 #<x>=8\nM98 P7 L3\nM98 P7 L0\nG0 X[#1*100+#<x>]\nM2\n\
                O7\n#1=[#1+1]\n#<x>=0\nG0 X#1\nM99";
    assert_eq!(xs(text), [6.0, 7.0, 8.0, 808.0]);
}

#[test]
fn names_of_a_subroutine_are_gone_in_its_next_round() {
    let text = "M98 P7 L2\nM2\nO7\nG0 X[10+EXISTS[#<x>]]\n#<x>=1\nG0 X[20+EXISTS[#<x>]]\nM99";
    assert_eq!(xs(text), [10.0, 21.0, 10.0, 21.0]);
}

#[test]
fn m99_leaves_the_loops_of_its_subroutine_and_no_others() {
    let text = "o1 repeat [2]\nM98 P7 L2\no1 endrepeat\nM2\n\
                O7\no2 repeat [9]\n#1=[#1+1]\nG0 X#1\nM99\no2 endrepeat";
    assert_eq!(xs(text), [1.0, 2.0, 3.0, 4.0]);
}

#[test]
fn axis_words_in_the_line_of_m98_and_m99_move_before_the_jump() {
    assert_eq!(xs("G0 X1 M98 P7\nX4\nM2\nO7\nX2\nX3 M99"), [1.0, 2.0, 3.0, 4.0]);
}

#[test]
fn subroutines_by_number_are_refused_where_they_cannot_run() {
    for (text, place, words) in [
        ("G0 X1\nM99", "2:1", "M99 outside of a subroutine"),
        ("o1 sub\nM99\no1 endsub\no1 call", "2:1", "M99 outside of a subroutine"),
        ("M98 P3\nM2\nO3\nG0 X1\n", "4", "ends without M99"),
        ("%\nM98 P3\nM2\nO3\nG0 X1\n%\nM99", "6", "ends without M99"),
        ("M98 P3", "1:1", "the file has no `O3`"),
        ("M98 P3\nM2\no3 sub\no3 endsub", "1:1", "the file has no `O3`"),
        ("o3 call\nM2\nO3\nM99", "1:4", "the file has no `o3 sub`"),
        ("G0 M98", "1:4", "M98 needs P"),
        ("M98 P1.5", "1:5", "not a whole number"),
        ("M98 P1 L-1", "1:8", "L is -1"),
        ("M98 P1 Q1", "1:8", "nothing in this line uses Q"),
        ("M98 P3\nM2\nO3\nM98 P3\nM99", "4:1", "more than 100 deep"),
    ] {
        let shown = steps(text).unwrap_err().to_string();
        assert!(shown.starts_with(&format!("p.ngc:{place}: ")), "{shown} {text}");
        assert!(shown.contains(words), "{shown} {words}");
    }
}

#[test]
fn a_subroutine_without_content_that_is_called_without_end_is_refused() {
    let options = Options { blocks: 10_000, ..Options::default() };
    let text = "M98 P3 L1000000000\nM2\nO3\nM99";
    let program = Interpreter::new(std::io::Cursor::new(text), "p.ngc", &options).unwrap();
    let kind = program.last().unwrap().unwrap_err().kind;
    assert_eq!(kind, ErrorKind::TooManyBlocks(10_000));
}

#[test]
fn lines_after_a_call_of_a_subroutine_at_the_end_of_the_file_do_not_count_as_run_again() {
    let text = "M98 P3\n".to_owned() + &"G4 P1\n".repeat(1000) + "M2\nO3\nM99";
    let options = Options { blocks: 10, ..Options::default() };
    let program = Interpreter::new(std::io::Cursor::new(text), "p.ngc", &options).unwrap();
    assert_eq!(program.filter(Result::is_ok).count(), 1001);
}

#[test]
fn subroutines_are_found_in_the_running_file_the_program_and_the_file_of_their_name() {
    let job = "G0 X1\no<far> call [2]\no5 call\nM98 P0006\no<far> call [7]\nM2\n\
               o<near> sub\nX[#1+0.5]\no<near> endsub";
    let far = "%\nG0 X99\no<own> sub\nX[#1+0.25]\no<own> endsub\n\
               o<far> sub\nX#1\no<own> call [#1]\no<near> call [#1]\no<far> endsub\n%";
    let folder = folder(&[
        ("job.ngc", job),
        ("far.ngc", far),
        ("5.ngc", "o5 sub\nX5\no5 endsub"),
        ("6.ngc", "O6\nX6\nM99"),
    ]);
    let steps = run(folder.path()).unwrap();
    let shown = |step: Step| match step.canon {
        Canon::Traverse { to } => {
            let file = Path::new(&*step.file).file_name().unwrap().to_str().unwrap().to_owned();
            Some((file, step.line, to[0]))
        }
        _ => None,
    };
    let found: Vec<_> = steps.into_iter().filter_map(shown).collect();
    let expected = [
        ("job.ngc", 1, 1.0),
        ("far.ngc", 7, 2.0),
        ("far.ngc", 4, 2.25),
        ("job.ngc", 8, 2.5),
        ("5.ngc", 2, 5.0),
        ("6.ngc", 2, 6.0),
        ("far.ngc", 7, 7.0),
        ("far.ngc", 4, 7.25),
        ("job.ngc", 8, 7.5),
    ];
    assert_eq!(found, expected.map(|(file, line, x)| (file.to_owned(), line, x)));
}

#[test]
fn mistakes_in_other_files_are_refused_with_their_place() {
    let job = ("job.ngc", "G0 X1\no<a> call\nM2");
    let cases: [(&str, &str, &str); 6] = [
        ("o<b> sub\no<b> endsub", "job.ngc:2:6: ", "a.ngc has no `o<a> sub`"),
        ("o<a> sub\n", "a.ngc:1:1: ", "`o<a> sub` is never closed"),
        ("o<a> sub\nG0 X1 X2\no<a> endsub", "a.ngc:2:7: ", "X occurs twice"),
        ("o<a> sub\no<b> call\no<a> endsub", "a.ngc:2:6: ", "the file has no `o<b> sub`"),
        ("o<a> sub\nM98 P7\no<a> endsub\nO7\n", "a.ngc:4: ", "ends without M99"),
        ("o<a> sub\no<a> call\no<a> endsub", "a.ngc:2:6: ", "more than 100 deep"),
    ];
    for (text, place, words) in cases {
        let shown = refused(&[job, ("a.ngc", text)]);
        assert!(shown.starts_with(place) && shown.contains(words), "{shown}\n{place} {words}");
    }
    let outside = refused(&[("job.ngc", "o<../job> call")]);
    assert!(outside.starts_with("job.ngc:1:11: the file has no `o<../job> sub`"), "{outside}");
}

#[test]
fn a_subroutine_without_content_in_too_many_files_is_refused() {
    let folder = folder(&[("job.ngc", "#1=1\no1 while [1]\no#1 call\n#1=[#1+1]\no1 endwhile")]);
    for n in 1..120 {
        let path = folder.path().join(format!("{n}.ngc"));
        std::fs::write(path, format!("o{n} sub\no{n} endsub")).unwrap();
    }
    let error = run(folder.path()).unwrap_err();
    assert_eq!((error.line, error.kind), (3, ErrorKind::TooManyFiles(100)));
}

#[test]
fn another_file_that_changes_while_the_program_is_read_is_refused() {
    let folder =
        folder(&[("job.ngc", "o<a> call\nG0 X2\nX3"), ("a.ngc", "o<a> sub\nG0 X1\no<a> endsub")]);
    let path = folder.path().join("job.ngc");
    let mut program = Interpreter::open(&path, &Options::default()).unwrap();
    assert_eq!(program.next().unwrap().unwrap().line, 2);
    std::fs::write(folder.path().join("a.ngc"), "o<a> sub\nG0 X99\no<a> endsub").unwrap();
    let error = program.last().unwrap().unwrap_err();
    assert_eq!(error.kind, ErrorKind::Changed);
    assert!(error.file.ends_with("a.ngc"), "{error}");
}

#[test]
fn the_number_of_a_program_alone_means_nothing() {
    assert_eq!(xs("O0001 (PART 7)\nG0 X1\nO<name>\nX2\nM30\n"), [1.0, 2.0]);
}
