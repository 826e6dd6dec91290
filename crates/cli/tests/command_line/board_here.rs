//! A virtual board in this process, behind a pseudo-terminal: a test looks at everything that it has
//! done when it ends.

use carrystep_virtual_board::{Edges, Pace, RealTimeBoard, SimulatedBoard, Switches, Terminal};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;

/// A board that runs in a thread until [`BoardHere::end`].
pub struct BoardHere<B, E> {
    pub port: String,
    ends: Arc<AtomicBool>,
    thread: Option<JoinHandle<(B, E)>>,
}

impl<B, E> BoardHere<B, E>
where
    B: SimulatedBoard + Send + 'static,
    E: Edges + Send + 'static,
{
    /// Runs a board with this clock, Hz. `switches` gives the switches by the positions of the axes;
    /// `edges` receives the edges of its pins.
    pub fn new(
        board: B,
        mut edges: E,
        (pace, clock_hz): (Pace, u64),
        switches: impl Fn(&B) -> Switches + Send + 'static,
    ) -> Self {
        let terminal = Terminal::new().unwrap();
        let port = terminal.name().to_owned();
        let ends = Arc::new(AtomicBool::new(false));
        let asked = Arc::clone(&ends);
        let mut real_time = RealTimeBoard::new(board, terminal, pace, clock_hz);
        let thread = std::thread::spawn(move || {
            while !asked.load(Ordering::Relaxed) {
                real_time.board.press(switches(&real_time.board));
                real_time.step(&mut edges).unwrap();
            }
            (real_time.board, edges)
        });
        Self { port, ends, thread: Some(thread) }
    }

    /// Ends the board, and returns it with the receiver of its edges.
    pub fn end(mut self) -> (B, E) {
        self.ends.store(true, Ordering::Relaxed);
        self.thread.take().unwrap().join().unwrap()
    }
}

impl<B, E> Drop for BoardHere<B, E> {
    fn drop(&mut self) {
        // A test that has failed leaves no thread behind that goes on.
        self.ends.store(true, Ordering::Relaxed);
    }
}
