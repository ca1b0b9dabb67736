//! A decoded picture: texels in their stored precision, read as linear values.

use super::encoding::{ColorEncoding, Quantizer};
use super::error::ImageError;
use super::wrap::Wrap;
use crate::color::{ColorSpaceKind, Rgb};
use crate::math::{Vec2, Vec3};
use exr::prelude::f16;

/// What the channels of a picture are.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Layout {
    /// One channel.
    Gray,
    /// Red, green, blue.
    Rgb,
    /// Red, green, blue and alpha, not premultiplied by this library.
    Rgba,
}

impl Layout {
    /// Channels per texel.
    pub const fn channels(self) -> usize {
        match self {
            Self::Gray => 1,
            Self::Rgb => 3,
            Self::Rgba => 4,
        }
    }
}

/// Texels in the precision of their file.
#[derive(Clone, Debug)]
enum Texels {
    /// 8-bit codes; `linear` holds the decoded value of each code.
    U8 {
        codes: Vec<u8>,
        encoding: ColorEncoding,
        linear: Box<[f32; 256]>,
    },
    F16(Vec<f16>),
    F32(Vec<f32>),
}

/// A picture in memory. Row 0 is the top; texel (x, y) covers [x, x+1) × [y, y+1).
///
/// 8-bit pictures stay 8-bit and are decoded per lookup through a table of 256 values. The encoding
/// applies to the alpha channel as well, as in pbrt-v4.
#[derive(Clone, Debug)]
pub struct Image {
    width: u32,
    height: u32,
    layout: Layout,
    texels: Texels,
    color_space: ColorSpaceKind,
}

/// Four texels and their bilinear weights; `None` lies in the black.
type Taps = [(Option<usize>, f32); 4];

/// Four texels of which none lies beyond an edge.
struct Inside {
    /// Where the left texel of the upper and of the lower row begins.
    rows: [usize; 2],
    /// From the left texel to the right one, in [0, 1).
    dx: f32,
    /// From the upper row to the lower one, in [0, 1).
    dy: f32,
}

impl Image {
    /// A picture from 8-bit codes, channels interleaved, rows from the top.
    ///
    /// # Errors
    /// When a side is zero or the number of codes does not fit the size.
    pub fn from_u8(
        width: u32,
        height: u32,
        layout: Layout,
        codes: Vec<u8>,
        encoding: ColorEncoding,
    ) -> Result<Self, ImageError> {
        check_len(width, height, layout, codes.len())?;
        let texels = Texels::U8 { codes, encoding, linear: encoding.table() };
        Ok(Self { width, height, layout, texels, color_space: ColorSpaceKind::Srgb })
    }

    /// A picture from linear half-precision values, channels interleaved, rows from the top.
    ///
    /// # Errors
    /// When a side is zero or the number of values does not fit the size.
    pub fn from_f16(width: u32, height: u32, layout: Layout, values: Vec<f16>) -> Result<Self, ImageError> {
        check_len(width, height, layout, values.len())?;
        Ok(Self { width, height, layout, texels: Texels::F16(values), color_space: ColorSpaceKind::Srgb })
    }

    /// A picture from linear values, channels interleaved, rows from the top.
    ///
    /// # Errors
    /// When a side is zero or the number of values does not fit the size.
    pub fn from_f32(width: u32, height: u32, layout: Layout, values: Vec<f32>) -> Result<Self, ImageError> {
        check_len(width, height, layout, values.len())?;
        Ok(Self { width, height, layout, texels: Texels::F32(values), color_space: ColorSpaceKind::Srgb })
    }

    /// A picture of the same storage (precision and encoding) as this one from linear values.
    pub(crate) fn like(&self, width: u32, height: u32, linear: &[f32]) -> Result<Self, ImageError> {
        let l = self.layout;
        let image = match &self.texels {
            Texels::U8 { encoding, .. } => {
                let quantizer = Quantizer::new(*encoding);
                let codes = linear.iter().map(|&v| quantizer.code(v)).collect();
                Self::from_u8(width, height, l, codes, *encoding)
            }
            Texels::F16(_) => {
                Self::from_f16(width, height, l, linear.iter().map(|&v| f16::from_f32(v)).collect())
            }
            Texels::F32(_) => Self::from_f32(width, height, l, linear.to_vec()),
        }?;
        Ok(image.with_color_space(self.color_space))
    }

