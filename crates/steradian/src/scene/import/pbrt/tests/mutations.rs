//! Damaged scenes: whatever the bytes, the importer answers and does not panic.

use super::import_with;
use crate::math::hash::Pcg32;
use crate::scene::files::MemoryFiles;
use crate::scene::import::pbrt::{Input, import};
use std::path::Path;

const SCENES: [&str; 4] = [
    "LookAt 0 0 5 0 0 0 0 1 0\nCamera \"perspective\" \"float fov\" [ 45 ]\nFilm \"rgb\" \"integer xresolution\" 64\n\
     Sampler \"zsobol\" \"integer pixelsamples\" 4\nWorldBegin\nAttributeBegin\nTranslate 1 2 3 # comment\n\
     AreaLightSource \"diffuse\" \"blackbody L\" 5500\nShape \"sphere\" \"float radius\" 2\nAttributeEnd\n\
     LightSource \"infinite\" \"rgb L\" [ 1 1 1 ] \"float scale\" 2\n",
    "WorldBegin\nTexture \"a\" \"spectrum\" \"checkerboard\" \"rgb tex1\" [.1 .2 .3] \"float uscale\" 4\n\
     MakeNamedMaterial \"m\" \"string type\" \"coateddiffuse\" \"texture reflectance\" \"a\" \"bool remaproughness\" false\n\
     NamedMaterial \"m\"\nShape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0] \"integer indices\" [0 1 2 2 1 3]\n\
     \"point2 uv\" [0 0 1 0 0 1 1 1]\n",
    "Transform [1 0 0 0 0 1 0 0 0 0 1 0 0 0 4 1]\nWorldBegin\nObjectBegin \"o\"\nShape \"disk\" \"float radius\" 1\n\
     ObjectEnd\nActiveTransform EndTime Rotate 90 0 0 1 ActiveTransform All\nObjectInstance \"o\"\n\
     Include \"part.pbrt\" Import \"part.pbrt\"\nMaterial \"mix\" \"string materials\" [\"p\" \"p\"]\nShape \"cylinder\"\n",
    "Option \"disablepixeljitter\" true\nColorSpace \"rec2020\"\nWorldBegin\nAttribute \"shape\" \"float radius\" 3\n\
     Material \"conductor\" \"spectrum eta\" \"metal-Au-eta\" \"spectrum k\" [400 1 700 2.5e0]\nReverseOrientation\n\
     Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 1 0 3 1 1] \"string type\" \"flat\" \"float width\" .1\n\
     MediumInterface \"\" \"\" Shape \"loopsubdiv\" \"integer indices\" [0 1 2] \"point3 P\" [0 0 0 1 0 0 0 1 0]\n",
];

fn below(r: &mut Pcg32, n: usize) -> usize {
    r.next_u32() as usize % n.max(1)
}

fn mutate(bytes: &mut Vec<u8>, r: &mut Pcg32) {
    let at = below(r, bytes.len());
    let until = (at + 1 + below(r, 24)).min(bytes.len());
    match below(r, 7) {
        0 => bytes[at] = below(r, 256) as u8,
        1 => bytes[at] ^= 1 << below(r, 8),
        2 => drop(bytes.drain(at..until)),
        3 => bytes.truncate(at),
        4 => {
            let copy = bytes[at..until].to_vec();
            let to = below(r, bytes.len());
            bytes.splice(to..to, copy);
        }
        5 => {
            let mut words: Vec<&[u8]> = bytes.split(|b| *b == b' ').collect();
            let (a, b) = (below(r, words.len()), below(r, words.len()));
            words.swap(a, b);
            *bytes = words.join(&b' ');
        }
        _ => {
            let odd: [&[u8]; 8] =
                [b"[", b"]", b"\"", b"1e999", b"-0", b"\\", b" AttributeBegin ", b" \"float alpha\" 0 "];
            let with = odd[below(r, odd.len())];
            bytes.splice(at..at, with.iter().copied());
        }
    }
    if bytes.is_empty() {
        bytes.push(b' ');
    }
}

#[test]
fn damaged_scenes_are_answered() {
    let part = "AttributeBegin Material \"diffuse\" Shape \"sphere\" AttributeEnd MakeNamedMaterial \"p\" \"string type\" \"diffuse\"";
    let (mut whole, mut refused) = (0, 0);
    for case in 0..4000_u64 {
        let r = &mut Pcg32::new(case, 0);
        let mut main = SCENES[below(r, SCENES.len())].as_bytes().to_vec();
        let mut part = part.as_bytes().to_vec();
        for _ in 0..=below(r, 4) {
            if below(r, 5) == 0 {
                mutate(&mut part, r);
            } else {
                mutate(&mut main, r);
            }
        }
        let files = MemoryFiles::new().with("part.pbrt", part);
        let imported = import(&[Input::Text { name: "main", bytes: &main, base: Path::new("") }], &files);
        // Rendering the messages visits every span.
        let text = imported.diagnostics.display(&imported.sources).to_string();
        assert_eq!(imported.scene.is_none(), imported.diagnostics.has_errors(), "case {case}: {text}");
        match imported.scene {
            Some(_) => whole += 1,
            None => refused += 1,
        }
    }
    // Some mutations hit comments, names or digits and leave a valid scene.
    assert!(whole > 100 && refused > 2000, "{whole} whole, {refused} refused");
}

#[test]
fn undamaged_specimens_are_right() {
    let files = MemoryFiles::new().with("part.pbrt", "Shape \"sphere\"");
    for text in [SCENES[0], SCENES[1], SCENES[3]] {
        let imported = import_with(text, &files);
        assert!(imported.diagnostics.is_empty(), "{}", imported.diagnostics.display(&imported.sources));
    }
}
