//! Wrong scenes: the whole text of every message.

use super::{import_text, import_with, messages};
use crate::scene::files::MemoryFiles;
use crate::scene::import::pbrt::{Input, import};
use std::path::Path;

/// Checks the messages about the contents of a world, which begins on line 2.
fn expect(world: &str, expected: &[&str]) {
    let imported = import_text(&format!("WorldBegin\n{world}"));
    assert_eq!(messages(&imported), expected, "{world}");
    let any_error = expected.iter().any(|e| e.contains(": error: "));
    assert_eq!(imported.scene.is_none(), any_error, "{world}");
}

/// Checks the messages about the contents of a header, which begins on line 1.
fn expect_header(header: &str, expected: &[&str]) {
    assert_eq!(messages(&import_text(&format!("{header}\nWorldBegin\n"))), expected, "{header}");
}

#[test]
fn amounts_of_lights_are_stated_once_and_in_units_that_fit() {
    expect(
        "LightSource \"point\" \"float power\" 100 \"float watts\" 2",
        &["2:39: error: the amount is stated twice: by \"power\" and by \"watts\""],
    );
    expect(
        "LightSource \"distant\" \"float luminance\" 100",
        &["2:23: error: light \"distant\" has no parameter \"luminance\" (did you mean \"illuminance\"?)"],
    );
    expect(
        "LightSource \"infinite\" \"float luminance\" -1",
        &["2:24: error: parameter \"luminance\" must be positive, found -1"],
    );
}

#[test]
fn faults_of_photometric_lights() {
    let lamp = |more: &str| format!("LightSource \"photometric\" \"string filename\" \"a.ies\" {more}");
    let one = |more: &str, message: &str| expect(&lamp(more), &[message]);
    expect(
        "LightSource \"photometric\"",
        &["2:13: error: light \"photometric\" needs a parameter \"filename\""],
    );
    one(
        "\"string opening\" \"disk\"",
        "2:53: error: unknown opening \"disk\" (known are point and file; or state \"width\" and \"length\")",
    );
    one("\"float width\" 1", "2:53: error: an opening needs both \"width\" and \"length\"");
    one(
        "\"float flux\" 1 \"float intensity\" 1",
        "2:68: error: the amount is stated twice: by \"flux\" and by \"intensity\"",
    );
    one(
        "\"string unit\" \"intensity\"",
        "2:67: error: the file of a photometric light states candela; its spectrum is a shape",
    );
    one("\"float tilt\" -10", "2:53: error: parameter \"tilt\" must be from 0 to 180, found -10");
}

#[test]
fn faults_of_grammar() {
    expect("Shpae \"sphere\"", &["2:1: error: unknown directive `Shpae` (did you mean \"Shape\"?)"]);
    expect("Frobnicate 1 2 3", &["2:1: error: unknown directive `Frobnicate`"]);
    expect("\"loose\" Identity", &["2:1: error: expected a directive, found the string \"loose\""]);
    expect("] Identity", &["2:1: error: expected a directive, found `]`"]);
    expect("Shape sphere", &["2:7: error: expected a quoted name after `Shape`, found `sphere`"]);
    expect("Shape", &["2:6: error: expected a quoted name after `Shape`, found the end of the file"]);
    expect("Shape \"sphere", &["2:7: error: this string is not closed on its line"]);
    expect(
        "Shape \"disk\" \"float radius 2\nIdentity",
        &["2:14: error: this string is not closed on its line"],
    );
    expect(
        "Shape \"sphere\" \"float radius\" 1 2",
        &[
            "2:33: error: expected a directive, found `2` (several values of a parameter need brackets: [ 1 2 3 ])",
        ],
    );
    expect("Translate 1 2", &["2:1: error: `Translate` takes 3 numbers, found 2"]);
    expect("Rotate 1 2 3 4 5", &["2:1: error: `Rotate` takes 4 numbers, found 5"]);
    expect("Transform [ 1 0 0 ]", &["2:1: error: `Transform` takes 16 numbers, found 3"]);
    expect("Scale 1 nan 1", &["2:9: error: expected a number, found `nan` (numbers must be finite)"]);
    expect("Scale [ 1 2 3 Identity", &["2:7: error: this `[` is never closed"]);
    expect(
        "ActiveTransform Start",
        &["2:17: error: expected `StartTime`, `EndTime` or `All`, found `Start`"],
    );
    expect(
        "Shape \"a\\qb\"",
        &["2:9: error: unknown escape in a string (write `\\\\` for a backslash; in file names use `/`)"],
    );
}

