//! Sweeps: tables and pictures.
