//! Lines of equal value over a grid of samples.

/// Values at the nodes of a grid, row by row.
#[derive(Clone, Copy, Debug)]
pub struct Field<'a> {
    /// Nodes in a row.
    pub columns: usize,
    /// Values, a whole number of rows.
    pub values: &'a [f64],
}

/// The lines on which bilinear interpolation has the value `level`, by marching squares; coordinates are column and row of the nodes.
/// Closed lines end where they begin. In a cell whose corners lie above and below in turn, the mean of the corners decides which
/// of them are connected.
pub fn contours(field: &Field<'_>, level: f64) -> Vec<Vec<[f64; 2]>> {
    let columns = field.columns;
    let rows = field.values.len() / columns.max(1);
    if columns < 2 || rows < 2 {
        return Vec::new();
    }
    let value = |x: usize, y: usize| field.values[y * columns + x];
    // Crossings have the number of their edge: first the edges along rows, then those along columns.
    let along_row = |x: usize, y: usize| y * columns + x;
    let along_column = |x: usize, y: usize| columns * rows + y * columns + x;
    // At most two pieces of line meet in a crossing, one from each side of its edge.
    let mut links: Vec<[Option<usize>; 2]> = vec![[None; 2]; 2 * columns * rows];
    let mut connect = |a: usize, b: usize| {
        for (from, to) in [(a, b), (b, a)] {
            let slot = usize::from(links[from][0].is_some());
            links[from][slot] = Some(to);
        }
    };
    for y in 0..rows - 1 {
        for x in 0..columns - 1 {
            // Corners and edges in turn around the cell.
            let corners = [value(x, y), value(x + 1, y), value(x + 1, y + 1), value(x, y + 1)];
            if !corners.iter().all(|c| c.is_finite()) {
                continue;
            }
            let edges = [along_row(x, y), along_column(x + 1, y), along_row(x, y + 1), along_column(x, y)];
            let above = corners.map(|c| c >= level);
            let crossed: Vec<usize> = (0..4).filter(|&e| above[e] != above[(e + 1) % 4]).collect();
            match *crossed.as_slice() {
                [a, b] => connect(edges[a], edges[b]),
                [_, _, _, _] => {
                    let middle = 0.25 * corners.iter().sum::<f64>() >= level;
                    // Lines cut off the corners that differ from the middle: corner c lies between edges c − 1 and c.
                    for c in (0..4).filter(|&c| above[c] != middle) {
                        connect(edges[(c + 3) % 4], edges[c]);
                    }
                }
                _ => {}
            }
        }
    }
    let place = |edge: usize| -> [f64; 2] {
        let across = edge >= columns * rows;
        let node = edge % (columns * rows);
        let (x, y) = (node % columns, node / columns);
        let (a, b) = (value(x, y), if across { value(x, y + 1) } else { value(x + 1, y) });
        let t = (level - a) / (b - a);
        if across { [x as f64, y as f64 + t] } else { [x as f64 + t, y as f64] }
    };
    let mut lines = Vec::new();
    // Open lines from their ends, then what is left: closed ones.
    for ends in [true, false] {
        for start in 0..links.len() {
            let degree = links[start].iter().flatten().count();
            if degree == 0 || (ends && degree == 2) {
                continue;
            }
            let mut line = vec![place(start)];
            let mut at = start;
            while let Some(next) = links[at].iter_mut().find_map(Option::take) {
                if let Some(back) = links[next].iter_mut().find(|l| **l == Some(at)) {
                    *back = None;
                }
                line.push(place(next));
                at = next;
            }
            lines.push(line);
        }
    }
    lines
}

/// About `count` levels strictly between two values: multiples of 1, 2 or 5 times a power of ten.
pub fn levels(low: f64, high: f64, count: usize) -> Vec<f64> {
    let span = high - low;
    if !(span > 1e-9 * high.abs()) || !span.is_finite() {
        return Vec::new();
    }
    let rough = span / count.max(1) as f64;
    let power = 10_f64.powf(rough.log10().floor());
    let lead = [1.0, 2.0, 5.0].into_iter().find(|n| rough <= n * power).unwrap_or(10.0);
    let step = lead * power;
    let first = (low / step).floor() as i64 + 1;
    let last = (high / step).ceil() as i64 - 1;
    (first..=last).map(|i| i as f64 * step).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sampled(columns: usize, rows: usize, f: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        (0..rows * columns).map(|i| f((i % columns) as f64, (i / columns) as f64)).collect()
    }

    #[test]
    fn a_cone_has_one_closed_circle() {
        let values = sampled(41, 41, |x, y| (x - 20.0).hypot(y - 20.0));
        let lines = contours(&Field { columns: 41, values: &values }, 12.3);
        assert_eq!(lines.len(), 1);
        let line = &lines[0];
        assert_eq!(line.first(), line.last());
        assert!(line.iter().all(|p| ((p[0] - 20.0).hypot(p[1] - 20.0) - 12.3).abs() < 0.02));
        let length: f64 = line.windows(2).map(|w| (w[1][0] - w[0][0]).hypot(w[1][1] - w[0][1])).sum();
        assert!((length / (2.0 * std::f64::consts::PI * 12.3) - 1.0).abs() < 3e-3, "{length}");
    }

    #[test]
    fn a_slope_has_one_straight_line_from_side_to_side() {
        let values = sampled(5, 4, |x, y| 2.0 * x + y);
        let lines = contours(&Field { columns: 5, values: &values }, 5.5);
        assert_eq!(lines.len(), 1);
        assert!(lines[0].iter().all(|p| (2.0 * p[0] + p[1] - 5.5).abs() < 1e-12));
        let ys: Vec<f64> = lines[0].iter().map(|p| p[1]).collect();
        let (lo, hi) = (ys.iter().copied().fold(9.0, f64::min), ys.iter().copied().fold(0.0, f64::max));
        assert_eq!((lo, hi), (0.0, 3.0));
    }

    #[test]
    fn saddles_are_decided_by_their_middle() {
        // Corners 3 0 / 0 2: the mean is 1.25.
        let values = [3.0, 0.0, 0.0, 2.0];
        let field = Field { columns: 2, values: &values };
        for (level, low_cut) in [(1.0, true), (1.5, false)] {
            let lines = contours(&field, level);
            assert_eq!(lines.len(), 2);
            // Below the mean the high corners are connected, so that the lines cut off the low corners (1, 0) and (0, 1).
            let cuts_corner = |corner: [f64; 2]| {
                lines.iter().any(|l| l.iter().all(|p| (p[0] - corner[0]).hypot(p[1] - corner[1]) < 1.0))
            };
            assert_eq!(cuts_corner([1.0, 0.0]), low_cut);
            assert_eq!(cuts_corner([0.0, 0.0]), !low_cut);
        }
    }

    #[test]
    fn holes_and_thin_grids_have_no_lines() {
        let mut values = sampled(3, 3, |x, _| x);
        values[4] = f64::NAN;
        assert!(contours(&Field { columns: 3, values: &values }, 0.5).is_empty());
        assert!(contours(&Field { columns: 1, values: &[1.0, 2.0] }, 1.5).is_empty());
    }

    #[test]
    fn levels_are_round_and_inside() {
        assert_eq!(levels(95.0, 520.0, 5), [100.0, 200.0, 300.0, 400.0, 500.0]);
        assert_eq!(levels(0.0, 1.0, 5), [0.2, 0.4, 0.6000000000000001, 0.8]);
        assert!(levels(3.0, 3.0, 5).is_empty() && levels(0.0, f64::NAN, 5).is_empty());
    }
}