#[test]
fn faults_of_values() {
    let sphere = |param: &str| format!("Shape \"sphere\" {param}");
    let one = |param: &str, message: &str| expect(&sphere(param), &[message]);
    one("\"radius\" 1", "2:16: error: expected a parameter \"type name\", found the string \"radius\"");
    one("\"flaot radius\" 1", "2:16: error: unknown parameter type \"flaot\" (did you mean \"float\"?)");
    one(
        "\"color Kd\" [1 1 1]",
        "2:16: error: unknown parameter type \"color\" (pbrt-v4 writes \"rgb\" where pbrt-v3 wrote \"color\")",
    );
    one("\"float radius\" nan", "2:31: error: expected a number, found `nan` (numbers must be finite)");
    one("\"float radius\" [ -inf ]", "2:33: error: expected a number, found `-inf` (numbers must be finite)");
    one("\"float radius\" 1e39", "2:31: error: `1e39` does not fit 32 bits");
    one("\"float radius\" 1.5x", "2:31: error: expected a number, found `1.5x`");
    one("\"float radius\" x", "2:31: error: expected a number, found `x`");
    one("\"float radius\"", "2:30: error: expected a number, found the end of the file");
    one("\"float radius\" [ 1", "2:31: error: this `[` is never closed");
    one("\"float radius\" [ 1 \"float zmin\" 0", "2:31: error: this `[` is never closed");
    one("\"float radius\" [ 1 x ]", "2:35: error: expected a number or `]`, found `x`");
    one("\"integer levels\" 1.5", "2:33: error: expected an integer, found `1.5`");
    one("\"integer levels\" 3000000000", "2:33: error: `3000000000` does not fit 32 bits");
    one("\"bool b\" 1", "2:25: error: expected true or false, found `1`");
    one("\"string s\" 1", "2:27: error: expected a quoted string, found `1`");
    one(
        "\"bool b\" \"true\"",
        "2:25: error: expected true or false, found \"true\" (write true without quotes, which only pbrt-v3 had)",
    );
    one("\"rgb c\" [ 1 2 ]", "2:24: error: \"c\" is of type rgb: it needs 3 numbers a value, found 2");
    one(
        "\"rgb c\" 1",
        "2:24: error: \"c\" is of type rgb: it needs 3 numbers a value, found 1 (several values of a parameter need brackets: [ 1 2 3 ])",
    );
    one(
        "\"spectrum s\" [ 1 2 3 ]",
        "2:29: error: \"s\" needs pairs of wavelength and value, found 3 numbers",
    );
    one("\"float radius\" [ ]", "2:31: error: parameter \"radius\" takes one value, found 0");
    one("\"float radius\" [ 1 2 ]", "2:31: error: parameter \"radius\" takes one value, found 2");
}

#[test]
fn faults_of_parameters() {
    expect(
        "Shape \"sphere\" \"float raduis\" 1",
        &["2:16: error: shape \"sphere\" has no parameter \"raduis\" (did you mean \"radius\"?)"],
    );
    expect("Shape \"sphere\" \"float x\" 1", &["2:16: error: shape \"sphere\" has no parameter \"x\""]);
    expect(
        "Shape \"sphere\" \"integer radius\" 1",
        &["2:16: error: parameter \"radius\" has type integer, expected float"],
    );
    expect(
        "Shape \"sphere\" \"rgb alpha\" [1 1 1]",
        &["2:16: error: parameter \"alpha\" has type rgb, expected float or texture"],
    );
    expect(
        "Material \"dielectric\" \"string eta\" \"glass-BK7\"",
        &["2:23: error: parameter \"eta\" has type string, expected float, spectrum, rgb or blackbody"],
    );
    expect(
        "Shape \"sphere\" \"float radius\" 1 \"float radius\" 2",
        &["2:33: error: parameter \"radius\" is given twice"],
    );
    expect(
        "Shape \"sphere\" \"float radius\" 0",
        &["2:16: error: parameter \"radius\" must be positive, found 0"],
    );
    expect("Shape \"plymesh\"", &["2:7: error: shape \"plymesh\" needs a parameter \"filename\""]);
    expect("Shape \"spehre\"", &["2:7: error: unknown shape \"spehre\" (did you mean \"sphere\"?)"]);
    expect("MakeNamedMaterial \"m\"", &["2:19: error: material \"m\" needs a parameter \"type\""]);
    expect(
        "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"a.png\" \"string wrap\" \"repaet\"",
        &["2:72: error: unknown wrap \"repaet\" (did you mean \"repeat\"?)"],
    );
    expect(
        "Texture \"t\" \"float\" \"imagemap\" \"string filename\" \"a.png\" \"string encoding\" \"gamma x\"",
        &[
            "2:76: error: unknown encoding \"gamma x\" (known are sRGB, linear, and gamma followed by a positive number)",
        ],
    );
}

