//! O-words, messages and the end of programs.

use crate::support::{canons, steps, xs};
use carrystep_gcode::{Canon, Input, Interpreter, Options, Pace, Step, Until};
use std::io::Cursor;

#[test]
fn only_the_first_branch_whose_condition_holds_is_taken() {
    for (value, taken) in [(1, 10.0), (2, 20.0), (3, 30.0), (4, 40.0)] {
        let text = format!(
            "#1={value}\no1 if [#1 eq 1]\nG0 X10\no1 elseif [#1 le 2]\nG0 X20\n\
             o1 elseif [#1 le 3]\nG0 X30\no1 else\nG0 X40\no1 endif\n"
        );
        assert_eq!(xs(&text), [taken]);
    }
}

#[test]
fn an_inner_if_without_a_true_branch_goes_on_after_its_end() {
    let text = "o1 if [1]\no2 if [0]\nG0 X1\no2 elseif [0]\nG0 X2\no2 endif\nG0 X3\no1 elseif [1]\n\
                G0 X4\no1 endif\nG0 X5";
    assert_eq!(xs(text), [3.0, 5.0]);
}

#[test]
fn break_and_continue_leave_the_loops_inside_of_theirs() {
    let text = "\
        o1 while [#1 lt 3]\n#1=[#1+1]\no2 repeat [3]\n#2=[#2+1]\no3 if [#1 eq 2]\no1 continue\n\
        o3 endif\nG0 X#2\no2 endrepeat\no1 endwhile\n\
        o4 repeat [2]\no5 repeat [9]\n#3=[#3+1]\nG0 X[100+#3]\no6 if [#3 mod 2 eq 0]\no5 break\n\
        o6 endif\no5 endrepeat\no4 endrepeat";
    let first = [1.0, 2.0, 3.0, 5.0, 6.0, 7.0];
    assert_eq!(xs(text), [&first[..], &[101.0, 102.0, 103.0, 104.0]].concat());
}

#[test]
fn repeat_in_a_recursion_counts_for_each_call() {
    let text = "o1 sub\no2 if [#1 gt 0]\no3 repeat [2]\no1 call [#1-1]\no3 endrepeat\no2 endif\n\
                #<_n>=[#<_n>+1]\nG0 X#<_n>\no1 endsub\n#<_n>=0\no1 call [3]";
    assert_eq!(xs(text).len(), 15);
}

#[test]
fn return_out_of_loops_gives_the_value_and_the_parameters_back() {
    let text = "o<f> sub\n#<x>=5\no1 repeat [9]\no2 while [1]\n#1=[#1+1]\no3 if [#1 gt 20]\n\
                o<f> return [#1*2]\no3 endif\no2 endwhile\no1 endrepeat\no<f> endsub\n\
                #1=7 #<x>=1\no4 repeat [2]\no<f> call [18] [3]\nG0 X#<_value>\nG0 X[#1+#<x>]\n\
                o4 endrepeat";
    assert_eq!(xs(text), [42.0, 8.0, 42.0, 8.0]);
}

#[test]
fn a_subroutine_may_stand_behind_its_call_and_runs_only_when_called() {
    assert_eq!(xs("o1 call [3]\nG0 X1\no1 sub\nG0 X#1\no1 endsub\nG0 X2"), [3.0, 1.0, 2.0]);
}

#[test]
fn a_label_may_be_used_again_for_another_block() {
    assert_eq!(xs("o1 if [1]\nG0 X1\no1 endif\no01 if [1]\nG0 X2\no1 endif"), [1.0, 2.0]);
}

#[test]
fn lines_with_a_slash_are_left_out_or_read() {
    let text = "G0 X1\n/X2\n/o1 if [0]\nX3\n/o1 endif";
    assert_eq!(xs(text), [1.0, 3.0]);
    let options = Options { block_delete: false, ..Options::default() };
    let program = Interpreter::new(Cursor::new(text), "p.ngc", &options).unwrap();
    let lines: Vec<u64> = program.map(|step| step.unwrap().line).collect();
    assert_eq!(lines, [1, 2, 5]);
}

