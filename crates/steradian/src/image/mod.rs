//! Pictures: decoding, lookup, minification, output frames and their comparison.

mod codec;
pub mod encoding;
pub mod error;
pub mod picture;
pub mod pyramid;
pub mod wrap;
pub mod frame;
pub mod frame_exr;
pub mod frame_png;
pub mod compare;
pub mod flip;
pub mod heat;
pub mod radiance;

pub use codec::decode;
pub use compare::{Comparison, Outliers, compare};
pub use encoding::ColorEncoding;
pub use error::ImageError;
pub use flip::{DEFAULT_PIXELS_PER_DEGREE, FlipMap, flip};
pub use frame::{Channel, Frame, RgbPlanes, Window};
pub use frame_exr::{SampleDepth, read_frame_exr, write_exr};
pub use frame_png::{FrameFormat, write_frame, write_pfm, write_png};
pub use heat::{heat_color, heat_map};
pub use picture::{Image, Layout};
pub use pyramid::Pyramid;
pub use radiance::{FisheyeView, RadianceHeader, write_radiance};
pub use wrap::{AxisWrap, Wrap};
