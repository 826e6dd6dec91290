//! Waveforms in and out, the pulse checker and its pictures.
