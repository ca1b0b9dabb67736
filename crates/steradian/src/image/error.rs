//! Why a picture cannot be read or written.

/// A picture that cannot be decoded, built or encoded. The caller adds the file name.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ImageError {
    /// Neither the content nor the extension names a format that is read.
    #[error("unknown image format \"{extension}\" (read: exr, pfm, hdr, png, tga, jpg, bmp)")]
    UnknownFormat {
        /// Extension of the file, as given.
        extension: String,
    },
    /// The bytes do not follow their format.
    #[error("malformed {format} image: {reason}")]
    Malformed {
        /// Name of the format.
        format: &'static str,
        /// What is wrong.
        reason: String,
    },
    /// The header promises more texels than the file can hold, or than are supported.
    #[error("image of {width} x {height} pixels is too large for a file of {bytes} bytes")]
    TooLarge {
        /// Width in the header [px].
        width: u64,
        /// Height in the header [px].
        height: u64,
        /// Length of the file [B].
        bytes: usize,
    },
    /// A side is zero pixels long.
    #[error("the image has no pixels")]
    Empty,
    /// A valid file that uses what is not supported.
    #[error("unsupported {format} image: {reason}")]
    Unsupported {
        /// Name of the format.
        format: &'static str,
        /// What is not supported.
        reason: String,
    },
    /// The amount of data does not fit the resolution.
    #[error("{found} values given for {width} x {height} pixels of {channels} channels")]
    WrongSize {
        /// Width [px].
        width: u32,
        /// Height [px].
        height: u32,
        /// Channels per pixel.
        channels: usize,
        /// Number of values that were given.
        found: usize,
    },
    /// A frame has no channel of this name.
    #[error("the frame has no channel \"{name}\"")]
    NoChannel {
        /// Name of the channel.
        name: String,
    },
    /// Two frames that should be compared have different sizes.
    #[error("frames of {} x {} and {} x {} pixels cannot be compared", .a[0], .a[1], .b[0], .b[1])]
    SizeMismatch {
        /// Width and height of the first [px].
        a: [u32; 2],
        /// Width and height of the second [px].
        b: [u32; 2],
    },
    /// The picture cannot be written in a format of this name.
    #[error("cannot write images as \"{extension}\" (written: exr, png, pfm)")]
    UnwritableFormat {
        /// Extension of the file, as given.
        extension: String,
    },
    /// Writing failed.
    #[error("cannot write the image: {0}")]
    Write(String),
}