#[test]
fn faults_of_spectra() {
    let one = |param: &str, message: &str| expect(&format!("Material \"diffuse\" {param}"), &[message]);
    one(
        "\"rgb reflectance\" [1.1 0 0]",
        "2:38: error: parameter \"reflectance\": rgb components must be from 0 to 1: they are fractions",
    );
    one(
        "\"rgb reflectance\" [-1 0 0]",
        "2:38: error: parameter \"reflectance\": rgb components must not be negative",
    );
    one(
        "\"spectrum reflectance\" [500 1 400 0]",
        "2:43: error: parameter \"reflectance\": wavelengths must increase, found 400 after 500",
    );
    one(
        "\"spectrum reflectance\" [ ]",
        "2:43: error: parameter \"reflectance\": at least one pair of wavelength and value is needed",
    );
    one(
        "\"spectrum reflectance\" \"metal-Cu-etta\"",
        "2:43: error: unknown spectrum \"metal-Cu-etta\" (did you mean \"metal-Cu-eta\"?)",
    );
    one(
        "\"float reflectance\" 0.5",
        "2:20: error: parameter \"reflectance\" has type float, expected texture, spectrum, rgb or blackbody",
    );
    expect(
        "LightSource \"point\" \"blackbody I\" [5000 2]",
        &[
            "2:35: error: parameter \"I\" takes one temperature, found 2 numbers (pbrt-v3's second number is now the parameter \"scale\")",
        ],
    );
    expect(
        "LightSource \"point\" \"blackbody I\" 0",
        &["2:35: error: parameter \"I\": a temperature must be positive"],
    );
    expect(
        "Material \"dielectric\" \"float eta\" 0",
        &["2:35: error: parameter \"eta\" must be one number from 0.01 to 100 or a spectrum"],
    );
}

#[test]
fn faults_of_transforms() {
    expect("Scale 1 0 1", &["2:1: error: `Scale` by zero along an axis cannot be inverted"]);
    expect("Rotate 30 0 0 0", &["2:1: error: `Rotate` needs an axis that is not zero"]);
    let look = "2:1: error: `LookAt` needs a target away from the eye and an up vector across the view";
    expect("LookAt 1 2 3 1 2 3 0 1 0", &[look]);
    expect("LookAt 0 0 0 0 1 0 0 1 0", &[look]);
    expect(
        "ConcatTransform [ 1 0 0 0  1 0 0 0  0 0 1 0  0 0 0 1 ]",
        &["2:1: error: the matrix of `ConcatTransform` cannot be inverted"],
    );
    let limit = "3:1: error: the current transform becomes too large or too small for 32-bit floats";
    expect("Scale 1e30 1 1\nScale 1e30 1 1", &[limit]);
    expect("Scale 1e-30 1 1\nScale 1e-30 1 1", &[limit]);
    expect("TransformTimes 1 0", &["2:1: error: `TransformTimes` needs the start before the end"]);
    expect(
        "CoordSysTransform \"camra\"",
        &["2:19: warning: unknown coordinate system \"camra\"; the directive has no effect"],
    );
}

