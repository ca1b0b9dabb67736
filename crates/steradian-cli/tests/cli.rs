//! The command as users meet it: exit codes, what is written where, and what is said.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "tests fail by panicking")]

mod support;

use std::io::Write as _;
use std::process::Stdio;
use steradian::image::{Frame, read_frame_exr};
use support::desk::{Desk, Said};

/// A scene of a few hundred samples.
const SCENE: &str = r#"LookAt 0 0 -4  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 8 "integer yresolution" 6 "string filename" "picture.exr"
Sampler "independent" "integer pixelsamples" 4
Integrator "path" "integer maxdepth" 3
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
Material "diffuse" "rgb reflectance" [ 0.8 0.4 0.2 ]
Shape "sphere"
"#;

/// The default scene, ready to be run.
fn new_desk() -> Desk {
    Desk::new(SCENE)
}

fn picture(desk: &Desk, name: &str) -> Frame {
    read_frame_exr(&desk.read(name)).unwrap()
}

#[test]
fn no_command_prints_the_help_with_examples() {
    let desk = new_desk();
    desk.run(&[]).refused("steradian render scene.pbrt -o a.exr -o a.png");
    for arguments in [&["--help"][..], &["help"], &["render", "--help"], &["help", "compare"]] {
        let said = desk.run(arguments).succeeded();
        assert!(said.out.contains("Usage:") && said.err.is_empty(), "{said:?}");
    }
    assert!(desk.run(&["--version"]).succeeded().out.starts_with("steradian "));
}

#[test]
fn wrong_arguments_are_refused_with_what_is_expected() {
    let desk = new_desk();
    let render = |argument: &'static str, value: &'static str| {
        desk.run(&["render", "scene.pbrt", &format!("{argument}={value}")])
    };
    desk.run(&["renderr"]).refused("a similar subcommand exists: 'render'");
    desk.run(&["scene.pbrt"]).refused("a command is missing; try: steradian render scene.pbrt");
    desk.run(&["render", "--sp", "4"]).refused("--spp");
    render("--spp", "0").refused("0 is not in 1..=16777216");
    render("--spp", "-4").refused("'-4'");
    render("--noise", "little").refused("a percentage such as 1%, or a fraction such as 0.01");
    render("--noise", "0%").refused("a percentage such as 1%");
    render("--resolution", "640").refused("such as 1280x720");
    render("--resolution", "0x4").refused("between 1 and 65536");
    render("--crop", "0,1,1,0").refused("0 <= Y0 < Y1 <= 1");
    render("--time", "soon").refused("60s, 5m or 1h");
    render("--threads", "0").refused("0 is not in 1..=4096");
    desk.run(&["compare", "a.exr"]).refused("<REFERENCE>");
    assert_eq!(desk.files(), ["scene.pbrt"]);
}

#[test]
fn render_writes_every_output_and_says_so() {
    let desk = new_desk();
    let said = desk.run(&["render", "scene.pbrt", "-o", "a.exr", "--output", "a.png"]).succeeded();
    assert_eq!(desk.files(), ["a.exr", "a.png", "scene.pbrt"]);
    assert!(said.out.is_empty() && said.err.contains("a.exr, a.png: 4 spp in 0:0"), "{said:?}");
    let frame = picture(&desk, "a.exr");
    assert_eq!(frame.resolution(), [8, 6]);
    // The background is the light itself, the sphere is red.
    let [red, blue] = ["R", "B"].map(|c| frame.channel(c).unwrap().to_vec());
    assert!((red[0] - 1.0).abs() < 0.3 && red[3 * 8 + 4] > 2.0 * blue[3 * 8 + 4], "{red:?} {blue:?}");
    assert!(std::fs::read(desk.path("a.png")).unwrap().starts_with(b"\x89PNG"));
    assert_eq!(frame.attribute("renderer.samplesPerPixel"), Some("4"));
}

#[test]
fn render_without_output_writes_the_file_that_the_scene_names() {
    let desk = new_desk();
    desk.run(&["render", "scene.pbrt"]).succeeded();
    assert_eq!(desk.files(), ["picture.exr", "scene.pbrt"]);
}

