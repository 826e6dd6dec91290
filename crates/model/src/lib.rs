//! The gateware as integer functions, tick by tick and clock by clock.
