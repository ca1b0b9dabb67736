//! Pictures in the format of the Radiance system, `.hdr`, with the units and header lines that its programs understand.
//!
//! Radiance stores RGB radiance [W·m⁻²·sr⁻¹] for primaries of its own, and calls 179 (0.265 R + 0.670 G + 0.065 B) the
//! luminance (G. Ward, *Real Pixels*, Graphics Gems II, 1991; `color.h`). Values are written such that this is the
//! luminance in cd/m².

use super::error::ImageError;
use crate::color::Xyz;
use glam::{DMat3, DVec3};
use std::io::Write;

/// Luminous efficacy of Radiance's white [lm/W]: a convention, not a measurement.
pub const WHITE_EFFICACY: f64 = 179.0;

/// Chromaticities x, y of red, green, blue and white, to Radiance's digits.
const PRIMARIES: [[f64; 2]; 4] = [[0.64, 0.33], [0.29, 0.60], [0.15, 0.06], [0.3333, 0.3333]];

/// A view of half of all directions, in which the distance from the middle is proportional to the angle: `-vta` over 180°.
///
/// Vectors are in the space of the picture's user. Radiance takes it as right-handed and draws direction × up to the right.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FisheyeView {
    /// Where the eye is.
    pub point: [f64; 3],
    /// Where it looks, a unit vector.
    pub direction: [f64; 3],
    /// What is up, a unit vector.
    pub up: [f64; 3],
}

/// What the header says besides the format.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct RadianceHeader {
    /// Remarks, one line each.
    pub remarks: Vec<String>,
    /// The view.
    pub view: Option<FisheyeView>,
}

/// Writes tristimulus values [cd/m²], rows from the top, run-length encoded.
///
/// Colours outside of the triangle of the primaries move onto its side and keep their luminance. What is negative or not a number is
/// black. Components have 8 bits and share an exponent: luminances are right to about half a percent each and without bias on average.
///
/// # Errors
/// When the number of values does not fit the size, or writing fails.
pub fn write_radiance(
    [width, height]: [u32; 2],
    values: &[Xyz],
    header: &RadianceHeader,
    out: &mut impl Write,
) -> Result<(), ImageError> {
    if width == 0 || height == 0 {
        return Err(ImageError::Empty);
    }
    if values.len() != width as usize * height as usize {
        return Err(ImageError::WrongSize { width, height, channels: 1, found: values.len() });
    }
    write(width, height, values, header, out).map_err(|e| ImageError::Write(e.to_string()))
}

fn write(
    width: u32,
    height: u32,
    values: &[Xyz],
    header: &RadianceHeader,
    out: &mut impl Write,
) -> std::io::Result<()> {
    writeln!(out, "#?RADIANCE")?;
    for remark in &header.remarks {
        writeln!(out, "# {}", remark.replace(['\n', '\r'], " "))?;
    }
    if let Some(view) = &header.view {
        let words = |v: [f64; 3]| v.map(|x| format!("{}", x as f32)).join(" ");
        let FisheyeView { point, direction, up } = view;
        let (point, direction, up) = (words(*point), words(*direction), words(*up));
        writeln!(out, "VIEW= -vta -vp {point} -vd {direction} -vu {up} -vh 180 -vv 180")?;
    }
    writeln!(out, "EXPOSURE=1")?;
    let primaries = PRIMARIES.as_flattened().iter().map(|x| format!("{x:.4}")).collect::<Vec<_>>();
    writeln!(out, "PRIMARIES= {}", primaries.join(" "))?;
    writeln!(out, "FORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}")?;
    let to_rgb = rgb_from_xyz();
    let mut scanline = Vec::new();
    for row in values.chunks_exact(width as usize) {
        let pixels: Vec<[u8; 4]> = row.iter().map(|xyz| rgbe(rgb(&to_rgb, *xyz))).collect();
        scanline.clear();
        match u16::try_from(width) {
            // What the run-length encoding is defined for.
            Ok(w) if (8..32768).contains(&w) => {
                let [high, low] = w.to_be_bytes();
                scanline.extend([2, 2, high, low]);
                for component in 0..4 {
                    let plane: Vec<u8> = pixels.iter().map(|p| p[component]).collect();
                    encode_runs(&plane, &mut scanline);
                }
            }
            _ => scanline.extend(pixels.as_flattened()),
        }
        out.write_all(&scanline)?;
    }
    Ok(())
}