    /// The same texels, understood in another colour space.
    #[must_use]
    pub fn with_color_space(self, color_space: ColorSpaceKind) -> Self {
        Self { color_space, ..self }
    }

    /// The primaries of red, green and blue; sRGB unless the file says otherwise.
    pub fn color_space(&self) -> ColorSpaceKind {
        self.color_space
    }

    /// Width [px], not zero.
    pub fn width(&self) -> u32 {
        self.width
    }

    /// Height [px], not zero.
    pub fn height(&self) -> u32 {
        self.height
    }

    /// What the channels are.
    pub fn layout(&self) -> Layout {
        self.layout
    }

    /// Memory of the texels [B].
    pub fn bytes(&self) -> usize {
        match &self.texels {
            Texels::U8 { codes, .. } => codes.len(),
            Texels::F16(v) => v.len() * 2,
            Texels::F32(v) => v.len() * 4,
        }
    }

    /// Linear value of channel `c` at texel (x, y). Coordinates beyond the picture are a broken invariant.
    pub fn texel(&self, x: u32, y: u32, c: usize) -> f32 {
        debug_assert!(x < self.width && y < self.height && c < self.layout.channels());
        self.value(self.base(x, y) + c)
    }

    /// Linear red, green and blue at texel (x, y); a gray picture has three equal values.
    pub fn rgb(&self, x: u32, y: u32) -> Rgb {
        self.rgb_at(self.base(x, y))
    }

    /// The one number that a float texture reads at texel (x, y): the value of a gray picture, the mean of an
    /// RGB one, the alpha of an RGBA one.
    ///
    /// This is pbrt-v4's rule for interpolated lookups, made for cut-out masks that come as RGBA pictures. For
    /// lookups of single texels (nearest, EWA) pbrt reads the first channel instead; we keep one rule, so that
    /// the filter does not change what is filtered.
    pub fn scalar(&self, x: u32, y: u32) -> f32 {
        self.scalar_at(self.base(x, y))
    }

    /// [`Image::rgb`] at coordinates that may lie beyond the picture, where `wrap` decides.
    pub fn rgb_wrapped(&self, x: i32, y: i32, wrap: Wrap) -> Rgb {
        wrap.resolve(x, y, self.width, self.height).map_or(Rgb::default(), |[x, y]| self.rgb(x, y))
    }

    /// [`Image::scalar`] at coordinates that may lie beyond the picture, where `wrap` decides.
    pub fn scalar_wrapped(&self, x: i32, y: i32, wrap: Wrap) -> f32 {
        wrap.resolve(x, y, self.width, self.height).map_or(0.0, |[x, y]| self.scalar(x, y))
    }

    /// Bilinear interpolation of [`Image::rgb`] at `st`, where [0, 1]² is the picture and t points down.
    pub fn bilerp_rgb(&self, st: Vec2, wrap: Wrap) -> Rgb {
        // Chosen once, not for each channel of each texel.
        match (&self.texels, self.layout) {
            (_, Layout::Gray) => Rgb(Vec3::splat(self.bilerp_scalar(st, wrap))),
            (Texels::U8 { codes, linear, .. }, Layout::Rgb | Layout::Rgba) => {
                self.blend(codes, st, wrap, |code| linear[usize::from(code)])
            }
            (Texels::F16(v), Layout::Rgb | Layout::Rgba) => self.blend(v, st, wrap, f16::to_f32),
            (Texels::F32(v), Layout::Rgb | Layout::Rgba) => self.blend(v, st, wrap, |v| v),
        }
    }