#[test]
fn faults_of_meshes() {
    let one = |params: &str, message: &str| expect(&format!("Shape \"trianglemesh\" {params}"), &[message]);
    let p = "\"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]";
    one(
        &format!("{p} \"integer indices\" [0 1 4]"),
        "2:77: error: \"indices\": value 3 is 4, but \"P\" has 4 points",
    );
    one(
        &format!("{p} \"integer indices\" [0 -1 2]"),
        "2:77: error: \"indices\": value 2 is -1, but \"P\" has 4 points",
    );
    one(
        &format!("{p} \"integer indices\" [0 1 2 3]"),
        "2:77: error: \"indices\" needs 3 values a face, found 4",
    );
    one(p, "2:7: error: shape \"trianglemesh\" needs a parameter \"indices\"");
    one("\"integer indices\" [0 1 2]", "2:7: error: shape \"trianglemesh\" needs a parameter \"P\"");
    one(
        &format!("{p} \"integer indices\" [0 1 2] \"point2 uv\" [0 0 1 1]"),
        "2:97: error: \"uv\" has 2 values, but \"P\" has 4 points",
    );
    one(
        &format!("{p} \"integer indices\" [0 1 2] \"integer faceIndices\" [1 2]"),
        "2:107: error: \"faceIndices\" has 2 values for 1 faces",
    );
    expect(
        "Shape \"bilinearmesh\" \"integer indices\" [0 1 2 3] \"point3 P\" [0 0 0]",
        &["2:40: error: \"indices\": value 2 is 1, but \"P\" has 1 points"],
    );
    expect(
        "Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0 4 0 0]",
        &[
            "2:26: error: a bezier curve of degree 3 needs 4 and then 3 for every further segment points, found 5",
        ],
    );
    expect(
        "Shape \"curve\" \"string type\" \"ribbon\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0]",
        &["2:7: error: shape \"curve\" needs a parameter \"N\""],
    );
}

#[test]
fn faults_of_order() {
    expect("Film \"rgb\"", &["2:1: error: `Film` must come before `WorldBegin`"]);
    expect("WorldBegin", &["2:1: error: a second `WorldBegin`"]);
    expect_header("Shape \"sphere\" Shape \"sphere\"", &["1:1: error: `Shape` must come after `WorldBegin`"]);
    let imported = import_text("Film \"rgb\"\n");
    assert_eq!(messages(&imported), ["2:1: error: the scene ends without `WorldBegin`"]);
    expect_header("Film \"rgb\"\nFilm \"rgb\"", &["2:1: warning: this `Film` replaces an earlier one"]);
    expect(
        "AttributeBegin AttributeBegin AttributeEnd",
        &["2:1: error: this `AttributeBegin` is never closed"],
    );
    expect("AttributeEnd", &["2:1: error: `AttributeEnd` without `AttributeBegin`"]);
    expect(
        "ObjectBegin \"o\" AttributeEnd ObjectEnd",
        &["2:17: error: `AttributeEnd` without `AttributeBegin`"],
    );
    expect("AttributeBegin ObjectEnd AttributeEnd", &["2:16: error: `ObjectEnd` without `ObjectBegin`"]);
    expect("ObjectBegin \"o\"", &["2:1: error: this `ObjectBegin` is never closed"]);
    expect(
        "ObjectBegin \"a\" ObjectBegin \"b\" ObjectEnd ObjectEnd",
        &["2:17: error: an object cannot be defined inside another"],
    );
    expect(
        "ObjectBegin \"a\" ObjectEnd ObjectBegin \"b\" ObjectInstance \"a\" ObjectEnd",
        &["2:43: error: an object cannot be placed inside the definition of another"],
    );
    expect(
        "ObjectBegin \"a\" ObjectEnd ObjectBegin \"a\" ObjectEnd",
        &["2:39: error: object \"a\" is defined twice"],
    );
}

