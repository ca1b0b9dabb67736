//! Where a report measures.

use steradian::lab::glare::{Eye, Handedness, Threshold};
use steradian::lab::report::Grid;
use steradian::math::{Point, Vec3};
use steradian::scene::RenderJob;

/// A grid as typed.
#[derive(Clone, Debug)]
pub(super) struct GridPlace {
    pub(super) grid: Grid,
}

/// A view as typed.
#[derive(Clone, Debug)]
pub(super) struct ViewPlace {
    pub(super) name: String,
    at: Stand,
}

#[derive(Clone, Debug)]
enum Stand {
    /// Where the scene's camera is.
    Camera,
    /// Position, line of sight, upwards.
    Vectors([[f64; 3]; 3]),
}

/// From where on a pixel belongs to a source of glare.
#[derive(Clone, Copy, Debug)]
pub(super) struct GlareThreshold(pub(super) Threshold);

pub(super) fn grid(text: &str) -> Result<GridPlace, String> {
    let (name, rest) = named(text);
    let n: [f64; 11] = numbers(rest).ok_or(
        "expected 11 numbers: a corner, two sides, and the number of cells along each, such as 0,0,0.8,4,0,0,0,3,0,8,6",
    )?;
    let count = |x: f64| ((1.0..=1e6).contains(&x) && x.fract() == 0.0).then_some(x as usize);
    let (Some(columns), Some(rows)) = (count(n[9]), count(n[10])) else {
        return Err("the last two numbers are counts of cells, at least 1".to_owned());
    };
    let grid = Grid {
        name: name.unwrap_or("grid").to_owned(),
        corner: [n[0], n[1], n[2]],
        u: [n[3], n[4], n[5]],
        v: [n[6], n[7], n[8]],
        columns,
        rows,
    };
    Ok(GridPlace { grid: grid.checked().map_err(|e| e.to_string())? })
}

pub(super) fn view(text: &str) -> Result<ViewPlace, String> {
    let (name, rest) = named(text);
    if rest.trim() == "camera" {
        return Ok(ViewPlace { name: name.unwrap_or("camera").to_owned(), at: Stand::Camera });
    }
    let n: [f64; 9] = numbers(rest).ok_or(
        "expected `camera`, or 9 numbers: position, line of sight, upwards, such as 2,0.5,1.2,0,1,0,0,0,1",
    )?;
    let at = Stand::Vectors([[n[0], n[1], n[2]], [n[3], n[4], n[5]], [n[6], n[7], n[8]]]);
    Ok(ViewPlace { name: name.unwrap_or("view").to_owned(), at })
}

pub(super) fn threshold(text: &str) -> Result<GlareThreshold, String> {
    let (number, factor) = match text.trim().strip_suffix(['x', '×']) {
        Some(number) => (number, true),
        None => (text.trim(), false),
    };
    let number = number.parse::<f64>().ok().filter(|x| *x > 0.0 && x.is_finite());
    let number =
        number.ok_or("expected a luminance in cd/m² such as 2000, or a multiple of the mean such as 5x")?;
    Ok(GlareThreshold(if factor { Threshold::TimesMean(number) } else { Threshold::Luminance(number) }))
}

/// Names become names of files: they must differ, and be plain.
pub(super) fn check_names(grids: &[GridPlace], views: &[ViewPlace]) -> Result<(), String> {
    for (what, names) in [
        ("grids", grids.iter().map(|g| g.grid.name.as_str()).collect::<Vec<_>>()),
        ("views", views.iter().map(|v| v.name.as_str()).collect()),
    ] {
        for (i, name) in names.iter().enumerate() {
            if names[..i].contains(name) {
                return Err(format!("two {what} are called {name}: write NAME= before the numbers"));
            }
            let plain = |c: char| c.is_alphanumeric() || matches!(c, '-' | '_' | '.');
            if name.is_empty() || !name.chars().all(plain) || name.starts_with('.') {
                return Err(format!("\"{name}\" is no name for a file: use letters, digits, - and _"));
            }
        }
    }
    Ok(())
}

fn named(text: &str) -> (Option<&str>, &str) {
    match text.split_once('=') {
        Some((name, rest)) => (Some(name.trim()), rest),
        None => (None, text),
    }
}

fn numbers<const N: usize>(text: &str) -> Option<[f64; N]> {
    let all: Option<Vec<f64>> =
        text.split(',').map(|w| w.trim().parse::<f64>().ok().filter(|x| x.is_finite())).collect();
    all?.try_into().ok()
}

impl ViewPlace {
    /// The eye in the scene's world.
    pub(super) fn eye(&self, job: &RenderJob) -> Result<Eye, String> {
        let [point, ahead, up] = match self.at {
            Stand::Vectors(v) => v,
            Stand::Camera => {
                let placement = job.scene.camera().placement().start();
                let world = &job.world_from_render;
                let vector = |v: Vec3| world.vector(placement.vector(v)).to_array().map(f64::from);
                let point = world.point(placement.point(Point::ORIGIN)).to_array().map(f64::from);
                [point, vector(Vec3::Z), vector(Vec3::Y)]
            }
        };
        Eye::new(point, ahead, up, Handedness::of(job)).map_err(|e| format!("view {}: {e}", self.name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_read_with_and_without_names() {
        let place = grid("desk=0,0,0.8,4,0,0,0,3,0,8,6").unwrap();
        assert_eq!((place.grid.name.as_str(), place.grid.columns, place.grid.rows), ("desk", 8, 6));
        assert!(grid("0,0,0.8,4,0,0,0,3,0,8").unwrap_err().contains("11 numbers"));
        assert!(grid("0,0,0.8,4,0,0,0,3,0,8,0.5").unwrap_err().contains("counts"));
        assert!(grid("0,0,0.8,4,0,0,8,0,0,8,6").unwrap_err().contains("no area"));
        assert_eq!(view("camera").unwrap().name, "camera");
        assert_eq!(view("seat=0,0,1.2,0,1,0,0,0,1").unwrap().name, "seat");
        assert!(view("0,0,1.2").is_err());
    }

    #[test]
    fn thresholds_are_luminances_or_multiples() {
        assert_eq!(threshold("2000").unwrap().0, Threshold::Luminance(2000.0));
        assert_eq!(threshold("5x").unwrap().0, Threshold::TimesMean(5.0));
        assert!(threshold("0").is_err() && threshold("x").is_err() && threshold("5 y").is_err());
    }

    #[test]
    fn names_must_differ_and_be_plain() {
        let both = [grid("0,0,0.8,4,0,0,0,3,0,8,6").unwrap(), grid("a=0,0,0.8,4,0,0,0,3,0,8,6").unwrap()];
        assert!(check_names(&both, &[]).is_ok());
        let same = [view("camera").unwrap(), view("camera=0,0,1.2,0,1,0,0,0,1").unwrap()];
        assert!(check_names(&[], &same).unwrap_err().contains("two views are called camera"));
        assert!(check_names(&[grid("../x=0,0,0.8,4,0,0,0,3,0,8,6").unwrap()], &[]).is_err());
    }
}
