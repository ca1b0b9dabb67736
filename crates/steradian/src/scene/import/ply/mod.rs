//! PLY meshes from bytes: ASCII and both binary orders, triangles and quadrilaterals.
//!
//! Files as programs write them go through `regular`, which gives up at the first thing out of the ordinary; then
//! `general` has the last word, and the words for what is wrong.

mod general;
mod header;
mod mesh;
mod regular;

pub use mesh::{Place, PlyError, PlyMesh};

use header::Header;

/// Reads a mesh.
///
/// # Errors
/// Everything that does not follow the format; an index that no vertex has; a coordinate that is not finite; a face
/// that has neither three nor four corners. Nothing larger than the file is allocated on the word of its header.
pub fn parse(bytes: &[u8]) -> Result<PlyMesh, PlyError> {
    let (header, body) = Header::parse(bytes)?;
    regular::read(&header, body).map_or_else(|| general::read(&header, body), Ok)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Point, Vec2};
    use proptest::prelude::*;

    const HEADER: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n\
        property double s\nproperty double t\nproperty uchar red\nelement face 2\n\
        property list uchar int vertex_indices\nproperty int face_indices\nend_header\n";
    const VERTICES: [[f64; 5]; 4] = [
        [0.0, 0.0, 0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0, 1.0, 0.0],
        [1.0, 1.0, 0.5, 1.0, 1.0],
        [0.0, 1.0, 0.0, 0.0, 1.0],
    ];

    fn ascii() -> String {
        let mut text = format!("ply\nformat ascii 1.0\ncomment made by hand\n{HEADER}");
        for [x, y, z, s, t] in VERTICES {
            text += &format!("{x} {y} {z} {s} {t} 255\n");
        }
        text + "3 0 1 2 7\n4 0 1 2 3 9\n"
    }

    fn binary(little: bool) -> Vec<u8> {
        let name = if little { "binary_little_endian" } else { "binary_big_endian" };
        let mut out = format!("ply\r\nformat {name} 1.0\r\n{}", HEADER.replace('\n', "\r\n")).into_bytes();
        let mut put = |le: &[u8]| {
            if little { out.extend(le) } else { out.extend(le.iter().rev()) }
        };
        for [x, y, z, s, t] in VERTICES {
            [x, y, z].iter().for_each(|v| put(&(*v as f32).to_le_bytes()));
            [s, t].iter().for_each(|v| put(&v.to_le_bytes()));
            put(&[255]);
        }
        for (face, number) in [(&[0, 1, 2][..], 7), (&[0, 1, 2, 3][..], 9)] {
            put(&[face.len() as u8]);
            face.iter().for_each(|v: &i32| put(&v.to_le_bytes()));
            put(&i32::to_le_bytes(number));
        }
        out
    }

    #[test]
    fn all_three_encodings_give_the_same_mesh() {
        let mesh = parse(ascii().as_bytes()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
        assert_eq!(mesh.quads, [[0, 1, 3, 2]], "a quad becomes a patch with corners in (u, v) order");
        assert_eq!((&mesh.triangle_numbers[..], &mesh.quad_numbers[..]), (&[7][..], &[9][..]));
        assert_eq!(mesh.positions[2], Point::new(1.0, 1.0, 0.5));
        assert_eq!(mesh.uvs[3], Vec2::new(0.0, 1.0));
        assert!(mesh.normals.is_empty());
        assert_eq!(parse(&binary(true)).unwrap(), mesh);
        assert_eq!(parse(&binary(false)).unwrap(), mesh);
    }

    fn message(text: &str) -> String {
        parse(text.as_bytes()).unwrap_err().to_string()
    }

    #[test]
    fn faults_are_named_with_their_place() {
        let good = ascii();
        assert_eq!(message("solid"), "the header does not end");
        assert_eq!(message("solid x\n"), "this is not a PLY file");
        assert_eq!(
            message(&good.replace("3 0 1 2 7", "3 0 1 4 7")),
            "face 0: vertex index 4 is out of range: there are 4 vertices"
        );
        assert_eq!(
            message(&good.replace("3 0 1 2 7", "3 0 -1 2 7")),
            "face 0: vertex index -1 is out of range"
        );
        assert_eq!(
            message(&good.replace("3 0 1 2 7", "2 0 1 7")),
            "face 0: 2 corners; only 3 and 4 are supported"
        );
        assert_eq!(message(&good.replace("0.5", "nan")), "vertex 2: position [1, 1, NaN] is not finite");
        assert_eq!(message(&good.replace("0.5", "half")), "vertex 2: \"half\" is no number");
        assert_eq!(message(good.trim_end_matches("9\n")), "face 1: the file ends here");
        assert_eq!(
            message(&good.replace("property float z\n", "")),
            "the header gives vertices no x, y and z"
        );
        assert_eq!(message(&good.replace("float x", "quad x")), "line 5 of the header: unknown type");
        assert_eq!(
            message(&good.replace("element face 2", "element face 999999999999")),
            "the header promises 999999999999 of element \"face\", more than the file has room for"
        );
    }

    /// A file of those faces among five vertices, in the words or bytes of a program.
    fn regular_file(format: &str, faces: &[Vec<u32>], extra: bool) -> Vec<u8> {
        let (word, number) = if extra { (" 7", "property int face_indices\n") } else { ("", "") };
        let mut out = format!(
            "ply\nformat {format} 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
            property float nx\nproperty float ny\nproperty float nz\nproperty float u\nproperty float v\n\
            element face {}\nproperty list uchar int vertex_indices\n{number}end_header\n",
            faces.len()
        )
        .into_bytes();
        let vertices: Vec<f32> = (0..40).map(|i| (i as f32 - 20.0) / 7.0).collect();
        if format == "ascii" {
            vertices
                .chunks(8)
                .for_each(|row| out.extend(format!("{row:?}\n").replace(['[', ']', ','], " ").bytes()));
            faces.iter().for_each(|f| {
                out.extend(format!("{} {f:?}{word}\n", f.len()).replace(['[', ']', ','], "").bytes());
            });
        } else {
            vertices.iter().for_each(|v| out.extend(v.to_le_bytes()));
            for f in faces {
                out.push(f.len() as u8);
                f.iter().for_each(|i| out.extend(i.to_le_bytes()));
                out.extend(&7_i32.to_le_bytes()[..if extra { 4 } else { 0 }]);
            }
        }
        out
    }

    /// What both ways make of a file: `None` for the regular one where it leaves the matter to the other.
    fn both(bytes: &[u8]) -> (Option<String>, Result<String, PlyError>) {
        // As text, in which a NaN equals itself.
        let shown = |m: PlyMesh| format!("{m:?}");
        let (header, body) = Header::parse(bytes).unwrap();
        (regular::read(&header, body).map(shown), general::read(&header, body).map(shown))
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(300))]

        #[test]
        fn the_short_way_reads_what_the_general_way_reads(
            // Runs of triangles and of quadrilaterals, longer and shorter than what is read at once.
            runs in prop::collection::vec((3_usize..=4, prop_oneof![0_usize..9, 500_usize..600]), 0..5),
            format in prop_oneof![Just("ascii"), Just("binary_little_endian")],
            extra in any::<bool>(),
            fault in prop::option::of((any::<prop::sample::Index>(), any::<u8>())),
        ) {
            let face = |(n, i): (usize, usize)| (0..n).map(|k| ((i * 3 + k) % 5) as u32).collect();
            let faces: Vec<Vec<u32>> =
                runs.iter().flat_map(|&(n, len)| (0..len).map(move |i| (n, i))).map(face).collect();
            let mut bytes = regular_file(format, &faces, extra);
            let (short, general) = both(&bytes);
            prop_assert_eq!(short, general.ok(), "a regular file needs no general way");
            // One damaged byte, and two missing ones: whatever the short way still accepts is what the general way makes of it.
            let body = bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11;
            if let Some((at, byte)) = fault {
                let at = body + at.index(bytes.len() - body);
                bytes[at] = byte;
            }
            for _ in 0..2 {
                if let (Some(short), general) = both(&bytes) {
                    prop_assert_eq!(Ok(short), general);
                }
                bytes.truncate(bytes.len() - 2);
            }
        }
    }

    #[test]
    fn no_truncation_and_no_flipped_byte_panics() {
        for little in [true, false] {
            let good = binary(little);
            for end in 0..good.len() {
                assert!(parse(&good[..end]).is_err(), "a file cut at {end} must not pass");
            }
            for i in 0..good.len() {
                let mut bad = good.clone();
                bad[i] ^= 0xff;
                let _ = parse(&bad);
            }
        }
    }
}