#[test]
fn a_program_ends_at_m2_at_the_second_percent_sign_or_at_the_end_of_the_file() {
    for text in
        ["%\nM3 S9 M8\nG0 X1\n%\nrubbish ((", "M3 S9 M8\nG0 X1\nM2\nrubbish ((", "M3 S9 M8\nG0 X1"]
    {
        let canons = canons(text);
        let [.., spindle, coolant, end] = &canons[..] else { panic!("{canons:?}") };
        assert!(matches!(spindle, Canon::Spindle { turn: carrystep_gcode::Turn::Off, .. }));
        assert_eq!(coolant, &Canon::Coolant { mist: false, flood: false });
        assert_eq!(end, &Canon::End);
        assert_eq!(xs(text), [1.0]);
    }
    assert_eq!(canons(""), [Canon::End]);
}

#[test]
fn messages_show_the_values_of_parameters() {
    let text = "#1=1.5 #<a b>=2\n(MSG, Tool #1)\n(debug, #1 #<A b> #<none> #x)\n( plain )";
    let message = |text: &str| Canon::Message(text.to_owned());
    let found = canons(text);
    assert_eq!(found[0], message("Tool #1"));
    assert_eq!(found[1], message("1.500000 2.000000 ###### #x"));
    assert_eq!(found[2], Canon::Comment("plain".to_owned()));
}

#[test]
fn every_step_has_the_line_that_asked_for_it() {
    let text = "o1 sub\nG0 X#1\no1 endsub\n\no1 call [1]\nG4 P1\no1 call [2]\n";
    let lines: Vec<u64> = steps(text).unwrap().into_iter().map(|step| step.line).collect();
    assert_eq!(lines, [2, 6, 2, 7]);
}

#[test]
fn a_probe_that_trips_early_moves_the_place_and_the_parameters() {
    let text = "F60\nG20\n\nG38.2 X3\nG91 G0 X1\nG90 X#5061\nY#5070";
    let mut program = Interpreter::new(Cursor::new(text), "p.ngc", &Options::default()).unwrap();
    let probe = program.next().unwrap().unwrap();
    assert!(matches!(
        probe,
        Step { line: 4, canon: Canon::Probe { contact: true, required: true, .. }, .. }
    ));
    program.probed([25.4, 0.0, 0.0, 0.0, 0.0, 0.0], true);
    let rest: Vec<Canon> = program.map(|step| step.unwrap().canon).collect();
    let traverse = |x, y| Canon::Traverse { to: [x, y, 0.0, 0.0, 0.0, 0.0] };
    assert_eq!(rest[..3], [traverse(50.8, 0.0), traverse(25.4, 0.0), traverse(25.4, 25.4)]);
}

#[test]
fn inputs_become_what_is_wanted_unless_another_value_is_reported() {
    let wanted = |l| format!("M66 P3 L{l} Q2.5\nG0 X[#5399+10]");
    for (l, until, x) in [(1, Until::Rise, 11.0), (2, Until::Fall, 10.0), (3, Until::High, 11.0)] {
        let found = canons(&wanted(l));
        let input = Input::Digital(3);
        assert_eq!(found[0], Canon::ReadInput { input, until, seconds: 2.5 });
        assert_eq!(xs(&wanted(l)), [x]);
    }
    let text = wanted(4) + "\nM66 E2\nX#5399";
    let mut program = Interpreter::new(Cursor::new(text), "p.ngc", &Options::default()).unwrap();
    program.next();
    program.input_read(None);
    let to = |x| Canon::Traverse { to: [x, 0.0, 0.0, 0.0, 0.0, 0.0] };
    assert_eq!(program.next().unwrap().unwrap().canon, to(9.0));
    let (input, until) = (Input::Analog(2), Until::Now);
    let read = Canon::ReadInput { input, until, seconds: 0.0 };
    assert_eq!(program.next().unwrap().unwrap().canon, read);
    program.input_read(Some(-2.5));
    assert_eq!(program.next().unwrap().unwrap().canon, to(-2.5));
}

