//! Radiometric and photometric quantities with their units.
