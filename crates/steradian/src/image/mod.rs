//! Pictures: decoding, lookup, minification, output frames and their comparison.

mod codec;
pub mod encoding;
pub mod error;
pub mod picture;
pub mod pyramid;
pub mod wrap;

pub use codec::decode;
pub use encoding::ColorEncoding;
pub use error::ImageError;
pub use picture::{Image, Layout};
pub use pyramid::Pyramid;
pub use wrap::{AxisWrap, Wrap};