    /// The first three channels between the four texels around `st`.
    #[inline]
    fn blend<T: Copy>(&self, values: &[T], st: Vec2, wrap: Wrap, linear: impl Fn(T) -> f32) -> Rgb {
        let color = |[r, g, b]: [T; 3]| Vec3::new(linear(r), linear(g), linear(b));
        if let Some(Inside { rows, dx, dy }) = self.inside(st, wrap) {
            let channels = self.layout.channels();
            let row = |first: usize| {
                let texels = values.get(first..first + 2 * channels)?;
                let (&left, &right) = (texels.first_chunk()?, texels.get(channels..)?.first_chunk()?);
                Some(color(left) * (1.0 - dx) + color(right) * dx)
            };
            if let (Some(upper), Some(lower)) = (row(rows[0]), row(rows[1])) {
                return Rgb(upper * (1.0 - dy) + lower * dy);
            }
        }
        let mut sum = Vec3::ZERO;
        for (base, weight) in self.taps(st, wrap) {
            if let Some(&texel) = base.and_then(|base| values.get(base..)).and_then(<[T]>::first_chunk) {
                sum += color(texel) * weight;
            }
        }
        Rgb(sum)
    }

    /// The four texels around `st` where they lie side by side in one copy of the picture, as nearly all do.
    #[inline]
    fn inside(&self, st: Vec2, wrap: Wrap) -> Option<Inside> {
        let st = if wrap == Wrap::REPEAT { st.map(tiled) } else { st };
        let (x, y) = (st.x * self.width as f32 - 0.5, st.y * self.height as f32 - 0.5);
        let within = |x: f32, n: u32| x >= 0.0 && x < (n - 1) as f32;
        (within(x, self.width) && within(y, self.height)).then(|| {
            let first = self.base(x as u32, y as u32);
            let rows = [first, first + self.width as usize * self.layout.channels()];
            Inside { rows, dx: x - x as u32 as f32, dy: y - y as u32 as f32 }
        })
    }

    /// Bilinear interpolation of [`Image::scalar`] at `st`, where [0, 1]² is the picture and t points down.
    pub fn bilerp_scalar(&self, st: Vec2, wrap: Wrap) -> f32 {
        let mut sum = 0.0;
        for (base, weight) in self.taps(st, wrap) {
            if let Some(base) = base {
                sum += self.scalar_at(base) * weight;
            }
        }
        sum
    }

    /// Bilinear interpolation of channel `c` at `st`, where [0, 1]² is the picture and t points down.
    pub fn bilerp_channel(&self, st: Vec2, c: usize, wrap: Wrap) -> f32 {
        debug_assert!(c < self.layout.channels());
        let mut sum = 0.0;
        for (base, weight) in self.taps(st, wrap) {
            if let Some(base) = base {
                sum += self.value(base + c) * weight;
            }
        }
        sum
    }

    /// Whether alpha is one everywhere, or there is none.
    pub fn is_opaque(&self) -> bool {
        self.layout != Layout::Rgba
            || (0..self.width as usize * self.height as usize).all(|i| self.value(i * 4 + 3) == 1.0)
    }

    /// The same picture without an alpha channel.
    #[must_use]
    pub fn without_alpha(self) -> Self {
        fn drop<T: Copy>(v: Vec<T>) -> Vec<T> {
            v.chunks_exact(4).flat_map(|t| [t[0], t[1], t[2]]).collect()
        }
        if self.layout != Layout::Rgba {
            return self;
        }
        let texels = match self.texels {
            Texels::U8 { codes, encoding, linear } => Texels::U8 { codes: drop(codes), encoding, linear },
            Texels::F16(v) => Texels::F16(drop(v)),
            Texels::F32(v) => Texels::F32(drop(v)),
        };
        Self { layout: Layout::Rgb, texels, ..self }
    }

    /// Column, row and value of the first channel that is infinite or not a number, if there is one.
    pub fn first_not_finite(&self) -> Option<(u32, u32, f32)> {
        let found = match &self.texels {
            Texels::U8 { .. } => None,
            Texels::F16(v) => v.iter().position(|v| !v.is_finite()),
            Texels::F32(v) => v.iter().position(|v| !v.is_finite()),
        };
        found.map(|i| {
            let texel = (i / self.layout.channels()) as u32;
            (texel % self.width, texel / self.width, self.value(i))
        })
    }

