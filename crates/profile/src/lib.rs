//! Float reference profiles of the literature.
