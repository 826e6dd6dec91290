//! A list that grows at its end while readers go through it, each at its own pace.
//!
//! ```text
//!  item 4 -> item 5 -> item 6 -> item 7 -> (end, not made yet)
//!              ^                             ^
//!              reader that is furthest back  reader that asks for the next item: it is made now
//! ```
//!
//! An item lives until the last reader has gone past it, so that a list of any length takes only
//! the memory that its readers are apart.

use std::fmt;
use std::sync::{Arc, OnceLock};

/// Makes the items of one or more lists.
pub trait Source: Send + Sync {
    /// Makes some more items, unless all have been made.
    fn grow(&self);
    /// The tick up to which all items are in the lists; `u64::MAX` if all have been made.
    fn known_to(&self) -> u64;
}

/// The source of a list that is complete.
struct Complete;

impl Source for Complete {
    fn grow(&self) {}

    fn known_to(&self) -> u64 {
        u64::MAX
    }
}

/// A place in a list: the item there, and the place after it; `None` behind the last item. It is
/// not set while the item has not been made.
struct Place<T>(OnceLock<Option<(T, Arc<Place<T>>)>>);

impl<T> Drop for Place<T> {
    /// Frees the places behind this one in a loop. The compiler's own code would call itself for
    /// each of them.
    fn drop(&mut self) {
        let mut next = self.0.take().flatten().map(|(_, place)| place);
        while let Some(mut place) = next.and_then(Arc::into_inner) {
            next = place.0.take().flatten().map(|(_, place)| place);
        }
    }
}

/// The end of a list, where items are added.
pub struct ListEnd<T>(Arc<Place<T>>);

impl<T> Default for ListEnd<T> {
    fn default() -> Self {
        Self(Arc::new(Place(OnceLock::new())))
    }
}

impl<T: Clone> ListEnd<T> {
    /// A reader that begins here. `source` adds to this list.
    pub fn reader(&self, source: Arc<dyn Source>) -> Reader<T> {
        Reader { at: self.0.clone(), source }
    }

    /// Adds an item.
    pub fn push(&mut self, item: T) {
        let Self(next) = Self::default();
        // Only this end sets its place, and it moves on at once.
        let _ = self.0.0.set(Some((item, next.clone())));
        self.0 = next;
    }

    /// Marks the list as complete.
    pub fn close(&self) {
        let _ = self.0.0.set(None);
    }
}

/// Goes through a list. A clone begins where the reader is.
pub struct Reader<T> {
    at: Arc<Place<T>>,
    source: Arc<dyn Source>,
}

impl<T> Clone for Reader<T> {
    fn clone(&self) -> Self {
        Self { at: self.at.clone(), source: self.source.clone() }
    }
}

impl<T> fmt::Debug for Reader<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Reader").field("known_to", &self.source.known_to()).finish_non_exhaustive()
    }
}

impl<T: Clone> Reader<T> {
    /// The next item, or `None` if the list has no further item, or none before `tick`: items are
    /// made until all are known up to and with this tick, and no longer.
    pub fn next_by(&mut self, tick: u64) -> Option<T> {
        loop {
            // This is read first: everything up to there is in the list when it is.
            let known = self.source.known_to();
            match self.at.0.get() {
                Some(Some((item, next))) => {
                    let item = item.clone();
                    self.at = next.clone();
                    return Some(item);
                }
                None if known <= tick => self.source.grow(),
                None | Some(None) => return None,
            }
        }
    }
}

impl<T: Clone> Iterator for Reader<T> {
    type Item = T;

    fn next(&mut self) -> Option<T> {
        // A source that has made everything has closed its lists.
        self.next_by(u64::MAX)
    }
}

impl<T: Clone> From<Vec<T>> for Reader<T> {
    /// A complete list.
    fn from(items: Vec<T>) -> Self {
        let mut end = ListEnd::default();
        let reader = end.reader(Arc::new(Complete));
        items.into_iter().for_each(|item| end.push(item));
        end.close();
        reader
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;
    use std::sync::atomic::{AtomicU64, Ordering::SeqCst};

    /// Adds the numbers below a limit, one at a time; number n is at tick 10 n.
    struct Numbers {
        end: Mutex<(u64, ListEnd<Arc<u64>>)>,
        known_to: AtomicU64,
        limit: u64,
    }

    impl Source for Numbers {
        fn grow(&self) {
            let (next, end) = &mut *self.end.lock().unwrap();
            if *next < self.limit {
                end.push(Arc::new(*next));
                *next += 1;
                self.known_to.store(10 * *next, SeqCst);
            } else {
                end.close();
                self.known_to.store(u64::MAX, SeqCst);
            }
        }

        fn known_to(&self) -> u64 {
            self.known_to.load(SeqCst)
        }
    }

    fn numbers(limit: u64) -> Reader<Arc<u64>> {
        let end = ListEnd::default();
        let at = ListEnd(end.0.clone());
        let source = Numbers { end: Mutex::new((0, end)), known_to: AtomicU64::new(0), limit };
        at.reader(Arc::new(source))
    }

    #[test]
    fn every_reader_sees_every_item() {
        let mut first = numbers(100);
        let second = first.clone();
        let begin: Vec<u64> = first.by_ref().take(7).map(|n| *n).collect();
        assert_eq!(begin, (0..7).collect::<Vec<_>>());
        assert!(second.map(|n| *n).eq(0..100));
        assert!(first.map(|n| *n).eq(7..100));
    }

    #[test]
    fn readers_in_threads_see_every_item() {
        let first = numbers(10_000);
        std::thread::scope(|scope| {
            for _ in 0..4 {
                let reader = first.clone();
                scope.spawn(move || assert!(reader.map(|n| *n).eq(0..10_000)));
            }
        });
    }

    #[test]
    fn no_more_is_made_than_was_asked_for() {
        let mut reader = numbers(100);
        assert_eq!(reader.next_by(35).as_deref(), Some(&0));
        assert_eq!(reader.source.known_to(), 10);
        let seen: Vec<u64> = std::iter::from_fn(|| reader.next_by(35)).map(|n| *n).collect();
        assert_eq!(seen, [1, 2, 3]);
        assert_eq!(reader.source.known_to(), 40);
        assert_eq!(reader.next_by(2000).as_deref(), Some(&4));
    }

    #[test]
    fn items_are_freed_behind_the_last_reader() {
        let mut reader = numbers(100);
        let mut held = reader.clone();
        let (third, first) = (reader.nth(2).unwrap(), held.next().unwrap());
        drop(reader);
        assert_eq!(Arc::strong_count(&first), 1);
        assert_eq!(Arc::strong_count(&third), 2);
        drop(held);
        assert_eq!(Arc::strong_count(&third), 1);
    }

    #[test]
    fn a_list_of_a_million_items_is_freed_without_recursion() {
        let reader = Reader::from(vec![0_u8; 1_000_000]);
        assert_eq!(reader.clone().count(), 1_000_000);
        drop(reader);
    }
}