    /// All linear values, channels interleaved, rows from the top.
    pub fn to_linear(&self) -> Vec<f32> {
        (0..self.width as usize * self.height as usize * self.layout.channels())
            .map(|i| self.value(i))
            .collect()
    }

    /// Writes the linear values of row `y`, channels interleaved, to `out`, which has as many.
    pub(super) fn read_row(&self, y: u32, out: &mut [f32]) {
        let values = self.base(0, y)..self.base(0, y) + self.width as usize * self.layout.channels();
        match &self.texels {
            Texels::U8 { codes, linear, .. } => {
                out.iter_mut().zip(&codes[values]).for_each(|(out, &code)| *out = linear[usize::from(code)]);
            }
            Texels::F16(v) => out.iter_mut().zip(&v[values]).for_each(|(out, v)| *out = v.to_f32()),
            Texels::F32(v) => out.copy_from_slice(&v[values]),
        }
    }

    fn taps(&self, st: Vec2, wrap: Wrap) -> Taps {
        let (x, y) = (st.x * self.width as f32 - 0.5, st.y * self.height as f32 - 0.5);
        let (x0, y0) = (x.floor(), y.floor());
        let (dx, dy) = (x - x0, y - y0);
        let (x0, y0) = (x0 as i32, y0 as i32);
        let (x1, y1) = (x0.saturating_add(1), y0.saturating_add(1));
        let weights = [(1.0 - dx) * (1.0 - dy), dx * (1.0 - dy), (1.0 - dx) * dy, dx * dy];
        let bases = match wrap {
            Wrap::Axes { s, t } => {
                // Each axis by itself: two columns and two rows.
                let ([c0, c1], [r0, r1]) =
                    (s.resolve_both([x0, x1], self.width), t.resolve_both([y0, y1], self.height));
                let at = |x: Option<u32>, y: Option<u32>| Some(self.base(x?, y?));
                [at(c0, r0), at(c1, r0), at(c0, r1), at(c1, r1)]
            }
            Wrap::OctahedralSphere => {
                let at = |x, y| wrap.resolve(x, y, self.width, self.height).map(|[x, y]| self.base(x, y));
                [at(x0, y0), at(x1, y0), at(x0, y1), at(x1, y1)]
            }
        };
        std::array::from_fn(|i| (bases[i], weights[i]))
    }

    fn base(&self, x: u32, y: u32) -> usize {
        (y as usize * self.width as usize + x as usize) * self.layout.channels()
    }

    /// Linear value of the i-th sample in storage order.
    fn value(&self, i: usize) -> f32 {
        match &self.texels {
            Texels::U8 { codes, linear, .. } => linear[usize::from(codes[i])],
            Texels::F16(v) => v[i].to_f32(),
            Texels::F32(v) => v[i],
        }
    }

    fn rgb_at(&self, base: usize) -> Rgb {
        match self.layout {
            Layout::Gray => Rgb::new(self.value(base), self.value(base), self.value(base)),
            Layout::Rgb | Layout::Rgba => {
                Rgb::new(self.value(base), self.value(base + 1), self.value(base + 2))
            }
        }
    }

    fn scalar_at(&self, base: usize) -> f32 {
        match self.layout {
            Layout::Gray => self.value(base),
            Layout::Rgb => self.rgb_at(base).0.element_sum() / 3.0,
            Layout::Rgba => self.value(base + 3),
        }
    }
}

/// What is left of a coordinate of tiles, in [0, 1]; anything where an integer cannot hold the number of tiles.
#[inline]
fn tiled(x: f32) -> f32 {
    let rest = x - x as i32 as f32;
    if rest < 0.0 { rest + 1.0 } else { rest }
}

