//! film
pub mod filter;