#[test]
fn faults_of_names() {
    expect(
        "MakeNamedMaterial \"wood\" \"string type\" \"diffuse\" NamedMaterial \"wod\"",
        &["2:64: error: material \"wod\" is not defined (did you mean \"wood\"?)"],
    );
    expect("ObjectInstance \"tree\"", &["2:16: error: object \"tree\" is not defined"]);
    expect(
        "Material \"diffuse\" \"texture reflectance\" \"a\" Shape \"sphere\" \"texture alpha\" \"a\"",
        &[
            "2:42: error: spectrum texture \"a\" is not defined",
            "2:77: error: float texture \"a\" is not defined",
        ],
    );
    expect("MediumInterface \"fog\" \"\"", &["2:17: error: medium \"fog\" is not defined"]);
    expect(
        "Texture \"a\" \"float\" \"constant\" Texture \"a\" \"float\" \"constant\"",
        &["2:40: error: float texture \"a\" is defined twice"],
    );
    expect(
        "MakeNamedMaterial \"a\" \"string type\" \"diffuse\" MakeNamedMaterial \"a\" \"string type\" \"diffuse\"",
        &["2:65: error: material \"a\" is defined twice"],
    );
    expect(
        "Texture \"a\" \"float\" \"scale\" \"texture tex\" \"b\" Texture \"b\" \"float\" \"scale\" \"texture tex\" \"a\"",
        &["2:47: error: texture \"b\" is made of itself"],
    );
    expect(
        "MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [\"a\" \"a\"]",
        &["2:1: error: material \"a\" is a mix of itself"],
    );
    expect(
        "MakeNamedMaterial \"a\" \"string type\" \"mix\" \"string materials\" [\"a\"]",
        &["2:62: error: \"materials\" takes the names of 2 materials, found 1"],
    );
    expect(
        "Texture \"a\" \"flot\" \"constant\"",
        &["2:13: error: unknown texture type \"flot\" (known are float and spectrum)"],
    );
    expect(
        "ColorSpace \"adobe\"",
        &["2:12: error: unknown colour space \"adobe\" (known are srgb, dci-p3, rec2020, aces2065-1)"],
    );
    expect(
        "Attribute \"lights\"",
        &[
            "2:11: error: unknown attribute target \"lights\" (known are shape, light, material, medium, texture)",
        ],
    );
}

#[test]
fn faults_of_lights_and_cameras() {
    expect("LightSource \"spot\" \"point3 to\" [0 0 0]", &["2:20: error: \"from\" and \"to\" must differ"]);
    expect(
        "LightSource \"infinite\" \"rgb L\" [1 1 1] \"string filename\" \"sky.exr\"",
        &["2:40: error: give \"L\" or \"filename\", not both"],
    );
    expect(
        "LightSource \"projection\"",
        &["2:13: error: light \"projection\" needs a parameter \"filename\""],
    );
    expect(
        "LightSource \"point\" \"string unit\" \"radiance\"",
        &["2:35: error: the unit of this light can only be \"intensity\", found \"radiance\""],
    );
    expect(
        "LightSource \"point\" \"float power\" 0",
        &["2:21: notice: \"power\" is ignored because it is not positive"],
    );
    expect_header(
        "Camera \"perspective\" \"float fov\" 180",
        &["1:22: error: parameter \"fov\" must be between 0 and 180, found 180"],
    );
    expect_header("Film \"rgb\" \"float cropwindow\" [0 1 1 1]", &["1:31: error: the crop window is empty"]);
    expect_header(
        "Film \"rgb\" \"integer xresolution\" 0",
        &["1:12: error: parameter \"xresolution\" must be from 1 to 65536, found 0"],
    );
    expect_header(
        "Sampler \"halton\" \"integer pixelsamples\" -1",
        &["1:18: error: parameter \"pixelsamples\" must be from 1 to 16777216, found -1"],
    );
    expect_header(
        "Sampler \"halton\" \"string randomization\" \"fastowen\"",
        &["1:41: error: unknown randomization \"fastowen\" (known are none, permutedigits, owen)"],
    );
    expect_header(
        "Option \"disablepixeljiter\" true",
        &["1:8: error: unknown option \"disablepixeljiter\" (did you mean \"disablepixeljitter\"?)"],
    );
    expect_header("Option \"seed\" 1.5", &["1:15: error: option \"seed\" takes one integer"]);
    expect_header(
        "Option \"float metersperunit\" 0",
        &["1:30: error: option \"metersperunit\" takes one positive number"],
    );
}

