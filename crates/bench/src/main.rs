//! wip
use carrystep_levels::{Job, fast};
use carrystep_model::fast::{Edge, Edges};
fn now() -> f64 { let t = rustix::time::clock_gettime(rustix::time::ClockId::ProcessCPUTime); t.tv_sec as f64 + t.tv_nsec as f64 * 1e-9 }
struct Count { n: u64, hash: u64 }
impl Edges for Count {
    fn edge(&mut self, e: Edge) {
        self.n += 1;
        self.hash = (self.hash ^ (e.clock << 4 | u64::from(e.axis) << 1 | u64::from(e.backward))).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(23);
    }
}
fn main() {
    for name in std::env::args().skip(1) {
        let file = carrystep_spec::MoveFile::load(std::path::Path::new(&name)).expect("file");
        let plan = carrystep_plan::plan::<f64>(&file).expect("plan");
        let program = plan.program();
        let job = Job::new(&plan.build, &program, plan.total_ticks());
        let mut best = f64::MAX;
        let mut out = (0, 0, 0);
        for _ in 0..std::env::var("N").map_or(20, |n| n.parse().expect("n")) {
            let t = now();
            let mut l = fast::EdgesOnly(Count { n: 0, hash: 0 });
            let o = fast::run(&job, &mut l).expect("run");
            best = best.min(now() - t);
            out = (l.0.n, l.0.hash, o.clocks);
        }
        eprintln!("{name}: {} segs {} edges {:016x} {} clocks, {:.1} us, {:.2} ns/edge, {:.2} Gc/s", program.len(), out.0, out.1, out.2, best * 1e6, best * 1e9 / out.0 as f64, out.2 as f64 / best / 1e9);
    }
}
