//! Small scenes that together use every shape, material, texture, light, camera, film, filter and sampler, and the files
//! that they read.
#![allow(dead_code, reason = "each test binary uses its part of this module")]
#![allow(clippy::expect_used, reason = "tests fail by panicking")]

use std::io::Cursor;
use steradian::color::ColorSpaceKind;
use steradian::image::{Frame, FrameFormat, SampleDepth, write_frame};
use steradian::scene::MemoryFiles;

/// A scene and what it is about.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Specimen {
    pub(crate) name: &'static str,
    pub(crate) text: &'static str,
}

/// All specimens; each compiles without errors.
pub(crate) const SPECIMENS: [Specimen; 7] = [
    Specimen { name: "quadrics", text: include_str!("../specimens/quadrics.pbrt") },
    Specimen { name: "meshes", text: include_str!("../specimens/meshes.pbrt") },
    Specimen { name: "materials", text: include_str!("../specimens/materials.pbrt") },
    Specimen { name: "textures", text: include_str!("../specimens/textures.pbrt") },
    Specimen { name: "lights", text: include_str!("../specimens/lights.pbrt") },
    Specimen { name: "motion", text: include_str!("../specimens/motion.pbrt") },
    Specimen { name: "curves", text: include_str!("../specimens/curves.pbrt") },
];

/// A text file that the specimens read.
const TEXTS: [(&str, &str); 4] = [
    ("part.pbrt", "Translate 0 0 1\nShape \"disk\" \"float radius\" .5\n"),
    (
        "imported.pbrt",
        "AttributeBegin\nMaterial \"diffuse\" \"rgb reflectance\" [.2 .4 .6]\nShape \"sphere\" \"float radius\" .2\nAttributeEnd\n",
    ),
    ("glass.spd", "# index of refraction\n360 1.55\n550 1.52 # green\n830 1.5\n"),
    (
        "quad.ply",
        "ply\nformat ascii 1.0\ncomment a square and a triangle\nelement vertex 5\nproperty float x\nproperty float y\n\
         property float z\nproperty float u\nproperty float v\nelement face 2\nproperty list uchar int vertex_indices\n\
         end_header\n0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n.5 2 .1 .5 1\n4 0 1 2 3\n3 3 2 4\n",
    ),
];

/// The files that the specimens read, by name.
pub(crate) fn files() -> Vec<(&'static str, Vec<u8>)> {
    let mut files: Vec<(&str, Vec<u8>)> = TEXTS.iter().map(|(n, t)| (*n, t.as_bytes().to_vec())).collect();
    files.push(("triangle.ply", binary_ply()));
    files.push(("square.exr", encoded(8, 8, FrameFormat::Exr(SampleDepth::Float))));
    files.push(("sky.pfm", encoded(8, 4, FrameFormat::Pfm)));
    files.push(("square.png", encoded(8, 8, FrameFormat::Png)));
    files.push(("normals.png", encoded(4, 4, FrameFormat::Png)));
    for (name, format) in [
        ("photo.jpg", image::ImageFormat::Jpeg),
        ("old.tga", image::ImageFormat::Tga),
        ("plain.bmp", image::ImageFormat::Bmp),
    ] {
        let picture = image::RgbImage::from_fn(8, 6, |x, y| image::Rgb([(x * 30) as u8, (y * 40) as u8, 90]));
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, format).expect("the codec is built in");
        files.push((name, bytes.into_inner()));
    }
    let radiance = image::Rgb32FImage::from_fn(8, 8, |x, y| image::Rgb([x as f32, y as f32, 0.5]));
    let mut bytes = Cursor::new(Vec::new());
    radiance.write_to(&mut bytes, image::ImageFormat::Hdr).expect("the codec is built in");
    files.push(("old.hdr", bytes.into_inner()));
    files
}

/// The same as a file system.
pub(crate) fn file_system(files: &[(&'static str, Vec<u8>)]) -> MemoryFiles {
    files.iter().fold(MemoryFiles::new(), |system, (name, bytes)| system.with(*name, bytes.clone()))
}

fn encoded(width: u32, height: u32, format: FrameFormat) -> Vec<u8> {
    let n = (width * height) as f32;
    let pixel = |i: usize| [1.0, 0.5, 0.25].map(|k| 0.1 + 0.8 * k * i as f32 / n);
    let frame = Frame::from_rgb([width, height], ColorSpaceKind::Srgb, pixel).expect("there are pixels");
    let mut bytes = Cursor::new(Vec::new());
    write_frame(&frame, &mut bytes, format).expect("memory can be written");
    bytes.into_inner()
}

fn binary_ply() -> Vec<u8> {
    let mut bytes =
        b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
        property float z\nproperty float nx\nproperty float ny\nproperty float nz\nelement face 1\n\
        property list uchar int vertex_indices\nend_header\n"
            .to_vec();
    for corner in [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]] {
        for v in corner.into_iter().chain([0.0, 0.0, 1.0]) {
            bytes.extend(v.to_le_bytes());
        }
    }
    bytes.push(3);
    for index in [0_i32, 1, 2] {
        bytes.extend(index.to_le_bytes());
    }
    bytes
}