#[test]
fn what_would_be_rendered_wrongly_is_refused() {
    expect(
        "Material \"subsurface\" \"string name\" \"Skin1\"",
        &["2:10: error: unsupported: material \"subsurface\""],
    );
    expect(
        "Texture \"t\" \"float\" \"ptex\" \"string filename\" \"a.ptx\"",
        &["2:21: error: unsupported: texture \"ptex\""],
    );
    expect(
        "Shape \"plymesh\" \"string filename\" \"a.ply\" \"texture displacement\" \"t\" Texture \"t\" \"float\" \"constant\"",
        &["2:43: error: unsupported: displacement of plymesh shapes"],
    );
    expect(
        "LightSource \"infinite\" \"point3 portal\" [0 0 0 1 0 0 1 1 0 0 1 0]",
        &["2:24: error: unsupported: portals of infinite lights"],
    );
    expect(
        "MakeNamedMedium \"m\" \"string type\" \"homogeneous\"",
        &["2:1: error: unsupported: participating media"],
    );
    expect(
        "MakeNamedMedium \"m\" \"string type\" \"nanovdb\" \"string filename\" \"a.nvdb\"",
        &["2:35: error: unsupported: medium \"nanovdb\""],
    );
    expect_header(
        "Camera \"realistic\" \"string lensfile\" \"a.dat\"",
        &["1:8: error: unsupported: camera \"realistic\""],
    );
    expect_header("Integrator \"function\"", &["1:12: error: unsupported: integrator \"function\""]);
    expect_header(
        "Film \"rgb\" \"string sensor\" \"nikon_d810\"",
        &["1:28: error: unsupported: sensor \"nikon_d810\"; known is cie1931"],
    );
}

#[test]
fn scenes_of_the_older_language_are_recognised_once() {
    let advice = "(convert it with pbrt-v4: `pbrt --upgrade old.pbrt > new.pbrt`)";
    for (text, place, why) in [
        ("Film \"image\" \"integer xresolution\" 4", "1:6", "which has no film \"image\""),
        ("WorldBegin\nMaterial \"matte\" Material \"uber\"", "2:10", "which has no material \"matte\""),
        (
            "WorldBegin\nTexture \"t\" \"color\" \"constant\"",
            "2:13",
            "which calls \"color\" textures \"spectrum\"",
        ),
        ("WorldBegin\nShape \"sphere\"\nWorldEnd\n", "3:1", "which has no `WorldEnd`"),
        ("Sampler \"lowdiscrepancy\"", "1:9", "which has no sampler \"lowdiscrepancy\""),
        ("Integrator \"directlighting\"", "1:12", "which has no integrator \"directlighting\""),
        ("Camera \"environment\"", "1:8", "which has no camera \"environment\""),
    ] {
        let imported = import_text(text);
        let expected = format!(
            "{place}: error: this looks like a pbrt-v3 file; the language here is pbrt-v4, {why} {advice}"
        );
        assert_eq!(messages(&imported), [expected], "{text}");
    }
}

#[test]
fn every_fault_of_a_file_is_reported() {
    expect(
        "Shape \"spehre\" \"float x\" 1\nScale 0 0 0\nShape \"disk\" \"float radius\" [ \"a\" ] \"float height\" x \"float hight\" 2\nFoo",
        &[
            "2:7: error: unknown shape \"spehre\" (did you mean \"sphere\"?)",
            "3:1: error: `Scale` by zero along an axis cannot be inverted",
            "4:31: error: expected a number or `]`, found the string \"a\"",
            "4:52: error: expected a number, found `x`",
            "4:54: error: shape \"disk\" has no parameter \"hight\" (did you mean \"height\"?)",
            "5:1: error: unknown directive `Foo`",
        ],
    );
}