/// From tristimulus values to Radiance's RGB with Y = 1 for (1, 1, 1).
fn rgb_from_xyz() -> DMat3 {
    let column = |[x, y]: [f64; 2]| DVec3::new(x / y, 1.0, (1.0 - x - y) / y);
    let [r, g, b, white] = PRIMARIES.map(column);
    let directions = DMat3::from_cols(r, g, b);
    (directions * DMat3::from_diagonal(directions.inverse() * white)).inverse()
}

/// R, G, B [W·m⁻²·sr⁻¹] of tristimulus values [cd/m²].
fn rgb(to_rgb: &DMat3, xyz: Xyz) -> [f64; 3] {
    let xyz = xyz.0.as_dvec3();
    if !(xyz.y > 0.0 && xyz.is_finite()) {
        return [0.0; 3];
    }
    let inside = (*to_rgb * xyz).max(DVec3::ZERO);
    // The middle row of the inverse: luminance of the primaries.
    let luminance = to_rgb.inverse().row(1).dot(inside);
    let scale = if luminance > 0.0 { xyz.y / luminance } else { 0.0 };
    (inside * (scale / WHITE_EFFICACY)).to_array()
}

/// Mantissas truncated, because readers add half a step.
fn rgbe(c: [f64; 3]) -> [u8; 4] {
    let largest = c[0].max(c[1]).max(c[2]);
    if !(largest > 1e-32) {
        return [0; 4];
    }
    let mut exponent = largest.log2().floor() as i32 + 1;
    // The logarithm may round across a power of two.
    if largest >= f64::from(exponent).exp2() {
        exponent += 1;
    }
    let exponent = exponent.min(127);
    let scale = f64::from(8 - exponent).exp2();
    let mantissa = |v: f64| (v * scale).min(255.0) as u8;
    [mantissa(c[0]), mantissa(c[1]), mantissa(c[2]), (exponent + 128) as u8]
}

