//! An output picture: named planes of floats with what they mean.

use super::error::ImageError;
use crate::color::ColorSpaceKind;
use std::collections::BTreeMap;

/// A rectangle of pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// First column.
    pub x: i32,
    /// First row.
    pub y: i32,
    /// Columns, at least one.
    pub width: u32,
    /// Rows, at least one.
    pub height: u32,
}

impl Window {
    /// The whole of a picture of `width` × `height`.
    pub const fn full([width, height]: [u32; 2]) -> Self {
        Self { x: 0, y: 0, width, height }
    }

    /// Number of pixels.
    pub const fn area(&self) -> usize {
        self.width as usize * self.height as usize
    }
}

/// One plane of a [`Frame`].
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Name as OpenEXR has it: `R`, `Albedo.G`, `N.X`, `S0.550,000nm`.
    pub name: String,
    /// One value per pixel of the window, rows from the top.
    pub values: Vec<f32>,
}

/// A picture as it is written to and read from files: channels over a window of the whole picture.
#[derive(Clone, Debug, PartialEq)]
pub struct Frame {
    resolution: [u32; 2],
    window: Window,
    color_space: Option<ColorSpaceKind>,
    channels: Vec<Channel>,
    attributes: BTreeMap<String, String>,
}

/// The planes of a colour.
#[derive(Clone, Copy, Debug)]
pub struct RgbPlanes<'a> {
    /// Red.
    pub r: &'a [f32],
    /// Green.
    pub g: &'a [f32],
    /// Blue.
    pub b: &'a [f32],
}

impl RgbPlanes<'_> {
    /// Red, green and blue of pixel `i`.
    pub fn pixel(&self, i: usize) -> [f32; 3] {
        [self.r[i], self.g[i], self.b[i]]
    }

    /// Number of pixels.
    pub fn len(&self) -> usize {
        self.r.len()
    }

    /// Whether there are no pixels.
    pub fn is_empty(&self) -> bool {
        self.r.is_empty()
    }
}

impl Frame {
    /// A frame without channels over `window` of a picture of size `resolution` [px].
    ///
    /// # Errors
    /// When the window has no pixels.
    pub fn new(
        resolution: [u32; 2],
        window: Window,
        color_space: Option<ColorSpaceKind>,
    ) -> Result<Self, ImageError> {
        if window.area() == 0 {
            return Err(ImageError::Empty);
        }
        Ok(Self { resolution, window, color_space, channels: Vec::new(), attributes: BTreeMap::new() })
    }

    /// A frame of three channels R, G, B that is a whole picture.
    ///
    /// # Errors
    /// When there are no pixels.
    pub fn from_rgb(
        [width, height]: [u32; 2],
        color_space: ColorSpaceKind,
        pixel: impl Fn(usize) -> [f32; 3],
    ) -> Result<Self, ImageError> {
        let window = Window::full([width, height]);
        let mut frame = Self::new([width, height], window, Some(color_space))?;
        for (c, name) in ["R", "G", "B"].into_iter().enumerate() {
            frame.push_channel(name, (0..window.area()).map(|i| pixel(i)[c]).collect())?;
        }
        Ok(frame)
    }

    /// Size of the whole picture [px], of which the window may be a part.
    pub fn resolution(&self) -> [u32; 2] {
        self.resolution
    }

    /// The part of the picture that the channels cover.
    pub fn window(&self) -> Window {
        self.window
    }

    /// The primaries of R, G and B; `None` when the file named some that are not known.
    pub fn color_space(&self) -> Option<ColorSpaceKind> {
        self.color_space
    }

    /// Adds a channel, or replaces the one of the same name.
    ///
    /// # Errors
    /// When the number of values is not that of the window's pixels.
    pub fn push_channel(&mut self, name: impl Into<String>, values: Vec<f32>) -> Result<(), ImageError> {
        let Window { width, height, .. } = self.window;
        if values.len() != self.window.area() {
            return Err(ImageError::WrongSize { width, height, channels: 1, found: values.len() });
        }
        let name = name.into();
        match self.channels.iter_mut().find(|c| c.name == name) {
            Some(channel) => channel.values = values,
            None => self.channels.push(Channel { name, values }),
        }
        Ok(())
    }

    /// All channels, in the order in which they were added.
    pub fn channels(&self) -> &[Channel] {
        &self.channels
    }

    /// The values of a channel; `None` if there is none of this name.
    pub fn channel(&self, name: &str) -> Option<&[f32]> {
        self.channels.iter().find(|c| c.name == name).map(|c| &c.values[..])
    }

    /// The channels R, G and B; for a frame that has none of them but a Y, three times Y.
    ///
    /// # Errors
    /// When a channel is missing.
    pub fn rgb(&self) -> Result<RgbPlanes<'_>, ImageError> {
        let find = |name: &str| {
            self.channel(name)
                .or_else(|| self.channel("Y"))
                .ok_or_else(|| ImageError::NoChannel { name: name.to_owned() })
        };
        Ok(RgbPlanes { r: find("R")?, g: find("G")?, b: find("B")? })
    }

    /// Attaches text, such as the unit of a channel or a render setting; replaces what had this name.
    pub fn set_attribute(&mut self, name: impl Into<String>, value: impl Into<String>) {
        self.attributes.insert(name.into(), value.into());
    }

    /// The text of this name.
    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.get(name).map(String::as_str)
    }

    /// All texts, sorted by name.
    pub fn attributes(&self) -> impl Iterator<Item = (&str, &str)> {
        self.attributes.iter().map(|(name, value)| (name.as_str(), value.as_str()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_fit_the_window_and_names_are_unique() {
        let window = Window { x: 2, y: 1, width: 3, height: 2 };
        let mut frame = Frame::new([8, 8], window, None).unwrap();
        assert!(frame.push_channel("R", vec![0.0; 5]).is_err());
        frame.push_channel("R", vec![1.0; 6]).unwrap();
        frame.push_channel("R", vec![2.0; 6]).unwrap();
        assert_eq!(frame.channels().len(), 1);
        assert_eq!(frame.channel("R"), Some(&[2.0; 6][..]));
        assert_eq!(frame.rgb().unwrap_err(), ImageError::NoChannel { name: "G".into() });
        frame.push_channel("Y", vec![0.5; 6]).unwrap();
        assert_eq!(frame.rgb().unwrap().pixel(3), [2.0, 0.5, 0.5]);
    }

    #[test]
    fn a_window_without_pixels_is_refused() {
        assert!(Frame::new([4, 4], Window { x: 0, y: 0, width: 0, height: 4 }, None).is_err());
    }
}