#[test]
fn files_that_cannot_be_read_and_circles_of_files_are_reported() {
    expect("Include \"none.pbrt\"", &["2:9: error: cannot read \"none.pbrt\": no such file"]);
    let files = MemoryFiles::new()
        .with("a.pbrt", "Include \"b.pbrt\"")
        .with("b.pbrt", "Include \"a.pbrt\"")
        .with("self.pbrt", "WorldBegin Include \"self.pbrt\"")
        .with("damaged.pbrt.gz", "this is no gzip file");
    let imported = import_with("WorldBegin\nInclude \"a.pbrt\"", &files);
    let text = imported.diagnostics.display(&imported.sources).to_string();
    assert_eq!(
        text,
        "b.pbrt:1:9: error: \"a.pbrt\" includes itself\n 1 | Include \"a.pbrt\"\n   |         ^^^^^^^^\n  \
         included from a.pbrt:1:1\n  included from scene.pbrt:2:1\n"
    );
    let imported = import(&[Input::File(Path::new("self.pbrt"))], &files);
    assert_eq!(messages(&imported), ["self.pbrt:1:20: error: \"self.pbrt\" includes itself"]);
    let imported = import_with("WorldBegin\nInclude \"damaged.pbrt.gz\"", &files);
    assert_eq!(messages(&imported), ["2:9: error: cannot read \"damaged.pbrt.gz\": invalid gzip header"]);
    let imported = import(&[Input::File(Path::new("none.pbrt"))], &files);
    assert_eq!(messages(&imported), ["error: cannot read none.pbrt: no such file"]);
    let imported = import(&[], &files);
    assert_eq!(messages(&imported), ["error: there is no scene file"]);
}

#[test]
fn lights_that_cannot_shine_are_announced() {
    expect(
        "AreaLightSource \"diffuse\" ObjectBegin \"o\" Shape \"sphere\" ObjectEnd",
        &["2:43: warning: shapes of objects cannot emit light; the area light is ignored"],
    );
    expect(
        "AreaLightSource \"diffuse\" Material \"interface\" Shape \"sphere\"",
        &["2:48: warning: shapes of material \"interface\" cannot emit light; the area light is ignored"],
    );
    expect("Material \"none\"", &["2:10: notice: material \"none\" is an old name of \"interface\""]);
}

#[test]
fn twenty_thousand_slips_do_not_take_twenty_thousand_squared_comparisons() {
    let n = 20_000;
    let mut text = String::from("WorldBegin\n");
    for i in 0..n {
        text.push_str(&format!("MakeNamedMaterial \"right{i}\" \"string type\" \"diffuse\"\n"));
    }
    for i in 0..n {
        text.push_str(&format!("NamedMaterial \"wrong{i}\"\nShape \"sphere\"\n"));
    }
    let imported = import_text(&text);
    assert_eq!(imported.diagnostics.error_count(), n);
    assert_eq!(imported.diagnostics.dropped(), n - crate::scene::Diagnostics::LIMIT);
    assert_eq!(messages(&imported)[0], format!("{}:15: error: material \"wrong0\" is not defined", n + 2));
}

#[test]
fn repeated_parameters_are_found_among_many() {
    let n = 50_000;
    let mut text = String::from("WorldBegin Shape \"sphere\"\n\"float radius\" 1\n\"float zmin\" 0\n");
    for i in 0..n {
        text.push_str(&format!("\"float a{i}\" 1\n"));
    }
    text.push_str("\"float zmin\" 0\n\"float radius\" 2\n");
    let imported = import_text(&text);
    assert_eq!(imported.diagnostics.error_count(), n + 2);
    let expected = ["zmin", "radius"].map(|name| format!("parameter \"{name}\" is given twice"));
    let found: Vec<_> = imported.diagnostics.iter().take(2).collect();
    for (d, (message, (line, first))) in found.iter().zip(expected.iter().zip([(n + 4, 3), (n + 5, 2)])) {
        assert_eq!(&d.message, message);
        assert_eq!(d.span.map(|s| imported.sources.location(s).line), Some(line));
        assert_eq!(imported.sources.location(d.related[0].span).line, first);
    }
}

#[test]
fn settings_that_change_the_file_or_the_estimator_of_pbrt_alone_are_announced() {
    expect_header(
        "Film \"rgb\" \"bool savefp16\" true",
        &["1:12: notice: \"savefp16\" is ignored: EXR is written in 32-bit float"],
    );
    expect_header("Film \"rgb\" \"bool savefp16\" false \"float diagonal\" 50", &[]);
    expect_header(
        "Integrator \"simplepath\" \"bool samplebsdf\" false \"bool samplelights\" false",
        &["1:49: notice: lights and BSDFs are both sampled all the same"],
    );
    let chance = "1:18: error: parameter \"largestepprobability\" must be from 0 to 1, found 2";
    expect_header("Integrator \"mlt\" \"float largestepprobability\" 2", &[chance]);
}
