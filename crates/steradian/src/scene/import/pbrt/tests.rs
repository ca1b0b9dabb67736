//! Laws of the importer: every directive does what pbrt-v4 says, every fault is reported at its place.

mod real;
