//! A pin in a board's file, or a list of pins.

use serde::de::{SeqAccess, Visitor};
use serde::{Deserialize, Deserializer};
use std::fmt;
use toml::Spanned;

/// One pin, or one pin for each axis.
pub(super) enum Pins {
    One(String),
    Many(Vec<Spanned<String>>),
}

/// Implemented by hand, because an untagged enumeration would lose the places in the file.
impl<'de> Deserialize<'de> for Pins {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct OneOrMany;
        impl<'de> Visitor<'de> for OneOrMany {
            type Value = Pins;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a pin in quotes, or a list of them")
            }
            fn visit_str<E: serde::de::Error>(self, pin: &str) -> Result<Pins, E> {
                Ok(Pins::One(pin.to_owned()))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Pins, A::Error> {
                let mut pins = Vec::new();
                while let Some(pin) = list.next_element()? {
                    pins.push(pin);
                }
                Ok(Pins::Many(pins))
            }
        }
        deserializer.deserialize_any(OneOrMany)
    }
}
