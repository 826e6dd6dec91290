//! The host's end of an SPI, mode 0: as long as there is something to say it is selected.
//!
//! ```text
//! select_n  ^^\______________________________________/^^^
//! sck       ________/^^\__/^^\__ ... __/^^\______________     half a period before the first edge and behind the last
//! mosi      --< bit 7 >< bit 6 > ...  < bit 0 >----------
//! miso                 looked at where SCK rises
//! ```

use std::collections::VecDeque;

/// The host; its clock need not divide the gateware's.
#[derive(Debug, Clone)]
pub struct Master {
    clock_hz: u64,
    /// Edges of SCK in a second.
    edges_hz: u64,
    /// Edges that are due, in parts of one: `clock_hz` are one edge.
    due: u64,
    queue: VecDeque<u8>,
    /// What is being said, the present bit highest, and edges that are left of it; none while it is not selected.
    byte: u8,
    left: u8,
    selected: bool,
    sck: bool,
    comes: u8,
    heard: VecDeque<u8>,
}

impl Master {
    /// A host at rest, with this SCK.
    pub fn new(clock_hz: u64, sck_hz: u64) -> Self {
        Self {
            clock_hz,
            edges_hz: 2 * sck_hz,
            due: 0,
            queue: VecDeque::new(),
            byte: 0,
            left: 0,
            selected: false,
            sck: false,
            comes: 0,
            heard: VecDeque::new(),
        }
    }

    /// Says a byte after all others, and hears one.
    pub fn say(&mut self, byte: u8) {
        self.queue.push_back(byte);
    }

    /// Bytes that are not said yet, the present one included; 1 too until it has let go.
    pub fn unsaid(&self) -> usize {
        self.queue.len() + usize::from(self.selected)
    }

    /// The next byte that was heard.
    pub fn next_byte(&mut self) -> Option<u8> {
        self.heard.pop_front()
    }

    /// Nothing is said, and nothing is to be said.
    pub fn rests(&self) -> bool {
        self.unsaid() == 0
    }

    /// SCK, select (low) and MOSI in the next clock, MISO being as it is.
    pub fn clock(&mut self, miso: bool) -> [bool; 3] {
        if !self.selected {
            let Some(byte) = self.queue.pop_front() else { return [false, true, false] };
            (self.selected, self.byte, self.left, self.due) = (true, byte, 16, 0);
            return self.pins();
        }
        self.due += self.edges_hz;
        if self.due < self.clock_hz {
            return self.pins();
        }
        self.due -= self.clock_hz;
        if self.left == 0 {
            // Half a period behind the last edge.
            self.selected = false;
            return self.pins();
        }
        self.sck = !self.sck;
        self.left -= 1;
        if self.sck {
            self.comes = self.comes << 1 | u8::from(miso);
        } else {
            self.byte <<= 1;
        }
        if self.left == 0 {
            self.heard.push_back(self.comes);
            if let Some(byte) = self.queue.pop_front() {
                (self.byte, self.left) = (byte, 16);
            }
        }
        self.pins()
    }

    const fn pins(&self) -> [bool; 3] {
        [self.sck, !self.selected, self.byte & 0x80 != 0]
    }
}
