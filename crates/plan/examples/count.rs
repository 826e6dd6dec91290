use carrystep_spec::*;
fn main() {
    for kind in ["logistic", "sine", "scurve", "trapezoid"] {
        for fit in [1000u64, 50, 10, 1] {
            let text = format!(
                "[machine]\n[[machine.axis]]\nname=\"x\"\nsteps_per_unit=1.0\nspeed_limit=150000.0\naccel_limit=500000.0\njerk_limit=5553604000.0\nstep_ns=100\ngap_ns=100\nsetup_ns=100\nhold_ns=100\n[[move]]\nprofile=\"{kind}\"\nfit_ns={fit}\nto={{x=20000}}\n"
            );
            let text = if kind == "scurve" { text } else { text.replace("jerk_limit=5553604000.0\n", "") };
            let file = MoveFile::from_source(Source { path: "x".into(), text: text.into() }).unwrap();
            let t = std::time::Instant::now();
            let plan = match carrystep_plan::plan::<f64>(&file) {
                Ok(p) => p,
                Err(e) => {
                    println!("{kind} {fit} {e}");
                    continue;
                }
            };
            let d = t.elapsed();
            let a = &plan.moves[0].axes[0];
            let l: Vec<u32> = a.segments.iter().map(|s| s.ticks).collect();
            println!("{kind} {fit} ns: {} segments {d:?} {l:?}", l.len());
        }
    }
}
