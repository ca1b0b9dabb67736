//! What tests of the program share.

pub(crate) mod desk;
