//! Debug.
use carrystep_spec::*;
fn main() {
    let text = std::fs::read_to_string(std::env::args().nth(1).unwrap()).unwrap();
    let file = MoveFile::from_source(Source { path: "x".into(), text: text.into() }).unwrap();
    match carrystep_plan::plan::<f64>(&file) { Ok(p) => for a in &p.moves[0].axes { println!("{:?}", a.profile); for s in a.segments.iter().take(40) { println!("{s:?}"); } }, Err(e) => println!("{e}") }
}