#[test]
fn render_without_scene_shows_the_cornell_box() {
    let desk = new_desk();
    desk.run(&["render", "--resolution", "16x16", "--spp", "1"]).succeeded();
    assert_eq!(desk.files(), ["cornell-box.exr", "cornell-box.png", "scene.pbrt"]);
}

#[test]
fn standard_input_and_several_files_make_one_scene() {
    let desk = new_desk();
    let (header, world) = SCENE.split_at(SCENE.find("WorldBegin").unwrap());
    desk.put("header.pbrt", header);
    desk.put("world.pbrt", world);
    desk.run(&["render", "scene.pbrt", "-o", "whole.exr"]).succeeded();
    desk.run(&["render", "header.pbrt", "world.pbrt", "-o", "parts.exr"]).succeeded();
    let mut child = desk
        .command(&["render", "-", "-o", "piped.exr"])
        .stdin(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    child.stdin.take().unwrap().write_all(SCENE.as_bytes()).unwrap();
    Said::of(child.wait_with_output().unwrap()).succeeded();
    let red = |name: &str| picture(&desk, name).channel("R").unwrap().to_vec();
    assert_eq!(red("whole.exr"), red("parts.exr"));
    assert_eq!(red("whole.exr"), red("piped.exr"));
}

#[test]
fn an_error_on_standard_input_is_located_there() {
    let desk = new_desk();
    let mut child =
        desk.command(&["check", "-"]).stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
    child.stdin.take().unwrap().write_all(b"WorldBegin\nShape \"spheer\"\n").unwrap();
    let said = Said::of(child.wait_with_output().unwrap());
    assert_eq!(said.code, Some(1));
    assert!(said.err.starts_with("(standard input):2:7: error: unknown shape \"spheer\"\n"), "{said:?}");
}

#[test]
fn resolution_and_crop_decide_which_pixels_are_rendered() {
    let desk = new_desk();
    let crop = ["render", "scene.pbrt", "--resolution", "20x10", "--crop", "0.5,1,0.2,0.5", "-o", "a.exr"];
    desk.run(&crop).succeeded();
    let frame = picture(&desk, "a.exr");
    let w = frame.window();
    assert_eq!(frame.resolution(), [20, 10]);
    assert_eq!((w.x, w.y, w.width, w.height), (10, 2, 10, 3));
    // The same pixels of the whole picture have the same values.
    desk.run(&["render", "scene.pbrt", "--resolution", "20x10", "-o", "b.exr"]).succeeded();
    let whole = picture(&desk, "b.exr");
    let (part, whole) = (frame.channel("G").unwrap(), whole.channel("G").unwrap());
    for (i, &v) in part.iter().enumerate() {
        assert_eq!(v, whole[(i / 10 + 2) * 20 + i % 10 + 10]);
    }
    let narrow = ["render", "scene.pbrt", "--crop", "0.51,0.52,0,1"];
    let said = desk.run(&narrow);
    assert_eq!(said.code, Some(1));
    assert!(said.err.starts_with("scene.pbrt:3:1: error: the part to be rendered contains none"), "{said:?}");
}

#[test]
fn the_seed_decides_the_picture() {
    let desk = new_desk();
    let bytes = |seed: &str, threads: &str| {
        desk.run(&["render", "scene.pbrt", "--seed", seed, "--threads", threads, "-q", "-o", "a.exr"])
            .succeeded();
        std::fs::read(desk.path("a.exr")).unwrap()
    };
    let first = bytes("7", "1");
    assert!(first == bytes("7", "2"), "the same seed gave another file");
    assert!(first != bytes("-8", "1"), "another seed gave the same file");
}

#[test]
fn quiet_says_nothing_and_lines_replace_the_bar_where_no_terminal_looks() {
    let desk = new_desk();
    let said = desk.run(&["render", "scene.pbrt", "--quiet"]).succeeded();
    assert_eq!((said.out.as_str(), said.err.as_str()), ("", ""));
    let said = desk.run(&["render", "scene.pbrt"]).succeeded();
    let lines: Vec<&str> = said.err.lines().collect();
    assert_eq!(lines[0], "rendering 8 x 6 pixels with 4 spp");
    assert!(lines[1].contains('%') && lines[1].contains(" spp "), "{lines:?}");
    assert!(!said.err.contains(['\r', '\u{1b}']), "{said:?}");
    let said = desk.run(&["render", "scene.pbrt", "--stats"]).succeeded();
    assert!(said.err.contains("rays, closest hit"), "{said:?}");
}

#[test]
fn a_time_limit_ends_the_render_with_fewer_samples() {
    let desk = new_desk();
    let arguments = ["render", "scene.pbrt", "--spp", "16000000", "--time", "0.2s", "-o", "a.exr"];
    desk.run(&arguments).succeeded();
    let spp: u32 = picture(&desk, "a.exr").attribute("renderer.samplesPerPixel").unwrap().parse().unwrap();
    assert!((1..16_000_000).contains(&spp), "{spp}");
}

#[test]
fn a_noise_target_takes_samples_where_they_are_needed_and_says_what_it_reached() {
    let desk = new_desk();
    let noise = |noise: &str, spp: &str| {
        desk.run(&["render", "scene.pbrt", "--noise", noise, "--spp", spp, "-o", "a.exr"]).succeeded()
    };
    let said = noise("2%", "8192");
    let lines: Vec<&str> = said.err.lines().collect();
    assert_eq!(lines[0], "rendering 8 x 6 pixels with up to 8192 spp for a noise of 2 %");
    assert!(said.err.contains("(target 2 %)") && !said.err.contains("warning"), "{said:?}");
    let frame = picture(&desk, "a.exr");
    let number = |name: &str| frame.attribute(name).unwrap().parse::<f64>().unwrap();
    assert!(number("renderer.noise") <= 0.024, "{said:?}");
    let range: Vec<f64> = frame
        .attribute("renderer.samplesPerPixelRange")
        .unwrap()
        .split(' ')
        .map(|n| n.parse().unwrap())
        .collect();
    let mean = number("renderer.samplesPerPixel");
    assert!(
        range[0] >= 16.0 && range[0] <= mean && mean <= range[1] && range[1] <= 8192.0,
        "{range:?} {mean}"
    );
    assert_eq!(frame.attribute("renderer.stoppedByMaximum"), Some("false"));
    // A demand that the count does not allow is said to be one.
    let said = noise("0.001", "32");
    assert!(said.err.contains("warning: 100.0 % of the pixels took all 32 samples"), "{said:?}");
    // The scene may ask for it, too.
    desk.put(
        "quiet.pbrt",
        SCENE.replace(r#""integer pixelsamples" 4"#, r#""integer pixelsamples" 512 "float noise" 0.1"#),
    );
    desk.run(&["render", "quiet.pbrt", "-q", "-o", "b.exr"]).succeeded();
    assert_eq!(picture(&desk, "b.exr").attribute("renderer.noiseTarget"), Some("0.1"));
    desk.put("wrong.pbrt", SCENE.replace(r#""integer pixelsamples" 4"#, r#""float noise" 2"#));
    let said = desk.run(&["check", "wrong.pbrt"]);
    assert!(
        said.code == Some(1) && said.err.contains("parameter \"noise\" must be above 0 and at most 1"),
        "{said:?}"
    );
}

#[test]
fn what_cannot_be_read_or_written_is_said_before_rendering() {
    let desk = new_desk();
    std::fs::create_dir(desk.path("folder.exr")).unwrap();
    let render = |more: &[&str]| desk.run(&[&["render", "scene.pbrt", "--spp", "16000000"], more].concat());
    desk.run(&["render", "gone.pbrt"]).failed("error: cannot read gone.pbrt: no such file");
    desk.run(&["render", "."]).failed("error: cannot read .: is a directory");
    desk.run(&["compare", "gone.exr", "a.exr"]).failed("error: cannot read gone.exr: no such file");
    render(&["-o", "a.gif"]).failed("error: a.gif: cannot write images as \"gif\" (written: exr, png, pfm)");
    render(&["-o", "gone/a.exr"]).failed("error: gone/a.exr: the folder gone does not exist");
    render(&["-o", "folder.exr"]).failed("error: folder.exr is a folder");
    render(&["--integrator", "pth"]).failed("error: unknown integrator \"pth\"; did you mean \"path\"?");
    render(&["--integrator", "bdpt"])
        .failed("error: unknown integrator \"bdpt\"; known are \"path\" and \"classic\"");
    // No file system has names as long as this.
    let said = render(&["-o", &format!("{}.exr", "a".repeat(5000))]);
    assert!(
        said.code == Some(1) && said.err.starts_with("error: cannot write into the folder of "),
        "{said:?}"
    );
    assert_eq!(desk.files(), ["folder.exr", "scene.pbrt"]);
}

#[cfg(unix)]
#[test]
fn a_folder_without_permission_is_said_before_rendering() {
    use std::os::unix::fs::PermissionsExt as _;
    let desk = new_desk();
    let folder = desk.path("locked");
    std::fs::create_dir(&folder).unwrap();
    std::fs::set_permissions(&folder, std::fs::Permissions::from_mode(0o555)).unwrap();
    if std::fs::write(folder.join("probe"), "").is_ok() {
        // The superuser may write anywhere.
        return;
    }
    let said = desk.run(&["render", "scene.pbrt", "--spp", "16000000", "-o", "locked/a.exr"]);
    said.failed("error: cannot write into the folder of locked/a.exr: permission denied");
}

#[test]
fn check_reports_all_problems_at_once() {
    let desk = new_desk();
    assert_eq!(desk.run(&["check", "scene.pbrt"]).succeeded().err, "0 errors, 0 warnings, 0 notices\n");
    desk.put("bad.pbrt", "Sampler \"haltn\"\nWorldBegin\nShape \"spheer\"\nScale 0 1 1\n");
    let said = desk.run(&["check", "bad.pbrt"]);
    assert_eq!(said.code, Some(1));
    assert_eq!(
        said.err,
        r#"bad.pbrt:1:9: error: unknown sampler "haltn"
 1 | Sampler "haltn"
   |         ^^^^^^^
  help: did you mean "halton"?
bad.pbrt:3:7: error: unknown shape "spheer"
 3 | Shape "spheer"
   |       ^^^^^^^^
  help: did you mean "sphere"?
bad.pbrt:4:1: error: `Scale` by zero along an axis cannot be inverted
 4 | Scale 0 1 1
   | ^^^^^
3 errors, 0 warnings, 0 notices
"#
    );
    // Faults that only compiling finds, and a warning.
    desk.put("gone.pbrt", "WorldBegin\nShape \"plymesh\" \"string filename\" \"gone.ply\"\n");
    let said = desk.run(&["check", "gone.pbrt"]);
    assert_eq!(said.code, Some(1));
    assert!(said.err.contains("gone.pbrt:2:35: error: cannot read mesh gone.ply: no such file"), "{said:?}");
    assert!(said.err.ends_with("1 error, 1 warning, 0 notices\n"), "{said:?}");
    for command in ["render", "info"] {
        assert_eq!(desk.run(&[command, "bad.pbrt"]).code, Some(1), "{command}");
    }
    assert_eq!(desk.files(), ["bad.pbrt", "gone.pbrt", "scene.pbrt"]);
}

#[test]
fn info_describes_the_scene() {
    let desk = new_desk();
    let said = desk.run(&["info", "scene.pbrt"]).succeeded();
    for expected in ["8 × 6, 4 samples per pixel", "1 with 1 primitives", "lm", "bounds (world)"] {
        assert!(said.out.contains(expected), "{expected}: {said:?}");
    }
    let room = desk.run(&["info"]).succeeded().out;
    assert!(room.contains("lights"));
    // A packet holds four triangles of 36 bytes and their numbers, and a node has 256 bytes: a room of 36 triangles
    // cannot take less than its geometry nor more than a packet and a node for each of them.
    let line = room.lines().find(|l| l.starts_with("memory per triangle")).unwrap();
    let figures: Vec<f64> = line.split_whitespace().filter_map(|w| w.parse().ok()).collect();
    assert!(
        matches!(figures[..], [resident, peak] if resident > 48.0 && peak >= resident && peak < 600.0),
        "{line}"
    );
}

#[test]
fn a_closed_pipe_is_no_reason_to_panic() {
    let desk = new_desk();
    for arguments in [&["info", "scene.pbrt"][..], &["--help"], &["check", "scene.pbrt"]] {
        let mut child =
            desk.command(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let said = Said::of(child.wait_with_output().unwrap());
        assert!(matches!(said.code, Some(0 | 2)), "{arguments:?} {said:?}");
    }
}

#[test]
fn compare_measures_differences_as_text_and_as_json() {
    let desk = new_desk();
    desk.run(&["render", "scene.pbrt", "-q", "-o", "a.exr"]).succeeded();
    desk.run(&["render", "scene.pbrt", "-q", "--seed", "5", "-o", "b.exr"]).succeeded();
    desk.run(&["render", "scene.pbrt", "-q", "--resolution", "4x4", "-o", "c.exr"]).succeeded();
    let same = desk.run(&["compare", "a.exr", "a.exr"]).succeeded();
    assert!(same.out.starts_with("mean ratio        1.00000 1.00000 1.00000"), "{same:?}");
    let said = desk.run(&["compare", "a.exr", "b.exr", "--json", "-o", "map.png"]).succeeded();
    let json: serde_json::Value = serde_json::from_str(&said.out).unwrap();
    assert!(json["mse"].as_f64().unwrap() > 0.0 && json["flip"].as_f64().unwrap() > 0.0, "{json}");
    assert_eq!((json["mean_ratio"].as_array().unwrap().len(), json["pixels"].as_u64()), (3, Some(48)));
    assert!(desk.path("map.png").exists());
    let said = desk.run(&["compare", "a.exr", "c.exr"]);
    said.failed("error: frames of 8 x 6 and 4 x 4 pixels cannot be compared");
    desk.put("text.exr", "this is no picture");
    let said = desk.run(&["compare", "text.exr", "a.exr"]);
    assert!(said.code == Some(1) && said.err.starts_with("error: cannot read text.exr: "), "{said:?}");
}

/// Ctrl-C, as the terminal sends it.
#[cfg(unix)]
mod interrupt {
    use super::{Desk, Stdio, new_desk, read_frame_exr};
    use std::io::{BufRead as _, BufReader};
    use std::process::{Child, Command};
    use std::time::{Duration, Instant};

    fn signal(child: &Child) {
        assert!(Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap().success());
    }

    /// The exit code; fails when it does not come in time.
    fn exit_code(child: &mut Child) -> Option<i32> {
        let start = Instant::now();
        loop {
            if let Some(status) = child.try_wait().unwrap() {
                return status.code();
            }
            if start.elapsed() > Duration::from_secs(60) {
                child.kill().unwrap();
                panic!("the program does not end");
            }
            std::thread::sleep(Duration::from_millis(20));
        }
    }

    /// Starts a render of hours and waits until it has begun.
    fn long_render(desk: &Desk) -> (Child, impl Iterator<Item = String>) {
        let arguments = ["render", "scene.pbrt", "--spp", "16000000", "-o", "a.exr"];
        let mut child = desk.command(&arguments).stderr(Stdio::piped()).spawn().unwrap();
        let mut lines = BufReader::new(child.stderr.take().unwrap()).lines().map_while(Result::ok);
        assert!(lines.by_ref().any(|l| l.starts_with("rendering ")), "no render began");
        (child, lines)
    }

    #[test]
    fn once_ends_the_pass_and_writes_the_picture() {
        let desk = new_desk();
        let (mut child, lines) = long_render(&desk);
        signal(&child);
        let said: Vec<String> = lines.collect();
        assert_eq!(exit_code(&mut child), Some(130), "{said:?}");
        assert!(said.iter().any(|l| l.starts_with("stopping after this pass")), "{said:?}");
        assert!(said.iter().any(|l| l.ends_with("of 16000000 samples per pixel")), "{said:?}");
        let frame = read_frame_exr(&std::fs::read(desk.path("a.exr")).unwrap()).unwrap();
        let spp: u32 = frame.attribute("renderer.samplesPerPixel").unwrap().parse().unwrap();
        assert!((1..16_000_000).contains(&spp), "{spp}");
    }
}
