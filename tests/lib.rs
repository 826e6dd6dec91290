//! What the rungs share.
