//! Functions of wavelength.

mod visible;
pub mod sampled;
pub mod cie;
pub mod tabulated;
pub mod spd;
pub mod blackbody;
pub mod sigmoid;
pub mod rgb;
pub mod function;
pub mod named;
pub mod photometry;

pub use blackbody::Blackbody;
pub use function::Spectrum;
pub use named::named;
pub use rgb::{RgbAlbedo, RgbIlluminant, RgbUnbounded};
pub use sampled::{LAMBDA_MAX, LAMBDA_MIN, LANES, Sampled, Wavelengths};
pub use sigmoid::Sigmoid;
pub use tabulated::{Dense, TableError, Tabulated};