fn check_len(width: u32, height: u32, layout: Layout, found: usize) -> Result<(), ImageError> {
    let channels = layout.channels();
    let expected = u64::from(width) * u64::from(height) * channels as u64;
    // Texel coordinates are i32 and grow by one beyond the edge.
    let side = 1..=i32::MAX as u32 / 2;
    if side.contains(&width) && side.contains(&height) && expected == found as u64 {
        Ok(())
    } else {
        Err(ImageError::WrongSize { width, height, channels, found })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn ramp() -> Image {
        // value = 10 y + x + c/10
        let values = (0..4 * 3 * 3)
            .map(|i| {
                let (pixel, c) = (i / 3, i % 3);
                (10 * (pixel / 4) + pixel % 4) as f32 + c as f32 / 10.0
            })
            .collect();
        Image::from_f32(4, 3, Layout::Rgb, values).unwrap()
    }

    #[test]
    fn interpolation_meets_texel_centres_and_is_linear_between() {
        let image = ramp();
        for y in 0..3 {
            for x in 0..4 {
                let st = Vec2::new((x as f32 + 0.5) / 4.0, (y as f32 + 0.5) / 3.0);
                assert!((image.bilerp_rgb(st, Wrap::CLAMP).0 - image.rgb(x, y).0).abs().max_element() < 1e-5);
            }
        }
        let st = Vec2::new(1.75 / 4.0, 1.0 / 3.0);
        // x = 1.25, y = 0.5 in texel centres: 10·0.5 + 1.25.
        assert!((image.bilerp_channel(st, 0, Wrap::CLAMP) - 6.25).abs() < 1e-5);
    }

    #[test]
    fn beyond_the_edge_each_wrap_does_as_it_says() {
        let image = ramp();
        let left = Vec2::new(-0.125, 0.5);
        assert!((image.bilerp_channel(left, 0, Wrap::CLAMP) - 10.0).abs() < 1e-5);
        assert!((image.bilerp_channel(left, 0, Wrap::REPEAT) - 13.0).abs() < 1e-5);
        assert_eq!(image.bilerp_channel(left, 0, Wrap::BLACK), 0.0);
        // On the edge itself black fades in: half of the texel's value.
        assert!((image.bilerp_channel(Vec2::new(0.0, 0.5), 0, Wrap::BLACK) - 5.0).abs() < 1e-5);
    }

    #[test]
    fn the_scalar_is_the_gray_value_the_mean_of_rgb_or_alpha() {
        let scalar = |layout, values| Image::from_f32(1, 1, layout, values).unwrap().scalar(0, 0);
        assert_eq!(scalar(Layout::Gray, vec![0.7]), 0.7);
        assert_eq!(scalar(Layout::Rgb, vec![0.25, 0.5, 0.75]), 0.5);
        assert_eq!(scalar(Layout::Rgba, vec![0.25, 0.5, 0.75, 0.125]), 0.125);
    }

    #[test]
    fn dropping_alpha_keeps_the_colours() {
        let image =
            Image::from_f32(2, 1, Layout::Rgba, vec![1.0, 2.0, 3.0, 1.0, 4.0, 5.0, 6.0, 1.0]).unwrap();
        assert!(image.is_opaque());
        let rgb = image.without_alpha();
        assert_eq!(rgb.to_linear(), [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]);
    }

    #[test]
    fn sizes_that_do_not_fit_are_refused() {
        assert!(Image::from_f32(2, 2, Layout::Rgb, vec![0.0; 11]).is_err());
        assert!(Image::from_f32(0, 2, Layout::Rgb, vec![]).is_err());
    }

    proptest! {
        #[test]
        fn interpolation_stays_within_the_texels_wherever_it_is_asked(
            s in prop_oneof![-3.0_f32..3.0, -1e12_f32..1e12],
            t in prop_oneof![-3.0_f32..3.0, -1e12_f32..1e12],
        ) {
            let image = ramp();
            for wrap in [Wrap::REPEAT, Wrap::CLAMP, Wrap::BLACK, Wrap::OctahedralSphere] {
                let v = image.bilerp_channel(Vec2::new(s, t), 0, wrap);
                prop_assert!((-1e-4..=23.0 + 1e-4).contains(&v), "{wrap:?}: {v}");
            }
        }
    }
}
