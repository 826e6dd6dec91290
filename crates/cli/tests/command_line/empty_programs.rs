//! Programs that do nothing are refused; dwells and outputs alone are something.

use crate::command::Folder;

/// A folder with the machine of `sim/jobs/` and this program.
fn folder(program: &str) -> Folder {
    let folder = Folder::new();
    folder.write("m.toml", include_str!("../../../../sim/jobs/machine.toml"));
    folder.write("job.ngc", program);
    folder
}

#[test]
fn program_that_does_nothing_is_refused_by_every_command() {
    for program in
        ["", "(only a comment)\n", "M2\n", "G1 X0 F600\n", "M0\nM6 T1\n", "M3 S100\nM2\n"]
    {
        let folder = folder(program);
        folder.write("own.vcd", "$timescale 1 ns $end\n$enddefinitions $end\n#0\n");
        for command in
            ["plan job.ngc", "simulate job.ngc --vcd out.vcd", "simulate job.ngc --level model"]
        {
            let ran = folder.run(&format!("{command} --machine m.toml"));
            ran.refuses(
                "job.ngc: the program does nothing on this machine: no axis moves by a step",
            );
            assert!(ran.stderr.contains("help: "), "{}", ran.stderr);
        }
        assert_eq!(folder.files(), ["job.ngc", "m.toml", "own.vcd"], "{program}");
    }
    let (empty, moves) = (folder("M2\n"), folder("G1 X1 F600\n"));
    assert_eq!(moves.run("simulate job.ngc --machine m.toml --vcd own.vcd").status, 0);
    std::fs::copy(moves.path("own.vcd"), empty.path("own.vcd")).unwrap();
    empty.run("check own.vcd job.ngc --machine m.toml").refuses("the program does nothing");
}

#[test]
fn dwells_and_outputs_alone_are_tried() {
    let rests = folder("G4 P0.05\n");
    let ran = rests.run("simulate job.ngc --machine m.toml --vcd own.vcd");
    assert!(ran.status == 0 && ran.stdout.contains("50000 ticks"), "{}{}", ran.stdout, ran.stderr);
    assert_eq!(rests.run("check own.vcd job.ngc --machine m.toml").status, 0);
    let switches = folder("M64 P3\n");
    switches.write("m.toml", include_str!("../../../../sim/jobs/outputs.toml"));
    let ran = switches.run("simulate job.ngc --machine m.toml");
    assert!(ran.stdout.contains("in their clocks: 1; wrong: 0"), "{}{}", ran.stdout, ran.stderr);
}