/// Runs of at least four equal bytes as 128 + length and the byte, all else as length and bytes.
fn encode_runs(plane: &[u8], out: &mut Vec<u8>) {
    const LEAST: usize = 4;
    const MOST: usize = 127;
    let mut i = 0;
    while i < plane.len() {
        let run = plane[i..].iter().take(MOST).take_while(|b| **b == plane[i]).count();
        if run >= LEAST {
            out.extend([128 + run as u8, plane[i]]);
            i += run;
            continue;
        }
        let start = i;
        while i < plane.len() && i - start < 128 {
            let run = plane[i..].iter().take(LEAST).take_while(|b| **b == plane[i]).count();
            if run >= LEAST {
                break;
            }
            i += 1;
        }
        out.push((i - start) as u8);
        out.extend(&plane[start..i]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::image::{ColorEncoding, decode};
    use crate::math::hash::Pcg32;

    fn written(size: [u32; 2], values: &[Xyz]) -> Vec<u8> {
        let mut bytes = Vec::new();
        let view = FisheyeView { point: [1.0, 2.0, 1.2], direction: [0.0, 1.0, 0.0], up: [0.0, 0.0, 1.0] };
        let header = RadianceHeader { remarks: vec!["a\nb".to_owned()], view: Some(view) };
        write_radiance(size, values, &header, &mut bytes).unwrap();
        bytes
    }

    /// Luminance [cd/m²] of decoded pixels, by Radiance's rule; the decoder leaves out the half step.
    fn luminance(rgb: [f32; 3]) -> f64 {
        let [r, g, b] = rgb.map(f64::from);
        179.0 * (0.265_074 * r + 0.670_115 * g + 0.064_811 * b)
    }

    #[test]
    fn luminance_survives_writing_and_reading() {
        let mut rng = Pcg32::new(3, 1);
        let size = [64, 20];
        let values: Vec<Xyz> = (0..64 * 20)
            .map(|_| {
                let y = 10f32.powf(rng.next_f32() * 8.0 - 3.0);
                Xyz::new(y * (0.8 + 0.4 * rng.next_f32()), y, y * (0.6 + 0.8 * rng.next_f32()))
            })
            .collect();
        let image = decode(&written(size, &values), "hdr", ColorEncoding::Linear).unwrap();
        assert_eq!([image.width(), image.height()], size);
        let mut bias = 0.0;
        for (i, xyz) in values.iter().enumerate() {
            let rgb = image.rgb(i as u32 % 64, i as u32 / 64).0;
            // Half a step of the mantissa: 2^(e−1−8) of the largest component.
            let half = f64::from(rgb.max_element()).log2().floor().exp2() / 256.0;
            let read = luminance(rgb.to_array()) + WHITE_EFFICACY * half;
            let relative = read / f64::from(xyz.0.y) - 1.0;
            // The largest component may be red, of which Y has less.
            assert!(relative.abs() < 6e-3, "{xyz:?}: {read}");
            bias += relative / values.len() as f64;
        }
        // 1280 errors within ±0.6 %: the mean of unbiased ones has a standard error below 1e-4; α = 1e-4.
        assert!(bias.abs() < 4e-4, "{bias}");
    }

    #[test]
    fn the_header_is_what_radiance_reads() {
        let bytes = written([8, 1], &[Xyz::new(1.0, 1.0, 1.0); 8]);
        let end = bytes.windows(2).position(|w| w == b"\n\n").unwrap();
        let text = std::str::from_utf8(&bytes[..end]).unwrap();
        assert_eq!(
            text,
            "#?RADIANCE\n# a b\nVIEW= -vta -vp 1 2 1.2 -vd 0 1 0 -vu 0 0 1 -vh 180 -vv 180\nEXPOSURE=1\n\
             PRIMARIES= 0.6400 0.3300 0.2900 0.6000 0.1500 0.0600 0.3333 0.3333\nFORMAT=32-bit_rle_rgbe"
        );
        assert!(bytes[end..].starts_with(b"\n\n-Y 1 +X 8\n\x02\x02\x00\x08\x88"));
    }

    #[test]
    fn white_of_179_candelas_is_one_watt() {
        let to_rgb = rgb_from_xyz();
        let luminances = to_rgb.inverse().row(1);
        assert!(
            (luminances - DVec3::new(0.265_074_126, 0.670_114_631, 0.064_811_243)).length() < 1e-8,
            "{luminances}"
        );
        let one = rgb(&to_rgb, Xyz::new(179.0, 179.0, 179.0));
        assert!(one.iter().all(|c| (c - 1.0).abs() < 1e-3), "{one:?}");
        assert_eq!(rgbe([1.0, 0.5, 0.0]), [128, 64, 0, 129]);
    }

    #[test]
    fn saturated_colours_keep_their_luminance() {
        let to_rgb = rgb_from_xyz();
        // Monochromatic 520 nm light, far outside of the primaries.
        let c = rgb(&to_rgb, Xyz::new(0.063_27, 0.71, 0.078_25));
        assert!(c.iter().all(|v| *v >= 0.0));
        let y = WHITE_EFFICACY * to_rgb.inverse().row(1).dot(DVec3::from_array(c));
        assert!((y - 0.71).abs() < 1e-6, "{y}");
        assert_eq!(rgb(&to_rgb, Xyz::new(f32::NAN, 1.0, 1.0)), [0.0; 3]);
    }

    #[test]
    fn runs_read_back() {
        let mut rng = Pcg32::new(5, 1);
        for width in [8_usize, 9, 127, 128, 129, 300, 1000] {
            let mut plane = Vec::new();
            while plane.len() < width {
                let run = 1 + (rng.next_f32().powi(4) * 200.0) as usize;
                plane.extend(std::iter::repeat_n((rng.next_f32() * 255.0) as u8, run));
            }
            plane.truncate(width);
            let mut code = Vec::new();
            encode_runs(&plane, &mut code);
            let (mut read, mut i) = (Vec::new(), 0);
            while i < code.len() {
                if code[i] > 128 {
                    read.extend(std::iter::repeat_n(code[i + 1], usize::from(code[i]) - 128));
                    i += 2;
                } else {
                    read.extend(&code[i + 1..=i + usize::from(code[i])]);
                    i += 1 + usize::from(code[i]);
                }
            }
            assert_eq!(read, plane, "{width}");
        }
    }

    #[test]
    fn sizes_are_checked() {
        let header = RadianceHeader::default();
        assert!(write_radiance([4, 2], &[Xyz::default(); 7], &header, &mut Vec::new()).is_err());
        assert!(write_radiance([0, 2], &[], &header, &mut Vec::new()).is_err());
    }
}