#[test]
fn offsets_that_the_machine_has_kept_are_in_effect_from_the_beginning() {
    let parameters = vec![(5221, 10.0), (5162, 7.0), (0, 1.0), (6000, 1.0)];
    let options = Options { parameters, start: [1.0; 6], ..Options::default() };
    let mut program =
        Interpreter::new(Cursor::new("G0 X0\nG28 Y0\nG10 L2 P1 X3"), "p.ngc", &options).unwrap();
    let to: Vec<Canon> = program.by_ref().map(|step| step.unwrap().canon).collect();
    assert_eq!(to[0], Canon::Traverse { to: [10.0, 1.0, 1.0, 1.0, 1.0, 1.0] });
    assert_eq!(to[2], Canon::Traverse { to: [10.0, 7.0, 1.0, 1.0, 1.0, 1.0] });
    assert_eq!(program.parameter(5221), 3.0);
    assert_eq!(program.place(), [10.0, 7.0, 1.0, 1.0, 1.0, 1.0]);
}

#[test]
fn continue_goes_on_with_the_next_round_of_each_kind_of_loop() {
    let text = "\
        o1 repeat [3]\n#1=[#1+1]\no2 if [#1 eq 2]\no1 continue\no2 endif\nG0 X#1\no1 endrepeat\n\
        o3 do\n#1=[#1+1]\no4 if [#1 eq 5]\no3 continue\no4 endif\nG0 X#1\no3 while [#1 lt 6]\n\
        o5 while [#1 lt 9]\n#1=[#1+1]\no6 if [#1 eq 8]\no5 continue\no6 endif\nG0 X#1\no5 endwhile";
    assert_eq!(xs(text), [1.0, 3.0, 4.0, 6.0, 7.0, 9.0]);
}

#[test]
fn a_branch_ends_at_elseif_also_in_a_round_after_one_that_tested_it() {
    let text = "o1 repeat [3]\n#1=[#1+1]\no2 if [#1 eq 2]\nG0 X2\no2 elseif [1]\nG0 X[10*#1]\n\
                o2 endif\no1 endrepeat";
    assert_eq!(xs(text), [10.0, 2.0, 30.0]);
}

#[test]
fn parameters_that_a_call_does_not_pass_are_zero_in_it() {
    let text = "#2=5 #30=6 #31=7\no1 sub\nG0 X[100+#1+#2+#30+#31]\no1 endsub\no1 call [1]\nG0 X#2";
    assert_eq!(xs(text), [108.0, 5.0]);
}

#[test]
fn the_remainder_of_a_negative_number_is_not_negative() {
    assert_eq!(xs("G0 X[-7 mod 3]\nG0 X[7 mod -3]"), [2.0, 1.0]);
}

#[test]
fn a_turn_of_a_rotary_axis_alone_has_its_feed_in_degrees_whatever_the_offsets() {
    let text =
        "F60\nG20\nF60\nG0 X0.1 Y0.7\nG10 L2 P1 X0.3 Y0.2 R33\nG92 X0.1 Y0.1\nG91 G1 A9\nG90 G1 A3";
    let pace = |canon| match canon {
        Canon::Feed { pace, .. } => Some(pace),
        _ => None,
    };
    let paces: Vec<Pace> = canons(text).into_iter().filter_map(pace).collect();
    assert_eq!(paces, [Pace::PerSecond(1.0); 2]);
}

#[test]
fn moves_that_are_shorter_than_rounding_errors_add_up_to_one() {
    let text = "G91 G0 X1\no1 repeat [100]\nG0 X0.0000000001\no1 endrepeat\nG90";
    let xs = xs(text);
    assert_eq!(xs.len(), 1 + 10);
    assert!((xs[10] - 1.000_000_01).abs() < 1e-12, "{xs:?}");
}

#[test]
fn a_small_peck_does_not_return_above_r() {
    let z = |canon: &Canon| match canon {
        Canon::Traverse { to } | Canon::Feed { to, .. } => Some((to[2] * 1000.0).round()),
        _ => None,
    };
    let found: Vec<f64> = canons("F60\nG83 Z-0.5 R0.1 Q0.2").iter().filter_map(z).collect();
    assert_eq!(found, [100.0, -100.0, 100.0, -300.0, 100.0, -46.0, -500.0, 100.0]);
}

#[test]
fn mist_and_flood_are_switched_on_one_by_one_and_off_together() {
    let coolant = |mist, flood| Canon::Coolant { mist, flood };
    let found = canons("M7\nM8\nM9\nM8");
    let off = coolant(false, false);
    assert_eq!(
        found,
        [
            coolant(true, false),
            coolant(true, true),
            off.clone(),
            coolant(false, true),
            off,
            Canon::End
        ]
    );
}
