//! Kempe.
